//! Systems whose cycles come about in stages: what a stage makes of a few variables and of what the stages before it have left is
//! found once and looked up from then on. So a state costs its different outcomes instead of its input combinations.
//!
//! What a stage leaves to those after it is a *class*: the values, of inputs too, that still matter. Ways through the stages that
//! agree in their class and in the state so far are one way, with the sum of their input combinations.

mod index;
mod pace;
mod watched;

pub(crate) use pace::Pace;
pub(crate) use watched::{Event, Watched};

use crate::pack::{Key, Packer};
use crate::process::Origin;
use crate::system::{Domain, Fault};
use index::{Index, Merge};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Holds in a cycle in which each of these atoms has the value beside it.
pub type Condition = Vec<(usize, bool)>;

/// The most conditions that are told apart.
pub(crate) const MOST_CONDITIONS: usize = 128;

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
    places: Index,
    known: Vec<Known>,
    /// What each outcome adds to the index of the state after, its class, and in how many of the combinations.
    outcomes: Vec<(K, u32, u64)>,
    fired: Vec<(usize, u64)>,
}

/// What follows from a class and the values of the variables read.
struct Known {
    outcomes: Range<usize>,
    fired: Range<usize>,
    /// The input combinations that have come here and are not counted yet.
    visits: u128,
    fault: bool,
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
    packer: &'a Packer<K>,
    combinations: u128,
    before: Vec<i32>,
    after: Vec<i32>,
    list: Vec<Outcome>,
    ways: Vec<Way<K>>,
    next: Vec<Way<K>>,
    merge: Merge,
    /// The places looked up for this state, with the combinations that came there.
    looked: Vec<(u32, u32, u128)>,
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
        self.looked.clear();
        self.ways.clear();
        self.ways.push(Way {
            key: K::of([0, 0]),
            class: 0,
            weight: self.combinations,
        });
        for stage in 0..self.parts.len() {
            let projection = self.parts[stage].projection(&self.before);
            self.next.clear();
            self.merge.start();
            for at in 0..self.ways.len() {
                let way = self.ways[at];
                let Some(place) = self.place(stage, projection, way.class) else {
                    return false;
                };
                let part = &self.parts[stage];
                let known = &part.known[place as usize];
                self.looked.push((stage as u32, place, way.weight));
                for (own, class, share) in &part.outcomes[known.outcomes.clone()] {
                    let key = way.key.plus(*own);
                    let weight = match *share as u128 == part.combinations {
                        true => way.weight,
                        false => part_of(way.weight, *share, part.combinations),
                    };
                    let hash = key.hash() ^ u64::from(*class).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                    let next = &mut self.next;
                    let same = |at: usize| next[at].key == key && next[at].class == *class;
                    match self.merge.find(hash, next.len(), same) {
                        Some(at) => self.next[at].weight += weight,
                        None => self.next.push(Way {
                            key,
                            class: *class,
                            weight,
                        }),
                    }
                }
            }
            std::mem::swap(&mut self.ways, &mut self.next);
        }
        for (stage, place, weight) in &self.looked {
            let known = &mut self.parts[*stage as usize].known[*place as usize];
            match known.visits.checked_add(*weight) {
                Some(visits) => known.visits = visits,
                None => {
                    // So many do not fit the counts of rules either.
                    known.visits = u128::MAX / self.combinations * self.combinations;
                }
            }
        }
        if std::mem::take(&mut self.grown) {
            self.weigh();
        }
        true
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
        let at = u64::from(projection) << 32 | u64::from(class);
        let fresh = part.known.len() as u32;
        let place = part.places.number(at, fresh);
        if place == fresh {
            self.learn(stage, class);
        }
        (!self.parts[stage].known[place as usize].fault).then_some(place)
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
        part.known.push(Known {
            outcomes: from..part.outcomes.len(),
            fired: fired..part.fired.len(),
            visits: 0,
            fault,
        });
        self.grown = true;
    }

    /// Tells what is held, and forgets all if it is too much.
    fn weigh(&mut self) {
        let bytes = self.stages.bytes() + self.parts.iter().map(Part::bytes).sum::<u64>();
        if bytes > self.most {
            let mut kept = std::mem::take(&mut self.fired);
            self.drain(&mut |rule, count| kept.push((rule, count)));
            self.fired = kept;
            self.parts.iter_mut().for_each(Part::forget);
        }
        let bytes = self.stages.bytes() + self.parts.iter().map(Part::bytes).sum::<u64>();
        self.held
            .fetch_add(bytes.wrapping_sub(self.told), Ordering::Relaxed);
        self.told = bytes;
    }

    fn drain(&mut self, each: &mut dyn FnMut(usize, u64)) {
        for part in &mut self.parts {
            for known in &mut part.known {
                let visits = std::mem::take(&mut known.visits);
                if visits == 0 {
                    continue;
                }
                for (rule, share) in &part.fired[known.fired.clone()] {
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
            places: Index::default(),
            known: Vec::new(),
            outcomes: Vec::new(),
            fired: Vec::new(),
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
            + self.outcomes.capacity() * size_of::<(K, u32, u64)>()
            + self.fired.capacity() * size_of::<(usize, u64)>();
        lists as u64 + self.projections.bytes() + self.places.bytes()
    }

    fn forget(&mut self) {
        self.projections = Index::default();
        self.places = Index::default();
        self.known = Vec::new();
        self.outcomes = Vec::new();
        self.fired = Vec::new();
    }
}
