//! The properties by family, and the step functions they are stated about.

/// Makes, from one list of the monitors of a family, the step functions under test (`Subject`), the contract of each as a
/// property (`contracts`), and its clauses as texts (`clauses`).
///
/// A contract as a property: from any consistent state, under any accepted configuration and any inputs, one step satisfies
/// every clause. The invariant is one of the clauses, and the initial state satisfies it, so the facts are inductive.
macro_rules! monitors {
    ($family:ident: $($(#[$doc:meta])+ $monitor:ident)+) => {
        /// The step functions under test: the production ones, or some replaced by mutants.
        #[derive(Clone, Copy, Debug)]
        pub struct Subject {$(
            $(#[$doc])+
            pub $monitor: stillpoint_monitors::$family::$monitor::Next,
        )+}

        impl Subject {
            /// The production monitors.
            pub const PRODUCTION: Self = Self {$(
                $monitor: stillpoint_monitors::$family::$monitor::next,
            )+};
        }

        /// The contract of every step function as a property.
        pub mod contracts {$(
            $(#[$doc])+
            pub fn $monitor<S: $crate::source::Source>(
                source: &mut S,
                subject: &super::Subject,
            ) -> $crate::source::Verdict {
                use stillpoint_monitors::$family::$monitor::{CLAUSES, State, Step, evaluate};
                use $crate::source::Verdict;
                let Some((before, config, inputs)) = $crate::arbitrary::$family::$monitor(source) else {
                    return Verdict::Discarded;
                };
                if !State::INITIAL.invariant(&config) {
                    return Verdict::Broken("initial_state_satisfies_the_invariant");
                }
                let (after, outputs) = (subject.$monitor)(before, &config, &inputs);
                let result = evaluate(Step { before, config, inputs, after, outputs });
                for index in 0..CLAUSES.len() {
                    source.cover(index, (result.premises >> index) & 1 == 1);
                }
                if let Some(index) = result.first_broken(CLAUSES.len()) {
                    return Verdict::Broken(CLAUSES.get(index).map_or("", |clause| clause.name));
                }
                Verdict::Held
            }
        )+}

        /// The clauses of each contract as texts.
        pub mod clauses {
            use $crate::inventory::ClauseText;
            $(
                $(#[$doc])+
                pub fn $monitor() -> Vec<ClauseText> {
                    let clauses = stillpoint_monitors::$family::$monitor::CLAUSES.iter();
                    clauses.map(|clause| ClauseText {
                        name: clause.name,
                        text: clause.text.trim(),
                        requirements: clause.requirements,
                    }).collect()
                }
            )+
        }
    };
}

pub mod heidenhain;
pub mod sinumerik;

/// The step functions under test of every family.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// HEIDENHAIN Functional Safety.
    pub heidenhain: heidenhain::Subject,
    /// SINUMERIK 840D.
    pub sinumerik: sinumerik::Subject,
}

impl Subject {
    /// The production monitors.
    pub const PRODUCTION: Self = Self {
        heidenhain: heidenhain::Subject::PRODUCTION,
        sinumerik: sinumerik::Subject::PRODUCTION,
    };
}
