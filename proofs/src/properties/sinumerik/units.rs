//! The conversions: none is less restrictive than the exact value.

use core::num::NonZeroU32;

use stillpoint_monitors::kernel::{Percent, Position, Speed};
use stillpoint_monitors::sinumerik::encoder::{Encoder, LimitFrequency, Mounting};
#[cfg(kani)]
use stillpoint_monitors::sinumerik::selection;
use stillpoint_monitors::sinumerik::selection::{Monitored, Stage};
use stillpoint_monitors::sinumerik::{motion, speed};
use stillpoint_monitors::units::{
    Axis, LONGEST_CYCLE_US, ModuloRange, Scale, distance_down, position_down, position_up,
};

use super::Subject;
use crate::source::{Source, Verdict};

/// Any number that is not 0; Kani takes those of a few bits.
fn positive<S: Source>(source: &mut S, reach: u32, highest: u32, bits: u32) -> Option<NonZeroU32> {
    NonZeroU32::new(cut(source, reach, highest - 1, bits) + 1)
}

/// A number that is cut to some bits where domains are narrow. For Kani the mask changes nothing but the size of the formula:
/// bits that are known to be 0 make no divider.
fn cut<S: Source>(source: &mut S, reach: u32, highest: u32, bits: u32) -> u32 {
    let number = source.any_cut(reach, highest, bits);
    if source.leaves_out() {
        number & ((1 << bits) - 1)
    } else {
        number
    }
}

/// In the place of the encoder's greatest common divisor, for Kani: ratios are not brought into lowest terms. A division of
/// 128 bits by a divisor that is found in a loop is too much for it.
#[cfg(kani)]
pub(crate) fn no_common_divisor(_: u128, _: u128) -> u128 {
    1
}

/// In the place of the factor of a choice, for Kani, where no override is configured: the whole. The list of the factors is then
/// no part of the formula.
#[cfg(kani)]
pub(crate) fn no_factor(config: &selection::Config, _: selection::Choice) -> Percent {
    use selection::FactorIndex;
    let first = FactorIndex::from_bits(false, false, false, true);
    assert!(config.choice(Stage::Sg2, first).factor == FactorIndex::NONE);
    Percent::WHOLE
}

/// Divisions by their definition, for Kani: a quotient and a rest of which the product and the sum are the dividend. A divider of
/// 64 bits, which is what a division in the source becomes, is the same with numbers of 64 bits.
#[cfg(kani)]
pub(crate) mod by_definition {
    use core::sync::atomic::{AtomicI64, Ordering};

    /// The whole number of divisors that the last division has taken away.
    static TAKEN: AtomicI64 = AtomicI64::new(0);

    /// The whole number of divisors that the last division has taken away.
    pub(crate) fn taken() -> i64 {
        TAKEN.load(Ordering::Relaxed)
    }

    /// `i64::checked_rem_euclid` of a difference of two positions and a width.
    pub(crate) fn rem_euclid(number: i64, divisor: i64) -> Option<i64> {
        // No quotient is then greater than 33 bits, and no product than 66.
        assert!(-(1 << 32) < number && number < 1 << 32);
        assert!(0 <= divisor && divisor < 1 << 32);
        if divisor == 0 {
            return None;
        }
        let (quotient, rest): (i64, u32) = (kani::any(), kani::any());
        let rest = i64::from(rest);
        kani::assume(-(1 << 32) < quotient && quotient < 1 << 32);
        kani::assume(rest < divisor);
        let taken = number - rest;
        kani::assume(i128::from(divisor as u32) * i128::from(quotient) == i128::from(taken));
        TAKEN.store(taken, Ordering::Relaxed);
        Some(rest)
    }

    /// `i64::checked_div_euclid` of numbers of at most 31 bits.
    pub(crate) fn div_euclid(number: i64, divisor: i64) -> Option<i64> {
        assert!(-(1 << 30) < number && number < 1 << 30);
        assert!(0 < divisor && divisor < 1 << 16);
        let quotient: i32 = kani::any();
        let rest: u16 = kani::any();
        let divisor = divisor as u16;
        kani::assume(rest < divisor);
        kani::assume(i64::from(divisor) * i64::from(quotient) + i64::from(rest) == number);
        Some(i64::from(quotient))
    }

    /// The encoder's quotient of numbers of at most 64 bits.
    pub(crate) fn quotient(number: u128, divisor: u128) -> u128 {
        assert!(number < 1 << 60);
        assert!(0 < divisor && divisor < 1 << 31);
        let quotient: u32 = kani::any();
        let rest: u32 = kani::any();
        let divisor = divisor as u32;
        // A quotient of more than 32 bits would be another one.
        assert!(number < u128::from(divisor) << 32);
        kani::assume(rest < divisor);
        kani::assume(u64::from(divisor) * u64::from(quotient) + u64::from(rest) == number as u64);
        u128::from(quotient)
    }
}

/// Either kind of axis, a part of the domain each.
fn any_axis<S: Source>(source: &mut S) -> Axis {
    match source.any_part(2) {
        0 => source.any_of(&[Axis::Linear, Axis::Rotary]),
        1 => Axis::Linear,
        _ => Axis::Rotary,
    }
}

/// Any monitoring cycle; the enumeration takes the longest ones and the shortest.
fn cycle<S: Source>(source: &mut S, reach: u32) -> Option<NonZeroU32> {
    NonZeroU32::new(LONGEST_CYCLE_US - source.any_u32(reach, LONGEST_CYCLE_US - 1))
}

/// Increments of a millimetre or a revolution.
const fn increments(axis: Axis) -> u64 {
    match axis {
        Axis::Linear => 1_000,
        Axis::Rotary => 360_000,
    }
}

/// Increments per cycle are thousandths of mm/min or rev/min, times the microseconds of a cycle, times this fraction: a
/// thousandth of the increments of the unit, over the microseconds of a minute times a thousand. In lowest terms, so that
/// the numbers stay small.
const fn per_cycle(axis: Axis) -> (u64, u64) {
    let (mut numerator, mut denominator) = (increments(axis), 60_000_000 * 1_000);
    let mut prime = 2;
    while prime <= 5 {
        while numerator % prime == 0 && denominator % prime == 0 {
            numerator /= prime;
            denominator /= prime;
        }
        prime += 1;
    }
    (numerator, denominator)
}

/// The fractions of both axes, calculated by the compiler.
const LINEAR: (u64, u64) = per_cycle(Axis::Linear);
const ROTARY: (u64, u64) = per_cycle(Axis::Rotary);

/// Whether `converted` is `numerator / denominator` rounded down; the denominator has at most 31 bits.
fn rounded_down(converted: u32, numerator: u64, denominator: u64) -> bool {
    let scaled = u64::from(converted) * denominator;
    scaled <= numerator && numerator - scaled < denominator
}

/// [`rounded_down`] for larger numbers.
fn rounded_down_wide(converted: u32, numerator: u128, denominator: u128) -> bool {
    let scaled = u128::from(converted) * denominator;
    scaled <= numerator && numerator - scaled < denominator
}

/// A speed in thousandths of mm/min or rev/min is the exact number of increments per cycle rounded down: never more.
///
/// Cover 0: something is rounded off, cover 1: nothing is.
pub fn speed_rounds_down<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    // One after the other, so that Kani divides by constants.
    match any_axis(source) {
        Axis::Linear => speed_of_axis_rounds_down(source, Axis::Linear, LINEAR, 13),
        Axis::Rotary => speed_of_axis_rounds_down(source, Axis::Rotary, ROTARY, 9),
    }
}

fn speed_of_axis_rounds_down<S: Source>(
    source: &mut S,
    axis: Axis,
    (numerator, denominator): (u64, u64),
    bits: u32,
) -> Verdict {
    let Some(cycle_us) = cycle(source, 12) else {
        return Verdict::Discarded;
    };
    // Thousandths, in steps of 200 in the enumeration: speeds of 0 to 40.
    let value = u64::from(source.any_cut(200, 20_000_000, bits)) * 200;
    let Ok(scale) = Scale::new(axis, cycle_us) else {
        return Verdict::Broken("permitted_cycle_is_accepted");
    };
    let Ok(converted) = scale.speed_from_thousandths(value) else {
        return Verdict::Discarded;
    };
    // Numbers of 32, 15 and 2 bits.
    let exact = value * (u64::from(cycle_us.get()) * numerator);
    let inexact = u64::from(converted.0) * denominator != exact;
    source.cover(0, inexact);
    source.cover(1, !inexact && exact > 0);
    if rounded_down(converted.0, exact, denominator) {
        Verdict::Held
    } else {
        Verdict::Broken("speed_rounds_down")
    }
}

/// The rule of the manual: a movement of more than the limit times the cycle is a violation, whole increments compared
/// with the limit rounded down give exactly the comparison with the exact limit.
///
/// Cover 0: a violation, cover 1: the largest movement that is none.
pub fn movement_is_compared_exactly<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    match any_axis(source) {
        Axis::Linear => {
            movement_of_axis_is_compared_exactly(source, subject, Axis::Linear, LINEAR, 11)
        }
        Axis::Rotary => {
            movement_of_axis_is_compared_exactly(source, subject, Axis::Rotary, ROTARY, 6)
        }
    }
}

fn movement_of_axis_is_compared_exactly<S: Source>(
    source: &mut S,
    subject: &Subject,
    axis: Axis,
    (numerator, denominator): (u64, u64),
    bits: u32,
) -> Verdict {
    let per_minute = source.any_cut(24, 60_000, bits);
    let Some(cycle_us) = cycle(source, 8) else {
        return Verdict::Discarded;
    };
    let Ok(limit) = Scale::new(axis, cycle_us).and_then(|scale| scale.speed(per_minute)) else {
        return Verdict::Discarded;
    };
    let Ok(config) = speed::Config::new(2, [0; 4], None) else {
        return Verdict::Discarded;
    };
    let from = Position(source.any_i32(1));
    let forward = source.any_bool();
    let other = i64::from(source.any_i32(1));
    let to = if source.enumerates() {
        // Movements around the limit, and large ones.
        let moved = i64::from(limit.0) + other % 1_000_000;
        i64::from(from.0) + if forward { moved } else { -moved }
    } else if forward {
        i64::from(from.0) + i64::from(limit.0) + other
    } else {
        other
    };
    let Ok(to) = i32::try_from(to) else {
        return Verdict::Discarded;
    };
    let state = motion::State {
        last: from,
        known: true,
        speed: Speed(0),
    };
    let inputs = motion::Inputs {
        position: Position(to),
        ..motion::Inputs::default()
    };
    let (_, actual) = subject.motion(state, &motion::Config, &inputs);
    let inputs = speed::Inputs {
        monitored: Monitored::Speed,
        speed: actual.speed,
        limit,
        stage: Stage::Sg1,
        encoder_speed: Speed(0),
    };
    let (_, outputs) = subject.speed(speed::State, &config, &inputs);
    // Numbers of 26, 15 and 2 bits, and of 32 and 26.
    let permitted = u64::from(per_minute) * 1_000 * (u64::from(cycle_us.get()) * numerator);
    let beyond = u64::from(from.0.abs_diff(to)) * denominator > permitted;
    source.cover(0, beyond);
    source.cover(1, actual.speed == limit && limit > Speed(0));
    if outputs.violated == beyond {
        Verdict::Held
    } else {
        Verdict::Broken("movement_is_compared_exactly")
    }
}

/// A part of a limit in percent is rounded down.
///
/// Cover 0: something is rounded off.
pub fn factor_rounds_down<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let limit = Speed(source.any_u32(120, u32::MAX));
    let percent = source.any_in(0, 100);
    let Ok(factor) = Percent::new(percent as u8) else {
        return Verdict::Broken("permitted_factor_is_accepted");
    };
    let exact = u64::from(limit.0) * u64::from(percent);
    let reduced = limit.reduced(factor).0;
    source.cover(0, u64::from(reduced) * 100 != exact);
    if rounded_down(reduced, exact, 100) {
        Verdict::Held
    } else {
        Verdict::Broken("factor_rounds_down")
    }
}

/// Tolerances and upper limits are rounded down, lower limits up: the permitted range never grows.
///
/// Cover 0: below zero and not a whole increment.
pub fn limits_round_inwards<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let thousandths = i64::from(source.any_cut_i32(3_000, 16));
    let (Ok(upper), Ok(lower)) = (position_down(thousandths), position_up(thousandths)) else {
        return Verdict::Broken("small_position_is_accepted");
    };
    let (above, below) = (i64::from(upper.0) * 1000, i64::from(lower.0) * 1000);
    source.cover(0, thousandths < 0 && above != thousandths);
    let magnitude = thousandths.unsigned_abs();
    let Ok(tolerance) = distance_down(magnitude) else {
        return Verdict::Broken("small_distance_is_accepted");
    };
    if above <= thousandths
        && thousandths < above + 1000
        && below >= thousandths
        && thousandths > below - 1000
        && rounded_down(tolerance.0, magnitude, 1000)
    {
        Verdict::Held
    } else {
        Verdict::Broken("limits_round_inwards")
    }
}

/// A folded position is in the range, a whole number of ranges away; one in the range is left alone.
///
/// Cover 0: folded down, cover 1: folded up, cover 2: no range.
pub fn folding_keeps_the_position<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let (lower, upper) = (source.any_i32(3), source.any_i32(3));
    let position = source.any_i32(9);
    let Ok(range) = ModuloRange::new(Position(lower), Position(upper)) else {
        return Verdict::Discarded;
    };
    let folded = range.folded(Position(position)).0;
    let away = i64::from(position) - i64::from(folded);
    source.cover(0, away > 0);
    source.cover(1, away < 0);
    source.cover(2, !range.folds());
    let right = if range.folds() {
        let width = i64::from(upper) - i64::from(lower);
        lower <= folded && folded < upper && is_multiple(away, width)
    } else {
        away == 0
    };
    if right {
        Verdict::Held
    } else {
        Verdict::Broken("folding_keeps_the_position")
    }
}

/// Whether a folded position is a whole number of widths away. For Kani that number is the one that the division has taken away.
#[cfg(kani)]
fn is_multiple(away: i64, _width: i64) -> bool {
    away == by_definition::taken()
}

/// Whether a folded position is a whole number of widths away.
#[cfg(not(kani))]
fn is_multiple(away: i64, width: i64) -> bool {
    away % width == 0
}

/// The position of a rotary encoder is the exact one of S840D-ENC-006 rounded down, in both directions.
///
/// Cover 0: reversed, below zero and rounded.
pub fn encoder_position_rounds_down<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let (Some(pulses), Some(denom), Some(numera), Some(load), Some(subdivision)) = (
        positive(source, 2, 100_000, 4),
        positive(source, 2, 8_388_607, 3),
        positive(source, 1, 8_388_607, 3),
        positive(source, 3, 10_000_000, 4),
        positive(source, 0, 16_384, 3),
    ) else {
        return Verdict::Discarded;
    };
    let mounting = Mounting::Rotary {
        pulses,
        denom,
        numera,
        load,
    };
    let reversed = source.any_bool();
    let count = source.any_cut_i32(6, 10);
    let Ok(encoder) = Encoder::new(mounting, subdivision, reversed) else {
        return Verdict::Discarded;
    };
    let Some(position) = encoder.position(count) else {
        return Verdict::Discarded;
    };
    let signed = if reversed {
        -i128::from(count)
    } else {
        i128::from(count)
    };
    // The narrow factor first: Kani adds once for each of its bits.
    let exact = i128::from(denom.get()) * i128::from(load.get()) * signed;
    let counts =
        i128::from(pulses.get()) * i128::from(numera.get()) * i128::from(subdivision.get());
    let scaled = counts * i128::from(position.0);
    source.cover(0, reversed && exact < 0 && scaled < exact);
    if scaled <= exact && exact < scaled + counts {
        Verdict::Held
    } else {
        Verdict::Broken("encoder_position_rounds_down")
    }
}

/// The highest speed under the limit frequency of the encoder is the exact one rounded down, at the load and at the
/// encoder.
///
/// Cover 0: an extended limit frequency.
pub fn encoder_speed_rounds_down<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let hz = 300_000 + cut(source, 3, 120_000, 6);
    let Ok(frequency) = LimitFrequency::new(hz, true) else {
        return Verdict::Broken("permitted_frequency_is_accepted");
    };
    let cycle_us = if source.leaves_out() {
        // The short ones, so that the numbers stay small.
        positive(source, 0, LONGEST_CYCLE_US, 5)
    } else {
        cycle(source, 2)
    };
    let (Some(cycle_us), Some(pulses), Some(denom), Some(numera), Some(load), Some(subdivision)) = (
        cycle_us,
        positive(source, 2, 100_000, 3),
        positive(source, 1, 8_388_607, 2),
        positive(source, 2, 8_388_607, 2),
        positive(source, 2, 10_000_000, 3),
        positive(source, 1, 16_384, 2),
    ) else {
        return Verdict::Discarded;
    };
    let mounting = Mounting::Rotary {
        pulses,
        denom,
        numera,
        load,
    };
    let (Ok(at_encoder), Ok(encoder)) = (
        frequency.pulses_per_cycle(cycle_us),
        Encoder::new(mounting, subdivision, false),
    ) else {
        return Verdict::Discarded;
    };
    let Ok(at_load) = encoder.highest_speed(frequency, cycle_us) else {
        return Verdict::Discarded;
    };
    let micro_pulses = u128::from(hz) * u128::from(cycle_us.get());
    // Of counts, not of pulses: a factor on both sides, with which Kani finds the numbers of the monitor again.
    let subdivision = u128::from(subdivision.get());
    let increments = u128::from(denom.get()) * u128::from(load.get());
    let exact = micro_pulses * subdivision * increments;
    let counts = u128::from(pulses.get()) * u128::from(numera.get()) * subdivision;
    let divisor = 1_000_000 * counts;
    source.cover(0, hz > LimitFrequency::STANDARD.hz());
    if rounded_down_wide(at_load.0, exact, divisor)
        && rounded_down_wide(at_encoder.0, micro_pulses, 1_000_000)
    {
        Verdict::Held
    } else {
        Verdict::Broken("encoder_speed_rounds_down")
    }
}
