//! Safe brake test (SBT): the sequence of one drive (machine B13).
//!
//! Selected, the drive measures the load with its brakes open. Started, it closes the brake that was chosen, builds up a test torque
//! against it, holds it and takes it back; a brake that lets the axis move has failed. Which brake, sign and sequence is taken at the
//! start and not again (S120-SBT-500). A sequence that was interrupted ends in `Ended`, which only the deselection leaves.
//!
//! The torque itself and the load are the controller's business. Readings: AF-26 SBT_FB_BOTH; a brake of the motor has no feedback and
//! is given its opening and closing times; an external one is asked, and has 11 s.

mod laws;

pub use laws::*;

use crate::kernel::{ConfigError, Cycles, Distance, Position};
use crate::sinamics::types::rises;

fields! {
    /// p10202: what a brake is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Kind {
        /// There is none, or it is not tested.
        #[default]
        None,
        /// The motor holding brake, which the drive controls.
        Motor,
        /// An external brake, which the control closes and opens when asked to.
        External,
    }
}

fields! {
    /// A test sequence.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Sequence {
        /// p10211 or p10221: how long the torque is held.
        pub duration: Cycles,
        /// p10212 or p10222: by how far the axis may move.
        pub tolerance: Distance,
    }
}

fields! {
    /// A brake and its tests.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Brake {
        /// p10202.
        pub kind: Kind,
        /// p10208: how long the torque takes to be built up, and to be taken back.
        pub ramp: Cycles,
        /// Sequence 1.
        pub first: Sequence,
        /// Sequence 2.
        pub second: Sequence,
    }
}

impl Brake {
    /// Each part of a test takes its time.
    const fn fits(&self) -> bool {
        !self.ramp.is_zero() && !self.first.duration.is_zero() && !self.second.duration.is_zero()
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        first: Brake,
        second: Brake,
        external: Cycles,
        opening: Cycles,
        closing: Cycles,
    }
}

impl Config {
    /// `first`, `second`: the brakes. `external`: 11 s, the time for an external brake to follow. `opening`: p1216, `closing`: p1217 of the
    /// motor holding brake.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0, [`ConfigError::ValueOutOfRange`] for two motor holding brakes (S120-SBT-002).
    pub const fn new(
        first: Brake,
        second: Brake,
        external: Cycles,
        opening: Cycles,
        closing: Cycles,
    ) -> Result<Self, ConfigError> {
        let times = !external.is_zero() && !opening.is_zero() && !closing.is_zero();
        if !(times && first.fits() && second.fits()) {
            return Err(ConfigError::NoDelay);
        }
        if matches!((first.kind, second.kind), (Kind::Motor, Kind::Motor)) {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self {
            first,
            second,
            external,
            opening,
            closing,
        })
    }

    /// One of the brakes.
    pub const fn brake(&self, second: bool) -> &Brake {
        if second { &self.second } else { &self.first }
    }

    /// There is an external brake.
    pub fn has_external(&self) -> bool {
        self.first.kind == Kind::External || self.second.kind == Kind::External
    }
}

fields! {
    /// Where the test is, in the order of a sequence.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Phase {
        /// Not selected, or refused.
        #[default]
        Idle,
        /// The load is measured, external brakes open.
        Measure,
        /// A sequence may be started.
        Ready,
        /// The brake closes.
        Close,
        /// The torque is built up.
        RampUp,
        /// The torque is held.
        Hold,
        /// It is taken back.
        RampDown,
        /// The brake opens.
        Open,
        /// The sequence is complete.
        Result,
        /// It was interrupted or failed by a fault.
        Ended,
    }
}

impl Phase {
    /// A sequence runs (r10234.3).
    pub fn runs(self) -> bool {
        (Self::Close..=Self::Open).contains(&self)
    }

    /// The torque acts against the brake.
    pub fn torque(self) -> bool {
        matches!(self, Self::RampUp | Self::Hold | Self::RampDown)
    }

    /// The brake under test is to be closed.
    pub fn closed(self) -> bool {
        self == Self::Close || self.torque()
    }
}

fields! {
    /// What a sequence tests.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Choice {
        /// Brake 2 (r10231.2).
        pub second_brake: bool,
        /// Negative torque (r10231.3).
        pub negative: bool,
        /// Sequence 2 (r10231.4).
        pub second_sequence: bool,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the test is.
        pub phase: Phase,
        /// What is left of the time of the phase.
        pub left: Cycles,
        /// What the last sequence tests.
        pub choice: Choice,
        /// Where the axis stood when the torque began; 0 while there is none.
        pub begin: Position,
        /// The brake has held so far.
        pub good: bool,
        /// The selection in the cycle before.
        pub select_held: bool,
        /// The start in the cycle before.
        pub start_held: bool,
    }
}

impl State {
    /// Not selected; signals count once they have been 0.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        choice: Choice {
            second_brake: false,
            negative: false,
            second_sequence: false,
        },
        begin: Position(0),
        good: false,
        select_held: true,
        start_held: true,
    };

    /// The time of the phase that the state is in; none where it has none.
    fn time(&self, config: &Config) -> Cycles {
        let brake = config.brake(self.choice.second_brake);
        let sequence = if self.choice.second_sequence {
            brake.second
        } else {
            brake.first
        };
        let moves = |motor| match brake.kind {
            Kind::External => config.external,
            _ => motor,
        };
        match self.phase {
            Phase::Measure => config.external,
            Phase::Close => moves(config.closing),
            Phase::Open => moves(config.opening),
            Phase::RampUp | Phase::RampDown => brake.ramp,
            Phase::Hold => sequence.duration,
            Phase::Idle | Phase::Ready | Phase::Result | Phase::Ended => Cycles::ZERO,
        }
    }

    /// Times, positions and choices belong to their phases; what is selected was not deselected; a brake that is tested exists.
    pub fn invariant(&self, config: &Config) -> bool {
        let time = self.time(config);
        let timed = if self.phase == Phase::Measure {
            self.left <= time
        } else {
            self.left <= time && self.left.is_zero() == time.is_zero()
        };
        let tested = config.brake(self.choice.second_brake).kind != Kind::None;
        timed
            && (self.phase == Phase::Idle || self.select_held)
            && (!self.phase.runs() || tested && self.start_held)
            && (self.phase != Phase::Result || self.start_held)
            && (self.phase.torque() || self.begin == Position(0))
            && (!self.phase.torque() || self.good)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The test is selected (r10231.0).
        pub select: bool,
        /// A sequence is started (r10231.1).
        pub start: bool,
        /// What is chosen.
        pub choice: Choice,
        /// An external brake reports closed (r10231.5).
        pub external_closed: bool,
        /// The pulses are enabled, with the control that the test needs.
        pub pulses: bool,
        /// The magnitude of the speed is at most 1 % of p1082.
        pub slow: bool,
        /// The load torque is known.
        pub load_known: bool,
        /// STO, SS1 or a stop acts.
        pub stop: bool,
        /// The actual position.
        pub position: Position,
    }
}

fields! {
    /// The outputs of one cycle; with the bits of r10234 (S_ZSW3B).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Bit 0: the test is selected.
        pub selected: bool,
        /// The load is known: a sequence may be started.
        pub ready: bool,
        /// Bit 1: the drive gives the setpoint.
        pub own_setpoint: bool,
        /// Bit 2: brake 2 is tested.
        pub second_brake: bool,
        /// Bit 3: a sequence runs.
        pub runs: bool,
        /// Bit 4: it was successful.
        pub successful: bool,
        /// Bit 5: it is complete.
        pub complete: bool,
        /// Bit 6: the external brake is to be closed.
        pub close_external: bool,
        /// The motor holding brake is to be closed.
        pub close_motor: bool,
        /// The test torque acts, its sign as chosen.
        pub torque: bool,
        /// The selection was refused: by the mode of the control (A01784), the pulses, the speed or a stop.
        pub refused: bool,
        /// A sequence was interrupted by the start signal (A01782).
        pub interrupted: bool,
        /// An external brake did not follow in time: fault.
        pub late: bool,
    }
}

/// The phase after `before` with the whole of its time.
fn enter(before: &State, config: &Config, phase: Phase) -> State {
    let mut after = State { phase, ..*before };
    after.left = after.time(config);
    if !phase.torque() {
        after.begin = Position(0);
    }
    after
}

/// A test that is selected and goes on, one cycle later; an external brake that is late is noted.
fn proceed(state: &State, config: &Config, inputs: &Inputs, late: &mut bool) -> State {
    let left = state.left.tick();
    let waiting = State { left, ..*state };
    let brake = config.brake(state.choice.second_brake);
    let sequence = if state.choice.second_sequence {
        &brake.second
    } else {
        &brake.first
    };
    let external = brake.kind == Kind::External;
    let over = left.is_zero();
    let begins = rises(inputs.start, state.start_held);
    let (reached, next) = match state.phase {
        Phase::Measure => {
            let open = !(config.has_external() && inputs.external_closed);
            if !open && over {
                *late = true;
                return enter(state, config, Phase::Ended);
            }
            (open && inputs.load_known, Phase::Ready)
        }
        Phase::Ready => {
            let exists = config.brake(inputs.choice.second_brake).kind != Kind::None;
            if begins && exists {
                let chosen = State {
                    choice: inputs.choice,
                    good: false,
                    ..*state
                };
                return enter(&chosen, config, Phase::Close);
            }
            return *state;
        }
        Phase::Close if external => (inputs.external_closed, Phase::RampUp),
        Phase::Close => (over, Phase::RampUp),
        Phase::RampUp | Phase::Hold | Phase::RampDown
            if inputs.position.distance(state.begin) > sequence.tolerance =>
        {
            let failed = State {
                good: false,
                ..*state
            };
            return enter(&failed, config, Phase::Open);
        }
        Phase::RampUp => (over, Phase::Hold),
        Phase::Hold => (over, Phase::RampDown),
        Phase::RampDown => (over, Phase::Open),
        Phase::Open if external => (!inputs.external_closed, Phase::Result),
        Phase::Open => (over, Phase::Result),
        Phase::Result => (!inputs.start, Phase::Ready),
        Phase::Idle | Phase::Ended => return *state,
    };
    if !reached {
        let moves = matches!(state.phase, Phase::Close | Phase::Open);
        if moves && external && over {
            *late = true;
            return enter(state, config, Phase::Ended);
        }
        return waiting;
    }
    let mut after = enter(state, config, next);
    if next == Phase::RampUp {
        after.begin = inputs.position;
        after.good = true;
    }
    after
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let fit = inputs.pulses && inputs.slow && !inputs.stop;
    let (mut refused, mut interrupted, mut late) = (false, false, false);
    let mut after = if !inputs.select {
        enter(&state, config, Phase::Idle)
    } else if state.phase == Phase::Idle {
        let asked = rises(inputs.select, state.select_held);
        refused = asked && !fit;
        let phase = if asked && fit {
            Phase::Measure
        } else {
            Phase::Idle
        };
        enter(&state, config, phase)
    } else if !fit {
        enter(&state, config, Phase::Ended)
    } else if state.phase.runs() && !inputs.start {
        interrupted = true;
        enter(&state, config, Phase::Ended)
    } else {
        proceed(&state, config, inputs, &mut late)
    };
    if matches!(after.phase, Phase::Idle | Phase::Measure | Phase::Ended) {
        after.good = false;
    }
    after.select_held = inputs.select;
    after.start_held = inputs.start;
    let kind = config.brake(after.choice.second_brake).kind;
    let outputs = Outputs {
        selected: after.phase != Phase::Idle,
        ready: after.phase == Phase::Ready,
        own_setpoint: after.phase != Phase::Idle,
        second_brake: after.choice.second_brake,
        runs: after.phase.runs(),
        successful: after.good && after.phase == Phase::Result,
        complete: after.phase == Phase::Result,
        close_external: after.phase.closed() && kind == Kind::External,
        close_motor: after.phase.closed() && kind == Kind::Motor,
        torque: after.phase.torque(),
        refused,
        interrupted,
        late,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests;
