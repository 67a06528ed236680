//! What the Extended Functions of a channel tell, and what the channels compare.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{
    gear, reference, safe_position, sdi, setpoint_limit, slp, sls, sos, ss1, ss2, ssm, stop_arbiter,
};

use super::super::messages::Messages;

/// What the channels compare with each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in super::super) struct Results {
    pub stop: Stop,
    pub function: Function,
    pub sos: bool,
    pub sls: bool,
    pub sls_level: u8,
    pub sdi: [bool; 2],
    pub slp: bool,
    pub stage: u8,
}

/// Why a channel has found a difference: STOP F.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in super::super) enum Defect {
    #[default]
    Channels,
    Gear,
    Wide,
    Value,
}

impl Defect {
    /// In words, and when STOP F has become STOP B.
    pub const fn texts(self) -> [&'static str; 2] {
        match self {
            Self::Channels => ["the channels differ", "STOP F: the channels differ"],
            Self::Gear => [
                "the tolerance of the gear was increased for too long",
                "STOP F: the tolerance of the gear was increased for too long",
            ],
            Self::Wide => [
                "the position does not fit 16 bits",
                "STOP F: the position does not fit 16 bits",
            ],
            Self::Value => [
                "the actual value is not plausible",
                "STOP F: the actual value is not plausible",
            ],
        }
    }

    /// The value of C01711 that the manual prints.
    pub const fn value(self) -> u16 {
        match self {
            Self::Channels => 0,
            Self::Gear => 1_015,
            Self::Wide => 7_001,
            Self::Value => 1_040,
        }
    }
}

/// What raises stops in a cycle.
#[derive(Clone, Copy)]
pub(in super::super) struct Raised {
    pub request: Stop,
    pub difference: bool,
    /// A message that asks for no stop: the user agreement was missed.
    pub notice: bool,
    /// The value of C01711; 0: none is printed.
    pub value: u16,
    pub messages: Messages,
    pub cause: &'static str,
    pub monitored: bool,
}

/// What the functions tell.
#[derive(Clone, Copy, Default)]
pub(in super::super) struct Told {
    pub ss1: ss1::Outputs,
    pub ss2: ss2::Outputs,
    pub sos: sos::Outputs,
    pub sos_reference: Position,
    pub sls: sls::Outputs,
    pub sdi: [sdi::Outputs; 2],
    pub slp: slp::Outputs,
    pub slp_second: bool,
    /// r9722.30 and r9722.31: the upper and the lower limit are kept.
    pub slp_kept: [bool; 2],
    pub reference: reference::Outputs,
    pub gear: gear::Outputs,
    pub transferred: safe_position::Outputs,
    pub ssm: ssm::Outputs,
    /// What SAM or SBR compares the speed with.
    pub braking_limit: Speed,
    pub arbiter: stop_arbiter::Outputs,
    pub function: Function,
    pub setpoint: Option<setpoint_limit::Outputs>,
    pub results: Results,
    /// Of what is latched.
    pub cause: &'static str,
    pub messages: Messages,
    /// A function is active whose stop does not wait for ESR.
    pub undelayed: bool,
}
