//! The source of nondeterministic values that every property is written over.

use stillpoint_monitors::kernel::{Cycles, Position, Speed};

/// What one run of a property found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The choices are outside the domain of the property (a broken assumption); the run does not count.
    Discarded,
    /// The property held.
    Held,
    /// The property did not hold; the name of the clause or law that was broken.
    Broken(&'static str),
}

/// Nondeterministic values, one choice after the other.
///
/// Engines differ in what "every value" means: the narrow ranges of [`Source::any_in`] are complete in every engine, the
/// wide values are cut to a small domain by the enumeration and complete under Kani.
pub trait Source {
    /// Any value from `low` to `high`, both included. `low` must not be above `high`.
    fn any_in(&mut self, low: u32, high: u32) -> u32;

    /// Any delay of at most `longest`, a parameter; the enumeration takes the delays of its domain.
    fn any_delay(&mut self, longest: Cycles) -> Cycles;

    /// Any duration of at most `longest`, the rest of a delay; the enumeration takes every one (its delays are short).
    fn any_cycles(&mut self, longest: Cycles) -> Cycles;

    /// Any position; the enumeration takes two.
    fn any_position(&mut self) -> Position;

    /// Any speed; the enumeration takes 0 to the highest of its domain.
    fn any_speed(&mut self) -> Speed;

    /// Any number; the enumeration takes those from -`reach` to `reach` and the two ends of the range.
    fn any_i32(&mut self, reach: u32) -> i32;

    /// Any number of at most `highest`; the enumeration takes those up to `reach`, and `highest` itself.
    fn any_u32(&mut self, reach: u32, highest: u32) -> u32;

    /// Any of the numbers of a choice. What is drawn may lie between two of them: the declaration of the choice makes the higher
    /// one of it.
    fn any_choice(&mut self, variants: &'static [(&'static str, i64)]) -> i64 {
        let place = self.any_in(0, variants.len().saturating_sub(1) as u32);
        variants
            .get(place as usize)
            .map_or(0, |(_, number)| *number)
    }

    /// Any whole number from `low` to `high`, both included, which are in 32 bits or the ends of 64.
    fn any_whole(&mut self, low: i64, high: i64) -> i64;

    /// As [`Source::any_whole`], but Kani takes only those from `_least` to `_greatest`.
    fn any_few(&mut self, low: i64, high: i64, _least: i64, _greatest: i64) -> i64 {
        self.any_whole(low, high)
    }

    /// As [`Source::any_u32`], but Kani takes only the numbers of `bits` bits: for the factors and divisors of arithmetic that
    /// it cannot decide at full width. Each use is a caveat of the harness.
    fn any_cut(&mut self, reach: u32, highest: u32, _bits: u32) -> u32 {
        self.any_u32(reach, highest)
    }

    /// As [`Source::any_i32`], but Kani takes only the numbers of `bits` bits, one of them the sign: see
    /// [`Source::any_cut`].
    fn any_cut_i32(&mut self, reach: u32, _bits: u32) -> i32 {
        self.any_i32(reach)
    }

    /// Whether the engine leaves out what the caveat of the harness names: Kani, where the whole is too much for it.
    fn leaves_out(&self) -> bool {
        false
    }

    /// Whether every choice is tried one after the other, so that a domain must be small. A draw that is narrowed for this
    /// engine takes everything in the others.
    fn enumerates(&self) -> bool {
        false
    }

    /// Which part of a domain that is too large to enumerate as a whole: the enumeration takes the parts 1 to `parts`; the
    /// other engines take 0, which is everything.
    fn any_part(&mut self, _parts: u32) -> u32 {
        0
    }

    /// Notes whether the situation `index` of the harness's list of covers was met.
    fn cover(&mut self, index: usize, met: bool);

    /// Either truth value.
    fn any_bool(&mut self) -> bool {
        self.any_in(0, 1) == 1
    }

    /// Any of the values of a list; the first one of an empty list's type default.
    fn any_of<T: Copy + Default>(&mut self, values: &[T]) -> T {
        let last = values.len().saturating_sub(1) as u32;
        let index = self.any_in(0, last);
        values.get(index as usize).copied().unwrap_or_default()
    }
}
