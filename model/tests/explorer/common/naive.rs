//! A second, naive implementation of all property forms: explicit edges for every input combination, and fixpoints over
//! sets of states. It shares nothing with the explorer but the meaning.

use super::Table;
use std::collections::{BTreeMap, BTreeSet};
use stillpoint_model::{Form, Verdict};

/// A cycle under one full input combination.
pub struct Edge {
    pub from: usize,
    pub to: usize,
    pub atoms: Vec<bool>,
}

pub struct Naive {
    /// All reachable states and their depth.
    pub depth: BTreeMap<usize, u64>,
    /// Cycles from reachable states that meet no fault.
    pub edges: Vec<Edge>,
    /// Least depth by fault.
    pub faults: BTreeMap<u32, u64>,
    pub transitions: u128,
    pub absorbing: u64,
}

pub struct Answer {
    pub verdict: Verdict,
    pub length: Option<u64>,
    pub bound: Option<u64>,
    pub fastest: Option<u64>,
}

type Set = BTreeSet<usize>;

impl Naive {
    pub fn new(table: &Table) -> Self {
        let mut all = Vec::new();
        let mut faulty = Vec::new();
        for from in 0..table.states {
            for a in 0..table.sizes[0] {
                for b in 0..table.sizes[1] {
                    for c in 0..table.sizes[2] {
                        let masked = |keep: [bool; 3]| {
                            let value = |k: bool, v: u32| if k { v } else { 0 };
                            table.index(
                                from,
                                [value(keep[0], a), value(keep[1], b), value(keep[2], c)],
                            )
                        };
                        let [x, y] = table.reads[from];
                        match table.next[masked([x, y, false])] {
                            Ok(to) => {
                                let atoms = table
                                    .atoms
                                    .iter()
                                    .map(|(keep, v)| v[masked(*keep)])
                                    .collect();
                                all.push(Edge { from, to, atoms });
                            }
                            Err(code) => faulty.push((from, code)),
                        }
                    }
                }
            }
        }
        let mut depth: BTreeMap<usize, u64> = table.initial.iter().map(|s| (*s, 0)).collect();
        for level in 0.. {
            let next: Set = all
                .iter()
                .filter(|e| depth.get(&e.from) == Some(&level))
                .map(|e| e.to)
                .collect();
            let new: Vec<usize> = next
                .into_iter()
                .filter(|s| !depth.contains_key(s))
                .collect();
            if new.is_empty() {
                break;
            }
            depth.extend(new.into_iter().map(|s| (s, level + 1)));
        }
        let mut faults = BTreeMap::new();
        faulty.retain(|(from, _)| depth.contains_key(from));
        for (from, code) in &faulty {
            let least = faults.entry(*code).or_insert(depth[from]);
            *least = depth[from].min(*least);
        }
        let edges: Vec<Edge> = all
            .into_iter()
            .filter(|e| depth.contains_key(&e.from))
            .collect();
        let stays = |s: &usize| {
            edges.iter().filter(|e| e.from == *s).all(|e| e.to == *s)
                && faulty.iter().all(|(from, _)| from != s)
        };
        let absorbing = depth.keys().filter(|s| stays(s)).count() as u64;
        let transitions = (edges.len() + faulty.len()) as u128;
        Naive {
            depth,
            edges,
            faults,
            transitions,
            absorbing,
        }
    }

    fn shortest(&self, edge: impl Fn(&Edge) -> bool) -> Option<u64> {
        self.edges
            .iter()
            .filter(|e| edge(e))
            .map(|e| self.depth[&e.from] + 1)
            .min()
    }

    pub fn judge(&self, form: &Form) -> Answer {
        let answer = |verdict, length| Answer {
            verdict,
            length,
            bound: None,
            fastest: None,
        };
        let given = |e: &Edge, atom: &Option<usize>| atom.is_none_or(|a| e.atoms[a]);
        match form {
            Form::Always { when, then } => {
                if let Some(length) = self.shortest(|e| given(e, when) && !e.atoms[*then]) {
                    return answer(Verdict::Violated, Some(length));
                }
                let Some(when) = when else {
                    return answer(Verdict::Holds, None);
                };
                self.unless_vacuous(*when)
            }
            Form::Reachable { goal } => match self.shortest(|e| e.atoms[*goal]) {
                Some(length) => answer(Verdict::Reached, Some(length)),
                None => answer(Verdict::Unreachable, None),
            },
            Form::CanAlwaysReach { goal, using } => {
                let mut good = Set::new();
                loop {
                    let step =
                        |e: &&Edge| given(e, using) && (e.atoms[*goal] || good.contains(&e.to));
                    let more: Set = self.edges.iter().filter(step).map(|e| e.from).collect();
                    if more == good {
                        break;
                    }
                    good = more;
                }
                let lost = self
                    .depth
                    .iter()
                    .filter(|(s, _)| !good.contains(s))
                    .map(|(_, d)| *d)
                    .min();
                match lost {
                    Some(depth) => answer(Verdict::Violated, Some(depth)),
                    None => answer(
                        Verdict::Holds,
                        self.shortest(|e| given(e, using) && e.atoms[*goal]),
                    ),
                }
            }
            Form::Unless {
                when,
                holds,
                unless,
            } => self.unless(*when, *holds, *unless),
            Form::LeadsTo {
                when,
                goal,
                within,
                fair,
                assuming,
            } => {
                let start = |e: &Edge| e.atoms[*when] && !e.atoms[*goal];
                let pending = |e: &Edge| !e.atoms[*goal] && given(e, assuming);
                match within {
                    Some(within) => {
                        let end = |e: &Edge| e.atoms[*goal] && given(e, assuming);
                        let answer = self.bounded(*when, start, pending, u64::from(*within));
                        let fastest = match answer.verdict {
                            Verdict::Vacuous => None,
                            _ => self.fastest(
                                |e| e.atoms[*when],
                                |e| e.atoms[*goal],
                                start,
                                pending,
                                end,
                            ),
                        };
                        Answer { fastest, ..answer }
                    }
                    None => self.fair(*when, start, pending, fair),
                }
            }
        }
    }

    fn unless_vacuous(&self, when: usize) -> Answer {
        match self.shortest(|e| e.atoms[when]) {
            None => Answer {
                verdict: Verdict::Vacuous,
                length: None,
                bound: None,
                fastest: None,
            },
            length => Answer {
                verdict: Verdict::Holds,
                length,
                bound: None,
                fastest: None,
            },
        }
    }

    /// The least number of cycles to the goal: sets of states that are 1, 2, ... cycles away from a start.
    fn fastest(
        &self,
        when: impl Fn(&Edge) -> bool,
        goal: impl Fn(&Edge) -> bool,
        start: impl Fn(&Edge) -> bool,
        pending: impl Fn(&Edge) -> bool,
        end: impl Fn(&Edge) -> bool,
    ) -> Option<u64> {
        if self.edges.iter().any(|e| when(e) && goal(e)) {
            return Some(0);
        }
        let after = |pass: &dyn Fn(&Edge) -> bool| -> Set {
            let passing = self.edges.iter().filter(|e| pass(e));
            passing.map(|e| e.to).collect()
        };
        let mut set = after(&start);
        for cycles in 1..=self.depth.len() as u64 {
            if self.edges.iter().any(|e| end(e) && set.contains(&e.from)) {
                return Some(cycles);
            }
            set = after(&|e| pending(e) && set.contains(&e.from));
        }
        None
    }

    fn bounded(
        &self,
        when: usize,
        start: impl Fn(&Edge) -> bool,
        pending: impl Fn(&Edge) -> bool,
        within: u64,
    ) -> Answer {
        let mut set: Set = self
            .edges
            .iter()
            .filter(|e| start(e))
            .map(|e| e.to)
            .collect();
        let mut sizes = Vec::new();
        // After more cycles than there are states a path has gone round, and goes on forever.
        for _ in 0..self.depth.len() + 2 {
            sizes.push(set.len());
            set = self
                .edges
                .iter()
                .filter(|e| pending(e) && set.contains(&e.from))
                .map(|e| e.to)
                .collect();
        }
        let bound = sizes
            .iter()
            .position(|size| *size == 0)
            .map(|bound| bound as u64);
        if bound.is_some_and(|bound| bound <= within) {
            let answer = self.unless_vacuous(when);
            let bound = bound.filter(|_| answer.verdict == Verdict::Holds);
            return Answer { bound, ..answer };
        }
        // The states from which `within` pending cycles can follow.
        let mut long: Set = self.depth.keys().copied().collect();
        for _ in 0..within {
            long = self
                .edges
                .iter()
                .filter(|e| pending(e) && long.contains(&e.to))
                .map(|e| e.from)
                .collect();
        }
        let first = self
            .shortest(|e| start(e) && long.contains(&e.to))
            .expect("a pending path");
        Answer {
            verdict: Verdict::Violated,
            length: Some(first + within),
            bound,
            fastest: None,
        }
    }

    /// Emerson and Lei's fixpoint, on cycles.
    fn fair(
        &self,
        when: usize,
        start: impl Fn(&Edge) -> bool,
        pending: impl Fn(&Edge) -> bool,
        fair: &[usize],
    ) -> Answer {
        let mut stay: Set = self.depth.keys().copied().collect();
        loop {
            let before = stay.clone();
            let conditions: Vec<Option<usize>> = match fair {
                [] => vec![None],
                some => some.iter().map(|a| Some(*a)).collect(),
            };
            for condition in conditions {
                let inside =
                    |e: &&Edge| pending(e) && stay.contains(&e.from) && stay.contains(&e.to);
                let met = |e: &&Edge| condition.is_none_or(|a| e.atoms[a]);
                let mut reach: Set = self
                    .edges
                    .iter()
                    .filter(inside)
                    .filter(met)
                    .map(|e| e.from)
                    .collect();
                loop {
                    let back: Set = self
                        .edges
                        .iter()
                        .filter(inside)
                        .filter(|e| reach.contains(&e.to))
                        .map(|e| e.from)
                        .collect();
                    let size = reach.len();
                    reach.extend(back);
                    if reach.len() == size {
                        break;
                    }
                }
                stay = reach;
            }
            if stay == before {
                break;
            }
        }
        match self.shortest(|e| start(e) && stay.contains(&e.to)) {
            Some(_) => Answer {
                verdict: Verdict::Violated,
                length: None,
                bound: None,
                fastest: None,
            },
            None => self.unless_vacuous(when),
        }
    }

    fn unless(&self, when: usize, holds: usize, unless: usize) -> Answer {
        let duty = |e: &Edge| !e.atoms[unless] && e.atoms[holds];
        let broken = |e: &Edge| !e.atoms[unless] && !e.atoms[holds];
        // The least number of cycles after which a duty can be pending in a state.
        let mut since: BTreeMap<usize, u64> = BTreeMap::new();
        loop {
            let before = since.clone();
            for e in &self.edges {
                let from = match (e.atoms[when], before.get(&e.from)) {
                    (true, _) => self.depth[&e.from],
                    (false, Some(depth)) => *depth,
                    (false, None) => continue,
                };
                if duty(e) {
                    let least = since.entry(e.to).or_insert(from + 1);
                    *least = (from + 1).min(*least);
                }
            }
            if since == before {
                break;
            }
        }
        let at_once = self.shortest(|e| e.atoms[when] && broken(e));
        let later = self
            .edges
            .iter()
            .filter(|e| broken(e))
            .filter_map(|e| since.get(&e.from))
            .map(|d| d + 1)
            .min();
        match at_once.into_iter().chain(later).min() {
            length @ Some(_) => Answer {
                verdict: Verdict::Violated,
                length,
                bound: None,
                fastest: None,
            },
            None => self.unless_vacuous(when),
        }
    }
}
