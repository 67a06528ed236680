//! Ranks (ranking functions) of the states in which something is awaited, and distances to a goal.

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

/// A cycle under a pending duty: from, to, and the set of fairness conditions that it satisfies.
pub(super) type Edge = (u32, u32, u32);

/// Ranks as the checker wants them (see `stillpoint_certify`): on the components of the graph of the pending cycles, each
/// above all it leads to. `pending` are the states that have a rank; the others get 0.
///
/// # Errors
/// Some run never meets the goal.
pub(super) fn ranks(pending: &[bool], edges: &[Edge], fair: usize) -> Result<Vec<u32>, String> {
    let mut number = vec![u32::MAX; pending.len()];
    let mut graph = DiGraph::<u32, u32>::new();
    for (state, _) in pending.iter().enumerate().filter(|(_, p)| **p) {
        number[state] = graph.add_node(state as u32).index() as u32;
    }
    let node = |state: u32| NodeIndex::new(number[state as usize] as usize);
    for (from, to, label) in edges {
        graph.add_edge(node(*from), node(*to), *label);
    }
    let n = fair.max(1) as u32;
    let mut level = vec![0_u32; graph.node_count()];
    let mut ranks = vec![0; pending.len()];
    // Each component comes after those it leads to.
    for component in kosaraju_scc(&graph) {
        // Until it is known, a level of 0 marks the component itself.
        let leaving = component.iter().flat_map(|node| graph.neighbors(*node));
        let own = 1 + leaving.map(|to| level[to.index()]).max().unwrap_or(0);
        let inside = |edge: &petgraph::graph::EdgeReference<u32>| {
            use petgraph::visit::EdgeRef;
            level[edge.target().index()] == 0
        };
        let inner = component
            .iter()
            .flat_map(|node| graph.edges(*node))
            .filter(inside);
        let labels: Vec<u32> = inner.map(|edge| *edge.weight()).collect();
        let met = labels.iter().fold(0, |met, label| met | label);
        let condition = match labels[..] {
            [] => 0,
            _ => (0..fair as u32)
                .find(|k| met >> k & 1 == 0)
                .ok_or("some run never meets the goal")?,
        };
        let rank = own
            .checked_mul(n)
            .and_then(|rank| rank.checked_add(condition))
            .ok_or("the ranks need more than 32 bits")?;
        for node in &component {
            level[node.index()] = own;
            ranks[graph[*node] as usize] = rank;
        }
    }
    Ok(ranks)
}

/// For each state the least number of cycles to the goal, 0 where there is no way: `direct` states meet it in one cycle.
pub(super) fn distances(direct: &[bool], edges: &[(u32, u32)]) -> Vec<u32> {
    let mut back: Vec<(u32, u32)> = edges.iter().map(|(from, to)| (*to, *from)).collect();
    back.sort_unstable();
    let mut distance = vec![0; direct.len()];
    let mut queue: Vec<u32> = Vec::new();
    for (state, _) in direct.iter().enumerate().filter(|(_, d)| **d) {
        distance[state] = 1;
        queue.push(state as u32);
    }
    let mut next = 0;
    while let Some(state) = queue.get(next).copied() {
        next += 1;
        let first = back.partition_point(|(to, _)| *to < state);
        for (_, from) in back[first..].iter().take_while(|(to, _)| *to == state) {
            if distance[*from as usize] == 0 {
                distance[*from as usize] = distance[state as usize] + 1;
                queue.push(*from);
            }
        }
    }
    distance
}
