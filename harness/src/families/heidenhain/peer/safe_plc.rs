//! Blocks of the safe PLC. The table `splc` is the program as a whole, the tables of the doors are one group each: the blocks
//! then run with the keys of the others at rest, and the self-test in force.

use stillpoint_monitors::heidenhain::key_filter::Keys;
use stillpoint_monitors::heidenhain::safe_plc::{Blocks, Config, Inputs, Outputs, State};
use stillpoint_monitors::heidenhain::{axes_logic, key_filter, magazine_logic, spindle_logic};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::cells::stored;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The machines of these tables, each with the block that its mutants are variants of.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("splc", "safe_plc"),
    ("splc_axes", "axes_logic"),
    ("splc_spindle", "spindle_logic"),
    ("splc_magazine", "magazine_logic"),
];

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    let blocks = Blocks {
        filter: chosen::<key_filter::Monitor>(mutant),
        axes: chosen::<axes_logic::Monitor>(mutant),
        spindle: chosen::<spindle_logic::Monitor>(mutant),
        magazine: chosen::<magazine_logic::Monitor>(mutant),
    };
    Ok(Some(match machine {
        "splc" => program(p, blocks)?,
        "splc_axes" => axes(p, blocks)?,
        "splc_spindle" => spindle(p, blocks)?,
        "splc_magazine" => magazine(p, blocks)?,
        _ => return Ok(None),
    }))
}

/// The EN 12417 variant, axis-direction keys without permissive: the recommended readings.
fn config(p: &Params) -> Result<Config, crate::diff::peer::Refusal> {
    Ok(Config::new(p.time("t_clear"), true, false)?)
}

/// A program whose latch has no time: for the groups that have none.
fn timeless() -> Result<Config, crate::diff::peer::Refusal> {
    Ok(Config::new(cycles(1), true, false)?)
}

fn domains(p: &Params) -> Vec<stillpoint_model::Domain> {
    let mut all = vec![truth(); stored(State::INITIAL).len()];
    all[6] = upto(p.value("t_clear").max(1));
    all
}

/// The unit in use with its keys, and nothing else: those of the spindle are of that unit, the axis keys and NC start of the panel.
fn keys(unit: Unit, panel: Keys, turning: Keys, wheel: bool) -> key_filter::Inputs {
    let on_wheel = unit == Unit::Handwheel;
    let turn = |here: bool| if here { turning } else { Keys::NONE };
    let (at_panel, at_wheel) = (turn(!on_wheel), turn(on_wheel));
    key_filter::Inputs {
        unit,
        panel: Keys {
            jog: at_panel.jog,
            spindle_start: at_panel.spindle_start,
            ..panel
        },
        wheel: Keys {
            permissive: wheel,
            jog: at_wheel.jog,
            spindle_start: at_wheel.spindle_start,
            ..Keys::NONE
        },
        ..key_filter::Inputs::default()
    }
}

/// A feed enable of the only axis.
fn first(feed: u8) -> i64 {
    i64::from(feed & 1)
}

fn requests_of_axes(o: &mut Vec<i64>, out: &axes_logic::Outputs) {
    o.extend([
        state_rank(out.request),
        bit(out.activate),
        first(out.feed),
        stop_rank(out.stop),
    ]);
}

fn requests_of_spindle(o: &mut Vec<i64>, out: &spindle_logic::Outputs) {
    o.extend([
        state_rank(out.request),
        bit(out.activate),
        stop_rank(out.stop),
    ]);
}

fn requests_of_magazine(o: &mut Vec<i64>, out: &magazine_logic::Outputs) {
    o.extend([
        state_rank(out.request),
        bit(out.activate),
        first(out.feed),
        stop_rank(out.stop),
    ]);
}

fn step(blocks: &Blocks, config: &Config, state: State, inputs: &Inputs) -> (State, Outputs) {
    blocks.next(state, config, inputs)
}

fn program(p: &Params, blocks: Blocks) -> Refusable {
    let config = config(p)?;
    Ok(Adapter::new(
        &[
            "door_open",
            "t_open",
            "som",
            "som_changed",
            "pb_panel",
            "pb_wheel",
            "pb_magazine",
            "axis_key",
            "nc_start",
            "jog",
            "spindle_start",
            "stop_key",
            "magazine_key",
            "confirm",
            "unit",
            "restricted",
            "holder_open",
            "state_a",
            "moving_t",
            "gen_safe",
        ],
        &[
            "request_a",
            "activate_a",
            "feed_a",
            "stop_a",
            "request_s",
            "activate_s",
            "stop_s",
            "request_t",
            "activate_t",
            "feed_t",
            "stop_t",
            "pb_a",
            "pb_s",
            "pb_t",
            "mkg",
        ],
        domains(p),
        State::INITIAL,
        move |state, i, o| {
            let panel = Keys {
                permissive: i[4] != 0,
                axes: u8::from(i[7] != 0),
                nc_start: i[8] != 0,
                ..Keys::NONE
            };
            let turning = Keys {
                jog: i[9] != 0,
                spindle_start: i[10] != 0,
                ..Keys::NONE
            };
            let inputs = Inputs {
                keys: key_filter::Inputs {
                    door_open: i[0] != 0,
                    t_open: i[1] != 0,
                    stop: i[11] != 0,
                    t_permissive: i[6] != 0,
                    t_keys: u8::from(i[12] != 0),
                    confirm: i[13] != 0,
                    ..keys(unit(i[14]), panel, turning, i[5] != 0)
                },
                som: som(i[2]),
                som_changed: i[3] != 0,
                restricted: i[15] != 0,
                holder_open: i[16] != 0,
                axes_state: self::state(i[17]),
                magazine_moving: i[18] != 0,
                gen_safe: i[19] != 0,
            };
            let (after, out) = step(&blocks, &config, state, &inputs);
            requests_of_axes(o, &out.axes);
            requests_of_spindle(o, &out.spindle);
            requests_of_magazine(o, &out.magazine);
            o.extend([
                bit(out.axes.permissive),
                bit(out.spindle.permissive),
                bit(out.magazine.permissive),
                bit(out.keys.machine_keys),
            ]);
            after
        },
    )
    // What the example does not look at.
    .without(&["state_s", "state_t", "moving_a", "moving_s"]))
}

fn axes(p: &Params, blocks: Blocks) -> Refusable {
    let config = config(p)?;
    Ok(Adapter::new(
        &[
            "door_open",
            "t_open",
            "som",
            "som_changed",
            "unit",
            "pb_panel",
            "pb_wheel",
            "axis_key",
            "nc_start",
            "stop_key",
            "state",
        ],
        &["request", "activate", "feed", "stop"],
        domains(p),
        State::INITIAL,
        move |state, i, o| {
            let panel = Keys {
                permissive: i[5] != 0,
                axes: u8::from(i[7] != 0),
                nc_start: i[8] != 0,
                ..Keys::NONE
            };
            let inputs = Inputs {
                keys: key_filter::Inputs {
                    door_open: i[0] != 0,
                    t_open: i[1] != 0,
                    stop: i[9] != 0,
                    ..keys(unit(i[4]), panel, Keys::NONE, i[6] != 0)
                },
                som: som(i[2]),
                som_changed: i[3] != 0,
                axes_state: self::state(i[10]),
                gen_safe: true,
                ..Inputs::default()
            };
            let (after, out) = step(&blocks, &config, state, &inputs);
            requests_of_axes(o, &out.axes);
            after
        },
    ))
}

fn spindle(p: &Params, blocks: Blocks) -> Refusable {
    let config = timeless()?;
    Ok(Adapter::new(
        &[
            "door_open",
            "t_open",
            "som",
            "som_changed",
            "unit",
            "pb_panel",
            "pb_wheel",
            "jog",
            "start_key",
            "stop_key",
            "restricted",
            "holder_open",
        ],
        &["request", "activate", "stop"],
        domains(p),
        State::INITIAL,
        move |state, i, o| {
            let panel = Keys {
                permissive: i[5] != 0,
                ..Keys::NONE
            };
            let turning = Keys {
                jog: i[7] != 0,
                spindle_start: i[8] != 0,
                ..Keys::NONE
            };
            let inputs = Inputs {
                keys: key_filter::Inputs {
                    door_open: i[0] != 0,
                    t_open: i[1] != 0,
                    stop: i[9] != 0,
                    ..keys(unit(i[4]), panel, turning, i[6] != 0)
                },
                som: som(i[2]),
                som_changed: i[3] != 0,
                restricted: i[10] != 0,
                holder_open: i[11] != 0,
                gen_safe: true,
                ..Inputs::default()
            };
            let (after, out) = step(&blocks, &config, state, &inputs);
            requests_of_spindle(o, &out.spindle);
            after
        },
    ))
}

fn magazine(p: &Params, blocks: Blocks) -> Refusable {
    let config = timeless()?;
    Ok(Adapter::new(
        &[
            "t_open",
            "pb",
            "one_key",
            "confirm",
            "som_changed",
            "moving",
        ],
        &["request", "activate", "feed", "stop"],
        domains(p),
        State::INITIAL,
        move |state, i, o| {
            let inputs = Inputs {
                keys: key_filter::Inputs {
                    t_open: i[0] != 0,
                    t_permissive: i[1] != 0,
                    t_keys: u8::from(i[2] != 0),
                    confirm: i[3] != 0,
                    ..key_filter::Inputs::default()
                },
                som_changed: i[4] != 0,
                magazine_moving: i[5] != 0,
                gen_safe: true,
                ..Inputs::default()
            };
            let (after, out) = step(&blocks, &config, state, &inputs);
            requests_of_magazine(o, &out.magazine);
            after
        },
    ))
}
