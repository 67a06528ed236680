//! Runs of a slice as runs of the whole system.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::slice::Slice;
use stillpoint_model::{Judgement, Replay, System, Trace};

use crate::table::Interpreted;

/// A loop of a slice is closed in the whole system within this many cycles, or the run is not told.
const LONGEST: usize = 100_000;

/// The run of the whole system with the least value for everything outside the slice. A loop of the slice is repeated
/// until the whole system's state repeats too.
pub(super) fn whole(bound: &Bound, slice: &Slice, trace: &Trace) -> Option<Trace> {
    let renamed = |step: &[(u32, u32)], names: &[u32]| -> Vec<(u32, u32)> {
        step.iter()
            .filter_map(|(k, v)| Some((*names.get(*k as usize)?, *v)))
            .collect()
    };
    let mut out = Trace {
        initial: renamed(&trace.initial, &slice.states),
        steps: trace
            .steps
            .iter()
            .map(|s| renamed(s, &slice.inputs))
            .collect(),
        loop_start: None,
    };
    if let Some(start) = trace.loop_start {
        out.loop_start = Some(closed(bound, &mut out, start)?);
    }
    Some(out)
}

/// Repeats the steps from `start` until the state before one repetition is that before an earlier one: where that was.
fn closed(bound: &Bound, trace: &mut Trace, start: usize) -> Option<usize> {
    let lap = trace.steps.get(start..)?.to_vec();
    if lap.is_empty() {
        return None;
    }
    let mut run = Run::new(bound, trace);
    for step in &trace.steps[..start] {
        run.step(step)?;
    }
    let mut seen = vec![run.state.clone()];
    loop {
        for step in &lap {
            run.step(step)?;
        }
        if let Some(place) = seen.iter().position(|s| *s == run.state) {
            return Some(start + place * lap.len());
        }
        if trace.steps.len() > LONGEST {
            return None;
        }
        seen.push(run.state.clone());
        trace.steps.extend_from_slice(&lap);
    }
}

/// Whether the whole system makes the run that shows a verdict without a fault.
pub(super) fn shown(bound: &Bound, judged: &Judgement) -> bool {
    let Some(trace) = judged
        .trace
        .as_ref()
        .filter(|_| super::has_run(judged.verdict))
    else {
        return false;
    };
    let mut run = Run::new(bound, trace);
    trace.steps.iter().all(|step| run.step(step).is_some())
}

/// The interpreter on its way along a run.
struct Run<'a> {
    system: Interpreted<'a>,
    frame: stillpoint_lang::eval::Frame,
    state: Vec<i32>,
    after: Vec<i32>,
}

impl<'a> Run<'a> {
    fn new(bound: &'a Bound, trace: &Trace) -> Self {
        let system = Interpreted::new(bound);
        let mut frame = system.work();
        let mut state = vec![0; bound.states.len()];
        system.initial(&mut frame, &mut Replay::new(&trace.initial), &mut state);
        Run {
            after: state.clone(),
            system,
            frame,
            state,
        }
    }

    fn step(&mut self, step: &[(u32, u32)]) -> Option<()> {
        let mut answers = Replay::new(step);
        self.system
            .next(&mut self.frame, &self.state, &mut answers, &mut self.after)
            .ok()?;
        std::mem::swap(&mut self.state, &mut self.after);
        Some(())
    }
}
