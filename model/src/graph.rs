//! The explicit graph of a part of the reachable cycles, with its strongly connected components.

use crate::choices::Odometer;
use crate::cursor::{Cursor, Leaf};
use crate::distinct::Distinct;
use crate::model::Model;
use crate::nodes::{Nodes, push};
use crate::pack::Key;
use crate::process::{Any, Origin, Process};
use crate::stages::{Condition, Staged};
use crate::store::PIECE;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Says what a cycle to the given state is.
pub(crate) type Rule<'a, K> = dyn Fn(&mut dyn Process, &mut Odometer, K) -> Mark + Sync + 'a;

/// The same in two forms, for cycles one by one and in stages.
pub(crate) struct Rules<'a, K> {
    pub(crate) rule: &'a Rule<'a, K>,
    /// What a cycle to the given state is in which the conditions hold that the walkers tell of, one bit for each.
    pub(crate) mark: &'a (dyn Fn(u128, K) -> Mark + Sync),
}

/// What a cycle is to a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// An edge with this label.
    Edge(u32),
    /// An edge with this label from the state to itself, in place of one that leads out of the graph.
    Around(u32),
    /// No edge, but a way out of the graph.
    Exit,
    /// Nothing.
    Outside,
}

impl Mark {
    /// Adds what a cycle from one state to another is to the edges; whether it is a way out.
    #[inline]
    fn note<K: Key>(self, from: K, to: K, ends: &mut Distinct<(K, u32)>) -> bool {
        match self {
            Mark::Edge(label) => ends.push((to, label)),
            Mark::Around(label) => ends.push((from, label)),
            Mark::Exit | Mark::Outside => (),
        }
        self == Mark::Exit
    }
}

/// An edge; there is one for each pair (target, label) that some choice vector makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Edge {
    pub(crate) to: u32,
    pub(crate) label: u32,
}

/// A graph closed under a rule. Nodes are numbered in breadth-first order, the seeds first.
#[derive(Debug)]
pub(crate) struct Graph<K> {
    nodes: Nodes<K>,
    first: Vec<usize>,
    edges: Vec<Edge>,
    pub(crate) seeds: u32,
    /// The first node with a way out; no other one is nearer to the seeds.
    exit: Option<u32>,
}

/// Edges found from the nodes of one piece.
struct Piece<K> {
    number: usize,
    degrees: Vec<usize>,
    ends: Vec<(K, u32)>,
    /// The first node with a way out.
    exit: Option<usize>,
}

/// What one thread needs to find a graph.
pub(crate) struct Walker<'m, 'a, K> {
    cursor: Cursor<<Any<'a> as Origin>::Process>,
    staged: Option<Staged<'m, K>>,
    pieces: Vec<Piece<K>>,
}

impl<'m, 'a, K: Key> Walker<'m, 'a, K> {
    /// With the stages of a cycle, if they are the quicker way.
    pub(crate) fn new(model: &Model<'a, Any<'a>, K>, staged: Option<Staged<'m, K>>) -> Self {
        Walker {
            cursor: model.cursor(),
            staged,
            pieces: Vec::new(),
        }
    }

    /// One for each thread; they tell of these conditions which ones hold.
    pub(crate) fn all(model: &'m Model<'a, Any<'a>, K>, conditions: &[Condition]) -> Vec<Self> {
        let threads = 0..model.crew.size();
        let one = |_| Walker::new(model, model.quicker(conditions));
        threads.map(one).collect()
    }
}

impl<K: Key> Graph<K> {
    /// The graph reached from the seeds; none if a limit is reached first, or it takes more than `most` bytes. `held` bytes are in use
    /// elsewhere.
    pub(crate) fn build<'a>(
        model: &Model<'a, Any<'a>, K>,
        seeds: &[K],
        rules: &Rules<K>,
        walkers: &mut [Walker<'_, 'a, K>],
        held: u64,
        most: u64,
    ) -> Option<Self> {
        let mut graph = Graph {
            nodes: Nodes::new(),
            first: vec![0],
            edges: Vec::new(),
            seeds: 0,
            exit: None,
        };
        for key in seeds {
            graph.nodes.add(*key)?;
        }
        graph.seeds = graph.nodes();
        let mut done = 0;
        while done < graph.nodes.keys().len() {
            if model.watch.over(0) || model.watch.too_much(held + graph.bytes()) {
                return None;
            }
            let here = graph.bytes();
            if here > most {
                return None;
            }
            // What the pieces of this block hold, and whether it is too much.
            let (found, broken) = (AtomicU64::new(0), AtomicBool::new(false));
            let before = held + here + model.known();
            let too_much = |own| model.watch.too_much(before + own) || here + own > most;
            let keys = graph.nodes.keys();
            let block = &keys[done..keys.len().min(done + 1024 * PIECE)];
            model
                .crew
                .share(walkers, block.len().div_ceil(PIECE), |walker, number| {
                    let Walker {
                        cursor,
                        staged,
                        pieces,
                    } = walker;
                    if broken.load(Ordering::Relaxed) {
                        return;
                    }
                    let mut piece = Piece {
                        number,
                        degrees: Vec::new(),
                        ends: Vec::new(),
                        exit: None,
                    };
                    let (first, last) = (number * PIECE, block.len().min((number + 1) * PIECE));
                    for (node, key) in (first..).zip(&block[first..last]) {
                        let mut ends = Distinct::new();
                        let mut exits = false;
                        let whole = match staged.as_mut().and_then(|s| s.made(*key)) {
                            Some(staged) => {
                                for (after, marks) in staged.ends() {
                                    let mark = (rules.mark)(marks, after);
                                    exits |= mark.note(*key, after, &mut ends);
                                }
                                let own = found.load(Ordering::Relaxed) + ends.bytes();
                                !too_much(own) && !model.watch.ended()
                            }
                            None => {
                                cursor.leaves(&model.packer, *key, |process, odometer, leaf| {
                                    if let Leaf::To(after) = leaf {
                                        let mark = (rules.rule)(&mut **process, odometer, after);
                                        exits |= mark.note(*key, after, &mut ends);
                                    }
                                    let own = found.load(Ordering::Relaxed) + ends.bytes();
                                    match too_much(own) {
                                        true => ControlFlow::Break(()),
                                        false => ControlFlow::Continue(()),
                                    }
                                })
                            }
                        };
                        if exits {
                            piece.exit = piece.exit.or(Some(done + node));
                        }
                        if !whole {
                            broken.store(true, Ordering::Relaxed);
                            return;
                        }
                        let ends = ends.sorted();
                        let bytes = size_of_val(ends.as_slice()) as u64;
                        found.fetch_add(bytes, Ordering::Relaxed);
                        piece.degrees.push(ends.len());
                        piece.ends.extend(ends);
                    }
                    pieces.push(piece);
                });
            if broken.into_inner() {
                walkers.iter_mut().for_each(|w| w.pieces.clear());
                return None;
            }
            done += block.len();
            let drained = walkers.iter_mut().flat_map(|w| w.pieces.drain(..));
            let mut pieces: Vec<Piece<K>> = drained.collect();
            pieces.sort_unstable_by_key(|piece| piece.number);
            for piece in pieces {
                let exit = piece.exit.and_then(|node| u32::try_from(node).ok());
                graph.exit = graph.exit.or(exit);
                for (key, label) in piece.ends {
                    let to = graph.nodes.add(key)?;
                    push(&mut graph.edges, Edge { to, label });
                }
                for degree in piece.degrees {
                    let end = graph.first.last().copied().unwrap_or(0) + degree;
                    push(&mut graph.first, end);
                }
            }
        }
        // Also the graph that is done counts.
        (!model.watch.too_much(held + graph.bytes()) && graph.bytes() <= most).then_some(graph)
    }

    pub(crate) fn bytes(&self) -> u64 {
        let edges =
            self.edges.capacity() * size_of::<Edge>() + self.first.capacity() * size_of::<usize>();
        self.nodes.bytes() + edges as u64
    }

    /// The number of a state of the graph.
    pub(crate) fn number(&self, key: K) -> Option<u32> {
        self.nodes.number(key)
    }

    pub(crate) fn key(&self, node: u32) -> K {
        self.nodes.keys()[node as usize]
    }

    pub(crate) fn nodes(&self) -> u32 {
        self.nodes.keys().len() as u32
    }

    pub(crate) fn edges(&self, node: u32) -> &[Edge] {
        &self.edges[self.first[node as usize]..self.first[node as usize + 1]]
    }

    /// The least number of edges from a seed to a node with a way out.
    pub(crate) fn nearest_exit(&self) -> Option<u64> {
        let exit = self.exit?;
        let (mut near, mut distance) = (self.seeds, 0);
        let mut from = 0;
        // Nodes have the order of a breadth-first search: those of one distance stand together.
        while exit >= near {
            let next = (from..near)
                .flat_map(|node| self.edges(node))
                .map(|edge| edge.to + 1)
                .max()
                .unwrap_or(near);
            (from, near, distance) = (near, next.max(near + 1), distance + 1);
        }
        Some(distance)
    }

    /// The strongly connected components of the edges that `keep` accepts (Tarjan, without recursion).
    pub(crate) fn components(&self, keep: impl Fn(Edge) -> bool) -> Components {
        const NONE: u32 = u32::MAX;
        let size = self.nodes.keys().len();
        let mut found = Components {
            of: vec![NONE; size],
            order: Vec::with_capacity(size),
            cyclic: Vec::new(),
        };
        let mut index = vec![NONE; size];
        let mut low = vec![0u32; size];
        let mut open: Vec<u32> = Vec::new();
        let mut calls: Vec<(u32, usize)> = Vec::new();
        let mut clock = 0;
        for root in 0..self.nodes() {
            let mut enter = (index[root as usize] == NONE).then_some(root);
            loop {
                if let Some(node) = enter.take() {
                    index[node as usize] = clock;
                    low[node as usize] = clock;
                    clock += 1;
                    open.push(node);
                    calls.push((node, 0));
                }
                let Some((node, position)) = calls.last_mut() else {
                    break;
                };
                let at = *node as usize;
                let Some(edge) = self.edges(*node).get(*position) else {
                    if low[at] == index[at] {
                        found.close(*node, &mut open);
                    }
                    calls.pop();
                    continue;
                };
                let to = edge.to as usize;
                if keep(*edge) && index[to] == NONE {
                    // The same edge is looked at again after its target.
                    enter = Some(edge.to);
                    continue;
                }
                if keep(*edge) && found.of[to] == NONE {
                    low[at] = low[at].min(low[to]);
                }
                *position += 1;
            }
        }
        for node in 0..self.nodes() {
            let component = found.of[node as usize];
            if self
                .edges(node)
                .iter()
                .any(|e| keep(*e) && found.of[e.to as usize] == component)
            {
                found.cyclic[component as usize] = true;
            }
        }
        found
    }
}

/// Strongly connected components. Each component comes after all components that its edges lead to.
#[derive(Debug)]
pub(crate) struct Components {
    /// The component of each node.
    pub(crate) of: Vec<u32>,
    /// The nodes, component by component.
    pub(crate) order: Vec<u32>,
    /// Whether a component has an edge inside.
    pub(crate) cyclic: Vec<bool>,
}

impl Components {
    fn close(&mut self, root: u32, open: &mut Vec<u32>) {
        let component = self.cyclic.len() as u32;
        self.cyclic.push(false);
        while let Some(node) = open.pop() {
            self.of[node as usize] = component;
            self.order.push(node);
            if node == root {
                return;
            }
        }
    }

    /// For each component whether one of its nodes passes, or a node that kept edges lead to.
    pub(crate) fn reaching<K: Key>(
        &self,
        graph: &Graph<K>,
        keep: impl Fn(Edge) -> bool,
        pass: impl Fn(u32) -> bool,
    ) -> Vec<bool> {
        let mut reaching = vec![false; self.cyclic.len()];
        for node in self.order.iter().copied() {
            let component = self.of[node as usize] as usize;
            let further = |e: &Edge| keep(*e) && reaching[self.of[e.to as usize] as usize];
            if pass(node) || graph.edges(node).iter().any(further) {
                reaching[component] = true;
            }
        }
        reaching
    }

    /// For each node the most edges a path from it can have; none if it is unbounded.
    pub(crate) fn heights<K: Key>(&self, graph: &Graph<K>) -> Vec<Option<u32>> {
        let mut heights = vec![None; self.of.len()];
        for node in self.order.iter().copied() {
            if self.cyclic[self.of[node as usize] as usize] {
                continue;
            }
            let mut height = Some(0u32);
            for edge in graph.edges(node) {
                let one = heights[edge.to as usize].map(|h: u32| h + 1);
                height = height.zip(one).map(|(a, b)| a.max(b));
            }
            heights[node as usize] = height;
        }
        heights
    }
}
