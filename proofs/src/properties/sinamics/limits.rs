//! Limits that are calculated.

use stillpoint_monitors::kernel::{Cycles, Speed};
use stillpoint_monitors::sinamics::sls::{self, Slsd};
use stillpoint_monitors::sinamics::types::Stop;

use super::Subject;
use crate::source::{Source, Verdict};

/// The number of 100 % in a telegram.
const WHOLE: u64 = 32_767;

/// The limit of level 1 that SLS takes from a telegram, where nothing delays it: the exact part, rounded down. A limit of the whole width
/// comes before, of which nothing is asserted but that it is calculated without overflow.
///
/// Cover 0: the whole limit, cover 1: a part that is rounded, cover 2: a limit that comes out as 0.
pub fn limit_of_the_telegram<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let value = source.any_u32(3, WHOLE as u32 - 1) as i16 + 1;
    let wide = Speed(source.any_u32(3, u32::MAX));
    if taken(value, wide, subject).is_none() {
        return Verdict::Broken("every_limit_is_monitored");
    }
    let highest = Speed(source.any_cut(6, u32::MAX, 10));
    let Some(limit) = taken(value, highest, subject) else {
        return Verdict::Broken("every_limit_is_monitored");
    };
    let exact = u64::from(highest.0) * value as u64;
    let parts = u64::from(limit.0) * WHOLE;
    source.cover(0, value as u64 == WHOLE && limit == highest);
    source.cover(1, parts < exact);
    source.cover(2, limit == Speed(0) && highest > Speed(0));
    if parts <= exact && exact < parts + WHOLE {
        Verdict::Held
    } else {
        Verdict::Broken("limit_is_the_exact_part")
    }
}

/// The limit that is monitored in the cycle of the selection.
fn taken(value: i16, highest: Speed, subject: &Subject) -> Option<Speed> {
    let made = sls::Config::new(
        [highest, Speed(0), Speed(0), Speed(0)],
        [Stop::A; 4],
        Cycles::ZERO,
        true,
        true,
        false,
        Slsd::Keep,
    );
    let inputs = sls::Inputs {
        selected: true,
        telegram: value,
        ..sls::Inputs::default()
    };
    let (_, outputs) = subject.sls(sls::State::INITIAL, &made.ok()?, &inputs);
    outputs.active.then_some(outputs.limit)
}
