//! The alarms of axis monitoring: numbers, reactions, acknowledgement (S840D-ALARM-501, S840D-ALARM-733).
//!
//! An alarm is a message. The stop comes from the monitors and does not depend on the message or on its suppression
//! (S840D-ALARM-701). External stops raise no alarm. The data are those of the manual's alarm table (`alarms.toml`); a test
//! compares every entry.

use crate::kernel::{Distance, Position};
use crate::sinumerik::code::Code;
use crate::sinumerik::level::{InternalStop, Level};

/// An alarm of axis monitoring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Alarm {
    /// The axis is not safely referenced (S840D-REF-013, S840D-ALARM-719, S840D-ALARM-720).
    NotSafelyReferenced,
    /// STOP F; its parameter is the [`Code`] (S840D-KDV-502, S840D-ALARM-713, S840D-ALARM-735).
    CrossComparison,
    /// The test of the shutdown path runs (S840D-TEST-015, S840D-ALARM-736).
    TestStop,
    /// The actual values of the channels differ statically (S840D-ALARM-718).
    StaticDifference,
    /// The test of the external shutdown runs (S840D-TEST-016).
    ExternalTest,
    /// The standstill tolerance is exceeded (S840D-ALARM-716).
    Standstill,
    /// The speed limit is exceeded (S840D-ALARM-714, S840D-ALARM-734).
    SpeedLimit,
    /// A limit switch is passed (S840D-ALARM-715).
    EndStop,
    /// The braking ramp is exceeded (S840D-ALARM-717).
    BrakingRamp,
    /// STOP E follows (S840D-ALARM-732).
    StopE,
    /// STOP D follows (S840D-ALARM-732).
    StopD,
    /// STOP C follows (S840D-ALARM-732).
    StopC,
    /// STOP B follows (S840D-ALARM-731).
    StopB,
    /// STOP A follows (S840D-ALARM-730).
    StopA,
    /// A parameter is invalid; in the drive the one case of actual value synchronisation (S840D-SLIP-501).
    InvalidParameter,
}

/// What the control does with the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Reaction {
    /// The mode group is not ready.
    ModeGroupNotReady,
    /// The channel is not ready.
    ChannelNotReady,
    /// No program starts.
    StartInhibit,
    /// The interface signals to the user program are set.
    InterfaceSignals,
    /// The message is displayed.
    Display,
    /// The program stops.
    ProgramStop,
}

impl Reaction {
    /// Every reaction.
    pub const ALL: [Self; 6] = [
        Self::ModeGroupNotReady,
        Self::ChannelNotReady,
        Self::StartInhibit,
        Self::InterfaceSignals,
        Self::Display,
        Self::ProgramStop,
    ];

    /// The keyword of the alarm table.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::ModeGroupNotReady => "mode-group-not-ready",
            Self::ChannelNotReady => "channel-not-ready",
            Self::StartInhibit => "nc-start-inhibit",
            Self::InterfaceSignals => "interface-signals-set",
            Self::Display => "alarm-display",
            Self::ProgramStop => "nc-stop-on-alarm",
        }
    }
}

/// The stop that belongs to the alarm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Response {
    /// None by the alarm itself.
    None,
    /// Always this one.
    Fixed(Level),
    /// The one configured for the monitor.
    Configured,
}

fields! {
    /// How a message is acknowledged (S840D-ALARM-711).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Class {
        /// It goes away with its cause.
        SelfClearing,
        /// By RESET.
        Reset,
        /// By power-on.
        PowerOn,
        /// By the cancel key, or NC-START.
        Cancel,
        /// By the cancel key of the NCK.
        NckKey,
    }
}

impl Class {
    /// The keyword of the alarm table.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::SelfClearing => "self-clearing",
            Self::Reset => "reset",
            Self::PowerOn => "power-on",
            Self::Cancel => "cancel-key-or-nc-start",
            Self::NckKey => "nck-key",
        }
    }
}

/// The acknowledgement of an alarm (S840D-ALARM-711, S840D-ACK-001).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Acknowledgement {
    /// As long as no STOP A or B has followed.
    pub class: Class,
    /// Once STOP A or B has followed, power-on is needed. Hiding the message does not change that (S840D-ALARM-710).
    pub escalates: bool,
}

impl Acknowledgement {
    /// What acknowledges the alarm, after or without a STOP A or B that followed from it.
    pub const fn needed(self, stop_ab: bool) -> Class {
        if stop_ab && self.escalates {
            Class::PowerOn
        } else {
            self.class
        }
    }
}

/// One alarm in one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The printed number.
    pub number: u32,
    /// What the control does.
    pub reactions: &'static [Reaction],
    /// The stop that belongs to it.
    pub response: Response,
    /// How it is acknowledged.
    pub acknowledgement: Acknowledgement,
}

/// A message only.
const DISPLAY: &[Reaction] = &[Reaction::Display];

/// A message, and no program starts.
const INHIBIT: &[Reaction] = &[Reaction::StartInhibit, Reaction::Display];

/// The program stops.
const STOP: &[Reaction] = &[
    Reaction::StartInhibit,
    Reaction::InterfaceSignals,
    Reaction::Display,
    Reaction::ProgramStop,
];

/// The mode group is no longer ready.
const NOT_READY: &[Reaction] = &[
    Reaction::ModeGroupNotReady,
    Reaction::ChannelNotReady,
    Reaction::StartInhibit,
    Reaction::InterfaceSignals,
    Reaction::Display,
    Reaction::ProgramStop,
];

const SELF_CLEARING: Acknowledgement = Acknowledgement {
    class: Class::SelfClearing,
    escalates: false,
};
const RESET: Acknowledgement = Acknowledgement {
    class: Class::Reset,
    escalates: false,
};
const RESET_OR_POWER_ON: Acknowledgement = Acknowledgement {
    class: Class::Reset,
    escalates: true,
};
const POWER_ON: Acknowledgement = Acknowledgement {
    class: Class::PowerOn,
    escalates: false,
};

impl Alarm {
    /// Every alarm, by the number of the NCK.
    pub const ALL: [Self; 15] = [
        Self::NotSafelyReferenced,
        Self::CrossComparison,
        Self::TestStop,
        Self::StaticDifference,
        Self::ExternalTest,
        Self::Standstill,
        Self::SpeedLimit,
        Self::EndStop,
        Self::BrakingRamp,
        Self::StopE,
        Self::StopD,
        Self::StopC,
        Self::StopB,
        Self::StopA,
        Self::InvalidParameter,
    ];

    /// The alarm of the NCK channel.
    pub const fn nck(self) -> Entry {
        let (number, reactions, response, acknowledgement) = match self {
            Self::NotSafelyReferenced => (27000, DISPLAY, Response::None, SELF_CLEARING),
            Self::CrossComparison => (27001, INHIBIT, Response::Fixed(Level::F), RESET_OR_POWER_ON),
            Self::TestStop => (27002, DISPLAY, Response::None, SELF_CLEARING),
            Self::StaticDifference => (27005, DISPLAY, Response::None, SELF_CLEARING),
            Self::ExternalTest => (27006, DISPLAY, Response::None, SELF_CLEARING),
            Self::Standstill => (27010, NOT_READY, Response::Fixed(Level::B), POWER_ON),
            Self::SpeedLimit => (27011, STOP, Response::Configured, RESET_OR_POWER_ON),
            Self::EndStop => (27012, STOP, Response::Configured, RESET),
            Self::BrakingRamp => (27013, NOT_READY, Response::Fixed(Level::A), POWER_ON),
            Self::StopE => (27020, STOP, Response::Fixed(Level::E), RESET),
            Self::StopD => (27021, STOP, Response::Fixed(Level::D), RESET),
            Self::StopC => (27022, STOP, Response::Fixed(Level::C), RESET),
            Self::StopB => (27023, NOT_READY, Response::Fixed(Level::B), POWER_ON),
            Self::StopA => (27024, NOT_READY, Response::Fixed(Level::A), POWER_ON),
            Self::InvalidParameter => (27033, NOT_READY, Response::None, POWER_ON),
        };
        Entry {
            number,
            reactions,
            response,
            acknowledgement,
        }
    }

    /// The alarm of the drive channel; `None` where only the NCK has one.
    ///
    /// It differs from the one of the NCK in the number, and for STOP F and the test of the shutdown path also in reaction
    /// and acknowledgement.
    pub const fn drive(self) -> Option<Entry> {
        let nck = self.nck();
        let number = match self {
            Self::NotSafelyReferenced => 300950,
            Self::CrossComparison => {
                return Some(Entry {
                    number: 300911,
                    reactions: DISPLAY,
                    ..nck
                });
            }
            Self::TestStop => {
                return Some(Entry {
                    number: 300951,
                    acknowledgement: Acknowledgement {
                        class: Class::SelfClearing,
                        escalates: true,
                    },
                    ..nck
                });
            }
            Self::StaticDifference | Self::ExternalTest => return None,
            Self::Standstill => 300907,
            Self::SpeedLimit => 300914,
            Self::EndStop => 300915,
            Self::BrakingRamp => 300906,
            Self::StopE => 300910,
            Self::StopD => 300909,
            Self::StopC => 300908,
            Self::StopB => 300901,
            Self::StopA => 300900,
            Self::InvalidParameter => 301708,
        };
        Some(Entry { number, ..nck })
    }

    /// The alarm that follows where an internal stop is raised; `None` without stop.
    pub const fn of_stop(stop: InternalStop) -> Option<Self> {
        match stop {
            InternalStop::None => None,
            InternalStop::E => Some(Self::StopE),
            InternalStop::D => Some(Self::StopD),
            InternalStop::C => Some(Self::StopC),
            InternalStop::B => Some(Self::StopB),
            InternalStop::A => Some(Self::StopA),
        }
    }

    const fn bit(self) -> u16 {
        1 << self as u16
    }
}

/// Whether "static actual-value difference" is displayed: only where limit switches or cams are enabled and the user
/// agreement is given, and only beyond `tolerance` (SAFE_POS_TOL). S840D-ALARM-718.
pub const fn static_difference(
    se_sn_enabled: bool,
    agreed: bool,
    own: Position,
    other: Position,
    tolerance: Distance,
) -> bool {
    se_sn_enabled && agreed && own.distance(other).0 > tolerance.0
}

/// The alarms of one channel in one cycle, with the parameter of STOP F.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Alarms {
    set: u16,
    code: Code,
}

impl Alarms {
    /// No alarm.
    pub const NONE: Self = Self {
        set: 0,
        code: Code::NONE,
    };

    /// These alarms and `alarm`, if `present`.
    #[must_use]
    pub const fn with(self, alarm: Alarm, present: bool) -> Self {
        Self {
            set: if present {
                self.set | alarm.bit()
            } else {
                self.set
            },
            code: self.code,
        }
    }

    /// These alarms and STOP F with its code; 0 means that the other channel has found it.
    #[must_use]
    pub const fn with_fault(self, code: Code) -> Self {
        Self {
            set: self.set | Alarm::CrossComparison.bit(),
            code,
        }
    }

    /// Whether the alarm is among them.
    pub const fn contains(self, alarm: Alarm) -> bool {
        self.set & alarm.bit() != 0
    }

    /// Whether there is none.
    pub const fn is_empty(self) -> bool {
        self.set == 0
    }

    /// The code of STOP F, where [`Alarm::CrossComparison`] is among them; else 0.
    pub const fn code(self) -> Code {
        self.code
    }

    /// The alarms, by number.
    pub fn iter(self) -> impl Iterator<Item = Alarm> {
        Alarm::ALL
            .into_iter()
            .filter(move |alarm| self.contains(*alarm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in() {
        assert!(Alarms::NONE.is_empty());
        for alarm in Alarm::ALL {
            assert!(Alarms::NONE.with(alarm, false).is_empty());
            let one = Alarms::NONE.with(alarm, true);
            assert!(one.iter().eq([alarm]));
        }
        let fault = Alarms::NONE
            .with(Alarm::StopB, true)
            .with_fault(Code::POSITION);
        assert_eq!(fault.code(), Code::POSITION);
        assert!(fault.iter().eq([Alarm::CrossComparison, Alarm::StopB]));
    }

    #[test]
    fn numbers_rise_and_escalation_needs_power_on() {
        for pair in Alarm::ALL.windows(2) {
            assert!(pair[0].nck().number < pair[1].nck().number);
        }
        let fault = Alarm::CrossComparison.nck().acknowledgement;
        assert_eq!(fault.needed(false), Class::Reset);
        assert_eq!(fault.needed(true), Class::PowerOn);
        assert_eq!(RESET.needed(true), Class::Reset);
    }

    #[test]
    fn the_static_difference_is_shown_beyond_the_tolerance_only() {
        let shown = |se_sn, agreed, other| {
            static_difference(se_sn, agreed, Position(0), Position(other), Distance(100))
        };
        assert!(shown(true, true, -101));
        assert!(!shown(true, true, -100));
        assert!(!shown(false, true, -101));
        assert!(!shown(true, false, -101));
    }
}
