//! Systems whose cycles come about in stages: what a stage makes of a few variables and of what the stages before it have left is
//! found once and looked up from then on. So a state costs its different outcomes instead of its input combinations.
//!
//! What a stage leaves to those after it is a *class*: the values, of inputs too, that still matter. Ways through the stages that
//! agree in their class and in the state so far are one way, with the sum of their input combinations.

mod counting;
mod fusion;
mod group;
mod index;
mod pace;
mod prefix;
mod seen;
mod table;
mod watched;
mod ways;

pub(crate) use pace::{Pace, Trial};
pub(crate) use watched::{Event, Watched, waits};

use crate::pack::{Key, Opened, Packer};
use crate::process::Origin;
use crate::system::{Domain, Fault};
use counting::visit;
use fusion::Fusion;
use group::Group;
use index::Merge;
use prefix::Prefix;
pub(crate) use seen::Burst;
use seen::Seen;
use std::sync::atomic::{AtomicU64, Ordering};
use table::{Count, Follows, Table};
use ways::{Way, follow};

/// Holds in a cycle in which each of these atoms has the value beside it.
pub type Condition = Vec<(usize, bool)>;

/// The most conditions that are told apart.
pub(crate) const MOST_CONDITIONS: usize = 128;

/// One of the outcomes of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome<'o> {
    /// The values of the stage's variables after the cycle, in the order of [`Stages::writes`].
    pub after: &'o [i32],
    /// What it leaves to the next stage.
    pub class: u32,
    /// The rule that fired.
    pub rule: Option<usize>,
    /// In how many of [`Stages::combinations`].
    pub share: u64,
}

/// The cycles of a system in stages, one after the other; a work area of one thread. All stages together are one cycle of the system,
/// with every combination of its inputs. Atoms meet no fault, and no cycle is discarded.
pub trait Stages: Send {
    /// How many stages there are.
    fn number(&self) -> usize;

    /// The variables whose values before the cycle a stage looks at.
    fn reads(&self, stage: usize) -> &[usize];

    /// The variables whose values after the cycle a stage decides. Each variable belongs to one stage.
    fn writes(&self, stage: usize) -> &[usize];

    /// The combinations of the inputs that a stage may read.
    fn combinations(&self, stage: usize) -> u64;

    /// Hands on the outcomes of a stage: from the values of the variables before the cycle, of which only those that the
    /// stage reads are given, and from what the stage before it has left (0 for the first one). The shares are the combinations
    /// of the stage's inputs, also where the class has their values already.
    ///
    /// # Errors
    /// The fault that one of them meets.
    fn outcomes(
        &mut self,
        stage: usize,
        before: &[i32],
        class: u32,
        each: &mut dyn FnMut(Outcome),
    ) -> Result<(), Fault>;

    /// Which of the conditions hold, one bit for each, in a class that the last stage leaves.
    fn conditions(&self, class: u32) -> u128;

    /// Bytes held.
    fn bytes(&self) -> u64;

    /// Forgets what can be found again. Classes keep their numbers.
    fn forget(&mut self);
}

/// Lists of ways, those before a table and those behind it, to be used again.
type Room<K> = (Vec<Way<K>>, Vec<Way<K>>, Merge);

/// A work area of one thread.
pub(crate) struct Staged<'a, K> {
    stages: Box<dyn Stages + 'a>,
    /// What each stage writes.
    writes: Vec<Vec<usize>>,
    /// One for each stage, then those of groups.
    tables: Vec<Table<K>>,
    groups: Vec<Group>,
    fusion: Fusion,
    domains: &'a [Domain],
    packer: &'a Packer<K>,
    combinations: u128,
    opened: Opened,
    after: Vec<i32>,
    /// The one way that comes to the first group.
    first: Vec<Way<K>>,
    /// One for each group; of so many groups they are those of the state looked at.
    prefixes: Vec<Prefix<K>>,
    valid: usize,
    /// By variable the first group that reads it.
    readers: Vec<usize>,
    merge: Merge,
    /// What is needed for ways, for each group that learns within another one.
    inner: Vec<Room<K>>,
    /// The places looked up in the last table for this state.
    places: Vec<u32>,
    marks: Vec<u128>,
    seen: Seen<K>,
    /// Of rules, from what was forgotten since.
    fired: Vec<(usize, u64)>,
    /// What all threads hold, and of it what this one has told.
    held: &'a AtomicU64,
    told: u64,
    most: u64,
    grown: bool,
}

impl<'a, K: Key> Staged<'a, K> {
    /// The stages of a system; none if it has none, or some that do not fit. It holds at most about `most` bytes.
    pub(crate) fn new(
        origin: &'a impl Origin,
        packer: &'a Packer<K>,
        conditions: &[Condition],
        held: &'a AtomicU64,
        most: u64,
    ) -> Option<Self> {
        if conditions.len() > MOST_CONDITIONS {
            return None;
        }
        let stages = origin.stages(conditions)?;
        let domains = origin.domains();
        let mut owned = vec![false; domains.len()];
        let mut tables = Vec::new();
        let mut writes = Vec::new();
        for stage in 0..stages.number() {
            let combinations = u128::from(stages.combinations(stage));
            // Products of weights and shares have to fit.
            origin.combinations().checked_mul(combinations)?;
            let reads = stages.reads(stage).iter().copied();
            let mut table = Table::new(reads, combinations, domains)?;
            table.merges.shift(stage);
            tables.push(table);
            let own = stages.writes(stage).to_vec();
            for variable in &own {
                if std::mem::replace(owned.get_mut(*variable)?, true) {
                    return None;
                }
            }
            writes.push(own);
        }
        let prefixes = tables.iter().map(|_| Prefix::default()).collect();
        let whole = !tables.is_empty() && owned.iter().all(|owned| *owned);
        let mut staged = whole.then(|| Staged {
            groups: (0..tables.len()).map(Group::single).collect(),
            fusion: Fusion::new(tables.len()),
            stages,
            writes,
            tables,
            domains,
            packer,
            combinations: origin.combinations(),
            opened: packer.opened(),
            after: vec![0; domains.len()],
            first: vec![Way::begin(0, origin.combinations())],
            prefixes,
            valid: 0,
            readers: vec![usize::MAX; domains.len()],
            merge: Merge::default(),
            inner: Vec::new(),
            places: Vec::new(),
            marks: Vec::new(),
            seen: Seen::new(most),
            fired: Vec::new(),
            held,
            told: 0,
            most,
            grown: false,
        })?;
        staged.note_readers();
        Some(staged)
    }

    /// Makes all cycles from a state; [`Staged::ends`] has them. False if one of them meets a fault: nothing is known then.
    #[inline]
    pub(crate) fn cycles(&mut self, key: K) -> bool {
        self.begin(key);
        let groups = self.groups.len();
        let made = self.pass(groups);
        if made {
            self.count_state(groups);
        }
        made
    }

    /// Makes all cycles from a state and hands them on in bursts, each with what was noted of it when it was handed on before, if that
    /// is still known; the answer is noted of it. The result is the input combinations, added up; none if one of the cycles meets
    /// a fault: nothing is handed on then.
    #[inline]
    pub(crate) fn bursts(
        &mut self,
        key: K,
        mut each: impl FnMut(Option<u128>, Burst<K>) -> u128,
    ) -> Option<u128> {
        self.begin(key);
        let last = self.groups.len() - 1;
        if !self.pass(last) {
            return None;
        }
        let ways = self.take_ways(last);
        let weight = self.look_up(last, &ways);
        if weight.is_some() {
            let of = &mut self.tables[self.groups[last].table];
            of.traffic.ways += ways.len() as u64;
            for (way, place) in ways.iter().zip(&self.places) {
                visit(of.visits(*place), Some(way.weight), self.combinations);
                let burst = Burst {
                    state: way.key,
                    follows: of.follows(*place),
                    marks: &self.marks,
                };
                let one = burst.is_one();
                let note = match one {
                    true => None,
                    false => self.seen.note(way.key, *place),
                };
                let new = each(note, burst);
                if !one && note != Some(new) {
                    self.seen.add(way.key, *place, new);
                }
            }
            self.count_state(last);
        }
        self.put_back(last, ways);
        weight
    }

    /// Looks up the places of ways in the table of the last group. The input combinations whose shares are there, added up; none if
    /// one of them meets a fault.
    #[inline]
    fn look_up(&mut self, last: usize, ways: &[Way<K>]) -> Option<u128> {
        let table = self.groups[last].table;
        let projection = self.tables[table].projection(&self.opened.state);
        self.places.clear();
        let mut weight = 0u128;
        for way in ways {
            let (place, fresh) = self.tables[table].place(projection, way.class);
            if fresh {
                self.learn(last, way.class);
            }
            let of = &self.tables[table];
            if of.follows(place).is_fault() {
                return None;
            }
            self.places.push(place);
            // Where shares are missing it does not come to all of them.
            if of.adds_up(place) {
                weight = weight.wrapping_add(way.weight);
            }
        }
        Some(weight)
    }

    /// Nothing is made yet of this state.
    #[inline]
    fn begin(&mut self, key: K) {
        if std::mem::take(&mut self.grown) {
            self.weigh();
        }
        if self.fusion.is_due() {
            self.fuse();
        }
        let mut first = self.valid;
        self.packer.open(key, &mut self.opened, |variable| {
            first = first.min(self.readers[variable]);
        });
        self.valid = first;
    }

    /// Goes through the stages of the first groups, as far as their prefixes are those of another state; false if one of the ways
    /// meets a fault.
    #[inline]
    fn pass(&mut self, groups: usize) -> bool {
        self.valid >= groups || self.pass_on(groups)
    }

    fn pass_on(&mut self, groups: usize) -> bool {
        for group in self.valid..self.groups.len() {
            self.settle(group);
        }
        while self.valid < groups {
            if !self.pass_one(self.valid) {
                return false;
            }
            self.valid += 1;
        }
        true
    }

    /// Goes on through the stages of a group.
    fn pass_one(&mut self, group: usize) -> bool {
        let mut own = std::mem::take(&mut self.prefixes[group]);
        own.ways.clear();
        own.looked.clear();
        let ways = self.take_ways(group);
        let made = self.follow_all(group, &ways, &mut own);
        self.put_back(group, ways);
        self.prefixes[group] = own;
        made
    }

    /// Makes what follows from these ways in a group; false if one of them meets a fault.
    fn follow_all(&mut self, group: usize, ways: &[Way<K>], own: &mut Prefix<K>) -> bool {
        let table = self.groups[group].table;
        let projection = self.tables[table].projection(&self.opened.state);
        let merges = self.tables[table].merges.begin() || group + 1 == self.groups.len();
        if merges {
            self.merge.start();
        }
        let mut made = 0;
        for way in ways {
            let (place, fresh) = self.tables[table].place(projection, way.class);
            if fresh {
                self.learn(group, way.class);
            }
            let of = &self.tables[table];
            let follows = of.follows(place);
            made += match follows {
                Follows::One(..) => 1,
                Follows::Of([]) => return false,
                Follows::Of(outcomes) => outcomes.len(),
            };
            own.looked.push((place, way.weight));
            let merge = merges.then_some(&mut self.merge);
            follow(*way, follows, of.whole, &mut own.ways, merge);
        }
        let of = &mut self.tables[table];
        if merges {
            of.merges.end(made, own.ways.len());
        }
        of.traffic.ways += ways.len() as u64;
        true
    }

    /// Counts a state whose cycles are made, in the first groups.
    #[inline]
    fn count_state(&mut self, groups: usize) {
        for prefix in &mut self.prefixes[..groups] {
            prefix.states += 1;
        }
    }

    /// Makes all cycles from a state; none if one of them meets a fault.
    #[inline]
    pub(crate) fn made(&mut self, key: K) -> Option<&Self> {
        self.cycles(key).then_some(&*self)
    }

    /// The states after the cycles just made, each with the conditions that hold in it. A state stands there once for each set of
    /// conditions.
    #[inline]
    pub(crate) fn ends(&self) -> impl ExactSizeIterator<Item = (K, u128)> + '_ {
        let marks = &self.marks;
        let ways = self.prefixes.last().map_or(&[][..], |all| &all.ways);
        ways.iter().map(|way| {
            let marks = marks.get(way.class as usize).copied();
            (way.key, marks.unwrap_or(0))
        })
    }

    /// Makes what follows from a class that comes to a group, for the next place of its table.
    #[cold]
    fn learn(&mut self, group: usize, class: u32) {
        let group = self.groups[group].clone();
        self.learn_of(&group, class);
        self.grown = true;
    }

    /// Has a stage make its outcomes.
    fn learn_stage(&mut self, stage: usize, class: u32) {
        let Staged {
            stages,
            packer,
            opened,
            after,
            ..
        } = self;
        let (table, writes) = (&mut self.tables[stage], &self.writes[stage]);
        let (from, counts) = (table.outcomes.len(), table.counts.len());
        let mut fault = false;
        let made = stages.outcomes(stage, &opened.state, class, &mut |outcome| {
            for (variable, value) in writes.iter().zip(outcome.after) {
                after[*variable] = *value;
            }
            let Some(own) = packer.share(writes, after) else {
                fault = true;
                return;
            };
            let old = table.outcomes[from..]
                .iter_mut()
                .find(|(k, class, _)| (*k, *class) == (own, outcome.class));
            match old {
                Some((_, _, share)) => *share += outcome.share,
                None => table.outcomes.push((own, outcome.class, outcome.share)),
            }
            if let Some(rule) = outcome.rule {
                let old = table.counts[counts..].iter_mut().find_map(|old| match old {
                    Count::Rule(r, share) if *r == rule => Some(share),
                    _ => None,
                });
                match old {
                    Some(share) => *share += outcome.share,
                    None => table.counts.push(Count::Rule(rule, outcome.share)),
                }
            }
        });
        fault |= made.is_err();
        if stage + 1 == self.writes.len() {
            for (_, class, _) in &table.outcomes[from..] {
                let at = *class as usize;
                if self.marks.len() <= at {
                    self.marks.resize(at + 1, 0);
                }
                self.marks[at] = stages.conditions(*class);
            }
        }
        table.learn(from, fault);
    }

    /// Tells what is held, and forgets all but the classes if it is too much.
    fn weigh(&mut self) {
        if self.bytes() > self.most {
            self.forget_prefixes();
            let mut kept = std::mem::take(&mut self.fired);
            self.drain(&mut |rule, count| kept.push((rule, count)));
            self.fired = kept;
            self.tables.iter_mut().for_each(Table::forget);
            self.seen.forget();
            self.stages.forget();
        }
        let bytes = self.bytes();
        self.held
            .fetch_add(bytes.wrapping_sub(self.told), Ordering::Relaxed);
        self.told = bytes;
    }

    fn bytes(&self) -> u64 {
        let tables = self.tables.iter().map(Table::bytes).sum::<u64>();
        let prefixes = self.prefixes.iter().map(Prefix::bytes).sum::<u64>();
        self.stages.bytes() + self.seen.bytes() + tables + prefixes
    }
}

impl<K> Drop for Staged<'_, K> {
    fn drop(&mut self) {
        self.held.fetch_sub(self.told, Ordering::Relaxed);
    }
}
