//! The cycle as a conjunction of parts, and what is reached by it: each variable is left as soon as no further part asks for it.

use super::super::sat::Spent;
use super::store::{Diagrams, Edge, Kept};

/// Nodes of a part, beyond which nothing more is joined to it.
pub(super) const PART: usize = 1500;

/// Parts in the order in which they are joined, each with the variables that are left then.
pub(super) struct Schedule(Vec<(Kept, Kept)>);

/// Joins parts of at most so many nodes, in their order.
pub(super) fn joined(
    diagrams: &mut Diagrams,
    parts: &[Kept],
    most: usize,
) -> Result<Vec<Kept>, Spent> {
    let mut list: Vec<Kept> = Vec::new();
    for part in parts {
        let part = diagrams.get(*part);
        let small = |diagrams: &Diagrams, edge| diagrams.is_within(edge, most);
        let last = list
            .last()
            .filter(|last| small(diagrams, part) && small(diagrams, diagrams.get(**last)));
        if let Some(last) = last {
            let both = diagrams.and(diagrams.get(*last), part)?;
            if small(diagrams, both) {
                diagrams.set(*last, both);
                continue;
            }
        }
        list.push(diagrams.keep(part));
    }
    Ok(list)
}

impl Schedule {
    /// The parts that leave most variables soonest come first.
    pub(super) fn new(
        diagrams: &mut Diagrams,
        parts: &[Kept],
        leaves: &[u32],
    ) -> Result<Self, Spent> {
        let mut open: Vec<(Kept, Vec<u32>)> = (parts.iter())
            .map(|part| {
                let mut support = diagrams.support(diagrams.get(*part));
                support.retain(|level| leaves.contains(level));
                (*part, support)
            })
            .collect();
        let asked = |open: &[(Kept, Vec<u32>)], level: &u32| {
            open.iter().filter(|(_, list)| list.contains(level)).count()
        };
        let free: Vec<u32> = (leaves.iter().copied())
            .filter(|level| asked(&open, level) == 0)
            .collect();
        let mut list = Vec::new();
        let free = diagrams.cube(&free)?;
        list.push((diagrams.keep(Edge::TRUE), diagrams.keep(free)));
        while !open.is_empty() {
            let alone = |list: &[u32]| list.iter().filter(|l| asked(&open, l) == 1).count();
            let best = (0..open.len()).max_by_key(|k| {
                let support = &open[*k].1;
                let left = alone(support);
                // Most that is left, then least that is new, then the first.
                (left, usize::MAX - (support.len() - left), usize::MAX - k)
            });
            let Some(best) = best else { break };
            let left: Vec<u32> = (open[best].1.iter().copied())
                .filter(|level| asked(&open, level) == 1)
                .collect();
            let (part, _) = open.remove(best);
            let cube = diagrams.cube(&left)?;
            list.push((part, diagrams.keep(cube)));
        }
        Ok(Schedule(list))
    }

    /// Joins all parts to a function.
    pub(super) fn apply(
        &self,
        diagrams: &mut Diagrams,
        edge: Edge,
        also: &mut [&mut Edge],
    ) -> Result<Edge, Spent> {
        let mut edge = edge;
        for (part, cube) in &self.0 {
            let (part, cube) = (diagrams.get(*part), diagrams.get(*cube));
            edge = diagrams.and_exists(edge, part, cube)?;
            let mut roots: Vec<&mut Edge> = also.iter_mut().map(|e| &mut **e).collect();
            roots.push(&mut edge);
            diagrams.collect(&mut roots);
        }
        Ok(edge)
    }
}
