//! Systems that fall into parts with nothing in common but inputs, such as axes that no monitor connects: the cycles of
//! each part are tabulated once, and a cycle of the system is put together from the tables.
//!
//! What a cycle of a part reads of the inputs is a *cube*: some inputs with their values, the others free. A cycle of the
//! system is a cycle of each part such that the cubes agree. Which cycles agree depends on the cubes alone; local states
//! with equal cubes share a *pattern*, and what agrees is found once for each combination of patterns.

use crate::cursor::{Cursor, Leaf};
use crate::pack::{Key, Packer};
use crate::process::{Any, Origin, Process, Source, beyond};
use crate::property::{Eval, Property};
use crate::system::{Domain, System};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;

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
/// The most states of a part, and the most cycles tabulated, that are worth a table.
const MOST_STATES: u64 = 1 << 16;
const MOST_CYCLES: u32 = 1 << 20;

/// Some inputs with their values, each in bits of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Cube {
    fixed: u128,
    values: u128,
}

impl Cube {
    fn meet(self, other: Cube) -> Option<Cube> {
        let both = self.fixed & other.fixed;
        ((self.values ^ other.values) & both == 0).then_some(Cube {
            fixed: self.fixed | other.fixed,
            values: self.values | other.values,
        })
    }
}

/// For each group of cycles the cubes of its cycles, over the inputs that other parts read too.
type Pattern = Vec<Vec<Cube>>;

/// The cycles of a part from one of its states, in groups with the same end.
struct Local<K> {
    pattern: u32,
    /// What each group adds to the index of the state.
    steps: Vec<K>,
    /// For each group the properties that a cycle of it leaves pending; whether there are any.
    pending: Vec<Vec<usize>>,
    is_duty: bool,
    first: Vec<usize>,
    bad: Vec<usize>,
    met: Vec<usize>,
    /// Each rule that fires, and in how many input combinations.
    fired: Vec<(usize, u64)>,
}

/// Numbers the states of a part. Of each of its variables: which one, its least value, its stride.
struct Digits(Vec<(usize, i32, usize)>);

impl Digits {
    #[inline]
    fn number(&self, state: &[i32]) -> usize {
        let digit = |(cell, lo, stride): &(usize, i32, usize)| {
            (state[*cell].wrapping_sub(*lo)) as u32 as usize * stride
        };
        self.0.iter().map(digit).sum()
    }
}

/// The table of a part.
struct Table<K> {
    digits: Digits,
    locals: Vec<Option<Local<K>>>,
}

/// The tables of all parts of a system.
pub(crate) struct Tables<K> {
    parts: Vec<Table<K>>,
    patterns: Vec<Pattern>,
    /// The number of combinations of patterns.
    combined: usize,
    combinations: u128,
}

/// What one worker has put together from the tables.
pub(crate) struct Joined {
    state: Vec<i32>,
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
    ) -> Option<Self> {
        let parts = origin.components();
        let domains = origin.domains();
        let number = parts.len();
        if !(2..=MOST_PARTS).contains(&number)
            || properties.iter().any(|p| part_of(&parts, p).is_none())
        {
            return None;
        }
        let mut initial = vec![0; domains.len()];
        Cursor::new(origin)
            .initial(packer, |key, _| {
                packer.unpack(key, &mut initial);
                ControlFlow::Break(())
            })
            .ok()?;
        let mut rough = Vec::new();
        let mut budget = MOST_CYCLES;
        for (number, part) in parts.iter().enumerate() {
            let own: Vec<usize> = (0..properties.len())
                .filter(|p| part_of(&parts, &properties[*p]) == Some(number))
                .collect();
            rough.push(
                Builder {
                    part,
                    domains,
                    packer,
                    properties,
                    own: &own,
                }
                .build(&initial, origin, &mut budget)?,
            );
        }
        let shared = Shared::new(&rough)?;
        let mut patterns: Vec<Pattern> = Vec::new();
        let mut numbers: HashMap<Pattern, u32> = HashMap::new();
        let mut tables = Vec::new();
        for (digits, locals) in rough {
            let locals = locals.into_iter().map(|local| {
                let local = local?;
                let pattern = shared.pattern(&local.reads);
                let next = patterns.len() as u32;
                let number = *numbers.entry(pattern).or_insert_with_key(|pattern| {
                    patterns.push(pattern.clone());
                    next
                });
                Some(Local {
                    pattern: number,
                    ..local.table
                })
            });
            let locals = locals.collect();
            tables.push(Table { digits, locals });
        }
        let combined = patterns.len().checked_pow(tables.len() as u32)?;
        (combined <= MOST_COMBINED).then_some(Tables {
            parts: tables,
            patterns,
            combined,
            combinations: origin.combinations(),
        })
    }

    pub(crate) fn worker(&self) -> Joined {
        Joined {
            state: Vec::new(),
            agreeing: vec![None; self.combined],
            visits: self.parts.iter().map(|p| vec![0; p.locals.len()]).collect(),
        }
    }

    /// The input combinations of a state.
    pub(crate) fn combinations(&self) -> u128 {
        self.combinations
    }

    /// Makes all cycles from a state. False if a part is in a state that it cannot reach by itself.
    #[inline]
    pub(crate) fn cycles(
        &self,
        packer: &Packer<K>,
        joined: &mut Joined,
        key: K,
        mut each: impl FnMut(Event<K>),
    ) -> bool {
        let Joined {
            state,
            agreeing,
            visits,
        } = joined;
        state.resize(packer.variables(), 0);
        packer.unpack(key, state);
        let parts = self.parts.len();
        let mut places = [0; MOST_PARTS];
        let mut combination = 0;
        for (table, place) in self.parts.iter().zip(&mut places) {
            *place = table.digits.number(state);
            let Some(Some(local)) = table.locals.get(*place) else {
                return false;
            };
            combination = combination * self.patterns.len() + local.pattern as usize;
        }
        let mut steps: [&[K]; MOST_PARTS] = [&[]; MOST_PARTS];
        let locals = self.parts.iter().zip(places);
        let locals = locals.filter_map(|(table, place)| table.locals[place].as_ref());
        for (number, local) in locals.clone().enumerate() {
            visits[number][places[number]] += 1;
            steps[number] = &local.steps;
            local.first.iter().for_each(|p| each(Event::First(*p)));
            local.bad.iter().for_each(|p| each(Event::Bad(*p)));
            local.met.iter().for_each(|p| each(Event::Met(*p)));
        }
        let groups = agreeing[combination].get_or_insert_with(|| {
            let patterns: Vec<u32> = locals.clone().map(|local| local.pattern).collect();
            self.agree(&patterns).into()
        });
        for cycle in groups.chunks_exact(parts) {
            let mut after = key;
            for (steps, group) in steps.iter().zip(cycle) {
                after = after.plus(steps[*group as usize]);
            }
            each(Event::To(after));
        }
        if locals.clone().any(|local| local.is_duty) {
            for cycle in groups.chunks_exact(parts) {
                let chosen = || locals.clone().zip(cycle);
                let steps = chosen().map(|(local, group)| local.steps[*group as usize]);
                let after = steps.fold(key, K::plus);
                for (local, group) in chosen() {
                    for property in &local.pending[*group as usize] {
                        each(Event::Pending(*property, after));
                    }
                }
            }
        }
        true
    }

    /// The combinations of groups with cycles that agree.
    fn agree(&self, patterns: &[u32]) -> Vec<u32> {
        let free = Cube {
            fixed: 0,
            values: 0,
        };
        let mut found: Vec<(Vec<u32>, Vec<Cube>)> = vec![(Vec::new(), vec![free])];
        for pattern in patterns {
            let mut next = Vec::new();
            for (groups, cubes) in &found {
                for (group, own) in self.patterns[*pattern as usize].iter().enumerate() {
                    let meets = cubes
                        .iter()
                        .flat_map(|a| own.iter().filter_map(|b| a.meet(*b)));
                    let meets: BTreeSet<Cube> = meets.collect();
                    if !meets.is_empty() {
                        let groups = groups.iter().copied().chain([group as u32]).collect();
                        next.push((groups, meets.into_iter().collect()));
                    }
                }
            }
            found = next;
        }
        found.into_iter().flat_map(|(groups, _)| groups).collect()
    }

    /// Adds to the count of each rule what it fired in the states visited since the last call.
    pub(crate) fn count(&self, joined: &mut Joined, coverage: &mut [u64]) {
        for (table, visits) in self.parts.iter().zip(&mut joined.visits) {
            for (local, visits) in table.locals.iter().zip(visits) {
                let times = std::mem::take(visits);
                if times == 0 {
                    continue;
                }
                for (rule, weight) in local.iter().flat_map(|local| &local.fired) {
                    if let Some(count) = coverage.get_mut(*rule) {
                        *count = count.saturating_add(weight.saturating_mul(times));
                    }
                }
            }
        }
    }
}

/// The part that a property speaks of: the first one if it speaks of none, no part if it speaks of several.
fn part_of(parts: &[Component], property: &Property) -> Option<usize> {
    let mut found = None;
    for atom in property.form.atoms() {
        if let Some(part) = parts.iter().position(|p| p.atoms.contains(&atom)) {
            if found.is_some_and(|other| other != part) {
                return None;
            }
            found = Some(part);
        }
    }
    Some(found.unwrap_or(0))
}

/// What one cycle reads: inputs with their sizes and values.
type Reads = Vec<(u32, u32, u32)>;

/// A local state before the patterns are known.
struct Rough<K> {
    table: Local<K>,
    /// For each group the reads of its cycles.
    reads: Vec<Vec<Reads>>,
}

type RoughTable<K> = (Digits, Vec<Option<Rough<K>>>);

/// Tabulates a part.
struct Builder<'a, K> {
    part: &'a Component<'a>,
    domains: &'a [Domain],
    packer: &'a Packer<K>,
    properties: &'a [Property],
    /// The properties that speak of the part.
    own: &'a [usize],
}

impl<K: Key> Builder<'_, K> {
    /// Every state that the part reaches by itself, the variables of the other parts having their initial values.
    fn build(
        &self,
        initial: &[i32],
        origin: &impl Origin,
        budget: &mut u32,
    ) -> Option<RoughTable<K>> {
        let mut size = 1u64;
        let mut digits = Vec::new();
        for cell in self.part.states.iter().rev() {
            let domain = self.domains.get(*cell)?;
            digits.push((*cell, domain.lo, usize::try_from(size).ok()?));
            size = size.checked_mul(domain.size())?;
            if size > MOST_STATES {
                return None;
            }
        }
        let digits = Digits(digits);
        let mut locals = Vec::new();
        locals.resize_with(size as usize, || None);
        let system = Any::of(&*self.part.system);
        let mut cursor = Cursor::new(&system);
        let mut open = Vec::new();
        Cursor::new(origin)
            .initial(self.packer, |key, _| {
                let mut state = self.packer.state(key);
                for (cell, value) in state.iter_mut().enumerate() {
                    if !self.part.states.contains(&cell) {
                        *value = initial[cell];
                    }
                }
                open.push(state);
                ControlFlow::Continue(())
            })
            .ok()?;
        while let Some(state) = open.pop() {
            let place = digits.number(&state);
            if locals[place].is_some() {
                continue;
            }
            let (rough, ends) = self.local(&mut cursor, &state, budget)?;
            locals[place] = Some(rough);
            open.extend(ends);
        }
        Some((digits, locals))
    }

    /// The cycles from one state, and the states they lead to.
    fn local(
        &self,
        cursor: &mut Cursor<<Any<'_> as Origin>::Process>,
        state: &[i32],
        budget: &mut u32,
    ) -> Option<(Rough<K>, Vec<Vec<i32>>)> {
        let key = self.packer.pack(state)?;
        let before = self.packer.share(&self.part.states, state)?;
        let mut groups: BTreeMap<(K, Vec<usize>), Vec<Reads>> = BTreeMap::new();
        let mut marks = [BTreeSet::new(), BTreeSet::new(), BTreeSet::new()];
        let mut coverage: BTreeMap<usize, u64> = BTreeMap::new();
        let mut sound = true;
        cursor.leaves(self.packer, key, |process, choices, leaf| {
            *budget = budget.saturating_sub(1);
            let Leaf::To(after) = leaf else {
                sound = false;
                return ControlFlow::Break(());
            };
            process.save();
            let mut pending = Vec::new();
            for property in self.own.iter().copied() {
                beyond(process, choices, |process, choices| {
                    let fault = |_| sound = false;
                    let mut eval = Eval {
                        process,
                        choices,
                        fault,
                    };
                    let sign = eval.sign(&self.properties[property].form);
                    let all = [sign.first, sign.bad, sign.met];
                    for (mark, _) in marks.iter_mut().zip(all).filter(|(_, is)| *is) {
                        mark.insert(property);
                    }
                    if sign.pending && pending.last() != Some(&property) {
                        pending.push(property);
                    }
                });
            }
            let weight = u64::try_from(choices.weight()).unwrap_or(u64::MAX);
            process.fired(&mut |rule| {
                let count = coverage.entry(rule).or_insert(0);
                *count = count.saturating_add(weight);
            });
            let group = groups.entry((after, pending)).or_default();
            group.push(choices.reads().collect());
            match sound && *budget > 0 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        });
        if !sound || *budget == 0 {
            return None;
        }
        let [first, bad, met] = marks.map(|mark| mark.into_iter().collect());
        let mut local = Local {
            pattern: 0,
            steps: Vec::new(),
            pending: Vec::new(),
            is_duty: false,
            first,
            bad,
            met,
            fired: coverage.into_iter().collect(),
        };
        let (mut reads, mut ends) = (Vec::new(), Vec::new());
        for ((after, pending), cycles) in groups {
            let end = self.packer.state(after);
            let share = self.packer.share(&self.part.states, &end)?;
            // The step must not change what belongs to another part.
            if after.minus(key) != share.minus(before) {
                return None;
            }
            local.steps.push(share.minus(before));
            local.is_duty |= !pending.is_empty();
            local.pending.push(pending);
            reads.push(cycles);
            ends.push(end);
        }
        let rough = Rough {
            table: local,
            reads,
        };
        Some((rough, ends))
    }
}

/// The bits of the inputs that several parts read.
struct Shared(BTreeMap<u32, (u32, u32)>);

impl Shared {
    /// None if they need more bits than a cube has.
    fn new<K>(parts: &[RoughTable<K>]) -> Option<Self> {
        let mut readers: BTreeMap<u32, (BTreeSet<usize>, u32)> = BTreeMap::new();
        for (number, (_, locals)) in parts.iter().enumerate() {
            let reads = locals.iter().flatten().flat_map(|local| &local.reads);
            for (input, size, _) in reads.flatten().flatten() {
                let (parts, _) = readers.entry(*input).or_insert((BTreeSet::new(), *size));
                parts.insert(number);
            }
        }
        let (mut bits, mut place) = (BTreeMap::new(), 0);
        for (input, (parts, size)) in readers {
            if parts.len() > 1 {
                let width = (32 - size.saturating_sub(1).leading_zeros()).max(1);
                bits.insert(input, (place, width));
                place += width;
            }
        }
        (place <= 128).then_some(Shared(bits))
    }

    fn pattern(&self, groups: &[Vec<Reads>]) -> Pattern {
        let cubes = |cycles: &Vec<Reads>| -> BTreeSet<Cube> {
            cycles.iter().map(|reads| self.cube(reads)).collect()
        };
        groups
            .iter()
            .map(|cycles| cubes(cycles).into_iter().collect())
            .collect()
    }

    fn cube(&self, reads: &Reads) -> Cube {
        let mut cube = Cube {
            fixed: 0,
            values: 0,
        };
        for (input, _, value) in reads {
            if let Some((place, width)) = self.0.get(input) {
                cube.fixed |= ((1u128 << width) - 1) << place;
                cube.values |= u128::from(*value) << place;
            }
        }
        cube
    }
}
