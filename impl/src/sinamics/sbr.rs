//! Safe brake ramp (SBR) of one channel: the speed stays below a ramp that is computed from parameters and does not follow it.
//!
//! The ramp begins t_d = max(p9582, 2 cycles) after the trigger and falls by p9581 in p9583. It is exact: what a cycle takes off is
//! no whole number of increments in general, so the rest is carried along and the limit is the ramp rounded down.
//!
//! Readings: AF-2 and AF-32 are choices of the configuration, the recommended one first. Under SBR_FLOOR_RES no limit is
//! below the resolution, so that it never rises again when the ramp has ended.

use crate::kernel::{ConfigError, Cycles, Speed};

fields! {
    /// Reading AF-2: the speed at which the ramp begins.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbrStart {
        /// That of the trigger.
        #[default]
        Trigger,
        /// That at the end of the delay.
        DelayEnd,
        /// The reference p9581.
        Reference,
    }
}

fields! {
    /// Reading AF-32: the least limit.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbrFloor {
        /// The resolution of the speed, r9732.
        #[default]
        Resolution,
        /// 0.
        Zero,
    }
}

config! {
    /// The parameters; speeds in increments per cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        reference: Speed,
        time: Cycles,
        delay: Cycles,
        resolution: Speed,
        start: SbrStart,
        floor: SbrFloor,
    }
    accepted |config| !config.time.is_zero() && config.delay >= Config::SHORTEST_DELAY
}

impl Config {
    /// The shortest delay: two cycles (S120-SBR-003).
    pub const SHORTEST_DELAY: Cycles = Cycles::new(2);

    /// `reference`: p9581. `time`: p9583. `delay`: p9582 in whole cycles, rounded up; a shorter one than two cycles is two
    /// (S120-SBR-003). `resolution`: r9732.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when the ramp has no time: it would be no ramp.
    pub const fn new(
        reference: Speed,
        time: Cycles,
        delay: Cycles,
        resolution: Speed,
        start: SbrStart,
        floor: SbrFloor,
    ) -> Result<Self, ConfigError> {
        if time.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        let delay = if delay.count() < Self::SHORTEST_DELAY.count() {
            Self::SHORTEST_DELAY
        } else {
            delay
        };
        Ok(Self {
            reference,
            time,
            delay,
            resolution,
            start,
            floor,
        })
    }

    /// The delay: t_d.
    pub const fn delay(&self) -> Cycles {
        self.delay
    }

    /// The resolution of the speed: r9732.
    pub const fn resolution(&self) -> Speed {
        self.resolution
    }

    /// The most that a ramp without time lasts: the cycles from the trigger until it is below `shutdown`, or as low as it gets
    /// (S120-SBR-006); none where it never falls.
    pub fn longest(&self, start: Speed, shutdown: Speed) -> Option<u64> {
        let height = u64::from(start.0.saturating_sub(shutdown.0));
        let cycles = height * u64::from(self.time.count());
        let fall = cycles.div_ceil(u64::from(self.reference.0).max(1));
        (self.reference.0 > 0 || height == 0).then_some(u64::from(self.delay.count()) + fall)
    }

    /// The least limit.
    const fn least(&self) -> Speed {
        match self.floor {
            SbrFloor::Resolution => self.resolution,
            SbrFloor::Zero => Speed(0),
        }
    }
}

fields! {
    /// Where the monitor is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing is monitored.
        #[default]
        Idle,
        /// The ramp has not begun.
        Delay,
        /// It falls, or has ended.
        Ramp,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the monitor is.
        pub phase: Phase,
        /// What is left of the delay.
        pub left: Cycles,
        /// The ramp, rounded down.
        pub ramp: Speed,
        /// How far the exact ramp is above it, in parts of an increment: as many as p9583 has cycles.
        pub rest: u32,
    }
}

impl State {
    /// Nothing is monitored.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        ramp: Speed(0),
        rest: 0,
    };

    /// Nothing is kept outside a stop; the rest is less than an increment and belongs to the ramp.
    pub fn invariant(&self, config: &Config) -> bool {
        match self.phase {
            Phase::Idle => *self == Self::INITIAL,
            Phase::Delay => {
                !self.left.is_zero()
                    && self.left <= config.delay
                    && self.rest == 0
                    && (config.start == SbrStart::Trigger || self.ramp == Speed(0))
            }
            Phase::Ramp => self.left.is_zero() && self.rest < config.time.count(),
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SS1, SS2, STOP B, STOP C or a lower limit of SLS brakes, and SBR is what monitors it.
        pub braking: bool,
        /// Magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is above the ramp: C01706, STOP A.
        pub violated: bool,
        /// The speed is compared.
        pub monitored: bool,
        /// What it is compared with; 0 while it is not.
        pub limit: Speed,
    }
}

/// The ramp is above 0 after the step, and was in the ramp before.
fn falling(s: &Step) -> bool {
    s.before.phase == Phase::Ramp && s.inputs.braking && s.after.ramp > Speed(0)
}

/// A ramp in parts of an increment.
fn parts(ramp: Speed, rest: u32, config: &Config) -> u64 {
    u64::from(ramp.0) * u64::from(config.time.count()) + u64::from(rest)
}

monitor! { sinamics::sbr;
    /// A speed above the ramp is a violation in the same cycle; the ramp itself is none.
    ramp_is_the_limit ["S120-SBR-002", "S120-SBR-005", "S120-PF-17"]:
        when |s| s.outputs.monitored
            => s.outputs.violated == (s.inputs.speed > s.outputs.limit);

    /// Without comparison there is no violation.
    nothing_else_violates ["S120-SBR-002"]:
        when |s| !s.outputs.monitored
            => !s.outputs.violated && s.outputs.limit == Speed(0);

    /// Each cycle the exact ramp falls by p9581 / p9583.
    ramp_falls_exactly ["S120-SBR-002"]:
        when |s| falling(&s)
            => parts(s.after.ramp, s.after.rest, &s.config) + u64::from(s.config.reference.0)
                == parts(s.before.ramp, s.before.rest, &s.config);

    /// It ends at 0, no sooner than the exact one is below an increment.
    ramp_ends_at_zero ["S120-SBR-002", "S120-SBR-006"]:
        when |s| s.before.phase == Phase::Ramp && s.inputs.braking && s.after.ramp == Speed(0)
            => parts(s.before.ramp, s.before.rest, &s.config)
                < u64::from(s.config.reference.0) + u64::from(s.config.time.count());

    /// The limit does not depend on the speed, and never rises.
    limit_never_rises ["S120-SBR-002", "S120-SBR-006", "S120-PF-17"]:
        when |s| s.before.phase == Phase::Ramp && s.inputs.braking
            => s.after.ramp <= s.before.ramp && s.after.phase == Phase::Ramp;

    /// The ramp begins after the delay, which is at least two cycles.
    delay_comes_first ["S120-SBR-003", "S120-SBR-001"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.braking
            => s.after.phase == Phase::Delay && s.after.left == s.config.delay && s.after.left.count() >= 2;

    /// The delay is counted down and ends in the ramp.
    delay_ends_in_the_ramp ["S120-SBR-003", "S120-SBR-002"]:
        when |s| s.before.phase == Phase::Delay && s.inputs.braking
            => (s.after.phase == Phase::Ramp) == (s.before.left == Cycles::new(1)) && s.after.left == s.before.left.tick();

    /// Where it begins (AF-2).
    ramp_begins_at_its_speed ["S120-SBR-002"]:
        when |s| s.before.phase == Phase::Delay && s.after.phase == Phase::Ramp
            => s.after.rest == 0 && s.after.ramp == match s.config.start {
                SbrStart::Trigger => s.before.ramp,
                SbrStart::DelayEnd => s.inputs.speed,
                SbrStart::Reference => s.config.reference,
            };

    /// Under the recommended reading the speed of the trigger is kept, so that an acceleration during the delay is seen at its end.
    trigger_speed_is_kept ["S120-SBR-002"]:
        when |s| s.config.start == SbrStart::Trigger && s.before.phase == Phase::Delay && s.inputs.braking
            => s.after.ramp == s.before.ramp;

    /// The delay is not monitored, the ramp is.
    delay_is_not_monitored ["S120-SBR-001", "S120-SBR-003"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.monitored == (s.after.phase == Phase::Ramp);

    /// Standstill is no violation at any time.
    standstill_is_no_violation ["S120-SBR-002", "S120-SBR-006"]:
        when |s| s.inputs.speed == Speed(0)
            => !s.outputs.violated;

    /// An ended ramp permits no more than the resolution, or nothing (AF-32).
    ended_ramp_permits_the_resolution ["S120-SBR-006"]:
        when |s| s.after.phase == Phase::Ramp && s.after.ramp == Speed(0)
            => s.outputs.limit == match s.config.floor {
                SbrFloor::Resolution => s.config.resolution,
                SbrFloor::Zero => Speed(0),
            };

    /// The monitor ends with the stop.
    no_braking_no_monitor ["S120-SBR-004", "S120-SBR-001"]:
        when |s| !s.inputs.braking
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// The state stays consistent.
    state_stays_consistent ["S120-SBR-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

/// The ramp one cycle later: the rest pays for the part of an increment, where it can.
fn fallen(state: &State, config: &Config) -> (Speed, u32) {
    let time = config.time.count().max(1);
    let (whole, part) = (config.reference.0 / time, config.reference.0 % time);
    let (fall, rest) = match state.rest.checked_sub(part) {
        Some(rest) => (whole, rest),
        // A part is less than the time, which the borrowed increment has.
        None => (whole.saturating_add(1), state.rest + (time - part)),
    };
    match state.ramp.0.checked_sub(fall) {
        Some(ramp) => (Speed(ramp), rest),
        None => (Speed(0), 0),
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.braking {
        return (State::INITIAL, Outputs::default());
    }
    let at_trigger = config.start == SbrStart::Trigger;
    let left = match state.phase {
        Phase::Idle => config.delay,
        Phase::Delay | Phase::Ramp => state.left.tick(),
    };
    let phase = if left.is_zero() {
        Phase::Ramp
    } else {
        Phase::Delay
    };
    let (ramp, rest) = match state.phase {
        Phase::Idle if at_trigger => (inputs.speed, 0),
        Phase::Idle => (Speed(0), 0),
        Phase::Delay if phase == Phase::Ramp => match config.start {
            SbrStart::Trigger => (state.ramp, 0),
            SbrStart::DelayEnd => (inputs.speed, 0),
            SbrStart::Reference => (config.reference, 0),
        },
        Phase::Delay => (state.ramp, 0),
        Phase::Ramp => fallen(&state, config),
    };
    let monitored = phase == Phase::Ramp;
    let limit = if monitored {
        ramp.max(config.least())
    } else {
        Speed(0)
    };
    let outputs = Outputs {
        violated: monitored && inputs.speed > limit,
        monitored,
        limit,
    };
    let after = State {
        phase,
        left,
        ramp,
        rest,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(reference: u32, time: u32, delay: u32) -> Config {
        Config::new(
            Speed(reference),
            Cycles::new(time),
            Cycles::new(delay),
            Speed(1),
            SbrStart::Trigger,
            SbrFloor::Resolution,
        )
        .expect("accepted")
    }

    /// S120-SBR-003: less than two cycles are two; the 250 ms of the acceptance trace, rounded up to cycles of 12 ms, are 21.
    #[test]
    fn the_shortest_delay() {
        for (p9582, delay) in [(0, 2), (1, 2), (2, 2), (3, 3), (250_u32.div_ceil(12), 21)] {
            assert_eq!(config(1500, 833, p9582).delay(), Cycles::new(delay));
        }
    }

    /// S120-SBR-002, S120-SBR-006: with 1500 rpm in 10 s (Table A-5) and cycles of 12 ms the ramp from 1500 rpm ends after the time of
    /// the ramp, and at each cycle it is the exact one rounded down.
    #[test]
    fn the_ramp_is_exact() {
        let config = config(1500, 833, 2);
        let mut monitor = Monitor::new(config);
        let inputs = |speed| Inputs {
            braking: true,
            speed: Speed(speed),
        };
        monitor.step(&inputs(1500));
        monitor.step(&inputs(0));
        for k in 0..=833_u32 {
            let limit = monitor.step(&inputs(0)).limit;
            let exact = (1500 * (833 - k)) / 833;
            assert_eq!(limit.0, exact.max(1), "cycle {k}");
        }
        assert_eq!(config.longest(Speed(1500), Speed(0)), Some(835));
        assert_eq!(config.longest(Speed(100), Speed(200)), Some(2));
    }
}
