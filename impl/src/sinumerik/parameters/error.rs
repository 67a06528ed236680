//! Why machine data were refused.

use super::datum::{Datum, Permitted};
use crate::kernel::ConfigError;
use crate::units::Axis;

/// A rule between several machine data; most are contexts of alarm 27033.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// The monitoring cycle is longer than 25 ms (S840D-TIMING-511).
    CycleTooLong,
    /// The monitoring cycle is no multiple of the position-control cycle (S840D-TIMING-502).
    CycleNoMultiple,
    /// The drive holds the monitoring cycle only in steps of 31.25 us and from 0.5 ms on (S840D-PARAM-003).
    CycleNotInDrive,
    /// A function is enabled without SBH/SG, in which STOP C, D and E end (S840D-PARAM-502, context 5).
    WithoutSbhSg,
    /// The reserved bit 2 of the enable word is set (S840D-PARAM-501, S840D-MDCHK-029/a).
    ReservedBit,
    /// External STOP E is enabled without external stops (S840D-EXT-003).
    StopEWithoutExternalStops,
    /// Errors of the safe logic ask for STOP E, which is not enabled (S840D-PARAM-505, context 33).
    SplStopENotEnabled,
    /// Slip synchronisation together with limit switches or cams (S840D-SLIP-501, context 21).
    SlipWithPosition,
    /// Slip synchronisation needs two encoders (S840D-SLIP-501, context 21).
    SlipWithOneEncoder,
    /// Cam synchronisation without a cam (S840D-PARAM-736, context 36).
    CamSyncWithoutCam,
    /// The upper limit of a pair does not lie above the lower one (S840D-PARAM-506, context 2).
    LimitsInterchanged,
    /// The modulo range is no multiple of 360 degrees (S840D-PARAM-719, context 19).
    ModuloNoMultiple,
    /// An enabled cam lies outside the modulo range or too near to its ends (S840D-SN-010, context 18).
    CamOutsideModulo,
    /// More than 300 kHz on a control module that monitors no more (S840D-FREQ-003, context 31).
    FrequencyTooHigh,
    /// Internal pulse cancellation without the external path (S840D-PARAM-507, context 32).
    InternalWithoutExternal,
    /// Internal pulse cancellation on a control module that has none (S840D-PARAM-507).
    InternalNotAvailable,
}

impl Rule {
    /// The number of the context in the text of alarm 27033; none for rules of other places of the manual.
    pub const fn context(self) -> Option<u8> {
        match self {
            Self::LimitsInterchanged => Some(2),
            Self::WithoutSbhSg => Some(5),
            Self::CamOutsideModulo => Some(18),
            Self::ModuloNoMultiple => Some(19),
            Self::SlipWithPosition | Self::SlipWithOneEncoder => Some(21),
            Self::FrequencyTooHigh => Some(31),
            Self::InternalWithoutExternal => Some(32),
            Self::SplStopENotEnabled => Some(33),
            Self::CamSyncWithoutCam => Some(36),
            Self::CycleTooLong
            | Self::CycleNoMultiple
            | Self::CycleNotInDrive
            | Self::ReservedBit
            | Self::StopEWithoutExternalStops
            | Self::InternalNotAvailable => None,
        }
    }

    /// What is wrong and what is permitted.
    pub const fn text(self) -> &'static str {
        match self {
            Self::CycleTooLong => "the monitoring cycle must not be longer than 25 ms",
            Self::CycleNoMultiple => "must be a multiple of MD10060",
            Self::CycleNotInDrive => {
                "the monitoring cycle must be a multiple of 31.25 us of at least 0.5 ms"
            }
            Self::WithoutSbhSg => "bits 1 to 15 need bit 0 (SBH/SG)",
            Self::ReservedBit => "bit 2 must be 0",
            Self::StopEWithoutExternalStops => "bit 4 (STOP E) needs bit 6 (external stops)",
            Self::SplStopENotEnabled => "MD10097 = 4 needs bits 4 (STOP E) and 6 (external stops)",
            Self::SlipWithPosition => "bit 3 (slip) excludes bit 1 (SE) and bits 8 to 15 (cams)",
            Self::SlipWithOneEncoder => "bit 3 (slip) needs two encoders",
            Self::CamSyncWithoutCam => "bit 7 (cam synchronisation) needs one of bits 8 to 15",
            Self::LimitsInterchanged => "must be greater than the lower limit MD36935",
            Self::ModuloNoMultiple => "must be a multiple of 360000 mdeg",
            Self::CamOutsideModulo => {
                "must keep MD36942 from both ends of the modulo range, with bit 7 also MD36940 from the upper"
            }
            Self::FrequencyTooHigh => "must not exceed 300000 Hz on this control module",
            Self::InternalWithoutExternal => {
                "bit 30 (internal cancellation) needs MD36984 and MD36979"
            }
            Self::InternalNotAvailable => {
                "bit 30 (internal cancellation) needs Performance 2 or better"
            }
        }
    }
}

/// Why machine data were refused.
#[derive(Clone, Copy, Debug)]
pub enum ParameterError {
    /// A value is outside its range or not in its list.
    NotPermitted {
        /// The machine datum.
        datum: &'static Datum,
        /// Which element; 0 for a single value.
        index: usize,
        /// The value refused, in the unit of the datum.
        value: i64,
        /// What is permitted on this axis.
        permitted: Permitted,
        /// Linear or rotary, which decides the unit.
        axis: Axis,
    },
    /// A value contradicts others.
    Implausible {
        /// The number of the machine datum that the alarm names.
        number: u32,
        /// Which element; 0 for a single value.
        index: usize,
        /// The value refused.
        value: i64,
        /// What it breaks.
        rule: Rule,
    },
    /// A monitor refused its configuration: a value of the [`Installation`](super::Installation) is out of range. The machine
    /// data never are, since their ranges are at most those of the monitors.
    Refused(ConfigError),
}

impl From<ConfigError> for ParameterError {
    fn from(error: ConfigError) -> Self {
        Self::Refused(error)
    }
}

impl core::fmt::Display for ParameterError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotPermitted {
                datum,
                index,
                value,
                permitted,
                axis,
            } => {
                let unit = datum.unit.symbol(*axis);
                write!(
                    f,
                    "MD{} {}[{index}] = {value}{unit}: permitted is {permitted}{unit}",
                    datum.number, datum.name
                )
            }
            Self::Implausible {
                number,
                index,
                value,
                rule,
            } => write!(f, "MD{number}[{index}] = {value}: {}", rule.text()),
            Self::Refused(error) => write!(f, "refused by a monitor: {error}"),
        }
    }
}

impl core::error::Error for ParameterError {}
