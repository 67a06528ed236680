//! Random runs of table and monitor at full width. A test, not a proof.

use super::product::{Product, Values};

/// SplitMix64: small, and the same numbers on every machine.
pub struct Random(u64);

impl Random {
    /// The sequence of `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `0..n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.draw()) * n as u128) >> 64) as usize
    }
}

/// Cycles of one run before both sides start anew.
pub const RUN: u64 = 400;

/// A run on which the sides part: the initial cells and the inputs of each cycle.
pub struct Divergence {
    /// Both initial states.
    pub start: Vec<i32>,
    /// The inputs of each cycle, the last one being the first that differs.
    pub cycles: Vec<Vec<i32>>,
}

/// A value of the range: of a wide one often an end, or the neighbour of an end.
fn any(values: Values, random: &mut Random) -> i32 {
    let count = values.count();
    let last = count - 1;
    if count <= 16 {
        return values.get(random.draw() % count);
    }
    match random.below(8) {
        0 => values.get(0),
        1 => values.get(1),
        2 => values.get(last - 1),
        3 => values.get(last),
        _ => values.get(random.draw() % count),
    }
}

/// Drives both sides for one run. Inputs keep their value for a while, so that timers expire and sequences complete;
/// how long differs from run to run.
pub fn run(
    product: &Product,
    inputs: usize,
    random: &mut Random,
    length: u64,
) -> Option<Divergence> {
    let start = product.start(&mut |k| {
        let domain = stillpoint_model::System::domains(product)[k];
        domain.lo + random.below(domain.size() as usize) as i32
    });
    // In one run inputs change rarely, in another often.
    let restless = 1 + random.below(16);
    let mut now: Vec<i32> = (0..inputs)
        .map(|k| any(product.values(k), random))
        .collect();
    let favourites = now.clone();
    let mut work = product.new_work();
    let mut cells = start.clone();
    let mut cycles = Vec::new();
    for _ in 0..length {
        for (k, cell) in now.iter_mut().enumerate() {
            if random.below(16) < restless {
                // The favourite value comes often: a run with power-on in every second cycle would see nothing.
                *cell = match random.below(4) {
                    0 => any(product.values(k), random),
                    _ => favourites[k],
                };
            }
        }
        work.set_inputs(&now);
        cycles.push(now.clone());
        if product.step(&mut work, &mut cells).is_err() || !product.agree(&work) {
            return Some(shrink(product, Divergence { start, cycles }));
        }
    }
    None
}

/// The cycle (from 0) in which the sides part, if they do.
fn parts(product: &Product, start: &[i32], cycles: &[Vec<i32>]) -> Option<usize> {
    let mut work = product.new_work();
    let mut cells = start.to_vec();
    for (n, inputs) in cycles.iter().enumerate() {
        work.set_inputs(inputs);
        if product.step(&mut work, &mut cells).is_err() || !product.agree(&work) {
            return Some(n);
        }
    }
    None
}

/// Leaves out cycles and calms inputs as long as the sides still part.
pub fn shrink(product: &Product, found: Divergence) -> Divergence {
    let mut best = found;
    let mut chunk = best.cycles.len();
    while chunk > 0 {
        let mut at = 0;
        while at < best.cycles.len() {
            let mut fewer = best.cycles.clone();
            fewer.drain(at..(at + chunk).min(fewer.len()));
            match parts(product, &best.start, &fewer) {
                Some(n) => {
                    fewer.truncate(n + 1);
                    best.cycles = fewer;
                }
                None => at += chunk,
            }
        }
        chunk /= 2;
    }
    for n in 0..best.cycles.len() {
        for k in 0..best.cycles[n].len() {
            let calm = if n > 0 {
                best.cycles[n - 1][k]
            } else {
                product.values(k).get(0)
            };
            if best.cycles[n][k] != calm {
                let mut other = best.cycles.clone();
                other[n][k] = calm;
                if parts(product, &best.start, &other) == Some(other.len() - 1) {
                    best.cycles = other;
                }
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_is_fixed() {
        let mut random = Random::new(42);
        assert_eq!(random.draw(), 13_679_457_532_755_275_413);
        let mut counts = [0; 5];
        for _ in 0..5000 {
            counts[random.below(5)] += 1;
        }
        assert!(counts.iter().all(|n| (850..1150).contains(n)), "{counts:?}");
    }
}
