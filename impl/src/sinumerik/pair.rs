//! Both channels of one axis, stepped against each other: what one tells, the other one reads in its next cycle.
//!
//! A convenience for simulation, tests and exploration; in a machine each channel runs on its own computer and the
//! [`Exchange`] goes over the drive bus. The pair adds nothing to the two axes but the delay of one
//! cycle, and the limit of the speed setpoint, which the control makes of the selections of both.

use crate::sinumerik::axis::{self, Exchange, Local, Side};
use crate::sinumerik::parameters::Configuration;
use crate::sinumerik::setpoint;

/// The parameters of both channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    nck: axis::Config,
    drive: axis::Config,
}

impl Config {
    /// Both channels with the same machine data, as the copy from the control to the drive makes them.
    pub const fn new(monitors: Configuration) -> Self {
        Self::different(monitors, monitors)
    }

    /// The channels with machine data of their own: a fault of the commissioning, which the comparison finds.
    pub const fn different(nck: Configuration, drive: Configuration) -> Self {
        Self {
            nck: axis::Config::new(Side::Nck, nck),
            drive: axis::Config::new(Side::Drive, drive),
        }
    }

    /// The channel of the control.
    pub const fn nck(&self) -> &axis::Config {
        &self.nck
    }

    /// The channel of the drive.
    pub const fn drive(&self) -> &axis::Config {
        &self.drive
    }
}

/// The state between two cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// The channel of the control.
    pub nck: axis::State,
    /// The channel of the drive.
    pub drive: axis::State,
    /// What the control told in the last cycle.
    pub from_nck: Exchange,
    /// What the drive told in the last cycle.
    pub from_drive: Exchange,
}

impl State {
    /// Both channels switched off, as delivered; nothing told.
    pub fn initial() -> Self {
        Self::default()
    }

    /// Both channels with the state kept through power-off.
    pub fn restored(nck: axis::State, drive: axis::State) -> Self {
        Self {
            nck,
            drive,
            ..Self::default()
        }
    }

    /// The state of both channels is consistent.
    pub fn invariant(&self, config: &Config) -> bool {
        self.nck.invariant(&config.nck) && self.drive.invariant(&config.drive)
    }
}

/// What each channel sees itself in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The channel of the control.
    pub nck: Local,
    /// The channel of the drive.
    pub drive: Local,
}

impl Inputs {
    /// Both channels see the same.
    pub const fn both(local: Local) -> Self {
        Self {
            nck: local,
            drive: local,
        }
    }
}

/// The outputs of both channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The channel of the control.
    pub nck: axis::Outputs,
    /// The channel of the drive.
    pub drive: axis::Outputs,
    /// What the interpolator makes of both selections.
    pub setpoint: setpoint::Outputs,
}

/// The type of [`next`], for code that takes a step function as a parameter.
pub type Next = fn(State, &Config, &Inputs) -> (State, Outputs);

/// One cycle of both channels.
pub fn next(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (nck, nck_out) = axis::next(
        state.nck,
        &config.nck,
        &axis::Inputs {
            local: inputs.nck,
            other: state.from_drive,
        },
    );
    let (drive, drive_out) = axis::next(
        state.drive,
        &config.drive,
        &axis::Inputs {
            local: inputs.drive,
            other: state.from_nck,
        },
    );
    let after = State {
        nck,
        drive,
        from_nck: nck_out.exchange,
        from_drive: drive_out.exchange,
    };
    let (nck_asks, drive_asks) = (&nck_out.channel.selection, &drive_out.channel.selection);
    let (_, setpoint) = setpoint::next(
        setpoint::State::INITIAL,
        config.nck.monitors().setpoint(),
        &setpoint::Inputs {
            nck_goal: nck_asks.goal,
            nck_limit: nck_asks.goal_limit,
            drive_goal: drive_asks.goal,
            drive_limit: drive_asks.goal_limit,
        },
    );
    let outputs = Outputs {
        nck: nck_out,
        drive: drive_out,
        setpoint,
    };
    (after, outputs)
}

/// The pair as an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    config: Config,
    state: State,
}

impl Pair {
    /// A pair in its initial state.
    pub fn new(config: Config) -> Self {
        Self {
            config,
            state: State::initial(),
        }
    }

    /// A pair that starts from a given state.
    ///
    /// # Errors
    /// [`InvalidState`](crate::contract::InvalidState) when a channel's state does not satisfy its invariant.
    pub fn resume(config: Config, state: State) -> Result<Self, crate::contract::InvalidState> {
        if state.invariant(&config) {
            Ok(Self { config, state })
        } else {
            Err(crate::contract::InvalidState)
        }
    }

    /// The present state.
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// Advances both channels by one cycle.
    pub fn step(&mut self, inputs: &Inputs) -> Outputs {
        let (state, outputs) = next(self.state, &self.config, inputs);
        self.state = state;
        outputs
    }
}
