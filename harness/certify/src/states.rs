//! States as numbers, and a set of them.

use stillpoint_lang::bind::Bound;

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

    /// By how much each variable raises the number of a state when its value grows by 1.
    pub fn weights(&self) -> Vec<u128> {
        let below = |k: usize| self.digits[k + 1..].iter().map(|(_, size)| size).product();
        (0..self.digits.len()).map(below).collect()
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

/// An ascending list of numbers, and where each one stands.
#[derive(Debug)]
pub struct Places<'a> {
    list: &'a [u128],
    /// A hash table with open addressing: places from 1 on, 0 where there is none.
    slots: Vec<u32>,
}

impl<'a> Places<'a> {
    /// The places in a list; none if it has 2^32 numbers or more.
    pub fn new(list: &'a [u128]) -> Option<Self> {
        u32::try_from(list.len()).ok()?;
        let mut places = Self {
            list,
            // At least half of them stay free, so that a search comes to an end soon.
            slots: vec![0; (2 * list.len() + 1).next_power_of_two()],
        };
        for (place, number) in list.iter().enumerate() {
            let slot = places.slot(*number);
            places.slots[slot] = place as u32 + 1;
        }
        Some(places)
    }

    /// Where a number stands.
    pub fn find(&self, number: u128) -> Option<usize> {
        (self.slots[self.slot(number)] as usize).checked_sub(1)
    }

    /// The slot of a number: one with its place, or a free one.
    fn slot(&self, number: u128) -> usize {
        let mixed = (number as u64 ^ (number >> 64) as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut slot = (mixed >> 32) as usize;
        loop {
            slot &= self.slots.len() - 1;
            match self.slots[slot] as usize {
                0 => return slot,
                place if self.list[place - 1] == number => return slot,
                _ => slot += 1,
            }
        }
    }
}
