//! Deliberately wrong step functions: tests of the tests. Compiled only with the feature `mutants`, reachable from no
//! production path.
//!
//! Each mutant replaces the step function of one monitor by a wrapper that alters the step in one way. A proof harness or
//! a differential check that cannot tell it from the production function is too weak. The mutants carry no contract
//! assertions, so that it is the check that finds them.

/// Declares the mutants: one line each, by monitor, with the name for command lines (the monitor first) and the wrong step
/// function.
macro_rules! mutants {
    ($family:ident: $(
        $(#[doc = $text:literal])+
        fn $monitor:ident {$(
            $(#[doc = $mutant_text:literal])+
            $mutant:ident $name:literal => $step:path;
        )+}
    )+) => {
        /// A wrong variant of one monitor.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Mutant {$($(
            $(#[doc = $mutant_text])+
            $mutant,
        )+)+}

        impl Mutant {
            /// Every mutant.
            pub const ALL: &[Self] = &[$($(Self::$mutant,)+)+];

            /// The name for command lines: the monitor first.
            pub const fn name(self) -> &'static str {
                match self {
                    $($(Self::$mutant => $name,)+)+
                }
            }

            /// The module of the monitor it is a variant of.
            pub const fn monitor(self) -> &'static str {
                match self {
                    $($(Self::$mutant => stringify!($monitor),)+)+
                }
            }

            $(
                $(#[doc = $text])+
                #[doc = "\n\nThe production function unless the mutant is one of it."]
                pub fn $monitor(self) -> $crate::$family::$monitor::Next {
                    match self {
                        $(Self::$mutant => $step,)+
                        _ => $crate::$family::$monitor::next,
                    }
                }
            )+
        }

        #[test]
        fn names_are_unique() {
            for (index, mutant) in Mutant::ALL.iter().enumerate() {
                let first = Mutant::ALL.iter().position(|other| other.name() == mutant.name());
                assert_eq!(first, Some(index));
            }
        }
    };
}
