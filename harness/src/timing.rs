//! The timing diagrams of replayed runs.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::UNSET;
use stillpoint_lang::ir::{LazyKind, Ty};
use stillpoint_show::diagram::{Diagram, Lane};

use stillpoint_engine::{Cycle, lazy};

/// The diagram of a replayed run of a table: inputs that were read, state, outputs; constant ones left out, but for a state that may
/// start anywhere: with which value it did is part of the run.
pub fn of_run(bound: &Bound, cycles: &[Cycle]) -> Diagram {
    let system = &bound.system;
    let mut lanes = Vec::new();
    let show = |ty: Ty, v: i32| (v != UNSET).then(|| system.show(ty, i64::from(v)));
    for (k, input) in system.inputs.iter().enumerate() {
        let values = cycles.iter().map(|c| show(input.ty, c.frame.inputs[k]));
        lanes.push(Lane {
            group: "inputs".to_owned(),
            name: input.name.clone(),
            level: input.ty == Ty::Bool,
            values: std::iter::once(None).chain(values).collect(),
        });
    }
    lanes.retain(|l| l.values.iter().any(Option::is_some));
    for (k, state) in system.states.iter().enumerate() {
        let first = cycles
            .first()
            .and_then(|c| show(state.var.ty, c.frame.before[k]));
        let values = cycles.iter().map(|c| show(state.var.ty, c.frame.now[k]));
        let lane = Lane {
            group: "state".to_owned(),
            name: state.var.name.clone(),
            level: state.var.ty == Ty::Bool,
            values: std::iter::once(first).chain(values).collect(),
        };
        if changes(&lane) || state.init.is_none() {
            lanes.push(lane);
        }
    }
    for (k, output) in system.lazies.iter().enumerate() {
        if output.kind != LazyKind::Output {
            continue;
        }
        let values = cycles
            .iter()
            .map(|c| lazy(bound, c, k).map(|v| system.show(output.ty, v)));
        let lane = Lane {
            group: "outputs".to_owned(),
            name: output.name.clone(),
            level: output.ty == Ty::Bool,
            values: std::iter::once(None).chain(values).collect(),
        };
        if changes(&lane) {
            lanes.push(lane);
        }
    }
    Diagram {
        lanes,
        columns: cycles.len() + 1,
        ..Diagram::default()
    }
}

fn changes(lane: &Lane) -> bool {
    let mut seen = lane.values.iter().flatten();
    let first = seen.next();
    seen.any(|v| Some(v) != first)
}
