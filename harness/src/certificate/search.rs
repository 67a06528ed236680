//! The walk through the reachable states that collects what a certificate needs.

use std::collections::{BTreeMap, HashMap};

use stillpoint_certify::cycle::{PairCycle, Pairing};
use stillpoint_certify::format::{Body, Run, Task, Verdict};
use stillpoint_certify::states::Radix;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_model::System;

use super::cycle::Cycle;
use super::ranks::{Edge, distances, ranks};

/// A cycle: the number of the state before it, and the inputs.
type Place = (u32, Vec<(u32, u32)>);

/// The reachable states, and what each property needs.
pub(super) struct Search<'a, S> {
    bound: &'a Bound,
    system: &'a S,
    radix: Radix,
    /// States in the order in which they were found.
    keys: Vec<u128>,
    number: HashMap<u128, u32>,
    /// The state before; an initial one is its own.
    parent: Vec<u32>,
    needs: Vec<Need>,
    /// By site: a cycle that leaves a range.
    faults: BTreeMap<u32, Place>,
}

/// What is collected for one property.
#[derive(Default)]
struct Need {
    /// An atom of which a cycle is wanted, and that cycle.
    witness: Option<usize>,
    seen: Option<Place>,
    /// A duty: whether each state is under it, and the cycles between such states.
    duty: Option<Duty>,
    under: Vec<bool>,
    pending: Vec<Edge>,
    /// Recoverability: (goal, using), the states with a cycle that meets the goal, and the usable cycles.
    goal: Option<(usize, Option<usize>)>,
    direct: Vec<bool>,
    usable: Vec<(u32, u32)>,
}

/// The atoms of a duty.
#[derive(Clone)]
struct Duty {
    when: usize,
    end: usize,
    assuming: Option<usize>,
    fair: Vec<usize>,
}

impl Need {
    fn new(form: &Form, verdict: Verdict) -> Self {
        let mut need = Self::default();
        match form {
            Form::CanAlwaysReach { goal, using }
                if matches!(verdict, Verdict::Holds | Verdict::Violated) =>
            {
                need.goal = Some((*goal, *using));
            }
            _ if verdict != Verdict::Holds => {}
            Form::Always { when, .. } => need.witness = *when,
            Form::Independent { condition, .. } => need.witness = *condition,
            Form::LeadsTo {
                when,
                goal,
                fair,
                assuming,
                ..
            } => {
                need.witness = Some(*when);
                need.duty = Some(Duty {
                    when: *when,
                    end: *goal,
                    assuming: *assuming,
                    fair: fair.clone(),
                });
            }
            Form::Unless { when, unless, .. } => {
                need.witness = Some(*when);
                need.duty = Some(Duty {
                    when: *when,
                    end: *unless,
                    assuming: None,
                    fair: Vec::new(),
                });
            }
            Form::CanAlwaysReach { .. } | Form::Reachable { .. } => {}
        }
        need
    }

    /// What one cycle of the first walk shows.
    fn cycle<S: System>(&mut self, cycle: &mut Cycle<S>, from: u32, to: u32) {
        if let (Some(atom), None) = (self.witness, &self.seen) {
            let seen = &mut self.seen;
            cycle.all(|c| {
                if c.atom(atom) {
                    *seen = Some((from, c.inputs()));
                }
                seen.is_none()
            });
        }
        if let Some(duty) = self.duty.as_ref().filter(|_| !self.under[to as usize]) {
            self.under[to as usize] = !cycle.all(|c| c.atom(duty.end) || !c.atom(duty.when));
        }
        if let Some((goal, using)) = self.goal {
            let usable = |c: &mut Cycle<S>| using.is_none_or(|u| c.atom(u));
            if self.usable.last() != Some(&(from, to)) && !cycle.all(|c| !usable(c)) {
                self.usable.push((from, to));
            }
            let direct = &mut self.direct[from as usize];
            *direct = *direct || !cycle.all(|c| !(usable(c) && c.atom(goal)));
        }
    }

    fn grow(&mut self, states: usize) {
        if self.duty.is_some() {
            self.under.resize(states, false);
        }
        if self.goal.is_some() {
            self.direct.resize(states, false);
        }
    }
}

impl<'a, S: System> Search<'a, S> {
    /// Walks through all reachable states.
    pub(super) fn run(
        bound: &'a Bound,
        system: &'a S,
        radix: Radix,
        verdicts: &[Verdict],
    ) -> Result<Self, String> {
        let properties = bound.system.properties.iter().zip(verdicts);
        let mut search = Self {
            bound,
            system,
            radix,
            keys: Vec::new(),
            number: HashMap::new(),
            parent: Vec::new(),
            needs: properties.map(|(p, v)| Need::new(&p.form, *v)).collect(),
            faults: BTreeMap::new(),
        };
        search.initial()?;
        let mut cycles = Cycle::new(system);
        let mut state = vec![0; bound.states.len()];
        let mut from = 0;
        while let Some(key) = search.keys.get(from as usize).copied() {
            search.radix.state(key, &mut state);
            let edges: Vec<usize> = search.needs.iter().map(|n| n.usable.len()).collect();
            cycles.each(&state, |cycle, made| {
                if let Err(site) = made {
                    let place = || (from, cycle.inputs());
                    search.faults.entry(site).or_insert_with(place);
                    return Ok(());
                }
                let to = search.visit(cycle.after(), from)?;
                for need in &mut search.needs {
                    need.cycle(cycle, from, to);
                }
                Ok::<(), String>(())
            })?;
            for (need, start) in search.needs.iter_mut().zip(edges) {
                compact(&mut need.usable, start);
            }
            from += 1;
        }
        search.pending()?;
        Ok(search)
    }

    /// The initial states.
    fn initial(&mut self) -> Result<(), String> {
        let (initial, ranges) = (&self.bound.initial, &self.bound.states);
        let first = |k: usize| initial[k].unwrap_or(ranges[k].0);
        let mut state: Vec<i32> = (0..ranges.len()).map(first).collect();
        loop {
            let own = u32::try_from(self.keys.len()).map_err(|_| TOO_MANY)?;
            self.visit(&state, own)?;
            let free = |k: &usize| initial[*k].is_none() && state[*k] < ranges[*k].1;
            let Some(k) = (0..state.len()).rev().find(free) else {
                return Ok(());
            };
            state[k] += 1;
            (k + 1..state.len()).for_each(|later| state[later] = first(later));
        }
    }

    /// The number of a state, new if it is.
    fn visit(&mut self, state: &[i32], parent: u32) -> Result<u32, String> {
        let key = self
            .radix
            .index(state)
            .ok_or("a state is outside its ranges")?;
        if let Some(number) = self.number.get(&key) {
            return Ok(*number);
        }
        let number = u32::try_from(self.keys.len()).map_err(|_| TOO_MANY)?;
        self.number.insert(key, number);
        self.keys.push(key);
        self.parent.push(parent);
        for need in &mut self.needs {
            need.grow(self.keys.len());
        }
        Ok(number)
    }

    /// Follows the duties from the states in which they begin.
    fn pending(&mut self) -> Result<(), String> {
        let Self {
            bound,
            system,
            radix,
            keys,
            number,
            needs,
            ..
        } = self;
        let mut todo: Vec<Vec<usize>> = vec![Vec::new(); keys.len()];
        for (k, need) in needs.iter().enumerate().filter(|(_, n)| n.duty.is_some()) {
            for (state, _) in need.under.iter().enumerate().filter(|(_, under)| **under) {
                todo[state].push(k);
            }
        }
        let mut queue: Vec<u32> = (0..keys.len() as u32)
            .filter(|state| !todo[*state as usize].is_empty())
            .collect();
        let mut cycles = Cycle::new(*system);
        let mut state = vec![0; bound.states.len()];
        while let Some(from) = queue.pop() {
            let due = std::mem::take(&mut todo[from as usize]);
            let start: Vec<usize> = needs.iter().map(|n| n.pending.len()).collect();
            radix.state(keys[from as usize], &mut state);
            cycles.each(&state, |cycle, made| {
                if made.is_err() {
                    return Ok(());
                }
                let key = radix
                    .index(cycle.after())
                    .ok_or("a state is outside its ranges")?;
                let to = *number.get(&key).ok_or("a state is new")?;
                for k in &due {
                    let Need {
                        duty: Some(duty),
                        pending,
                        under,
                        ..
                    } = &mut needs[*k]
                    else {
                        continue;
                    };
                    let before = pending.len();
                    cycle.all(|c| {
                        if !c.atom(duty.end) && duty.assuming.is_none_or(|a| c.atom(a)) {
                            let met = |(k, atom): (usize, &usize)| u32::from(c.atom(*atom)) << k;
                            let label = duty.fair.iter().enumerate().map(met).sum();
                            if pending.last() != Some(&(from, to, label)) {
                                pending.push((from, to, label));
                            }
                        }
                        true
                    });
                    if pending.len() > before && !under[to as usize] {
                        under[to as usize] = true;
                        if todo[to as usize].is_empty() {
                            queue.push(to);
                        }
                        todo[to as usize].push(*k);
                    }
                }
                Ok::<(), String>(())
            })?;
            for k in due {
                compact(&mut needs[k].pending, start[k]);
            }
        }
        Ok(())
    }

    /// Adds what shows the claims.
    pub(super) fn prove(mut self, task: &mut Task, body: &mut Body) -> Result<(), String> {
        let needs = std::mem::take(&mut self.needs);
        let mut order: Vec<u32> = (0..self.keys.len() as u32).collect();
        order.sort_unstable_by_key(|number| self.keys[*number as usize]);
        body.states = order
            .iter()
            .map(|number| self.keys[*number as usize])
            .collect();
        task.states = body.states.len() as u64;
        let mut place = vec![0_u32; order.len()];
        for (sorted, number) in order.iter().enumerate() {
            place[*number as usize] = sorted as u32;
        }
        let properties = &self.bound.system.properties;
        for (number, need) in needs.into_iter().enumerate() {
            let (property, proof) = (&task.property[number], &mut body.proofs[number]);
            let fail = |e: String| format!("{}: {e}", property.id);
            let form = &properties[number].form;
            if property.verdict == Verdict::Holds {
                match (&need.seen, need.witness, form) {
                    (Some(seen), ..) => proof.runs.push(self.run_to(seen)?),
                    (None, Some(_), _) => return Err(fail("its condition never holds".to_owned())),
                    // Without a condition any cycle is a witness.
                    (None, None, Form::Independent { .. }) => {
                        proof.runs.push(self.run_to(&(0, Vec::new()))?);
                    }
                    (None, None, _) => {}
                }
            }
            let map = match (&need.duty, need.goal, form) {
                (Some(_), _, Form::Unless { .. }) => {
                    need.under.iter().map(|under| u32::from(*under)).collect()
                }
                (Some(duty), ..) => {
                    ranks(&need.under, &need.pending, duty.fair.len()).map_err(fail)?
                }
                (None, Some(_), _) => {
                    let distance = distances(&need.direct, &need.usable);
                    match property.verdict {
                        Verdict::Violated => distance.iter().map(|d| u32::from(*d == 0)).collect(),
                        _ => distance,
                    }
                }
                (None, None, _) => Vec::new(),
            };
            proof.map = match map[..] {
                [] => Vec::new(),
                _ => order.iter().map(|number| map[*number as usize]).collect(),
            };
            if let (
                Form::Independent {
                    observe,
                    of,
                    condition,
                },
                Verdict::Holds,
            ) = (form, property.verdict)
            {
                let pairing = Pairing {
                    observe,
                    of,
                    condition: *condition,
                };
                proof.pairs = self.pairs(pairing, &place).map_err(fail)?;
            }
        }
        for (site, place) in &self.faults {
            let name = self
                .bound
                .system
                .sites
                .get(*site as usize)
                .map_or("", |s| &s.name);
            if !task.faults.iter().any(|known| known == name) {
                task.faults.push(name.to_owned());
                body.faults.push(self.run_to(place)?);
            }
        }
        Ok(())
    }

    /// A shortest run to a state, then the cycle given.
    fn run_to(&self, (state, last): &Place) -> Result<Run, String> {
        let mut steps = vec![last.clone()];
        let mut cycles = Cycle::new(self.system);
        let mut before = vec![0; self.bound.states.len()];
        let mut to = *state;
        while self.parent[to as usize] != to {
            let from = self.parent[to as usize];
            self.radix.state(self.keys[from as usize], &mut before);
            let key = Some(self.keys[to as usize]);
            // The search ends with the inputs as its "error".
            let found = cycles.each(&before, |cycle, made| {
                match made.is_ok() && self.radix.index(cycle.after()) == key {
                    true => Err(cycle.inputs()),
                    false => Ok(()),
                }
            });
            steps.push(found.err().ok_or("a run cannot be told")?);
            to = from;
        }
        steps.reverse();
        Ok(Run {
            initial: self.keys[to as usize],
            steps,
            repeats: None,
        })
    }

    /// The pairs of states that two runs can reach side by side; `place` is the place of a state in the certificate.
    fn pairs(&self, pairing: Pairing, place: &[u32]) -> Result<Vec<u128>, String> {
        let count = place.len() as u128;
        let mut cycles = PairCycle::new(self.bound, &self.radix, pairing);
        let roots = (0..place.len() as u32).filter(|k| self.parent[*k as usize] == *k);
        let mut queue: Vec<(u32, u32)> = roots.map(|k| (k, k)).collect();
        let mut seen: std::collections::HashSet<(u32, u32)> = queue.iter().copied().collect();
        while let Some((one, other)) = queue.pop() {
            let before = [one, other].map(|number| self.keys[number as usize]);
            cycles.each(before, |after, _| {
                let [one, other] = after.map(|key| self.number.get(&key).copied());
                let pair = one.zip(other).ok_or("a state is new")?;
                if seen.insert(pair) {
                    queue.push(pair);
                }
                Ok::<(), String>(())
            })?;
        }
        let key = |(a, b): (u32, u32)| {
            u128::from(place[a as usize]) * count + u128::from(place[b as usize])
        };
        let mut pairs: Vec<u128> = seen.into_iter().map(key).collect();
        pairs.sort_unstable();
        Ok(pairs)
    }
}

const TOO_MANY: &str = "there are more than 2^32 states";

/// Sorts what was added from `start` on and drops what is there twice.
fn compact<T: Ord>(list: &mut Vec<T>, start: usize) {
    let mut tail = list.split_off(start);
    tail.sort_unstable();
    tail.dedup();
    list.append(&mut tail);
}
