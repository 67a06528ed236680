//! Decomposition of a system into independent components, parts with nothing in common but inputs, such as axes that no monitor
//! connects: the cycles of each part are tabulated once, and a cycle of the system is put together from the tables.
//!
//! What a cycle of a part reads of the inputs is a *cube*: some inputs with their values, the others free. A cycle of the
//! system is a cycle of each part such that the cubes agree. Which cycles agree depends on the cubes alone; local states
//! with equal cubes share a *pattern*, and what agrees is found once for each combination of patterns.

mod patterns;
mod tabulate;

use crate::cursor::Cursor;
use crate::pack::{Key, Packer};
use crate::process::{Origin, Source};
use crate::property::Property;
use crate::system::System;
use crate::watch::Watch;
use patterns::{Pattern, Shared, agree};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use tabulate::{Builder, Digits, RoughTable, part_of};

/// A part of a system: a system over the same state variables and inputs that changes only its own variables.
pub struct Component<'s> {
    states: Vec<usize>,
    atoms: Vec<usize>,
    system: Box<dyn Source + 's>,
}

impl<'s> Component<'s> {
    /// A part with these state variables, and with the atoms that speak of them, as `system` steps it.
    pub fn new<S: System + 's>(states: Vec<usize>, atoms: Vec<usize>, system: S) -> Self {
        Component {
            states,
            atoms,
            system: Box::new(system),
        }
    }
}

/// The most parts that are put together, and the most combinations of their patterns.
const MOST_PARTS: usize = 16;
const MOST_COMBINED: usize = 1 << 20;
/// The most cycles of a state that tables tell apart: so many are made without a look at the limits.
const MOST_TOGETHER: usize = 1 << 18;
/// The most cycles that are worth tables.
const MOST_CYCLES: u32 = 1 << 20;

/// A state of a part, as small as can be, since one is looked up for each state and part.
#[derive(Clone, Copy)]
struct Local {
    /// Number of its pattern; [`UNREACHED`] if the part does not reach it by itself.
    pattern: u32,
    /// Where its steps begin.
    steps: u32,
    /// Number of its marks, the first ones being no marks.
    marks: u32,
}

const UNREACHED: u32 = u32::MAX;

/// What a state of a part means for the properties.
#[derive(Default, PartialEq)]
struct Marks {
    first: Vec<usize>,
    bad: Vec<usize>,
    met: Vec<usize>,
    /// For each group of its cycles the properties that a cycle leaves pending.
    pending: Vec<Vec<usize>>,
}

/// The table of a part.
struct Table<K> {
    digits: Digits,
    locals: Vec<Local>,
    /// For each group of cycles with the same end what it adds to the index of the state.
    steps: Vec<K>,
    marks: Vec<Marks>,
    /// For each state each rule that fires, and in how many input combinations.
    fired: Vec<Vec<(usize, u64)>>,
}

/// The tables of all parts of a system.
pub(crate) struct Tables<K> {
    parts: Vec<Table<K>>,
    patterns: Vec<Pattern>,
    /// The number of combinations of patterns.
    combined: usize,
    combinations: u128,
    /// Bytes of what the workers have put together.
    held: AtomicU64,
}

/// What one worker has put together from the tables.
pub(crate) struct Joined {
    /// By the number of a combination of patterns: the groups whose cycles agree, one number a part.
    agreeing: Vec<Option<Box<[u32]>>>,
    /// For each part and each of its states how many states of the system it was a part of.
    visits: Vec<Vec<u64>>,
}

/// What a state means for the properties, beside its cycles.
pub(crate) enum Event<K> {
    First(usize),
    Bad(usize),
    Met(usize),
    /// The state after a cycle, with a property that the cycle leaves pending.
    Pending(usize, K),
    To(K),
}

impl<K: Key> Tables<K> {
    /// The tables, if the system falls into parts and they are small enough; a cycle that meets a fault has no place
    /// in a table.
    pub(crate) fn new(
        origin: &impl Origin,
        packer: &Packer<K>,
        properties: &[Property],
        watch: &Watch,
    ) -> Option<Self> {
        let parts = origin.components();
        let number = parts.len();
        if !(2..=MOST_PARTS).contains(&number)
            || properties.iter().any(|p| part_of(&parts, p).is_none())
        {
            return None;
        }
        let mut initial = Vec::new();
        let all = Cursor::new(origin, watch)
            .initial(packer, |key, _| {
                initial.push(key);
                match initial.len() < MOST_CYCLES as usize {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            })
            .ok()?;
        if !all {
            return None;
        }
        let mut rough = Vec::new();
        let mut budget = MOST_CYCLES;
        for (number, part) in parts.iter().enumerate() {
            let own: Vec<usize> = (0..properties.len())
                .filter(|p| part_of(&parts, &properties[*p]) == Some(number))
                .collect();
            let builder = Builder {
                number,
                part,
                packer,
                properties,
                own: &own,
                watch,
            };
            rough.push(builder.build(&initial, &mut budget)?);
        }
        let shared = Shared::new(rough.iter().flat_map(|(_, locals)| locals).flatten())?;
        let mut patterns = Vec::new();
        let mut numbers = HashMap::new();
        let tables: Vec<_> = rough
            .into_iter()
            .map(|rough| Table::new(rough, &shared, &mut patterns, &mut numbers))
            .collect();
        let combined = patterns.len().checked_pow(tables.len() as u32)?;
        let most = |table: &Table<K>| table.groups(&patterns);
        let together = tables.iter().map(most).try_fold(1, usize::checked_mul)?;
        let bytes = together.checked_mul(tables.len() * size_of::<u32>())?;
        let fits = watch.memory().is_none_or(|most| bytes as u64 <= most / 8);
        (combined <= MOST_COMBINED && together <= MOST_TOGETHER && fits).then_some(Tables {
            parts: tables,
            patterns,
            combined,
            combinations: origin.combinations(),
            held: AtomicU64::new(0),
        })
    }

    pub(crate) fn worker(&self) -> Joined {
        Joined {
            agreeing: vec![None; self.combined],
            visits: self.parts.iter().map(|p| vec![0; p.locals.len()]).collect(),
        }
    }

    /// The input combinations of a state.
    pub(crate) fn combinations(&self) -> u128 {
        self.combinations
    }

    /// Bytes of what the workers have put together.
    pub(crate) fn bytes(&self) -> u64 {
        self.held.load(Ordering::Relaxed)
    }

    /// Makes all cycles from a state. False if a part is in a state that it cannot reach by itself, or a limit was reached
    /// while they were put together.
    #[inline]
    pub(crate) fn cycles(
        &self,
        joined: &mut Joined,
        key: K,
        watch: &Watch,
        mut each: impl FnMut(Event<K>),
    ) -> bool {
        let Joined { agreeing, visits } = joined;
        let halves = key.halves();
        let mut places = [0; MOST_PARTS];
        let mut steps: [&[K]; MOST_PARTS] = [&[]; MOST_PARTS];
        let (mut combination, mut marked) = (0, false);
        for (number, table) in self.parts.iter().enumerate() {
            let place = table.digits.number(halves);
            let Some(local) = table.locals.get(place) else {
                return false;
            };
            if local.pattern == UNREACHED {
                return false;
            }
            combination = combination * self.patterns.len() + local.pattern as usize;
            marked |= local.marks != 0;
            places[number] = place;
            steps[number] = &table.steps[local.steps as usize..];
        }
        let entry = &mut agreeing[combination];
        if entry.is_none() {
            let locals = self.parts.iter().zip(places).map(|(t, p)| t.locals[p]);
            let patterns = locals.map(|local| &self.patterns[local.pattern as usize]);
            *entry = agree(patterns, watch).map(Into::into);
            let bytes = entry.as_ref().map_or(0, |groups| size_of_val(&**groups));
            self.held.fetch_add(bytes as u64, Ordering::Relaxed);
        }
        let Some(groups) = entry else {
            return false;
        };
        for (visits, place) in visits.iter_mut().zip(places) {
            visits[place] += 1;
        }
        let parts = self.parts.len();
        for cycle in groups.chunks_exact(parts) {
            each(Event::To(joint(key, &steps, cycle)));
        }
        if !marked {
            return true;
        }
        let marks = self.parts.iter().zip(places);
        let marks = marks.map(|(t, place)| &t.marks[t.locals[place].marks as usize]);
        for own in marks.clone() {
            own.first.iter().for_each(|p| each(Event::First(*p)));
            own.bad.iter().for_each(|p| each(Event::Bad(*p)));
            own.met.iter().for_each(|p| each(Event::Met(*p)));
        }
        if marks.clone().any(|own| !own.pending.is_empty()) {
            for cycle in groups.chunks_exact(parts) {
                let after = joint(key, &steps, cycle);
                for (own, group) in marks.clone().zip(cycle) {
                    for property in own.pending.get(*group as usize).into_iter().flatten() {
                        each(Event::Pending(*property, after));
                    }
                }
            }
        }
        true
    }

    /// Adds to the count of each rule what it fired in the states visited since the last call.
    pub(crate) fn count(&self, joined: &mut Joined, coverage: &mut [u64]) {
        for (table, visits) in self.parts.iter().zip(&mut joined.visits) {
            for (fired, visits) in table.fired.iter().zip(visits) {
                let times = std::mem::take(visits);
                if times == 0 {
                    continue;
                }
                for (rule, weight) in fired {
                    if let Some(count) = coverage.get_mut(*rule) {
                        *count = count.saturating_add(weight.saturating_mul(times));
                    }
                }
            }
        }
    }
}

/// The state after a cycle of which each part makes the step of a group.
#[inline]
fn joint<K: Key>(key: K, steps: &[&[K]; MOST_PARTS], groups: &[u32]) -> K {
    let mut after = key;
    for (steps, group) in steps.iter().zip(groups) {
        after = after.plus(steps[*group as usize]);
    }
    after
}

impl<K: Key> Table<K> {
    /// The most groups of cycles that one of its states has.
    fn groups(&self, patterns: &[Pattern]) -> usize {
        let own = self.locals.iter().map(|local| local.pattern);
        let groups = own.filter_map(|pattern| patterns.get(pattern as usize).map(Vec::len));
        groups.max().unwrap_or(0)
    }

    fn new(
        (digits, locals): RoughTable<K>,
        shared: &Shared,
        patterns: &mut Vec<Pattern>,
        numbers: &mut HashMap<Pattern, u32>,
    ) -> Self {
        let mut table = Table {
            digits,
            locals: Vec::with_capacity(locals.len()),
            steps: Vec::new(),
            marks: vec![Marks::default()],
            fired: Vec::with_capacity(locals.len()),
        };
        for local in locals {
            let Some(local) = local else {
                table.locals.push(Local {
                    pattern: UNREACHED,
                    steps: 0,
                    marks: 0,
                });
                table.fired.push(Vec::new());
                continue;
            };
            let next = patterns.len() as u32;
            let pattern = numbers
                .entry(shared.pattern(&local.reads))
                .or_insert_with_key(|pattern| {
                    patterns.push(pattern.clone());
                    next
                });
            let marks = table.marks.iter().position(|m| *m == local.marks);
            table.locals.push(Local {
                pattern: *pattern,
                steps: table.steps.len() as u32,
                marks: marks.unwrap_or(table.marks.len()) as u32,
            });
            if marks.is_none() {
                table.marks.push(local.marks);
            }
            table.steps.extend(local.steps);
            table.fired.push(local.fired);
        }
        table
    }
}
