//! The cycles of one part from each of its states.

use super::{Component, Marks};
use crate::cursor::{Cursor, Leaf};
use crate::pack::{Key, Packer};
use crate::process::{Any, AnyProcess, beyond};
use crate::property::{Eval, Property};
use crate::watch::Watch;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

/// The most states of a part that are worth a table.
const MOST_STATES: u64 = 1 << 16;

/// The part that a property speaks of: the first one if it speaks of none, no part if it speaks of several.
pub(super) fn part_of(parts: &[Component], property: &Property) -> Option<usize> {
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

/// Variables of a part that stand side by side in an index, and so count as one.
struct Run {
    half: usize,
    stride: u64,
    /// The number of their values together.
    size: u64,
    /// No variable is more significant.
    top: bool,
    /// Their stride in the number of a local state.
    local: u64,
}

/// Numbers the states of a part.
pub(super) struct Digits(Vec<Run>);

impl Digits {
    /// Also gives how many states there are. None if they are too many.
    fn new<K: Key>(part: &Component, packer: &Packer<K>) -> Option<(Self, u64)> {
        let places = part.states.iter().map(|cell| packer.place(*cell));
        let mut places = places.collect::<Option<Vec<_>>>()?;
        places.retain(|place| place.size > 1);
        places.sort_unstable_by_key(|place| (place.half, place.stride));
        let mut runs: Vec<Run> = Vec::new();
        let mut states = 1u64;
        for place in places {
            let local = states;
            states = states
                .checked_mul(place.size)
                .filter(|s| *s <= MOST_STATES)?;
            let below = runs.last_mut().filter(|run| {
                run.half == place.half && run.stride.checked_mul(run.size) == Some(place.stride)
            });
            match below {
                Some(run) => {
                    run.size *= place.size;
                    run.top = place.top;
                }
                None => runs.push(Run {
                    half: place.half,
                    stride: place.stride,
                    size: place.size,
                    top: place.top,
                    local,
                }),
            }
        }
        Some((Digits(runs), states))
    }

    #[inline]
    pub(super) fn number(&self, halves: [u64; 2]) -> usize {
        let mut number = 0;
        for run in &self.0 {
            let above = halves[run.half & 1] / run.stride;
            let own = if run.top { above } else { above % run.size };
            number += own * run.local;
        }
        number as usize
    }
}

/// What one cycle reads: inputs with their sizes and values.
pub(super) type Reads = Vec<(u32, u32, u32)>;

/// A local state before the patterns are known. Its cycles stand in groups with the same end and the same duties.
pub(super) struct Rough<K> {
    /// Number of the part.
    pub(super) part: usize,
    /// What each group adds to the index of the state.
    pub(super) steps: Vec<K>,
    /// For each group the reads of its cycles.
    pub(super) reads: Vec<Vec<Reads>>,
    pub(super) marks: Marks,
    pub(super) fired: Vec<(usize, u64)>,
}

pub(super) type RoughTable<K> = (Digits, Vec<Option<Rough<K>>>);

/// Tabulates a part.
pub(super) struct Builder<'a, K> {
    pub(super) number: usize,
    pub(super) part: &'a Component<'a>,
    pub(super) packer: &'a Packer<K>,
    pub(super) properties: &'a [Property],
    /// The properties that speak of the part.
    pub(super) own: &'a [usize],
    pub(super) watch: &'a Watch,
}

impl<K: Key> Builder<'_, K> {
    /// Every state that the part reaches by itself, the variables of the other parts having their values in the first
    /// of the initial states.
    pub(super) fn build(&self, initial: &[K], budget: &mut u32) -> Option<RoughTable<K>> {
        let (digits, states) = Digits::new(self.part, self.packer)?;
        let mut locals = Vec::new();
        locals.resize_with(states as usize, || None);
        let system = Any::of(&*self.part.system);
        let mut cursor = Cursor::new(&system, self.watch);
        let rest = initial.first()?.minus(self.share(*initial.first()?)?);
        let mut open = Vec::new();
        for key in initial {
            open.push(rest.plus(self.share(*key)?));
        }
        while let Some(key) = open.pop() {
            let place = digits.number(key.halves());
            if locals[place].is_none() {
                let rough = self.local(&mut cursor, key, budget)?;
                open.extend(rough.steps.iter().map(|step| key.plus(*step)));
                locals[place] = Some(rough);
            }
        }
        Some((digits, locals))
    }

    /// What the part contributes to an index.
    fn share(&self, key: K) -> Option<K> {
        self.packer
            .share(&self.part.states, &self.packer.state(key))
    }

    /// The cycles from one state.
    fn local(&self, cursor: &mut Cursor<AnyProcess>, key: K, budget: &mut u32) -> Option<Rough<K>> {
        let before = self.share(key)?;
        let mut groups: BTreeMap<(K, Vec<usize>), Vec<Reads>> = BTreeMap::new();
        let mut marks = [BTreeSet::new(), BTreeSet::new(), BTreeSet::new()];
        let mut coverage = vec![0; self.part.system.rules()];
        let mut sound = true;
        let whole = cursor.leaves(self.packer, key, |process, choices, leaf| {
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
            process.count(weight, &mut coverage);
            let group = groups.entry((after, pending)).or_default();
            group.push(choices.reads().collect());
            match sound && *budget > 0 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        });
        if !whole || !sound || *budget == 0 {
            return None;
        }
        let [first, bad, met] = marks.map(|mark| mark.into_iter().collect());
        let mut rough = Rough {
            part: self.number,
            steps: Vec::new(),
            reads: Vec::new(),
            marks: Marks {
                first,
                bad,
                met,
                pending: Vec::new(),
            },
            fired: coverage
                .into_iter()
                .enumerate()
                .filter(|(_, n)| *n > 0)
                .collect(),
        };
        let mut duties = Vec::new();
        for ((after, pending), cycles) in groups {
            let step = self.share(after)?.minus(before);
            // The step must not change what belongs to another part.
            if after.minus(key) != step {
                return None;
            }
            rough.steps.push(step);
            rough.reads.push(cycles);
            duties.push(pending);
        }
        if duties.iter().any(|own| !own.is_empty()) {
            rough.marks.pending = duties;
        }
        Some(rough)
    }
}
