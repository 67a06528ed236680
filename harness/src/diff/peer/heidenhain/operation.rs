//! Inputs and general fields of the safe PLC, what the operator can do, and what the control checks of the program.

use stillpoint_monitors::heidenhain::{
    allowed_functions, availability, control_voltage, f_limited, general_fields, group_motion,
    jog_increment, program_check, safe_input, working_space,
};
use stillpoint_monitors::kernel::Speed;
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "safe_input" => safe_input(p, mutant)?,
        "doors" => doors(mutant)?,
        "general" => general(mutant),
        "motion" => motion(mutant),
        "available" => available(mutant),
        "program_check" => program_check(p, mutant)?,
        "increment" => increment(mutant)?,
        "functions" => functions(mutant),
        "reset_button" => reset_button(p, mutant)?,
        "nc_speed" => nc_speed(p, mutant)?,
        _ => return Ok(None),
    }))
}

cells! {
    control_voltage::State, 1 {
        armed = truthy, i32::from;
    }
    jog_increment::State, 1 {
        jog = |c| value(&jog_increment::Jog::ALL, c), |j| ordinal(&jog_increment::Jog::ALL, j);
    }
    program_check::State, 1 {
        good = truthy, i32::from;
    }
}

fn safe_input(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = safe_input::Config::new(p.is("invert_a"), p.is("invert_b"), p.is("missing"))?;
    let next = chosen::<safe_input::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["contact_a", "contact_b"],
        &["marker"],
        move |i, o| {
            let inputs = safe_input::Inputs {
                contact_a: i[0] != 0,
                contact_b: i[1] != 0,
            };
            let (_, out) = next(safe_input::State::INITIAL, &config, &inputs);
            o.push(bit(out.marker));
        },
    ))
}

fn doors(mutant: Option<Mutant>) -> Refusable {
    let config = working_space::Config::new(0b11)?;
    let next = chosen::<working_space::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["door_1", "door_2"],
        &["open"],
        move |i, o| {
            let closed = u8::from(i[0] != 0) | u8::from(i[1] != 0) << 1;
            let inputs = working_space::Inputs { closed };
            let (_, out) = next(working_space::State::INITIAL, &config, &inputs);
            o.push(bit(out.open));
        },
    ))
}

fn general(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<general_fields::Monitor>(mutant);
    Adapter::stateless(
        &["som", "cvo", "permit", "chain", "mkg", "t_brk", "feed"],
        &[
            "stop",
            "mode",
            "voltage",
            "drives",
            "chain_closed",
            "keys",
            "brakes",
            "enabled",
        ],
        move |i, o| {
            let inputs = general_fields::Inputs {
                som: small(i[0]),
                voltage: small(i[1]),
                drives: small(i[2]),
                chain: small(i[3]),
                keys: small(i[4]),
                brakes: small(i[5]),
                feed: small(i[6]),
            };
            let config = general_fields::Config;
            let (_, out) = next(general_fields::State::INITIAL, &config, &inputs);
            o.extend([
                stop_rank(out.stop),
                som_rank(out.som),
                bit(out.voltage),
                bit(out.drives),
                bit(out.chain),
                bit(out.keys),
                bit(out.brakes),
                bit(out.feed),
            ]);
        },
    )
}

fn motion(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<group_motion::Monitor>(mutant);
    Adapter::stateless(&["axis_1", "axis_2", "axis_3"], &["moving"], move |i, o| {
        let axes = (0..3).fold(0, |axes, k| axes | u8::from(i[k] != 0) << k);
        let inputs = group_motion::Inputs { axes };
        let (_, out) = next(group_motion::State::INITIAL, &group_motion::Config, &inputs);
        o.push(bit(out.moving));
    })
}

fn available(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<availability::Monitor>(mutant);
    Adapter::stateless(
        &[
            "kind",
            "function",
            "som",
            "has_brake",
            "spindle_sos",
            "ungrouped",
        ],
        &["has"],
        move |i, o| {
            let inputs = availability::Inputs {
                kind: kind(i[0]),
                function: value(&availability::Function::ALL, i[1]),
                som: som(i[2]),
                has_brake: i[3] != 0,
                spindle_sos: i[4] != 0,
                ungrouped: i[5] != 0,
            };
            let (_, out) = next(availability::State::INITIAL, &availability::Config, &inputs);
            o.push(bit(out.available));
        },
    )
}

fn program_check(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = program_check::Config::new(p.is("commissioning"))?;
    let next = chosen::<program_check::Monitor>(mutant);
    Ok(Adapter::new(
        &["translated", "crc_equal", "version_equal"],
        &["message_crc", "message_version", "good"],
        vec![truth()],
        program_check::State::INITIAL,
        move |state, i, o| {
            let inputs = program_check::Inputs {
                translated: i[0] != 0,
                crc_equal: i[1] != 0,
                version_equal: i[2] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.message_crc),
                bit(out.message_version),
                bit(out.good),
            ]);
            after
        },
    ))
}

fn increment(mutant: Option<Mutant>) -> Refusable {
    let config = jog_increment::Config::new(false)?;
    let next = chosen::<jog_increment::Monitor>(mutant);
    Ok(Adapter::new(
        &["key", "done"],
        &["feed", "stop", "jog"],
        vec![upto(2)],
        jog_increment::State::INITIAL,
        move |state, i, o| {
            let inputs = jog_increment::Inputs {
                key: i[0] != 0,
                done: i[1] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.feed),
                stop_rank(out.stop),
                rank(&jog_increment::Jog::ALL, after.jog),
            ]);
            after
        },
    ))
}

fn functions(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<allowed_functions::Monitor>(mutant);
    Adapter::stateless(
        &["door_open", "permissive", "function"],
        &["allowed"],
        move |i, o| {
            let inputs = allowed_functions::Inputs {
                door_open: i[0] != 0,
                permissive: i[1] != 0,
                function: value(&allowed_functions::Function::ALL, i[2]),
            };
            let config = allowed_functions::Config;
            let (_, out) = next(allowed_functions::State::INITIAL, &config, &inputs);
            o.push(bit(out.allowed));
        },
    )
}

/// The table knows the key only: the latch circuit is not set.
fn reset_button(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = control_voltage::Config::new(p.is("fitted"), false)?;
    let next = chosen::<control_voltage::Monitor>(mutant);
    Ok(Adapter::new(
        &["dropped", "reset", "cvo"],
        &["voltage"],
        vec![truth()],
        control_voltage::State::INITIAL,
        move |state, i, o| {
            let inputs = control_voltage::Inputs {
                dropped: i[0] != 0,
                reset: i[1] != 0,
                key: i[2] != 0,
                latched: false,
                t_key: false,
            };
            let (after, out) = next(state, &config, &inputs);
            o.push(bit(out.voltage));
            after
        },
    ))
}

fn nc_speed(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let limits = [p.speed("limit_2"), p.speed("limit_3"), p.speed("limit_4")];
    let config = f_limited::Config::new(limits)?;
    let next = chosen::<f_limited::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["f_limited", "som", "wanted"],
        &["v"],
        move |i, o| {
            let inputs = f_limited::Inputs {
                pressed: i[0] != 0,
                som: som(i[1]),
                wanted: speed(i[2]),
            };
            let (_, out) = next(f_limited::State::INITIAL, &config, &inputs);
            let Speed(v) = out.speed;
            o.push(i64::from(v));
        },
    ))
}
