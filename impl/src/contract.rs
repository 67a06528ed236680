//! Contracts, written once.
//!
//! The step function of a monitor is declared by one `monitor!` block: a precondition and a list of *clauses*. A clause is
//! an implication over one step, `when premise => conclusion`, with the requirements it stands for. From the one list
//! come
//!
//! * a predicate function per clause, and `CLAUSES`, the list as data (the proof harnesses and the inventory read it);
//! * under `cfg(kani)` `assert_clauses`, which asserts every clause on one step and covers every premise: a harness
//!   assumes the invariant, calls `next` and asserts;
//! * with debug assertions a check of every clause after every call of `next`: it panics when, and only when, the
//!   contract is broken. Release builds contain neither checks nor panics;
//! * with the feature `creusot` one `requires` and one `ensures` per clause as Creusot contracts.
//!
//! It also makes the monitor known to generic code as a [`Contract`]; the list of its family is the only other place that
//! names it (`heidenhain_monitors!`, `sinumerik_monitors!`).
//!
//! `next` is pure and takes its state by value, so no clause needs the value of an expression before the call.
//! Together with the invariant, which every contract assumes and re-establishes, the clauses are inductive: what holds for
//! one step from any state that satisfies the invariant holds along every run from the initial state.
//!
//! Caveat of the Creusot form: it has been built with an ordinary compiler only, which checks the syntax of the attributes
//! and nothing else; no Creusot run has been made. Under Creusot's own compiler (`cfg(creusot)`) the predicates are logic
//! functions, and what calls them as ordinary functions is left out; the small functions of [`crate::kernel`] that the
//! predicates call would need logic counterparts there.

use crate::fields::Fields;
#[cfg(feature = "mutants")]
use crate::mutant::Wrong;

/// The step function of a monitor.
pub type Next<M> = fn(
    <M as Contract>::State,
    &<M as Contract>::Config,
    &<M as Contract>::Inputs,
) -> (<M as Contract>::State, <M as Contract>::Outputs);

/// A step of a monitor.
pub type StepOf<M> = Step<
    <M as Contract>::State,
    <M as Contract>::Config,
    <M as Contract>::Inputs,
    <M as Contract>::Outputs,
>;

/// A clause of a monitor.
pub type ClauseOf<M> = Clause<
    <M as Contract>::State,
    <M as Contract>::Config,
    <M as Contract>::Inputs,
    <M as Contract>::Outputs,
>;

/// A monitor with all that generic code needs to know of it; every one but the compositions is declared by `monitor!`.
#[cfg(not(creusot))]
pub trait Contract: 'static {
    /// The module of its family.
    const FAMILY: &'static str;
    /// Its own module.
    const NAME: &'static str;
    /// The state between two cycles.
    type State: Fields + PartialEq + core::fmt::Debug;
    /// The parameters.
    type Config: Fields + PartialEq + core::fmt::Debug;
    /// The inputs of one cycle.
    type Inputs: Fields + PartialEq + core::fmt::Debug;
    /// The outputs of one cycle.
    type Outputs: Fields + PartialEq + core::fmt::Debug;
    /// The state at power-on.
    const INITIAL: Self::State;
    /// The clauses of the contract.
    const CLAUSES: &'static [ClauseOf<Self>];

    /// Whether the state is consistent under these parameters.
    fn invariant(state: &Self::State, config: &Self::Config) -> bool;

    /// Whether a constructor gives these parameters.
    fn accepted(config: &Self::Config) -> bool;

    /// One cycle, with the assertions of a debug build.
    fn next(
        state: Self::State,
        config: &Self::Config,
        inputs: &Self::Inputs,
    ) -> (Self::State, Self::Outputs);

    /// Every clause on one step.
    fn evaluate(step: StepOf<Self>) -> Evaluation;

    /// Its deliberately wrong variants.
    #[cfg(feature = "mutants")]
    fn wrong() -> &'static [Wrong<Next<Self>>];
}

/// One observed step of a monitor: everything a clause may talk about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step<S, C, I, O> {
    /// The state before the step.
    pub before: S,
    /// The parameters.
    pub config: C,
    /// The inputs of the cycle.
    pub inputs: I,
    /// The state after the step.
    pub after: S,
    /// The outputs of the cycle.
    pub outputs: O,
}

/// One clause of a contract as data.
#[derive(Debug)]
pub struct Clause<S, C, I, O> {
    /// The name of the predicate function.
    pub name: &'static str,
    /// The clause in words.
    pub text: &'static str,
    /// The requirements and properties it stands for.
    pub requirements: &'static [&'static str],
    /// Whether the clause says something about this step; a check that never meets the premise proves nothing.
    pub premise: fn(Step<S, C, I, O>) -> bool,
    /// Whether the step satisfies the clause (also when the premise does not hold).
    pub holds: fn(Step<S, C, I, O>) -> bool,
}

/// The clauses of a contract evaluated on one step, as bit sets by the index of the clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Evaluation {
    /// The clauses whose premise is met.
    pub premises: u64,
    /// The clauses that hold; a clause whose premise is not met holds.
    pub held: u64,
}

impl Evaluation {
    /// The index of the first clause of `count` that does not hold.
    pub const fn first_broken(self, count: usize) -> Option<usize> {
        let first = self.held.trailing_ones() as usize;
        if first < count { Some(first) } else { None }
    }
}

/// A state handed in from outside does not satisfy the invariant of its monitor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvalidState;

impl core::fmt::Display for InvalidState {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the state does not satisfy the invariant of the monitor")
    }
}

impl core::error::Error for InvalidState {}

fields! {
    /// The state of a monitor that remembers nothing from one cycle to the next. One type for all of them, so that they have
    /// the same form as the others.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Stateless;
}

impl Stateless {
    /// The only state.
    pub const INITIAL: Self = Self;

    /// The only state is consistent with every configuration.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant<C>(&self, _config: &C) -> bool {
        true
    }
}

/// Whether a number is one of these.
#[cfg(kani)]
pub const fn is_in(numbers: &[u32], number: u32) -> bool {
    let mut place = 0;
    while place < numbers.len() {
        if numbers[place] == number {
            return true;
        }
        place += 1;
    }
    false
}

/// Declares a monitor: `contract!`, and what makes it a [`Contract`] under the names of its family and of its module.
macro_rules! monitor {
    ($family:ident::$name:ident; $($clauses:tt)+) => {
        contract! { $($clauses)+ }

        #[cfg(not(creusot))]
        impl $crate::contract::Contract for Monitor {
            const FAMILY: &'static str = stringify!($family);
            const NAME: &'static str = stringify!($name);
            type State = State;
            type Config = Config;
            type Inputs = Inputs;
            type Outputs = Outputs;
            const INITIAL: State = State::INITIAL;
            const CLAUSES: &'static [$crate::contract::ClauseOf<Self>] = CLAUSES;

            fn invariant(state: &State, config: &Config) -> bool {
                state.invariant(config)
            }

            fn accepted(config: &Config) -> bool {
                config.accepted()
            }

            fn next(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
                next(state, config, inputs)
            }

            fn evaluate(step: Step) -> $crate::contract::Evaluation {
                evaluate(step)
            }

            #[cfg(feature = "mutants")]
            fn wrong() -> &'static [$crate::mutant::Wrong<$crate::contract::Next<Self>>] {
                $crate::$family::mutant::$name()
            }
        }
    };
}

/// Declares `next` with its contract, from the module's `State`, `Config`, `Inputs`, `Outputs` and `transition`.
macro_rules! contract {
    ($(
        $(#[doc = $text:literal])+
        $clause:ident [$($requirement:literal),+]: when |$step:ident| $premise:expr => $conclusion:expr;
    )+) => {
        /// One observed step of this monitor.
        pub type Step = $crate::contract::Step<State, Config, Inputs, Outputs>;

        /// The type of [`next`], for code that takes a step function as a parameter.
        pub type Next = fn(State, &Config, &Inputs) -> (State, Outputs);

        $(
            $(#[doc = $text])+
            #[doc = concat!("\n\nStands for:" $(, " ", $requirement)+, ".")]
            #[cfg_attr(creusot, creusot_contracts::macros::logic)]
            pub fn $clause($step: Step) -> bool {
                !($premise) || $conclusion
            }
        )+

        /// The clauses of the contract of [`next`].
        #[cfg(not(creusot))]
        pub const CLAUSES: &[$crate::contract::Clause<State, Config, Inputs, Outputs>] = &[$(
            $crate::contract::Clause {
                name: stringify!($clause),
                text: concat!($($text),+),
                requirements: &[$($requirement),+],
                premise: |$step| $premise,
                holds: $clause,
            }
        ),+];

        /// Evaluates every clause on one step: the clauses whose premise is met and the clauses that hold, as bit sets
        /// by the index in [`CLAUSES`].
        #[cfg(not(creusot))]
        pub fn evaluate(step: Step) -> $crate::contract::Evaluation {
            const { assert!(CLAUSES.len() < u64::BITS as usize) };
            let mut result = $crate::contract::Evaluation { premises: 0, held: 0 };
            let mut clause = 0_u32;
            $(
                let $step = step;
                result.premises |= u64::from($premise) << clause;
                result.held |= u64::from($clause(step)) << clause;
                clause += 1;
            )+
            let _ = clause;
            result
        }

        /// One cycle: the state after it and the outputs.
        ///
        /// Requires a state that satisfies [`State::invariant`]; ensures every clause of [`CLAUSES`]. Pure; total also for
        /// states that break the invariant, of whose outcome nothing is then claimed.
        #[cfg_attr(feature = "creusot", creusot_contracts::macros::requires(state.invariant(config)))]
        $(#[cfg_attr(feature = "creusot", creusot_contracts::macros::ensures($clause($crate::contract::Step {
            before: state, config: *config, inputs: *inputs, after: result.0, outputs: result.1,
        })))])+
        pub fn next(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
            // Kani asserts in its harness, Creusot checks the attributes; asserting here again would only slow them down.
            #[cfg(all(debug_assertions, not(any(kani, creusot))))]
            assert!(state.invariant(config), "the state before the step breaks the invariant");
            let result = transition(state, config, inputs);
            #[cfg(all(debug_assertions, not(any(kani, creusot))))]
            {
                let step = $crate::contract::Step {
                    before: state, config: *config, inputs: *inputs, after: result.0, outputs: result.1,
                };
                $(assert!($clause(step), concat!("contract broken: ", stringify!($clause)));)+
            }
            result
        }

        /// Asserts every clause on one step, for Kani, each under its name; and covers every premise, so that no clause
        /// holds vacuously. A harness that is a part takes the clauses whose place, from 1, is one of `part` modulo `of`; the
        /// others are not executed, so that a part has only its own clauses in its formula.
        ///
        /// Plain assertions, because the enforcement of a Kani contract takes every static as arbitrary, constants that the
        /// compiler has promoted to statics included: clauses that compare with a constant would fail falsely.
        #[cfg(kani)]
        pub fn assert_clauses(step: Step, part: &[u32], of: u32) {
            let mut clause = 0_u32;
            $(if $crate::contract::is_in(part, clause % of + 1) {
                // Functions of their own, not inlined: the compiler threads jumps through the parts of a premise and would make
                // several covers of one, some of which cannot be met. By reference: a copy of the step is an assignment for
                // each of its numbers.
                #[inline(never)]
                fn premise($step: &Step) -> bool {
                    $premise
                }
                #[inline(never)]
                fn conclusion($step: &Step) -> bool {
                    $conclusion
                }
                let met = premise(&step);
                kani::cover(met, concat!("premise of ", stringify!($clause)));
                assert!(!met || conclusion(&step), stringify!($clause));
            }
            clause += 1;)+
            let _ = clause;
        }

        /// The monitor as an object: the state kept between the cycles, with its configuration.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct Monitor {
            config: Config,
            state: State,
        }

        impl Monitor {
            /// A monitor in its initial state.
            pub const fn new(config: Config) -> Self {
                Self { config, state: State::INITIAL }
            }

            /// A monitor that starts from a given state, for instance one kept in non-volatile memory.
            ///
            /// # Errors
            /// [`InvalidState`](crate::contract::InvalidState) when `state` does not satisfy the invariant.
            #[cfg(not(creusot))]
            pub fn resume(config: Config, state: State) -> Result<Self, $crate::contract::InvalidState> {
                if state.invariant(&config) {
                    Ok(Self { config, state })
                } else {
                    Err($crate::contract::InvalidState)
                }
            }

            /// The present state.
            pub const fn state(&self) -> State {
                self.state
            }

            /// The parameters.
            pub const fn config(&self) -> &Config {
                &self.config
            }

            /// Advances the monitor by one cycle.
            pub fn step(&mut self, inputs: &Inputs) -> Outputs {
                let (state, outputs) = next(self.state, &self.config, inputs);
                self.state = state;
                outputs
            }
        }
    };
}
