//! Safely limited speed (SLS) of one axis or spindle: the limit of the mode in force plus 5 %.
//!
//! The cycle after the group has taken the state of an open door, a speed above its limit is SS1: the last 3 ms of the
//! response to the door in MC and CC (HFS-TIMING-007, HFS-TIMING-008).
//!
//! Which limit counts follows from the monitoring state of the group, also while a stop brakes it. A violation raises SS1 in
//! the same cycle, with no time to slow down. Restricted spindle operation has no 5 %. A limit of 0 is a wrong parameter,
//! which channel B finds.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{GroupState, Left, Stop};
use crate::kernel::{ConfigError, Speed};

fields! {
    /// The limits in increments per cycle (see [`crate::heidenhain::parameters`]), 0 where none is set.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Limits {
        /// SOM_2: SMP590.x of an axis, SMP591 of the spindle.
        pub som_2: Speed,
        /// SOM_3: SMP540.x, SMP541.
        pub som_3: Speed,
        /// SOM_4: SMP552.x, SMP551.
        pub som_4: Speed,
        /// Restricted spindle operation: 50 rpm.
        pub restricted: Speed,
    }
}

config! {
    /// The limits and the channel.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        limits: Limits,
        cc: bool,
    }
}

impl Config {
    /// `cc`: channel B, which also looks for limits that are not set.
    ///
    /// # Errors
    /// [`ConfigError::ValueTooLarge`] when a limit plus 5 % needs more than 32 bits.
    pub const fn new(limits: Limits, cc: bool) -> Result<Self, ConfigError> {
        let Limits {
            som_2,
            som_3,
            som_4,
            restricted: _,
        } = limits;
        if with_margin(som_2) > u32::MAX as u64
            || with_margin(som_3) > u32::MAX as u64
            || with_margin(som_4) > u32::MAX as u64
        {
            return Err(ConfigError::ValueTooLarge);
        }
        Ok(Self { limits, cc })
    }

    /// The limit of a monitoring state, none where the speed is not limited. `left`: the modes that the group has left without
    /// standing still; the lowest of all these limits counts, but not in restricted operation, which has its own.
    pub fn limit(&self, state: GroupState, left: Left) -> Option<Speed> {
        let Limits {
            som_2,
            som_3,
            som_4,
            restricted,
        } = self.limits;
        let own = match state {
            GroupState::Sls2 => som_2,
            GroupState::Sls3 => som_3,
            GroupState::Sls4 => som_4,
            GroupState::SlsS => return Some(restricted),
            GroupState::Auto | GroupState::Sos | GroupState::StoO | GroupState::Sto => return None,
        };
        let beside = |applies: bool, limit: Speed| if applies { limit } else { own };
        Some(
            own.min(beside(left.sls_2, som_2))
                .min(beside(left.sls_3, som_3))
                .min(beside(left.sls_4, som_4)),
        )
    }
}

/// A limit plus 5 %, rounded down: a whole number is above the exact value exactly when it is above this one.
const fn with_margin(limit: Speed) -> u64 {
    limit.0 as u64 * 105 / 100
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The monitoring state of the group at the start of the cycle.
        pub state: GroupState,
        /// The modes left in motion, whose limits apply as well.
        pub left: Left,
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is limited.
        pub watched: bool,
        /// The speed is above the limit and its margin.
        pub violated: bool,
        /// The limit in force is not set (found by channel B only).
        pub not_set: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::speed;
    /// Faster than the limit of the mode plus 5 %: SS1 in the same cycle.
    faster_than_the_limit_stops ["HFS-ARCH-004/c", "HFS-MODE-004/a", "HFS-MODE-004/b", "HFS-MODE-005/a", "HFS-MODE-005/b", "HFS-TIMING-007", "HFS-TIMING-008", "HFS-P-11", "HFS-SLS-001", "HFS-SLS-003", "HFS-SLS-004", "HFS-SLS-006", "HFS-SLS-010"]:
        when |s| s.inputs.state != GroupState::SlsS && s.config.limit(s.inputs.state, s.inputs.left)
            .is_some_and(|limit| s.inputs.speed.0 as u64 * 100 > limit.0 as u64 * 105)
            => s.outputs.violated && s.outputs.demand == Stop::Ss1;

    /// Up to the limit plus 5 % nothing is violated.
    within_the_margin_is_no_violation ["HFS-SLS-003"]:
        when |s| s.config.limit(s.inputs.state, s.inputs.left)
            .is_some_and(|limit| s.inputs.speed.0 as u64 * 100 <= limit.0 as u64 * 105)
            && s.inputs.state != GroupState::SlsS
            => !s.outputs.violated && s.outputs.watched;

    /// Restricted spindle operation: more than its limit is a violation, without a margin.
    restricted_operation_has_no_margin ["HFS-P-39", "HFS-MODE-013", "HFS-SLS-002"]:
        when |s| s.inputs.state == GroupState::SlsS
            => s.outputs.watched && s.outputs.violated == (s.inputs.speed > s.config.limits.restricted)
                && s.outputs.violated == (s.outputs.demand == Stop::Ss1);

    /// With the door closed, in the operating stop and without torque no speed is limited.
    nothing_watched_without_a_limit ["HFS-SLS-001", "HFS-SLS-011"]:
        when |s| s.config.limit(s.inputs.state, s.inputs.left).is_none()
            => !s.outputs.watched && !s.outputs.violated && !s.outputs.not_set && s.outputs.demand == Stop::None;

    /// After a change between SLS_2, SLS_3 and SLS_4 in motion the lowest limit counts.
    lowest_limit_counts ["HFS-AXG-018"]:
        when |s| matches!(s.inputs.state, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4)
            && ((s.inputs.left.sls_2 && s.inputs.speed.0 as u64 * 100 > s.config.limits.som_2.0 as u64 * 105)
                || (s.inputs.left.sls_3 && s.inputs.speed.0 as u64 * 100 > s.config.limits.som_3.0 as u64 * 105)
                || (s.inputs.left.sls_4 && s.inputs.speed.0 as u64 * 100 > s.config.limits.som_4.0 as u64 * 105))
            => s.outputs.violated;

    /// A limit of 0 in SOM_2 to SOM_4 is found by channel B, which raises SS1 at any speed.
    limit_of_zero_is_found ["HFS-SLS-008"]:
        when |s| s.config.limit(s.inputs.state, s.inputs.left) == Some(Speed(0)) && s.inputs.state != GroupState::SlsS
            => s.outputs.not_set == s.config.cc && (!s.config.cc || s.outputs.demand == Stop::Ss1);

    /// SS1 is raised for these two reasons only, and nothing else is.
    no_demand_without_cause ["HFS-STOP-001", "HFS-SLS-004"]:
        when |s| !s.outputs.violated && !s.outputs.not_set
            => s.outputs.demand == Stop::None;
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let Some(limit) = config.limit(inputs.state, inputs.left) else {
        return (State, Outputs::default());
    };
    let restricted = inputs.state == GroupState::SlsS;
    let highest = if restricted {
        limit.0 as u64
    } else {
        with_margin(limit)
    };
    let violated = inputs.speed.0 as u64 > highest;
    let not_set = config.cc && !restricted && limit == Speed(0);
    let outputs = Outputs {
        watched: true,
        violated,
        not_set,
        demand: if violated || not_set {
            Stop::Ss1
        } else {
            Stop::None
        },
    };
    (State, outputs)
}
