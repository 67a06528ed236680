//! Runs of the monitors of position and speed.

use stillpoint_monitors::heidenhain::speed;
use stillpoint_monitors::heidenhain::types::GroupState;
use stillpoint_monitors::kernel::Speed;

use super::Subject;
use crate::arbitrary::heidenhain::HIGHEST_LIMIT;
use crate::source::{Source, Verdict};

/// The limit of a mode and its margin of 5 %: a speed is a violation exactly if it is above the exact value.
///
/// Cover 0: above the limit and within the margin, cover 1: a violation.
pub fn margin_is_exact<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let limit = source.any_u32(45, HIGHEST_LIMIT);
    let limits = speed::Limits {
        som_2: Speed(limit),
        ..speed::Limits::default()
    };
    let Ok(config) = speed::Config::new(limits, false) else {
        return Verdict::Broken("highest_limit_is_accepted");
    };
    let actual = source.any_u32(50, u32::MAX);
    let inputs = speed::Inputs {
        state: GroupState::Sls2,
        speed: Speed(actual),
        ..speed::Inputs::default()
    };
    let (_, outputs) = subject.speed(speed::State::INITIAL, &config, &inputs);
    // Numbers of 32 and 7 bits.
    let beyond = u64::from(actual) * 100 > u64::from(limit) * 105;
    source.cover(0, actual > limit && !beyond);
    source.cover(1, beyond);
    if outputs.violated == beyond {
        Verdict::Held
    } else {
        Verdict::Broken("margin_is_exact")
    }
}
