//! Places in pixels for ordered layers.

use super::{At, Layers, Layout, Line, Way};

/// Space between two items of a layer.
const BESIDE: f64 = 22.0;
/// Space between two bends.
const BENDS: f64 = 12.0;
/// Space between two layers.
const BELOW: f64 = 30.0;
/// Passes over all layers.
const PASSES: usize = 24;

impl Layers {
    pub(super) fn place(&self, nodes: usize, lines: &[Line], upwards: &[bool]) -> Layout {
        let xs = self.columns();
        let (tops, heights) = self.rows();
        let top = |k: usize| {
            let item = &self.items[k];
            tops[item.layer] + (heights[item.layer] - item.size.1) / 2.0
        };
        let corners = (0..nodes).map(|k| (xs[k] - self.items[k].size.0 / 2.0, top(k)));
        let leaving = self.ports(&xs, true);
        let entering = self.ports(&xs, false);
        let mut ways = Vec::new();
        for (n, chain) in self.chains.iter().enumerate() {
            let mut points = Vec::new();
            let mut words = None;
            for (k, item) in chain.iter().copied().enumerate() {
                let Some(layer) = self.items.get(item).map(|i| i.layer) else {
                    continue;
                };
                if k == 0 {
                    points.push((leaving[n], top(item) + self.items[item].size.1));
                } else if k + 1 == chain.len() {
                    points.push((entering[n], top(item)));
                } else {
                    // Straight past what stands in this layer.
                    points.push((xs[item], tops[layer]));
                    points.push((xs[item], tops[layer] + heights[layer]));
                    if lines[n].words.is_some() && self.items[item].size.1 > 0.0 {
                        words = Some((xs[item], tops[layer] + heights[layer] / 2.0));
                    }
                }
            }
            ways.push(Way {
                points,
                upwards: upwards[n],
                words,
            });
        }
        Layout {
            nodes: corners.collect(),
            ways,
        }
    }

    /// Top and height of each layer.
    fn rows(&self) -> (Vec<f64>, Vec<f64>) {
        let heights: Vec<f64> = self
            .layers
            .iter()
            .map(|l| l.iter().map(|k| self.items[*k].size.1).fold(0.0, f64::max))
            .collect();
        let mut y = 0.0;
        let tops = heights.iter().map(|height| {
            let top = y;
            y += height + BELOW;
            top
        });
        (tops.collect(), heights)
    }

    /// Where each edge leaves its upper node, or enters its lower one: side by side in the order of where it leads.
    fn ports(&self, xs: &[f64], leaving: bool) -> Vec<f64> {
        let mut out = vec![0.0; self.chains.len()];
        let mut of: Vec<Vec<(f64, usize)>> = vec![Vec::new(); self.items.len()];
        for (n, chain) in self.chains.iter().enumerate() {
            let (node, next) = match (chain.as_slice(), leaving) {
                ([node, next, ..], true) | ([.., next, node], false) => (*node, *next),
                _ => continue,
            };
            of[node].push((xs[next], n));
        }
        for (node, edges) in of.iter_mut().enumerate() {
            edges.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (width, count) = (self.items[node].size.0, edges.len() as f64);
            // Few lines meet the node near its middle.
            let used = width * (count - 1.0) / (count + 1.0);
            for (k, (_, n)) in edges.iter().enumerate() {
                let share = if count > 1.0 {
                    k as f64 / (count - 1.0) - 0.5
                } else {
                    0.0
                };
                out[*n] = xs[node] + used * share;
            }
        }
        out
    }

    /// The middle of each item: as near to the middles of its neighbours as the others of its layer let it.
    fn columns(&self) -> Vec<f64> {
        let (above, below) = self.neighbours();
        let mut xs = vec![0.0; self.items.len()];
        for layer in &self.layers {
            for (item, x) in layer.iter().zip(self.offsets(layer)) {
                xs[*item] = x;
            }
        }
        let count = self.layers.len();
        for pass in 0..PASSES {
            let down = pass % 2 == 0;
            for step in 0..count {
                let layer = &self.layers[if down { step } else { count - 1 - step }];
                let wanted: Vec<(f64, f64)> = layer
                    .iter()
                    .map(|item| {
                        let (first, second) = (&above[*item], &below[*item]);
                        let near = first.iter().chain(second);
                        // Long lines should be straight above all.
                        let weight = |n: usize| match (self.items[*item].bend, self.items[n].bend) {
                            (true, true) => 8.0,
                            (false, false) => 2.0,
                            _ => 1.0,
                        };
                        let sum: f64 = near.clone().map(|n| weight(*n)).sum();
                        let mean: f64 = near.map(|n| xs[*n] * weight(*n)).sum();
                        match sum > 0.0 {
                            true => (mean / sum, sum),
                            false => (xs[*item], 0.1),
                        }
                    })
                    .collect();
                for (item, x) in layer.iter().zip(self.apart(layer, &wanted)) {
                    xs[*item] = x;
                }
            }
        }
        xs
    }

    /// The middles of the items of a layer as close together as they may stand.
    fn offsets(&self, layer: &[usize]) -> Vec<f64> {
        let mut out: Vec<f64> = Vec::new();
        for (k, item) in layer.iter().enumerate() {
            let x = match k.checked_sub(1) {
                None => 0.0,
                Some(before) => {
                    let (a, b) = (&self.items[layer[before]], &self.items[*item]);
                    let space = if a.bend && b.bend { BENDS } else { BESIDE };
                    out[before] + (a.size.0 + b.size.0) / 2.0 + space
                }
            };
            out.push(x);
        }
        out
    }

    /// The places nearest to the wanted ones (place, weight) that keep the order and the space between the items: the
    /// least squares, by putting together neighbours that would come too close.
    fn apart(&self, layer: &[usize], wanted: &[(f64, f64)]) -> Vec<f64> {
        let offsets = self.offsets(layer);
        // Blocks of items that touch: (mean of what is wanted without the offsets, weight, number of items).
        let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
        for ((x, weight), offset) in wanted.iter().zip(&offsets) {
            let mut block = (x - offset, *weight, 1);
            while let Some(last) = blocks.last().filter(|last| last.0 > block.0) {
                let weight = last.1 + block.1;
                block = (
                    (last.0 * last.1 + block.0 * block.1) / weight,
                    weight,
                    last.2 + block.2,
                );
                blocks.pop();
            }
            blocks.push(block);
        }
        let places = blocks
            .iter()
            .flat_map(|(x, _, count)| std::iter::repeat_n(*x, *count));
        places.zip(offsets).map(|(x, offset)| x + offset).collect()
    }
}

/// The box that holds everything: its upper left and its lower right corner.
pub(in crate::graph) fn frame(layout: &Layout, sizes: &[At], lines: &[Line]) -> Option<(At, At)> {
    let mut corners: Vec<At> = Vec::new();
    for ((x, y), (width, height)) in layout.nodes.iter().zip(sizes) {
        corners.extend([(*x, *y), (x + width, y + height)]);
    }
    for (way, line) in layout.ways.iter().zip(lines) {
        corners.extend(&way.points);
        if let (Some((x, y)), Some((width, height))) = (way.words, line.words) {
            let (half, tall) = (width / 2.0, height / 2.0);
            corners.extend([(x - half, y - tall), (x + half, y + tall)]);
        }
    }
    let first = *corners.first()?;
    Some(corners.iter().fold((first, first), |(low, high), c| {
        (
            (low.0.min(c.0), low.1.min(c.1)),
            (high.0.max(c.0), high.1.max(c.1)),
        )
    }))
}
