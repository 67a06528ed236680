//! The safe reference of an axis as it comes about: gear stage, the agreements of two channels and the referencing
//! stepped together in the order of the cycle.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::reference::AxisState;
use stillpoint_monitors::sinumerik::{agreement, gear, reference};

use super::Subject;
use crate::draw;
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

/// The state of both channels of an axis, and what each has told the other one of its agreement.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Axis {
    reference: [reference::State; 2],
    agreement: [agreement::State; 2],
    gear: [gear::State; 2],
    confirmed: [bool; 2],
}

/// The inputs of an axis; what the machines tell each other is filled in by [`step`].
#[derive(Clone, Copy)]
struct Cycle {
    gear: [gear::Inputs; 2],
    agreement: [agreement::Inputs; 2],
    reference: [reference::Inputs; 2],
}

/// One cycle of both channels; each reads what the other one has told in the cycle before.
fn step(
    subject: &Subject,
    parameters: &Parameters,
    axis: Axis,
    cycle: Cycle,
) -> (Axis, [reference::Outputs; 2]) {
    let mut after = axis;
    let mut shown = [reference::Outputs::default(); 2];
    for (channel, other) in [(0, 1), (1, 0)] {
        let (gear, gear_shown) =
            subject.gear(axis.gear[channel], &parameters.gear, &cycle.gear[channel]);
        let inputs = agreement::Inputs {
            axis_ref: axis.reference[channel].axis == AxisState::Ref,
            compare_due: axis.reference[channel].fresh,
            gear_changed: gear_shown.changed,
            other_agreed: axis.agreement[other].agreed,
            ..cycle.agreement[channel]
        };
        let (agreement, _) =
            subject.agreement(axis.agreement[channel], &parameters.agreement, &inputs);
        let inputs = reference::Inputs {
            agreed_1: agreement.agreed,
            agreed_2: axis.confirmed[other],
            ..cycle.reference[channel]
        };
        let (reference, out) =
            subject.reference(axis.reference[channel], &parameters.reference, &inputs);
        after.gear[channel] = gear;
        after.agreement[channel] = agreement;
        after.reference[channel] = reference;
        after.confirmed[channel] = out.confirmed;
        shown[channel] = out;
    }
    (after, shown)
}

fn quiet() -> Cycle {
    Cycle {
        gear: [gear::Inputs::default(); 2],
        agreement: [agreement::Inputs::default(); 2],
        reference: [reference::Inputs {
            run_up: true,
            ..reference::Inputs::default()
        }; 2],
    }
}

/// A change of the gear stage in one channel ends the safe reference there in the same cycle, also when the user agrees in
/// it, and in the other channel in the next one.
///
/// Cover 0: the axis was safely referenced before.
pub fn gear_change_ends_safe_reference<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Some(parameters) = Parameters::new(2) else {
        return Verdict::Discarded;
    };
    let state = source.any_of(&[AxisState::NotRef, AxisState::Ref, AxisState::SafeRef]);
    let (old, new) = (draw::any(source), draw::any(source));
    if old == new {
        return Verdict::Discarded;
    }
    let channel = source.any_in(0, 1) as usize;
    let agreed = [source.any_bool(), source.any_bool()];
    let known = gear::State {
        stage: old,
        known: true,
    };
    let axis = Axis {
        reference: [reference::State {
            axis: state,
            fresh: false,
        }; 2],
        agreement: agreed.map(agreement::State::restored),
        gear: [known; 2],
        confirmed: agreed.map(|agreed| agreed && state != AxisState::NotRef),
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
    let (_, next) = step(subject, &parameters, after, cycle);
    if !shown[channel].safely_referenced
        && after.reference[channel].axis != AxisState::SafeRef
        && !after.agreement[channel].agreed
        && !next[1 - channel].safely_referenced
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
    let Some(parameters) = Parameters::new(10) else {
        return Verdict::Discarded;
    };
    let mut axis = Axis {
        reference: [reference::State::INITIAL; 2],
        agreement: [agreement::State::restored(true); 2],
        gear: [gear::State::INITIAL; 2],
        confirmed: [false; 2],
    };
    let mut cycle = quiet();
    for inputs in &mut cycle.agreement {
        inputs.stored = source.any_bool();
        inputs.history_ok = source.any_bool();
    }
    let succeeds = cycle
        .agreement
        .map(|inputs| inputs.stored && inputs.history_ok);
    let power_on = Cycle {
        reference: cycle.reference.map(|inputs| reference::Inputs {
            power_on: true,
            ..inputs
        }),
        ..cycle
    };
    // The channels are referenced in any order, or together.
    let late = [source.any_bool(), source.any_bool()];
    let referenced = |wanted: bool| Cycle {
        reference: [0, 1].map(|channel| reference::Inputs {
            referenced: late[channel] == wanted,
            ..cycle.reference[channel]
        }),
        ..cycle
    };
    // Power-on and run-up, referenced, compared, told; in no cycle is it shown in a channel unless both succeed, and not
    // before both have compared.
    let run = [power_on, referenced(false), referenced(true), cycle, cycle];
    let mut compared = [false; 2];
    for inputs in run {
        let due = axis.reference.map(|reference| reference.fresh);
        let (after, shown) = step(subject, &parameters, axis, inputs);
        axis = after;
        if shown.iter().any(|shown| shown.safely_referenced)
            && ([0, 1].iter().any(|&k: &usize| !compared[k] && !due[k]) || succeeds != [true; 2])
        {
            return Verdict::Broken("no_safe_reference_before_the_comparison");
        }
        compared = [compared[0] || due[0], compared[1] || due[1]];
    }
    source.cover(0, succeeds == [true, true]);
    source.cover(1, succeeds[0] != succeeds[1]);
    let safe = axis
        .reference
        .map(|reference| reference.axis == AxisState::SafeRef);
    let agreed = axis.agreement.map(|agreement| agreement.agreed);
    if safe == [succeeds == [true, true]; 2] && agreed == succeeds {
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
        reference: [reference::State {
            axis: AxisState::Ref,
            fresh: false,
        }; 2],
        agreement: [agreement::State::restored(false); 2],
        gear: [gear::State {
            stage: gear::GearIndex::FIRST,
            known: true,
        }; 2],
        confirmed: [false; 2],
    };
    axis.agreement[single].agreed = true;
    axis.confirmed[single] = true;
    for _ in 0..=t_differ {
        let mut cycle = quiet();
        let parking = source.any_bool();
        for inputs in &mut cycle.reference {
            inputs.parking = parking;
        }
        let (after, shown) = step(subject, &parameters, axis, cycle);
        axis = after;
        if shown.iter().any(|shown| shown.safely_referenced) {
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
