//! Protection against unexpected start-up of one axis group: it has stood for more than 3 s while it was released with the
//! door open in a program mode.
//!
//! The permissive suppresses the reaction, not the count: after a long standstill it must be held until the group moves.

use crate::heidenhain::types::Unit;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// How long the group may stand.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_idle: Cycles,
    }
}

impl Config {
    /// The time of the manual: 3 s in cycles of 3 ms.
    pub const STANDARD: Self = Self {
        t_idle: Cycles::new(1000),
    };

    /// The longest time accepted: 30 s.
    pub const LONGEST: Cycles = Cycles::new(10_000);

    /// `t_idle`: the number of standing cycles after which a standing group is stopped, 1 cycle to [`Config::LONGEST`]. The manual fixes it to 3 s
    /// ([`Config::STANDARD`]).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(t_idle: Cycles) -> Result<Self, ConfigError> {
        if t_idle.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_idle: t_idle.at_most(Self::LONGEST)?,
        })
    }

    /// The time after which a standing group is stopped.
    pub const fn t_idle(&self) -> Cycles {
        self.t_idle
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How long the released group has stood, up to the time of the configuration.
        pub timer: Cycles,
    }
}

impl State {
    /// Not standing.
    pub const INITIAL: Self = Self {
        timer: Cycles::ZERO,
    };

    /// The count ends at the time of the configuration.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_idle
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The group is released with the door open: SLS_2, SLS_3, SLS_4 or SLS_S.
        pub limited: bool,
        /// An axis of the group moves (`NN_AxGrpInMotion`).
        pub moving: bool,
        /// The machine operating mode.
        pub unit: Unit,
        /// A permissive is valid for the group (`PP_AxGrpPB`).
        pub permissive: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The group has stood for too long: SS2.
        pub idle: bool,
    }
}

monitor! { heidenhain::startup;
    /// A group that has stood for the time is stopped as long as it stands, unless a permissive is held.
    long_standstill_stops ["HFS-USTART-001", "HFS-USTART-002", "HFS-USTART-004"]:
        when |s| stands(&s.inputs) && s.before.timer.count() + 1 >= s.config.t_idle.count() && !s.inputs.permissive
            => s.outputs.idle;

    /// Nothing else stops it: not a closed door, another mode, motion, a shorter standstill or a held permissive.
    nothing_else_stops ["HFS-USTART-002", "HFS-USTART-003"]:
        when |s| !stands(&s.inputs) || s.before.timer.count() + 1 < s.config.t_idle.count() || s.inputs.permissive
            => !s.outputs.idle;

    /// Each cycle of standstill counts, up to the limit.
    standstill_is_counted ["HFS-USTART-001"]:
        when |s| stands(&s.inputs)
            => s.after.timer.count() == (s.before.timer.count() + 1).min(s.config.t_idle.count());

    /// Any motion begins the count anew, and so does the end of the release.
    motion_resets_the_count ["HFS-USTART-001"]:
        when |s| !stands(&s.inputs)
            => s.after.timer.is_zero();

    /// The step keeps the invariant.
    state_stays_consistent ["HFS-USTART-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

/// The group stands though it could move: released, door open, program mode.
#[cfg_attr(creusot, creusot_contracts::macros::logic)]
const fn stands(inputs: &Inputs) -> bool {
    inputs.limited && !inputs.moving && matches!(inputs.unit, Unit::Program)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !stands(inputs) {
        return (State::INITIAL, Outputs { idle: false });
    }
    let stood = Cycles::new(state.timer.count().saturating_add(1));
    let timer = stood.min(config.t_idle);
    let idle = timer == config.t_idle && !inputs.permissive;
    (State { timer }, Outputs { idle })
}
