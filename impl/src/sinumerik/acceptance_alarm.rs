//! Acknowledgement of a tested STOP B or A in the acceptance test mode (machine `acceptance_alarm`).
//!
//! The alarms 27010/300907, 27023/300901 and 27024/300900 need power-on; in the mode of group 1 the RESET key is enough, once
//! the stop has come to its end. Its output `acknowledged` goes where the power-on of the `stop` goes. Another alarm that
//! needs power-on, such as 27013, keeps all of them.

config! {
    /// Nothing is to be configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// One of the three pairs is active.
        pub tested: bool,
        /// Another alarm that needs power-on is.
        pub kept: bool,
    }
}

impl State {
    /// No alarm.
    pub const INITIAL: Self = Self {
        tested: false,
        kept: false,
    };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// One of the three pairs comes up, or its cause lasts.
        pub cause: bool,
        /// So does another alarm that needs power-on.
        pub other: bool,
        /// Power-on, NCK reset.
        pub power_on: bool,
        /// The RESET key.
        pub reset: bool,
        /// The mode of group 1 was active before this cycle.
        pub active: bool,
        /// The stop of the axis has come to its end: pulses cancelled.
        pub over: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// STOP B or A is acknowledged like by power-on.
        pub acknowledged: bool,
    }
}

monitor! { sinumerik::acceptance_alarm;
    /// The RESET key acknowledges in the mode of group 1, a stop that is over, and with no other alarm that needs power-on.
    reset_acknowledges_in_the_mode ["S840D-ACCEPT-742"]:
        when |s| s.outputs.acknowledged
            => s.inputs.reset && s.inputs.active && s.inputs.over && s.before.tested && !s.before.kept;

    /// There it does.
    reset_is_heard ["S840D-ACCEPT-742"]:
        when |s| s.inputs.reset && s.inputs.active && s.inputs.over && s.before.tested && !s.before.kept && !s.inputs.power_on
            => s.outputs.acknowledged && s.after.tested == s.inputs.cause;

    /// Outside of the mode an alarm stays, whatever key is pressed.
    pending_alarm_needs_power_on ["S840D-ACCEPT-742", "S840D-ACCEPT-753", "S840D-PARAM-023/b"]:
        when |s| !s.inputs.active && !s.inputs.power_on
            => !s.outputs.acknowledged && s.after.tested == (s.before.tested || s.inputs.cause);

    /// An alarm of another kind is not relaxed.
    other_alarms_are_not_relaxed ["S840D-ACCEPT-742"]:
        when |s| s.before.kept && !s.inputs.power_on
            => s.after.kept && !s.outputs.acknowledged && s.after.tested == (s.before.tested || s.inputs.cause);

    /// Power-on acknowledges what has no cause any more.
    power_on_acknowledges ["S840D-ACCEPT-753"]:
        when |s| s.inputs.power_on
            => s.after.tested == s.inputs.cause && s.after.kept == s.inputs.other;

    /// A cause that lasts keeps its alarm.
    cause_keeps_its_alarm ["S840D-ACCEPT-742"]:
        when |s| s.inputs.cause || s.inputs.other
            => (s.after.tested || !s.inputs.cause) && (s.after.kept || !s.inputs.other);
}

pub(crate) const fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let relaxed = inputs.active && inputs.over && !state.kept && state.tested;
    let acknowledged = !inputs.power_on && inputs.reset && relaxed;
    let cleared = inputs.power_on || acknowledged;
    let after = State {
        tested: (state.tested && !cleared) || inputs.cause,
        kept: (state.kept && !cleared) || inputs.other,
    };
    (after, Outputs { acknowledged })
}
