//! -STO.A.G while one axis has lost its torque by SS0 and all others brake by SS1F: they need their torque, so the signal for
//! all falls when they have ended, and after SMP2172 at the latest. The axis itself loses its torque at once, by -STO.A.x and
//! -STO.B.x (see [`crate::heidenhain::stop`]).
//!
//! -STO.A.G is also the path by which the MC closes all brakes together (HFS-SBC-002).
//!
//! Recommended readings of the manual implemented here: AMB-65 SS0_GLOBAL_AT_END.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The time of the others.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_off: Cycles,
    }
}

impl Config {
    /// The longest time: 60 s in cycles of 3 ms.
    pub const LONGEST: Cycles = Cycles::new(20_000);

    /// `t_off`: SMP2172, as [`crate::heidenhain::parameters`] converts it (its 0 is 3 s).
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
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// -STO.A.G is 1.
        pub on: bool,
        /// What is left of SMP2172, 0 where it does not run.
        pub timer: Cycles,
    }
}

impl State {
    /// The drives are on, none in SS0.
    pub const INITIAL: Self = Self {
        on: true,
        timer: Cycles::ZERO,
    };

    /// The time runs only while the signal is on.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_off && (self.on || self.timer.is_zero())
    }
}

impl Default for State {
    fn default() -> Self {
        Self::INITIAL
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// An axis is in SS0.
        pub ss0: bool,
        /// The SS1F of all others has ended.
        pub others_off: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// -STO.A.G is 1: power modules enabled, brakes supplied.
        pub on: bool,
    }
}

monitor! { heidenhain::global_sto;
    /// The others keep their torque while they brake, until SMP2172 is over.
    others_brake_first ["HFS-SS0-006"]:
        when |s| s.before.on && s.inputs.ss0 && !s.inputs.others_off && s.before.timer.count() != 1
            => s.outputs.on && !s.after.timer.is_zero();

    /// When they have ended the signal falls in the same cycle, and with it the supply of all brakes.
    end_of_the_others_takes_it ["HFS-SS0-006", "HFS-SBC-002"]:
        when |s| s.inputs.ss0 && s.inputs.others_off
            => !s.outputs.on;

    /// It falls after SMP2172 at the latest: the time is lower in each cycle, and its last one takes the signal.
    smp2172_takes_it ["HFS-SS0-006", "HFS-PARAM-021"]:
        when |s| s.before.on && s.inputs.ss0 && !s.before.timer.is_zero()
            => !s.outputs.on || s.after.timer < s.before.timer;

    /// The whole time counts from the SS0 on.
    time_begins_with_the_ss0 ["HFS-SS0-006", "HFS-PARAM-021"]:
        when |s| s.before.on && s.inputs.ss0 && !s.inputs.others_off && s.before.timer.is_zero()
            => s.after.timer == s.config.t_off;

    /// What has fallen stays so until the main switch.
    off_until_the_main_switch ["HFS-SS0-005", "HFS-SS0-006"]:
        when |s| !s.before.on
            => !s.outputs.on;

    /// Without an SS0 the signal does not fall here.
    nothing_else_takes_it ["HFS-SS0-006"]:
        when |s| s.before.on && !s.inputs.ss0
            => s.outputs.on && s.after.timer.is_zero();

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-SS0-006"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.on == s.after.on;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let waits = state.on && inputs.ss0;
    let last = state.timer.count() == 1;
    let on = state.on && !(inputs.ss0 && (inputs.others_off || last));
    let timer = match waits && on {
        true if state.timer.is_zero() => config.t_off,
        true => state.timer.tick(),
        false => Cycles::ZERO,
    };
    (State { on, timer }, Outputs { on })
}
