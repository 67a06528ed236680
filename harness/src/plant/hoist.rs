//! What a hoist has beside its drive: brakes that close and open by themselves, and a load on a rope.

/// A brake. It is open or closed a while after it was asked to be; what it holds is told by its torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Brake {
    /// Its torque in percent of the one that it should have.
    pub torque: u32,
    /// It stays what it is, whatever it is asked for.
    pub stuck: bool,
    /// It is closed.
    pub closed: bool,
    /// Cycles for which it has been asked to be something else.
    asked_for: u32,
}

impl Default for Brake {
    fn default() -> Self {
        Self {
            torque: 100,
            stuck: false,
            closed: false,
            asked_for: 0,
        }
    }
}

impl Brake {
    /// A cycle in which it is asked to be closed or open, which takes so many cycles.
    pub fn ask(&mut self, closed: bool, time: u32) {
        if self.closed == closed || self.stuck {
            self.asked_for = 0;
            return;
        }
        self.asked_for += 1;
        if self.asked_for > time {
            self.closed = closed;
            self.asked_for = 0;
        }
    }

    /// What it holds against, as an acceleration, where one in order brakes the axis with `braking`.
    pub fn holds(&self, braking: i64) -> i64 {
        match self.closed {
            true => braking * i64::from(self.torque) / 100,
            false => 0,
        }
    }
}

/// A load on a rope: 10000 is full load.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Load {
    /// The load.
    pub load: i64,
    /// Where it comes to rest on something, in thousandths of an increment; none: it hangs free.
    pub rests: Option<i64>,
}

impl Default for Load {
    /// Half of the full load, hanging free.
    fn default() -> Self {
        Self {
            load: 5_000,
            rests: None,
        }
    }
}

/// The way over which a load that comes to rest is taken off its rope: 10 mm, by which the rope was longer.
const STRETCH: i64 = 10_000_000;

impl Load {
    /// What the rope carries at a position, rounded down.
    pub fn on_rope(&self, position: i64) -> i64 {
        let below = self.rests.map_or(0, |place| (place - position).max(0));
        self.load * (STRETCH - below.min(STRETCH)) / STRETCH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brake_takes_its_time() {
        let mut brake = Brake::default();
        let mut closed = || {
            brake.ask(true, 2);
            brake.closed
        };
        assert_eq!([(); 4].map(|()| closed()), [false, false, true, true]);
        brake.ask(false, 0);
        assert!(!brake.closed);
        brake.stuck = true;
        brake.ask(true, 0);
        assert!(!brake.closed);
    }

    #[test]
    fn a_weak_brake_holds_less() {
        let brake = Brake {
            torque: 60,
            closed: true,
            ..Brake::default()
        };
        assert_eq!(brake.holds(500), 300);
        assert_eq!(Brake::default().holds(500), 0);
    }

    /// The rope carries all down to the place, half of it 5 mm below, nothing from 10 mm below on.
    #[test]
    fn a_load_that_rests_leaves_a_slack_rope() {
        let load = Load {
            load: 6_000,
            rests: Some(1_000_000_000),
        };
        let at = |position| load.on_rope(position);
        assert_eq!(at(1_000_000_000), 6_000);
        assert_eq!(at(995_000_000), 3_000);
        assert_eq!((at(990_000_000), at(0)), (0, 0));
        let free = Load {
            rests: None,
            ..load
        };
        assert_eq!(free.on_rope(0), 6_000);
    }
}
