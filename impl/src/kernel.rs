//! Primitives shared by the monitors of every family: time in cycles, positions and speeds.

use core::num::NonZeroU32;

/// A duration in monitoring cycles (T_SI), 0 to `u32::MAX`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cycles(u32);

/// A duration does not fit [`Cycles`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DurationTooLong;

impl core::fmt::Display for DurationTooLong {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the duration has more cycles than 32 bits hold")
    }
}

impl core::error::Error for DurationTooLong {}

impl Cycles {
    /// No time: a timer started with it expires at once.
    pub const ZERO: Self = Self(0);

    /// Ten seconds in cycles of 31.25 us, the unit of the drive's monitoring cycle (MD1300) and so the shortest possible:
    /// the longest t_B and t_C.
    pub const TEN_SECONDS: Self = Self(320_000);

    /// Sixty seconds in cycles of 31.25 us: the longest of all other delays.
    pub const SIXTY_SECONDS: Self = Self(1_920_000);

    /// A duration of `count` cycles.
    pub const fn new(count: u32) -> Self {
        Self(count)
    }

    /// The number of cycles.
    pub const fn count(self) -> u32 {
        self.0
    }

    /// The shortest number of cycles that lasts at least `millis` milliseconds, for a cycle of `cycle_us` microseconds.
    ///
    /// Rounds up: the safe side wherever a reaction needs a minimum time, such as braking before the standstill window
    /// is watched. Also the convention of the specification for all stop timers.
    ///
    /// # Errors
    /// [`DurationTooLong`] when the result needs more than 32 bits.
    pub const fn from_millis_up(
        millis: u32,
        cycle_us: NonZeroU32,
    ) -> Result<Self, DurationTooLong> {
        Self::from_micros_up(millis as u64 * 1000, cycle_us)
    }

    /// The shortest number of cycles that lasts at least `micros` microseconds; like [`Cycles::from_millis_up`].
    ///
    /// # Errors
    /// [`DurationTooLong`] when the result needs more than 32 bits.
    pub const fn from_micros_up(
        micros: u64,
        cycle_us: NonZeroU32,
    ) -> Result<Self, DurationTooLong> {
        Self::checked(micros.div_ceil(cycle_us.get() as u64))
    }

    /// The longest number of cycles that lasts at most `millis` milliseconds, for a cycle of `cycle_us` microseconds.
    ///
    /// Rounds down: the safe side wherever a hazard may last no longer than the given time.
    ///
    /// # Errors
    /// [`DurationTooLong`] when the result needs more than 32 bits.
    pub const fn from_millis_down(
        millis: u32,
        cycle_us: NonZeroU32,
    ) -> Result<Self, DurationTooLong> {
        Self::from_micros_down(millis as u64 * 1000, cycle_us)
    }

    /// The longest number of cycles that lasts at most `micros` microseconds; like [`Cycles::from_millis_down`].
    ///
    /// # Errors
    /// [`DurationTooLong`] when the result needs more than 32 bits.
    pub const fn from_micros_down(
        micros: u64,
        cycle_us: NonZeroU32,
    ) -> Result<Self, DurationTooLong> {
        Self::checked(micros / cycle_us.get() as u64)
    }

    /// The shortest tolerance for a change of an input signal (`MODE_SWITCH_TIME`, t_chg) that the system needs: two of the
    /// longest cycles of the PLC and one of the interpolator, rounded up (S840D-TIMING-510). The delays of the wiring, such
    /// as relays, come on top of it. All times in microseconds.
    ///
    /// # Errors
    /// [`DurationTooLong`] when the result needs more than 32 bits.
    pub const fn least_change_tolerance(
        plc_us: u32,
        interpolator_us: u32,
        cycle_us: NonZeroU32,
    ) -> Result<Self, DurationTooLong> {
        let micros = 2 * plc_us as u64 + interpolator_us as u64;
        Self::checked(micros.div_ceil(cycle_us.get() as u64))
    }

    /// The same duration, if it is at most `limit`.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when it is longer.
    pub const fn at_most(self, limit: Self) -> Result<Self, ConfigError> {
        if self.0 <= limit.0 {
            Ok(self)
        } else {
            Err(ConfigError::DelayTooLong)
        }
    }

    const fn checked(count: u64) -> Result<Self, DurationTooLong> {
        if count > u32::MAX as u64 {
            Err(DurationTooLong)
        } else {
            Ok(Self(count as u32))
        }
    }

    /// What is left one cycle later; zero stays zero.
    pub const fn tick(self) -> Self {
        Self(self.0.saturating_sub(1))
    }

    /// The shorter of the two durations.
    pub const fn min(self, other: Self) -> Self {
        if self.0 <= other.0 { self } else { other }
    }

    /// Whether the time is up.
    pub const fn is_zero(self) -> bool {
        self.0 == 0
    }
}

/// Why a configuration was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConfigError {
    /// A delay is longer than the manual allows in the shortest monitoring cycle: see [`Cycles::TEN_SECONDS`] and
    /// [`Cycles::SIXTY_SECONDS`].
    DelayTooLong,
    /// A delay must be at least one cycle.
    NoDelay,
    /// Errors of the safe logic shall raise STOP E, but external stops or STOP E are not enabled (S840D-PARAM-505).
    StopENotEnabled,
    /// The highest gear index is above 7 (S840D-GEAR-501).
    GearIndexTooHigh,
    /// Internal pulse cancellation lacks its external path (S840D-PARAM-507).
    NoExternalPath,
    /// Actual values are synchronised on an axis with one encoder, limit switches or cams (S840D-SLIP-501).
    SynchronisationNotAllowed,
    /// The list of the cross comparison is empty or has more than 256 items.
    ListLength,
    /// A factor is outside its range: 1 to 100 % for the override (S840D-PARAM-011), 0 to 100 % for the setpoint limit
    /// (S840D-PARAM-012).
    FactorOutOfRange,
    /// A configured stop is none of those the monitor may raise: there is no default (S840D-STOP-087, S840D-PARAM-735).
    StopNotAllowed,
    /// An upper limit is not above its lower limit (S840D-PARAM-506).
    LimitsCrossed,
    /// The tolerance of the operating stop is above 100 mm or 100 degrees.
    ToleranceTooLarge,
    /// A value has more increments than 32 bits hold.
    ValueTooLarge,
    /// The monitoring cycle is longer than 25 ms (S840D-TIMING-511).
    CycleTooLong,
    /// The modulo range of the cams is neither 0 nor a multiple of 360 degrees up to 737280 (S840D-PARAM-719).
    ModuloRangeUneven,
    /// A cam is too close to the limits of the modulo range (S840D-SN-010).
    CamNearModuloLimit,
    /// The encoder limit frequency is not 300 to 420 kHz (S840D-FREQ-003).
    FrequencyOutOfRange,
    /// A value is outside the range of its parameter (HFS-PARAM-010).
    ValueOutOfRange,
}

impl core::fmt::Display for ConfigError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::DelayTooLong => "a delay is longer than the manual allows",
            Self::NoDelay => "a delay must be at least one cycle",
            Self::StopENotEnabled => {
                "STOP E on errors of the safe logic needs external stops and STOP E enabled"
            }
            Self::GearIndexTooHigh => "the highest gear index is above 7",
            Self::NoExternalPath => {
                "internal pulse cancellation needs an external path and an input for its test"
            }
            Self::SynchronisationNotAllowed => {
                "the synchronisation of actual values needs two encoders and neither limit switches nor cams"
            }
            Self::ListLength => "the list of the cross comparison must have 1 to 256 items",
            Self::FactorOutOfRange => "a factor in percent is outside its range",
            Self::StopNotAllowed => "a configured stop is none the monitor may raise",
            Self::LimitsCrossed => "an upper limit is not above its lower limit",
            Self::ToleranceTooLarge => "the tolerance of the operating stop is above 100 mm or 100 degrees",
            Self::ValueTooLarge => "a value has more increments than 32 bits hold",
            Self::CycleTooLong => "the monitoring cycle is longer than 25 ms",
            Self::ModuloRangeUneven => {
                "the modulo range of the cams is neither 0 nor a multiple of 360 degrees up to 737280"
            }
            Self::CamNearModuloLimit => "a cam is too close to the limits of the modulo range",
            Self::FrequencyOutOfRange => "the encoder limit frequency is not 300 to 420 kHz",
            Self::ValueOutOfRange => "a value is outside the range of its parameter",
        })
    }
}

impl core::error::Error for ConfigError {}

/// A safe position in increments: micrometres (linear axes) or thousandths of a degree (rotary axes).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position(pub i32);

impl Position {
    /// The distance of two positions; never overflows.
    pub const fn distance(self, other: Self) -> Distance {
        Distance(self.0.abs_diff(other.0))
    }
}

/// A distance or a tolerance in increments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Distance(pub u32);

/// A speed magnitude in increments per monitoring cycle: the distance of the positions of two cycles, which is what the
/// manual compares with its limits (S840D-TIMING-512). Conversion: [`crate::units::Scale`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Speed(pub u32);

impl Speed {
    /// The given part of the speed, rounded down: a limit so reduced is never above the exact one.
    pub const fn reduced(self, factor: Percent) -> Self {
        // At most the speed itself, since a factor is at most 100.
        Self((self.0 as u64 * factor.0 as u64 / 100) as u32)
    }
}

/// A factor of 0 to 100 percent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Percent(u8);

impl Percent {
    /// The whole.
    pub const WHOLE: Self = Self(100);

    /// A factor of `percent`.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] when `percent` is above 100.
    pub const fn new(percent: u8) -> Result<Self, ConfigError> {
        if percent <= 100 {
            Ok(Self(percent))
        } else {
            Err(ConfigError::FactorOutOfRange)
        }
    }

    /// The number, 0 to 100.
    pub const fn get(self) -> u8 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversion_rounds_to_the_named_side() {
        let cycle = NonZeroU32::new(12_000).expect("not zero");
        assert_eq!(Cycles::from_millis_up(100, cycle), Ok(Cycles::new(9)));
        assert_eq!(Cycles::from_millis_down(100, cycle), Ok(Cycles::new(8)));
        assert_eq!(
            Cycles::from_millis_up(96, cycle),
            Cycles::from_millis_down(96, cycle)
        );
        assert_eq!(
            Cycles::from_millis_up(u32::MAX, NonZeroU32::MIN),
            Err(DurationTooLong)
        );
        assert_eq!(Cycles::from_millis_up(0, cycle), Ok(Cycles::ZERO));
    }

    #[test]
    fn time_runs_down_and_stops_at_zero() {
        assert_eq!(Cycles::new(2).tick(), Cycles::new(1));
        assert!(Cycles::new(1).tick().is_zero());
        assert!(Cycles::ZERO.tick().is_zero());
    }
}
