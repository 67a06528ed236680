//! What can be explored: a finite system of states that makes one step a cycle.

use crate::parts::Component;
use crate::stages::{Condition, Stages};

/// The environment of one cycle: it answers each input the system asks for.
///
/// Within one cycle the same input always gets the same answer, however often it is asked for.
pub trait Choices {
    /// The value of input number `input`, in `0..size`. `size` is at least 1 and belongs to the input.
    fn choose(&mut self, input: u32, size: u32) -> u32;
}

/// The values of one state variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Domain {
    /// The least value.
    pub lo: i32,
    /// The greatest value, at least `lo`.
    pub hi: i32,
}

impl Domain {
    /// The number of values; 0 if `hi < lo`.
    pub fn size(self) -> u64 {
        u64::try_from(i64::from(self.hi) - i64::from(self.lo) + 1).unwrap_or(0)
    }
}

/// An evaluation fault (a value left its range) reached by a cycle; such a cycle has no successor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Names the place; its meaning is the system's, except for the two constants here.
    pub code: u32,
}

impl Fault {
    /// The explorer's own: `next` gave a state outside the declared domains.
    pub const OUT_OF_DOMAIN: Fault = Fault { code: u32::MAX };
    /// An observation was asked for that the system does not have.
    pub const NO_OBSERVATION: Fault = Fault { code: u32::MAX - 1 };
}

/// A finite system. A cycle leads from a state to a state; *atoms* are Boolean statements about one cycle.
///
/// All methods are functions of their arguments, the work area and the answers of `Choices` alone: the explorer runs
/// one cycle again and again with other answers, and relies on getting the same questions for the same answers.
pub trait System: Sync {
    /// The work area of one thread, for example the frame of values of the cycle just made.
    type Work: Send + Clone;

    /// A new work area.
    fn work(&self) -> Self::Work;

    /// The state variables.
    fn domains(&self) -> &[Domain];

    /// The number of input combinations a cycle has: the product of the sizes of all inputs, read or not.
    fn combinations(&self) -> u128;

    /// Writes an initial state to `state`; its choices may use input numbers of their own.
    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]);

    /// Makes one cycle from the state `before` and writes every variable of the state `after` it.
    ///
    /// # Errors
    /// The fault that evaluation met.
    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault>;

    /// The value of an atom in the cycle just made by `next`; it may read further inputs of that cycle.
    ///
    /// # Errors
    /// The fault that evaluation met.
    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault>;

    /// Whether an atom may read an input that `next` did not read. Where none does, the explorer need not keep a copy of
    /// the work area for the further values of such inputs.
    fn atoms_read(&self) -> bool {
        true
    }

    /// The number of rules whose coverage is counted.
    fn rules(&self) -> usize {
        0
    }

    /// Calls `each` with the number of every rule that fired in the cycle just made.
    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        let _ = (work, each);
    }

    /// The value of observed expression number `expression` in the cycle just made; used by [`crate::Twin`].
    ///
    /// # Errors
    /// The fault that evaluation met; [`Fault::NO_OBSERVATION`] if the system has no such expression.
    fn observe<C: Choices>(
        &self,
        work: &mut Self::Work,
        expression: usize,
        choices: &mut C,
    ) -> Result<i64, Fault> {
        let _ = (work, expression, choices);
        Err(Fault::NO_OBSERVATION)
    }

    /// A state variable that merely counts down and is set anew: with [`crate::Options::intervals`] its values are stored
    /// as intervals.
    fn timer(&self) -> Option<usize> {
        None
    }

    /// The parts of the system that share nothing but inputs, if it falls into several: together they have every state
    /// variable, and a cycle of the system is a cycle of each of them under the same inputs. None is discarded.
    fn components(&self) -> Vec<Component<'_>> {
        Vec::new()
    }

    /// The cycles of the system in stages, if it has such: the explorer takes them where a state has many input combinations. Which
    /// of the conditions hold is told with the end of each cycle.
    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        let _ = conditions;
        None
    }

    /// Whether the answers of the cycle just made by `next` are no input at all, so that the cycle does not exist.
    /// (A restriction on inputs that only the evaluation can tell.)
    fn discarded(&self, work: &Self::Work) -> bool {
        let _ = work;
        false
    }
}
