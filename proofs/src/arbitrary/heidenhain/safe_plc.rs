//! Blocks of the safe PLC.

use stillpoint_monitors::heidenhain::axes_logic;
use stillpoint_monitors::heidenhain::types::{GroupState, Som, Unit};

use crate::source::Source;

/// Any step of the logic of the axes. By hand, since all inputs together are too many to enumerate: the enumeration takes the keys
/// in one part, in the other the events that stop and the parameters.
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
        keys: if keys_move {
            source.any_u32(1, u32::from(u8::MAX)) as u8
        } else {
            0
        },
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
