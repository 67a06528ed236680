//! Runs of a table, cycle by cycle.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Frame, UNSET};
use stillpoint_model::{Replay, System, Trace};

use crate::table::Interpreted;

/// One cycle of a replayed run.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// All cells; inputs and named expressions that were not needed are evaluated too, unread inputs stay [`UNSET`].
    pub frame: Frame,
    /// The explorer's choices (input, value above the least).
    pub choices: Vec<(u32, u32)>,
}

/// Replays a trace with the interpreter.
pub fn replay(bound: &Bound, trace: &Trace) -> Vec<Cycle> {
    let system = Interpreted::new(bound);
    let mut frame = system.work();
    let mut state = vec![0; bound.states.len()];
    system.initial(&mut frame, &mut Replay::new(&trace.initial), &mut state);
    let mut cycles = Vec::new();
    for step in &trace.steps {
        let mut after = state.clone();
        let fault = system
            .next(&mut frame, &state, &mut Replay::new(step), &mut after)
            .is_err();
        for k in 0..bound.system.atoms.len() {
            // Atoms may have read inputs the step did not need; they belong to the cycle as well.
            let read = step.iter().map(|(i, _)| *i as usize).collect::<Vec<_>>();
            let mut probe = frame.clone();
            let mut extra = false;
            bound.atom(k, &mut probe, &mut |i| {
                extra |= !read.contains(&i);
                bound.inputs[i].0
                    + step
                        .iter()
                        .find(|(n, _)| *n as usize == i)
                        .map_or(0, |(_, v)| *v as i32)
            });
            if !extra {
                frame = probe;
            }
        }
        cycles.push(Cycle {
            frame: frame.clone(),
            choices: step.clone(),
        });
        if fault {
            break;
        }
        state = after;
    }
    cycles
}

/// The value of named expression `k` in a replayed cycle, if no unread input decides it.
pub fn lazy(bound: &Bound, cycle: &Cycle, k: usize) -> Option<i64> {
    let mut frame = cycle.frame.clone();
    let mut unread = false;
    let value = bound.lazy(k, &mut frame, &mut |i| {
        unread = true;
        bound.inputs[i].0
    });
    (!unread && value != i64::from(UNSET)).then_some(value)
}
