//! `stillpoint check --engine`.

use std::path::Path;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_harness::certificate::proofs;
use stillpoint_harness::proof::{
    Choice, Every, Settings, Span, Told, Which, exit_status, is_empty, judge, judge_every, to_json,
};

use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::{Condition, Unread};
use stillpoint_model::proof::Budget;

use super::interrupt::Interruptible;
use super::limits::LimitOptions;
use super::progress::Line;
use super::{Failure, emit, show};

/// What judges the properties.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// All reachable states are enumerated
    Explorer,
    /// Bounded model checking: shortest runs of up to --depth cycles; proves nothing
    Bmc,
    /// k-induction with k up to --depth
    Kinduction,
    /// Property-directed reachability (IC3): runs and proofs of any length
    Pdr,
    /// Sets of states as binary decision diagrams: shortest runs, and the exact number of reachable states
    Bdd,
    /// Each property by the engine that has a form for it: pdr after a look at short runs, else bdd, then the explorer
    Auto,
}

impl Engine {
    fn choice(self) -> Choice {
        match self {
            Engine::Explorer => Choice::Explorer,
            Engine::Bmc => Choice::Bmc,
            Engine::Kinduction => Choice::Induction,
            Engine::Pdr => Choice::Pdr,
            Engine::Bdd => Choice::Bdd,
            Engine::Auto => Choice::Auto,
        }
    }
}

/// How it is asked for.
pub struct Asked<'a> {
    pub engine: Engine,
    /// Parameters that are to have every value.
    pub every: Option<&'a Which>,
    /// What these values satisfy.
    pub conditions: &'a [String],
    pub depth: usize,
    /// The most wall time for a property.
    pub each: Option<Duration>,
    pub certificate: Option<&'a Path>,
    pub limits: &'a LimitOptions,
    pub json: bool,
    pub verbose: bool,
}

/// Reads `--every`.
pub fn every(text: &str) -> Result<Which, String> {
    if text == "all" {
        return Ok(Which::All);
    }
    let one = |part: &str| {
        let (name, values) = match part.split_once('=') {
            None => (part, None),
            Some((name, values)) => {
                let pair = (values.split_once(".."))
                    .and_then(|(lo, hi)| Some((lo.trim().parse().ok()?, hi.trim().parse().ok()?)));
                let pair = pair.ok_or_else(|| {
                    format!("`{values}` is no range: write NAME=LO..HI with whole numbers, times in cycles")
                })?;
                (name, Some(pair))
            }
        };
        let name = name.trim().to_owned();
        Ok(Span { name, values })
    };
    let list = text.split(',').map(one);
    list.collect::<Result<_, _>>().map(Which::Named)
}

/// By task those of the conditions that are about parameters of its system.
fn conditions(subject: &Subject, texts: &[String]) -> Result<Vec<Vec<Condition>>, Failure> {
    let mut all = vec![Vec::new(); subject.tasks.len()];
    for text in texts {
        let refused = |why: String| Failure::Other(format!("--where: {why}"));
        let (mut read, mut unknown) = (false, None);
        for (task, list) in subject.tasks.iter().zip(&mut all) {
            match Condition::read(&task.bound.system, text) {
                Ok(condition) => {
                    list.push(condition);
                    read = true;
                }
                Err(Unread::Unknown(why)) => unknown = unknown.or(Some(why)),
                Err(Unread::Wrong(why)) => return Err(refused(why)),
            }
        }
        if let Some(why) = unknown.filter(|_| !read) {
            return Err(refused(why));
        }
    }
    Ok(all)
}

/// All values of some parameters in place of those of the file.
fn set_free(subject: &mut Subject, which: &Which, texts: &[String]) -> Result<Vec<Every>, Failure> {
    if let Which::Named(list) = which {
        for span in list {
            let has = |task: &Task| {
                let mut params = task.bound.system.params.iter();
                params.any(|p| p.var.array() == span.name)
            };
            if !subject.tasks.iter().any(has) {
                return Err(Failure::Other(format!(
                    "--every: no system of {} has a parameter `{}`; `check -v` lists them",
                    subject.name, span.name
                )));
            }
        }
    }
    let conditions = conditions(subject, texts)?;
    let mut all = Vec::new();
    let (mut asked, mut empty) = (false, true);
    for (task, conditions) in subject.tasks.iter_mut().zip(conditions) {
        let every = Every::such(&task.bound, which, &conditions).map_err(Failure::Other)?;
        if !conditions.is_empty() {
            asked = true;
            empty &= is_empty(&every);
        }
        task.title = format!("{}\n  for every {}", task.title, every.text());
        let system = &task.bound.system;
        for condition in &conditions {
            task.title = format!("{}\n  where {}", task.title, condition.text(system));
        }
        task.bound = every.bound.clone();
        all.push(every);
    }
    match asked && empty {
        true => Err(Failure::Other(format!(
            "--where: no values of the parameters of {} satisfy all conditions",
            subject.name
        ))),
        false => Ok(all),
    }
}

/// Judges every property and tells by what.
pub fn run(subject: &mut Subject, asked: &Asked) -> Result<u8, Failure> {
    if asked.certificate.is_some() && asked.engine == Engine::Explorer {
        return Err(Failure::Other(
            "--certificate: leave out --engine, and the explorer writes its own certificate"
                .to_owned(),
        ));
    }
    if asked.certificate.is_some() && asked.engine == Engine::Bdd {
        return Err(Failure::Other(
            "--certificate: a set of states has none; --engine pdr writes one".to_owned(),
        ));
    }
    let bounds: Vec<Bound> = subject.tasks.iter().map(|t| t.bound.clone()).collect();
    let every = match asked.every {
        Some(which) => Some(set_free(subject, which, asked.conditions)?),
        None => None,
    };
    let interrupt = Interruptible::begin()?;
    let start = Instant::now();
    let mut judged = Vec::new();
    for (k, task) in subject.tasks.iter().enumerate() {
        let line = Line::new(&task.title);
        let settings = Settings {
            choice: asked.engine.choice(),
            depth: asked.depth,
            time: asked.limits.time.map(|t| t.saturating_sub(start.elapsed())),
            each: asked.each,
            memory: asked.limits.memory,
            threads: asked.limits.threads,
            ranges: true,
            interrupt: Some(interrupt.handle()),
        };
        judged.push(match every.as_ref().and_then(|all| all.get(k)) {
            Some(every) => judge_every(every, &settings),
            None => judge(&task.bound, &settings),
        });
        drop(line);
    }
    let told = Told {
        subject,
        judged: &judged,
    };
    if asked.json {
        emit(&format!("{:#}\n", to_json(&told)));
    } else {
        show(&told.text(asked.verbose));
    }
    let status = exit_status(&told);
    if let Some(path) = asked.certificate {
        for (task, bound) in subject.tasks.iter_mut().zip(bounds) {
            task.bound = bound;
        }
        let found = proofs::Found {
            subject,
            every: every.as_deref(),
            judged: &judged,
        };
        let line = Line::new("certificate");
        let progress = |done: usize, of: usize| line.share(done as u64, of as u64, "systems");
        let budget = Budget {
            until: None,
            interrupt: Some(interrupt.handle()),
        };
        proofs::certify(path, &found, &budget, &progress).map_err(Failure::Other)?;
    }
    Ok(status)
}
