//! Binary decision diagrams: a function of truth values asks its variables one after the other, in the order of their levels; each
//! function stands once, and its negation is the same node.

use std::collections::{HashMap, HashSet};

use super::super::sat::{Budget, Spent};

/// A function: a node or its negation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Edge(u32);

impl Edge {
    pub(super) const FALSE: Edge = Edge(0);
    pub(super) const TRUE: Edge = Edge(1);

    fn new(node: usize, negated: bool) -> Self {
        Edge((node as u32) << 1 | u32::from(negated))
    }

    fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Itself, or its negation where `flip` is set.
    pub(super) fn flipped(self, flip: bool) -> Self {
        Edge(self.0 ^ u32::from(flip))
    }

    fn negated(self) -> bool {
        self.0 & 1 == 1
    }
}

impl std::ops::Not for Edge {
    type Output = Edge;

    fn not(self) -> Edge {
        self.flipped(true)
    }
}

/// A function that outlives a collection: its place among those that are kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Kept(usize);

/// The variable that is asked, and what the function is where it is FALSE and TRUE. `high` is no negation.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Node {
    level: u32,
    low: Edge,
    high: Edge,
}

/// A result that is known.
#[derive(Clone, Copy)]
struct Known {
    key: [u32; 3],
    result: Edge,
}

/// No function and no cube: marks an operation that has no third or second operand.
const NONE: u32 = u32::MAX;
/// A shift upwards and downwards, in the place of the second operand.
const UP: u32 = NONE - 1;
const DOWN: u32 = NONE - 2;

const NOTHING: Known = Known {
    key: [NONE; 3],
    result: Edge::FALSE,
};

/// The level of the constants, below all variables.
const BOTTOM: u32 = u32::MAX;

/// Nodes that there may be at most: with what is known of them about a gigabyte.
const MOST: usize = 40_000_000;
/// Nodes before the first collection, of questions that are no test of it.
pub(super) const FIRST: usize = 1 << 20;
/// Steps between two looks at the clock.
const STEPS: u32 = 1 << 14;

/// All nodes, each after those that it consists of, and what is known of them.
pub(super) struct Diagrams {
    nodes: Vec<Node>,
    /// Places of nodes by their hash; 0 is empty.
    table: Vec<u32>,
    known: Vec<Known>,
    kept: Vec<Edge>,
    /// The number of nodes at which to collect: the least, and the next.
    first: usize,
    collect_at: usize,
    budget: Budget,
    steps: u32,
}

fn hash(key: [u32; 3]) -> usize {
    const MULTIPLIER: u64 = 0x9E37_79B9_7F4A_7C15;
    let mixed = key.iter().fold(0u64, |sum, part| {
        (sum ^ u64::from(*part))
            .wrapping_mul(MULTIPLIER)
            .rotate_left(29)
    });
    (mixed ^ mixed >> 32) as usize
}

impl Diagrams {
    /// Collects from so many nodes on; with 0 whenever it can.
    pub(super) fn new(budget: &Budget, first: usize) -> Self {
        let constant = Node {
            level: BOTTOM,
            low: Edge::FALSE,
            high: Edge::FALSE,
        };
        Diagrams {
            nodes: vec![constant],
            table: vec![0; 1 << 12],
            known: vec![NOTHING; 1 << 16],
            kept: Vec::new(),
            first,
            collect_at: first,
            budget: budget.clone(),
            steps: 0,
        }
    }

    /// Keeps a function over collections.
    pub(super) fn keep(&mut self, edge: Edge) -> Kept {
        self.kept.push(edge);
        Kept(self.kept.len() - 1)
    }

    /// One that is kept.
    pub(super) fn get(&self, kept: Kept) -> Edge {
        self.kept[kept.0]
    }

    /// Keeps another one in its place.
    pub(super) fn set(&mut self, kept: Kept, edge: Edge) {
        self.kept[kept.0] = edge;
    }

    /// Forgets what is kept from this one on.
    pub(super) fn forget(&mut self, first: Kept) {
        self.kept.truncate(first.0);
    }

    /// Another budget from now on, for what is kept.
    pub(super) fn limit(&mut self, budget: &Budget) {
        self.budget = budget.clone();
        self.steps = 0;
        self.collect(&mut []);
    }

    /// A variable.
    pub(super) fn variable(&mut self, level: u32) -> Result<Edge, Spent> {
        self.node(level, Edge::FALSE, Edge::TRUE)
    }

    fn step(&mut self) -> Result<(), Spent> {
        self.steps += 1;
        if self.steps == STEPS {
            self.steps = 0;
            if self.budget.spent() || self.nodes.len() > MOST {
                return Err(Spent);
            }
        }
        Ok(())
    }

    fn node(&mut self, level: u32, low: Edge, high: Edge) -> Result<Edge, Spent> {
        if low == high {
            return Ok(low);
        }
        let flip = high.negated();
        let node = Node {
            level,
            low: low.flipped(flip),
            high: high.flipped(flip),
        };
        let place = match self.find(&node) {
            Ok(place) => place,
            Err(slot) => {
                self.step()?;
                self.nodes.push(node);
                let place = self.nodes.len() - 1;
                self.table[slot] = place as u32;
                if self.nodes.len() * 2 > self.table.len() {
                    self.index(self.table.len() * 2);
                }
                place
            }
        };
        Ok(Edge::new(place, flip))
    }

    /// The place of a node, or where in the table it belongs.
    fn find(&self, node: &Node) -> Result<usize, usize> {
        let mask = self.table.len() - 1;
        let mut slot = hash([node.level, node.low.0, node.high.0]) & mask;
        loop {
            match self.table[slot] {
                0 => return Err(slot),
                place if self.nodes[place as usize] == *node => return Ok(place as usize),
                _ => slot = (slot + 1) & mask,
            }
        }
    }

    /// Makes the table anew, with so many slots.
    fn index(&mut self, slots: usize) {
        self.table.clear();
        self.table.resize(slots, 0);
        for place in 1..self.nodes.len() {
            if let Err(slot) = self.find(&self.nodes[place]) {
                self.table[slot] = place as u32;
            }
        }
        // As much is worth remembering as there are nodes.
        let remembered = (slots / 2).clamp(1 << 16, 1 << 22);
        self.known.clear();
        self.known.resize(remembered, NOTHING);
    }

    /// Forgets all functions but those that are kept and these, which get new places; only if there are many.
    pub(super) fn collect(&mut self, also: &mut [&mut Edge]) {
        if self.nodes.len() < self.collect_at {
            return;
        }
        let mut used = vec![false; self.nodes.len()];
        used[0] = true;
        for edge in self.kept.iter().chain(also.iter().map(|edge| &**edge)) {
            used[edge.node()] = true;
        }
        for place in (1..self.nodes.len()).rev() {
            if used[place] {
                used[self.nodes[place].low.node()] = true;
                used[self.nodes[place].high.node()] = true;
            }
        }
        let mut moved = vec![0u32; self.nodes.len()];
        let mut next = 1;
        for place in 1..self.nodes.len() {
            if used[place] {
                let new = |edge: Edge| Edge::new(moved[edge.node()] as usize, edge.negated());
                let node = self.nodes[place];
                self.nodes[next] = Node {
                    low: new(node.low),
                    high: new(node.high),
                    ..node
                };
                moved[place] = next as u32;
                next += 1;
            }
        }
        self.nodes.truncate(next);
        let also = also.iter_mut().map(|edge| &mut **edge);
        for edge in self.kept.iter_mut().chain(also) {
            *edge = Edge::new(moved[edge.node()] as usize, edge.negated());
        }
        self.collect_at = match self.first {
            0 => 0,
            first => first.max((next * 2).min(MOST / 8 * 7)),
        };
        self.index((next * 2).next_power_of_two().max(1 << 12));
    }

    fn level(&self, edge: Edge) -> u32 {
        self.nodes[edge.node()].level
    }

    /// What a function is where a variable that is not below its first one is FALSE and TRUE.
    fn parts(&self, edge: Edge, level: u32) -> (Edge, Edge) {
        let node = self.nodes[edge.node()];
        if node.level != level {
            return (edge, edge);
        }
        let flip = edge.negated();
        (node.low.flipped(flip), node.high.flipped(flip))
    }

    fn look(&self, key: [u32; 3]) -> Result<Edge, usize> {
        let slot = hash(key) & (self.known.len() - 1);
        let known = &self.known[slot];
        if known.key == key {
            Ok(known.result)
        } else {
            Err(slot)
        }
    }

    fn remember(&mut self, key: [u32; 3], result: Edge) {
        let slot = hash(key) & (self.known.len() - 1);
        self.known[slot] = Known { key, result };
    }

    /// Both hold.
    pub(super) fn and(&mut self, a: Edge, b: Edge) -> Result<Edge, Spent> {
        let (a, b) = (a.min(b), a.max(b));
        if a == Edge::FALSE || a == !b {
            return Ok(Edge::FALSE);
        }
        if a == Edge::TRUE || a == b {
            return Ok(b);
        }
        let key = [a.0, b.0, NONE];
        if let Ok(result) = self.look(key) {
            return Ok(result);
        }
        self.step()?;
        let level = self.level(a).min(self.level(b));
        let ((a0, a1), (b0, b1)) = (self.parts(a, level), self.parts(b, level));
        let low = self.and(a0, b0)?;
        let high = self.and(a1, b1)?;
        let result = self.node(level, low, high)?;
        self.remember(key, result);
        Ok(result)
    }

    /// One of them holds.
    pub(super) fn or(&mut self, a: Edge, b: Edge) -> Result<Edge, Spent> {
        Ok(!self.and(!a, !b)?)
    }

    /// They are the same.
    pub(super) fn same(&mut self, a: Edge, b: Edge) -> Result<Edge, Spent> {
        let one = self.and(a, !b)?;
        let other = self.and(!a, b)?;
        Ok(!self.or(one, other)?)
    }

    /// Some values of the variables of a cube make both hold.
    pub(super) fn and_exists(&mut self, a: Edge, b: Edge, cube: Edge) -> Result<Edge, Spent> {
        let (a, b) = (a.min(b), a.max(b));
        if a == Edge::FALSE || a == !b {
            return Ok(Edge::FALSE);
        }
        let level = self.level(a).min(self.level(b));
        let mut cube = cube;
        while self.level(cube) < level {
            cube = self.parts(cube, self.level(cube)).1;
        }
        if cube == Edge::TRUE {
            return self.and(a, b);
        }
        let key = [a.0, b.0, cube.0];
        if let Ok(result) = self.look(key) {
            return Ok(result);
        }
        self.step()?;
        let ((a0, a1), (b0, b1)) = (self.parts(a, level), self.parts(b, level));
        let result = if self.level(cube) == level {
            let rest = self.parts(cube, level).1;
            match self.and_exists(a0, b0, rest)? {
                Edge::TRUE => Edge::TRUE,
                low => {
                    let high = self.and_exists(a1, b1, rest)?;
                    self.or(low, high)?
                }
            }
        } else {
            let low = self.and_exists(a0, b0, cube)?;
            let high = self.and_exists(a1, b1, cube)?;
            self.node(level, low, high)?
        };
        self.remember(key, result);
        Ok(result)
    }

    /// All variables of a function one level up or down.
    pub(super) fn shifted(&mut self, edge: Edge, down: bool) -> Result<Edge, Spent> {
        if edge == Edge::FALSE || edge == Edge::TRUE {
            return Ok(edge);
        }
        let (flip, edge) = (edge.negated(), edge.flipped(edge.negated()));
        let key = [edge.0, if down { DOWN } else { UP }, NONE];
        if let Ok(result) = self.look(key) {
            return Ok(result.flipped(flip));
        }
        self.step()?;
        let level = self.level(edge);
        let (low, high) = self.parts(edge, level);
        let low = self.shifted(low, down)?;
        let high = self.shifted(high, down)?;
        let level = if down { level + 1 } else { level - 1 };
        let result = self.node(level, low, high)?;
        self.remember(key, result);
        Ok(result.flipped(flip))
    }

    /// The conjunction of variables.
    pub(super) fn cube(&mut self, levels: &[u32]) -> Result<Edge, Spent> {
        let mut levels = levels.to_vec();
        levels.sort_unstable();
        let mut cube = Edge::TRUE;
        for level in levels.iter().rev() {
            cube = self.node(*level, Edge::FALSE, cube)?;
        }
        Ok(cube)
    }

    /// The variables that a function depends on.
    pub(super) fn support(&self, edge: Edge) -> Vec<u32> {
        let nodes = self.below(edge, usize::MAX).into_iter();
        let mut levels: Vec<u32> = nodes.map(|node| self.nodes[node].level).collect();
        levels.sort_unstable();
        levels.dedup();
        levels
    }

    /// Whether a function has no more nodes than so many.
    pub(super) fn is_within(&self, edge: Edge, most: usize) -> bool {
        self.below(edge, most).len() <= most
    }

    /// The nodes of a function, or one more than so many of them.
    fn below(&self, edge: Edge, most: usize) -> HashSet<usize> {
        let mut seen = HashSet::new();
        let mut open = vec![edge.node()];
        while let Some(node) = open.pop() {
            if node != 0 && seen.len() <= most && seen.insert(node) {
                open.extend([self.nodes[node].low.node(), self.nodes[node].high.node()]);
            }
        }
        seen
    }

    /// Values with which a function holds, of the variables that it asks for them; none of FALSE.
    pub(super) fn example(&self, edge: Edge) -> HashMap<u32, bool> {
        let mut values = HashMap::new();
        let mut edge = edge;
        while edge != Edge::TRUE && edge != Edge::FALSE {
            let level = self.level(edge);
            let (low, high) = self.parts(edge, level);
            values.insert(level, low == Edge::FALSE);
            edge = if low == Edge::FALSE { high } else { low };
        }
        values
    }

    /// How many values of these variables, in rising order, make a function hold that depends on no other one; none if they are more
    /// than 2^128 - 1.
    pub(super) fn count(&self, edge: Edge, levels: &[u32]) -> Option<u128> {
        let below = |level: u32| levels.partition_point(|other| *other < level) as u32;
        let mut known = HashMap::new();
        let all = self.counted(edge, &below, &mut known)?;
        all.checked_mul(1u128.checked_shl(below(self.level(edge)))?)
    }

    /// The same of the variables from its first one on.
    fn counted(
        &self,
        edge: Edge,
        below: &impl Fn(u32) -> u32,
        known: &mut HashMap<Edge, u128>,
    ) -> Option<u128> {
        if edge == Edge::FALSE || edge == Edge::TRUE {
            return Some(u128::from(edge == Edge::TRUE));
        }
        if let Some(count) = known.get(&edge) {
            return Some(*count);
        }
        let level = self.level(edge);
        let (low, high) = self.parts(edge, level);
        let mut sum = 0u128;
        for part in [low, high] {
            if part == Edge::FALSE {
                continue;
            }
            let skipped = below(self.level(part)) - below(level) - 1;
            let count = self.counted(part, below, known)?;
            sum = sum.checked_add(count.checked_mul(1u128.checked_shl(skipped)?)?)?;
        }
        known.insert(edge, sum);
        Some(sum)
    }
}
