//! Safely limited speed (SLS) of one channel without encoder and with SBR (p9506 = 1): a braking ramp leads to a lower limit.
//!
//! A selection, and the change to a lower level, brake the drive; the ramp ([`crate::sinamics::sbr`]) watches that. The new limit
//! takes over as soon as the ramp has come down to it, or the speed has been below it for p9582. Until then the old limit stays
//! monitored; at a first selection there is none. A higher limit takes effect at once.
//!
//! The limit of level 1 may come from the telegram (p9501.24); a lower one is like a lower level.
//!
//! Without selection (p9512.4) there is no transition: see [`crate::sinamics::sls`].

use crate::kernel::{ConfigError, Cycles, Speed};
use crate::sinamics::sbr;
use crate::sinamics::sls::{self, Level, Request, WHOLE};
use crate::sinamics::types::Stop;

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        limits: [Speed; 4],
        responses: [Stop; 4],
        ramp: sbr::Config,
        by_telegram: bool,
    }
}

impl Config {
    /// `limits`: p9531. `responses`: p9563. `ramp`: p9581 to p9583. `by_telegram`: p9501.24.
    ///
    /// # Errors
    /// [`ConfigError::StopNotAllowed`] for a response that a drive without encoder must not have (S120-SLS-014),
    /// [`ConfigError::NoDelay`] for a ramp that is none.
    pub fn new(
        limits: [Speed; 4],
        responses: [Stop; 4],
        ramp: sbr::Config,
        by_telegram: bool,
    ) -> Result<Self, ConfigError> {
        if !responses.iter().all(|stop| stop.allowed(false)) {
            return Err(ConfigError::StopNotAllowed);
        }
        if !ramp.accepted() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            limits,
            responses,
            ramp,
            by_telegram,
        })
    }

    /// The limit of a level, as a parameter.
    pub const fn limit(&self, level: Level) -> Speed {
        level.of(self.limits)
    }

    /// The stop of a level.
    pub const fn response(&self, level: Level) -> Stop {
        level.of(self.responses)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The level and the limit that are monitored; none at a first selection.
        pub now: Option<Request>,
        /// Those that the ramp leads to; none while no ramp falls.
        pub next: Option<Request>,
        /// The ramp.
        pub ramp: sbr::State,
        /// What is left of p9582 for a speed below the new limit; 0 while it is not below.
        pub settling: Cycles,
    }
}

impl State {
    /// Not selected.
    pub const INITIAL: Self = Self {
        now: None,
        next: None,
        ramp: sbr::State::INITIAL,
        settling: Cycles::ZERO,
    };

    /// A ramp belongs to the limit that it leads to, which is below the monitored one; none is above that of its level.
    pub fn invariant(&self, config: &Config) -> bool {
        let ramp = self.ramp.invariant(&config.ramp)
            && self.next.is_some() == (self.ramp.phase != sbr::Phase::Idle);
        let lower = match (self.now, self.next) {
            (Some(now), Some(next)) => next.limit < now.limit,
            _ => true,
        };
        let within = |request: Request| request.limit <= config.limit(request.level);
        let lower = lower && self.now.is_none_or(within) && self.next.is_none_or(within);
        let settles = self.settling.is_zero() || self.next.is_some();
        ramp && lower && settles && self.settling <= config.ramp.delay()
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SLS is selected.
        pub selected: bool,
        /// The selected level.
        pub level: Level,
        /// S_SLS_LIMIT_A: the limit of level 1 in 32767ths of p9531[0].
        pub telegram: i16,
        /// Magnitude of the actual speed of the load.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A limit is monitored (r9722.4).
        pub active: bool,
        /// Its level; the first one while none is.
        pub level: Level,
        /// The monitored limit; 0 while none is.
        pub limit: Speed,
        /// The drive brakes along OFF3 to a lower limit.
        pub braking: bool,
        /// The speed is above the monitored limit: C01714.
        pub violated: bool,
        /// It is above the ramp: C01706.
        pub ramp_violated: bool,
        /// The limit of the telegram is none: C01711 with value 1041.
        pub wrong_value: bool,
        /// The stop that is raised.
        pub demand: Stop,
    }
}

/// What is asked for: it waits for the ramp, or is monitored. See `selection_is_asked_for`.
fn asked(s: &Step) -> Speed {
    s.after.next.or(s.after.now).unwrap_or(Request::NONE).limit
}

/// The limit of the telegram counts.
fn telegram(s: &Step) -> bool {
    s.config.by_telegram && s.inputs.level == Level::FIRST
}

/// A limit is asked for that is no lower than the monitored one.
fn rises(s: &Step) -> bool {
    s.before.now.is_some_and(|now| asked(s) >= now.limit)
}

monitor! { sinamics::sls_ramp;
    /// The selected level is asked for, with its parameter.
    selection_is_asked_for ["S120-SLS-006", "S120-SLS-013"]:
        when |s| s.inputs.selected
            => s.after.next.or(s.after.now).is_some_and(|request| request.level == s.inputs.level)
                && (telegram(&s) || asked(&s) == s.config.limit(s.inputs.level));

    /// The telegram gives a part of the limit of level 1, never more than it.
    telegram_gives_a_part ["S120-SLS-009", "S120-PF-18"]:
        when |s| telegram(&s) && s.inputs.selected && s.inputs.telegram >= 1
            => {
                let exact = u64::from(s.config.limit(Level::FIRST).0) * s.inputs.telegram as u64;
                let taken = u64::from(asked(&s).0) * WHOLE;
                taken <= exact && exact < taken + WHOLE && !s.outputs.wrong_value
            };

    /// A value that is none raises the stop of level 1, with its message, and asks for 0.
    wrong_value_is_a_stop ["S120-SLS-009", "S120-PF-18"]:
        when |s| telegram(&s) && s.inputs.selected && s.inputs.telegram < 1
            => s.outputs.wrong_value && s.outputs.demand >= s.config.response(Level::FIRST) && asked(&s) == Speed(0);

    /// A speed above the monitored limit is a violation with the stop of its level, also while the ramp falls.
    fast_axis_is_stopped ["S120-SLS-013", "S120-SLS-002", "S120-PF-08"]:
        when |s| s.outputs.active && s.inputs.speed > s.outputs.limit
            => s.outputs.violated && s.outputs.demand >= s.config.response(s.outputs.level);

    /// The limit itself is no violation.
    limit_is_kept ["S120-SLS-002"]:
        when |s| !s.outputs.active || s.inputs.speed <= s.outputs.limit
            => !s.outputs.violated;

    /// A selection brakes; there is no limit yet.
    selection_brakes ["S120-SLS-013"]:
        when |s| s.before.now.is_none() && s.before.next.is_none() && s.inputs.selected
            => s.outputs.braking && !s.outputs.active && s.after.next.is_some()
                && s.after.ramp.left == s.config.ramp.delay();

    /// A lower level brakes, while the old limit stays monitored.
    lower_level_brakes ["S120-SLS-013", "S120-SBR-001"]:
        when |s| s.before.next.is_none() && s.before.now.is_some() && s.inputs.selected && !rises(&s)
            => s.outputs.braking && s.after.now == s.before.now && s.after.next.is_some()
                && s.after.ramp.left == s.config.ramp.delay();

    /// A higher limit takes effect at once, with and without a ramp.
    higher_limit_is_at_once ["S120-SLS-005", "S120-SLS-013"]:
        when |s| s.inputs.selected && rises(&s)
            => s.outputs.active && s.outputs.level == s.inputs.level && !s.outputs.braking;

    /// A speed above the ramp is STOP A in the same cycle, until the new limit takes over.
    ramp_is_watched ["S120-SLS-013", "S120-SBR-005", "S120-SBR-002"]:
        when |s| s.outputs.braking && s.after.ramp.phase == sbr::Phase::Ramp && s.inputs.speed > s.after.ramp.ramp
            && s.inputs.speed > s.config.ramp.resolution()
            => s.outputs.ramp_violated && s.outputs.demand == Stop::A;

    /// The ramp itself is none, nor is there one any more when the limit has taken over.
    ramp_is_kept ["S120-SLS-013", "S120-SBR-002"]:
        when |s| !s.outputs.braking || s.inputs.speed <= s.after.ramp.ramp
            => !s.outputs.ramp_violated;

    /// The limit that the ramp has reached takes over.
    reached_limit_takes_over ["S120-SLS-013", "S120-SBR-004", "S120-PF-34"]:
        when |s| s.before.next.is_some() && s.inputs.selected && s.before.ramp.phase == sbr::Phase::Ramp
            && reached(&s.before.ramp, asked(&s))
            => s.outputs.active && s.outputs.level == s.inputs.level && !s.outputs.braking;

    /// So does one that the speed has been below for p9582.
    settled_speed_takes_over ["S120-SLS-013", "S120-SBR-004"]:
        when |s| s.before.next.is_some_and(|next| next.level == s.inputs.level && next.limit == asked(&s)) && s.inputs.selected
            && s.before.settling == Cycles::new(1) && s.inputs.speed < asked(&s)
            => s.outputs.active && s.outputs.level == s.inputs.level && !s.outputs.braking;

    /// A speed at or above it begins that time anew.
    faster_speed_begins_anew ["S120-SLS-013"]:
        when |s| s.before.next.is_some() && s.outputs.braking && s.inputs.speed >= asked(&s)
            => s.after.settling.is_zero();

    /// Nothing else takes over.
    nothing_else_takes_over ["S120-SLS-013", "S120-SBR-004", "S120-PF-09"]:
        when |s| s.before.next.is_some() && !s.outputs.braking && s.inputs.selected && !rises(&s)
            => s.before.settling == Cycles::new(1) && s.inputs.speed < asked(&s)
                || s.before.ramp.phase == sbr::Phase::Ramp
                || s.before.ramp.left == Cycles::new(1);

    /// While the ramp falls the limit is the old one, or none.
    limit_waits ["S120-SLS-013", "S120-PF-09"]:
        when |s| s.outputs.braking
            => s.after.now == s.before.now && s.outputs.active == s.before.now.is_some();

    /// Level and limit that are shown are those that are monitored.
    shown_is_monitored ["S120-SLS-006", "S120-SLS-010", "S120-SLS-011"]:
        when |s| s.outputs.active
            => s.after.now == Some(Request { level: s.outputs.level, limit: s.outputs.limit });

    /// A deselection ends everything at once.
    deselection_is_at_once ["S120-SLS-001", "S120-PF-10"]:
        when |s| !s.inputs.selected
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// STOP A or B only.
    stops_are_a_or_b ["S120-SLS-014"]:
        when |s| s.outputs.demand != Stop::None
            => s.outputs.demand >= Stop::B
                && (s.outputs.violated || s.outputs.ramp_violated || s.outputs.wrong_value && telegram(&s));

    /// The state stays consistent.
    state_stays_consistent ["S120-SLS-013"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.braking == s.after.next.is_some();
}

/// The exact ramp, which lies above the rounded one by its rest, has come down to the limit.
fn reached(ramp: &sbr::State, limit: Speed) -> bool {
    ramp.phase == sbr::Phase::Ramp && (ramp.ramp < limit || ramp.ramp == limit && ramp.rest == 0)
}

/// The state after a cycle in which this is asked for, and whether the ramp is violated.
fn moved(state: &State, config: &Config, request: Request, inputs: &Inputs) -> (State, bool) {
    let limit = request.limit;
    let taken = State {
        now: Some(request),
        ..State::INITIAL
    };
    if state.now.is_some_and(|now| limit >= now.limit) {
        return (taken, false);
    }
    let speed = sbr::Inputs {
        braking: true,
        speed: inputs.speed,
    };
    let (ramp, watched) = sbr::transition(state.ramp, &config.ramp, &speed);
    let same = state.next == Some(request);
    let settling = if inputs.speed >= limit {
        Cycles::ZERO
    } else if same && !state.settling.is_zero() {
        state.settling.tick()
    } else {
        config.ramp.delay()
    };
    let settled = same && state.settling == Cycles::new(1) && inputs.speed < limit;
    if settled || reached(&ramp, limit) {
        return (taken, false);
    }
    let after = State {
        now: state.now,
        next: Some(request),
        ramp,
        settling,
    };
    (after, watched.violated)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.selected {
        return (State::INITIAL, Outputs::default());
    }
    let parameter = Request {
        level: inputs.level,
        limit: config.limit(inputs.level),
    };
    let (request, wrong_value) = sls::asked(parameter, config.by_telegram, inputs.telegram);
    let (after, ramp_violated) = moved(&state, config, request, inputs);
    let Request { level, limit } = after.now.unwrap_or(Request::NONE);
    let violated = after.now.is_some() && inputs.speed > limit;
    let own = match violated {
        true => config.response(level),
        false => Stop::None,
    };
    let wrong = match wrong_value {
        true => config.response(Level::FIRST),
        false => Stop::None,
    };
    let outputs = Outputs {
        active: after.now.is_some(),
        level,
        limit,
        braking: after.next.is_some(),
        violated,
        ramp_violated,
        wrong_value,
        demand: match ramp_violated {
            true => Stop::A,
            false => own.max(wrong),
        },
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinamics::sbr::{SbrFloor, SbrStart};

    fn monitor() -> Monitor {
        let ramp = sbr::Config::new(
            Speed(10),
            Cycles::new(1),
            Cycles::new(2),
            Speed(1),
            SbrStart::Trigger,
            SbrFloor::Resolution,
        );
        let limits = [Speed(100), Speed(50), Speed(20), Speed(10)];
        let config = Config::new(limits, [Stop::B; 4], ramp.expect("accepted"), true);
        Monitor::new(config.expect("accepted"))
    }

    fn inputs(speed: u32) -> Inputs {
        Inputs {
            selected: true,
            level: Level::FIRST,
            telegram: i16::MAX,
            speed: Speed(speed),
        }
    }

    /// S120-SLS-013, Image 4-14: from 120 the ramp reaches the limit of 100 two cycles after the delay of two.
    #[test]
    fn the_ramp_leads_to_the_limit() {
        let mut run = monitor();
        for speed in [120, 120, 120, 110] {
            let outputs = run.step(&inputs(speed));
            assert!(outputs.braking && !outputs.active && outputs.demand == Stop::None);
        }
        assert_eq!(run.step(&inputs(100)).limit, Speed(100));
        assert_eq!(run.step(&inputs(101)).demand, Stop::B);
    }

    /// S120-SLS-013: a drive that does not brake meets the ramp; one that is slow enough is taken over after p9582.
    #[test]
    fn too_slow_a_braking_and_an_early_takeover() {
        let mut run = monitor();
        for _ in 0..3 {
            assert!(!run.step(&inputs(120)).ramp_violated);
        }
        assert_eq!(run.step(&inputs(120)).demand, Stop::A);
        let mut run = monitor();
        assert!(!run.step(&inputs(99)).active && !run.step(&inputs(99)).active);
        assert!(run.step(&inputs(99)).active);
    }
    /// S120-SLS-009, S120-SLS-013: half the limit by telegram is a lower limit, which the ramp leads to; a value that is none stops.
    #[test]
    fn a_lower_limit_by_telegram_has_its_ramp() {
        let mut run = monitor();
        for _ in 0..3 {
            run.step(&inputs(99));
        }
        let half = |speed| Inputs {
            telegram: 16_384,
            ..inputs(speed)
        };
        for speed in [99, 99, 99, 90, 80, 70, 60] {
            let outputs = run.step(&half(speed));
            assert!(
                outputs.braking && outputs.limit == Speed(100),
                "{speed}: {outputs:?}"
            );
        }
        assert_eq!(run.step(&half(50)).limit, Speed(50));
        let none = Inputs {
            telegram: 0,
            ..inputs(50)
        };
        let outputs = run.step(&none);
        assert!(outputs.wrong_value && outputs.limit == Speed(50));
        assert_eq!(outputs.demand, Stop::B);
    }
}
