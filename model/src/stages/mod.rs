//! Systems whose cycles come about in stages: what a stage makes of a few variables and of what the stages before it have left is
//! found once and looked up from then on. So a state costs its different outcomes instead of its input combinations.
//!
//! What a stage leaves to those after it is a *class*: the values, of inputs too, that still matter. Ways through the stages that
//! agree in their class and in the state so far are one way, with the sum of their input combinations.

mod index;
mod pace;
mod prefix;
mod watched;

pub(crate) use pace::Pace;
pub(crate) use watched::{Event, Watched};

use crate::pack::{Key, Packer};
use crate::process::Origin;
use crate::system::{Domain, Fault};
use index::{Index, Merge, Places};
use prefix::{Looked, Prefixes};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Holds in a cycle in which each of these atoms has the value beside it.
pub type Condition = Vec<(usize, bool)>;

/// The most conditions that are told apart.
pub(crate) const MOST_CONDITIONS: usize = 128;

/// Of what may be held, the part that prefixes may.
const SHARE_OF_PREFIXES: u64 = 4;

/// One of the outcomes of a stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The values of the stage's variables after the cycle, in the order of [`Stages::writes`].
    pub after: Vec<i32>,
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

    /// Adds the outcomes of a stage to a list: from the values of the variables before the cycle, of which only those that the
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
        list: &mut Vec<Outcome>,
    ) -> Result<(), Fault>;

    /// Which of the conditions hold, one bit for each, in a class that the last stage leaves.
    fn conditions(&self, class: u32) -> u128;

    /// Bytes held.
    fn bytes(&self) -> u64;
}

/// What is known of one stage.
struct Part<K> {
    /// The variables it reads: number, least value, stride in the number of their values together.
    reads: Vec<(usize, i32, u64)>,
    writes: Vec<usize>,
    combinations: u128,
    /// The values of the variables it reads, numbered.
    projections: Index,
    /// By such a number and a class the place of what follows.
    places: Places,
    known: Vec<Known>,
    /// The input combinations that have come to each place and are not counted yet.
    visits: Vec<u128>,
    /// What each outcome adds to the index of the state after, its class, and in how many of the combinations.
    outcomes: Vec<(K, u32, u64)>,
    fired: Vec<(usize, u64)>,
    merges: Merges,
}

/// Whether ways that have become one behind a stage are looked for: where hardly any do, it costs more than it saves. The last stage
/// always does.
#[derive(Clone, Copy, Default)]
struct Merges {
    rare: bool,
    states: u32,
    made: usize,
    left: usize,
}

impl Merges {
    /// The ways made until it is judged anew, the share of them that is worth it, and the states of which one is looked at all the same.
    const JUDGED: usize = 4096;
    const WORTH: usize = 16;
    const SAMPLE: u32 = 64;

    /// Whether this state is looked at.
    #[inline]
    fn begin(&mut self) -> bool {
        self.states = self.states.wrapping_add(1);
        !self.rare || self.states % Self::SAMPLE == 0
    }

    /// What became of the ways.
    fn end(&mut self, made: usize, left: usize) {
        self.made += made;
        self.left += left;
        if self.made >= Self::JUDGED {
            self.rare = (self.made - self.left) * Self::WORTH < self.made;
            (self.made, self.left) = (0, 0);
        }
    }
}

/// What follows from a class and the values of the variables read: ranges of outcomes and of rules. Where there is a fault, no outcome.
#[derive(Clone, Copy)]
struct Known {
    outcomes: (u32, u32),
    fired: (u32, u32),
}

impl Known {
    fn outcomes(self) -> Range<usize> {
        self.outcomes.0 as usize..self.outcomes.1 as usize
    }

    fn fired(self) -> Range<usize> {
        self.fired.0 as usize..self.fired.1 as usize
    }
}

/// A way through some stages: the index of the state so far, the class, the input combinations.
#[derive(Clone, Copy)]
struct Way<K> {
    key: K,
    class: u32,
    weight: u128,
}

/// A work area of one thread.
pub(crate) struct Staged<'a, K> {
    stages: Box<dyn Stages + 'a>,
    parts: Vec<Part<K>>,
    prefixes: Prefixes<K>,
    packer: &'a Packer<K>,
    combinations: u128,
    before: Vec<i32>,
    after: Vec<i32>,
    list: Vec<Outcome>,
    ways: Vec<Way<K>>,
    next: Vec<Way<K>>,
    merge: Merge,
    /// The places looked up for this state, with the combinations that came there.
    looked: Vec<Looked>,
    /// The number of what each of the first stages reads.
    numbers: Vec<u32>,
    marks: Vec<u128>,
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
        let mut parts = Vec::new();
        for stage in 0..stages.number() {
            let part = Part::new(&*stages, stage, domains)?;
            for variable in &part.writes {
                if std::mem::replace(&mut owned[*variable], true) {
                    return None;
                }
            }
            // Products of weights and shares have to fit.
            origin.combinations().checked_mul(part.combinations)?;
            parts.push(part);
        }
        let whole = owned.iter().all(|owned| *owned);
        whole.then(|| Staged {
            prefixes: Prefixes::new(parts.len(), most / SHARE_OF_PREFIXES),
            numbers: Vec::new(),
            stages,
            parts,
            packer,
            combinations: origin.combinations(),
            before: vec![0; domains.len()],
            after: vec![0; domains.len()],
            list: Vec::new(),
            ways: Vec::new(),
            next: Vec::new(),
            merge: Merge::default(),
            looked: Vec::new(),
            marks: Vec::new(),
            fired: Vec::new(),
            held,
            told: 0,
            most,
            grown: false,
        })
    }

    /// Makes all cycles from a state; [`Staged::ends`] has them. False if one of them meets a fault: nothing is known then.
    #[inline]
    pub(crate) fn cycles(&mut self, key: K) -> bool {
        self.packer.unpack(key, &mut self.before);
        let begun = self.begin();
        let from = begun.map_or(0, |(stages, _)| stages);
        let counted = self.looked.len();
        for stage in from..self.parts.len() {
            let projection = match self.numbers.get(stage) {
                Some(number) => *number,
                None => self.parts[stage].projection(&self.before),
            };
            self.next.clear();
            let last = stage + 1 == self.parts.len();
            let merges = self.parts[stage].merges.begin() || last;
            if merges {
                self.merge.start();
            }
            let mut made = 0;
            for at in 0..self.ways.len() {
                let way = self.ways[at];
                let Some(place) = self.place(stage, projection, way.class) else {
                    return false;
                };
                let part = &self.parts[stage];
                let outcomes = &part.outcomes[part.known[place as usize].outcomes()];
                self.looked.push((stage as u32, place, way.weight));
                made += outcomes.len();
                for (own, class, share) in outcomes {
                    let key = way.key.plus(*own);
                    let weight = match *share as u128 == part.combinations {
                        true => way.weight,
                        false => part_of(way.weight, *share, part.combinations),
                    };
                    let class = *class;
                    if merges {
                        let hash =
                            key.hash() ^ u64::from(class).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                        let next = &self.next;
                        let same = |at: usize| next[at].key == key && next[at].class == class;
                        if let Some(at) = self.merge.find(hash, next.len(), same) {
                            self.next[at].weight += weight;
                            continue;
                        }
                    }
                    self.next.push(Way { key, class, weight });
                }
            }
            if merges {
                self.parts[stage].merges.end(made, self.next.len());
            }
            std::mem::swap(&mut self.ways, &mut self.next);
            if self.prefixes.wants(stage + 1) {
                self.grown |= self.prefixes.keep(stage + 1, &self.ways, &self.looked);
            }
        }
        if let Some((_, node)) = begun {
            self.prefixes.visit(node);
        }
        for looked in &self.looked[counted..] {
            visit(&mut self.parts, self.combinations, looked, 1);
        }
        if std::mem::take(&mut self.grown) {
            self.weigh();
        }
        true
    }

    /// Begins behind the longest prefix of this state that is kept, if there is one: its stages and its node, which counts what has been
    /// looked up in it.
    #[inline]
    fn begin(&mut self) -> Option<(usize, u32)> {
        let (parts, before, numbers) = (&mut self.parts, &self.before, &mut self.numbers);
        numbers.clear();
        let kept = self.prefixes.walk(|stage| {
            let number = parts[stage].projection(before);
            numbers.push(number);
            number
        });
        self.looked.clear();
        self.ways.clear();
        let Some((from, node)) = kept else {
            self.ways.push(Way {
                key: K::of([0, 0]),
                class: 0,
                weight: self.combinations,
            });
            return None;
        };
        self.ways.extend_from_slice(self.prefixes.ways(node));
        // A longer one has them too.
        if self.prefixes.wants_more(from) {
            self.looked.extend_from_slice(self.prefixes.looked(node));
        }
        kept
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
        self.ways.iter().map(|way| {
            let marks = marks.get(way.class as usize).copied();
            (way.key, marks.unwrap_or(0))
        })
    }

    /// The input combinations of the cycles just made, added up.
    pub(crate) fn weight(&self) -> u128 {
        let weights = self.ways.iter().map(|way| way.weight);
        weights.fold(0, u128::wrapping_add)
    }

    /// The place of what follows; none for a fault.
    #[inline]
    fn place(&mut self, stage: usize, projection: u32, class: u32) -> Option<u32> {
        let part = &mut self.parts[stage];
        let fresh = part.known.len() as u32;
        let place = part.places.number(projection, class, fresh);
        if place == fresh {
            self.learn(stage, class);
        }
        let (from, to) = self.parts[stage].known[place as usize].outcomes;
        (from < to).then_some(place)
    }

    /// Has a stage make its outcomes, for the next place.
    #[cold]
    fn learn(&mut self, stage: usize, class: u32) {
        self.list.clear();
        let made = self
            .stages
            .outcomes(stage, &self.before, class, &mut self.list);
        let last = stage + 1 == self.parts.len();
        let part = &mut self.parts[stage];
        let (from, fired) = (part.outcomes.len(), part.fired.len());
        let mut fault = made.is_err();
        for outcome in self.list.drain(..) {
            for (variable, value) in part.writes.iter().zip(&outcome.after) {
                self.after[*variable] = *value;
            }
            let Some(own) = self.packer.share(&part.writes, &self.after) else {
                fault = true;
                continue;
            };
            let old = part.outcomes[from..]
                .iter_mut()
                .find(|(k, class, _)| (*k, *class) == (own, outcome.class));
            match old {
                Some((_, _, share)) => *share += outcome.share,
                None => part.outcomes.push((own, outcome.class, outcome.share)),
            }
            if let Some(rule) = outcome.rule {
                let old = part.fired[fired..].iter_mut().find(|(r, _)| *r == rule);
                match old {
                    Some((_, share)) => *share += outcome.share,
                    None => part.fired.push((rule, outcome.share)),
                }
            }
            if last {
                let class = outcome.class as usize;
                if self.marks.len() <= class {
                    self.marks.resize(class + 1, 0);
                }
                self.marks[class] = self.stages.conditions(outcome.class);
            }
        }
        if fault {
            part.outcomes.truncate(from);
        }
        part.known.push(Known {
            outcomes: (from as u32, part.outcomes.len() as u32),
            fired: (fired as u32, part.fired.len() as u32),
        });
        part.visits.push(0);
        self.grown = true;
    }

    /// Tells what is held, and forgets all if it is too much.
    fn weigh(&mut self) {
        if self.bytes() > self.most {
            let mut kept = std::mem::take(&mut self.fired);
            self.drain(&mut |rule, count| kept.push((rule, count)));
            self.fired = kept;
            self.parts.iter_mut().for_each(Part::forget);
            self.prefixes.forget();
        }
        let bytes = self.bytes();
        self.held
            .fetch_add(bytes.wrapping_sub(self.told), Ordering::Relaxed);
        self.told = bytes;
    }

    fn bytes(&self) -> u64 {
        let parts = self.parts.iter().map(Part::bytes);
        self.stages.bytes() + self.prefixes.bytes() + parts.sum::<u64>()
    }

    fn drain(&mut self, each: &mut dyn FnMut(usize, u64)) {
        let (parts, combinations) = (&mut self.parts, self.combinations);
        self.prefixes
            .settle(|looked, states| visit(parts, combinations, looked, states));
        for part in &mut self.parts {
            for (known, visits) in part.known.iter().zip(&mut part.visits) {
                let visits = std::mem::take(visits);
                if visits == 0 {
                    continue;
                }
                for (rule, share) in &part.fired[known.fired()] {
                    let count = rational(visits, *share, part.combinations);
                    each(*rule, u64::try_from(count).unwrap_or(u64::MAX));
                }
            }
        }
    }

    /// Adds to the count of each rule in how many input combinations it fired since the last call.
    pub(crate) fn count(&mut self, coverage: &mut [u64]) {
        let mut add = |rule: usize, count: u64| {
            if let Some(sum) = coverage.get_mut(rule) {
                *sum = sum.saturating_add(count);
            }
        };
        std::mem::take(&mut self.fired)
            .into_iter()
            .for_each(|(rule, count)| add(rule, count));
        self.drain(&mut add);
    }
}

impl<K> Drop for Staged<'_, K> {
    fn drop(&mut self) {
        self.held.fetch_sub(self.told, Ordering::Relaxed);
    }
}

/// Counts the input combinations that have come to a place, from so many states.
#[inline]
fn visit<K>(parts: &mut [Part<K>], combinations: u128, looked: &Looked, states: u64) {
    let (stage, place, weight) = *looked;
    let visits = &mut parts[stage as usize].visits[place as usize];
    let more = weight.checked_mul(u128::from(states));
    let sum = more.and_then(|more| visits.checked_add(more));
    // So many do not fit the counts of rules either.
    *visits = sum.unwrap_or(u128::MAX / combinations * combinations);
}

/// `share` of `whole` parts of a weight, which is a whole number.
#[inline]
fn part_of(weight: u128, share: u64, whole: u128) -> u128 {
    match (u64::try_from(weight), u64::try_from(whole)) {
        (Ok(weight), Ok(whole)) => match weight.checked_mul(share) {
            Some(product) => u128::from(product / whole),
            None => u128::from(weight) * u128::from(share) / u128::from(whole),
        },
        _ => weight * u128::from(share) / whole,
    }
}

/// The same for a sum of weights, which may be so large that the product does not fit.
fn rational(visits: u128, share: u64, whole: u128) -> u128 {
    match visits.checked_mul(u128::from(share)) {
        Some(product) => product / whole,
        None => (visits / whole).saturating_mul(u128::from(share)),
    }
}

impl<K: Key> Part<K> {
    fn new(stages: &dyn Stages, stage: usize, domains: &[Domain]) -> Option<Self> {
        let mut stride = 1u64;
        let mut reads = Vec::new();
        for variable in stages.reads(stage) {
            let domain = domains.get(*variable)?;
            reads.push((*variable, domain.lo, stride));
            stride = stride.checked_mul(domain.size()).filter(|s| *s < 1 << 63)?;
        }
        let writes = stages.writes(stage).to_vec();
        let fits = writes.iter().all(|variable| *variable < domains.len());
        fits.then(|| Part {
            reads,
            writes,
            combinations: u128::from(stages.combinations(stage)),
            projections: Index::default(),
            places: Places::default(),
            known: Vec::new(),
            visits: Vec::new(),
            outcomes: Vec::new(),
            fired: Vec::new(),
            merges: Merges::default(),
        })
    }

    /// The number of the values of the variables that it reads.
    #[inline]
    fn projection(&mut self, before: &[i32]) -> u32 {
        let mut all = 0;
        for (variable, lo, stride) in &self.reads {
            all += u64::from((before[*variable] as u32).wrapping_sub(*lo as u32)) * stride;
        }
        let fresh = self.projections.len();
        self.projections.number(all, fresh)
    }

    fn bytes(&self) -> u64 {
        let lists = self.known.capacity() * size_of::<Known>()
            + self.visits.capacity() * size_of::<u128>()
            + self.outcomes.capacity() * size_of::<(K, u32, u64)>()
            + self.fired.capacity() * size_of::<(usize, u64)>();
        lists as u64 + self.projections.bytes() + self.places.bytes()
    }

    fn forget(&mut self) {
        self.projections = Index::default();
        self.places = Places::default();
        self.known = Vec::new();
        self.visits = Vec::new();
        self.outcomes = Vec::new();
        self.fired = Vec::new();
    }
}
