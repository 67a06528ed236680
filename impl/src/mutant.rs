//! Deliberately wrong step functions: tests of the tests. Compiled only with the feature `mutants`, reachable from no
//! production path.
//!
//! Each mutant replaces the step function of one monitor by a wrapper that alters the step in one way. A proof harness or
//! a differential check that cannot tell it from the production function is too weak. The mutants carry no contract
//! assertions, so that it is the check that finds them.

/// What a mutant is called, and what is wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mutant {
    /// The module of the family.
    pub family: &'static str,
    /// The module of the monitor that it is a variant of.
    pub monitor: &'static str,
    /// The name for command lines: the monitor first.
    pub name: &'static str,
    /// What is wrong, in words.
    pub text: &'static str,
}

/// A wrong variant of the monitor with the step function `N`.
#[derive(Clone, Copy, Debug)]
pub struct Wrong<N> {
    /// Its name.
    pub mutant: Mutant,
    /// The wrong step function.
    pub next: N,
}

/// Declares the wrong variants of a monitor, as a function of its name that lists them.
macro_rules! variants {
    ($family:ident::$monitor:ident: $(
        $(#[doc = $text:literal])+
        $name:literal |$state:pat_param, $config:pat_param, $inputs:pat_param| $body:block
    )+) => {
        #[doc = concat!("The wrong variants of `", stringify!($monitor), "`.")]
        pub fn $monitor() -> &'static [$crate::mutant::Wrong<$crate::$family::$monitor::Next>] {
            use $crate::$family::$monitor as module;
            const WRONG: &[$crate::mutant::Wrong<module::Next>] = &[$({
                fn wrong(
                    $state: module::State,
                    $config: &module::Config,
                    $inputs: &module::Inputs,
                ) -> (module::State, module::Outputs) $body

                $crate::mutant::Wrong {
                    mutant: $crate::mutant::Mutant {
                        family: stringify!($family),
                        monitor: stringify!($monitor),
                        name: $name,
                        text: concat!($($text),+),
                    },
                    next: wrong,
                }
            }),+];
            WRONG
        }
    };
}

/// Lists the mutants of a family, from the list of its monitors and those named besides.
macro_rules! list_mutants {
    ($family:ident [$($more:ident)*] $($monitor:ident)+) => {
        /// Every mutant of the family, in the order of its monitors.
        pub fn all() -> impl Iterator<Item = $crate::mutant::Mutant> {
            type List = fn(usize) -> Option<$crate::mutant::Mutant>;
            let lists = [
                $((|place| Some($monitor().get(place)?.mutant)) as List,)+
                $((|place| Some($more().get(place)?.mutant)) as List,)*
            ];
            lists.into_iter().flat_map(|list| (0..).map_while(list))
        }

        #[test]
        fn names_are_unique() {
            for (index, mutant) in all().enumerate() {
                let first = all().position(|other| other.name == mutant.name);
                assert_eq!(first, Some(index));
            }
        }
    };
}
