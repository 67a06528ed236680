//! The list of all harnesses, and the Kani harness of each entry.

use crate::enumeration::{Count, Domain};
use crate::properties::Subject;
use crate::sampling::Tape;
use crate::source::Verdict;

/// One harness: a property with its engines.
pub struct Entry {
    /// The name of the harness; also the name of its Kani harness.
    pub id: &'static str,
    /// The monitors it is about.
    pub monitor: &'static str,
    /// The property in one line.
    pub property: &'static str,
    /// Requirements and properties it stands for.
    pub requirements: fn() -> Vec<&'static str>,
    /// The situations that must be met, in the order of their index.
    pub covers: fn() -> Vec<&'static str>,
    /// What the enumeration tries, in words.
    pub domain: &'static str,
    /// What limits the statement under every engine, Kani included.
    pub bound: &'static str,
    /// What a reader must know before relying on it.
    pub caveat: &'static str,
    /// The clauses of a contract: name, text, requirements. Empty for runs.
    pub clauses: fn() -> Vec<ClauseText>,
    /// Tries every choice.
    pub enumerate: fn(&Subject) -> Count,
    /// Makes one random run.
    pub sample: fn(&mut Tape<'_>, &Subject) -> Verdict,
}

/// A clause of a contract as the page shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClauseText {
    /// The name of the predicate function.
    pub name: &'static str,
    /// The clause in words.
    pub text: &'static str,
    /// The requirements and properties it stands for.
    pub requirements: &'static [&'static str],
}

/// The requirements of the clauses of a contract, each once, in order.
fn requirements_of(clauses: Vec<ClauseText>) -> Vec<&'static str> {
    let mut all: Vec<_> = clauses
        .iter()
        .flat_map(|clause| clause.requirements.iter().copied())
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

macro_rules! entry {
    (contract $id:ident on $monitor:ident {
        property: $property:literal, domain: $domain:expr, domain_text: $domain_text:literal, caveat: $caveat:literal $(,)?
    }) => {
        $crate::inventory::Entry {
            id: stringify!($id),
            monitor: stringify!($monitor),
            property: $property,
            requirements: || $crate::inventory::requirements_of($crate::inventory::clauses::$monitor()),
            covers: || $crate::inventory::clauses::$monitor().iter().map(|clause| clause.name).collect(),
            domain: $domain_text,
            bound: "one step from any consistent state; inductive",
            caveat: $caveat,
            clauses: $crate::inventory::clauses::$monitor,
            enumerate: |subject| {
                let covers = stillpoint_monitors::$monitor::CLAUSES.len();
                $crate::enumeration::enumerate($domain, covers, |source| {
                    $crate::properties::contracts::$monitor(source, subject)
                })
            },
            sample: |tape, subject| $crate::properties::contracts::$monitor(tape, subject),
        }
    };
    (run($unwind:literal) $id:ident on $monitor:literal by $module:ident::$function:ident {
        property: $property:literal, requirements: [$($requirement:literal),+], covers: [$($cover:literal),+],
        domain: $domain:expr, domain_text: $domain_text:literal, bound: $bound:literal, caveat: $caveat:literal $(,)?
    }) => {
        $crate::inventory::Entry {
            id: stringify!($id),
            monitor: $monitor,
            property: $property,
            requirements: || vec![$($requirement),+],
            covers: || vec![$($cover),+],
            domain: $domain_text,
            bound: $bound,
            caveat: $caveat,
            clauses: Vec::new,
            enumerate: |subject| {
                $crate::enumeration::enumerate($domain, [$($cover),+].len(), |source| {
                    $crate::properties::$module::$function(source, subject)
                })
            },
            sample: |tape, subject| $crate::properties::$module::$function(tape, subject),
        }
    };
}

#[cfg(kani)]
macro_rules! kani_harness {
    (contract $id:ident on $monitor:ident { $($rest:tt)* }) => {
        #[kani::proof_for_contract(stillpoint_monitors::$monitor::next)]
        fn $id() {
            use stillpoint_monitors::$monitor::{Step, cover_premises, next};
            let mut source = Symbolic::default();
            if let Some((before, config, inputs)) = crate::arbitrary::$monitor(&mut source) {
                let (after, outputs) = next(before, &config, &inputs);
                cover_premises(Step { before, config, inputs, after, outputs });
            }
        }
    };
    (run($unwind:literal) $id:ident on $monitor:literal by $module:ident::$function:ident {
        property: $property:literal, requirements: $requirements:tt, covers: [$($cover:literal),+], $($rest:tt)*
    }) => {
        #[kani::proof]
        #[kani::unwind($unwind)]
        fn $id() {
            let mut source = Symbolic::default();
            conclude(crate::properties::$module::$function(&mut source, &Subject::PRODUCTION));
            $(kani::cover!(source.take_cover(), $cover);)+
        }
    };
}

/// Makes the list of a file and the Kani harnesses from the same lines.
macro_rules! inventory {
    ($([$($entry:tt)*])+) => {
        /// The harnesses of this file.
        pub(super) static ENTRIES: &[$crate::inventory::Entry] = &[$(entry!($($entry)*)),+];

        #[cfg(kani)]
        mod kani_harnesses {
            // A file of contracts only needs no more than the symbolic source.
            #[allow(unused_imports)]
            use crate::kani_source::{Symbolic, conclude};
            #[allow(unused_imports)]
            use crate::properties::Subject;

            $(kani_harness!($($entry)*);)+
        }
    };
}

/// The clauses of each contract as texts.
mod clauses {
    use super::ClauseText;

    macro_rules! texts {
        ($($monitor:ident)+) => {$(
            pub fn $monitor() -> Vec<ClauseText> {
                let clauses = stillpoint_monitors::$monitor::CLAUSES.iter();
                clauses.map(|clause| ClauseText {
                    name: clause.name,
                    text: clause.text.trim(),
                    requirements: clause.requirements,
                }).collect()
            }
        )+};
    }

    texts!(test_stop shutdown_test pulses compare slip history forced_check);
    texts!(motion standstill speed limit_switch ramp threshold cam results);
    texts!(channel);
    texts!(stop external fault selection reference agreement gear group);
}

mod base;
mod checking;
mod composing;
mod watching;

/// Every harness.
pub fn all() -> impl Iterator<Item = &'static Entry> {
    [
        base::ENTRIES,
        checking::ENTRIES,
        watching::ENTRIES,
        composing::ENTRIES,
    ]
    .into_iter()
    .flatten()
}

/// A domain for properties that read no wide value.
const NARROW: Domain = Domain {
    delays: &[0],
    highest_speed: 0,
};
