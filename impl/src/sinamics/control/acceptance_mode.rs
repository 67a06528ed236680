//! Acceptance test mode: limit violations can be provoked for a limited time.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The longest duration, p9558.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) duration: Cycles,
    }
}

impl Config {
    /// `duration`: p9558 in cycles.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is 0: the mode would never begin.
    pub const fn new(duration: Cycles) -> Result<Self, ConfigError> {
        if duration.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self { duration })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is left of the mode; 0: it is off.
        pub left: Cycles,
        /// p9570 in the last cycle.
        pub requested: bool,
    }
}

impl State {
    /// Off; a p9570 that is set is no edge.
    pub const INITIAL: Self = Self {
        left: Cycles::ZERO,
        requested: true,
    };

    /// The mode lasts no longer than its time, and no longer than it is requested.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.duration && (self.requested || self.left.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// p9570: the mode is requested.
        pub request: bool,
        /// p9575 = 172: the test of SLP is selected.
        pub position_test: bool,
        /// The drive has braked and is in SOS, also that of SS2.
        pub standing: bool,
        /// A violation of SOS is acknowledged in this cycle.
        pub sos_acknowledged: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The mode is on: S_ZSW3B bit 15.
        pub active: bool,
        /// The test of SLP is selected: S_ZSW3B bit 14.
        pub position_test: bool,
        /// The setpoint limits r9733\[0..2\] are in force.
        pub limits: bool,
        /// The setpoint has effect in SOS.
        pub setpoint_enabled: bool,
        /// SOS takes the present position as its reference.
        pub new_reference: bool,
    }
}

monitor! { sinamics::acceptance_mode;
    /// The mode begins by the rising edge of its request.
    mode_begins_by_an_edge ["S120-ACCEPT-500", "S120-PARAM-508"]:
        when |s| s.outputs.active && s.before.left.is_zero()
            => s.inputs.request && !s.before.requested && !s.inputs.power_on && s.after.left == s.config.duration;

    /// It ends within p9558: in each cycle less of it is left.
    mode_ends_in_time ["S120-ACCEPT-500", "S120-PC-24", "S120-PARAM-508"]:
        when |s| s.before.left > Cycles::ZERO && !s.inputs.power_on
            => if s.inputs.request {
                s.after.left == s.before.left.tick()
            } else {
                !s.outputs.active
            };

    /// Outside the mode nothing is tolerated.
    nothing_is_tolerated_outside ["S120-ACCEPT-500", "S120-ACCEPT-502", "S120-PC-24"]:
        when |s| !s.outputs.active
            => s.outputs.limits && !s.outputs.setpoint_enabled && !s.outputs.new_reference && !s.outputs.position_test;

    /// In the mode the setpoint limits are removed, and the setpoint has effect in SOS.
    limits_are_removed ["S120-ACCEPT-500", "S120-ACCEPT-501", "S120-ACCEPT-503", "S120-SIC-505"]:
        when |s| s.outputs.active
            => !s.outputs.limits && s.outputs.setpoint_enabled == s.inputs.standing
                && s.outputs.position_test == s.inputs.position_test;

    /// An acknowledged violation of SOS in the mode teaches the position anew.
    acknowledged_sos_is_taught ["S120-ACCEPT-502"]:
        when |s| s.inputs.sos_acknowledged
            => s.outputs.new_reference == s.outputs.active;

    /// POWER ON ends it.
    power_on_ends_it ["S120-ACCEPT-500"]:
        when |s| s.inputs.power_on
            => !s.outputs.active;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-ACCEPT-500"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.active != s.after.left.is_zero();
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let left = if inputs.power_on || !inputs.request {
        Cycles::ZERO
    } else if !state.requested {
        config.duration
    } else {
        state.left.tick()
    };
    let after = State {
        left,
        requested: inputs.request,
    };
    let active = !left.is_zero();
    let outputs = Outputs {
        active,
        position_test: active && inputs.position_test,
        limits: !active,
        setpoint_enabled: active && inputs.standing,
        new_reference: active && inputs.sos_acknowledged,
    };
    (after, outputs)
}
