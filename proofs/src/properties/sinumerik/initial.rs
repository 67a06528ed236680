//! The base of the induction: initial states satisfy the invariants.

use stillpoint_monitors::sinumerik::{
    agreement, external, fault, gear, reference, selection, stop,
};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::source::{Source, Verdict};

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
