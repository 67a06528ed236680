//! What a statement about a cycle says where not every input was read.

use std::collections::BTreeSet;

use stillpoint_spec::bind::Bound;
use stillpoint_spec::eval::Frame;

use super::walk::size;

/// Evaluations of one statement at most.
const MOST_TRIES: usize = 256;

/// The value of an atom in a cycle. Inputs that the cycle did not read have the values `known` (distances from the least one),
/// and else any: all of them are tried.
///
/// # Errors
/// The inputs on which the value depends, or may depend, where there are too many values to try.
pub fn truth(
    bound: &Bound,
    frame: &Frame,
    known: &[(u32, u32)],
    atom: usize,
) -> Result<bool, BTreeSet<u32>> {
    let mut tried: Vec<(u32, u32, u32)> = Vec::new();
    let mut seen = BTreeSet::new();
    let mut first = None;
    let mut probe = frame.clone();
    for _ in 0..MOST_TRIES {
        let mut at = 0;
        let value = bound.atom(atom, &mut probe, &mut |k| {
            let (lo, input) = (bound.inputs[k].0, k as u32);
            let given = known.iter().find(|(i, _)| *i == input);
            let above = match given {
                Some((_, value)) => *value,
                None => {
                    if at == tried.len() {
                        seen.insert(input);
                        tried.push((input, size(bound, input).unwrap_or(1), 0));
                    }
                    at += 1;
                    tried[at - 1].2
                }
            };
            // The distance is below the number of values.
            lo.wrapping_add(above as i32)
        });
        if *first.get_or_insert(value) != value {
            return Err(seen);
        }
        // The next values, in the order of an odometer.
        while tried.last().is_some_and(|(_, size, v)| v + 1 >= *size) {
            tried.pop();
        }
        match tried.last_mut() {
            None => return Ok(value),
            Some((_, _, v)) => *v += 1,
        }
        probe.clone_from(frame);
    }
    Err(seen)
}
