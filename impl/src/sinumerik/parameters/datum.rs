//! What the manual says about one machine datum: its number, unit, range and default.

use super::Parameters;
use crate::units::Axis;

/// The integer unit in which a machine datum counts here. Each is the finest step that both channels hold, so that a value
/// of either channel's manual unit with three decimals is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A plain number; the manual's own.
    Number,
    /// A value of a list, or yes and no; the manual's own.
    Choice,
    /// A word of bits; the manual's own.
    Bits,
    /// Percent; the manual's own.
    Percent,
    /// Hertz; the manual's own.
    Hertz,
    /// Microseconds; the manual's unit is the second, for delays in the drive the millisecond.
    Microseconds,
    /// Micrometres, on a rotary axis 0.001 degrees; the manual's unit is mm or degree (NCK), or the same (drive).
    Length,
    /// 0.001 degrees; the manual's unit is the degree (NCK), or the same (drive).
    Angle,
    /// Nanometres; the manual's unit is mm (NCK) or um (drive).
    Grid,
    /// Micrometres per revolution; the manual's unit is mm per revolution.
    Pitch,
    /// Micrometres per minute, on a rotary axis 0.001 revolutions per minute; the manual's unit is mm/min or rev/min.
    Speed,
}

impl Unit {
    /// How many of these units make one unit of the NCK machine datum.
    pub const fn per_manual_unit(self) -> i64 {
        match self {
            Self::Number | Self::Choice | Self::Bits | Self::Percent | Self::Hertz => 1,
            Self::Length | Self::Angle | Self::Pitch | Self::Speed => 1_000,

            Self::Microseconds | Self::Grid => 1_000_000,
        }
    }

    /// The abbreviation, for a linear or a rotary axis; empty for plain numbers.
    pub const fn symbol(self, axis: Axis) -> &'static str {
        match (self, axis) {
            (Self::Number | Self::Choice | Self::Bits, _) => "",
            (Self::Percent, _) => " %",
            (Self::Hertz, _) => " Hz",
            (Self::Microseconds, _) => " us",
            (Self::Length, Axis::Linear) => " um",
            (Self::Length, Axis::Rotary) | (Self::Angle, _) => " mdeg",
            (Self::Grid, _) => " nm",
            (Self::Pitch, _) => " um/rev",
            (Self::Speed, Axis::Linear) => " um/min",
            (Self::Speed, Axis::Rotary) => " x 0.001 rev/min",
        }
    }
}

/// The values a machine datum may have, in its [`Unit`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Permitted {
    /// Every value from the first to the second, both included.
    Range(i64, i64),
    /// These values.
    Values(&'static [i64]),
}

impl Permitted {
    /// Whether the value is permitted.
    pub fn contains(self, value: i64) -> bool {
        match self {
            Self::Range(min, max) => min <= value && value <= max,
            Self::Values(values) => values.contains(&value),
        }
    }
}

impl core::fmt::Display for Permitted {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Range(min, max) => write!(f, "{min} to {max}"),
            Self::Values(values) => {
                for (i, value) in values.iter().enumerate() {
                    let separator = if i == 0 { "" } else { ", " };
                    write!(f, "{separator}{value}")?;
                }
                Ok(())
            }
        }
    }
}

/// One machine datum of [`Parameters`].
#[derive(Clone, Copy, Debug)]
pub struct Datum {
    /// The number of the NCK machine datum; the name of the drive's counterpart is the same.
    pub number: u32,
    /// The name without the prefix `$MN_` or `$MA_`.
    pub name: &'static str,
    /// The unit in which it counts here.
    pub unit: Unit,
    /// What both channels permit.
    pub permitted: Permitted,
    /// The greatest value on a linear axis, where alarm 27033 limits it further.
    pub linear_max: Option<i64>,
    /// The number of elements; 1 for a single value.
    pub count: usize,
    /// The value of an element; 0 beyond the last.
    pub value: fn(&Parameters, usize) -> i64,
}

impl Datum {
    /// The permitted values on an axis of this kind.
    pub fn permitted_on(&self, axis: Axis) -> Permitted {
        match (axis, self.linear_max, self.permitted) {
            (Axis::Linear, Some(limit), Permitted::Range(min, max)) => {
                Permitted::Range(min, max.min(limit))
            }
            (_, _, permitted) => permitted,
        }
    }
}

/// A field of [`Parameters`]: one value or an array of them.
pub(super) trait Elements {
    const COUNT: usize;

    fn element(&self, index: usize) -> i64;
}

macro_rules! single {
    ($($type:ty),+) => {$(
        impl Elements for $type {
            const COUNT: usize = 1;

            fn element(&self, index: usize) -> i64 {
                if index == 0 { i64::from(*self) } else { 0 }
            }
        }
    )+};
}

single!(bool, i8, u8, u32, i32);

impl<T: Elements, const N: usize> Elements for [T; N] {
    const COUNT: usize = N;

    fn element(&self, index: usize) -> i64 {
        self.get(index).map_or(0, |value| value.element(0))
    }
}
