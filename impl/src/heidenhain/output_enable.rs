//! `NN_GenOutputEnable`: the permission for all outputs of the safe PLC that trigger or permit motion.
//!
//! It goes at the beginning of an SS0, and at the standstill of an SS1F or of an SS1 by an external emergency stop, at the
//! latest after SMP2172. An SS1 for any other reason leaves it.
//!
//! Recommended readings of the manual implemented here: AMB-63 (off until the self-test has passed), AMB-71
//! STANDSTILL_OR_2172.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// How long the outputs may stay on during a stop.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_off: Cycles,
    }
}

impl Config {
    /// The longest time: 60 s in cycles of 3 ms.
    pub const LONGEST: Cycles = Cycles::new(20_000);

    /// `t_off`: the time after which the outputs are off in any case (SMP2172), 1 cycle to [`Config::LONGEST`].
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(t_off: Cycles) -> Result<Self, ConfigError> {
        if t_off.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_off: t_off.at_most(Self::LONGEST)?,
        })
    }

    /// The same from the value of SMP2172: 0 to 60 seconds, where 0 means 3 s. Rounded down to cycles of 3 ms: the outputs
    /// go rather earlier.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above 60.
    pub fn from_smp2172(seconds: u8) -> Result<Self, ConfigError> {
        let seconds = if seconds == 0 { 3 } else { seconds };
        let cycles = (u32::from(seconds) * 1000) / 3;
        Self::new(Cycles::new(cycles))
    }

    /// The time after which the outputs are off in any case.
    pub const fn t_off(&self) -> Cycles {
        self.t_off
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The permission.
        pub enabled: bool,
        /// What is left until the permission goes in any case; 0 where nothing takes it.
        pub timer: Cycles,
    }
}

impl State {
    /// No permission before the self-test.
    pub const INITIAL: Self = Self {
        enabled: false,
        timer: Cycles::ZERO,
    };

    /// A timer runs only towards the end of the permission.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_off && (self.enabled || self.timer.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The self-test has passed and the drives are switched on.
        pub ready: bool,
        /// The highest stop of the machine.
        pub stop: Stop,
        /// An SS1 in force is due to an external emergency stop, that of a handwheel included.
        pub emergency: bool,
        /// All axes and spindles stand still.
        pub still: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `NN_GenOutputEnable`.
        pub enabled: bool,
    }
}

monitor! { heidenhain::output_enable;
    /// SS0 takes the permission at its beginning.
    ss0_takes_it_at_once ["HFS-P-34", "HFS-SS0-003/c", "HFS-API-032"]:
        when |s| s.inputs.stop == Stop::Ss0
            => !s.outputs.enabled;

    /// SS1F and an SS1 by an external emergency stop take it at standstill.
    standstill_takes_it ["HFS-P-34", "HFS-SS1-009", "HFS-SS1F-004", "HFS-API-032"]:
        when |s| takes(&s.inputs) && s.inputs.still
            => !s.outputs.enabled;

    /// They take it at the latest after SMP2172: each cycle before, its timer is lower.
    deadline_takes_it ["HFS-P-34", "HFS-API-039"]:
        when |s| takes(&s.inputs) && s.before.enabled && s.before.timer > Cycles::ZERO
            => !s.outputs.enabled || s.after.timer < s.before.timer;

    /// The deadline counts from the beginning of the stop.
    deadline_counts_from_the_stop ["HFS-API-039"]:
        when |s| takes(&s.inputs) && s.before.enabled && s.before.timer == Cycles::ZERO && !s.inputs.still
            => s.outputs.enabled && s.after.timer == s.config.t_off;

    /// Nothing else takes it, not an SS1 for another reason, nor SS2.
    nothing_else_takes_it ["HFS-P-33", "HFS-P-34", "HFS-SS1-009", "HFS-API-032"]:
        when |s| s.before.enabled && !takes(&s.inputs) && s.inputs.stop != Stop::Ss0
            => s.outputs.enabled && s.after.timer == Cycles::ZERO;

    /// It comes with the restart only, while no such stop is in force.
    restart_gives_it ["HFS-P-34", "HFS-API-032"]:
        when |s| !s.before.enabled
            => s.outputs.enabled == (s.inputs.ready && !takes(&s.inputs) && s.inputs.stop != Stop::Ss0);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-P-34"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.enabled == s.after.enabled;
}

/// A stop is in force whose end takes the permission.
#[cfg_attr(creusot, creusot_contracts::macros::logic)]
const fn takes(inputs: &Inputs) -> bool {
    matches!(inputs.stop, Stop::Ss1F) || (matches!(inputs.stop, Stop::Ss1) && inputs.emergency)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.stop == Stop::Ss0 {
        State::INITIAL
    } else if !takes(inputs) {
        State {
            enabled: state.enabled || inputs.ready,
            timer: Cycles::ZERO,
        }
    } else if !state.enabled || inputs.still || state.timer == Cycles::new(1) {
        State::INITIAL
    } else {
        let running = !state.timer.is_zero();
        State {
            enabled: true,
            timer: if running {
                state.timer.tick()
            } else {
                config.t_off
            },
        }
    };
    let enabled = after.enabled;
    (after, Outputs { enabled })
}
