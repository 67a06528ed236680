//! What the signals of a machine are called.
//!
//! A signal of an axis is `X.NAME`, one of a channel of the axis `X.CHANNEL.NAME`. Names with a point after
//! that, `Monitoring. ...` and `Safety. ...`, are browse paths of OPC UA for the Powertrain, part 2 (OPC 40400-2, 7.7 to
//! 7.9): position and speed, and for each safety function its `SelectionState` and `ActivationState` with the values named
//! there. The other names are those of a family, or our own.

/// The position of an axis.
pub const POSITION: &str = "Monitoring.PositionActualValue";
/// The speed of an axis.
pub const VELOCITY: &str = "Monitoring.VelocityActualValue";
/// The speed that the control asks for.
pub const SETPOINT: &str = "Monitoring.VelocitySetpoint";

/// The stop in force, of an axis in a channel.
pub const STOP: &str = "stop";
/// The alarms of an axis in a channel, by number.
pub const ALARMS: &str = "alarms";

/// What a number counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Not a number, or a plain one.
    None,
    /// 1 um or 0.001 degrees.
    Increment,
    /// 0.1 um or 0.0001 degrees.
    Tenth,
    /// 1 mm.
    Millimetre,
    /// 1 mm/min.
    MillimetrePerMinute,
    /// Increments per cycle.
    IncrementPerCycle,
    /// Pulses of the encoder per cycle.
    PulsesPerCycle,
}

impl Unit {
    /// The unit in words, for a linear or a rotary axis.
    pub const fn text(self, rotary: bool) -> &'static str {
        match (self, rotary) {
            (Self::None, _) => "",
            (Self::Increment, false) => "um",
            (Self::Increment, true) => "mdeg",
            (Self::Tenth, false) => "0.1 um",
            (Self::Tenth, true) => "0.1 mdeg",
            (Self::Millimetre, _) => "mm",
            (Self::MillimetrePerMinute, _) => "mm/min",
            (Self::IncrementPerCycle, false) => "um/cycle",
            (Self::IncrementPerCycle, true) => "mdeg/cycle",
            (Self::PulsesPerCycle, _) => "pulses/cycle",
        }
    }
}
