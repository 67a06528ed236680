//! From the values of the safe machine parameters (SMP) to increments and cycles.
//!
//! One increment is a tenth of a micrometre, or a ten-thousandth of a degree, the finest decimal that a parameter has; one
//! cycle is 3 ms. So a speed in mm/min or degrees per minute is half as many increments per cycle, and one revolution per
//! minute is 180 of them. Every function takes a value in the smallest step of its parameter, refuses what is outside the
//! printed range (HFS-PARAM-010), and says to which side it rounds: towards the earlier reaction.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Cycles, Distance, Position, Speed};

/// The length of a cycle in microseconds (HFS-TIMING-001).
pub const CYCLE_US: u32 = 3_000;

/// The same as the divisor of a conversion.
const CYCLE: NonZeroU32 = match NonZeroU32::new(CYCLE_US) {
    Some(cycle) => cycle,
    None => NonZeroU32::MIN,
};

/// Standstill of an axis: 50 mm/min or degrees per minute, from which on it moves (HFS-TIMING-012).
pub const AXIS_STILL: Speed = Speed(25);

/// Standstill of a spindle: 10 rpm, from which on it turns (HFS-TIMING-012).
pub const SPINDLE_STILL: Speed = Speed(1_800);

/// Restricted spindle operation: at most 50 rpm (HFS-MODE-013).
pub const RESTRICTED_SPEED: Speed = Speed(9_000);

/// Restricted spindle operation: at most two revolutions, in increments (HFS-MODE-013).
pub const RESTRICTED_ANGLE: u32 = 7_200_000;

/// A value inside the printed range of its parameter.
const fn within(value: u32, low: u32, high: u32) -> Result<u32, ConfigError> {
    if low <= value && value <= high {
        Ok(value)
    } else {
        Err(ConfigError::ValueOutOfRange)
    }
}

/// The limit of the speed of an axis in mm/min or degrees per minute, rounded down: SMP590.x up to 2000, SMP540.x and
/// SMP552.x up to 5000. `highest` is that end of the range.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above `highest`.
pub const fn axis_limit(per_minute: u32, highest: u32) -> Result<Speed, ConfigError> {
    match within(per_minute, 0, highest) {
        Ok(value) => Ok(Speed(value / 2)),
        Err(error) => Err(error),
    }
}

/// The limit of the speed of a spindle in rpm: SMP591, SMP541 and SMP551, 0 to 6000. Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above 6000.
pub const fn spindle_limit(rpm: u32) -> Result<Speed, ConfigError> {
    match within(rpm, 0, 6_000) {
        Ok(value) => Ok(Speed(value * 180)),
        Err(error) => Err(error),
    }
}

/// The path of the operating stop in micrometres or thousandths of a degree: SMP545.x, 1 to 30 000. Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside the range.
pub const fn standstill_path(thousandths: u32) -> Result<Distance, ConfigError> {
    match within(thousandths, 1, 30_000) {
        Ok(value) => Ok(Distance(value * 10)),
        Err(error) => Err(error),
    }
}

/// The path of an SS2 in increments: SMP550.x, 10 (0.0010 mm) to 1 000 000 (100 mm). Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside the range.
pub const fn stop_path(increments: u32) -> Result<Distance, ConfigError> {
    match within(increments, 10, 1_000_000) {
        Ok(value) => Ok(Distance(value)),
        Err(error) => Err(error),
    }
}

/// A deviation of positions in micrometres or thousandths of a degree: SMP641.x and SMP642.x, 0 to 30 000. Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above the range.
pub const fn deviation(thousandths: u32) -> Result<Distance, ConfigError> {
    match within(thousandths, 0, 30_000) {
        Ok(value) => Ok(Distance(value * 10)),
        Err(error) => Err(error),
    }
}

/// An absolute position in increments: SMP646.x, SMP650.x and SMP670.x, up to 99 999.9999 mm to either side. Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside the range.
pub const fn absolute(increments: i32) -> Result<Position, ConfigError> {
    if increments.unsigned_abs() <= 999_999_999 {
        Ok(Position(increments))
    } else {
        Err(ConfigError::ValueOutOfRange)
    }
}

/// A time in milliseconds after which something worse follows: SMP525.x to SMP528.x and SMP530.x, 0 to 10 000. Rounded
/// down: the time is never longer than the one entered.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above the range.
pub const fn stop_time(millis: u32) -> Result<Cycles, ConfigError> {
    match within(millis, 0, 10_000) {
        Ok(value) => at_most_millis(value),
        Err(error) => Err(error),
    }
}

/// The time in milliseconds that a brake takes to close, MP2308, 0 to 10 000. Rounded **up**: the torque goes when the brake
/// is closed, not before.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above the range.
pub const fn brake_time(millis: u32) -> Result<Cycles, ConfigError> {
    match within(millis, 0, 10_000) {
        Ok(value) => match Cycles::from_millis_up(value, CYCLE) {
            Ok(cycles) => Ok(cycles),
            Err(_) => Err(ConfigError::ValueOutOfRange),
        },
        Err(error) => Err(error),
    }
}

/// A window of the comparison of speeds in milliseconds: SMP632.x, SMP633. The manual prints no range; one cycle to a minute
/// are accepted. Rounded down.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside 3 to 60 000.
pub const fn window(millis: u32) -> Result<Cycles, ConfigError> {
    match within(millis, 3, 60_000) {
        Ok(value) => at_most_millis(value),
        Err(error) => Err(error),
    }
}

/// The interval of the self-test in minutes: SMP511, 1 to 10 080. Exact.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside the range.
pub const fn test_interval(minutes: u32) -> Result<Cycles, ConfigError> {
    match within(minutes, 1, 10_080) {
        Ok(value) => Ok(Cycles::new(value * 20_000)),
        Err(error) => Err(error),
    }
}

/// The time in seconds after which outputs and power modules are off at the latest: SMP2172, 0 to 60; 0 means 3. Rounded
/// down (HFS-PARAM-021).
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] above the range.
pub const fn switch_off_time(seconds: u32) -> Result<Cycles, ConfigError> {
    match within(seconds, 0, 60) {
        Ok(0) => at_most_millis(3_000),
        Ok(value) => at_most_millis(value * 1_000),
        Err(error) => Err(error),
    }
}

/// The time in tenths of a second that a permissive counts: a timer of SMP535.x, at most 30 minutes (HFS-PB-001). Rounded
/// down.
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] outside 1 to 18 000.
pub const fn permissive_time(tenths: u32) -> Result<Cycles, ConfigError> {
    match within(tenths, 1, 18_000) {
        Ok(value) => at_most_millis(value * 100),
        Err(error) => Err(error),
    }
}

const fn at_most_millis(millis: u32) -> Result<Cycles, ConfigError> {
    match Cycles::from_millis_down(millis, CYCLE) {
        Ok(cycles) => Ok(cycles),
        Err(_) => Err(ConfigError::ValueOutOfRange),
    }
}

/// The bits of SMP560 that exist in this version (HFS-PARAM-011): a set bit takes a part of the safety away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Bit 0: SOM_4 is enabled.
    pub som_4: bool,
    /// Bit 1: the self-test runs with open doors.
    pub test_with_open_doors: bool,
    /// Bit 3: the brake control is not tested.
    pub no_brake_control_test: bool,
    /// Bit 6: the axes cannot be switched off one by one by -STO.B.x in the test.
    pub collective_switch_off: bool,
    /// Bit 8: -STO.A.G and -STOS.A.G are not wired to the power modules.
    pub global_signals_not_wired: bool,
    /// Bit 11: the dv/dt monitoring of spindles is off, for commissioning.
    pub spindle_ramp_off: bool,
    /// Bit 12: it is not tested whether the safe outputs can be switched off.
    pub no_output_test: bool,
}

impl Options {
    /// The options of SMP560, bit 0 the lowest.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] when a bit is set that does not exist in this version: 2, 4, 5, 7, 9, 10 and above 12.
    pub const fn new(smp560: u32) -> Result<Self, ConfigError> {
        const KNOWN: u32 = 0b1_1001_0100_1011;
        if smp560 & !KNOWN != 0 {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self {
            som_4: smp560 & 1 != 0,
            test_with_open_doors: smp560 & (1 << 1) != 0,
            no_brake_control_test: smp560 & (1 << 3) != 0,
            collective_switch_off: smp560 & (1 << 6) != 0,
            global_signals_not_wired: smp560 & (1 << 8) != 0,
            spindle_ramp_off: smp560 & (1 << 11) != 0,
            no_output_test: smp560 & (1 << 12) != 0,
        })
    }
}

/// How steep the emergency braking ramp is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ramp {
    /// The drive brakes at the limit of its current.
    Current,
    /// By this deceleration, in the unit of the two parameters (mm/s2 or degrees/s2, or their multiples).
    Deceleration(u32),
}

/// The emergency braking ramp of MP2590, of which MP1060, the acceleration of normal operation, is the least: HFS-SS1-003. 0 in
/// MP2590 is the limit of current. Neither is a safe parameter, so any value is taken: what the ramp comes to is watched by
/// the times of SS1 and by dv/dt.
pub const fn emergency_ramp(mp2590: u32, mp1060: u32) -> Ramp {
    match mp2590 {
        0 => Ramp::Current,
        steep if steep >= mp1060 => Ramp::Deceleration(steep),
        _ => Ramp::Deceleration(mp1060),
    }
}
