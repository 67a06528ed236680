//! The explorations of a check: two at a time, so that one goes on where the other waits for its slowest thread.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use stillpoint_machine::Abstraction;
use stillpoint_model::{Beside, Error, Options, Progress, Until, Verdict};

use crate::checked::{Answer, Checked, told};
use crate::excluded::Judge;
use crate::explore;
use crate::known::{Claim, Identity, Known, identity};
use crate::outcome::Outcome;
use crate::reduce;
use crate::settings::Settings;
use crate::subject::Task;
use crate::theorems::Cited;

/// A task that is done, and what decides its outcome, if others may have the same.
type Done = (Checked, Option<Identity>);

/// The same, or why a system cannot be explored, with the task's title.
type Tried = Result<Done, (String, Error)>;

/// Makes the progress of a task.
type Follow<'a> = dyn FnMut(&Task) -> Box<dyn Progress> + Send + 'a;

/// Explores the tasks, those of a machine or not. With [`Until::Violated`] what comes after the one that has found a violation is not
/// there.
///
/// # Errors
/// A system that cannot be explored at all, with the task's title: the first one.
///
/// # Panics
/// If an exploration does.
pub(crate) fn explore(
    tasks: &mut [Task],
    machine: bool,
    settings: &Settings,
    progress: &mut Follow<'_>,
) -> Result<Vec<Checked>, (String, Error)> {
    let known = settings.known.clone().unwrap_or_default();
    let number = tasks.len();
    let workers = side_by_side(settings).min(number);
    let alone = settings.cluster.as_ref().is_none_or(|c| c.process() == 0);
    let ways = Ways {
        settings,
        known: &known,
        start: Instant::now(),
        judge: (machine && alone).then(Mutex::default),
        beside: Beside::new(workers.max(1)),
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
    let whole = out.len() == number || settings.until == Until::Violated;
    assert!(whole, "a task was left out");
    in_order(&mut out);
    Ok(out.into_iter().map(|(checked, _)| checked).collect())
}

/// How many explorations go on at a time. What has a limit, is kept, or ends with the first violation is one after the other; so are
/// processes that explore together.
fn side_by_side(settings: &Settings) -> usize {
    let processors = match settings.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let apart = settings.memory.is_some()
        || settings.time.is_some()
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
        let Some(identity) = all[at].1 else {
            continue;
        };
        let before = *first.entry(identity).or_insert(at);
        if all[before].0.again && !all[at].0.again {
            let seconds = std::mem::take(&mut all[at].0.outcome.report.seconds);
            all[before].0.outcome.report.seconds = seconds;
            all[before].0.again = false;
            all[at].0.again = true;
        }
    }
}

/// What the threads that explore share.
struct Ways<'a, 'f, Q> {
    settings: &'a Settings,
    known: &'a Known,
    start: Instant,
    /// Of a machine: which witnesses its values exclude.
    judge: Option<Mutex<Judge>>,
    beside: Beside,
    progress: Mutex<&'a mut Follow<'f>>,
    /// The tasks that nobody has begun.
    queue: Mutex<Q>,
    done: Mutex<Vec<Option<Tried>>>,
}

impl<'t, Q: Iterator<Item = (usize, &'t mut Task)>> Ways<'_, '_, Q> {
    fn work(&self) {
        // Also where an exploration panics the others have all threads, and end soon.
        let _end = End(self);
        loop {
            let Some((number, task)) = self.queue().next() else {
                return;
            };
            let done = self.task(number, task);
            let last = match &done {
                Ok((checked, _)) => {
                    let mut judged = checked.outcome.report.properties.iter();
                    self.settings.until == Until::Violated
                        && judged.any(|j| j.verdict == Verdict::Violated)
                }
                Err(_) => true,
            };
            let mut all = self.done.lock().unwrap_or_else(PoisonError::into_inner);
            all[number] = Some(done);
            drop(all);
            if last {
                self.leave_the_rest();
            }
        }
    }

    fn queue(&self) -> MutexGuard<'_, Q> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What nobody has begun is not explored.
    fn leave_the_rest(&self) {
        self.queue().by_ref().for_each(drop);
    }

    fn task(&self, number: usize, task: &mut Task) -> Tried {
        let settings = self.settings;
        let keep = settings.keep.as_ref();
        let options = Options {
            checkpoint: keep.map(|k| k.of(number, &task.bound)),
            beside: Some(self.beside.clone()),
            ..settings.options(self.start)
        };
        let mut cited = Cited::take(settings.theorems.as_deref(), task);
        // What the processes of a cluster share, and what is kept for later, belongs to the system itself.
        let loosely = !settings.exact && settings.cluster.is_none() && keep.is_none();
        let found = match loosely {
            true => self.loosely(task, &options)?,
            false => None,
        };
        let nothing = cited.all && found.is_none();
        let (mut outcome, again, identity) = match found {
            Some(found) => found,
            None if cited.all => (Outcome::nothing(&task.bound.system), false, None),
            None => self.own(task, &options)?,
        };
        cited.put_back(task, &mut outcome);
        let answer = Answer {
            outcome,
            again,
            ended: match nothing {
                true => 0.0,
                false => self.start.elapsed().as_secs_f64(),
            },
            cited,
        };
        let checked = told(task, answer, self.judge.as_ref(), settings, &options);
        let checked = checked.map_err(|e| (task.title.clone(), e))?;
        Ok((checked, identity))
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
        // Who waits for another exploration needs no thread.
        self.beside.leave();
        let claim = identity.map(|identity| self.known.claim(identity));
        self.beside.join();
        let claim = match claim {
            Some(Claim::Known(outcome)) => return Ok((*outcome, true, identity)),
            Some(Claim::Free(claim)) => Some(claim),
            None => None,
        };
        let options = &Options {
            limits: settings.limits(self.start),
            ..options.clone()
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
        task.abstractions.push(Abstraction::of_system(text));
        Ok(Some(found))
    }
}

/// The end of a thread that explores.
struct End<'a, 't, 'b, 'f, Q: Iterator<Item = (usize, &'t mut Task)>>(&'a Ways<'b, 'f, Q>);

impl<'t, Q: Iterator<Item = (usize, &'t mut Task)>> Drop for End<'_, 't, '_, '_, Q> {
    fn drop(&mut self) {
        self.0.beside.leave();
        if std::thread::panicking() {
            self.0.leave_the_rest();
        }
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
