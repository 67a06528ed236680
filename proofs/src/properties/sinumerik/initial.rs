//! The base of the induction: initial states satisfy the invariants.

use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::{
    agreement, external, fault, gear, reference, selection, stop,
};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::draw::any;
use crate::source::{Source, Verdict};

/// Any configuration of narrow numbers.
fn accepted<M: Contract>(source: &mut impl Source) -> Option<M::Config> {
    Some(any(source)).filter(M::accepted)
}

/// The initial state of every monitor satisfies its invariant under every accepted configuration: the base of the
/// induction.
pub fn initial_states<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let law = match source.any_in(0, 6) {
        0 => arbitrary::stop_config(source).map(|config| stop::State::INITIAL.invariant(&config)),
        1 => arbitrary::selection_config(source)
            .map(|(config, _)| selection::State::INITIAL.invariant(&config)),
        2 => fault::Config::new(source.any_delay(Cycles::SIXTY_SECONDS))
            .ok()
            .map(|config| fault::State::INITIAL.invariant(&config)),
        3 => accepted::<external::Monitor>(source)
            .map(|config| external::State::INITIAL.invariant(&config)),
        4 => accepted::<reference::Monitor>(source)
            .map(|config| reference::State::INITIAL.invariant(&config)),
        5 => {
            let t_differ = source.any_delay(Cycles::SIXTY_SECONDS);
            agreement::Config::new(t_differ, source.any_bool())
                .ok()
                .map(|config| agreement::State::restored(source.any_bool()).invariant(&config))
        }
        _ => {
            accepted::<gear::Monitor>(source).map(|config| gear::State::INITIAL.invariant(&config))
        }
    };
    source.cover(0, law == Some(true));
    match law {
        None => Verdict::Discarded,
        Some(true) => Verdict::Held,
        Some(false) => Verdict::Broken("initial_state_satisfies_the_invariant"),
    }
}
