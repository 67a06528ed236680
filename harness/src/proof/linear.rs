//! What a bound over parameters is made of.

use std::collections::BTreeMap;

use stillpoint_lang::ir::{BinaryOp, Node, Space};

/// A bound as a number and multiples of parameters, or about so, where it is not linear.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Linear {
    pub number: i64,
    /// Places of the state variables that stand for the parameters, each with the multiple that the bound has of it.
    pub parameters: BTreeMap<usize, i64>,
}

impl Linear {
    /// That of an expression over parameters.
    pub(super) fn of(bound: &Node) -> Self {
        let mut linear = Linear::default();
        linear.add(bound, 1);
        linear
    }

    fn add(&mut self, node: &Node, times: i64) {
        match node {
            Node::Const(value) => self.number += times * value,
            Node::Binary(BinaryOp::Add, a, b) => {
                self.add(a, times);
                self.add(b, times);
            }
            Node::Binary(BinaryOp::Sub, a, b) => {
                self.add(a, times);
                self.add(b, -times);
            }
            Node::Binary(BinaryOp::Mul, a, b) => match (&**a, &**b) {
                (Node::Const(factor), other) | (other, Node::Const(factor)) => {
                    self.add(other, times * factor);
                }
                _ => self.about(node, times),
            },
            _ => self.about(node, times),
        }
    }

    /// A parameter by itself; what is not linear, such as the longest of several times, has each as often as it stands there.
    fn about(&mut self, node: &Node, times: i64) {
        node.visit(&mut |part| {
            for cell in part.cells(Space::Before) {
                *self.parameters.entry(cell as usize).or_default() += times;
            }
        });
    }
}
