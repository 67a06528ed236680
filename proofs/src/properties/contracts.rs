//! The contract of every step function as a property: from any consistent state, under any accepted configuration and
//! any inputs, one step satisfies every clause. The invariant is one of the clauses, so the facts are inductive.

use stillpoint_monitors::channel;
use stillpoint_monitors::{agreement, external, fault, gear, group, reference, selection, stop};
use stillpoint_monitors::{cam, limit_switch, motion, ramp, results, speed, standstill, threshold};
use stillpoint_monitors::{compare, forced_check, history, pulses, shutdown_test, slip, test_stop};

use crate::arbitrary;
use crate::properties::Subject;
use crate::source::{Source, Verdict};

macro_rules! contract_property {
    ($(#[$doc:meta])* $monitor:ident) => {
        $(#[$doc])*
        pub fn $monitor<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
            let Some((before, config, inputs)) = arbitrary::$monitor(source) else {
                return Verdict::Discarded;
            };
            let (after, outputs) = (subject.$monitor)(before, &config, &inputs);
            let step = $monitor::Step { before, config, inputs, after, outputs };
            let result = $monitor::evaluate(step);
            for index in 0..$monitor::CLAUSES.len() {
                source.cover(index, (result.premises >> index) & 1 == 1);
            }
            if let Some(index) = result.first_broken($monitor::CLAUSES.len()) {
                return Verdict::Broken($monitor::CLAUSES.get(index).map_or("", |clause| clause.name));
            }
            Verdict::Held
        }
    };
}

contract_property! {
    /// The contract of the arbitration.
    stop
}
contract_property! {
    /// The contract of the external stops.
    external
}
contract_property! {
    /// The contract of STOP F.
    fault
}
contract_property! {
    /// The contract of the selection.
    selection
}
contract_property! {
    /// The contract of the referencing.
    reference
}
contract_property! {
    /// The contract of the user agreement.
    agreement
}
contract_property! {
    /// The contract of the gear stage.
    gear
}
contract_property! {
    /// The contract of the effect on other axes.
    group
}
contract_property! {
    /// The contract of the test of the shutdown path.
    test_stop
}
contract_property! {
    /// The contract of the test of the external shutdown.
    shutdown_test
}
contract_property! {
    /// The contract of the pulse cancellation.
    pulses
}
contract_property! {
    /// The contract of the cross comparison.
    compare
}
contract_property! {
    /// The contract of the synchronisation of actual values.
    slip
}
contract_property! {
    /// The contract of the history.
    history
}
contract_property! {
    /// The contract of the forced checking.
    forced_check
}

contract_property! {
    /// The contract of the actual position.
    motion
}
contract_property! {
    /// The contract of the window of the operating stop.
    standstill
}
contract_property! {
    /// The contract of the limit of the speed.
    speed
}
contract_property! {
    /// The contract of the limit switches.
    limit_switch
}
contract_property! {
    /// The contract of the braking ramp.
    ramp
}
contract_property! {
    /// The contract of the threshold.
    threshold
}
contract_property! {
    /// The contract of a cam.
    cam
}
contract_property! {
    /// The contract of the result lists.
    results
}

contract_property! {
    /// The laws of the channel, the composition of the monitors.
    channel
}

/// The initial state of every monitor satisfies its invariant under every accepted configuration: the base of the
/// induction.
pub fn initial_states<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let law = match source.any_in(0, 6) {
        0 => arbitrary::stop_config(source).map(|config| stop::State::INITIAL.invariant(&config)),
        1 => arbitrary::selection_config(source)
            .map(|(config, _)| selection::State::INITIAL.invariant(&config)),
        2 => {
            arbitrary::fault(source).map(|(_, config, _)| fault::State::INITIAL.invariant(&config))
        }
        3 => arbitrary::external(source)
            .map(|(_, config, _)| external::State::INITIAL.invariant(&config)),
        4 => arbitrary::reference(source)
            .map(|(_, config, _)| reference::State::INITIAL.invariant(&config)),
        5 => arbitrary::agreement(source).map(|(state, config, _)| {
            agreement::State::INITIAL.invariant(&config)
                && agreement::State::restored(state.agreed).invariant(&config)
        }),
        _ => arbitrary::gear(source).map(|(_, config, _)| gear::State::INITIAL.invariant(&config)),
    };
    source.cover(0, law == Some(true));
    match law {
        None => Verdict::Discarded,
        Some(true) => Verdict::Held,
        Some(false) => Verdict::Broken("initial_state_satisfies_the_invariant"),
    }
}
