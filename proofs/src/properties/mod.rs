//! The properties by family, and the step functions they are stated about.

use stillpoint_monitors::contract::{Contract, Next, Step};

use crate::draw::Case;
use crate::inventory::ClauseText;
use crate::source::{Source, Verdict};

/// Makes, from the list of the monitors of a family, the step functions under test (`Subject`), each a field and a method.
///
/// Kani checks the production monitors only, and has no fields: a list of function pointers brings every monitor of the family into each
/// harness that calls one of them, and it takes seconds to read them all.
macro_rules! subject {
    ($family:ident [] $($monitor:ident)+) => {
        /// The step functions under test: the production ones, or some replaced by mutants.
        #[derive(Clone, Copy, Debug)]
        pub struct Subject {$(
            #[cfg(not(kani))]
            #[doc = concat!("Of [`", stringify!($monitor), "`](stillpoint_monitors::", stringify!($family), "::", stringify!($monitor), ").")]
            pub $monitor: stillpoint_monitors::$family::$monitor::Next,
        )+}

        impl Subject {
            /// The production monitors.
            pub const PRODUCTION: Self = Self {$(
                #[cfg(not(kani))]
                $monitor: stillpoint_monitors::$family::$monitor::next,
            )+};

            $(
                #[doc = concat!("One step of [`", stringify!($monitor), "`](stillpoint_monitors::", stringify!($family), "::", stringify!($monitor), ").")]
                #[cfg(not(kani))]
                pub fn $monitor(
                    &self,
                    state: stillpoint_monitors::$family::$monitor::State,
                    config: &stillpoint_monitors::$family::$monitor::Config,
                    inputs: &stillpoint_monitors::$family::$monitor::Inputs,
                ) -> (stillpoint_monitors::$family::$monitor::State, stillpoint_monitors::$family::$monitor::Outputs) {
                    (self.$monitor)(state, config, inputs)
                }

                #[cfg(kani)]
                #[allow(missing_docs)]
                pub fn $monitor(
                    &self,
                    state: stillpoint_monitors::$family::$monitor::State,
                    config: &stillpoint_monitors::$family::$monitor::Config,
                    inputs: &stillpoint_monitors::$family::$monitor::Inputs,
                ) -> (stillpoint_monitors::$family::$monitor::State, stillpoint_monitors::$family::$monitor::Outputs) {
                    stillpoint_monitors::$family::$monitor::next(state, config, inputs)
                }
            )+
        }
    };
}

/// The contract of a monitor as a property: from any consistent state, under any accepted configuration and any inputs, one
/// step satisfies every clause. The invariant is one of the clauses, and the initial state satisfies it, so the facts are
/// inductive.
pub fn contract<M: Contract>(
    source: &mut impl Source,
    case: Option<Case<M>>,
    next: Next<M>,
) -> Verdict {
    let Some((before, config, inputs)) = case else {
        return Verdict::Discarded;
    };
    if !M::invariant(&M::INITIAL, &config) {
        return Verdict::Broken("initial_state_satisfies_the_invariant");
    }
    let (after, outputs) = next(before, &config, &inputs);
    let result = M::evaluate(Step {
        before,
        config,
        inputs,
        after,
        outputs,
    });
    for index in 0..M::CLAUSES.len() {
        source.cover(index, (result.premises >> index) & 1 == 1);
    }
    match result.first_broken(M::CLAUSES.len()) {
        Some(index) => Verdict::Broken(M::CLAUSES.get(index).map_or("", |clause| clause.name)),
        None => Verdict::Held,
    }
}

/// The clauses of a contract as texts.
pub fn clauses<M: Contract>() -> Vec<ClauseText> {
    let clauses = M::CLAUSES.iter();
    clauses
        .map(|clause| ClauseText {
            name: clause.name,
            text: clause.text.trim(),
            requirements: clause.requirements,
        })
        .collect()
}

pub mod heidenhain;
pub mod iec;
pub mod sinamics;
pub mod sinumerik;
pub mod srm;

/// The step functions under test of every family.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// HEIDENHAIN Functional Safety.
    pub heidenhain: heidenhain::Subject,
    /// Functions of IEC 61800-5-2.
    pub iec: iec::Subject,
    /// SINAMICS S120.
    pub sinamics: sinamics::Subject,
    /// SINUMERIK 840D.
    pub sinumerik: sinumerik::Subject,
    /// Fail-safe blocks for storage and retrieval machines.
    pub srm: srm::Subject,
}

impl Subject {
    /// The production monitors.
    pub const PRODUCTION: Self = Self {
        heidenhain: heidenhain::Subject::PRODUCTION,
        iec: iec::Subject::PRODUCTION,
        sinamics: sinamics::Subject::PRODUCTION,
        sinumerik: sinumerik::Subject::PRODUCTION,
        srm: srm::Subject::PRODUCTION,
    };
}
