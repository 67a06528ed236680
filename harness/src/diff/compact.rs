//! A product whose states are too long for a key: the table's half by number.
//!
//! The cells of a composed table have many more combinations than are ever reached. Those of each channel that are met get a
//! number, as long as the exploration lasts; equal numbers mean equal cells and the other way round, so nothing is lost.

use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use stillpoint_model::{Choices, Domain, Fault, System};

use super::product::{Product, Work};

/// Keys of the explorer have this many bits.
const KEY_BITS: f64 = 128.0;

/// The greatest number; the state after a cycle that needs more is out of its domain, which ends the exploration.
const NUMBERS: i32 = (1 << 24) - 1;

/// Combinations of cells by number.
#[derive(Default)]
struct Numbers {
    cells: Vec<Arc<[i32]>>,
    by_cells: HashMap<Arc<[i32]>, i32>,
}

/// A product with numbers in place of the table's cells.
pub struct Compact<'p, 'a> {
    product: &'p Product<'a>,
    /// The cells that a number stands for, by number's place.
    groups: Vec<Vec<usize>>,
    numbers: Vec<RwLock<Numbers>>,
    /// The cells that stay as they are.
    rest: Vec<usize>,
    domains: Vec<Domain>,
}

/// The work area.
#[derive(Clone)]
pub struct Long {
    work: Work,
    before: Vec<i32>,
    after: Vec<i32>,
    part: Vec<i32>,
}

impl<'p, 'a> Compact<'p, 'a> {
    /// The product with the cells of the table by number, if its states are too long as they are.
    pub fn needed(product: &'p Product<'a>) -> Option<Self> {
        let bits = |domain: &Domain| (domain.size() as f64).log2();
        if product.domains().iter().map(bits).sum::<f64>() < KEY_BITS {
            return None;
        }
        let table = product.table_cells();
        let (second, first): (Vec<usize>, Vec<usize>) =
            (0..table.len()).partition(|k| table[*k].contains("[2]"));
        let mut groups = vec![first, second];
        groups.retain(|group| !group.is_empty());
        let rest: Vec<usize> = (table.len()..product.domains().len()).collect();
        let number = Domain { lo: 0, hi: NUMBERS };
        let mut domains = vec![number; groups.len()];
        domains.extend(rest.iter().map(|k| product.domains()[*k]));
        Some(Self {
            product,
            numbers: groups.iter().map(|_| RwLock::default()).collect(),
            groups,
            rest,
            domains,
        })
    }

    fn expand(&self, short: &[i32], long: &mut [i32]) {
        for ((group, numbers), number) in self.groups.iter().zip(&self.numbers).zip(short) {
            let known = numbers.read().unwrap_or_else(PoisonError::into_inner);
            let cells = usize::try_from(*number)
                .ok()
                .and_then(|k| known.cells.get(k));
            for (cell, value) in group.iter().zip(cells.into_iter().flat_map(|c| c.iter())) {
                long[*cell] = *value;
            }
        }
        for (cell, value) in self.rest.iter().zip(&short[self.groups.len()..]) {
            long[*cell] = *value;
        }
    }

    fn shorten(&self, long: &[i32], part: &mut Vec<i32>, short: &mut [i32]) {
        for (k, (group, numbers)) in self.groups.iter().zip(&self.numbers).enumerate() {
            part.clear();
            part.extend(group.iter().map(|cell| long[*cell]));
            let known = numbers
                .read()
                .unwrap_or_else(PoisonError::into_inner)
                .by_cells
                .get(part.as_slice())
                .copied();
            short[k] = known.unwrap_or_else(|| new(numbers, part));
        }
        for (cell, value) in self.rest.iter().zip(&mut short[self.groups.len()..]) {
            *value = long[*cell];
        }
    }
}

/// The number of a combination that may be new.
fn new(numbers: &RwLock<Numbers>, cells: &[i32]) -> i32 {
    let mut known = numbers.write().unwrap_or_else(PoisonError::into_inner);
    if let Some(number) = known.by_cells.get(cells) {
        return *number;
    }
    let number = i32::try_from(known.cells.len()).unwrap_or(i32::MAX);
    let cells: Arc<[i32]> = cells.into();
    known.cells.push(cells.clone());
    known.by_cells.insert(cells, number);
    number
}

impl System for Compact<'_, '_> {
    type Work = Long;

    fn work(&self) -> Long {
        let cells = self.product.domains().len();
        Long {
            work: self.product.work(),
            before: vec![0; cells],
            after: vec![0; cells],
            part: Vec::new(),
        }
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        self.product.combinations()
    }

    fn initial<C: Choices>(&self, long: &mut Long, choices: &mut C, state: &mut [i32]) {
        self.product
            .initial(&mut long.work, choices, &mut long.after);
        self.shorten(&long.after, &mut long.part, state);
    }

    fn next<C: Choices>(
        &self,
        long: &mut Long,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        self.expand(before, &mut long.before);
        self.product
            .next(&mut long.work, &long.before, choices, &mut long.after)?;
        let out_of = |(cell, domain): (&i32, &Domain)| *cell < domain.lo || *cell > domain.hi;
        if long.after.iter().zip(self.product.domains()).any(out_of) {
            return Err(Fault::OUT_OF_DOMAIN);
        }
        self.shorten(&long.after, &mut long.part, after);
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        long: &mut Long,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        self.product.atom(&mut long.work, atom, choices)
    }

    fn atoms_read(&self) -> bool {
        self.product.atoms_read()
    }
}
