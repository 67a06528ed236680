//! States as numbers, and a set of them.

use stillpoint_spec::bind::Bound;

/// The number of a state: its variables are the digits, the first one the highest.
#[derive(Debug, Clone)]
pub struct Radix {
    digits: Vec<(i32, u128)>,
    /// The number of all values of the state variables together.
    pub space: u128,
}

impl Radix {
    /// The numbering of the states of `bound`; none if they need more than 128 bits.
    pub fn new(bound: &Bound) -> Option<Self> {
        let size = |(lo, hi): &(i32, i32)| (*lo, u128::from(hi.abs_diff(*lo)) + 1);
        let digits: Vec<_> = bound.states.iter().map(size).collect();
        let space = digits
            .iter()
            .try_fold(1_u128, |product, (_, size)| product.checked_mul(*size))?;
        Some(Self { digits, space })
    }

    /// The number of a state; none if a variable is outside its range.
    pub fn index(&self, state: &[i32]) -> Option<u128> {
        let mut index = 0;
        for ((lo, size), value) in self.digits.iter().zip(state) {
            let digit = u128::from(value.abs_diff(*lo));
            if value < lo || digit >= *size {
                return None;
            }
            index = index * size + digit;
        }
        Some(index)
    }

    /// Writes the state of this number; false if there is none.
    pub fn state(&self, mut index: u128, state: &mut [i32]) -> bool {
        if index >= self.space {
            return false;
        }
        for ((lo, size), cell) in self.digits.iter().zip(state).rev() {
            // A digit is below 2^32, so the sum wraps into the variable's range.
            *cell = lo.wrapping_add_unsigned((index % size) as u32);
            index /= size;
        }
        true
    }
}

/// Where `key` stands in an ascending list. `near` is where the last one stood: successors often repeat.
pub fn place(list: &[u128], key: u128, near: &mut usize) -> Option<usize> {
    if list.get(*near) != Some(&key) {
        *near = list.binary_search(&key).ok()?;
    }
    Some(*near)
}
