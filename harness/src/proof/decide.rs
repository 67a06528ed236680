//! One question, one engine after the other.

use std::time::Instant;

use stillpoint_model::proof::{
    Bounded, Budget, Induction, Lit, Netlist, Problem, Reachability, Run, Spent, induction,
    reachability,
};

use super::{Choice, Proof};

/// Cycles that are looked at before an engine for runs of any length begins: most witnesses are within.
const SHORT: usize = 8;

/// Why there is no answer, where a limit ended the search.
pub(super) const LIMITED: &str = "the limit was reached first";

/// The answer to a question.
#[derive(Debug)]
pub(super) enum Decision {
    /// No run of any length shows it.
    Never(Proof),
    /// A shortest run that does.
    Seen(Run),
    /// No answer: why.
    Open(String),
}

/// Cycles that are looked at at most, for engines that do not end by themselves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Depth(pub usize);

/// Whether a run of the netlist ends in a cycle with `target`.
pub(super) fn decide(
    netlist: &Netlist,
    target: Lit,
    choice: Choice,
    depth: Depth,
    budget: &Budget,
) -> Decision {
    if target == Lit::FALSE {
        return Decision::Never(Proof::Nothing);
    }
    let problem = Problem::new(netlist, target);
    let decision = match choice {
        Choice::Bmc => bounded(&problem, depth, budget),
        Choice::Induction => inductive(&problem, depth, budget),
        Choice::Pdr => reached(&problem, 0, budget),
        Choice::Auto | Choice::Explorer | Choice::Bdd => reached(&problem, SHORT, budget),
    };
    match decision {
        // Whatever an engine says is checked by other code.
        Ok(Decision::Seen(run)) if !problem.shows(&run) => {
            Decision::Open("the engine's run is none: please report this".to_owned())
        }
        Ok(decision) => decision,
        Err(Spent) => Decision::Open(LIMITED.to_owned()),
    }
}

fn bounded(problem: &Problem, depth: Depth, budget: &Budget) -> Result<Decision, Spent> {
    Ok(match Bounded::new(problem, budget).within(depth.0)? {
        Some(run) => Decision::Seen(run),
        None => Decision::Open(format!("no run of up to {} cycles", depth.0)),
    })
}

fn inductive(problem: &Problem, depth: Depth, budget: &Budget) -> Result<Decision, Spent> {
    Ok(match induction(problem, depth.0, budget)? {
        Induction::Proved(k, differ) => Decision::Never(Proof::Induction(k, differ)),
        Induction::Found(run) => Decision::Seen(run),
        Induction::Open => Decision::Open(format!(
            "no run of up to {0} cycles, and {0} cycles do not prove that there is none",
            depth.0
        )),
    })
}

/// Reachability, after a look at short runs. A run that it finds need not be a shortest one.
fn reached(problem: &Problem, short: usize, budget: &Budget) -> Result<Decision, Spent> {
    let mut runs = Bounded::new(problem, budget);
    if let Some(run) = runs.within(short)? {
        return Ok(Decision::Seen(run));
    }
    match reachability(problem, budget)?.0 {
        Reachability::Proved(invariant) => Ok(
            match invariant.check(problem.netlist(), problem.bad(), budget)? {
                Ok(()) => Decision::Never(Proof::Invariant(invariant)),
                Err(defect) => Decision::Open(format!(
                    "the engine's invariant shows nothing, {defect}: please report this"
                )),
            },
        ),
        Reachability::Found(run) if !problem.shows(&run) => Ok(Decision::Seen(run)),
        Reachability::Found(run) => {
            let shorter = runs.within(run.cycles.len() - 1)?;
            Ok(Decision::Seen(shorter.unwrap_or(run)))
        }
    }
}

/// The budget from now on.
pub(super) fn until(time: Option<std::time::Duration>) -> Option<Instant> {
    time.map(|time| Instant::now() + time)
}
