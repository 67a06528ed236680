//! Runs that a string of bytes describes: what a coverage-guided fuzzer alters.
//!
//! The first bytes choose the initial values that are free. Then each command changes one input and lets some cycles pass:
//! a byte for the input, a byte for the number of cycles, a byte for the value (small values count from the low end of the
//! range, large ones from the high end; 127 takes four more bytes for any value).

use super::product::{Product, Values};
use super::random::{Divergence, shrink};

/// The longest run a string of bytes describes.
const LONGEST: usize = 400;

/// Drives both sides of `product`, whose table has `inputs` inputs, as `data` says. Tells where they part.
pub fn run(product: &Product, inputs: usize, data: &[u8]) -> Option<Divergence> {
    let mut bytes = data.iter().copied();
    let domains = stillpoint_model::System::domains(product);
    let start = product.start(&mut |k| {
        let choice = u64::from(bytes.next().unwrap_or(0)) % domains[k].size();
        domains[k].lo.wrapping_add(choice as i32)
    });
    let mut now: Vec<i32> = (0..inputs).map(|k| product.values(k).get(0)).collect();
    let mut work = product.new_work();
    let mut cells = start.clone();
    let mut cycles = Vec::new();
    while let (Some(input), Some(length)) = (bytes.next(), bytes.next()) {
        if let Some(k) = usize::from(input).checked_rem(inputs) {
            now[k] = value(product.values(k), &mut bytes);
        }
        for _ in 0..=length % 16 {
            if cycles.len() == LONGEST {
                return None;
            }
            work.set_inputs(&now);
            cycles.push(now.clone());
            if product.step(&mut work, &mut cells).is_err() || !product.agree(&work) {
                return Some(shrink(product, Divergence { start, cycles }));
            }
        }
    }
    None
}

fn value(values: Values, bytes: &mut impl Iterator<Item = u8>) -> i32 {
    let count = values.count();
    match bytes.next().unwrap_or(0) {
        127 => {
            let any = (0..4).fold(0, |n, _| n << 8 | u64::from(bytes.next().unwrap_or(0)));
            values.get(any % count)
        }
        low @ 0..127 => values.get(u64::from(low) % count),
        high => values.get(count - 1 - u64::from(high - 128) % count),
    }
}
