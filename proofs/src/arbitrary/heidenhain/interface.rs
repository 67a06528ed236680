//! What the kernel takes over from the safe PLC.

use stillpoint_monitors::heidenhain::types::{GroupState, Som, Stop};
use stillpoint_monitors::heidenhain::{
    both_channels, both_fields, both_status, gate, general_fields,
};

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

/// Any general fields as a kernel has taken them over; an unknown number has no other effect on what is compared than its stop.
fn fields<S: Source>(source: &mut S) -> general_fields::Outputs {
    general_fields::Outputs {
        stop: source.any_of(&[Stop::None, Stop::Ss1F]),
        som: source.any_of(&Som::ALL),
        voltage: source.any_bool(),
        drives: source.any_bool(),
        chain: source.any_bool(),
        keys: source.any_bool(),
        brakes: source.any_bool(),
        feed: source.any_bool(),
    }
}

/// Any step of the joining of the general fields.
pub fn both_fields<S: Source>(
    source: &mut S,
) -> Option<(both_fields::State, both_fields::Config, both_fields::Inputs)> {
    let inputs = both_fields::Inputs {
        mc: fields(source),
        cc: fields(source),
    };
    Some((both_fields::State::INITIAL, both_fields::Config, inputs))
}

/// Any status of a channel: no output, all, and each of the first two alone.
fn status<S: Source>(source: &mut S) -> both_status::Status {
    both_status::Status {
        executed: source.any_bool(),
        runtime: source.any_bool(),
        outputs: source.any_u32(3, u32::from(u16::MAX)) as u16,
    }
}

/// Any step of the comparison of programs, run-time systems and outputs.
pub fn both_status<S: Source>(
    source: &mut S,
) -> Option<(both_status::State, both_status::Config, both_status::Inputs)> {
    let inputs = both_status::Inputs {
        mc: status(source),
        cc: status(source),
    };
    Some((both_status::State::INITIAL, both_status::Config, inputs))
}
