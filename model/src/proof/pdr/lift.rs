//! From one state to many: which latches make a cycle go where it goes.

use crate::proof::graph::{Graph, Lit, Node, value};

use super::cube::{Cube, Fixed};

/// Finds the latches that decide about values, by justification: a conjunction that does not hold needs one part that does not.
pub(super) struct Lift {
    /// The nodes of the cone, each after its parts.
    nodes: Vec<usize>,
    /// By node, the latch of the cone.
    latch: Vec<Option<u32>>,
    /// By node, about how many latches its value takes.
    cost: Vec<u32>,
    needed: Vec<bool>,
}

impl Lift {
    pub(super) fn new(graph: &Graph, nodes: &[usize], latches: impl Iterator<Item = Lit>) -> Self {
        let mut latch = vec![None; graph.size()];
        for (k, lit) in latches.enumerate() {
            latch[lit.node()] = Some(k as u32);
        }
        Lift {
            nodes: nodes.to_vec(),
            latch,
            cost: vec![0; graph.size()],
            needed: vec![false; graph.size()],
        }
    }

    /// Latches whose values, with these inputs, are enough for the values of `roots`. `values` has those of the variables, and gets
    /// those of the nodes of the cone.
    pub(super) fn cube(
        &mut self,
        graph: &Graph,
        values: &mut [bool],
        roots: impl Iterator<Item = Lit>,
    ) -> Cube {
        for node in &self.nodes {
            let node = *node;
            self.cost[node] = match graph.node(node) {
                Node::And(a, b) => {
                    let (x, y) = (value(values, a), value(values, b));
                    values[node] = x && y;
                    let (c, d) = (self.cost[a.node()], self.cost[b.node()]);
                    match (x, y) {
                        (true, true) => c.saturating_add(d),
                        (false, false) => c.min(d),
                        (false, true) => c,
                        (true, false) => d,
                    }
                }
                _ => u32::from(self.latch[node].is_some()),
            };
        }
        for root in roots {
            self.needed[root.node()] = true;
        }
        let mut list = Vec::new();
        for node in self.nodes.iter().rev() {
            if !std::mem::take(&mut self.needed[*node]) {
                continue;
            }
            match graph.node(*node) {
                Node::And(a, b) if values[*node] => {
                    self.needed[a.node()] = true;
                    self.needed[b.node()] = true;
                }
                Node::And(a, b) => {
                    let chosen = match (value(values, a), value(values, b)) {
                        (false, true) => a,
                        (true, false) => b,
                        _ if self.needed[a.node()] => a,
                        _ if self.needed[b.node()] => b,
                        _ if self.cost[a.node()] <= self.cost[b.node()] => a,
                        _ => b,
                    };
                    self.needed[chosen.node()] = true;
                }
                _ => {
                    if let Some(latch) = self.latch[*node] {
                        list.push(Fixed::new(latch as usize, values[*node]));
                    }
                }
            }
        }
        Cube::new(list)
    }
}
