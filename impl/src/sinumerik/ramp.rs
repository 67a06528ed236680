//! Braking ramp (SBR) of one channel: after STOP B or C the axis must not become faster again (machine M8).
//!
//! The limit is the speed at the start of the stop plus a tolerance. It follows the speed down, never up, to the speed n_x
//! plus the tolerance, where it stays. In each cycle the speed is compared with the limit of the cycle before; then the
//! limit is corrected. A violation raises STOP A, which is not configurable.
//!
//! Recommended readings of the manual implemented here: A-22 (settled), a stop that begins below n_x has the lowest limit
//! from its start; A-31 SBR_KEEP, STOP B after STOP C keeps the limit reached. How long the ramp is on is the
//! business of [`crate::sinumerik::stop`].

use crate::kernel::{ConfigError, Speed};

use crate::sinumerik::level::InternalStop;

config! {
    /// The parameters of the ramp.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        velo_x: Speed,
        tol: Speed,
    }
}

impl Config {
    /// `velo_x`: the speed below which the limit is frozen (`SAFE_VELO_X`, 36946 / 1346). `tol`: how much faster than
    /// before the axis may be (`SAFE_STOP_VELO_TOL`, 36948 / 1348). Both rounded down.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when their sum, the lowest limit, needs more than 32 bits.
    pub const fn new(velo_x: Speed, tol: Speed) -> Result<Self, ConfigError> {
        match velo_x.0.checked_add(tol.0) {
            Some(_) => Ok(Self { velo_x, tol }),
            None => Err(ConfigError::ValueTooLarge),
        }
    }

    /// The limit for an axis whose lowest speed since the start of the stop is `lowest`.
    ///
    /// A sum beyond 32 bits gives the highest number, which no speed exceeds either.
    pub fn limit(&self, lowest: Speed) -> Speed {
        Speed(lowest.max(self.velo_x).0.saturating_add(self.tol.0))
    }

    /// The lowest limit.
    pub fn lowest_limit(&self) -> Speed {
        self.limit(self.velo_x)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The lowest speed since the start of the stop, that of the cycle before it included; the last speed without a stop.
        pub lowest: Speed,
    }
}

impl State {
    /// The axis has not moved yet.
    pub const INITIAL: Self = Self { lowest: Speed(0) };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }

    /// The limit of the next cycle, in force if the ramp is on then.
    pub fn limit(&self, config: &Config) -> Speed {
        config.limit(self.lowest)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// STOP B, or STOP C, was effective after the last cycle (see [`crate::sinumerik::stop::Outputs::sbr_on`]).
        pub on: bool,
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is above the limit (alarms 27013, 300906).
        pub violated: bool,
        /// The limit for the next cycle; in force while the ramp is on.
        pub limit: Speed,
        /// The ramp is on and the limit has reached its lowest value.
        pub frozen: bool,
        /// STOP A when violated.
        pub demand: InternalStop,
    }
}

monitor! { sinumerik::ramp;
    /// Faster than the limit of the cycle before: STOP A is demanded in the same cycle.
    faster_than_the_ramp_demands_stop_a ["S840D-P-11", "S840D-SBR-002", "S840D-SBR-003", "S840D-PARAM-018",
        "S840D-ALARM-717"]:
        when |s| s.inputs.on && !s.inputs.power_on && s.inputs.speed > s.before.limit(&s.config)
            => s.outputs.violated && s.outputs.demand == InternalStop::A;

    /// At the limit and below nothing is demanded.
    at_the_limit_is_no_violation ["S840D-SBR-003", "S840D-SBR-008"]:
        when |s| s.inputs.speed <= s.before.limit(&s.config) && !s.inputs.power_on
            => !s.outputs.violated && s.outputs.demand == InternalStop::None;

    /// Without a stop of level B or C nothing is demanded, at any speed.
    off_demands_nothing ["S840D-SBR-001"]:
        when |s| !s.inputs.on
            => !s.outputs.violated && !s.outputs.frozen && s.outputs.demand == InternalStop::None;

    /// While the ramp is on its limit never rises, a change from STOP C to STOP B included.
    limit_never_rises ["S840D-P-10", "S840D-SBR-002", "S840D-SBR-009", "S840D-ALARM-717"]:
        when |s| s.inputs.on && !s.inputs.power_on
            => s.outputs.limit <= s.before.limit(&s.config) && s.after.limit(&s.config) == s.outputs.limit;

    /// A slower axis takes the limit down with it, at once.
    limit_follows_the_speed_down ["S840D-SBR-002", "S840D-SBR-007"]:
        when |s| s.inputs.on && !s.inputs.power_on && s.config.limit(s.inputs.speed) < s.before.limit(&s.config)
            => s.outputs.limit == s.config.limit(s.inputs.speed);

    /// The limit ends at n_x plus the tolerance and stays there.
    lowest_limit_is_kept ["S840D-P-10", "S840D-SBR-002"]:
        when |s| s.inputs.on && s.before.limit(&s.config) == s.config.lowest_limit()
            => s.outputs.limit == s.config.lowest_limit() && s.outputs.frozen;

    /// The stop starts with the speed of the cycle in which it becomes effective, or with n_x if that is higher.
    start_value_is_the_speed ["S840D-SBR-002", "S840D-SBR-010"]:
        when |s| !s.inputs.on
            => s.outputs.limit == s.config.limit(s.inputs.speed) && s.after.limit(&s.config) == s.outputs.limit;

    /// No limit is below n_x plus the tolerance.
    no_limit_below_the_lowest ["S840D-SBR-002", "S840D-SBR-010"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.limit >= s.config.lowest_limit() && s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let violated = inputs.on && inputs.speed > before.limit(config);
    let after = State {
        lowest: if inputs.on {
            before.lowest.min(inputs.speed)
        } else {
            inputs.speed
        },
    };
    let limit = after.limit(config);
    let outputs = Outputs {
        violated,
        limit,
        frozen: inputs.on && limit == config.lowest_limit(),
        demand: if violated {
            InternalStop::A
        } else {
            InternalStop::None
        },
    };
    (after, outputs)
}
