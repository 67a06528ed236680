//! One alarm: when it is active, and what acknowledges it (machine `alarm_life`).
//!
//! The alarm is a message; the stop that belongs to it has a latch of its own ([`crate::sinumerik::stop`]). Whether it is shown
//! is decided by [`crate::sinumerik::alarm_display`] and changes nothing here (S840D-ALARM-701). How an alarm is acknowledged
//! says [`crate::sinumerik::message::acknowledgement`].

use crate::sinumerik::alarm::Class;

config! {
    /// The alarm.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        class: Class,
        escalates: bool,
        tested: bool,
    }
    accepted |config| *config == Config::new(config.class, config.escalates, config.tested)
}

impl Config {
    /// `class`: how it is acknowledged. `escalates`: once a STOP A or B was initiated with it, it needs power-on. `tested`: RESET
    /// acknowledges it in the acceptance test mode.
    pub const fn new(class: Class, escalates: bool, tested: bool) -> Self {
        Self {
            class,
            escalates,
            tested,
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The alarm is active.
        pub active: bool,
        /// A STOP A or B was initiated with it.
        pub escalated: bool,
    }
}

impl State {
    /// No alarm.
    pub const INITIAL: Self = Self {
        active: false,
        escalated: false,
    };

    /// Only an active alarm that may escalate has.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        !self.escalated || (self.active && config.escalates)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on.
        pub power_on: bool,
        /// What the alarm tells is there.
        pub cause: bool,
        /// STOP A or B is initiated with it.
        pub stop_ab: bool,
        /// The RESET key.
        pub reset: bool,
        /// The cancel key.
        pub cancel: bool,
        /// NC-START.
        pub nc_start: bool,
        /// Acceptance test mode of group 1.
        pub relaxed: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Only power-on clears it; in the acceptance test mode RESET may.
        pub needs_power_on: bool,
    }
}

monitor! { sinumerik::alarm_life;
    /// A cause that is there raises the alarm and keeps it, whatever is pressed.
    cause_keeps_the_alarm ["S840D-ALARM-711"]:
        when |s| s.inputs.cause
            => s.after.active;

    /// No alarm without cause.
    no_alarm_without_cause ["S840D-ALARM-711"]:
        when |s| s.after.active && !s.before.active
            => s.inputs.cause;

    /// An alarm that clears itself goes with its cause.
    self_clearing_goes ["S840D-ALARM-711", "S840D-ALARM-720"]:
        when |s| s.config.class == Class::SelfClearing && !s.config.escalates
            => s.after.active == s.inputs.cause;

    /// RESET clears what it may, once the cause has gone.
    reset_clears ["S840D-ALARM-711"]:
        when |s| s.config.class == Class::Reset && s.inputs.reset && !s.inputs.cause && !s.before.escalated
            && !(s.config.escalates && s.inputs.stop_ab)
            => !s.after.active;

    /// Without its key, and without power-on, an alarm stays.
    key_is_needed ["S840D-ALARM-711", "S840D-ALARM-725/b"]:
        when |s| s.before.active && !(s.after.active || s.inputs.power_on || (s.config.tested && s.inputs.relaxed))
            => match s.config.class {
                Class::SelfClearing => true,
                Class::Reset => s.inputs.reset,
                Class::PowerOn => false,
                Class::Cancel => s.inputs.cancel || s.inputs.nc_start,
                Class::NckKey => s.inputs.cancel,
            };

    /// The cancel key clears what it may.
    cancel_clears ["S840D-ALARM-711", "S840D-ALARM-725/b"]:
        when |s| matches!(s.config.class, Class::Cancel | Class::NckKey) && s.inputs.cancel && !s.inputs.cause
            && !s.config.escalates
            => !s.after.active;

    /// An alarm with which a STOP A or B came needs power-on, in every mode.
    escalated_needs_power_on ["S840D-ALARM-710", "S840D-ALARM-711", "S840D-ACCEPT-742"]:
        when |s| (s.before.escalated || (s.before.active && s.config.escalates && s.inputs.stop_ab)) && !s.inputs.power_on
            => s.after.active && s.after.escalated && s.outputs.needs_power_on;

    /// In the acceptance test mode RESET clears one of the three pairs.
    tested_alarm_is_reset ["S840D-ACCEPT-742"]:
        when |s| s.config.tested && s.inputs.relaxed && s.inputs.reset && !s.inputs.cause && !s.before.escalated
            && !(s.config.escalates && s.inputs.stop_ab)
            => !s.after.active;

    /// No other alarm that needs power-on is relaxed there.
    others_are_not_relaxed ["S840D-ACCEPT-742", "S840D-ALARM-710"]:
        when |s| s.config.class == Class::PowerOn && !s.config.tested && s.before.active && !s.inputs.power_on
            => s.after.active && s.outputs.needs_power_on;

    /// Power-on clears what has no cause any more.
    power_on_clears ["S840D-ALARM-711"]:
        when |s| s.inputs.power_on
            => s.after.active == s.inputs.cause && s.after.escalated == (s.inputs.cause && s.config.escalates && s.inputs.stop_ab);

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-ALARM-710"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config)
                && s.outputs.needs_power_on == (s.after.escalated || (s.after.active && s.config.class == Class::PowerOn));
}

pub(crate) const fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let pending = state.active && !inputs.power_on;
    let there = pending || inputs.cause;
    let stopped = (pending && state.escalated) || (there && config.escalates && inputs.stop_ab);
    let key = match config.class {
        Class::SelfClearing => true,
        Class::Reset => inputs.reset,
        Class::PowerOn => false,
        Class::Cancel => inputs.cancel || inputs.nc_start,
        Class::NckKey => inputs.cancel,
    };
    let acknowledged = key || (config.tested && inputs.relaxed && inputs.reset);
    let active = there && (inputs.cause || stopped || !acknowledged);
    let after = State {
        active,
        escalated: stopped,
    };
    let needs_power_on = stopped || (active && matches!(config.class, Class::PowerOn));
    (after, Outputs { needs_power_on })
}
