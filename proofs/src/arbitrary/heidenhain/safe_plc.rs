//! Blocks of the safe PLC.

use stillpoint_monitors::heidenhain::key_filter::Keys;
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Som, Unit};
use stillpoint_monitors::heidenhain::{
    allowed_functions, availability, axes_logic, control_voltage, f_limited, general_fields,
    group_motion, jog_increment, key_filter, magazine_logic, program_check, safe_input,
    safe_output, spindle_logic, working_space,
};

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

/// Any step of a safe input.
pub fn safe_input<S: Source>(
    source: &mut S,
) -> Option<(safe_input::State, safe_input::Config, safe_input::Inputs)> {
    let config =
        safe_input::Config::new(source.any_bool(), source.any_bool(), source.any_bool()).ok()?;
    let inputs = safe_input::Inputs {
        contact_a: source.any_bool(),
        contact_b: source.any_bool(),
    };
    Some((safe_input::State::INITIAL, config, inputs))
}

/// Any step of a working space.
pub fn working_space<S: Source>(
    source: &mut S,
) -> Option<(
    working_space::State,
    working_space::Config,
    working_space::Inputs,
)> {
    let config = working_space::Config::new(axes(source, 3)).ok()?;
    let inputs = working_space::Inputs {
        closed: axes(source, 7),
    };
    Some((working_space::State::INITIAL, config, inputs))
}

/// Any step of the control voltage asked for.
pub fn control_voltage<S: Source>(
    source: &mut S,
) -> Option<(
    control_voltage::State,
    control_voltage::Config,
    control_voltage::Inputs,
)> {
    let config = control_voltage::Config::new(source.any_bool(), source.any_bool()).ok()?;
    let state = control_voltage::State {
        armed: source.any_bool(),
    };
    let inputs = control_voltage::Inputs {
        dropped: source.any_bool(),
        reset: source.any_bool(),
        key: source.any_bool(),
        latched: source.any_bool(),
        t_key: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of a jog increment.
pub fn jog_increment<S: Source>(
    source: &mut S,
) -> Option<(
    jog_increment::State,
    jog_increment::Config,
    jog_increment::Inputs,
)> {
    let config = jog_increment::Config::new(source.any_bool()).ok()?;
    let state = jog_increment::State {
        jog: source.any_of(&jog_increment::Jog::ALL),
    };
    let inputs = jog_increment::Inputs {
        key: source.any_bool(),
        done: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any number of a marker: its values, the first beyond them, and the highest.
fn marker<S: Source>(source: &mut S) -> u8 {
    source.any_u32(2, u32::from(u8::MAX)) as u8
}

/// Any step of the general fields.
pub fn general_fields<S: Source>(
    source: &mut S,
) -> Option<(
    general_fields::State,
    general_fields::Config,
    general_fields::Inputs,
)> {
    let inputs = general_fields::Inputs {
        som: source.any_u32(4, u32::from(u8::MAX)) as u8,
        voltage: marker(source),
        drives: marker(source),
        chain: marker(source),
        keys: marker(source),
        brakes: marker(source),
        feed: marker(source),
    };
    Some((
        general_fields::State::INITIAL,
        general_fields::Config,
        inputs,
    ))
}

/// Any step of the check of a program.
pub fn program_check<S: Source>(
    source: &mut S,
) -> Option<(
    program_check::State,
    program_check::Config,
    program_check::Inputs,
)> {
    let config = program_check::Config::new(source.any_bool()).ok()?;
    let state = program_check::State {
        good: source.any_bool(),
    };
    let inputs = program_check::Inputs {
        translated: source.any_bool(),
        crc_equal: source.any_bool(),
        version_equal: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the table of the safety functions.
pub fn availability<S: Source>(
    source: &mut S,
) -> Option<(
    availability::State,
    availability::Config,
    availability::Inputs,
)> {
    let inputs = availability::Inputs {
        kind: source.any_of(&Kind::ALL),
        function: source.any_of(&availability::Function::ALL),
        som: source.any_of(&Som::ALL),
        has_brake: source.any_bool(),
        spindle_sos: source.any_bool(),
        ungrouped: source.any_bool(),
    };
    Some((availability::State::INITIAL, availability::Config, inputs))
}

/// Any step of the functions with the door open.
pub fn allowed_functions<S: Source>(
    source: &mut S,
) -> Option<(
    allowed_functions::State,
    allowed_functions::Config,
    allowed_functions::Inputs,
)> {
    let inputs = allowed_functions::Inputs {
        door_open: source.any_bool(),
        permissive: source.any_bool(),
        function: source.any_of(&allowed_functions::Function::ALL),
    };
    Some((
        allowed_functions::State::INITIAL,
        allowed_functions::Config,
        inputs,
    ))
}

/// Any step of the soft key F LIMITED.
pub fn f_limited<S: Source>(
    source: &mut S,
) -> Option<(f_limited::State, f_limited::Config, f_limited::Inputs)> {
    let limits = [source.any_speed(), source.any_speed(), source.any_speed()];
    let config = f_limited::Config::new(limits).ok()?;
    let inputs = f_limited::Inputs {
        pressed: source.any_bool(),
        som: source.any_of(&Som::ALL),
        wanted: source.any_speed(),
    };
    Some((f_limited::State::INITIAL, config, inputs))
}

/// Any step of the motion of a group.
pub fn group_motion<S: Source>(
    source: &mut S,
) -> Option<(
    group_motion::State,
    group_motion::Config,
    group_motion::Inputs,
)> {
    let inputs = group_motion::Inputs {
        axes: axes(source, 254),
    };
    Some((group_motion::State::INITIAL, group_motion::Config, inputs))
}

/// Any step of a safe output.
pub fn safe_output<S: Source>(
    source: &mut S,
) -> Option<(safe_output::State, safe_output::Config, safe_output::Inputs)> {
    let config = safe_output::Config::new(source.any_bool()).ok()?;
    let inputs = safe_output::Inputs {
        wanted: source.any_bool(),
        enabled: source.any_bool(),
    };
    Some((safe_output::State::INITIAL, config, inputs))
}
