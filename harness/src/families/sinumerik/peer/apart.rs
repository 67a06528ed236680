//! Monitors that are driven otherwise than their tables.

use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{compare, group};

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The machines of this topic, each with the module of its monitor.
pub(super) const MACHINES: &[(&str, &str)] = &[("group", "group"), ("compare", "compare")];

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "group" => group(p, mutant),
        "compare" => compare(p, mutant)?,
        _ => return Ok(None),
    }))
}

/// The table asks for one axis what two others do to it; the monitor is asked once for each, the higher answer counts.
fn group(p: &Params, mutant: Option<Mutant>) -> Adapter {
    let esr = p.is("esr_active");
    let next = chosen::<group::Monitor>(mutant);
    Adapter::stateless(
        &[
            "stop_1",
            "internal_1",
            "group_1",
            "together_1",
            "stop_2",
            "internal_2",
            "group_2",
            "together_2",
        ],
        &["reaction"],
        move |i, o| {
            let reach = |k: usize| match i[k] {
                0 => group::Reach::Channel,
                _ => group::Reach::Interpolating,
            };
            let of = |first: usize| {
                let inputs = group::Inputs {
                    level: level(i[first]),
                    internal: internal(i[first + 1]),
                    interpolates: i[first + 3] != 0,
                    esr,
                };
                let config = group::Config::new(reach(first + 2));
                next(group::State::INITIAL, &config, &inputs).1.reaction
            };
            let worst = group::worst(&[of(0), of(4)]);
            o.push(i64::from(ordinal(&group::Reaction::ALL, worst)));
        },
    )
    .only(&["internal_1", "internal_2"], INTERNAL)
}

fn compare(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = compare::Config::new(p.time("t_chg"), &compare::list::CLASSES)?;
    let next = chosen::<compare::Monitor>(mutant);
    let t_chg = p.value("t_chg");
    Ok(Adapter::new(
        &[
            "power_on",
            "change",
            "other_changing",
            "diff_1",
            "diff_2",
            "diff_3",
            "diff_4",
            "diff_5",
            "diff_6",
        ],
        &["discrepancy", "code", "changing", "suspended"],
        vec![
            upto(5),
            upto(t_chg),
            upto(t_chg.saturating_mul(10)),
            truth(),
        ],
        compare::State::INITIAL,
        move |state, i, o| {
            // The other channel presents whatever the monitor says is due.
            let due = state.due(&config, i[0] != 0);
            let class = compare::list::CLASSES.iter().position(|item| *item == due);
            let inputs = compare::Inputs {
                power_on: i[0] != 0,
                change: i[1] != 0,
                other_changing: i[2] != 0,
                differs: class.is_some_and(|class| i[3 + class] != 0),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.discrepancy),
                i64::from(out.code.number()),
                bit(out.changing),
                bit(out.suspended),
            ]);
            after
        },
    ))
}
