//! The order of the variables: what is asked together stands together.

use std::collections::HashMap;

use super::super::graph::{Lit, Node};
use super::super::netlist::Problem;

/// Levels: of a latch now, of the same a cycle later the one behind it; of an input. As the latches and inputs of the cone.
pub(super) struct Levels {
    pub(super) latches: Vec<u32>,
    pub(super) inputs: Vec<u32>,
    /// Their places among those of the netlist, and how many these are.
    pub(super) places: (Vec<usize>, Vec<usize>),
    pub(super) of: (usize, usize),
}

impl Levels {
    /// In the order in which the functions of the latches ask for them, depth first: so the bits of numbers that are compared
    /// alternate.
    pub(super) fn new(problem: &Problem) -> Self {
        let graph = problem.graph();
        let mut seen = vec![false; graph.size()];
        let mut order = Vec::new();
        let asked: Vec<Lit> = (problem.cone().map(|latch| latch.next))
            .chain([problem.bad])
            .collect();
        for root in asked
            .into_iter()
            .chain(problem.cone().map(|latch| latch.lit))
        {
            let mut open = vec![root.node()];
            while let Some(node) = open.pop() {
                if std::mem::replace(&mut seen[node], true) {
                    continue;
                }
                match graph.node(node) {
                    Node::And(a, b) => open.extend([b.node(), a.node()]),
                    Node::Leaf => order.push(node),
                    Node::Constant => {}
                }
            }
        }
        let netlist = problem.netlist;
        let mut place = vec![None; graph.size()];
        for (k, latch) in problem.latches.iter().enumerate() {
            place[netlist.latches[*latch].lit.node()] = Some((true, k));
        }
        for (k, input) in problem.inputs.iter().enumerate() {
            place[netlist.inputs[*input].lit.node()] = Some((false, k));
        }
        let mut levels = Levels {
            latches: vec![0; problem.latches.len()],
            inputs: vec![0; problem.inputs.len()],
            places: (problem.latches.clone(), problem.inputs.clone()),
            of: (netlist.latches.len(), netlist.inputs.len()),
        };
        let mut next = 0;
        for node in order {
            match place[node] {
                Some((true, k)) => {
                    levels.latches[k] = next;
                    next += 2;
                }
                Some((false, k)) => {
                    levels.inputs[k] = next;
                    next += 1;
                }
                None => {}
            }
        }
        // An input that only a condition asks for.
        for (k, input) in problem.inputs.iter().enumerate() {
            if !seen[netlist.inputs[*input].lit.node()] {
                levels.inputs[k] = next;
                next += 1;
            }
        }
        levels
    }
    /// Levels by nodes.
    pub(super) fn variables(&self, problem: &Problem) -> HashMap<usize, u32> {
        let latches = problem.cone().map(|latch| latch.lit.node());
        let inputs = problem.inputs.iter();
        let inputs = inputs.map(|k| problem.netlist.inputs[*k].lit.node());
        let levels = self.latches.iter().chain(&self.inputs);
        latches.chain(inputs).zip(levels.copied()).collect()
    }
}
