//! Whether a task's proofs show its claims. Everything a certificate rests on is decided here.
//!
//! Let R be the set of states of a certificate. It is checked that each initial state is in R, and that each cycle from
//! a state of R, under each combination of inputs, leads into R (or is a range fault that is claimed and shown). So R
//! contains every reachable state, and what holds in each cycle from R holds in each cycle of each run. All claims come
//! down to that, with the help of numbers that the certificate gives to the states; see [`Duty`].

use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::ScopedJoinHandle;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;

use crate::cycle::{Cycle, PairCycle, Pairing};
use crate::format::{Body, Task, Verdict};
use crate::states::{Places, Radix};

/// What each cycle from a state of R to a state of R has to satisfy for one property.
pub(crate) enum Duty<'a> {
    /// Nothing.
    None,
    /// Where the condition holds, the claim does.
    Implies(Option<usize>, usize),
    /// The condition does not hold.
    Never(usize),
    /// The map is not 0 in states under the duty. A cycle that begins the duty or starts under it either ends it, or
    /// does what it asks and leads to a state under it.
    Unless(usize, usize, usize, &'a [u32]),
    /// The map gives ranks to the states in which the goal is awaited.
    Leads(Leads<'a>),
    /// The map is a distance: each state has a cycle (with `using`) that meets the goal or leads nearer.
    Near(usize, Option<usize>, &'a [u32]),
    /// The map is not 0 in lost states: their cycles (with `using`) do not meet the goal and lead to lost states.
    Lost(usize, Option<usize>, &'a [u32]),
}

impl Duty<'_> {
    /// The atoms it reads, and whether it asks where the cycle leads.
    fn reads(&self) -> (Vec<usize>, bool) {
        match self {
            Duty::None => (Vec::new(), false),
            Duty::Implies(when, then) => (when.iter().copied().chain([*then]).collect(), false),
            Duty::Never(atom) => (vec![*atom], false),
            Duty::Unless(when, holds, unless, _) => (vec![*when, *holds, *unless], true),
            Duty::Leads(leads) => {
                let atoms = leads.fair.iter().chain(&leads.assuming).copied();
                (atoms.chain([leads.when, leads.goal]).collect(), true)
            }
            Duty::Near(goal, using, _) | Duty::Lost(goal, using, _) => {
                (using.iter().copied().chain([*goal]).collect(), true)
            }
        }
    }
}

/// A response. A cycle that begins it without the goal leads to a state with a rank, at most the bound if there is one.
/// From a state with a rank each cycle without the goal (with `assuming`) leads to one with a lower rank: so after
/// `rank` cycles the goal has come. With n fairness conditions, rank / n is a level that must not rise. A cycle that
/// stays on the level keeps the rank, and does not satisfy condition rank MOD n: so a run that stays on a level forever
/// satisfies that condition only finitely often and does not count.
pub(crate) struct Leads<'a> {
    pub(crate) when: usize,
    pub(crate) goal: usize,
    pub(crate) within: Option<u32>,
    pub(crate) fair: &'a [usize],
    pub(crate) assuming: Option<usize>,
    pub(crate) rank: &'a [u32],
}

impl Leads<'_> {
    /// A cycle from the state at `from` to that at `to`; false if it breaks the rules.
    fn cycle(&self, cycle: &mut Cycle, from: usize, to: usize, most: &mut u32) -> bool {
        let (rank, next) = (self.rank[from], self.rank[to]);
        // Where nothing is awaited and nothing begins, the goal does not matter.
        let begins = cycle.atom(self.when);
        if (rank == 0 && !begins) || cycle.atom(self.goal) {
            return true;
        }
        if begins {
            *most = next.max(*most);
            if next == 0 || self.within.is_some_and(|within| next > within) {
                return false;
            }
        }
        if rank == 0 || !self.assuming.is_none_or(|a| cycle.atom(a)) {
            return true;
        }
        let n = self.fair.len().max(1) as u32;
        let unfair = |cycle: &mut Cycle| {
            let condition = self.fair.get((rank % n) as usize);
            next == rank && condition.is_some_and(|c| !cycle.atom(*c))
        };
        next != 0 && (next / n < rank / n || unfair(cycle))
    }
}

/// One task, ready to be checked.
pub(crate) struct Checker<'a> {
    pub(crate) bound: &'a Bound,
    pub(crate) task: &'a Task,
    pub(crate) body: &'a Body,
    pub(crate) radix: Radix,
    pub(crate) places: Places<'a>,
    pub(crate) threads: usize,
}

const TOO_MANY: &str = "there are 2^32 states or pairs of states, or more";

/// Checks all claims about one task. For each property the greatest number of cycles after which a response has come,
/// where it shows one.
///
/// # Errors
/// What is not shown: one line.
pub fn check(
    bound: &Bound,
    task: &Task,
    body: &Body,
    threads: usize,
) -> Result<Vec<Option<u32>>, String> {
    let radix = Radix::new(bound).ok_or("its states need more than 128 bits")?;
    let checker = Checker {
        bound,
        task,
        body,
        radix,
        places: Places::new(&body.states).ok_or(TOO_MANY)?,
        threads,
    };
    checker.faults()?;
    let mut duties = Vec::new();
    for (number, (property, proof)) in task.property.iter().zip(&body.proofs).enumerate() {
        let form = &bound.system.properties[number].form;
        let duty = checker.claim(form, property.verdict, proof);
        duties.push(duty.map_err(|what| format!("{}: {what}", property.id))?);
    }
    if body.states.is_empty() {
        return Ok(vec![None; duties.len()]);
    }
    checker.initial()?;
    let most = checker.closed(&duties)?;
    for (number, (property, proof)) in task.property.iter().zip(&body.proofs).enumerate() {
        let form = &bound.system.properties[number].form;
        if let (Some(pairing), Verdict::Holds) = (pairing(form), property.verdict) {
            let paired = checker.pairs(pairing, &proof.pairs);
            paired.map_err(|what| format!("{}: {what}", property.id))?;
        }
    }
    let told = |(duty, most): (&Duty, u32)| match duty {
        Duty::Leads(Leads { fair: [], .. }) => Some(most),
        _ => None,
    };
    Ok(duties.iter().zip(most).map(told).collect())
}

pub(crate) fn pairing(form: &Form) -> Option<Pairing<'_>> {
    match form {
        Form::Independent {
            observe,
            of,
            condition,
        } => Some(Pairing {
            observe,
            of,
            condition: *condition,
        }),
        _ => None,
    }
}

impl<'a> Checker<'a> {
    /// Each initial state is in the set; states outside the ranges are not.
    fn initial(&self) -> Result<(), String> {
        if self
            .body
            .states
            .last()
            .is_some_and(|s| *s >= self.radix.space)
        {
            return Err("a state is outside the ranges of the variables".to_owned());
        }
        let (initial, ranges) = (&self.bound.initial, &self.bound.states);
        let mut state: Vec<i32> = (initial.iter().zip(ranges))
            .map(|(init, (lo, _))| init.unwrap_or(*lo))
            .collect();
        loop {
            (self.radix.index(&state))
                .and_then(|state| self.places.find(state))
                .ok_or("an initial state is missing in the set of states")?;
            let free = |k: &usize| initial[*k].is_none() && state[*k] < ranges[*k].1;
            let Some(k) = (0..state.len()).rev().find(free) else {
                return Ok(());
            };
            state[k] += 1;
            for later in k + 1..state.len() {
                state[later] = initial[later].unwrap_or(ranges[later].0);
            }
        }
    }

    /// Each cycle from a state of the set leads into the set and does its duties. For each duty the greatest rank with
    /// which a response begins.
    fn closed(&self, duties: &[Duty]) -> Result<Vec<u32>, String> {
        // Duties whose numbers agree in the last 7 bits share a mark.
        let mark = |number: usize| 1_u128 << (number % 128);
        let reads = duties.iter().map(Duty::reads).enumerate();
        let (atoms, leads): (Vec<_>, Vec<_>) = reads
            .map(|(number, (atoms, leads))| {
                ((mark(number), atoms), u128::from(leads) * mark(number))
            })
            .unzip();
        let leading = leads.iter().fold(0, |all, one| all | one);
        let begin = || {
            let cycles = Cycle::new(self.bound, &self.radix, &atoms);
            (cycles, vec![0; duties.len()], vec![false; duties.len()])
        };
        let parts = self.share(
            self.body.states.len(),
            begin,
            |(cycles, most, moves), range| {
                for from in range {
                    moves.fill(false);
                    let mut last = None;
                    cycles.each(self.body.states[from], |cycle, made| {
                        if let Err(site) = made {
                            return self.claimed(site);
                        }
                        let to = self.places.find(cycle.after()).ok_or_else(|| {
                            format!(
                                "a successor of state {} is missing in the set of states",
                                self.body.states[from]
                            )
                        })?;
                        let mut due = cycle.marked();
                        if last.replace(to) != Some(to) {
                            due |= leading;
                        }
                        // What a duty depends on does not differ from the cycle before, in which it was done, if it has no mark.
                        for (number, duty) in duties.iter().enumerate() {
                            if due & mark(number) != 0
                                && !done(
                                    duty,
                                    cycle,
                                    (from, to),
                                    &mut moves[number],
                                    &mut most[number],
                                )
                            {
                                return Err(self.breaks(number, from));
                            }
                        }
                        Ok(())
                    })?;
                    let still =
                        |(duty, moves): (&Duty, &bool)| matches!(duty, Duty::Near(..)) && !moves;
                    if let Some(number) = duties.iter().zip(moves.iter()).position(still) {
                        return Err(self.breaks(number, from));
                    }
                }
                Ok(())
            },
        )?;
        let mut most = vec![0; duties.len()];
        for (_, part, _) in parts {
            most.iter_mut().zip(part).for_each(|(m, p)| *m = p.max(*m));
        }
        Ok(most)
    }

    fn claimed(&self, site: u32) -> Result<(), String> {
        let name = self.bound.system.sites.get(site as usize).map(|s| &s.name);
        match name {
            Some(name) if self.task.faults.contains(name) => Ok(()),
            name => Err(format!(
                "a range fault is not claimed: {}",
                name.map_or("", |n| n)
            )),
        }
    }

    fn breaks(&self, number: usize, from: usize) -> String {
        let (id, state) = (&self.task.property[number].id, self.body.states[from]);
        format!("{id}: not shown in the cycles from state {state}")
    }

    /// Each pair of equal initial states is in the set of pairs, which is closed; all its pairs of cycles agree.
    fn pairs(&self, pairing: Pairing, pairs: &[u128]) -> Result<(), String> {
        let count = self.body.states.len() as u128;
        if pairs.last().is_some_and(|pair| *pair >= count * count) {
            return Err("a pair is outside the set of states".to_owned());
        }
        let places = Places::new(pairs).ok_or(TOO_MANY)?;
        let mut initial = vec![0; self.bound.states.len()];
        for (number, index) in self.body.states.iter().enumerate() {
            self.radix.state(*index, &mut initial);
            let starts =
                (initial.iter().zip(&self.bound.initial)).all(|(v, i)| i.is_none_or(|i| i == *v));
            if starts && places.find(number as u128 * (count + 1)).is_none() {
                return Err("a pair of initial states is missing".to_owned());
            }
        }
        let place = |state| Some(self.places.find(state)? as u128);
        let begin = || PairCycle::new(self.bound, &self.radix, pairing);
        self.share(pairs.len(), begin, |cycles, range| {
            for pair in &pairs[range] {
                let before = [pair / count, pair % count];
                let before = before.map(|place| self.body.states[place as usize]);
                cycles.each(before, |[first, second], agree| {
                    let pair = (place(first).zip(place(second)))
                        .and_then(|(first, second)| places.find(first * count + second));
                    match (agree, pair) {
                        (false, _) => {
                            Err("an observed expression depends on the inputs".to_owned())
                        }
                        (true, None) => Err("a pair of successors is missing".to_owned()),
                        (true, Some(_)) => Ok(()),
                    }
                })?;
            }
            Ok(())
        })?;
        Ok(())
    }

    /// Shares the numbers below `count` among the threads, each with a work area of its own, and gives these areas back. Of several
    /// errors that of the lowest numbers is told.
    fn share<W: Send>(
        &self,
        count: usize,
        begin: impl Fn() -> W + Sync,
        work: impl Fn(&mut W, Range<usize>) -> Result<(), String> + Sync,
    ) -> Result<Vec<W>, String> {
        const PIECE: usize = 512;
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let worker = || {
            let mut area = begin();
            while !failed.load(Ordering::Relaxed) {
                let start = next.fetch_add(PIECE, Ordering::Relaxed);
                if start >= count {
                    break;
                }
                work(&mut area, start..count.min(start + PIECE)).map_err(|what| {
                    failed.store(true, Ordering::Relaxed);
                    (start, what)
                })?;
            }
            Ok(area)
        };
        let done: Vec<Result<W, (usize, String)>> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..self.threads).map(|_| scope.spawn(worker)).collect();
            let own = worker();
            let join =
                |other: ScopedJoinHandle<_>| other.join().unwrap_or_else(|p| resume_unwind(p));
            others.into_iter().map(join).chain([own]).collect()
        });
        let (areas, errors): (Vec<_>, Vec<_>) = done.into_iter().partition(Result::is_ok);
        match errors.into_iter().filter_map(Result::err).min() {
            Some((_, what)) => Err(what),
            None => Ok(areas.into_iter().flatten().collect()),
        }
    }
}

/// Whether a cycle, from the state at one place to that at the other, does a duty.
fn done(
    duty: &Duty,
    cycle: &mut Cycle,
    (from, to): (usize, usize),
    moves: &mut bool,
    most: &mut u32,
) -> bool {
    match duty {
        Duty::None => true,
        Duty::Implies(when, then) => {
            cycle.all(|c| !when.is_none_or(|w| c.atom(w)) || c.atom(*then))
        }
        Duty::Never(atom) => cycle.all(|c| !c.atom(*atom)),
        Duty::Unless(when, holds, unless, under) => cycle.all(|c| {
            let asked = under[from] != 0 || c.atom(*when);
            !asked || c.atom(*unless) || (c.atom(*holds) && under[to] != 0)
        }),
        Duty::Leads(leads) => cycle.all(|c| leads.cycle(c, from, to, most)),
        Duty::Near(goal, using, distance) => {
            let stuck = |c: &mut Cycle| {
                let usable = using.is_none_or(|u| c.atom(u));
                !(usable && (c.atom(*goal) || distance[to] < distance[from]))
            };
            *moves = *moves || !cycle.all(stuck);
            true
        }
        Duty::Lost(goal, using, lost) => {
            lost[from] == 0
                || cycle.all(|c| {
                    let usable = using.is_none_or(|u| c.atom(u));
                    !usable || (!c.atom(*goal) && lost[to] != 0)
                })
        }
    }
}
