//! Input choices: the odometer that enumerates them on demand, and the replay of those of a step made before.

use crate::report::Step;
use crate::system::Choices;
use crate::watch::Watch;

/// Vectors between two looks at the limits: a look costs as much as a small step.
const PATIENCE: u32 = 64;

#[derive(Clone, Copy, Debug)]
struct Read {
    input: u32,
    size: u32,
    value: u32,
    /// Input combinations that agree with the reads before this one, and up to this one.
    before: u128,
    weight: u128,
}

/// A place in the reads of one run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    at: usize,
    seen: u64,
}

/// Enumerates the choices of one cycle in lexicographic order of the reads, only over what is really read.
///
/// The caller runs the cycle between `begin` and `advance`, until `advance` says that no vector is left. Under a watch a limit
/// ends every enumeration, those of a single state too, and no further one begins: see [`Odometer::is_broken`].
#[derive(Clone, Debug)]
pub(crate) struct Odometer {
    /// The reads of the present vector, `len` of them; what follows is left over, and saves some divisions.
    reads: Vec<Read>,
    len: usize,
    at: usize,
    /// Input numbers read in this run, modulo 64: a quick negative answer to "was it read already".
    seen: u64,
    total: u128,
    watch: Option<Watch>,
    /// Vectors until the next look at the limits.
    patience: u32,
    broken: bool,
}

impl Odometer {
    pub(crate) fn new(combinations: u128) -> Self {
        Odometer {
            reads: Vec::with_capacity(64),
            len: 0,
            at: 0,
            seen: 0,
            total: combinations,
            watch: None,
            patience: PATIENCE,
            broken: false,
        }
    }

    /// The same under limits.
    pub(crate) fn watched(combinations: u128, watch: &Watch) -> Self {
        Odometer {
            watch: Some(watch.clone()),
            ..Odometer::new(combinations)
        }
    }

    /// Whether a limit broke an enumeration off.
    #[inline]
    pub(crate) fn is_broken(&self) -> bool {
        self.broken
    }

    /// Looks at the limits now and then; true if one is reached.
    #[inline]
    fn tires(&mut self) -> bool {
        self.patience -= 1;
        if self.patience == 0 {
            self.patience = PATIENCE;
            self.broken |= self.watch.as_ref().is_some_and(Watch::ended);
        }
        self.broken
    }

    /// Forgets the present vector: the next run is the first of a new cycle.
    #[inline]
    pub(crate) fn reset(&mut self) {
        self.len = 0;
        self.begin();
    }

    /// Starts a run with the present choice vector.
    #[inline]
    pub(crate) fn begin(&mut self) {
        self.at = 0;
        self.seen = 0;
    }

    /// The next choice vector; false if there is none.
    #[inline]
    pub(crate) fn advance(&mut self) -> bool {
        debug_assert_eq!(self.at, self.len, "a run read less than the one before it");
        self.len = self.at;
        if self.tires() {
            return false;
        }
        while let Some(last) = self
            .len
            .checked_sub(1)
            .and_then(|last| self.reads.get_mut(last))
        {
            last.value += 1;
            if last.value < last.size {
                return true;
            }
            self.len -= 1;
        }
        false
    }

    /// The reads of this run so far: what is read beyond them can be enumerated by itself.
    #[inline]
    pub(crate) fn mark(&self) -> Mark {
        Mark {
            at: self.at,
            seen: self.seen,
        }
    }

    /// The next vector of the reads beyond a mark, to be read from the mark on; false if there is none. What was read
    /// beyond the mark is forgotten then.
    #[inline]
    pub(crate) fn advance_beyond(&mut self, mark: Mark) -> bool {
        let last = self.at;
        self.at = mark.at;
        self.seen = mark.seen;
        self.len = last;
        if last > mark.at && self.tires() {
            self.len = mark.at;
            return false;
        }
        while self.len > mark.at {
            let read = &mut self.reads[self.len - 1];
            read.value += 1;
            if read.value < read.size {
                return true;
            }
            self.len -= 1;
        }
        false
    }

    /// Whether something was read beyond a mark.
    #[inline]
    pub(crate) fn is_beyond(&self, mark: Mark) -> bool {
        self.at > mark.at
    }

    /// How many input combinations the run just made stands for.
    #[inline]
    pub(crate) fn weight(&self) -> u128 {
        match self.at.checked_sub(1).and_then(|last| self.reads.get(last)) {
            Some(last) => last.weight,
            None => self.total,
        }
    }

    /// The inputs read in the run just made: number, size, value.
    pub(crate) fn reads(&self) -> impl Iterator<Item = (u32, u32, u32)> + '_ {
        self.reads[..self.at]
            .iter()
            .map(|r| (r.input, r.size, r.value))
    }

    /// The inputs read and their values.
    pub(crate) fn values(&self) -> Step {
        self.reads[..self.at]
            .iter()
            .map(|r| (r.input, r.value))
            .collect()
    }

    /// Reads an input that this vector has no value for yet.
    #[inline]
    fn first(&mut self, input: u32, size: u32) {
        let before = self.weight();
        self.len += 1;
        if let Some(old) = self.reads.get_mut(self.at) {
            if old.size == size && old.before == before {
                old.input = input;
                old.value = 0;
                return;
            }
        }
        self.divide(input, size, before);
    }

    #[cold]
    fn divide(&mut self, input: u32, size: u32, before: u128) {
        let size = size.max(1);
        let read = Read {
            input,
            size,
            value: 0,
            before,
            weight: before / u128::from(size),
        };
        match self.reads.get_mut(self.at) {
            Some(old) => *old = read,
            None => self.reads.push(read),
        }
    }
}

impl Choices for Odometer {
    #[inline(always)]
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        let bit = 1u64 << (input & 63);
        if self.seen & bit != 0 {
            if let Some(read) = self.reads[..self.at].iter().find(|r| r.input == input) {
                return read.value;
            }
        }
        self.seen |= bit;
        if self.at == self.len {
            self.first(input, size);
        }
        let read = &self.reads[self.at];
        debug_assert_eq!(
            read.input, input,
            "the same answers led to another question"
        );
        self.at += 1;
        read.value
    }
}

/// Answers from a step made before. What is not among its choices was not read then, so it does not matter: it reads 0.
#[derive(Clone, Copy, Debug)]
pub struct Replay<'a> {
    step: &'a [(u32, u32)],
}

impl<'a> Replay<'a> {
    /// Replays the pairs (input, value) of one step.
    pub fn new(step: &'a [(u32, u32)]) -> Self {
        Replay { step }
    }
}

impl Choices for Replay<'_> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        let found = self.step.iter().find(|(i, _)| *i == input);
        found
            .map_or(0, |(_, value)| *value)
            .min(size.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_beyond_a_mark_are_enumerated_by_themselves() {
        let mut odometer = Odometer::new(2 * 3 * 5 * 7);
        let (mut steps, mut first, mut second) = (0, 0, 0);
        odometer.reset();
        loop {
            odometer.begin();
            let step = odometer.choose(0, 2);
            let mark = odometer.mark();
            // Two observers, each of which reads an input of its own and, at times, the one the step has read.
            loop {
                assert_eq!(odometer.choose(0, 2), step);
                odometer.choose(1, 3);
                first += 1;
                if !odometer.advance_beyond(mark) {
                    break;
                }
            }
            loop {
                if step == 1 {
                    odometer.choose(1, 3);
                    odometer.choose(65, 5);
                }
                second += 1;
                if !odometer.advance_beyond(mark) {
                    break;
                }
            }
            assert!(!odometer.is_beyond(mark));
            assert_eq!(odometer.weight(), 3 * 5 * 7);
            steps += 1;
            if !odometer.advance() {
                break;
            }
        }
        assert_eq!((steps, first, second), (2, 2 * 3, 1 + 3 * 5));
    }

    #[test]
    fn enumerates_only_what_is_read_and_the_weights_add_up() {
        let mut odometer = Odometer::new(2 * 3 * 5 * 7);
        let mut seen = Vec::new();
        let mut sum = 0;
        odometer.reset();
        loop {
            odometer.begin();
            // Input 1 is read only where input 0 is 1; input 65 shares the quick mark of input 1; 3 is never read.
            if odometer.choose(0, 2) == 1 {
                let value = odometer.choose(1, 3);
                odometer.choose(65, 5);
                assert_eq!(odometer.choose(1, 3), value);
            }
            sum += odometer.weight();
            seen.push(odometer.values());
            if !odometer.advance() {
                break;
            }
        }
        assert_eq!(seen.len(), 1 + 3 * 5);
        assert_eq!(seen[0], [(0, 0)]);
        assert_eq!(seen[15], [(0, 1), (1, 2), (65, 4)]);
        assert_eq!(sum, 2 * 3 * 5 * 7);
        let mut sorted = seen.clone();
        sorted.sort();
        assert_eq!(sorted, seen);
    }
}
