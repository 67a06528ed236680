//! Whether stages are quicker than the cycles one by one.

use std::time::Duration;

/// States made one by one before stages are tried, those of the next level among them, or input vectors, and the input vectors of each
/// state that are worth it. So few states that were made one by one tell how long one takes.
const TRIED: u64 = 512;
const FEW: u64 = 64;
const MANY: u64 = 1 << 14;
const WORTH: u64 = 12;
/// States in stages before they are judged, or nanoseconds of all threads together.
const JUDGED: u64 = 1024;
const LONG: u64 = 250_000_000;

/// What some states took.
#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    nanoseconds: u64,
    states: u64,
}

impl Spent {
    fn add(&mut self, time: Duration, states: u64) {
        self.nanoseconds += time.as_nanos() as u64;
        self.states += states;
    }

    /// Nanoseconds a state.
    fn rate(self) -> u64 {
        self.nanoseconds / self.states.max(1)
    }
}

/// What both ways have taken. It decides how long an exploration takes, and nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    plain: Spent,
    vectors: u64,
    staged: Spent,
    /// Nanoseconds a state, when stages were judged last.
    last: Option<u64>,
}

impl Pace {
    /// States that were made one by one, with so many input vectors.
    pub(crate) fn plain(&mut self, time: Duration, states: u64, vectors: u64) {
        self.plain.add(time, states);
        self.vectors += vectors;
    }

    /// States that were made in stages.
    pub(crate) fn staged(&mut self, time: Duration, states: u64) {
        self.staged.add(time, states);
    }

    /// Takes over what another thread has measured.
    pub(crate) fn take(&mut self, other: &mut Pace) {
        let other = std::mem::take(other);
        self.plain.nanoseconds += other.plain.nanoseconds;
        self.plain.states += other.plain.states;
        self.vectors += other.vectors;
        self.staged.nanoseconds += other.staged.nanoseconds;
        self.staged.states += other.staged.states;
    }

    /// Whether stages are worth a trial, before so many further states.
    pub(crate) fn tries(&self, further: u64) -> bool {
        let states = self.plain.states.max(1);
        let each = self.vectors / states;
        let all = states.saturating_add(further);
        let many = all >= TRIED || all.saturating_mul(each) >= MANY;
        let known = states >= FEW || self.vectors >= MANY;
        known && many && each >= WORTH
    }

    /// Whether stages turn out to be the slower way. What is learned in the first states pays later, and where it does it shows soon:
    /// a state takes much less than before.
    pub(crate) fn gives_up(&mut self) -> bool {
        if self.staged.states < JUDGED && self.staged.nanoseconds < LONG {
            return false;
        }
        let rate = std::mem::take(&mut self.staged).rate();
        let improves = self.last.is_none_or(|last| rate * 5 < last * 3);
        self.last = Some(rate);
        rate > self.plain.rate() && !improves
    }
}
