//! Wrong couplings of the two channels: what one tells, and what the other one makes of it.

use crate::sinumerik::axis::{Exchange, TestResult};
use crate::sinumerik::fault::FaultState;
use crate::sinumerik::level::{ExternalStop, Level};
use crate::sinumerik::pair::{Config, Inputs, Outputs, State, next};

/// A cycle after which something else has been told.
fn told(
    state: State,
    config: &Config,
    inputs: &Inputs,
    alter: impl Fn(&mut State),
) -> (State, Outputs) {
    let (mut after, outputs) = next(state, config, inputs);
    alter(&mut after);
    (after, outputs)
}

pub(super) fn stop_late(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.internal = state.nck.channel.stop.internal;
    })
}

pub(super) fn request_late(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_drive.external = state.drive.channel.stop.external;
    })
}

pub(super) fn request_passed_back(
    state: State,
    config: &Config,
    inputs: &Inputs,
) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.external = after.from_nck.external.max(state.from_drive.external);
        after.from_drive.external = after.from_drive.external.max(state.from_nck.external);
    })
}

pub(super) fn own_request_read(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.external = after.from_drive.external;
    })
}

pub(super) fn test_passed_on(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        if after.nck.channel.stop.level == Level::Test {
            after.from_nck.external = ExternalStop::A;
        }
    })
}

pub(super) fn fault_not_told(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_drive.fault = false
    })
}

pub(super) fn fault_late(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.fault = state.nck.channel.fault.fault != FaultState::None;
    })
}

pub(super) fn reset_while_other_brakes(
    state: State,
    config: &Config,
    inputs: &Inputs,
) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_drive.braking = false
    })
}

pub(super) fn agreement_stale(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_drive.agreed = state.drive.agreement.agreed;
    })
}

pub(super) fn own_agreement_read(
    state: State,
    config: &Config,
    inputs: &Inputs,
) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.agreed = after.from_drive.agreed;
    })
}

pub(super) fn history_not_compared_in_drive(
    mut state: State,
    config: &Config,
    inputs: &Inputs,
) -> (State, Outputs) {
    state.drive.reference.fresh = false;
    next(state, config, inputs)
}

pub(super) fn change_not_told(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.changing = false;
    })
}

pub(super) fn lists_apart(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_nck.snapshot.results_1 = state.nck.told.results_1;
    })
}

pub(super) fn test_result_lost(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        after.from_drive.test = TestResult::None;
    })
}

pub(super) fn nothing_told(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    told(state, config, inputs, |after| {
        let snapshot = after.from_drive.snapshot;
        after.from_drive = Exchange {
            snapshot,
            ..Exchange::default()
        };
    })
}
