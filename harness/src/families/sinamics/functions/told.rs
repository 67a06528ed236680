//! What the Extended Functions of a channel tell, and what the channels compare.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::cross_check::{Defect, Results};
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{
    acceptance_mode, gear, reference, safe_position, sdi, setpoint_limit, slp, sls, sos, ss1, ss2,
    ssm, stop_arbiter,
};

use super::super::messages::Messages;

/// A defect in words, and when STOP F has become STOP B.
pub(in super::super) const fn texts(defect: Defect) -> [&'static str; 2] {
    match defect {
        Defect::None | Defect::Channels => ["the channels differ", "STOP F: the channels differ"],
        Defect::Gear => [
            "the tolerance of the gear was increased for too long",
            "STOP F: the tolerance of the gear was increased for too long",
        ],
        Defect::Wide => [
            "the position does not fit 16 bits",
            "STOP F: the position does not fit 16 bits",
        ],
        Defect::Implausible => [
            "the actual value is not plausible",
            "STOP F: the actual value is not plausible",
        ],
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
    pub mode: acceptance_mode::Outputs,
    pub sls: sls::Outputs,
    /// The limit of SLS that is asked for, whether it is monitored yet or not.
    pub sls_asked: Speed,
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
