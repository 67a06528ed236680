//! The source for Kani: every value of the full width, symbolically.

use stillpoint_monitors::fields::Kind;
use stillpoint_monitors::kernel::{Cycles, Percent, Position, Speed};
use stillpoint_monitors::units::ModuloRange;

use crate::source::{Source, Verdict};

// The ends of the types. As constants and by `as`, here and in what is called for each number: a call of `from` is executed.
const BYTE: i64 = u8::MAX as i64;
const WORD: i64 = u16::MAX as i64;
const LONG: i64 = u32::MAX as i64;
const LEAST: i64 = i32::MIN as i64;
const GREATEST: i64 = i32::MAX as i64;

/// Kani's nondeterminism as a source; keeps the covers met for the harness to hand to Kani.
#[derive(Default)]
pub(crate) struct Symbolic {
    covers: u32,
    part: u32,
}

impl Symbolic {
    /// A source that takes one part of the domain of a run, from 1.
    pub(crate) fn part(part: u32) -> Self {
        Self { covers: 0, part }
    }

    /// Whether the lowest cover not yet taken was met; takes it.
    pub(crate) fn take_cover(&mut self) -> bool {
        let met = self.covers & 1 == 1;
        self.covers >>= 1;
        met
    }
}

impl Source for Symbolic {
    fn any_in(&mut self, low: u32, high: u32) -> u32 {
        // As few bits as the range needs: those above are then constants, and what is calculated with them is small.
        let value = if high <= u32::from(u8::MAX) {
            u32::from(kani::any::<u8>())
        } else if high <= u32::from(u16::MAX) {
            u32::from(kani::any::<u16>())
        } else {
            kani::any()
        };
        // The mask leaves out nothing that is in the range, and where it is all that the range asks for nothing is assumed.
        let mask = u32::MAX >> high.leading_zeros().min(31);
        let value = value & mask;
        if low > 0 || high < mask {
            kani::assume(low <= value && value <= high);
        }
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

    fn any_choice(&mut self, variants: &'static [(&'static str, i64)]) -> i64 {
        // No place in the list is looked up: a symbolic place makes every name and number of the list part of the formula.
        let (low, high) = Kind::Choice(variants).ends();
        self.any_whole(low, high)
    }

    fn any_whole(&mut self, low: i64, high: i64) -> i64 {
        // As few bits as the type has, and no assumption where it has them all.
        match (low, high) {
            (0, BYTE) => kani::any::<u8>() as i64,
            (0, WORD) => kani::any::<u16>() as i64,
            (0, LONG) => kani::any::<u32>() as i64,
            (LEAST, GREATEST) => kani::any::<i32>() as i64,
            (0, _) if high < LONG => self.any_in(0, high as u32) as i64,
            _ => {
                let value = kani::any();
                kani::assume(low <= value && value <= high);
                value
            }
        }
    }

    fn any_few(&mut self, low: i64, high: i64, least: i64, greatest: i64) -> i64 {
        let (least, greatest) = (least.max(low), greatest.min(high));
        least + i64::from(self.any_in(0, (greatest - least) as u32))
    }

    fn any_part(&mut self, _: u32) -> u32 {
        self.part
    }

    fn leaves_out(&self) -> bool {
        true
    }

    fn any_cut(&mut self, _: u32, highest: u32, bits: u32) -> u32 {
        self.any_in(0, highest.min((1 << bits) - 1))
    }

    fn any_cut_i32(&mut self, _: u32, bits: u32) -> i32 {
        let value = if bits <= i8::BITS {
            i32::from(kani::any::<i8>())
        } else {
            i32::from(kani::any::<i16>())
        };
        let reach = 1 << (bits - 1);
        kani::assume(-reach <= value && value < reach);
        value
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

/// [`Speed::reduced`] where the reduced limit is at most 15; a limit that is not reduced is free. The monitors compare
/// limits and treat none by its value, so that 4 bits show every order; that a wide one is reduced exactly is the property
/// `units_factor`.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn reduced_small(speed: Speed, factor: Percent) -> Speed {
    if factor == Percent::WHOLE {
        return speed;
    }
    kani::assume(speed.0 <= 15);
    Speed(u32::from(
        u16::from(speed.0 as u8) * u16::from(factor.get()) / 100,
    ))
}

/// [`ModuloRange::folded`] for a position in the range, which is folded to itself. What a monitor makes of any other
/// position is what it makes of the one it is folded to: it reads no other.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn folded_in_range(range: ModuloRange, position: Position) -> Position {
    kani::assume(!range.folds() || (range.lower() <= position && position < range.upper()));
    position
}
