//! The safe reference of an axis as it comes about: gear stage, the agreements of two channels and the referencing
//! stepped together in the order of the cycle.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::reference::AxisState;
use stillpoint_monitors::sinumerik::{agreement, gear, reference};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::source::{Source, Verdict};

/// The parameters of an axis with limit switches.
struct Parameters {
    agreement: agreement::Config,
    gear: gear::Config,
    reference: reference::Config,
}

impl Parameters {
    fn new(t_differ: u32) -> Option<Self> {
        Some(Self {
            agreement: agreement::Config::new(Cycles::new(t_differ), true).ok()?,
            gear: gear::Config::new(7, true).ok()?,
            reference: reference::Config::new(true).ok()?,
        })
    }
}

/// The state of an axis: one referencing, two channels.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Axis {
    reference: reference::State,
    agreement: [agreement::State; 2],
    gear: [gear::State; 2],
}

/// The inputs of an axis; what the machines tell each other is filled in by [`step`].
#[derive(Clone, Copy)]
struct Cycle {
    gear: [gear::Inputs; 2],
    agreement: [agreement::Inputs; 2],
    reference: reference::Inputs,
}

fn step(
    subject: &Subject,
    parameters: &Parameters,
    axis: Axis,
    cycle: Cycle,
) -> (Axis, reference::Outputs) {
    let mut after = axis;
    for (channel, other) in [(0, 1), (1, 0)] {
        let (gear, gear_shown) =
            (subject.gear)(axis.gear[channel], &parameters.gear, &cycle.gear[channel]);
        let inputs = agreement::Inputs {
            axis_ref: axis.reference.axis == AxisState::Ref,
            compare_due: axis.reference.fresh,
            gear_changed: gear_shown.changed,
            other_agreed: axis.agreement[other].agreed,
            ..cycle.agreement[channel]
        };
        let (agreement, _) =
            (subject.agreement)(axis.agreement[channel], &parameters.agreement, &inputs);
        after.gear[channel] = gear;
        after.agreement[channel] = agreement;
    }
    let inputs = reference::Inputs {
        agreed_1: after.agreement[0].agreed,
        agreed_2: after.agreement[1].agreed,
        ..cycle.reference
    };
    let (reference, shown) = (subject.reference)(axis.reference, &parameters.reference, &inputs);
    after.reference = reference;
    (after, shown)
}

fn quiet() -> Cycle {
    Cycle {
        gear: [gear::Inputs::default(); 2],
        agreement: [agreement::Inputs::default(); 2],
        reference: reference::Inputs {
            run_up: true,
            ..reference::Inputs::default()
        },
    }
}

/// A change of the gear stage in one channel ends the safe reference in the same cycle, also when the user agrees in it.
///
/// Cover 0: the axis was safely referenced before.
pub fn gear_change_ends_safe_reference<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Some(parameters) = Parameters::new(2) else {
        return Verdict::Discarded;
    };
    let state = source.any_of(&[AxisState::NotRef, AxisState::Ref, AxisState::SafeRef]);
    let (old, new) = (arbitrary::gear_index(source), arbitrary::gear_index(source));
    if old == new {
        return Verdict::Discarded;
    }
    let channel = source.any_in(0, 1) as usize;
    let known = gear::State {
        stage: old,
        known: true,
    };
    let axis = Axis {
        reference: reference::State {
            axis: state,
            fresh: false,
        },
        agreement: [
            agreement::State::restored(source.any_bool()),
            agreement::State::restored(source.any_bool()),
        ],
        gear: [known; 2],
    };
    let mut cycle = quiet();
    cycle.gear = [gear::Inputs {
        power_on: false,
        index: old,
    }; 2];
    cycle.gear[channel].index = new;
    for inputs in &mut cycle.agreement {
        *inputs = agreement::Inputs {
            set: source.any_bool(),
            key: source.any_bool(),
            ..*inputs
        };
    }
    let both = axis.agreement.iter().all(|agreement| agreement.agreed);
    let (after, shown) = step(subject, &parameters, axis, cycle);
    source.cover(0, state == AxisState::SafeRef && both);
    if !shown.safely_referenced
        && after.reference.axis != AxisState::SafeRef
        && !after.agreement[channel].agreed
    {
        Verdict::Held
    } else {
        Verdict::Broken("gear_change_ends_safe_reference")
    }
}

/// After power-on with stored agreements an axis becomes safely referenced without the user exactly when the comparison
/// with the history succeeds in both channels.
///
/// Cover 0: it succeeds, cover 1: it fails in one channel only.
pub fn history_decides_after_power_on<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Some(parameters) = Parameters::new(2) else {
        return Verdict::Discarded;
    };
    let mut axis = Axis {
        reference: reference::State::INITIAL,
        agreement: [agreement::State::restored(true); 2],
        gear: [gear::State::INITIAL; 2],
    };
    let mut cycle = quiet();
    for inputs in &mut cycle.agreement {
        inputs.stored = source.any_bool();
        inputs.history_ok = source.any_bool();
    }
    let succeeds = cycle
        .agreement
        .map(|inputs| inputs.stored && inputs.history_ok);
    let mut power_on = cycle;
    power_on.reference.power_on = true;
    let mut referenced = cycle;
    referenced.reference.referenced = true;
    // Power-on and run-up, referenced, compared.
    for (inputs, before_comparison) in [(power_on, true), (referenced, true), (cycle, false)] {
        let (after, shown) = step(subject, &parameters, axis, inputs);
        axis = after;
        if before_comparison && shown.safely_referenced {
            return Verdict::Broken("no_safe_reference_before_the_comparison");
        }
    }
    source.cover(0, succeeds == [true, true]);
    source.cover(1, succeeds[0] != succeeds[1]);
    let safe = axis.reference.axis == AxisState::SafeRef;
    let agreed = axis.agreement.map(|agreement| agreement.agreed);
    if safe == (succeeds == [true, true]) && agreed == succeeds {
        Verdict::Held
    } else {
        Verdict::Broken("history_decides_after_power_on")
    }
}

/// An agreement given or withdrawn in one channel only does not last: after t_differ cycles neither channel has it, and
/// meanwhile the axis is not safely referenced.
///
/// Cover 0: one channel alone agreed.
pub fn single_agreement_does_not_last<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_differ = source.any_in(1, 3);
    let Some(parameters) = Parameters::new(t_differ) else {
        return Verdict::Discarded;
    };
    let single = source.any_in(0, 1) as usize;
    let mut axis = Axis {
        reference: reference::State {
            axis: AxisState::Ref,
            fresh: false,
        },
        agreement: [agreement::State::restored(false); 2],
        gear: [gear::State {
            stage: gear::GearIndex::FIRST,
            known: true,
        }; 2],
    };
    axis.agreement[single].agreed = true;
    for _ in 0..=t_differ {
        let mut cycle = quiet();
        cycle.reference.parking = source.any_bool();
        let (after, shown) = step(subject, &parameters, axis, cycle);
        axis = after;
        if shown.safely_referenced {
            return Verdict::Broken("no_safe_reference_with_one_agreement");
        }
    }
    source.cover(0, true);
    if axis.agreement.iter().any(|agreement| agreement.agreed) {
        Verdict::Broken("single_agreement_is_withdrawn")
    } else {
        Verdict::Held
    }
}
