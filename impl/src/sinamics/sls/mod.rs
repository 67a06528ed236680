//! Safely limited speed (SLS) of one channel, with encoder or with SAM (p9506 = 0, 2, 3): four levels, one speed limit each.
//!
//! A lower limit takes effect after p9551, a higher one at once; until then the old one is monitored. The limit of level 1 may come
//! from the telegram (p9501.24); the limit of a value that is none is 0, for the manual names only its stop. Without selection (p9512.4) level 1 is
//! monitored for ever. With SBR and no encoder (p9506 = 1) see [`crate::sinamics::sls_ramp`].
//!
//! A stop that the function has raised ends in SOS: then its status goes off and nothing is compared, until SOS lets go.
//! Reading AF-30 is a choice of the configuration, the recommended one first.

mod laws;
mod setting;

pub use laws::*;
pub use setting::{Level, Request, Slsd};
pub(in crate::sinamics) use setting::{WHOLE, asked};

use crate::kernel::{ConfigError, Cycles, Speed};
use crate::sinamics::types::Stop;

config! {
    /// The parameters; speeds in increments per cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        limits: [Speed; 4],
        responses: [Stop; 4],
        delay: Cycles,
        encoder: bool,
        by_telegram: bool,
        unselected: bool,
        slsd: Slsd,
    }
}

impl Config {
    /// `limits`: p9531. `responses`: p9563. `delay`: p9551, of a selection and of a lower level, the same as that of SOS
    /// (S120-SLS-500). `encoder`: p9506 is 0 or 2. `by_telegram`: p9501.24. `unselected`: p9512.4.
    ///
    /// # Errors
    /// [`ConfigError::StopNotAllowed`] for a response that is none, or none without encoder (S120-SLS-014).
    pub fn new(
        limits: [Speed; 4],
        responses: [Stop; 4],
        delay: Cycles,
        encoder: bool,
        by_telegram: bool,
        unselected: bool,
        slsd: Slsd,
    ) -> Result<Self, ConfigError> {
        if !responses.iter().all(|stop| stop.allowed(encoder)) {
            return Err(ConfigError::StopNotAllowed);
        }
        Ok(Self {
            limits,
            responses,
            delay,
            encoder,
            by_telegram,
            unselected,
            slsd,
        })
    }

    /// The limit of a level, as a parameter.
    pub const fn limit(&self, level: Level) -> Speed {
        level.of(self.limits)
    }

    /// The limit that is asked for, at once, whatever is monitored: what the setpoint is limited by (S120-SLS-008).
    pub fn asked(&self, inputs: &Inputs) -> Speed {
        setting::request(self, inputs).0.limit
    }

    /// The stop of a level.
    pub const fn response(&self, level: Level) -> Stop {
        level.of(self.responses)
    }
}

fields! {
    /// What SLS does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// Selected; nothing is monitored yet.
        Delay,
        /// A limit is monitored.
        Active,
        /// A limit is monitored, a lower one waits for its delay.
        Lower,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What SLS does.
        pub phase: Phase,
        /// What is left of the delay.
        pub left: Cycles,
        /// The monitored level and its limit; level 1 with limit 0 while nothing is monitored.
        pub now: Request,
        /// The level and limit that wait; level 1 with limit 0 while none does.
        pub next: Request,
    }
}

impl State {
    /// Not selected.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        now: Request::NONE,
        next: Request::NONE,
    };

    /// A delay runs where something waits for it; what waits is lower than what is monitored; without selection nothing waits.
    pub fn invariant(&self, config: &Config) -> bool {
        let waits = !self.left.is_zero() && self.left <= config.delay;
        let fits = match self.phase {
            Phase::Idle => *self == Self::INITIAL,
            Phase::Delay => waits && self.now == Request::NONE && self.next == Request::NONE,
            Phase::Active => self.left.is_zero() && self.next == Request::NONE,
            Phase::Lower => {
                waits
                    && self.next.limit < self.now.limit
                    && self.next.limit <= config.limit(self.next.level)
            }
        };
        let forever = self.phase == Phase::Idle || self.phase == Phase::Active;
        fits && self.now.limit <= config.limit(self.now.level) && (!config.unselected || forever)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SLS is selected.
        pub selected: bool,
        /// The selected level: bits 9 and 10 of the control word.
        pub level: Level,
        /// S_SLS_LIMIT_A: the limit of level 1 in 32767ths of p9531[0].
        pub telegram: i16,
        /// A drive without encoder is switched on.
        pub drive_on: bool,
        /// SOS acts after a stop C, D or E.
        pub sos_after_stop: bool,
        /// Magnitude of the actual speed of the load.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SLS is active (r9722.4): a limit is monitored.
        pub active: bool,
        /// The monitored level (r9722.9, r9722.10); the first one while none is.
        pub level: Level,
        /// The monitored limit (r9714\[2\]); 0 while none is.
        pub limit: Speed,
        /// The speed is above it: C01714.
        pub violated: bool,
        /// The limit of the telegram is none: C01711 with value 1041.
        pub wrong_value: bool,
        /// The stop that is raised.
        pub demand: Stop,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let on = if config.unselected {
        config.encoder || inputs.drive_on
    } else {
        inputs.selected
    };
    if !on {
        return (State::INITIAL, Outputs::default());
    }
    let (request, wrong_value) = setting::request(config, inputs);
    let after = setting::next(&state, config, request);
    let monitored = matches!(after.phase, Phase::Active | Phase::Lower);
    let active = monitored && !inputs.sos_after_stop;
    let violated = active && inputs.speed > after.now.limit;
    let own = if violated {
        config.response(after.now.level)
    } else {
        Stop::None
    };
    let wrong = if wrong_value {
        config.response(Level::FIRST)
    } else {
        Stop::None
    };
    let shown = if active { after.now } else { Request::NONE };
    let outputs = Outputs {
        active,
        level: shown.level,
        limit: shown.limit,
        violated,
        wrong_value,
        demand: own.max(wrong),
    };
    (after, outputs)
}

#[cfg(test)]
mod tests;
