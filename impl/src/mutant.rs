//! Deliberately wrong step functions: tests of the tests. Compiled only with the feature `mutants`, reachable from no
//! production path.
//!
//! Each mutant replaces the step function of one monitor by a wrapper that alters the step in one way. A proof harness or
//! a differential check that cannot tell it from the production function is too weak. The mutants carry no contract
//! assertions, so that it is the check that finds them.

use core::str::FromStr;

use crate::kernel::{Cycles, ExternalStop, InternalStop};
use crate::{agreement, external, fault, gear, reference, selection, stop};

/// A wrong variant of one monitor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mutant {
    /// STOP B never becomes STOP A by its timer, only by standstill.
    StopBNoTimerExit,
    /// A lower stop displaces a higher latched one.
    StopLowerDisplaces,
    /// RESET acknowledges a STOP C, D or E already while it brakes.
    StopResetWhileBraking,
    /// A rise to a higher stop in the operating stop starts a new braking phase.
    StopReleasesStandstill,
    /// The signals count before the comparison of the safe logic has been started.
    ExternalBeforeStart,
    /// STOP D comes before STOP C.
    ExternalWrongPriority,
    /// RESET aborts the delay from STOP F to STOP B.
    FaultDelayAborted,
    /// A STOP C, D or E keeps STOP B from following also when it comes during the delay.
    FaultDelayHeldByStop,
    /// The delay to a lower limit or to the operating stop is one cycle short.
    SelectionDelayShort,
    /// The forced operating stop follows the de-selection signal.
    SelectionForcedDeselects,
    /// The reference of the operating stop is captured anew in every cycle.
    SelectionReferenceCreeps,
    /// One agreement of the two is enough for the safe reference.
    ReferenceOneAgreement,
    /// "Safely referenced" outlives the agreement by a cycle.
    ReferenceLateReset,
    /// The agreement is kept when the gear stage changes.
    AgreementKeptAfterGear,
    /// The agreement is kept when the comparison with the history fails.
    AgreementNoHistory,
    /// The agreement is given without the key.
    AgreementWithoutKey,
    /// A change of the gear stage to stage 1 is overlooked.
    GearChangeOverlooked,
}

/// A name that is no mutant's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownMutant;

impl core::fmt::Display for UnknownMutant {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("no mutant has this name; the names are")?;
        for mutant in Mutant::ALL {
            write!(f, " {}", mutant.name())?;
        }
        Ok(())
    }
}

impl core::error::Error for UnknownMutant {}

impl FromStr for Mutant {
    type Err = UnknownMutant;

    fn from_str(name: &str) -> Result<Self, UnknownMutant> {
        Self::ALL
            .iter()
            .copied()
            .find(|mutant| mutant.name() == name)
            .ok_or(UnknownMutant)
    }
}

impl Mutant {
    /// Every mutant.
    pub const ALL: &[Self] = &[
        Self::StopBNoTimerExit,
        Self::StopLowerDisplaces,
        Self::StopResetWhileBraking,
        Self::StopReleasesStandstill,
        Self::ExternalBeforeStart,
        Self::ExternalWrongPriority,
        Self::FaultDelayAborted,
        Self::FaultDelayHeldByStop,
        Self::SelectionDelayShort,
        Self::SelectionForcedDeselects,
        Self::SelectionReferenceCreeps,
        Self::ReferenceOneAgreement,
        Self::ReferenceLateReset,
        Self::AgreementKeptAfterGear,
        Self::AgreementNoHistory,
        Self::AgreementWithoutKey,
        Self::GearChangeOverlooked,
    ];

    /// The name for command lines: the monitor first.
    pub const fn name(self) -> &'static str {
        match self {
            Self::StopBNoTimerExit => "stop-b-no-timer-exit",
            Self::StopLowerDisplaces => "stop-lower-displaces",
            Self::StopResetWhileBraking => "stop-reset-while-braking",
            Self::StopReleasesStandstill => "stop-releases-standstill",
            Self::ExternalBeforeStart => "external-before-start",
            Self::ExternalWrongPriority => "external-wrong-priority",
            Self::FaultDelayAborted => "fault-delay-aborted",
            Self::FaultDelayHeldByStop => "fault-delay-held-by-stop",
            Self::SelectionDelayShort => "selection-delay-short",
            Self::SelectionForcedDeselects => "selection-forced-deselects",
            Self::SelectionReferenceCreeps => "selection-reference-creeps",
            Self::ReferenceOneAgreement => "reference-one-agreement",
            Self::ReferenceLateReset => "reference-late-reset",
            Self::AgreementKeptAfterGear => "agreement-kept-after-gear",
            Self::AgreementNoHistory => "agreement-no-history",
            Self::AgreementWithoutKey => "agreement-without-key",
            Self::GearChangeOverlooked => "gear-change-overlooked",
        }
    }

    /// The arbitration with this mutant in it: the production function unless the mutant is one of it.
    pub fn stop(self) -> stop::Next {
        match self {
            Self::StopBNoTimerExit => stop_b_no_timer_exit,
            Self::StopLowerDisplaces => stop_lower_displaces,
            Self::StopResetWhileBraking => stop_reset_while_braking,
            Self::StopReleasesStandstill => stop_releases_standstill,
            _ => stop::next,
        }
    }

    /// The external stops with this mutant in them.
    pub fn external(self) -> external::Next {
        match self {
            Self::ExternalBeforeStart => external_before_start,
            Self::ExternalWrongPriority => external_wrong_priority,
            _ => external::next,
        }
    }

    /// STOP F with this mutant in it.
    pub fn fault(self) -> fault::Next {
        match self {
            Self::FaultDelayAborted => fault_delay_aborted,
            Self::FaultDelayHeldByStop => fault_delay_held_by_stop,
            _ => fault::next,
        }
    }

    /// The selection with this mutant in it.
    pub fn selection(self) -> selection::Next {
        match self {
            Self::SelectionDelayShort => selection_delay_short,
            Self::SelectionForcedDeselects => selection_forced_deselects,
            Self::SelectionReferenceCreeps => selection_reference_creeps,
            _ => selection::next,
        }
    }

    /// The referencing with this mutant in it.
    pub fn reference(self) -> reference::Next {
        match self {
            Self::ReferenceOneAgreement => reference_one_agreement,
            Self::ReferenceLateReset => reference_late_reset,
            _ => reference::next,
        }
    }

    /// The agreement with this mutant in it.
    pub fn agreement(self) -> agreement::Next {
        match self {
            Self::AgreementKeptAfterGear => agreement_kept_after_gear,
            Self::AgreementNoHistory => agreement_no_history,
            Self::AgreementWithoutKey => agreement_without_key,
            _ => agreement::next,
        }
    }

    /// The gear stage with this mutant in it.
    pub fn gear(self) -> gear::Next {
        match self {
            Self::GearChangeOverlooked => gear_change_overlooked,
            _ => gear::next,
        }
    }
}

fn stop_b_no_timer_exit(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if state.phase == stop::Phase::BBraking && state.timer == Cycles::new(1) {
        state.timer = Cycles::new(2);
    }
    stop::transition(state, config, inputs)
}

fn stop_lower_displaces(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if inputs.demand != InternalStop::None && inputs.demand < state.internal {
        state = stop::State::INITIAL;
    }
    stop::transition(state, config, inputs)
}

fn stop_reset_while_braking(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if inputs.reset && state.phase == stop::Phase::Braking {
        state = stop::State::INITIAL;
    }
    stop::transition(state, config, inputs)
}

fn stop_releases_standstill(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if state.phase == stop::Phase::SbhInt && !inputs.reset && inputs.demand.level() > state.level {
        state = stop::State {
            internal: state.internal,
            ..stop::State::INITIAL
        };
    }
    stop::transition(state, config, inputs)
}

fn external_before_start(
    state: external::State,
    config: &external::Config,
    inputs: &external::Inputs,
) -> (external::State, external::Outputs) {
    let (after, mut outputs) = external::transition(state, config, inputs);
    if !after.started && !after.spl_latched {
        outputs.request = outputs.selected;
    }
    (after, outputs)
}

fn external_wrong_priority(
    state: external::State,
    config: &external::Config,
    inputs: &external::Inputs,
) -> (external::State, external::Outputs) {
    let (after, mut outputs) = external::transition(state, config, inputs);
    if outputs.request == ExternalStop::C && !inputs.sge_d {
        outputs.request = ExternalStop::D;
    }
    (after, outputs)
}

fn fault_delay_aborted(
    state: fault::State,
    config: &fault::Config,
    inputs: &fault::Inputs,
) -> (fault::State, fault::Outputs) {
    let mut state = state;
    if inputs.reset && state.fault == fault::FaultState::Delay {
        state = fault::State::INITIAL;
    }
    fault::transition(state, config, inputs)
}

fn fault_delay_held_by_stop(
    state: fault::State,
    config: &fault::Config,
    inputs: &fault::Inputs,
) -> (fault::State, fault::Outputs) {
    let mut state = state;
    if inputs.cde_before && state.fault == fault::FaultState::Delay {
        state = fault::State {
            fault: fault::FaultState::Latched,
            timer: Cycles::ZERO,
        };
    }
    fault::transition(state, config, inputs)
}

fn selection_delay_short(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut state = state;
    if state.timer > Cycles::new(1) {
        state.timer = state.timer.tick();
    }
    selection::transition(state, config, inputs)
}

fn selection_forced_deselects(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut inputs = *inputs;
    inputs.sbh_internal &= !inputs.sge_sbh_sg;
    selection::transition(state, config, &inputs)
}

fn selection_reference_creeps(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut state = state;
    if state.mode == selection::Mode::Sbh {
        state.reference = inputs.position;
    }
    selection::transition(state, config, inputs)
}

fn reference_one_agreement(
    state: reference::State,
    config: &reference::Config,
    inputs: &reference::Inputs,
) -> (reference::State, reference::Outputs) {
    let agreed = inputs.agreed_1 || inputs.agreed_2;
    let inputs = reference::Inputs {
        agreed_1: agreed,
        agreed_2: agreed,
        ..*inputs
    };
    reference::transition(state, config, &inputs)
}

fn reference_late_reset(
    state: reference::State,
    config: &reference::Config,
    inputs: &reference::Inputs,
) -> (reference::State, reference::Outputs) {
    let (after, mut outputs) = reference::transition(state, config, inputs);
    outputs.safely_referenced |= state.axis == reference::AxisState::SafeRef && !inputs.power_on;
    (after, outputs)
}

fn agreement_kept_after_gear(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            gear_changed: false,
            ..*inputs
        },
    )
}

fn agreement_no_history(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            compare_due: false,
            ..*inputs
        },
    )
}

fn agreement_without_key(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            key: inputs.key || inputs.set,
            ..*inputs
        },
    )
}

fn gear_change_overlooked(
    state: gear::State,
    config: &gear::Config,
    inputs: &gear::Inputs,
) -> (gear::State, gear::Outputs) {
    let (after, mut outputs) = gear::transition(state, config, inputs);
    outputs.changed &= after.stage != gear::GearIndex::FIRST;
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_found_again() {
        for (index, mutant) in Mutant::ALL.iter().enumerate() {
            assert_eq!(
                Mutant::ALL
                    .iter()
                    .position(|other| other.name() == mutant.name()),
                Some(index)
            );
            assert_eq!(Mutant::from_str(mutant.name()), Ok(*mutant));
        }
        assert_eq!(Mutant::from_str("none"), Err(UnknownMutant));
    }
}
