//! The monitoring state of one axis group in one channel (`NN_AxGrpState`).
//!
//! Steps after the stop of the group. A stricter request takes effect at once, a laxer one only with an activation from
//! standstill: closing a door never starts a motion. While a stop brakes along the emergency ramp the state stays what it
//! was, and so do its limits.
//!
//! Recommended readings of the manual implemented here: AMB-07 STO_O, AMB-09, AMB-56 KEEP, AMB-66 KEEP, AMB-72 SS1 (a request
//! for torque off in motion leaves the state to the stop that follows).

use crate::heidenhain::types::{GroupState, Kind, Phase, Stop};
use crate::kernel::ConfigError;

mod laws;

pub use laws::*;

/// What the group consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    kind: Kind,
}

impl Config {
    /// `kind`: what the group consists of (MP100).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(kind: Kind) -> Result<Self, ConfigError> {
        Ok(Self { kind })
    }

    /// What the group consists of.
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Whether such a group may be released in a state: restricted operation is for spindles.
    pub const fn may_release(&self, state: GroupState) -> bool {
        match state {
            GroupState::SlsS => matches!(self.kind, Kind::Spindle),
            _ => state.is_released(),
        }
    }

    /// The standstill state: under control for axes, torque off for spindles.
    const fn rest(&self) -> GroupState {
        match self.kind {
            Kind::Spindle => GroupState::StoO,
            Kind::NcAxes | Kind::Auxiliary => GroupState::Sos,
        }
    }
}

/// The state between two cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct State {
    /// The monitoring state.
    pub state: GroupState,
    /// The limits of SLS_2 and SLS_3 apply together, until the group stands.
    pub both: bool,
}

impl State {
    /// Torque off, as after every start of the control.
    pub const INITIAL: Self = Self {
        state: GroupState::Sto,
        both: false,
    };

    /// Both limits apply in one of their states only; restricted operation is for spindles.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        (!self.both || matches!(self.state, GroupState::Sls2 | GroupState::Sls3))
            && (!self.state.is_released() || config.may_release(self.state))
    }
}

/// The inputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Main switch off and on.
    pub main_switch: bool,
    /// The requested monitoring state (`PP_AxGrpStateReq`).
    pub request: GroupState,
    /// An event permits motion of the group (`PP_AxGrpActivate`).
    pub activate: bool,
    /// An axis of the group moves (`NN_AxGrpInMotion`).
    pub moving: bool,
    /// `NN_GenSafe`: the self-test has passed and is not overdue.
    pub gen_safe: bool,
    /// The highest cause of a stop in this cycle.
    pub demand: Stop,
    /// What the stop of the group is doing, after its step.
    pub phase: Phase,
    /// The torque is off at the end of an SS1D, which needs no drive-on.
    pub soft: bool,
    /// An SS2 has ended in this cycle, or was asked of a group that stands.
    pub ss2_ended: bool,
    /// Fresh edge of the drive permission, control voltage on, chain closed.
    pub switch_on: bool,
    /// The SS2 came from the spindle-stop key, and SMP549 asks for SOS.
    pub spindle_stop: bool,
}

/// The outputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The monitoring state (`NN_AxGrpState`).
    pub state: GroupState,
    /// The limits of SLS_2 and SLS_3 apply together.
    pub both: bool,
    /// The group is released and no stop brakes it.
    pub may_move: bool,
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.main_switch {
        State::INITIAL
    } else {
        state
    };
    let next = match inputs.phase {
        // A soft end must not lift a torque off that needs the operator.
        Phase::TorqueOff if inputs.soft && before.state != GroupState::Sto => GroupState::StoO,
        Phase::TorqueOff => GroupState::Sto,
        Phase::EmergencyBrake | Phase::BrakeCloses => before.state,
        Phase::Run | Phase::Ss2Wait | Phase::Ss2Brake | Phase::Ss1DWait => {
            controlled(before.state, config, inputs)
        }
    };
    let changed = matches!(
        (before.state, next),
        (GroupState::Sls2, GroupState::Sls3) | (GroupState::Sls3, GroupState::Sls2)
    );
    let limits = matches!(next, GroupState::Sls2 | GroupState::Sls3);
    let after = State {
        state: next,
        both: limits && inputs.moving && (before.both || changed),
    };
    let outputs = Outputs {
        state: after.state,
        both: after.both,
        may_move: after.state.is_released()
            && matches!(inputs.phase, Phase::Run | Phase::Ss2Wait | Phase::Ss1DWait),
    };
    (after, outputs)
}

/// The state of a group that no emergency ramp brakes.
fn controlled(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    let strict = match inputs.request {
        GroupState::StoO | GroupState::Sto if !inputs.moving => inputs.request,
        _ => GroupState::Auto,
    };
    match before {
        GroupState::Sto => leave_torque_off(config, inputs),
        GroupState::Sos | GroupState::StoO => {
            if releases(config, inputs) {
                inputs.request
            } else {
                before.stricter(strict)
            }
        }
        _ if inputs.ss2_ended => rest(config, inputs).stricter(strict),
        _ => released(before, config, inputs).stricter(strict),
    }
}

/// The standstill state: that of axes also for a spindle, where its stop key and SMP549 ask for it.
const fn rest(config: &Config, inputs: &Inputs) -> GroupState {
    if inputs.spindle_stop {
        GroupState::Sos
    } else {
        config.rest()
    }
}

/// STO is left by the operator's edge only, and not while a stop of rank SS1 is asked for.
fn leave_torque_off(config: &Config, inputs: &Inputs) -> GroupState {
    let switched = inputs.switch_on
        && inputs.phase == Phase::Run
        && inputs.demand < Stop::Ss1D
        && inputs.request != GroupState::Sto;
    match inputs.request {
        _ if !switched => GroupState::Sto,
        GroupState::StoO => GroupState::StoO,
        _ => config.rest(),
    }
}

/// A standing group is released by an activation without any stop; with the door open the self-test must be in force.
fn releases(config: &Config, inputs: &Inputs) -> bool {
    inputs.activate
        && inputs.phase == Phase::Run
        && inputs.demand == Stop::None
        && config.may_release(inputs.request)
        && (inputs.gen_safe || inputs.request == GroupState::Auto)
}

/// The next state of a released group by its request; torque off is looked after by the caller.
fn released(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    use GroupState::{Auto, Sls2, Sls3, Sls4, SlsS, Sos};
    let standing = if inputs.moving {
        None
    } else {
        Some(config.rest())
    };
    match (before, inputs.request) {
        // In motion a stop follows; the limits stay until then.
        (_, Sos) => standing.unwrap_or(before),
        (Auto, request) if config.may_release(request) => request,
        (Sls2 | Sls3, Sls2 | Sls3) => inputs.request,
        (Sls2 | Sls3 | Sls4, SlsS) if config.may_release(SlsS) => standing.unwrap_or(SlsS),
        (SlsS, Sls2 | Sls3 | Sls4) => standing.unwrap_or(SlsS),
        (_, Auto) if releases(config, inputs) => Auto,
        _ => before,
    }
}
