//! Forced dynamic sampling of one pair of inputs: the supplies of its channels are switched off in turn.
//!
//! A supply switched at the end of one cycle acts on what is read in the next.
//!
//! During its own pulse an input must read 0, else a short circuit holds it and it could not report an open contact: SS1. A
//! 0 outside its own pulse is a real one; the other channel watches on during the pulse of the first.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// The length of a pulse and the meaning of the pair.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_low: Cycles,
        emergency: bool,
    }
}

impl Config {
    /// `t_low`: how long a supply is switched off; the manual does not print it. `emergency`: the pair is an emergency stop,
    /// an open contact of which is SS1; others, such as doors, are evaluated elsewhere.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when `t_low` is 0.
    pub const fn new(t_low: Cycles, emergency: bool) -> Result<Self, ConfigError> {
        if t_low.is_zero() {
            Err(ConfigError::NoDelay)
        } else {
            Ok(Self { t_low, emergency })
        }
    }
}

fields! {
    /// Where the test is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Pulse {
        /// No test.
        #[default]
        None,
        /// The supply of the inputs of channel A is off.
        ALow,
        /// It is back on.
        ABack,
        /// The supply of the inputs of channel B is off.
        BLow,
        /// It is back on.
        BBack,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the test is.
        pub pulse: Pulse,
        /// What is left of the pulse, else 0.
        pub timer: Cycles,
    }
}

impl State {
    /// No test.
    pub const INITIAL: Self = Self {
        pulse: Pulse::None,
        timer: Cycles::ZERO,
    };

    /// Time is left exactly during a pulse.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        matches!(self.pulse, Pulse::ALow | Pulse::BLow) != self.timer.is_zero()
            && self.timer <= config.t_low
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// A test is due.
        pub due: bool,
        /// The contact of channel A is closed: the good state.
        pub contact_a: bool,
        /// The contact of channel B is closed.
        pub contact_b: bool,
        /// A short circuit to 24 V holds input A.
        pub stuck_a: bool,
        /// A short circuit to 24 V holds input B.
        pub stuck_b: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What input A reads in this cycle.
        pub reads_a: bool,
        /// What input B reads.
        pub reads_b: bool,
        /// A contact is open: an input reads 0 outside its own pulse.
        pub opened: bool,
        /// An input stays 1 without its supply.
        pub short: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::sampling;
    /// An open contact that no short circuit hides is seen in the same cycle unless its own pulse runs: during a pulse the
    /// other channel sees it.
    open_contact_is_seen ["HFS-ARCH-004/g", "HFS-P-07", "HFS-DYN-001", "HFS-ES-004"]:
        when |s| (!s.inputs.contact_a && !s.inputs.stuck_a && s.before.pulse != Pulse::ALow)
            || (!s.inputs.contact_b && !s.inputs.stuck_b && s.before.pulse != Pulse::BLow)
            => s.outputs.opened && (s.outputs.demand == Stop::Ss1 || !s.config.emergency);

    /// So with both contacts open one channel sees it in every cycle of the test.
    emergency_stop_is_seen_in_every_pulse ["HFS-P-07", "HFS-ES-001", "HFS-ES-004"]:
        when |s| s.config.emergency && !s.inputs.contact_a && !s.inputs.contact_b
            && !s.inputs.stuck_a && !s.inputs.stuck_b
            => s.outputs.demand == Stop::Ss1;

    /// A pulse is never taken for an open contact.
    pulse_is_no_open_contact ["HFS-DYN-001"]:
        when |s| s.inputs.contact_a && s.inputs.contact_b
            => !s.outputs.opened;

    /// An input that stays 1 without its supply is stopped by SS1.
    short_circuit_is_stopped ["HFS-FAULT-012", "HFS-IO-003"]:
        when |s| (s.before.pulse == Pulse::ALow && s.inputs.stuck_a) || (s.before.pulse == Pulse::BLow && s.inputs.stuck_b)
            => s.outputs.short && s.outputs.demand == Stop::Ss1;

    /// With closed contacts and without a short circuit nothing is raised.
    good_input_passes ["HFS-FAULT-012"]:
        when |s| !s.inputs.stuck_a && !s.inputs.stuck_b
            => !s.outputs.short
                && (s.outputs.demand == Stop::None || (s.config.emergency && s.outputs.opened));

    /// Without its supply an input without short circuit reads 0, with it what its contact is.
    inputs_read_their_contacts ["HFS-DYN-001", "HFS-KDV-003"]:
        when |s| !s.inputs.stuck_a && !s.inputs.stuck_b
            => s.outputs.reads_a == (s.inputs.contact_a && s.before.pulse != Pulse::ALow)
                && s.outputs.reads_b == (s.inputs.contact_b && s.before.pulse != Pulse::BLow);

    /// A test that is due begins with channel A.
    test_begins_with_channel_a ["HFS-DYN-001", "HFS-ES-004"]:
        when |s| s.before.pulse == Pulse::None
            => s.after == if s.inputs.due {
                State { pulse: Pulse::ALow, timer: s.config.t_low }
            } else {
                State::INITIAL
            };

    /// A pulse lasts its time; then the supply is back, and then it is the turn of the other channel.
    channels_are_tested_in_turn ["HFS-DYN-001", "HFS-ES-004"]:
        when |s| s.before.pulse != Pulse::None
            => match s.before.pulse {
                Pulse::None => false,
                Pulse::ALow if s.before.timer.count() > 1 => s.after.pulse == Pulse::ALow,
                Pulse::ALow => s.after.pulse == Pulse::ABack,
                Pulse::ABack => s.after == State { pulse: Pulse::BLow, timer: s.config.t_low },
                Pulse::BLow if s.before.timer.count() > 1 => s.after.pulse == Pulse::BLow,
                Pulse::BLow => s.after.pulse == Pulse::BBack,
                Pulse::BBack => s.after == State::INITIAL,
            };

    /// The state stays consistent, and the time of a pulse runs.
    state_stays_consistent ["HFS-DYN-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && (s.after.pulse != s.before.pulse || s.after.timer == s.before.timer.tick());
}

impl State {
    /// The state one cycle later.
    fn advanced(self, config: &Config, due: bool) -> Self {
        let low = |pulse| Self {
            pulse,
            timer: config.t_low,
        };
        let timer = self.timer.tick();
        match self.pulse {
            Pulse::None if due => low(Pulse::ALow),
            Pulse::None | Pulse::BBack => Self::INITIAL,
            Pulse::ALow if timer.is_zero() => Self {
                pulse: Pulse::ABack,
                timer,
            },
            Pulse::BLow if timer.is_zero() => Self {
                pulse: Pulse::BBack,
                timer,
            },
            Pulse::ALow | Pulse::BLow => Self { timer, ..self },
            Pulse::ABack => low(Pulse::BLow),
        }
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = state.advanced(config, inputs.due);
    let (low_a, low_b) = (state.pulse == Pulse::ALow, state.pulse == Pulse::BLow);
    let reads_a = inputs.stuck_a || (inputs.contact_a && !low_a);
    let reads_b = inputs.stuck_b || (inputs.contact_b && !low_b);
    let short = (low_a && reads_a) || (low_b && reads_b);
    let opened = (!reads_a && !low_a) || (!reads_b && !low_b);
    let outputs = Outputs {
        reads_a,
        reads_b,
        opened,
        short,
        demand: if short || (opened && config.emergency) {
            Stop::Ss1
        } else {
            Stop::None
        },
    };
    (after, outputs)
}
