//! The source for Kani: every value of the full width, symbolically.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};

use crate::source::{Source, Verdict};

/// Kani's nondeterminism as a source.
pub(crate) struct Symbolic;

impl Source for Symbolic {
    fn any_in(&mut self, low: u32, high: u32) -> u32 {
        let value: u32 = kani::any();
        kani::assume(low <= value && value <= high);
        value
    }

    fn any_cycles(&mut self, longest: Cycles) -> Cycles {
        Cycles::new(self.any_in(0, longest.count()))
    }

    fn any_position(&mut self) -> Position {
        Position(kani::any())
    }

    fn any_speed(&mut self) -> Speed {
        Speed(kani::any())
    }

    fn any_bool(&mut self) -> bool {
        kani::any()
    }

    fn cover(&mut self, index: usize, met: bool) {
        // A cover is a place in the program for Kani; so each index has its own.
        kani::cover!(index == 0 && met);
        kani::cover!(index == 1 && met);
        kani::cover!(index == 2 && met);
    }
}

/// Turns the verdict of a property into Kani's terms.
pub(crate) fn conclude(verdict: Verdict) {
    kani::assume(verdict != Verdict::Discarded);
    assert!(verdict == Verdict::Held);
}
