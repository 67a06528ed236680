//! The explorations of a check: two at a time, so that one goes on where the other waits for its slowest thread.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use stillpoint_model::{Beside, Error, Options, Progress, Until, Verdict};

use crate::check::{Settings, options};
use crate::explore;
use crate::known::{Claim, Identity, Known, identity};
use crate::outcome::Outcome;
use crate::reduce;
use crate::subject::Task;
use crate::theorems::Cited;

/// What exploring a task gave.
pub(crate) struct Done {
    pub(crate) outcome: Outcome,
    /// It is the outcome of a task before it, or of another check.
    pub(crate) again: bool,
    /// Seconds from the begin of the check; 0 where nothing was explored.
    pub(crate) ended: f64,
    pub(crate) cited: Cited,
    /// What decides the outcome, if others may have the same.
    identity: Option<Identity>,
}

/// Makes the progress of a task.
type Follow<'a> = dyn FnMut(&Task) -> Box<dyn Progress> + Send + 'a;

/// Explores the tasks. With [`Until::Violated`] what comes after the one that has found a violation is not there.
///
/// # Errors
/// A system that cannot be explored at all, with the task's title: the first one.
pub(crate) fn explore(
    tasks: &mut [Task],
    settings: &Settings,
    start: Instant,
    progress: &mut Follow<'_>,
) -> Result<Vec<Done>, (String, Error)> {
    let known = settings.known.clone().unwrap_or_default();
    let number = tasks.len();
    let workers = side_by_side(settings).min(number);
    let ways = Ways {
        settings,
        known: &known,
        start,
        beside: Beside::new(workers),
        progress: Mutex::new(progress),
        queue: Mutex::new(tasks.iter_mut().enumerate()),
        done: Mutex::new((0..number).map(|_| None).collect()),
    };
    std::thread::scope(|scope| {
        for _ in 1..workers {
            scope.spawn(|| ways.work());
        }
        ways.work();
    });
    let done = ways
        .done
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    let mut out = done
        .into_iter()
        .map_while(|one| one)
        .collect::<Result<Vec<_>, _>>()?;
    in_order(&mut out);
    Ok(out)
}

/// How many explorations go on at a time. What has a limit on memory, is kept, or ends with the first violation is one after the
/// other; so are processes that explore together.
fn side_by_side(settings: &Settings) -> usize {
    let processors = match settings.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let apart = settings.memory.is_some()
        || settings.keep.is_some()
        || settings.cluster.is_some()
        || settings.until == Until::Violated;
    match apart {
        true => 1,
        false => processors.min(2),
    }
}

/// The first task of those that are one has the time of it, whichever was quicker.
fn in_order(all: &mut [Done]) {
    let mut first: HashMap<Identity, usize> = HashMap::new();
    for at in 0..all.len() {
        let Some(identity) = all[at].identity else {
            continue;
        };
        let before = *first.entry(identity).or_insert(at);
        if all[before].again && !all[at].again {
            let seconds = std::mem::take(&mut all[at].outcome.report.seconds);
            all[before].outcome.report.seconds = seconds;
            all[before].again = false;
            all[at].again = true;
        }
    }
}

/// What the threads that explore share.
struct Ways<'a, 'f, Q> {
    settings: &'a Settings,
    known: &'a Known,
    start: Instant,
    beside: Beside,
    progress: Mutex<&'a mut Follow<'f>>,
    /// The tasks that nobody has begun.
    queue: Mutex<Q>,
    done: Mutex<Vec<Option<Result<Done, (String, Error)>>>>,
}

impl<'t, Q: Iterator<Item = (usize, &'t mut Task)>> Ways<'_, '_, Q> {
    fn work(&self) {
        loop {
            let next = self
                .queue
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .next();
            let Some((number, task)) = next else {
                return self.beside.leave();
            };
            let explored = self.task(number, task);
            let last = match &explored {
                Ok(explored) => {
                    let mut judged = explored.outcome.report.properties.iter();
                    self.settings.until == Until::Violated
                        && judged.any(|j| j.verdict == Verdict::Violated)
                }
                Err(_) => true,
            };
            let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
            done[number] = Some(explored);
            drop(done);
            if last {
                // What nobody has begun is not explored.
                let mut queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
                queue.by_ref().for_each(drop);
            }
        }
    }

    fn task(&self, number: usize, task: &mut Task) -> Result<Done, (String, Error)> {
        let settings = self.settings;
        let keep = settings.keep.as_ref();
        let options = Options {
            checkpoint: keep.map(|k| k.of(number, &task.bound)),
            beside: Some(self.beside.clone()),
            ..options(settings, self.start)
        };
        let mut cited = Cited::take(settings.theorems.as_deref(), task);
        // What the processes of a cluster share, and what is kept for later, belongs to the system itself.
        let loosely = !settings.exact && settings.cluster.is_none() && keep.is_none();
        let found = match loosely {
            true => self.loosely(task, &options)?,
            false => None,
        };
        let options = Options {
            limits: settings.limits(self.start),
            ..options
        };
        let nothing = cited.all && found.is_none();
        let (mut outcome, again, identity) = match found {
            Some(found) => found,
            None if cited.all => (Cited::outcome(task), false, None),
            None => self.own(task, &options)?,
        };
        cited.put_back(task, &mut outcome);
        Ok(Done {
            outcome,
            again,
            ended: match nothing {
                true => 0.0,
                false => self.start.elapsed().as_secs_f64(),
            },
            cited,
            identity,
        })
    }

    /// Explores the system of a task, unless what comes out is known.
    fn own(&self, task: &Task, options: &Options) -> Result<Found, (String, Error)> {
        let settings = self.settings;
        let how = (
            settings.interpret,
            settings.reductions,
            settings.witnesses,
            options.until,
        );
        // The other processes of a cluster know nothing of what this one has found.
        let identity = settings
            .cluster
            .is_none()
            .then(|| identity(&task.bound, &how));
        let claim = match identity {
            Some(identity) => match self.known.claim(identity) {
                Claim::Known(outcome) => return Ok((*outcome, true, Some(identity))),
                Claim::Free(claim) => Some(claim),
            },
            None => None,
        };
        let mut follow = {
            let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
            progress(task)
        };
        let outcome = match &settings.cluster {
            Some(cluster) => explore::run_together(
                &task.bound,
                options,
                settings.interpret,
                follow.as_mut(),
                Some(cluster),
            ),
            None => reduce::run(
                &task.bound,
                options,
                settings.interpret,
                settings.reductions,
                follow.as_mut(),
            ),
        }
        .map_err(|e| (task.title.clone(), e))?;
        if let Some(claim) = claim {
            claim.keep(&outcome);
        }
        Ok((outcome, false, identity))
    }

    /// Explores the loose system of a task, if it has one. None: it does not show that what is asked holds, and the task is as it was.
    fn loosely(
        &self,
        task: &mut Task,
        options: &Options,
    ) -> Result<Option<Found>, (String, Error)> {
        let Some(text) = task.loose.as_ref().map(|loose| loose.text.clone()) else {
            return Ok(None);
        };
        let options = Options {
            until: Until::Violated,
            ..options.clone()
        };
        task.change();
        let found = self.own(task, &options)?;
        if !holds(&found.0) {
            task.change();
            return Ok(None);
        }
        task.abstractions.push(text);
        Ok(Some(found))
    }
}

/// An outcome, whether it was known, and what decides it.
type Found = (Outcome, bool, Option<Identity>);

/// Whether all that is asked holds, and is put to the test.
fn holds(outcome: &Outcome) -> bool {
    let report = &outcome.report;
    let mut judged = report.properties.iter();
    report.complete && report.faults.is_empty() && judged.all(|j| j.verdict == Verdict::Holds)
}
