//! The source for random tests: choices read from a tape of words.
//!
//! The tape is made (and, when a property breaks, shrunk) by proptest in the tests; a smaller word gives a smaller choice
//! and a tape that is too short goes on with zeros, so that shrinking the tape shrinks the choices.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};

use crate::source::Source;

/// A source that reads its choices from words.
pub struct Tape<'a> {
    words: &'a [u32],
    next: usize,
    covers: &'a mut [u64],
}

impl<'a> Tape<'a> {
    /// A source over the words; `covers` counts the covers met.
    pub fn new(words: &'a [u32], covers: &'a mut [u64]) -> Self {
        Self {
            words,
            next: 0,
            covers,
        }
    }

    fn word(&mut self) -> u32 {
        let word = self.words.get(self.next).copied().unwrap_or(0);
        self.next += 1;
        word
    }

    /// A wide value: small ones, the ends of the range and the whole range in equal parts.
    fn wide(&mut self, highest: u32) -> u32 {
        let word = self.word();
        let value = word >> 2;
        match word & 3 {
            0 | 1 => value % highest.min(3).saturating_add(1),
            2 => highest - value % highest.min(3).saturating_add(1),
            _ => ((u64::from(word) * (u64::from(highest) + 1)) >> 32) as u32,
        }
    }
}

impl Source for Tape<'_> {
    fn any_in(&mut self, low: u32, high: u32) -> u32 {
        let span = high.saturating_sub(low).saturating_add(1);
        low + self.word() % span
    }

    fn any_delay(&mut self, longest: Cycles) -> Cycles {
        Cycles::new(self.wide(longest.count()))
    }

    fn any_cycles(&mut self, longest: Cycles) -> Cycles {
        Cycles::new(self.wide(longest.count()))
    }

    fn any_position(&mut self) -> Position {
        // The same bits read as a signed number.
        Position(self.wide(u32::MAX) as i32)
    }

    fn any_speed(&mut self) -> Speed {
        Speed(self.wide(u32::MAX))
    }

    fn any_i32(&mut self, _: u32) -> i32 {
        // The same bits read as a signed number.
        self.wide(u32::MAX) as i32
    }

    fn any_u32(&mut self, _: u32, highest: u32) -> u32 {
        self.wide(highest)
    }

    fn any_whole(&mut self, low: i64, high: i64) -> i64 {
        // Near 0, near the ends, or anywhere; a range of 64 bits is taken as one of 32.
        let span = u32::try_from(high.saturating_sub(low)).unwrap_or(u32::MAX);
        let value = low.saturating_add(i64::from(self.wide(span)));
        if low < 0 && self.word() & 1 == 0 {
            (value - low).min(high)
        } else {
            value
        }
    }

    fn cover(&mut self, index: usize, met: bool) {
        if let Some(count) = self.covers.get_mut(index) {
            *count += u64::from(met);
        }
    }
}
