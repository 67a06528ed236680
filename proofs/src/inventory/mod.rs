//! The list of all harnesses, and the Kani harness of each entry.

use stillpoint_monitors::contract::{Contract, Next};

use crate::complete::{Found, Tied};
use crate::draw::Case;
use crate::enumeration::{Count, Domain, Odometer, enumerate};
use crate::properties::{self, Subject};
use crate::sampling::Tape;
use crate::source::Verdict;

/// What the enumeration of a draw leaves out, for each list of numbers that are tied.
pub type LeftOut = fn(&[Vec<Tied>]) -> Vec<Found>;

/// One harness: a property with its engines.
pub struct Entry {
    /// The name of the harness; also the name of its Kani harness.
    pub id: &'static str,
    /// The monitors it is about.
    pub monitor: &'static str,
    /// The family it belongs to: a module of the monitors.
    pub family: &'static str,
    /// The property in one line.
    pub property: &'static str,
    /// Requirements and properties it stands for.
    pub requirements: fn() -> Vec<&'static str>,
    /// The situations that must be met, in the order of their index.
    pub covers: fn() -> Vec<&'static str>,
    /// What the enumeration tries, in words.
    pub domain: fn() -> String,
    /// What limits the statement under every engine, Kani included.
    pub bound: &'static str,
    /// What a reader must know before relying on it.
    pub caveat: &'static str,
    /// The file of the property in `src`; `None` for a contract, which stands in its monitor.
    pub file: Option<&'static str>,
    /// The attributes of the Kani harness, with spaces as the compiler prints them: solver, stubs. Empty for the defaults.
    pub kani: &'static str,
    /// The numbers of which Kani takes only some: name, the least and the greatest.
    pub few: crate::draw::Few,
    /// The parts for which that is so; empty for all of them.
    pub few_in: &'static [u32],
    /// The clauses of a contract: name, text, requirements. Empty for runs.
    pub clauses: fn() -> Vec<ClauseText>,
    /// Tries every choice.
    pub enumerate: fn(&Subject) -> Count,
    /// What the enumeration of a contract leaves out whose draw is written by hand.
    pub by_hand: Option<LeftOut>,
    /// Makes one random run.
    pub sample: fn(&mut Tape<'_>, &Subject) -> Verdict,
}

impl Entry {
    /// What the entries of all contracts have in common; the engines are still to be set.
    const fn contract<M: Contract>(
        id: &'static str,
        property: &'static str,
        caveat: &'static str,
    ) -> Self {
        Self {
            id,
            monitor: M::NAME,
            family: M::FAMILY,
            property,
            requirements: || requirements_of(properties::clauses::<M>()),
            covers: || M::CLAUSES.iter().map(|clause| clause.name).collect(),
            domain: String::new,
            bound: "one step from any consistent state; inductive",
            caveat,
            file: None,
            kani: "",
            few: &[],
            few_in: &[],
            clauses: properties::clauses::<M>,
            enumerate: |_| Count::default(),
            by_hand: None,
            sample: |_, _| Verdict::Discarded,
        }
    }

    /// What the entries of all harnesses that call a monitor with anything have in common.
    const fn total<M: Contract>(id: &'static str, caveat: &'static str) -> Self {
        Self {
            id,
            monitor: M::NAME,
            family: M::FAMILY,
            property: "no call overflows or panics, whatever its numbers are",
            requirements: || vec!["SRM-LFMATH-003"],
            covers: || crate::total::COVERS.to_vec(),
            domain: || crate::total::DOMAIN.to_owned(),
            bound: "one call from any state; under Kani also from an inconsistent one",
            caveat,
            file: None,
            kani: "",
            few: &[],
            few_in: &[],
            clauses: Vec::new,
            enumerate: |_| Count::default(),
            by_hand: None,
            sample: |_, _| Verdict::Discarded,
        }
    }
}

/// Tries every case of a contract.
fn enumerate_contract<M: Contract>(
    domain: Domain,
    case: impl Fn(&mut Odometer) -> Option<Case<M>>,
    next: Next<M>,
) -> Count {
    enumerate(domain, M::CLAUSES.len(), |source| {
        let case = case(source);
        properties::contract::<M>(source, case, next)
    })
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
    (contract $([$($how:tt)*])? $id:ident on $family:ident::$monitor:ident {
        property: $property:literal, tries: $tries:literal, $(few: $few:tt $(in parts $few_in:tt)?,)? caveat: $caveat:literal $(,)?
    }) => {{
        use stillpoint_monitors::$family::$monitor::Monitor;
        static TRIES: std::sync::OnceLock<$crate::tries::Tries> = std::sync::OnceLock::new();
        fn tries() -> &'static $crate::tries::Tries {
            TRIES.get_or_init(|| match $crate::tries::Tries::of::<Monitor>($tries) {
                Ok(tries) => tries,
                Err(what) => panic!(concat!(stringify!($id), ": {}"), what),
            })
        }
        $crate::inventory::Entry {
            kani: concat!($(stringify!($($how)*))?),
            $(few: &$few, $(few_in: &$few_in,)?)?
            domain: || $crate::tries::in_words($tries),
            enumerate: |subject| {
                let case = |source: &mut $crate::enumeration::Odometer| tries().step::<Monitor, _>(source);
                $crate::inventory::enumerate_contract::<Monitor>(
                    $crate::inventory::NARROW, case, subject.$family.$monitor,
                )
            },
            sample: |tape, subject| {
                let case = tries().step::<Monitor, _>(tape);
                $crate::properties::contract::<Monitor>(tape, case, subject.$family.$monitor)
            },
            ..$crate::inventory::Entry::contract::<Monitor>(stringify!($id), $property, $caveat)
        }
    }};
    (contract $([$($how:tt)*])? $id:ident on $family:ident::$monitor:ident {
        property: $property:literal, domain: $domain:expr, domain_text: $domain_text:literal, caveat: $caveat:literal $(,)?
    }) => {{
        use stillpoint_monitors::$family::$monitor::Monitor;
        $crate::inventory::Entry {
            kani: concat!($(stringify!($($how)*))?),
            domain: || $domain_text.to_owned(),
            enumerate: |subject| {
                let case = |source: &mut $crate::enumeration::Odometer| $crate::arbitrary::$family::$monitor(source);
                $crate::inventory::enumerate_contract::<Monitor>($domain, case, subject.$family.$monitor)
            },
            by_hand: Some(|tied| {
                $crate::complete::check::<Monitor>($domain, $crate::arbitrary::$family::$monitor, tied)
            }),
            sample: |tape, subject| {
                let case = $crate::arbitrary::$family::$monitor(tape);
                $crate::properties::contract::<Monitor>(tape, case, subject.$family.$monitor)
            },
            ..$crate::inventory::Entry::contract::<Monitor>(stringify!($id), $property, $caveat)
        }
    }};
    (total $([$($how:tt)*])? $id:ident on $family:ident::$monitor:ident { caveat: $caveat:literal }) => {{
        use stillpoint_monitors::$family::$monitor::Monitor;
        $crate::inventory::Entry {
            kani: concat!($(stringify!($($how)*))?),
            enumerate: |subject| {
                $crate::total::enumerated::<Monitor>($crate::inventory::NARROW, subject.$family.$monitor)
            },
            sample: |tape, subject| $crate::total::sampled::<Monitor>(tape, subject.$family.$monitor),
            ..$crate::inventory::Entry::total::<Monitor>(stringify!($id), $caveat)
        }
    }};
    (run($unwind:literal) $([$($how:tt)*])? $id:ident on $family:ident::$monitor:literal by $module:ident::$function:ident {
        property: $property:literal, requirements: [$($requirement:literal),+], covers: [$($cover:literal),+],
        domain: $domain:expr, domain_text: $domain_text:literal, bound: $bound:literal, caveat: $caveat:literal $(,)?
    }) => {
        $crate::inventory::Entry {
            id: stringify!($id),
            monitor: $monitor,
            family: stringify!($family),
            property: $property,
            requirements: || vec![$($requirement),+],
            covers: || vec![$($cover),+],
            domain: || $domain_text.to_owned(),
            bound: $bound,
            caveat: $caveat,
            file: Some(concat!("properties/", stringify!($family), "/", stringify!($module), ".rs")),
            kani: concat!($(stringify!($($how)*))?),
            few: &[],
            few_in: &[],
            clauses: Vec::new,
            by_hand: None,
            enumerate: |subject| {
                $crate::enumeration::enumerate($domain, [$($cover),+].len(), |source| {
                    $crate::properties::$family::$module::$function(source, &subject.$family)
                })
            },
            sample: |tape, subject| $crate::properties::$family::$module::$function(tape, &subject.$family),
        }
    };
}

/// Whether one of these parts is one of those; known to the compiler, so that no part has a draw that it does not make.
#[cfg(kani)]
const fn some_in(parts: &[u32], those: &[u32]) -> bool {
    let mut place = 0;
    while place < parts.len() {
        if stillpoint_monitors::contract::is_in(those, parts[place]) {
            return true;
        }
        place += 1;
    }
    false
}

/// One Kani harness, with its attributes.
#[cfg(kani)]
macro_rules! kani_proof {
    (($($name:ident $arguments:tt),*) [$($more:ident $values:tt),*] $id:ident $body:block) => {
        #[kani::proof]
        $(#[kani::$name $arguments])*
        $(#[kani::$more $values])*
        fn $id() $body
    };
}

/// The step that Kani starts from: any that the types of the monitor allow, or one drawn by hand.
#[cfg(kani)]
macro_rules! kani_case {
    ($family:ident $monitor:ident $source:ident $number:tt { property: $property:literal, tries: $tries:literal, few: $few:tt in parts $parts:tt, $($rest:tt)* }) => {{
        let few: crate::draw::Few = if const { crate::inventory::some_in(&$number, &$parts) } {
            &$few
        } else {
            &[]
        };
        crate::draw::step::<stillpoint_monitors::$family::$monitor::Monitor, _>(&mut $source, few)
    }};
    ($family:ident $monitor:ident $source:ident $number:tt { property: $property:literal, tries: $tries:literal, few: $few:tt, $($rest:tt)* }) => {
        crate::draw::step::<stillpoint_monitors::$family::$monitor::Monitor, _>(&mut $source, &$few)
    };
    ($family:ident $monitor:ident $source:ident $number:tt { property: $property:literal, tries: $($rest:tt)* }) => {
        crate::draw::step::<stillpoint_monitors::$family::$monitor::Monitor, _>(&mut $source, &[])
    };
    ($family:ident $monitor:ident $source:ident $number:tt $rest:tt) => {
        crate::arbitrary::$family::$monitor(&mut $source)
    };
}

/// The Kani harness of an entry, where it is one of the chosen ones (see `build.rs`); with `[parts(COUNT: NAME = NUMBER, ...)]` several in a module of its name. The parts of a
/// contract share its clauses, by their place modulo COUNT, and a part may have several of these numbers (`NAME = 1 | 3`); those of a run are the parts that its property knows, and part 0 is the whole with the covers
/// and without the assertion.
#[cfg(kani)]
macro_rules! kani_harness {
    (contract [kani $kani:tt parts($count:literal: $($part:ident = $($number:literal)|+),+)]
        $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        #[cfg(any(not(kani_chosen), $id))]
        mod $id {
            use super::*;
            $(kani_proof! { $kani [] $part {
                use stillpoint_monitors::$family::$monitor::{State, Step, assert_clauses, next};
                let mut source = Symbolic::default();
                if let Some((before, config, inputs)) = kani_case!($family $monitor source [$($number),+] $rest) {
                    kani::assume(before.invariant(&config));
                    assert!(State::INITIAL.invariant(&config), "initial_state_satisfies_the_invariant");
                    let (after, outputs) = next(before, &config, &inputs);
                    assert_clauses(Step { before, config, inputs, after, outputs }, &[$($number),+], $count);
                }
            }})+
        }
    };
    (contract [kani $kani:tt] $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        kani_harness! { contract [kani $kani parts(1: whole = 1)] $id on $family::$monitor $rest }
    };
    (contract [parts $parts:tt] $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        kani_harness! { contract [kani() parts $parts] $id on $family::$monitor $rest }
    };
    (contract $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        kani_harness! { contract [kani() parts(1: whole = 1)] $id on $family::$monitor $rest }
    };
    (total [kani $kani:tt] $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        #[cfg(any(not(kani_chosen), $id))]
        mod $id {
            use super::*;
            kani_proof! { $kani [] whole {
                crate::total::called::<stillpoint_monitors::$family::$monitor::Monitor>(&mut Symbolic::default());
            }}
        }
    };
    (total $id:ident on $family:ident::$monitor:ident $rest:tt) => {
        kani_harness! { total [kani()] $id on $family::$monitor $rest }
    };
    (run($unwind:literal) [kani $kani:tt parts($count:literal: $($part:ident = $number:literal),+)]
        $id:ident on $family:ident::$monitor:literal by $module:ident::$function:ident $rest:tt) => {
        #[cfg(any(not(kani_chosen), $id))]
        mod $id {
            use super::*;
            kani_harness! { covers $kani [unwind($unwind)] false covers $family $module $function $rest }
            $(kani_proof! { $kani [unwind($unwind)] $part {
                let mut source = Symbolic::part($number);
                conclude(crate::properties::$family::$module::$function(&mut source, &Subject::PRODUCTION.$family));
            }})+
        }
    };
    (run($unwind:literal) [kani $kani:tt] $id:ident on $family:ident::$monitor:literal by $module:ident::$function:ident $rest:tt) => {
        #[cfg(any(not(kani_chosen), $id))]
        mod $id {
            use super::*;
            kani_harness! { covers $kani [unwind($unwind)] true whole $family $module $function $rest }
        }
    };
    (run($unwind:literal) $id:ident on $family:ident::$monitor:literal by $module:ident::$function:ident $rest:tt) => {
        kani_harness! { run($unwind) [kani()] $id on $family::$monitor by $module::$function $rest }
    };
    (covers $kani:tt $more:tt $asserts:literal $id:ident $family:ident $module:ident $function:ident {
        property: $property:literal, requirements: $requirements:tt, covers: [$($cover:literal),+], $($rest:tt)*
    }) => {
        kani_proof! { $kani $more $id {
            let mut source = Symbolic::default();
            let verdict = crate::properties::$family::$module::$function(&mut source, &Subject::PRODUCTION.$family);
            if $asserts {
                conclude(verdict);
            } else {
                kani::assume(verdict != Verdict::Discarded);
            }
            $(kani::cover!(source.take_cover(), $cover);)+
        }}
    };
}

/// Makes the list of a file and the Kani harnesses from the same lines.
macro_rules! inventory {
    ($([$($entry:tt)*])+) => {
        /// The harnesses of this file.
        #[cfg(not(kani))]
        pub(super) static ENTRIES: &[$crate::inventory::Entry] = &[$(entry!($($entry)*)),+];

        #[cfg(kani)]
        mod kani_harnesses {
            // A file of contracts only needs no more than the symbolic source.
            #[allow(unused_imports)]
            use crate::kani_source::{Symbolic, conclude};
            #[allow(unused_imports)]
            use crate::source::Verdict;
            #[allow(unused_imports)]
            use crate::properties::Subject;

            $(kani_harness!($($entry)*);)+
        }
    };
}

mod heidenhain;
mod iec;
mod sinamics;
mod sinumerik;
mod srm;

/// Every harness.
#[cfg(not(kani))]
pub fn all() -> impl Iterator<Item = &'static Entry> {
    let families = sinumerik::ENTRIES
        .into_iter()
        .chain(heidenhain::ENTRIES)
        .chain(sinamics::ENTRIES)
        .chain(srm::ENTRIES)
        .chain(iec::ENTRIES);
    families.flatten()
}

/// A domain for properties that read no wide value.
pub const NARROW: Domain = Domain {
    delays: &[0],
    highest_speed: 0,
};
