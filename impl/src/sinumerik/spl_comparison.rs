//! What one channel makes of the errors in the comparison of NCK-SPL and PLC-SPL (machine `spl_comparison`).
//!
//! The monitors of the 320 signals ([`crate::sinumerik::spl_signal`]) tell which of them has become an error; here stand the alarm,
//! the number that is shown and the stop on all axes, which only a protected channel asks for. Three more causes have the same
//! answer: the channels are not protected alike, they would not stop alike, or nothing can be compared. Those cannot be
//! acknowledged while they are there.
//!
//! A comparison that has found an error changes no signal and no output (S840D-SPL-012): it only asks for the stop.
//!
//! Reading B-40: SPLSTOP_RESET.

use crate::sinumerik::level::ExternalStop;

config! {
    /// There is nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The number of a signal, 1 to 320 in the order of DB18 (S840D-SPLKDV-009); 0 is none.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Number(u16) in 0..=320;
}

impl Number {
    /// No signal.
    pub const NONE: Self = Self(0);

    /// The signal with this number; the last one for a greater number.
    pub const fn new(number: u16) -> Self {
        Self(if number > 320 { 320 } else { number })
    }

    /// The number.
    pub const fn get(self) -> u16 {
        self.0
    }

    /// Whether it is the number of a signal.
    pub const fn is_some(self) -> bool {
        self.0 != 0
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Alarm 27090 waits for RESET.
        pub alarm: bool,
        /// The channel stops the axes: alarm 27091 with its name.
        pub stop: bool,
        /// STATSI: the signal that was the first error since RESET.
        pub number: Number,
    }
}

impl State {
    /// No error.
    pub const INITIAL: Self = Self {
        alarm: false,
        stop: false,
        number: Number::NONE,
    };

    /// A stop and a number have an alarm.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        self.alarm || (!self.stop && !self.number.is_some())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// NC-RESET.
        pub reset: bool,
        /// The comparison has been started.
        pub running: bool,
        /// The first of the signals that have become errors in this cycle.
        pub found: Number,
        /// This channel is protected ([`crate::sinumerik::spl_protection`]).
        pub protected: bool,
        /// The other one is.
        pub protected_other: bool,
        /// This channel stops with STOP E.
        pub stop_e: bool,
        /// The other one does.
        pub stop_e_other: bool,
        /// Communication has failed.
        pub lost: bool,
    }
}

impl Inputs {
    /// The settings of the channels do not match.
    const fn mismatch(&self) -> bool {
        self.running && (self.protected != self.protected_other || self.stop_e != self.stop_e_other)
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop asked for on all SI axes.
        pub request: ExternalStop,
        /// `$A_STATSID` bit 28: one channel is protected and one is not.
        pub bit_28: bool,
        /// The channels would stop differently.
        pub bad_mode: bool,
    }
}

monitor! { sinumerik::spl_comparison;
    /// Every cause raises the alarm in its cycle, also in one with RESET.
    cause_raises_the_alarm ["S840D-SPLKDV-003", "S840D-SPLKDV-007", "S840D-SPLKDV-018", "S840D-KDV-727", "S840D-KDV-728"]:
        when |s| s.inputs.found.is_some() || s.inputs.lost
            || (s.inputs.running && (s.inputs.protected != s.inputs.protected_other || s.inputs.stop_e != s.inputs.stop_e_other))
            => s.after.alarm;

    /// With the alarm a protected channel stops, with the stop that it is set to.
    protected_channel_stops ["S840D-SPLKDV-004", "S840D-SPLKDV-020", "S840D-SPL-015", "S840D-KDV-727", "S840D-KDV-728"]:
        when |s| s.inputs.protected && (s.inputs.found.is_some() || s.inputs.lost)
            => s.after.stop && s.outputs.request == if s.inputs.stop_e { ExternalStop::E } else { ExternalStop::D };

    /// A channel that is being commissioned begins no stop.
    commissioning_begins_no_stop ["S840D-SPLKDV-003", "S840D-ALARM-725/a"]:
        when |s| !s.inputs.protected && !s.before.stop
            => !s.after.stop && s.outputs.request == ExternalStop::None;

    /// Settings that do not match are an error only once the comparison runs.
    settings_are_compared ["S840D-SPLKDV-007", "S840D-KDV-727"]:
        when |s| s.inputs.running
            => s.outputs.bit_28 == (s.inputs.protected != s.inputs.protected_other)
                && s.outputs.bad_mode == (s.inputs.stop_e != s.inputs.stop_e_other);

    /// Without a cause nothing is raised.
    no_alarm_without_cause ["S840D-SPLKDV-001", "S840D-SPLKDV-007"]:
        when |s| !s.before.alarm && !s.inputs.found.is_some() && !s.inputs.lost && !s.outputs.bit_28 && !s.outputs.bad_mode
            => s.after == State::INITIAL;

    /// The number of the first error stays until RESET.
    first_error_is_shown ["S840D-SPLKDV-009", "S840D-SPLKDV-017"]:
        when |s| s.before.number.is_some() && !s.inputs.reset && !s.inputs.power_on
            => s.after.number == s.before.number;

    /// Where none is shown the error of this cycle is.
    error_is_shown ["S840D-SPLKDV-009", "S840D-SPLKDV-017"]:
        when |s| !s.before.number.is_some() || s.inputs.reset || s.inputs.power_on
            => s.after.number == s.inputs.found;

    /// Alarm and stop stay without RESET.
    error_is_latched ["S840D-SPLKDV-011"]:
        when |s| s.before.alarm && !s.inputs.reset && !s.inputs.power_on
            => s.after.alarm && (!s.before.stop || s.after.stop);

    /// RESET without a cause clears alarm, number and stop.
    reset_acknowledges ["S840D-SPLKDV-011"]:
        when |s| s.inputs.reset && !s.inputs.found.is_some() && !s.inputs.lost && !s.outputs.bit_28 && !s.outputs.bad_mode
            => s.after == State::INITIAL && s.outputs.request == ExternalStop::None;

    /// The step keeps the invariant, and no stop is asked for but the latched one.
    state_stays_consistent ["S840D-SPLKDV-004"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.stop == (s.outputs.request != ExternalStop::None);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on || inputs.reset {
        State::INITIAL
    } else {
        state
    };
    let raised = inputs.found.is_some() || inputs.mismatch() || inputs.lost;
    let after = State {
        alarm: before.alarm || raised,
        stop: before.stop || (raised && inputs.protected),
        number: if before.number.is_some() {
            before.number
        } else {
            inputs.found
        },
    };
    let request = match (after.stop, inputs.stop_e) {
        (false, _) => ExternalStop::None,
        (true, false) => ExternalStop::D,
        (true, true) => ExternalStop::E,
    };
    let outputs = Outputs {
        request,
        bit_28: inputs.running && inputs.protected != inputs.protected_other,
        bad_mode: inputs.running && inputs.stop_e != inputs.stop_e_other,
    };
    (after, outputs)
}
