//! `stillpoint check --engine`.

use std::time::Instant;

use clap::ValueEnum;
use stillpoint_engine::subject::Subject;
use stillpoint_harness::proof::{Choice, Settings, Told, exit_status, judge, to_json};

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
    /// Each property by the engine that has a form for it: pdr after a look at short runs, else the explorer
    Auto,
}

impl Engine {
    fn choice(self) -> Choice {
        match self {
            Engine::Explorer => Choice::Explorer,
            Engine::Bmc => Choice::Bmc,
            Engine::Kinduction => Choice::Induction,
            Engine::Pdr => Choice::Pdr,
            Engine::Auto => Choice::Auto,
        }
    }
}

/// How it is asked for.
pub struct Asked<'a> {
    pub engine: Engine,
    pub depth: usize,
    pub limits: &'a LimitOptions,
    pub json: bool,
    pub verbose: bool,
}

/// Judges every property and tells by what.
pub fn run(subject: &Subject, asked: &Asked) -> Result<u8, Failure> {
    let interrupt = Interruptible::begin()?;
    let start = Instant::now();
    let mut judged = Vec::new();
    for task in &subject.tasks {
        let line = Line::new(&task.title);
        let settings = Settings {
            choice: asked.engine.choice(),
            depth: asked.depth,
            time: asked.limits.time.map(|t| t.saturating_sub(start.elapsed())),
            memory: asked.limits.memory,
            threads: asked.limits.threads,
            interrupt: Some(interrupt.handle()),
        };
        judged.push(judge(&task.bound, &settings));
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
    Ok(exit_status(&told))
}
