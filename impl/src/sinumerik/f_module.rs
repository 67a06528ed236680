//! Data and faults of one F module on PROFIsafe (machine `f_module`), for a sub-slot of 32 bits.
//!
//! One call is one interpolator cycle. The data for the module are formed only where the clock ([`f_master`](super::f_master))
//! starts OB40, from both channels of the safe logic; a bit is 1 where both have it. In between they stay, whatever the channels
//! do. What the module sends is one value, which both channels get. What it reports as faulty is 0 at once in both channels, and
//! the axes are stopped; after RESET with the fault gone the signal comes back.
//!
//! Which bit is which variable of the safe logic: [`net_data`](super::net_data). What the module does by itself when telegrams
//! stay away is a matter of its F monitoring time, outside.
//!
//! Reading: B-42 INSE_AFTER_RESET.

use crate::kernel::ConfigError;

config! {
    /// The sub-slot.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        bits: u8,
    }
}

impl Config {
    /// `bits`: how many of the sub-slot are net data of the module, 1 to 32 (S840D-PSAFE-009).
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] for another number.
    pub const fn new(bits: u8) -> Result<Self, ConfigError> {
        if bits == 0 || bits > 32 {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self { bits })
    }

    /// The bits that are net data.
    const fn mask(&self) -> u32 {
        if self.bits >= 32 {
            u32::MAX
        } else {
            !(u32::MAX << self.bits)
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the safe logic sees of the module's inputs.
        pub shown: u32,
        /// The inputs that wait for RESET at 0.
        pub blocked: u32,
        /// The data for the module.
        pub net: u32,
        /// Alarm 27251: communication error of the module.
        pub a_failed: bool,
        /// Alarm 27252: no sign of life of its slave.
        pub a_life: bool,
        /// Alarm 27254: fault of a channel.
        pub a_channel: bool,
        /// Alarm 27255: general error.
        pub a_general: bool,
    }
}

impl State {
    /// Power-on: everything is 0 (S840D-PSAFE-048).
    pub const INITIAL: Self = Self {
        shown: 0,
        blocked: 0,
        net: 0,
        a_failed: false,
        a_life: false,
        a_channel: false,
        a_general: false,
    };

    /// What is blocked is 0; nothing lies outside the net data.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.shown & self.blocked == 0
            && (self.shown | self.blocked | self.net) & !config.mask() == 0
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
        /// OB40 is started in this cycle.
        pub trigger: bool,
        /// There is no F communication until power-on.
        pub stopped: bool,
        /// The F net data of the module, as they are in the last valid telegram.
        pub received: u32,
        /// What the NCK's logic writes to the outputs.
        pub outse: u32,
        /// What the PLC's logic writes to them.
        pub outsep: u32,
        /// The communication with the module has an error: timeout, CRC, sequence, synchronism of NCK and PLC, empty
        /// telegrams.
        pub failed: bool,
        /// The DP slave of the module shows no sign of life.
        pub lifeless: bool,
        /// The input channels that the module reports as faulty.
        pub bad: u32,
        /// It reports an output channel, or itself (channel 0), as faulty.
        pub bad_output: bool,
        /// It reports a general error.
        pub general: bool,
    }
}

impl Inputs {
    /// The inputs whose signal is worth nothing in this cycle.
    const fn worthless(&self, config: &Config) -> u32 {
        if self.failed || self.lifeless || self.stopped {
            config.mask()
        } else {
            self.bad & config.mask()
        }
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The inputs for the NCK's logic.
        pub inse: u32,
        /// The inputs for the PLC's logic.
        pub insep: u32,
        /// STOP D or E of all safety axes.
        pub stop: bool,
        /// Mode group and channel not ready, no NC start, NC stop.
        pub inhibit: bool,
    }
}

monitor! { sinumerik::f_module;
    /// Where OB40 is started a bit of the data for the module is 1 exactly where both channels have it.
    both_channels_or_nothing ["S840D-PSAFE-003", "S840D-PSAFE-007", "S840D-PSAFE-051", "S840D-P-01"]:
        when |s| s.inputs.trigger && !s.inputs.power_on
            => s.after.net == s.inputs.outse & s.inputs.outsep & s.config.mask();

    /// Between two starts the data for the module stay as they were formed.
    data_are_constant_between ["S840D-PSAFE-050", "S840D-PSAFE-051", "S840D-P-01"]:
        when |s| !s.inputs.trigger && !s.inputs.power_on
            => s.after.net == s.before.net;

    /// A bit that one channel holds at 0 where OB40 is started is 0, whatever the other says.
    one_channel_switches_off ["S840D-PSAFE-003", "S840D-PSAFE-049", "S840D-PSAFE-716"]:
        when |s| s.inputs.trigger
            => s.after.net & !s.inputs.outse == 0 && s.after.net & !s.inputs.outsep == 0;

    /// Both channels see the same inputs.
    channels_see_the_same ["S840D-PSAFE-001", "S840D-PSAFE-002", "S840D-PSAFE-004", "S840D-PSAFE-716", "S840D-DIAG-705"]:
        when |s| s.after.shown != 0 || s.before.shown != 0
            => s.outputs.inse == s.after.shown && s.outputs.insep == s.after.shown;

    /// A fault that is reported clears its inputs in both channels in the same cycle.
    fault_clears_its_inputs ["S840D-PSAFE-048", "S840D-PSAFE-716", "S840D-P-31"]:
        when |s| s.inputs.bad != 0 && !s.inputs.power_on
            => s.outputs.inse & s.inputs.bad == 0 && s.outputs.insep & s.inputs.bad == 0;

    /// Without communication every input is 0 in both channels.
    no_communication_clears_all ["S840D-PSAFE-018", "S840D-PSAFE-019", "S840D-PSAFE-048", "S840D-P-31"]:
        when |s| s.inputs.failed || s.inputs.lifeless || s.inputs.stopped
            => s.outputs.inse == 0 && s.outputs.insep == 0;

    /// Errors of the communication and of channels stop the axes.
    faults_stop_the_axes ["S840D-PSAFE-018", "S840D-PSAFE-019", "S840D-PSAFE-021", "S840D-PSAFE-024",
        "S840D-PSAFE-704", "S840D-PSAFE-716", "S840D-P-31", "S840D-DIAG-705"]:
        when |s| (s.inputs.failed || s.inputs.lifeless || s.inputs.bad != 0 || s.inputs.bad_output) && !s.inputs.power_on
            => s.outputs.stop && s.outputs.inhibit
                && s.after.a_failed >= s.inputs.failed && s.after.a_life >= s.inputs.lifeless
                && s.after.a_channel >= (s.inputs.bad != 0 || s.inputs.bad_output);

    /// The stop waits for RESET.
    stop_waits_for_reset ["S840D-PSAFE-018", "S840D-PSAFE-019", "S840D-PSAFE-021", "S840D-PSAFE-704"]:
        when |s| (s.before.a_failed || s.before.a_life || s.before.a_channel) && !s.inputs.reset && !s.inputs.power_on
            => s.outputs.stop && s.after.a_failed >= s.before.a_failed && s.after.a_life >= s.before.a_life
                && s.after.a_channel >= s.before.a_channel;

    /// RESET with the fault gone ends it.
    reset_ends_what_has_gone ["S840D-PSAFE-018", "S840D-PSAFE-019", "S840D-PSAFE-021", "S840D-PSAFE-704"]:
        when |s| s.inputs.reset
            => s.after.a_failed <= s.inputs.failed && s.after.a_life <= s.inputs.lifeless
                && s.after.a_channel <= (s.inputs.bad != 0 || s.inputs.bad_output)
                && s.after.a_general <= s.inputs.general && s.after.blocked & !s.inputs.worthless(&s.config) == 0;

    /// A general error stops the program, waits for RESET, and asks for no stop of the axes.
    general_error_stops_the_program ["S840D-PSAFE-022", "S840D-PSAFE-705"]:
        when |s| !s.inputs.power_on && (s.inputs.general || (s.before.a_general && !s.inputs.reset))
            => s.after.a_general && s.outputs.inhibit
                && s.outputs.stop == (s.after.a_failed || s.after.a_life || s.after.a_channel);

    /// An input at 0 rises only where OB40 is started, from the telegram, and not while it is faulty.
    inputs_rise_from_telegrams ["S840D-PSAFE-001", "S840D-PSAFE-048"]:
        when |s| s.after.shown & !s.before.shown != 0
            => s.inputs.trigger && s.after.shown & !s.inputs.received == 0 && s.after.shown & s.inputs.worthless(&s.config) == 0;

    /// What a fault has cleared stays 0 until RESET.
    cleared_until_reset ["S840D-PSAFE-048"]:
        when |s| s.before.blocked != 0 && !s.inputs.reset && !s.inputs.power_on
            => s.after.blocked & s.before.blocked == s.before.blocked && s.outputs.inse & s.before.blocked == 0;

    /// What is not blocked is as the module has sent it.
    healthy_inputs_are_taken_over ["S840D-PSAFE-001", "S840D-PSAFE-004"]:
        when |s| s.inputs.trigger && !s.inputs.power_on
            => s.after.shown == s.inputs.received & s.config.mask() & !s.after.blocked
                && s.after.blocked & !(s.before.blocked | s.inputs.worthless(&s.config)) == 0;

    /// Power-on: everything is 0, nothing is asked for.
    power_on_begins_anew ["S840D-PSAFE-048"]:
        when |s| s.inputs.power_on
            => s.after == State::INITIAL && !s.outputs.stop && !s.outputs.inhibit && s.outputs.inse == 0;

    /// Without an alarm the outputs ask for nothing.
    no_alarm_no_reaction ["S840D-PSAFE-022", "S840D-PSAFE-024"]:
        when |s| !(s.after.a_failed || s.after.a_life || s.after.a_channel)
            => !s.outputs.stop && s.outputs.inhibit == s.after.a_general;

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-PSAFE-048"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.power_on {
        State::INITIAL
    } else {
        cycle(state, config, inputs)
    };
    let stop = after.a_failed || after.a_life || after.a_channel;
    let outputs = Outputs {
        inse: after.shown,
        insep: after.shown,
        stop,
        inhibit: stop || after.a_general,
    };
    (after, outputs)
}

/// A cycle without power-on.
const fn cycle(state: State, config: &Config, inputs: &Inputs) -> State {
    let kept = if inputs.reset {
        State {
            shown: state.shown,
            net: state.net,
            ..State::INITIAL
        }
    } else {
        state
    };
    let blocked = kept.blocked | inputs.worthless(config);
    let (seen, net) = if inputs.trigger {
        (
            inputs.received & config.mask(),
            inputs.outse & inputs.outsep & config.mask(),
        )
    } else {
        (kept.shown, kept.net)
    };
    State {
        shown: seen & !blocked,
        blocked,
        net,
        a_failed: kept.a_failed || inputs.failed,
        a_life: kept.a_life || inputs.lifeless,
        a_channel: kept.a_channel || inputs.bad != 0 || inputs.bad_output,
        a_general: kept.a_general || inputs.general,
    }
}
