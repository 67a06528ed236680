//! Bounded model checking (BMC): the shortest run to what is looked for, and k-induction.

use super::netlist::{Problem, Run};
use super::sat::{Budget, Spent};
use super::unroll::{From, Unrolling};

/// Looks for runs of rising length.
pub struct Bounded<'a> {
    unrolling: Unrolling<'a>,
}

impl<'a> Bounded<'a> {
    /// None has been looked for yet.
    pub fn new(problem: &'a Problem<'a>, budget: &Budget) -> Self {
        Bounded {
            unrolling: Unrolling::new(problem, From::Start, budget),
        }
    }

    /// Cycles of the longest runs looked at so far.
    pub fn cycles(&self) -> usize {
        self.unrolling.cycles()
    }

    /// A run that is one cycle longer; where it is called until there is one, it is a shortest one.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn longer(&mut self) -> Result<Option<Run>, Spent> {
        let last = self.unrolling.cycles();
        self.unrolling.extend();
        if self.unrolling.possible(last)? {
            return Ok(Some(self.unrolling.run(last)));
        }
        self.unrolling.exclude(last);
        Ok(None)
    }

    /// The shortest run of at most so many cycles.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn within(&mut self, cycles: usize) -> Result<Option<Run>, Spent> {
        while self.cycles() < cycles {
            if let Some(run) = self.longer()? {
                return Ok(Some(run));
            }
        }
        Ok(None)
    }
}

/// What k-induction finds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Induction {
    /// Nowhere: so many cycles without it are followed by another one, where these pairs of them begin in different states.
    Proved(usize, Vec<(usize, usize)>),
    /// The shortest run.
    Found(Run),
    /// No answer with at most so many cycles.
    Open,
}

/// k-induction over states that differ (simple paths), for rising k up to `most` cycles. With `most` beyond the number of states
/// there is always an answer.
///
/// # Errors
/// The budget is spent.
pub fn induction(problem: &Problem<'_>, most: usize, budget: &Budget) -> Result<Induction, Spent> {
    let mut base = Bounded::new(problem, budget);
    let mut step = Unrolling::new(problem, From::Anywhere, budget);
    let mut differ = Vec::new();
    for k in 0..most {
        if let Some(run) = base.longer()? {
            return Ok(Induction::Found(run));
        }
        // Cycle k of a path whose cycles before it are good.
        step.extend();
        loop {
            if !step.possible(k)? {
                return Ok(Induction::Proved(k, differ));
            }
            match step.repeated() {
                Some((one, other)) => {
                    step.separate(one, other);
                    differ.push((one, other));
                }
                None => break,
            }
        }
        step.exclude(k);
    }
    Ok(Induction::Open)
}
