//! The monitoring state of one axis group in one channel (`NN_AxGrpState`).
//!
//! Steps after the stop of the group. A stricter request takes effect at once, a laxer one only with an activation from
//! standstill: closing a door never starts a motion. While a stop runs the state stays what it was, and so do its limits; a
//! limit may still be added.
//!
//! Recommended readings of the manual implemented here: AMB-07 STO_O, AMB-09, AMB-56 KEEP, AMB-66 KEEP, AMB-72 SS1 (a request
//! for torque off in motion leaves the state to the stop that follows).

use crate::heidenhain::types::{GroupState, Kind, Left, Phase, Stop};
use crate::kernel::ConfigError;

mod laws;

pub use laws::*;

config! {
    /// What the group consists of.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        kind: Kind,
    }
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

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The monitoring state.
        pub state: GroupState,
        /// The modes it has left in motion, whose limits apply until it stands.
        pub left: Left,
    }
}

impl State {
    /// Torque off, as after every start of the control.
    pub const INITIAL: Self = Self {
        state: GroupState::Sto,
        left: Left::NONE,
    };

    /// Limits of other modes apply in one of these states only; restricted operation is for spindles.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        (self.left.is_none() || is_sls(self.state))
            && (!self.state.is_released() || config.may_release(self.state))
    }
}

fields! {
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
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The monitoring state (`NN_AxGrpState`).
        pub state: GroupState,
        /// The modes left in motion, whose limits apply as well.
        pub left: Left,
        /// The group is released; a stop may brake it all the same.
        pub may_move: bool,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = state.state;
    let next = match inputs.phase {
        _ if inputs.main_switch => GroupState::Sto,
        // A soft end must not lift a torque off that needs the operator.
        Phase::TorqueOff if inputs.soft && before != GroupState::Sto => GroupState::StoO,
        Phase::TorqueOff => GroupState::Sto,
        Phase::Run => free(before, config, inputs),
        Phase::Ss2Wait
        | Phase::Ss2Brake
        | Phase::Ss1DWait
        | Phase::EmergencyBrake
        | Phase::BrakeCloses => limit(before, config, inputs),
    };
    // While a stop runs, standing still for a moment does not end the limits of before.
    let kept = if inputs.moving || inputs.phase != Phase::Run {
        state.left
    } else {
        Left::NONE
    };
    let left = match is_sls(next) {
        true if before != next && inputs.moving => kept.and(before),
        true => kept,
        false => Left::NONE,
    };
    let after = State { state: next, left };
    let outputs = Outputs {
        state: after.state,
        left: after.left,
        may_move: after.state.is_released(),
    };
    (after, outputs)
}

/// Limited speed of one of the modes SOM_2 to SOM_4.
const fn is_sls(state: GroupState) -> bool {
    matches!(
        state,
        GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4
    )
}

/// The state while a stop runs: what it was, to which a limit may still be added.
fn limit(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    use GroupState::{Auto, Sls2, Sls3, Sls4, SlsS};
    let permitted = config.may_release(inputs.request);
    match (before, inputs.request) {
        (Auto, Sls2 | Sls3 | Sls4 | SlsS) | (Sls2 | Sls3 | Sls4, SlsS) if permitted => {
            inputs.request
        }
        _ => before,
    }
}

/// The state of a group without a stop.
fn free(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    if before == GroupState::Sto {
        return leave_torque_off(config, inputs);
    }
    if before.is_released() && inputs.ss2_ended {
        return rest(config, inputs);
    }
    if inputs.request.strictness() >= GroupState::Sos.strictness() {
        return stand(before, config, inputs);
    }
    if before.is_released() {
        released(before, config, inputs)
    } else if releases(config, inputs) {
        inputs.request
    } else {
        before
    }
}

/// The state at the end of an SS2: the standstill state, or the stricter one that is requested. A spindle stays under control
/// where its stop key and SMP549 ask for it and no standstill is requested.
fn rest(config: &Config, inputs: &Inputs) -> GroupState {
    match inputs.request {
        GroupState::Sto | GroupState::StoO => inputs.request,
        GroupState::Sos => config.rest(),
        _ if inputs.spindle_stop => GroupState::Sos,
        _ => config.rest(),
    }
}

/// The state where standstill or torque off is requested. In motion a stop follows, and the limits stay until then.
fn stand(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    let asked = match inputs.request {
        GroupState::Sos => config.rest(),
        request => request,
    };
    // A spindle that is under control by its stop key stays so.
    let stricter = inputs.request.strictness() > before.strictness();
    if stricter && !inputs.moving {
        asked
    } else {
        before
    }
}

/// STO is left by the operator's edge only, and not while a stop of rank SS1 is asked for.
fn leave_torque_off(config: &Config, inputs: &Inputs) -> GroupState {
    let switched =
        inputs.switch_on && inputs.demand < Stop::Ss1D && inputs.request != GroupState::Sto;
    match inputs.request {
        _ if !switched => GroupState::Sto,
        GroupState::StoO => GroupState::StoO,
        _ => config.rest(),
    }
}

/// An activation without any stop; with the door open the self-test must be in force.
fn releases(config: &Config, inputs: &Inputs) -> bool {
    inputs.activate
        && inputs.demand == Stop::None
        && config.may_release(inputs.request)
        && (inputs.gen_safe || inputs.request == GroupState::Auto)
}

/// The next state of a released group by a request for a released one.
fn released(before: GroupState, config: &Config, inputs: &Inputs) -> GroupState {
    use GroupState::{Auto, Sls2, Sls3, Sls4, SlsS};
    let request = inputs.request;
    match (before, request) {
        (Auto, _) if config.may_release(request) => request,
        // Between SOM_4 and the others the door was closed meanwhile; a direct change is SS1F and does not come here.
        (Sls2 | Sls3 | Sls4, Sls2 | Sls3 | Sls4) => request,
        (Sls2 | Sls3 | Sls4, SlsS) | (SlsS, Sls2 | Sls3 | Sls4) if config.may_release(SlsS) => {
            if inputs.moving {
                SlsS
            } else {
                config.rest()
            }
        }
        (_, Auto) if releases(config, inputs) => Auto,
        _ => before,
    }
}
