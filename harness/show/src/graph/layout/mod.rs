//! Where nodes and edges lie: in layers from top to bottom, with few crossings and straight lines.
//!
//! The steps are Sugiyama's: turn edges so that no cycle is left, give each node a layer, fill long edges up with bends,
//! order each layer by the middles of its neighbours, then find places. Libraries for this exist, but those that were tried
//! end the program on some graphs.

mod order;
mod place;

pub(super) use place::frame;

/// A point in pixels.
pub(super) type At = (f64, f64);

/// An edge to be laid out, from one node to another.
pub(super) struct Line {
    pub(super) from: usize,
    pub(super) to: usize,
    /// Width and height of the words on it; nothing for none.
    pub(super) words: Option<At>,
}

/// The places of everything.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// Upper left corner of each node.
    pub(super) nodes: Vec<At>,
    /// The way of each edge.
    pub(super) ways: Vec<Way>,
}

/// The way of an edge from top to bottom.
#[derive(Debug)]
pub(super) struct Way {
    /// Where the line passes, vertically each time.
    pub(super) points: Vec<At>,
    /// It enters the upper node.
    pub(super) upwards: bool,
    /// Middle of its words.
    pub(super) words: Option<At>,
}

/// What has a place in a layer: a node, or a bend of an edge.
struct Item {
    layer: usize,
    size: At,
    bend: bool,
}

/// Items in layers, and for each edge the items that it passes from top to bottom.
struct Layers {
    items: Vec<Item>,
    chains: Vec<Vec<usize>>,
    /// The items of each layer from left to right.
    layers: Vec<Vec<usize>>,
}

/// Lays out nodes of these sizes and the edges between them. Edges name nodes that exist and lead to another one.
pub(super) fn lay_out(sizes: &[At], lines: &[Line]) -> Layout {
    let upwards = turned(sizes.len(), lines);
    let ends = |n: usize| match upwards[n] {
        true => (lines[n].to, lines[n].from),
        false => (lines[n].from, lines[n].to),
    };
    // Words need a layer of their own between those of the nodes.
    let edges: Vec<(usize, usize, usize)> = (0..lines.len())
        .map(|n| {
            let (upper, lower) = ends(n);
            (upper, lower, 1 + usize::from(lines[n].words.is_some()))
        })
        .collect();
    let ranks = ranks(sizes.len(), &edges);
    let mut layers = Layers::new(sizes, lines, &edges, &ranks);
    layers.order();
    layers.place(sizes.len(), lines, &upwards)
}

/// Which edges point upwards: those that lead back to where a walk along the edges came from.
fn turned(count: usize, lines: &[Line]) -> Vec<bool> {
    let mut leaving: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (n, line) in lines.iter().enumerate() {
        leaving[line.from].push(n);
    }
    let mut out = vec![false; lines.len()];
    let (mut open, mut done) = (vec![false; count], vec![false; count]);
    for start in 0..count {
        if done[start] || open[start] {
            continue;
        }
        let mut walk = vec![(start, 0)];
        open[start] = true;
        while let Some((node, next)) = walk.last_mut() {
            let Some(n) = leaving[*node].get(*next).copied() else {
                open[*node] = false;
                done[*node] = true;
                walk.pop();
                continue;
            };
            *next += 1;
            let to = lines[n].to;
            if open[to] {
                out[n] = true;
            } else if !done[to] {
                open[to] = true;
                walk.push((to, 0));
            }
        }
    }
    out
}

/// The layer of each node: below all that lead to it, by the length of each edge, and no higher than it need be.
fn ranks(count: usize, edges: &[(usize, usize, usize)]) -> Vec<usize> {
    let mut ranks = vec![0; count];
    // Without cycles the longest way has fewer edges than there are nodes.
    for _ in 0..count {
        let mut moved = false;
        for (upper, lower, length) in edges {
            if ranks[*lower] < ranks[*upper] + length {
                ranks[*lower] = ranks[*upper] + length;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    // What nothing leads to may stand just above what it leads to.
    for node in 0..count {
        if edges.iter().all(|(_, lower, _)| *lower != node) {
            let below = edges.iter().filter(|(upper, ..)| *upper == node);
            let highest = below.map(|(_, lower, length)| ranks[*lower] - length).min();
            ranks[node] = highest.unwrap_or(0);
        }
    }
    ranks
}

impl Layers {
    fn new(sizes: &[At], lines: &[Line], edges: &[(usize, usize, usize)], ranks: &[usize]) -> Self {
        let mut items: Vec<Item> = sizes
            .iter()
            .zip(ranks)
            .map(|(size, layer)| Item {
                layer: *layer,
                size: *size,
                bend: false,
            })
            .collect();
        let mut chains = Vec::new();
        for (line, (upper, lower, _)) in lines.iter().zip(edges) {
            let mut chain = vec![*upper];
            let (first, last) = (ranks[*upper], ranks[*lower]);
            let words_at = (first + last) / 2;
            for layer in first + 1..last {
                let size = line.words.filter(|_| layer == words_at);
                chain.push(items.len());
                items.push(Item {
                    layer,
                    size: size.unwrap_or((2.0, 0.0)),
                    bend: true,
                });
            }
            chain.push(*lower);
            chains.push(chain);
        }
        let count = items.iter().map(|i| i.layer + 1).max().unwrap_or(0);
        let mut layers = vec![Vec::new(); count];
        for (k, item) in items.iter().enumerate() {
            layers[item.layer].push(k);
        }
        Self {
            items,
            chains,
            layers,
        }
    }

    /// Neighbours of each item in the layer above it and in the layer below it.
    fn neighbours(&self) -> (Vec<Vec<usize>>, Vec<Vec<usize>>) {
        let mut above = vec![Vec::new(); self.items.len()];
        let mut below = vec![Vec::new(); self.items.len()];
        for pair in self.chains.iter().flat_map(|c| c.windows(2)) {
            below[pair[0]].push(pair[1]);
            above[pair[1]].push(pair[0]);
        }
        (above, below)
    }
}
