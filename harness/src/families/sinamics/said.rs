//! What a channel of a drive tells.

use stillpoint_monitors::kernel::Speed;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::{gear, reference, safe_position};

use super::messages::Messages;
use super::{bare, service};

/// What a channel tells in a cycle.
#[derive(Clone, Copy, Default)]
pub(super) struct Said {
    pub position: i32,
    pub speed: Speed,
    pub stop: Stop,
    pub stop_f: bool,
    pub cause: &'static str,
    pub messages: Messages,
    pub sto: bool,
    pub ss1: bool,
    pub ss2: bool,
    pub ss2e: bool,
    pub sos: bool,
    /// SOS is selected, also by a stop that ends in it.
    pub sos_selected: bool,
    pub sos_violated: bool,
    pub sos_reference: i32,
    pub sls: bool,
    pub sls_level: u8,
    pub sls_limit: Speed,
    pub sls_violated: bool,
    pub sdi: [bool; 2],
    pub slp: bool,
    pub slp_second: bool,
    pub slp_kept: [bool; 2],
    pub reference: reference::Outputs,
    pub gear: gear::Outputs,
    pub transferred: safe_position::Outputs,
    pub ssm: bool,
    pub braking_limit: Speed,
    pub function: Function,
    pub pulses_off: bool,
    /// S_ZSW1B.14: the control is to retract.
    pub esr: bool,
    /// The drive brakes along OFF3.
    pub off3: bool,
    /// The control is to brake, or to hold the axis: SOS, SS1E, SS2E, STOP D and E.
    pub control_brakes: bool,
    /// The setpoint has no effect.
    pub inhibited: bool,
    pub torque: bool,
    /// r9733\[2\], and both directions.
    pub setpoint: Speed,
    pub directions: Option<[Speed; 2]>,
    pub brake_open: bool,
    /// What the safety telegram says counts.
    pub valid: bool,
    pub event: bool,
    /// The value of C01711, until it is acknowledged.
    pub value: u16,
    /// Without encoder.
    pub bare: bare::Told,
    pub service: service::Told,
}
