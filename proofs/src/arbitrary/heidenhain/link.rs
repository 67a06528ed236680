//! Telegrams between controller computers.

use stillpoint_monitors::heidenhain::cc_link;
use stillpoint_monitors::kernel::Position;

use crate::source::Source;

/// Any drive.
fn drive<S: Source>(source: &mut S) -> cc_link::Drive {
    cc_link::Drive {
        moving: source.any_bool(),
        group: source.any_of(&[None, Some(0), Some(7)]),
        position: Position(source.any_i32(1)),
        brake_open: source.any_bool(),
        torque: source.any_bool(),
    }
}

/// Any step of the telegrams about a drive.
pub fn cc_link<S: Source>(
    source: &mut S,
) -> Option<(cc_link::State, cc_link::Config, cc_link::Inputs)> {
    let tolerated = source.any_in(0, u32::from(cc_link::Config::MOST));
    let config = cc_link::Config::new(u8::try_from(tolerated).ok()?).ok()?;
    let state = cc_link::State {
        faulty: u8::try_from(source.any_in(0, tolerated)).ok()?,
        last: drive(source),
        lost: source.any_bool(),
    };
    if !state.invariant(&config) {
        return None;
    }
    let main_switch = source.any_bool();
    let sound = source.any_bool();
    let inputs = cc_link::Inputs {
        main_switch,
        sound,
        // A telegram that is not sound says nothing.
        drive: if sound {
            drive(source)
        } else {
            cc_link::Drive::default()
        },
        fatal: source.any_bool(),
    };
    Some((state, config, inputs))
}
