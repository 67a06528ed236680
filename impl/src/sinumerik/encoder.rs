//! The position of the load from the counter of an encoder, and the speed the encoder limit frequency permits.
//!
//! The position of the load is the count times a fixed ratio of increments per count (S840D-ENC-006). The ratio is held in
//! lowest terms in 32 bits each, so that a position is one multiplication and one division of 64-bit integers.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Position, Speed};
use crate::units::narrow;

/// Increments of a revolution of a rotary axis: thousandths of a degree.
pub const REVOLUTION: NonZeroU32 = match NonZeroU32::new(360_000) {
    Some(increments) => increments,
    None => NonZeroU32::MIN,
};

/// How an encoder is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mounting {
    /// A rotary encoder with a gear, in one of its stages, between encoder and load.
    Rotary {
        /// Pulses of one revolution of the encoder (`SAFE_ENC_RESOL`, 36918 / 1318).
        pulses: NonZeroU32,
        /// Revolutions of the load (`SAFE_ENC_GEAR_DENOM`, 36921 / 1321) ...
        denom: NonZeroU32,
        /// ... for this many revolutions of the encoder (`SAFE_ENC_GEAR_NUMERA`, 36922 / 1322).
        numera: NonZeroU32,
        /// Increments of one revolution of the load: [`REVOLUTION`] for a rotary axis, the pitch of the spindle in
        /// micrometres (`SAFE_ENC_GEAR_PITCH`, 36920 / 1320) for a linear one.
        load: NonZeroU32,
    },
    /// A linear encoder at the load.
    Linear {
        /// The distance of two lines of the grid in nanometres (`SAFE_ENC_GRID_POINT_DIST`, 36917 / 1317).
        grid_nm: NonZeroU32,
    },
}

/// An encoder limit frequency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LimitFrequency(u32);

impl LimitFrequency {
    /// 300 kHz: the standard value, and the only one of control modules without an extended range.
    pub const STANDARD: Self = Self(300_000);

    /// `hz`: the frequency (`SAFE_ENC_FREQ_LIMIT`, 36926 / 1326). `extended`: the control module permits more than
    /// 300 kHz (Performance 2, High Standard, High Performance).
    ///
    /// # Errors
    /// [`ConfigError::FrequencyOutOfRange`] outside 300 to 420 kHz, and for any other than 300 kHz without extended range
    /// (S840D-FREQ-003).
    pub const fn new(hz: u32, extended: bool) -> Result<Self, ConfigError> {
        if hz == Self::STANDARD.0 || (extended && hz > Self::STANDARD.0 && hz <= 420_000) {
            Ok(Self(hz))
        } else {
            Err(ConfigError::FrequencyOutOfRange)
        }
    }

    /// The frequency in Hz.
    pub const fn hz(self) -> u32 {
        self.0
    }

    /// The highest speed of an encoder in revolutions per minute, rounded down (S840D-FREQ-002).
    pub const fn revolutions_per_minute(self, pulses: NonZeroU32) -> u32 {
        // At most 420000 * 60.
        self.0 * 60 / pulses.get()
    }

    /// The highest speed in pulses of the encoder per cycle of `cycle_us` microseconds, rounded down: the same in every
    /// gear stage.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
    pub const fn pulses_per_cycle(self, cycle_us: NonZeroU32) -> Result<Speed, ConfigError> {
        match narrow(self.0 as u64 * cycle_us.get() as u64 / 1_000_000) {
            Ok(pulses) => Ok(Speed(pulses)),
            Err(error) => Err(error),
        }
    }
}

/// An encoder as mounted, in one gear stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoder {
    /// Increments per count, in lowest terms.
    numerator: u32,
    denominator: NonZeroU32,
    /// Counts of one pulse.
    subdivision: NonZeroU32,
    reversed: bool,
}

impl Encoder {
    /// `subdivision`: counts of one pulse (or line of the grid), 1 without fine interpolation. `reversed`: the sign of the
    /// count is inverted (`SAFE_ENC_POLARITY` = -1; 0 and 1 do not invert).
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the ratio of increments and counts, in lowest terms, needs more than 32 bits.
    pub const fn new(
        mounting: Mounting,
        subdivision: NonZeroU32,
        reversed: bool,
    ) -> Result<Self, ConfigError> {
        let (increments, counts) = match mounting {
            Mounting::Rotary {
                pulses,
                denom,
                numera,
                load,
            } => (
                denom.get() as u128 * load.get() as u128,
                pulses.get() as u128 * numera.get() as u128,
            ),
            Mounting::Linear { grid_nm } => (grid_nm.get() as u128, 1000),
        };
        // Products of three numbers of 32 bits fit 128 bits.
        let counts = counts * subdivision.get() as u128;
        let divisor = greatest_common_divisor(increments, counts);
        let (numerator, denominator) = (increments / divisor, counts / divisor);
        if numerator > u32::MAX as u128 || denominator > u32::MAX as u128 {
            return Err(ConfigError::ValueTooLarge);
        }
        match NonZeroU32::new(denominator as u32) {
            Some(denominator) => Ok(Self {
                numerator: numerator as u32,
                denominator,
                subdivision,
                reversed,
            }),
            None => Err(ConfigError::ValueTooLarge),
        }
    }

    /// Increments per count in lowest terms: numerator and denominator.
    pub const fn ratio(&self) -> (u32, NonZeroU32) {
        (self.numerator, self.denominator)
    }

    /// The position of the load at a count, rounded towards minus infinity; `None` when it needs more than 32 bits.
    ///
    /// The position is less than one increment below the exact one, in both directions of motion, so the distance of two
    /// positions differs from the exact one by less than one increment.
    pub const fn position(&self, count: i32) -> Option<Position> {
        let count = if self.reversed {
            -(count as i64)
        } else {
            count as i64
        };
        // At most 2^31 * (2^32 - 1), which fits; the divisor is positive, so the quotient is rounded down.
        let exact = self.numerator as i64 * count;
        match exact.checked_div_euclid(self.denominator.get() as i64) {
            Some(increments) if increments >= i32::MIN as i64 && increments <= i32::MAX as i64 => {
                Some(Position(increments as i32))
            }
            _ => None,
        }
    }

    /// The highest speed of the load that the limit frequency permits, in increments per cycle of `cycle_us`
    /// microseconds, rounded down (S840D-FREQ-001, S840D-FREQ-002): f * T pulses, each `subdivision` counts.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when the result needs more than 32 bits.
    pub const fn highest_speed(
        &self,
        limit: LimitFrequency,
        cycle_us: NonZeroU32,
    ) -> Result<Speed, ConfigError> {
        // Numbers of 19, 32, 32 and 32 bits.
        let product = limit.0 as u128
            * cycle_us.get() as u128
            * self.subdivision.get() as u128
            * self.numerator as u128;
        let increments = quotient(product, 1_000_000 * self.denominator.get() as u128);
        if increments > u32::MAX as u128 {
            Err(ConfigError::ValueTooLarge)
        } else {
            Ok(Speed(increments as u32))
        }
    }
}

/// A division of 128 bits, which the proofs replace by its definition; 0 for a divisor of 0.
const fn quotient(number: u128, divisor: u128) -> u128 {
    match number.checked_div(divisor) {
        Some(quotient) => quotient,
        None => 0,
    }
}

/// Euclid's algorithm; at least 1 where one of the numbers is.
const fn greatest_common_divisor(a: u128, b: u128) -> u128 {
    let (mut a, mut b) = (a, b);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n(value: u32) -> NonZeroU32 {
        NonZeroU32::new(value).expect("not zero")
    }

    #[test]
    fn the_table_of_the_manual_rounds_further_down() {
        // Table 5-21; its value for 512 pulses at 200 kHz is a misprint and not a limit that can be set.
        for (pulses, at_300, at_420) in [
            (2048, 8_700, 12_300),
            (1024, 17_400, 24_600),
            (512, 34_800, 49_200),
        ] {
            let standard = LimitFrequency::STANDARD.revolutions_per_minute(n(pulses));
            let highest = LimitFrequency::new(420_000, true)
                .expect("in range")
                .revolutions_per_minute(n(pulses));
            assert!((at_300..at_300 + 400).contains(&standard), "{standard}");
            assert!((at_420..at_420 + 400).contains(&highest), "{highest}");
        }
    }

    #[test]
    fn limit_frequencies_depend_on_the_module() {
        assert_eq!(
            LimitFrequency::new(300_000, false),
            Ok(LimitFrequency::STANDARD)
        );
        assert!(LimitFrequency::new(300_001, true).is_ok());
        for (hz, extended) in [
            (299_999, true),
            (420_001, true),
            (300_001, false),
            (0, false),
        ] {
            assert_eq!(
                LimitFrequency::new(hz, extended),
                Err(ConfigError::FrequencyOutOfRange)
            );
        }
    }

    #[test]
    fn a_spindle_of_ten_millimetres() {
        let encoder = |reversed| {
            Encoder::new(
                Mounting::Rotary {
                    pulses: n(2048),
                    denom: n(1),
                    numera: n(2),
                    load: n(10_000),
                },
                n(4),
                reversed,
            )
            .expect("small")
        };
        // Two revolutions of the encoder, 2048 pulses of 4 counts each, are one of the load: 10 mm.
        assert_eq!(
            encoder(false).position(2 * 2048 * 4),
            Some(Position(10_000))
        );
        assert_eq!(
            encoder(true).position(2 * 2048 * 4),
            Some(Position(-10_000))
        );
        assert_eq!(encoder(false).position(-1), Some(Position(-1)));
        assert_eq!(encoder(false).position(0), Some(Position(0)));
        // 300 kHz in 12 ms are 3600 pulses, 1.7578 revolutions of the encoder, 8.789 mm.
        assert_eq!(
            encoder(false).highest_speed(LimitFrequency::STANDARD, n(12_000)),
            Ok(Speed(8_789))
        );
        assert_eq!(
            LimitFrequency::STANDARD.pulses_per_cycle(n(12_000)),
            Ok(Speed(3_600))
        );
    }

    #[test]
    fn extreme_ratios_are_refused_and_extreme_counts_have_no_position() {
        let rotary = |pulses, denom| Mounting::Rotary {
            pulses: n(pulses),
            denom: n(denom),
            numera: n(1),
            load: REVOLUTION,
        };
        assert_eq!(
            Encoder::new(rotary(1, u32::MAX), n(1), false),
            Err(ConfigError::ValueTooLarge)
        );
        assert_eq!(
            Encoder::new(rotary(u32::MAX, 1), n(u32::MAX), false),
            Err(ConfigError::ValueTooLarge)
        );
        let coarse = Encoder::new(rotary(1, 1), n(1), true).expect("small");
        assert_eq!(coarse.position(i32::MIN), None);
        let grid = Mounting::Linear {
            grid_nm: n(u32::MAX),
        };
        let grid = Encoder::new(grid, n(1), true).expect("fits");
        assert_eq!(grid.position(i32::MIN), None);
    }
}
