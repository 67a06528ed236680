//! Safe machine parameters to increments and cycles: accepted in their range only, rounded to the earlier reaction.

use stillpoint_monitors::heidenhain::parameters;
use stillpoint_monitors::kernel::{ConfigError, Cycles, Speed};

use super::Subject;
use crate::source::{Source, Verdict};

/// A conversion of one parameter as numbers.
struct Conversion {
    /// The ends of the printed range.
    range: (u32, u32),
    /// The result.
    convert: fn(u32) -> Result<u32, ConfigError>,
    /// The exact value is the entered one times this, divided by the second number.
    factor: (u64, u64),
    /// Rounded up, else down.
    up: bool,
}

fn speed(result: Result<Speed, ConfigError>) -> Result<u32, ConfigError> {
    result.map(|speed| speed.0)
}

fn time(result: Result<Cycles, ConfigError>) -> Result<u32, ConfigError> {
    result.map(Cycles::count)
}

/// Every conversion that rounds or has a range.
const CONVERSIONS: [Conversion; 11] = [
    Conversion {
        range: (0, 2_000),
        convert: |v| speed(parameters::axis_limit(v, 2_000)),
        factor: (1, 2),
        up: false,
    },
    Conversion {
        range: (0, 5_000),
        convert: |v| speed(parameters::axis_limit(v, 5_000)),
        factor: (1, 2),
        up: false,
    },
    Conversion {
        range: (0, 6_000),
        convert: |v| speed(parameters::spindle_limit(v)),
        factor: (180, 1),
        up: false,
    },
    Conversion {
        range: (1, 30_000),
        convert: |v| parameters::standstill_path(v).map(|d| d.0),
        factor: (10, 1),
        up: false,
    },
    Conversion {
        range: (10, 1_000_000),
        convert: |v| parameters::stop_path(v).map(|d| d.0),
        factor: (1, 1),
        up: false,
    },
    Conversion {
        range: (0, 30_000),
        convert: |v| parameters::deviation(v).map(|d| d.0),
        factor: (10, 1),
        up: false,
    },
    Conversion {
        range: (0, 10_000),
        convert: |v| time(parameters::stop_time(v)),
        factor: (1, 3),
        up: false,
    },
    Conversion {
        range: (0, 10_000),
        convert: |v| time(parameters::brake_time(v)),
        factor: (1, 3),
        up: true,
    },
    Conversion {
        range: (1, 10_080),
        convert: |v| time(parameters::test_interval(v)),
        factor: (20_000, 1),
        up: false,
    },
    Conversion {
        range: (1, 18_000),
        convert: |v| time(parameters::permissive_time(v)),
        factor: (100, 3),
        up: false,
    },
    Conversion {
        range: (3, 60_000),
        convert: |v| time(parameters::window(v)),
        factor: (1, 3),
        up: false,
    },
];

/// A value in the printed range becomes the exact one rounded to the side of the earlier reaction; any other is refused.
///
/// Cover 0: accepted, cover 1: refused, cover 2: rounded down, cover 3: rounded up.
pub fn values_round_to_the_earlier_reaction<S: Source>(
    source: &mut S,
    _subject: &Subject,
) -> Verdict {
    let which = match source.any_part(CONVERSIONS.len() as u32) {
        0 => source.any_in(0, CONVERSIONS.len() as u32 - 1) as usize,
        part => part as usize - 1,
    };
    // One after the other, so that Kani divides by constants.
    for (place, conversion) in CONVERSIONS.iter().enumerate() {
        if place == which {
            return rounds_to_the_earlier_reaction(source, conversion);
        }
    }
    Verdict::Discarded
}

fn rounds_to_the_earlier_reaction<S: Source>(source: &mut S, conversion: &Conversion) -> Verdict {
    let (low, high) = conversion.range;
    // Kani takes every value with the first one: the others would be in its formula beside it.
    let values = if source.leaves_out() { 0 } else { 2 };
    let value = match source.any_in(0, values) {
        0 => source.any_u32(40, u32::MAX),
        1 => source.any_in(low, low + 4) - low.min(1),
        _ => source.any_in(high - 4, high + 2),
    };
    let result = (conversion.convert)(value);
    let (numerator, denominator) = conversion.factor;
    let product = u64::from(value) * numerator;
    let accepted = low <= value && value <= high;
    let scaled = result.map(|converted| u64::from(converted) * denominator);
    let inexact = scaled != Ok(product);
    source.cover(0, accepted);
    source.cover(1, !accepted);
    source.cover(2, accepted && inexact && !conversion.up);
    source.cover(3, accepted && inexact && conversion.up);
    let right = match scaled {
        Ok(scaled) if conversion.up => {
            accepted && product <= scaled && scaled - product < denominator
        }
        Ok(scaled) => accepted && scaled <= product && product - scaled < denominator,
        // No accepted value is too large for the result.
        Err(error) => !accepted && error == ConfigError::ValueOutOfRange,
    };
    if right {
        Verdict::Held
    } else {
        Verdict::Broken("value_rounds_to_the_earlier_reaction")
    }
}
