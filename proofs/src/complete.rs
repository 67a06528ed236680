//! Whether the enumeration of a draw that is written by hand leaves steps out.
//!
//! The values that it gives to each number are combined anew. Each combination that the constructor accepts and whose state is
//! consistent must be among those that it enumerates; what it leaves out of them it leaves out on purpose or by mistake.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::ControlFlow;

use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::fields::{get, set, walk};

use crate::draw::Case;
use crate::enumeration::{Domain, Odometer, enumerate};
use crate::source::Verdict;
use crate::tries::names;

/// At most so many combinations of a part are all made; of more, so many random ones.
const COMBINATIONS: u64 = 1_000_000;

/// What was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Combinations that are steps, each once.
    pub steps: usize,
    /// Those of them that the draw leaves out.
    pub missed: usize,
    /// One of those: its part, its numbers with their names.
    pub example: String,
}

/// Numbers that are combined as one: those of some names (as in [`crate::tries`]), in a part of the domain (0: in a domain
/// without parts).
pub type Tied<'a> = (u32, &'a str);

/// Combines the values of a draw; those that are tied keep the combinations that it gives them. One answer for each list
/// of tied numbers.
pub fn check<M: Contract>(
    domain: Domain,
    case: impl Fn(&mut Odometer) -> Option<Case<M>>,
    tied: &[Vec<Tied>],
) -> Vec<Found> {
    let each = |found: &mut dyn FnMut(u32, &[i64])| {
        let mut numbers = Vec::new();
        enumerate(domain, 0, |source| {
            if let Some(case) = case(source) {
                read::<M>(&case, &mut numbers);
                found(source.part(), &numbers);
            }
            Verdict::Held
        });
    };
    let paths = paths::<M>();
    let mut all: Vec<Parts> = tied.iter().map(|_| Parts::new()).collect();
    each(&mut |part, numbers| {
        for (parts, tied) in all.iter_mut().zip(tied) {
            let units = parts
                .entry(part)
                .or_insert_with(|| units(&paths, part, tied));
            units.iter_mut().for_each(|unit| unit.meet(numbers));
        }
    });
    let mut found = vec![Found::default(); all.len()];
    // The steps that no draw has made yet, each with the places of the lists that combine it.
    let mut open: HashMap<u64, Vec<usize>> = HashMap::new();
    for (place, (found, parts)) in found.iter_mut().zip(&all).enumerate() {
        combine::<M>(parts, &mut |part, numbers| {
            let of = open.entry(hash(part, numbers)).or_default();
            if of.last() != Some(&place) {
                of.push(place);
                found.steps += 1;
            }
            ControlFlow::Continue(())
        });
    }
    each(&mut |part, numbers| {
        open.remove(&hash(part, numbers));
    });
    for (place, (found, parts)) in found.iter_mut().zip(&all).enumerate() {
        let missed = |of: &Vec<usize>| of.contains(&place);
        found.missed = open.values().filter(|of| missed(of)).count();
        if found.missed == 0 {
            continue;
        }
        combine::<M>(parts, &mut |part, numbers| {
            if !open.get(&hash(part, numbers)).is_some_and(missed) {
                return ControlFlow::Continue(());
            }
            let named = paths.iter().zip(numbers);
            let named: Vec<String> = named
                .map(|(path, number)| format!("{} {number}", path.join(".")))
                .collect();
            found.example = format!("part {part}: {}", named.join(", "));
            ControlFlow::Break(())
        });
    }
    found
}

/// Reads the numbers of a step.
fn read<M: Contract>(&(state, config, inputs): &Case<M>, numbers: &mut Vec<i64>) {
    numbers.clear();
    get(config, |number| numbers.push(number));
    get(state, |number| numbers.push(number));
    get(inputs, |number| numbers.push(number));
}

/// The step with these numbers.
fn write<M: Contract>(numbers: &[i64]) -> Case<M> {
    let mut numbers = numbers.iter().copied();
    let config = set(&mut numbers);
    let state = set(&mut numbers);
    (state, config, set(numbers))
}

type Path = Vec<&'static str>;

/// Where the numbers of a step stand.
fn paths<M: Contract>() -> Vec<Path> {
    let mut paths = Vec::new();
    let mut each = |path: &[&'static str], _| paths.push(path.to_vec());
    walk::<M::Config>("config", &mut each);
    walk::<M::State>("state", &mut each);
    walk::<M::Inputs>("inputs", &mut each);
    paths
}

/// Numbers that are chosen together, with the values that were met.
#[derive(Default)]
struct Unit {
    places: Vec<usize>,
    last: Vec<i64>,
    met: HashSet<Vec<i64>>,
    values: Vec<Vec<i64>>,
}

impl Unit {
    fn meet(&mut self, numbers: &[i64]) {
        let own = || self.places.iter().filter_map(|place| numbers.get(*place));
        if own().eq(&self.last) {
            return;
        }
        self.last = own().copied().collect();
        if self.met.insert(self.last.clone()) {
            self.values.push(self.last.clone());
        }
    }
}

/// The numbers of each part.
type Parts = BTreeMap<u32, Vec<Unit>>;

/// One for each row of names that are tied in the part, and for each other number.
fn units(paths: &[Path], part: u32, tied: &[Tied]) -> Vec<Unit> {
    let tied = tied.iter().filter(|(of, _)| *of == part);
    let mut units: BTreeMap<Result<&str, usize>, Unit> = BTreeMap::new();
    for (place, path) in paths.iter().enumerate() {
        let name = tied
            .clone()
            .find(|(_, all)| all.split(' ').any(|name| names(path, name)));
        let unit = units
            .entry(name.map(|(_, name)| *name).ok_or(place))
            .or_default();
        unit.places.push(place);
    }
    units.into_values().collect()
}

/// Combines the values of each part. Only what is a step counts.
fn combine<M: Contract>(parts: &Parts, step: &mut dyn FnMut(u32, &[i64]) -> ControlFlow<()>) {
    for (part, units) in parts {
        let counts: Vec<u64> = units.iter().map(|unit| unit.values.len() as u64).collect();
        let all = (counts.iter()).try_fold(1, |all: u64, count| all.checked_mul(*count));
        let all = all.filter(|all| *all <= COMBINATIONS);
        let mut random = 0;
        let mut effective = Vec::new();
        let mut numbers = vec![0; units.iter().map(|unit| unit.places.len()).sum()];
        for number in 0..all.unwrap_or(COMBINATIONS) {
            let mut rest = number;
            for (unit, count) in units.iter().zip(&counts) {
                let digit = if all.is_some() {
                    let digit = rest % count;
                    rest /= count;
                    digit
                } else {
                    next(&mut random) % count
                };
                let values = unit.values.get(digit as usize).into_iter().flatten();
                for (place, value) in unit.places.iter().zip(values) {
                    if let Some(number) = numbers.get_mut(*place) {
                        *number = *value;
                    }
                }
            }
            let case = write::<M>(&numbers);
            let (state, config, _) = &case;
            if M::accepted(config) && M::invariant(state, config) {
                // A number of a value that is missing has no effect: it is read as it is after all.
                read::<M>(&case, &mut effective);
                if step(*part, &effective).is_break() {
                    return;
                }
            }
        }
    }
}

/// SplitMix64: the same numbers in every run.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

/// Fx, since every case of an enumeration is hashed.
fn hash(part: u32, numbers: &[i64]) -> u64 {
    numbers.iter().fold(u64::from(part), |hash, number| {
        (hash.rotate_left(5) ^ *number as u64).wrapping_mul(0x517c_c1b7_2722_0a95)
    })
}
