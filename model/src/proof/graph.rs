//! And-inverter graphs with structural hashing: a function of truth values is made of conjunctions and negations, and each
//! conjunction stands once.

use std::collections::HashMap;
use std::ops::Not;

/// A node of a [`Graph`] or its negation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Lit(u32);

impl Lit {
    /// FALSE.
    pub const FALSE: Lit = Lit(0);
    /// TRUE.
    pub const TRUE: Lit = Lit(1);

    /// A constant.
    pub fn constant(value: bool) -> Lit {
        Lit(u32::from(value))
    }

    /// A node as it is.
    pub fn of(node: usize) -> Lit {
        Lit((node as u32) << 1)
    }

    /// Its node; 0 is that of the constants.
    pub fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether it is a negation.
    pub fn negated(self) -> bool {
        self.0 & 1 == 1
    }

    /// Itself, or its negation where `flip` is set.
    #[must_use]
    pub fn flipped(self, flip: bool) -> Lit {
        Lit(self.0 ^ u32::from(flip))
    }

    /// Its value if it is a constant.
    pub fn known(self) -> Option<bool> {
        (self.node() == 0).then(|| self.negated())
    }

    /// Its number in the AIGER format, where nodes keep their numbers.
    pub(super) fn code(self) -> u32 {
        self.0
    }
}

impl Not for Lit {
    type Output = Lit;

    fn not(self) -> Lit {
        self.flipped(true)
    }
}

/// What a node is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Node {
    /// FALSE; only node 0.
    Constant,
    /// A variable.
    Leaf,
    /// Both hold.
    And(Lit, Lit),
}

/// An and-inverter graph: the parts of a node stand before it.
#[derive(Clone, Debug)]
pub struct Graph {
    nodes: Vec<Node>,
    known: HashMap<(Lit, Lit), Lit>,
}

impl Default for Graph {
    fn default() -> Self {
        Graph {
            nodes: vec![Node::Constant],
            known: HashMap::new(),
        }
    }
}

impl Graph {
    /// Number of nodes, that of the constants included.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Number of conjunctions.
    pub fn ands(&self) -> usize {
        self.known.len()
    }

    /// What a node is.
    pub fn node(&self, node: usize) -> Node {
        self.nodes[node]
    }

    /// A new variable.
    pub fn leaf(&mut self) -> Lit {
        self.nodes.push(Node::Leaf);
        Lit::of(self.nodes.len() - 1)
    }

    /// Both hold.
    pub fn and(&mut self, a: Lit, b: Lit) -> Lit {
        let (a, b) = (a.min(b), a.max(b));
        if a == Lit::FALSE || a == !b {
            return Lit::FALSE;
        }
        if a == Lit::TRUE || a == b {
            return b;
        }
        if let Some(simpler) = self.absorbed(a, b).or_else(|| self.absorbed(b, a)) {
            return simpler;
        }
        if let Some(known) = self.known.get(&(a, b)) {
            return *known;
        }
        self.nodes.push(Node::And(a, b));
        let new = Lit::of(self.nodes.len() - 1);
        self.known.insert((a, b), new);
        new
    }

    /// `a AND b` where the parts of `b` make it simpler.
    fn absorbed(&mut self, a: Lit, b: Lit) -> Option<Lit> {
        let Node::And(c, d) = self.nodes[b.node()] else {
            return None;
        };
        match b.negated() {
            false if a == c || a == d => Some(b),
            false if a == !c || a == !d => Some(Lit::FALSE),
            true if a == !c || a == !d => Some(a),
            true if a == c => Some(self.and(a, !d)),
            true if a == d => Some(self.and(a, !c)),
            _ => None,
        }
    }

    /// One of them holds.
    pub fn or(&mut self, a: Lit, b: Lit) -> Lit {
        !self.and(!a, !b)
    }

    /// They differ.
    pub fn xor(&mut self, a: Lit, b: Lit) -> Lit {
        let one = self.and(a, !b);
        let other = self.and(!a, b);
        self.or(one, other)
    }

    /// They are the same.
    pub fn same(&mut self, a: Lit, b: Lit) -> Lit {
        !self.xor(a, b)
    }

    /// `a` where the condition holds, else `b`.
    pub fn choice(&mut self, condition: Lit, a: Lit, b: Lit) -> Lit {
        if a == b {
            return a;
        }
        let one = self.and(condition, a);
        let other = self.and(!condition, b);
        self.or(one, other)
    }

    /// All hold.
    pub fn all(&mut self, list: impl IntoIterator<Item = Lit>) -> Lit {
        list.into_iter().fold(Lit::TRUE, |a, b| self.and(a, b))
    }

    /// Some hold.
    pub fn any(&mut self, list: impl IntoIterator<Item = Lit>) -> Lit {
        list.into_iter().fold(Lit::FALSE, |a, b| self.or(a, b))
    }

    /// Marks the nodes that these consist of, themselves included.
    pub fn below(&self, roots: impl IntoIterator<Item = Lit>) -> Vec<bool> {
        let mut seen = vec![false; self.nodes.len()];
        self.mark(roots, &mut seen);
        seen
    }

    /// Marks further nodes.
    pub(super) fn mark(&self, roots: impl IntoIterator<Item = Lit>, seen: &mut [bool]) {
        let mut open: Vec<usize> = roots.into_iter().map(Lit::node).collect();
        while let Some(node) = open.pop() {
            if std::mem::replace(&mut seen[node], true) {
                continue;
            }
            if let Node::And(a, b) = self.nodes[node] {
                open.extend([a.node(), b.node()]);
            }
        }
    }

    /// The value of each node, where `leaf` gives those of the variables.
    pub fn values(&self, mut leaf: impl FnMut(usize) -> bool) -> Vec<bool> {
        let mut values = Vec::with_capacity(self.nodes.len());
        for (k, node) in self.nodes.iter().enumerate() {
            let value = match node {
                Node::Constant => false,
                Node::Leaf => leaf(k),
                Node::And(a, b) => value(&values, *a) && value(&values, *b),
            };
            values.push(value);
        }
        values
    }
}

/// The value of a literal, where those of the nodes are known.
pub fn value(values: &[bool], lit: Lit) -> bool {
    values[lit.node()] != lit.negated()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_conjunction_stands_once_and_simple_ones_not_at_all() {
        let mut graph = Graph::default();
        let (a, b) = (graph.leaf(), graph.leaf());
        let both = graph.and(a, b);
        assert_eq!(graph.and(b, a), both);
        assert_eq!(graph.and(a, !a), Lit::FALSE);
        assert_eq!(graph.and(a, both), both);
        assert_eq!(graph.and(!a, both), Lit::FALSE);
        assert_eq!(graph.and(!a, !both), !a);
        let rest = graph.and(a, !both);
        assert_eq!(rest, graph.and(a, !b));
        assert_eq!(graph.or(a, Lit::TRUE), Lit::TRUE);
        assert_eq!(graph.ands(), 2);
    }

    #[test]
    fn operators_have_their_truth_tables() {
        let mut graph = Graph::default();
        let [a, b, c] = [(); 3].map(|()| graph.leaf());
        let (xor, choice) = (graph.xor(a, b), graph.choice(a, b, c));
        let (all, any) = (graph.all([a, b, c]), graph.any([a, b, c]));
        for row in 0..8 {
            let bit = |lit: Lit| row >> (lit.node() - 1) & 1 == 1;
            let values = graph.values(|node| bit(Lit::of(node)));
            assert_eq!(value(&values, xor), bit(a) != bit(b));
            assert_eq!(value(&values, choice), if bit(a) { bit(b) } else { bit(c) });
            assert_eq!(value(&values, all), row == 7);
            assert_eq!(value(&values, any), row != 0);
        }
    }
}
