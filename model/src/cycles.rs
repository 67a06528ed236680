//! The cycles of one state, for who walks through a state space by hand instead of exploring it.

use std::ops::ControlFlow;

use crate::choices::Odometer;
use crate::report::Step;
use crate::system::{Choices, Domain, Fault, System};

/// One cycle from a state. It stands for all combinations of the inputs that it does not read.
pub struct Cycle<'a, W> {
    /// The inputs it read and their values, in the order of reading; inputs that are held are not among them.
    pub reads: Step,
    /// The number of input combinations it stands for, of those that agree with the inputs held.
    pub weight: u128,
    /// The state after it, or the fault it met.
    pub after: Result<&'a [i32], Fault>,
    /// The work area after it.
    pub work: &'a mut W,
}

/// An input held at a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// Its number.
    pub input: u32,
    /// The number of its values, as the system asks for it.
    pub size: u32,
    /// Its value, below `size`.
    pub value: u32,
}

/// The odometer over the inputs that are not held.
struct Partly<'a> {
    held: &'a [Held],
    free: Odometer,
}

impl Choices for Partly<'_> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        match self.held.iter().find(|h| h.input == input) {
            Some(held) => held.value.min(size.saturating_sub(1)),
            None => self.free.choose(input, size),
        }
    }
}

/// Makes every cycle from the state `before` in which the inputs `held` have their values, in the order of the choices and
/// only over what is read, until `each` breaks off. These are the cycles that [`crate::explore`] makes.
///
/// `before` must have a value of its domain for each state variable.
pub fn cycles<S: System>(
    system: &S,
    before: &[i32],
    held: &[Held],
    mut each: impl FnMut(Cycle<S::Work>) -> ControlFlow<()>,
) {
    let sizes = held.iter().map(|h| u128::from(h.size.max(1)));
    let combinations = sizes.fold(system.combinations(), |all, size| all / size);
    let mut choices = Partly {
        held,
        free: Odometer::new(combinations),
    };
    let mut work = system.work();
    let mut after = before.to_vec();
    choices.free.reset();
    loop {
        choices.free.begin();
        let done = system.next(&mut work, before, &mut choices, &mut after);
        if done.is_err() || !system.discarded(&work) {
            let after = done.and_then(|()| match within(system.domains(), &after) {
                true => Ok(after.as_slice()),
                false => Err(Fault::OUT_OF_DOMAIN),
            });
            let cycle = Cycle {
                reads: choices.free.values(),
                weight: choices.free.weight(),
                after,
                work: &mut work,
            };
            if each(cycle).is_break() {
                return;
            }
        }
        if !choices.free.advance() {
            return;
        }
    }
}

/// Gives the choices of every initial state and the state, until `each` breaks off.
pub fn initials<S: System>(system: &S, mut each: impl FnMut(&Step, &[i32]) -> ControlFlow<()>) {
    let mut choices = Odometer::new(1);
    let mut work = system.work();
    let mut state = vec![0; system.domains().len()];
    choices.reset();
    loop {
        choices.begin();
        system.initial(&mut work, &mut choices, &mut state);
        if each(&choices.values(), &state).is_break() || !choices.advance() {
            return;
        }
    }
}

fn within(domains: &[Domain], state: &[i32]) -> bool {
    let both = domains.iter().zip(state);
    both.into_iter()
        .all(|(domain, value)| (domain.lo..=domain.hi).contains(value))
}
