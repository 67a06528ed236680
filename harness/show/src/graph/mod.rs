//! Directed graphs as pictures, such as the control states of a machine.

mod layout;
mod svg;

/// A directed graph.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Graph {
    /// What it shows.
    pub title: String,
    /// Its nodes.
    pub nodes: Vec<Node>,
    /// Its edges.
    pub edges: Vec<Edge>,
}

/// A node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Node {
    /// What stands in it.
    pub label: String,
    /// A remark shown when it is chosen; may be empty.
    pub note: String,
    /// It is reached. The others are drawn pale.
    pub reached: bool,
    /// Runs begin here.
    pub initial: bool,
}

/// An edge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edge {
    /// Number of the node it leaves.
    pub from: usize,
    /// Number of the node it enters.
    pub to: usize,
    /// Why it is taken, each reason a line; may be empty.
    pub labels: Vec<String>,
}

impl Graph {
    /// The edges that enter a node from another one, or leave it for another one.
    pub(crate) fn edges_of(&self, node: usize, entering: bool) -> impl Iterator<Item = &Edge> {
        self.edges.iter().filter(move |e| {
            let here = if entering { e.to } else { e.from };
            here == node && e.from != e.to
        })
    }

    /// The edges that stay in a node.
    pub(crate) fn stays(&self, node: usize) -> impl Iterator<Item = &Edge> {
        self.edges
            .iter()
            .filter(move |e| e.from == node && e.to == node)
    }

    /// What stands in a node, in one line.
    pub(crate) fn name(&self, node: usize) -> String {
        self.nodes
            .get(node)
            .map_or(String::new(), |n| n.label.replace('\n', ", "))
    }
}
