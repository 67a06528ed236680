//! From the values a user enters to increments and increments per cycle.
//!
//! One increment is one micrometre of a linear axis or one thousandth of a degree of a rotary axis. Every conversion says
//! to which side it rounds. Limits, tolerances and thresholds of speed and distance round **down**: no converted value
//! permits more than the exact one. The one exception says so ([`Scale::way_up`]). For one comparison `value > limit` of whole
//! increments that is the same as the exact limit: a whole number is above it exactly when it is above the limit rounded
//! down. Over many cycles it is stricter: an axis that is no faster than the exact limit may in one cycle go a whole increment
//! more than the limit rounded down, and what is made of a rounded value (an override, a ramp) is rounded again.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Distance, Position, Speed};

/// Longest monitoring cycle in microseconds (S840D-TIMING-511).
pub const LONGEST_CYCLE_US: u32 = 25_000;

/// The kind of an axis: what its speeds are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Speeds in mm/min.
    #[default]
    Linear,
    /// Speeds in revolutions per minute.
    Rotary,
}

/// The scale of the speeds of an axis: its kind and the monitoring cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    axis: Axis,
    cycle_us: NonZeroU32,
}

impl Scale {
    /// `cycle_us`: the monitoring cycle T_SI in microseconds.
    ///
    /// # Errors
    /// [`ConfigError::CycleTooLong`] above [`LONGEST_CYCLE_US`]: the cycle determines the overshoot over each limit.
    pub const fn new(axis: Axis, cycle_us: NonZeroU32) -> Result<Self, ConfigError> {
        if cycle_us.get() <= LONGEST_CYCLE_US {
            Ok(Self { axis, cycle_us })
        } else {
            Err(ConfigError::CycleTooLong)
        }
    }

    /// A speed in mm/min or rev/min as increments per cycle, rounded down (S840D-TIMING-512, S840D-KDV-711).
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
    pub const fn speed(self, per_minute: u32) -> Result<Speed, ConfigError> {
        // A value of 32 bits times a thousand fits 64 bits.
        self.speed_from_thousandths(per_minute as u64 * 1000)
    }

    /// A speed in thousandths of mm/min or rev/min as increments per cycle, rounded down: for values with decimals.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits, or the calculation more than 64.
    pub const fn speed_from_thousandths(self, per_minute: u64) -> Result<Speed, ConfigError> {
        let (numerator, denominator) = self.ratio();
        match per_minute.checked_mul(self.cycle_us.get() as u64 * numerator) {
            Some(product) => match narrow(product / denominator) {
                Ok(increments) => Ok(Speed(increments)),
                Err(error) => Err(error),
            },
            None => Err(ConfigError::ValueTooLarge),
        }
    }

    /// The way at a speed in thousandths of mm/min or rev/min in a number of cycles, rounded **up**: a way that somebody who is
    /// no faster does not exceed.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
    pub const fn way_up(self, per_minute: u32, cycles: u32) -> Result<Distance, ConfigError> {
        let (numerator, denominator) = self.ratio();
        // Numbers of 32, 15, 2 and 32 bits.
        let product =
            per_minute as u128 * self.cycle_us.get() as u128 * numerator as u128 * cycles as u128;
        let increments = product.div_ceil(denominator as u128);
        if increments > u32::MAX as u128 {
            Err(ConfigError::ValueTooLarge)
        } else {
            Ok(Distance(increments as u32))
        }
    }

    /// Increments per unit * microseconds / (60e6 us * 1000), in lowest terms: 1e3 or 360e3 over 60e9.
    const fn ratio(self) -> (u64, u64) {
        match self.axis {
            Axis::Linear => (1, 60_000_000),
            Axis::Rotary => (3, 500_000),
        }
    }
}

/// A distance or tolerance in thousandths of an increment (nanometres, millionths of a degree), rounded down.
///
/// # Errors
/// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
pub const fn distance_down(thousandths: u64) -> Result<Distance, ConfigError> {
    match narrow(thousandths / 1000) {
        Ok(increments) => Ok(Distance(increments)),
        Err(error) => Err(error),
    }
}

/// A position in thousandths of an increment, rounded towards minus infinity: for upper limits and cams, where "beyond" is
/// "greater than".
///
/// # Errors
/// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
pub const fn position_down(thousandths: i64) -> Result<Position, ConfigError> {
    let increments = thousandths.div_euclid(1000);
    if increments < i32::MIN as i64 || increments > i32::MAX as i64 {
        Err(ConfigError::ValueTooLarge)
    } else {
        Ok(Position(increments as i32))
    }
}

/// A position in thousandths of an increment, rounded towards plus infinity: for lower limits, where "beyond" is "less
/// than".
///
/// # Errors
/// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
pub const fn position_up(thousandths: i64) -> Result<Position, ConfigError> {
    match thousandths.checked_add(999) {
        Some(sum) => position_down(sum),
        None => Err(ConfigError::ValueTooLarge),
    }
}

pub(crate) const fn narrow(value: u64) -> Result<u32, ConfigError> {
    if value > u32::MAX as u64 {
        Err(ConfigError::ValueTooLarge)
    } else {
        Ok(value as u32)
    }
}

fields! {
    /// The range of positions in which the cams of an endlessly turning axis are calculated: `lower` up to, not including,
    /// `upper`.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct ModuloRange {
        lower: Position,
        upper: Position,
    }
}

impl ModuloRange {
    /// No folding: linear axes.
    pub const LINEAR: Self = Self {
        lower: Position(0),
        upper: Position(0),
    };

    /// 2048 revolutions in millidegrees: the range of the value 0.
    const REVOLUTIONS_2048: i32 = 737_280_000;

    /// Positions from `lower` up to `upper`, excluding it; equal limits mean no folding.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when `lower` is above `upper`.
    pub const fn new(lower: Position, upper: Position) -> Result<Self, ConfigError> {
        if lower.0 <= upper.0 {
            Ok(Self { lower, upper })
        } else {
            Err(ConfigError::LimitsCrossed)
        }
    }

    /// The range of a rotary axis (`SAFE_MODULO_RANGE`, 36905 / 1305): 0 for 2048 revolutions in both directions, else a
    /// multiple of 360 degrees, counted from 0 (S840D-SN-011).
    ///
    /// # Errors
    /// [`ConfigError::ModuloRangeUneven`] for any other value.
    pub const fn from_degrees(degrees: u32) -> Result<Self, ConfigError> {
        if degrees == 0 {
            Ok(Self {
                lower: Position(-Self::REVOLUTIONS_2048),
                upper: Position(Self::REVOLUTIONS_2048),
            })
        } else if degrees % 360 == 0 && degrees <= 737_280 {
            Ok(Self {
                lower: Position(0),
                upper: Position(degrees as i32 * 1000),
            })
        } else {
            Err(ConfigError::ModuloRangeUneven)
        }
    }

    /// The lowest position.
    pub const fn lower(self) -> Position {
        self.lower
    }

    /// The end, the first position that is folded down.
    pub const fn upper(self) -> Position {
        self.upper
    }

    /// Whether positions are folded at all.
    pub const fn folds(self) -> bool {
        self.lower.0 < self.upper.0
    }

    /// The position in the range that is a whole number of ranges away; the position itself without folding.
    pub const fn folded(self, position: Position) -> Position {
        let lower = self.lower.0 as i64;
        let width = self.upper.0 as i64 - lower;
        match (position.0 as i64 - lower).checked_rem_euclid(width) {
            // From 0 to the width, excluding it, so the sum is in the range and fits.
            Some(offset) => Position((lower + offset) as i32),
            None => position,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(axis: Axis, cycle_us: u32) -> Scale {
        Scale::new(axis, NonZeroU32::new(cycle_us).expect("not zero")).expect("short enough")
    }

    #[test]
    fn the_example_of_the_manual() {
        // SG1 = 2000 mm/min in a cycle of 12 ms is 0.4 mm per cycle.
        assert_eq!(scale(Axis::Linear, 12_000).speed(2000), Ok(Speed(400)));
        assert_eq!(
            scale(Axis::Linear, 12_000).speed_from_thousandths(4_999),
            Ok(Speed(0))
        );
        // One revolution per minute is 6 degrees per second.
        assert_eq!(scale(Axis::Rotary, 12_000).speed(1), Ok(Speed(72)));
        assert_eq!(
            scale(Axis::Rotary, 25_000).speed(u32::MAX),
            Err(ConfigError::ValueTooLarge)
        );
        let cycle = NonZeroU32::new(LONGEST_CYCLE_US + 1).expect("not zero");
        assert_eq!(
            Scale::new(Axis::Linear, cycle),
            Err(ConfigError::CycleTooLong)
        );
    }

    #[test]
    fn positions_round_to_the_named_side() {
        assert_eq!(position_down(1_999), Ok(Position(1)));
        assert_eq!(position_down(-1), Ok(Position(-1)));
        assert_eq!(position_up(1), Ok(Position(1)));
        assert_eq!(position_up(-1_999), Ok(Position(-1)));
        assert_eq!(position_up(-2_000), Ok(Position(-2)));
        assert_eq!(position_up(i64::MAX), Err(ConfigError::ValueTooLarge));
        assert_eq!(position_down(i64::MIN), Err(ConfigError::ValueTooLarge));
        assert_eq!(distance_down(1_999), Ok(Distance(1)));
    }

    #[test]
    fn ranges_of_the_machine_data() {
        let turn = ModuloRange::from_degrees(360).expect("a multiple");
        assert_eq!(turn.folded(Position(359_999)), Position(359_999));
        assert_eq!(turn.folded(Position(360_000)), Position(0));
        assert_eq!(turn.folded(Position(-1)), Position(359_999));
        let wide = ModuloRange::from_degrees(0).expect("2048 revolutions");
        assert_eq!(wide.folded(Position(737_279_999)), Position(737_279_999));
        assert_eq!(wide.folded(Position(737_280_000)), Position(-737_280_000));
        assert_eq!(
            ModuloRange::LINEAR.folded(Position(i32::MIN)),
            Position(i32::MIN)
        );
        for uneven in [1, 361, 737_281, 737_640, u32::MAX] {
            assert_eq!(
                ModuloRange::from_degrees(uneven),
                Err(ConfigError::ModuloRangeUneven)
            );
        }
    }
}
