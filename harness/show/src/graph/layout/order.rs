//! The order of the items of each layer, with few crossings.

use super::Layers;

/// Sweeps down and up.
const SWEEPS: usize = 24;

impl Layers {
    /// Orders each layer by the middles of its neighbours, again and again, and keeps the best.
    pub(super) fn order(&mut self) {
        let (above, below) = self.neighbours();
        let mut best = self.layers.clone();
        let mut least = self.crossings(&below);
        for sweep in 0..SWEEPS {
            let down = sweep % 2 == 0;
            let neighbours = if down { &above } else { &below };
            let count = self.layers.len();
            for step in 1..count {
                let layer = if down { step } else { count - 1 - step };
                let places = self.places();
                let middle = |item: usize| -> f64 {
                    let near = &neighbours[item];
                    if near.is_empty() {
                        return places[item];
                    }
                    near.iter().map(|n| places[*n]).sum::<f64>() / near.len() as f64
                };
                let mut keyed: Vec<(f64, usize)> = self.layers[layer]
                    .iter()
                    .map(|i| (middle(*i), *i))
                    .collect();
                keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
                self.layers[layer] = keyed.into_iter().map(|(_, i)| i).collect();
            }
            let crossings = self.crossings(&below);
            if crossings < least {
                least = crossings;
                best.clone_from(&self.layers);
            }
            if least == 0 {
                break;
            }
        }
        self.layers = best;
    }

    /// The place of each item in its layer, as a share of the layer's length, so that layers can be compared.
    fn places(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.items.len()];
        for layer in &self.layers {
            for (k, item) in layer.iter().enumerate() {
                out[*item] = (k as f64 + 0.5) / layer.len() as f64;
            }
        }
        out
    }

    fn crossings(&self, below: &[Vec<usize>]) -> usize {
        let places = self.places();
        let mut sum = 0;
        for layer in &self.layers {
            let lines: Vec<(usize, f64)> = layer
                .iter()
                .enumerate()
                .flat_map(|(k, item)| below[*item].iter().map(move |to| (k, *to)))
                .map(|(k, to)| (k, places[to]))
                .collect();
            for (n, (from, to)) in lines.iter().enumerate() {
                let later = lines[n + 1..].iter();
                sum += later.filter(|(f, t)| f > from && t < to).count();
            }
        }
        sum
    }
}
