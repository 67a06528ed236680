//! What a statement about a cycle says where not every input was read.

use std::collections::BTreeSet;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

use super::walk::size;

/// Evaluations of one statement at most.
const MOST_TRIES: usize = 256;

/// The value of an atom in a cycle, see [`Teller::truth`].
///
/// # Errors
/// As there.
pub fn truth(
    bound: &Bound,
    frame: &Frame,
    known: &[(u32, u32)],
    atom: usize,
) -> Result<bool, BTreeSet<u32>> {
    Teller::new(bound, frame, known).truth(atom)
}

/// Tells the values of atoms in one cycle; what they have in common is evaluated once.
pub struct Teller<'a> {
    bound: &'a Bound,
    frame: &'a Frame,
    known: &'a [(u32, u32)],
    probe: Frame,
}

impl<'a> Teller<'a> {
    /// A teller of the cycle that left this frame. Inputs that it did not read have the values `known` (distances from the
    /// least one), and else any.
    pub fn new(bound: &'a Bound, frame: &'a Frame, known: &'a [(u32, u32)]) -> Self {
        Self {
            bound,
            frame,
            known,
            probe: frame.clone(),
        }
    }

    /// The value of an atom. Of inputs with any value all values are tried.
    ///
    /// # Errors
    /// The inputs on which the value depends, or may depend, where there are too many values to try.
    pub fn truth(&mut self, atom: usize) -> Result<bool, BTreeSet<u32>> {
        let mut tried: Vec<(u32, u32, u32)> = Vec::new();
        let mut seen = BTreeSet::new();
        let mut first = None;
        for _ in 0..MOST_TRIES {
            let mut at = 0;
            let (bound, known) = (self.bound, self.known);
            let value = bound.atom(atom, &mut self.probe, &mut |k| {
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
            if !tried.is_empty() {
                // What was evaluated belongs to a value that was only tried.
                self.probe.clone_from(self.frame);
            }
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
        }
        Err(seen)
    }
}
