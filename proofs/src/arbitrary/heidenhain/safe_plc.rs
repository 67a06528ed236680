//! Blocks of the safe PLC.

use stillpoint_monitors::heidenhain::key_filter::Keys;
use stillpoint_monitors::heidenhain::types::{GroupState, Som, Unit};
use stillpoint_monitors::heidenhain::{axes_logic, key_filter, magazine_logic, spindle_logic};

use crate::source::Source;

/// Any bit set of axes; the enumeration takes those of the numbers up to `reach`, and all axes.
fn axes<S: Source>(source: &mut S, reach: u32) -> u8 {
    source.any_u32(reach, u32::from(u8::MAX)) as u8
}

fn keys<S: Source>(source: &mut S) -> Keys {
    Keys {
        permissive: source.any_bool(),
        axes: axes(source, 1),
        nc_start: source.any_bool(),
        jog: source.any_bool(),
        spindle_start: source.any_bool(),
    }
}

/// Any step of the filter.
pub fn key_filter<S: Source>(
    source: &mut S,
) -> Option<(key_filter::State, key_filter::Config, key_filter::Inputs)> {
    let inputs = key_filter::Inputs {
        door_open: source.any_bool(),
        t_open: source.any_bool(),
        unit: source.any_of(&Unit::ALL),
        panel: keys(source),
        wheel: keys(source),
        stop: source.any_bool(),
        t_permissive: source.any_bool(),
        t_keys: axes(source, 3),
        confirm: source.any_bool(),
    };
    Some((key_filter::State::INITIAL, key_filter::Config, inputs))
}

/// Any step of the logic of the axes. The enumeration takes the keys in one part, in the other the events that stop and the
/// parameters.
pub fn axes_logic<S: Source>(
    source: &mut S,
) -> Option<(axes_logic::State, axes_logic::Config, axes_logic::Inputs)> {
    let part = source.any_part(2);
    let (keys_move, events_move) = (part != 2, part != 1);
    let key = |source: &mut S| keys_move && source.any_bool();
    let event = |source: &mut S| events_move && source.any_bool();
    let t_clear = source.any_delay(axes_logic::Config::LONGEST);
    let hold = !event(source);
    let config = axes_logic::Config::new(t_clear, hold, event(source)).ok()?;
    let state = axes_logic::State {
        open: source.any_bool(),
        keyed: source.any_bool(),
        starts: source.any_bool(),
        latch: source.any_bool(),
        started: source.any_bool(),
        program: source.any_bool(),
        rest: source.any_cycles(t_clear),
    };
    if !state.invariant(&config) {
        return None;
    }
    let inputs = axes_logic::Inputs {
        door_open: source.any_bool(),
        t_open: source.any_bool(),
        som: source.any_of(&Som::ALL),
        som_changed: event(source),
        unit: source.any_of(&Unit::ALL),
        panel: source.any_bool(),
        wheel: source.any_bool(),
        keys: if keys_move { axes(source, 1) } else { 0 },
        nc_start: key(source),
        start_held: key(source),
        key_held: key(source),
        stop: event(source),
        state: match part {
            0 => source.any_of(&GroupState::ALL),
            _ => source.any_of(&[GroupState::Sls2, GroupState::Sos]),
        },
        gen_safe: !key(source),
    };
    Some((state, config, inputs))
}

/// Any step of the logic of the spindle.
pub fn spindle_logic<S: Source>(
    source: &mut S,
) -> Option<(
    spindle_logic::State,
    spindle_logic::Config,
    spindle_logic::Inputs,
)> {
    let state = spindle_logic::State {
        open: source.any_bool(),
        keyed: source.any_bool(),
        starts: source.any_bool(),
        jogged: source.any_bool(),
        latch: source.any_bool(),
        started: source.any_bool(),
    };
    if !state.invariant(&spindle_logic::Config) {
        return None;
    }
    let inputs = spindle_logic::Inputs {
        door_open: source.any_bool(),
        t_open: source.any_bool(),
        som: source.any_of(&Som::ALL),
        som_changed: source.any_bool(),
        unit: source.any_of(&Unit::ALL),
        panel: source.any_bool(),
        wheel: source.any_bool(),
        jog: source.any_bool(),
        jog_held: source.any_bool(),
        spindle_start: source.any_bool(),
        start_held: source.any_bool(),
        key_held: source.any_bool(),
        stop: source.any_bool(),
        restricted: source.any_bool(),
        holder_open: source.any_bool(),
        gen_safe: source.any_bool(),
    };
    Some((state, spindle_logic::Config, inputs))
}

/// Any step of the logic of the magazine.
pub fn magazine_logic<S: Source>(
    source: &mut S,
) -> Option<(
    magazine_logic::State,
    magazine_logic::Config,
    magazine_logic::Inputs,
)> {
    let state = magazine_logic::State {
        open: source.any_bool(),
        keyed: source.any_bool(),
        confirmed: source.any_bool(),
    };
    if !state.invariant(&magazine_logic::Config) {
        return None;
    }
    let inputs = magazine_logic::Inputs {
        t_open: source.any_bool(),
        permissive: source.any_bool(),
        keys: axes(source, 3),
        confirm: source.any_bool(),
        som_changed: source.any_bool(),
        moving: source.any_bool(),
        gen_safe: source.any_bool(),
    };
    Some((state, magazine_logic::Config, inputs))
}
