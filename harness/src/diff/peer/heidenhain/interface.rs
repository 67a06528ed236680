//! What the kernel takes over from the safe PLC.

use stillpoint_monitors::heidenhain::mutant::Mutant;
use stillpoint_monitors::heidenhain::{both_channels, gate};

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "gate" => gate(p, mutant)?,
        "both_channels" => both_channels(mutant)?,
        _ => return Ok(None),
    }))
}

fn gate(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = gate::Config::new(kind(p.value("kind")))?;
    let next = mutant.map_or(gate::next as gate::Next, Mutant::gate);
    Ok(Adapter::stateless(
        &[
            "state_code",
            "stop_code",
            "som_code",
            "activate",
            "permissive",
        ],
        &["request", "stop", "som", "starts", "held"],
        move |i, o| {
            let inputs = gate::Inputs {
                state_code: small(i[0]),
                stop_code: small(i[1]),
                som_code: small(i[2]),
                activate: i[3] != 0,
                permissive: i[4] != 0,
            };
            let (_, out) = next(gate::State::INITIAL, &config, &inputs);
            o.extend([
                state_rank(out.request),
                stop_rank(out.stop),
                som_rank(out.som),
                bit(out.starts),
                bit(out.held),
            ]);
        },
    ))
}

fn both_channels(mutant: Option<Mutant>) -> Refusable {
    let config = both_channels::Config::new()?;
    let next = mutant.map_or(
        both_channels::next as both_channels::Next,
        Mutant::both_channels,
    );
    Ok(Adapter::stateless(
        &[
            "request_mc",
            "request_cc",
            "stop_mc",
            "stop_cc",
            "starts_mc",
            "starts_cc",
            "held_mc",
            "held_cc",
            "late",
        ],
        &["request", "starts", "held", "stop", "differ"],
        move |i, o| {
            let inputs = both_channels::Inputs {
                request_mc: state(i[0]),
                request_cc: state(i[1]),
                stop_mc: stop(i[2]),
                stop_cc: stop(i[3]),
                starts_mc: i[4] != 0,
                starts_cc: i[5] != 0,
                held_mc: i[6] != 0,
                held_cc: i[7] != 0,
                late: i[8] != 0,
            };
            let (_, out) = next(both_channels::State::INITIAL, &config, &inputs);
            o.extend([
                state_rank(out.request),
                bit(out.starts),
                bit(out.held),
                stop_rank(out.stop),
                bit(out.differ),
            ]);
        },
    ))
}
