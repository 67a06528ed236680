//! Whether stages are quicker than the cycles one by one.

use std::time::Duration;

/// States made one by one before stages are tried, those of the next level among them, or input vectors, and the input vectors of each
/// state that are worth it.
const TRIED: u64 = 512;
const MANY: u64 = 1 << 14;
const WORTH: u64 = 12;
/// So many input vectors are not made one by one where few states have told how many a state has. Else it is worth to wait: the more is
/// known of the properties, the less the stages have to tell apart.
const TOO_MANY: u64 = 1 << 17;
/// So many states have told how many input vectors a state has, unless they had many.
const FEW: u64 = 64;
/// So many states that were made one by one tell how long one takes.
const SAMPLES: u64 = 32;
/// States in stages before they are judged, or the time they took.
const JUDGED: u64 = 1024;
const LONG: Duration = Duration::from_millis(100);
/// What may be lost with them: learning pays late.
const LOST: Duration = Duration::from_millis(150);
/// Nanoseconds between two looks at the clock, and states at most.
const LOOK: u128 = 1_000_000;
const MOST: u64 = 64;

/// What some states took.
#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    time: Duration,
    states: u64,
}

impl Spent {
    fn add(&mut self, time: Duration, states: u64) {
        self.time += time;
        self.states += states;
    }

    /// Nanoseconds a state.
    fn rate(self) -> u128 {
        self.time.as_nanos() / u128::from(self.states.max(1))
    }
}

/// What the cycles one by one have taken. It decides how long an exploration takes, and nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    plain: Spent,
    vectors: u64,
}

impl Pace {
    /// States that were made one by one, with so many input vectors.
    pub(crate) fn plain(&mut self, time: Duration, states: u64, vectors: u64) {
        self.plain.add(time, states);
        self.vectors += vectors;
    }

    /// Takes over what a thread has measured.
    pub(crate) fn take(&mut self, other: &mut Pace) {
        let other = std::mem::take(other);
        self.plain(other.plain.time, other.plain.states, other.vectors);
    }

    /// Whether stages are worth a trial, before so many further states.
    pub(crate) fn tries(&self, further: u64) -> bool {
        let states = self.plain.states.max(1);
        let each = self.vectors / states;
        let all = states.saturating_add(further);
        let vectors = all.saturating_mul(each);
        let known = states >= FEW || self.vectors >= MANY;
        let many = match known {
            true => all >= TRIED || vectors >= MANY,
            false => vectors >= TOO_MANY,
        };
        many && each >= WORTH
    }
}

/// Stages of one thread on trial: it gives them up as soon as they turn out to be the slower way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    plain: Spent,
    /// States that are made one by one before any in stages.
    samples: u64,
    staged: Spent,
    /// Those since stages were judged last, and nanoseconds a state before that.
    recent: Spent,
    last: Option<u128>,
    pub(crate) over: bool,
}

impl Trial {
    /// One of several threads that begin after so much was made one by one.
    pub(crate) fn new(pace: &Pace, threads: usize) -> Self {
        let samples = SAMPLES.saturating_sub(pace.plain.states);
        Trial {
            plain: pace.plain,
            samples: samples.div_ceil(threads as u64),
            staged: Spent::default(),
            recent: Spent::default(),
            last: None,
            over: false,
        }
    }

    /// Whether the next state is made one by one.
    pub(crate) fn plain(&self) -> bool {
        self.over || self.samples > 0
    }

    /// So many states can be made before the clock is looked at.
    pub(crate) fn stride(&self) -> u64 {
        match self.last {
            _ if self.over => u64::MAX,
            _ if self.samples > 0 => self.samples,
            None => 1,
            Some(rate) => u64::try_from(LOOK / rate.max(1)).map_or(MOST, |s| s.clamp(1, MOST)),
        }
    }

    /// States that were made in the way that [`Trial::plain`] tells. Stages are given up when more is lost with them than may be, unless
    /// a state has come to take much less than before.
    pub(crate) fn made(&mut self, time: Duration, states: u64) {
        if self.plain() {
            self.plain.add(time, states);
            self.samples = self.samples.saturating_sub(states);
            return;
        }
        self.staged.add(time, states);
        self.recent.add(time, states);
        if self.recent.states < JUDGED && self.recent.time < LONG {
            return;
        }
        let (plain, rate) = (self.plain.rate(), std::mem::take(&mut self.recent).rate());
        let improves = self.last.is_none_or(|last| rate * 5 < last * 3);
        self.last = Some(rate);
        self.over = rate > plain && !improves && self.lost() > LOST.as_nanos() as i128;
    }

    /// Nanoseconds that were lost with stages so far; less than nothing where they were won.
    pub(crate) fn lost(&self) -> i128 {
        let plain = self.plain.rate() * u128::from(self.staged.states);
        self.staged.time.as_nanos() as i128 - plain as i128
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// After one state of 1 ms with 500 input vectors.
    fn begun() -> Pace {
        let mut pace = Pace::default();
        pace.plain(MS, 1, 500);
        pace
    }

    #[test]
    fn tries_where_many_vectors_are_to_come() {
        assert!(!Pace::default().tries(u64::MAX));
        assert!(!begun().tries(261));
        assert!(begun().tries(262), "131 500 vectors by one state");
        let mut known = Pace::default();
        known.plain(MS, 64, 64 * 20);
        assert!(!known.tries(447));
        assert!(known.tries(448), "512 states");
        known.plain(MS, 1, 64 * 500);
        assert!(known.tries(0), "more than 16 384 vectors");
        let mut few = Pace::default();
        few.plain(MS, 1, 11);
        assert!(!few.tries(u64::MAX));
    }

    #[test]
    fn samples_come_first_in_each_thread() {
        let mut trial = Trial::new(&begun(), 2);
        assert_eq!((trial.plain(), trial.stride()), (true, 16));
        trial.made(15 * MS, 15);
        assert_eq!((trial.plain(), trial.stride()), (true, 1));
        trial.made(MS, 1);
        assert_eq!((trial.plain(), trial.stride()), (false, 1));
    }

    /// One thread whose states take 1 ms one by one.
    fn sampled() -> Trial {
        let mut trial = Trial::new(&begun(), 1);
        trial.made(31 * MS, 31);
        trial
    }

    #[test]
    fn slow_stages_are_given_up() {
        let mut trial = sampled();
        trial.made(100 * MS, 10);
        assert!(!trial.over, "what is learned may pay later");
        assert_eq!(trial.stride(), 1);
        trial.made(100 * MS, 12);
        assert!(trial.over && trial.plain());
    }

    #[test]
    fn stages_that_become_quicker_are_kept() {
        let mut trial = sampled();
        for states in [10, 20, 40] {
            trial.made(100 * MS, states);
            assert!(!trial.over, "a state takes less and less");
        }
        trial.made(100 * MS, 42);
        assert!(trial.over, "{trial:?}");
    }

    #[test]
    fn one_slow_window_is_no_reason() {
        let mut trial = sampled();
        trial.made(100 * MS, 10);
        trial.made(MS, 1024);
        assert_eq!(trial.stride(), MOST);
        trial.made(300 * MS, 100);
        assert!(!trial.over, "far less was lost than won");
        assert_eq!(trial.lost(), -733 * 1_000_000);
        trial.made(1200 * MS, 100);
        assert!(trial.over && trial.lost() > 0);
    }
}
