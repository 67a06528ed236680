//! The source for Kani: every value of the full width, symbolically.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};

use crate::source::{Source, Verdict};

/// Kani's nondeterminism as a source; keeps the covers met for the harness to hand to Kani.
#[derive(Default)]
pub(crate) struct Symbolic {
    covers: u32,
}

impl Symbolic {
    /// Whether the lowest cover not yet taken was met; takes it.
    pub(crate) fn take_cover(&mut self) -> bool {
        let met = self.covers & 1 == 1;
        self.covers >>= 1;
        met
    }
}

impl Source for Symbolic {
    fn any_in(&mut self, low: u32, high: u32) -> u32 {
        let value: u32 = kani::any();
        kani::assume(low <= value && value <= high);
        value
    }

    fn any_delay(&mut self, longest: Cycles) -> Cycles {
        Cycles::new(self.any_in(0, longest.count()))
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

    fn any_i32(&mut self, _: u32) -> i32 {
        kani::any()
    }

    fn any_u32(&mut self, _: u32, highest: u32) -> u32 {
        self.any_in(0, highest)
    }

    fn cover(&mut self, index: usize, met: bool) {
        if met && index < 32 {
            self.covers |= 1 << index;
        }
    }

    fn any_bool(&mut self) -> bool {
        kani::any()
    }
}

/// Turns the verdict of a property into Kani's terms.
pub(crate) fn conclude(verdict: Verdict) {
    kani::assume(verdict != Verdict::Discarded);
    assert!(verdict == Verdict::Held);
}
