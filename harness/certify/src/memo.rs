//! What a part of a system does, as a function of the cells it reads: found by the interpreter once, then looked up.
//!
//! The interpreter reads and writes cells through [`Memory`] and sees nothing else that changes. So which cell it reads next, and
//! in the end what it does, follows from the values it has read before. These questions and answers form a decision tree, which
//! grows by a path each time the interpreter is asked.

use std::collections::HashMap;

use stillpoint_lang::eval::Memory;

use crate::cells::Cells;
use crate::later::Later;

/// What a part of a system does, as far as it matters later.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Effect {
    /// The digits it gives to cells.
    pub(crate) writes: Vec<(usize, u32)>,
    /// The inputs it reads.
    inputs: Vec<(usize, u32)>,
    /// Its value, or the site at which it leaves a range.
    pub(crate) result: Result<i64, u32>,
}

impl Effect {
    fn new(
        cells: &Cells,
        path: &[(usize, u32)],
        writes: &[(usize, u32)],
        result: Result<i64, u32>,
        later: Option<&Later>,
    ) -> Self {
        // Named expressions that have a value now are not evaluated again.
        let known = |cell| {
            let has = |(c, digit): &(usize, u32)| *c == cell && *digit > 0;
            writes.iter().chain(path).any(has)
        };
        let matters = later.map_or_else(Vec::new, |later| later.all(known));
        let of = |list: &[(usize, u32)]| {
            let mut of = list.to_vec();
            of.retain(|(cell, _)| matters.get(*cell) == Some(&true));
            of.sort_unstable();
            of
        };
        let mut inputs = of(path);
        inputs.retain(|(cell, _)| cells.layout.input_in(*cell).is_some());
        Self {
            writes: of(writes),
            inputs,
            result,
        }
    }
}

/// The memory in which the interpreter is watched. What it writes is kept apart from the cells.
pub(crate) struct Watched<'a> {
    cells: &'a mut Cells,
    side: usize,
    /// The cells read, in this order, and their digits.
    path: Vec<(usize, u32)>,
    writes: Vec<(usize, u32)>,
}

impl Watched<'_> {
    fn get(&mut self, cell: usize) -> u32 {
        // A cell known already is no further question.
        let known = self.writes.iter().chain(&self.path);
        if let Some((_, digit)) = known.into_iter().find(|(c, _)| *c == cell) {
            return *digit;
        }
        let digit = self.cells.read(self.side, cell);
        self.path.push((cell, digit));
        digit
    }

    fn load(&mut self, cell: usize) -> i32 {
        let digit = self.get(cell);
        self.cells.layout.value(cell, digit)
    }

    fn store(&mut self, cell: usize, value: i32) {
        let digit = self.cells.layout.digit(cell, value);
        match self.writes.iter_mut().find(|(c, _)| *c == cell) {
            Some((_, old)) => *old = digit,
            None => self.writes.push((cell, digit)),
        }
    }
}

impl Memory for Watched<'_> {
    fn before(&mut self, k: usize) -> i32 {
        self.load(self.cells.layout.before(k))
    }

    fn now(&mut self, k: usize) -> i32 {
        self.load(self.cells.layout.now(k))
    }

    fn input(&mut self, k: usize) -> i32 {
        self.load(self.cells.layout.input(k))
    }

    fn named(&mut self, k: usize) -> Option<i32> {
        let cell = self.cells.layout.named(k);
        let digit = self.get(cell);
        (digit > 0).then(|| self.cells.layout.value(cell, digit))
    }

    fn assign(&mut self, k: usize, value: i32) {
        self.store(self.cells.layout.now(k), value);
    }

    fn name(&mut self, k: usize, value: i32) {
        self.store(self.cells.layout.named(k), value);
    }
}

/// No tree grows beyond this number of entries; what finds no place is left to the interpreter each time.
const LARGEST: usize = 1 << 20;

/// A cell with more digits is asked about one digit after the other.
const WIDE: u32 = 64;

/// An entry below this number is the place of a node; above, the rest is the number of an effect.
const EFFECT: u32 = 1 << 31;
const UNKNOWN: u32 = u32::MAX;
/// In a node: it asks about one digit.
const ONE: u32 = 1 << 31;

/// The decision tree of one part of a system.
#[derive(Debug)]
pub(crate) struct Memo {
    /// The entry for the root, then the nodes. A node is the cell to be read, and an entry for each of its digits. If that were too
    /// many, it is the cell with [`ONE`], a digit, the entry for that digit, and the entry for all others: another question about the cell.
    tree: Vec<u32>,
    /// The first one is what found no place, the last time.
    effects: Vec<Effect>,
    numbers: HashMap<Effect, usize>,
}

impl Memo {
    /// Nothing is known.
    pub(crate) fn new() -> Self {
        Self {
            tree: vec![UNKNOWN],
            effects: vec![Effect {
                writes: Vec::new(),
                inputs: Vec::new(),
                result: Ok(0),
            }],
            numbers: HashMap::new(),
        }
    }

    /// What is done on one side: looked up, or else what `run` does, as far as it matters `later`. Equal effects have the same number;
    /// none where it found no place.
    pub(crate) fn effect(
        &mut self,
        cells: &mut Cells,
        side: usize,
        later: Option<&Later>,
        run: impl FnOnce(&mut Watched) -> Result<i64, u32>,
    ) -> (&Effect, Option<usize>) {
        let mut at = 0;
        while self.tree[at] < EFFECT {
            let node = self.tree[at] as usize;
            let digit = cells.read(side, (self.tree[node] & !ONE) as usize);
            at = self.next(node, digit);
        }
        let number = match self.tree[at] {
            UNKNOWN => {
                let mut watched = Watched {
                    cells,
                    side,
                    path: Vec::new(),
                    writes: Vec::new(),
                };
                let result = run(&mut watched);
                let Watched { path, writes, .. } = watched;
                let effect = Effect::new(cells, &path, &writes, result, later);
                self.learn(cells, &path, effect)
            }
            known => (known - EFFECT) as usize,
        };
        (&self.effects[number], Some(number).filter(|n| *n > 0))
    }

    /// The place of the entry for a digit.
    #[inline]
    fn next(&self, node: usize, digit: u32) -> usize {
        match self.tree[node] & ONE {
            0 => node + 1 + digit as usize,
            _ => node + 2 + usize::from(self.tree[node + 1] != digit),
        }
    }

    /// Adds a path to the tree: the number of its effect.
    fn learn(&mut self, cells: &Cells, path: &[(usize, u32)], effect: Effect) -> usize {
        if self.tree.len() + path.len() * (WIDE as usize + 2) > LARGEST {
            self.effects[0] = effect;
            return 0;
        }
        let mut at = 0;
        for (cell, digit) in path {
            let greatest = cells.layout.greatest(*cell);
            loop {
                if self.tree[at] == UNKNOWN {
                    let node = self.tree.len();
                    self.tree[at] = node as u32;
                    if greatest > WIDE {
                        let one = [*cell as u32 | ONE, *digit, UNKNOWN, UNKNOWN];
                        self.tree.extend(one);
                    } else {
                        self.tree.push(*cell as u32);
                        self.tree.resize(node + 2 + greatest as usize, UNKNOWN);
                    }
                }
                let node = self.tree[at] as usize;
                at = self.next(node, *digit);
                if greatest <= WIDE || self.tree[node + 1] == *digit {
                    break;
                }
            }
        }
        let number = match self.numbers.get(&effect) {
            Some(number) => *number,
            None => {
                self.numbers.insert(effect.clone(), self.effects.len());
                self.effects.push(effect);
                self.effects.len() - 1
            }
        };
        self.tree[at] = EFFECT + number as u32;
        number
    }
}
