//! What the kernel takes over from the safe PLC.

use stillpoint_monitors::heidenhain::types::{GroupState, Stop};
use stillpoint_monitors::heidenhain::{both_channels, gate};

use super::kind;
use crate::source::Source;

/// Any fields of the interface: every code, and for the others one beyond them and the highest number.
pub fn gate_inputs<S: Source>(source: &mut S) -> gate::Inputs {
    gate::Inputs {
        state_code: source.any_u32(8, u32::from(u8::MAX)) as u8,
        stop_code: source.any_u32(5, u32::from(u8::MAX)) as u8,
        som_code: source.any_u32(4, u32::from(u8::MAX)) as u8,
        activate: source.any_bool(),
        permissive: source.any_bool(),
    }
}

/// Any step of the take-over.
pub fn gate<S: Source>(source: &mut S) -> Option<(gate::State, gate::Config, gate::Inputs)> {
    let config = gate::Config::new(kind(source)).ok()?;
    Some((gate::State::INITIAL, config, gate_inputs(source)))
}

/// Any step of the joining.
pub fn both_channels<S: Source>(
    source: &mut S,
) -> Option<(
    both_channels::State,
    both_channels::Config,
    both_channels::Inputs,
)> {
    let config = both_channels::Config::new().ok()?;
    let inputs = both_channels::Inputs {
        request_mc: source.any_of(&GroupState::ALL),
        request_cc: source.any_of(&GroupState::ALL),
        stop_mc: source.any_of(&Stop::ALL),
        stop_cc: source.any_of(&Stop::ALL),
        starts_mc: source.any_bool(),
        starts_cc: source.any_bool(),
        held_mc: source.any_bool(),
        held_cc: source.any_bool(),
        late: source.any_bool(),
    };
    Some((both_channels::State::INITIAL, config, inputs))
}
