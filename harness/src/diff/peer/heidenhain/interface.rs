//! What the kernel takes over from the safe PLC.

use stillpoint_monitors::heidenhain::types::Stop;
use stillpoint_monitors::heidenhain::{
    both_channels, both_fields, both_status, gate, general_fields,
};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "gate" => gate(p, mutant)?,
        "both_channels" => both_channels(mutant)?,
        "both_fields" => both_fields(mutant),
        "both_status" => both_status(mutant),
        _ => return Ok(None),
    }))
}

fn gate(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = gate::Config::new(kind(p.value("kind")))?;
    let next = chosen::<gate::Monitor>(mutant);
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
    let next = chosen::<both_channels::Monitor>(mutant);
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

fn both_fields(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<both_fields::Monitor>(mutant);
    Adapter::stateless(
        &[
            "wrong_mc",
            "wrong_cc",
            "som_mc",
            "som_cc",
            "voltage_mc",
            "voltage_cc",
            "drives_mc",
            "drives_cc",
            "chain_mc",
            "chain_cc",
            "keys_mc",
            "keys_cc",
            "brakes_mc",
            "brakes_cc",
            "feed_mc",
            "feed_cc",
        ],
        &[
            "mode",
            "voltage",
            "drives",
            "chain_closed",
            "keys",
            "enabled",
            "differ",
            "stop",
        ],
        move |i, o| {
            // The inputs of the channels stand in turn.
            let fields = |channel: usize| general_fields::Outputs {
                stop: if i[channel] != 0 {
                    Stop::Ss1F
                } else {
                    Stop::None
                },
                som: som(i[2 + channel]),
                voltage: i[4 + channel] != 0,
                drives: i[6 + channel] != 0,
                chain: i[8 + channel] != 0,
                keys: i[10 + channel] != 0,
                brakes: i[12 + channel] != 0,
                feed: i[14 + channel] != 0,
            };
            let inputs = both_fields::Inputs {
                mc: fields(0),
                cc: fields(1),
            };
            let (_, out) = next(both_fields::State::INITIAL, &both_fields::Config, &inputs);
            o.extend([
                som_rank(out.som),
                bit(out.voltage),
                bit(out.drives),
                bit(out.chain),
                bit(out.keys),
                bit(out.feed),
                bit(out.differ),
                stop_rank(out.stop),
            ]);
        },
    )
}

fn both_status(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<both_status::Monitor>(mutant);
    Adapter::stateless(
        &[
            "runs_mc",
            "runs_cc",
            "runtime_mc",
            "runtime_cc",
            "output_mc",
            "output_cc",
        ],
        &["differ", "stop"],
        move |i, o| {
            let status = |channel: usize| both_status::Status {
                executed: i[channel] != 0,
                runtime: i[2 + channel] != 0,
                outputs: u16::from(i[4 + channel] != 0),
            };
            let inputs = both_status::Inputs {
                mc: status(0),
                cc: status(1),
            };
            let (_, out) = next(both_status::State::INITIAL, &both_status::Config, &inputs);
            o.extend([bit(out.differ), stop_rank(out.stop)]);
        },
    )
}
