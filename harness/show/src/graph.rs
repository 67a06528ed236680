//! Directed graphs as pictures, such as the control states of a machine.

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
