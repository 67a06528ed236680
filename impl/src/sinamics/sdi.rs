//! Safe direction (SDI), one of its two instances in one channel: the axis may move in one direction only (machine B8).
//!
//! Both directions are two monitors with times and references of their own. Without an encoder a drive whose pulses are suppressed
//! is told as inactive (p9509.8 = 1) or stays active, with STO ([`crate::sinamics::encoderless`]).
//!
//! Reading AF-15 is a choice of the configuration, the recommended one first.

use crate::kernel::{ConfigError, Cycles, Distance, Position};
use crate::sinamics::types::Stop;

fields! {
    /// Reading AF-15: from where the travel counts.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SdiRef {
        /// From the furthest position in the permitted direction.
        #[default]
        Trail,
        /// From the position at activation.
        Fixed,
    }
}

fields! {
    /// The permitted direction.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Permitted {
        /// SDI positive: message value 0.
        #[default]
        Positive,
        /// SDI negative: message value 1.
        Negative,
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        permitted: Permitted,
        delay: Cycles,
        tolerance: Distance,
        response: Stop,
        encoder: bool,
        unselected: bool,
        inactive_when_off: bool,
        reference: SdiRef,
    }
}

impl Config {
    /// `delay`: p9565. `tolerance`: p9564. `response`: p9566. `encoder`: p9506 is 0 or 2. `unselected`: p9512.12 or p9512.13.
    /// `inactive_when_off`: p9509.8.
    ///
    /// # Errors
    /// [`ConfigError::StopNotAllowed`] for a response that is none, or none without encoder (S120-SLS-014).
    #[allow(clippy::too_many_arguments)]
    pub const fn new(
        permitted: Permitted,
        delay: Cycles,
        tolerance: Distance,
        response: Stop,
        encoder: bool,
        unselected: bool,
        inactive_when_off: bool,
        reference: SdiRef,
    ) -> Result<Self, ConfigError> {
        if !response.allowed(encoder) {
            return Err(ConfigError::StopNotAllowed);
        }
        Ok(Self {
            permitted,
            delay,
            tolerance,
            response,
            encoder,
            unselected,
            inactive_when_off,
            reference,
        })
    }

    /// The further of two positions in the permitted direction.
    fn further(&self, a: Position, b: Position) -> Position {
        match self.permitted {
            Permitted::Positive => a.max(b),
            Permitted::Negative => a.min(b),
        }
    }

    /// The travel against the permitted direction.
    fn against(&self, from: Position, to: Position) -> Distance {
        if self.further(from, to) == from {
            from.distance(to)
        } else {
            Distance(0)
        }
    }
}

fields! {
    /// What SDI does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// Selected; nothing is monitored yet.
        Delay,
        /// The direction is monitored.
        Active,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What SDI does.
        pub phase: Phase,
        /// What is left of the delay.
        pub left: Cycles,
        /// From where the travel counts; 0 while nothing is monitored.
        pub from: Position,
    }
}

impl State {
    /// Not selected.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        from: Position(0),
    };

    /// The delay runs in its phase only, and not without selection; a position is kept while it is needed.
    pub fn invariant(&self, config: &Config) -> bool {
        (self.phase == Phase::Delay) != self.left.is_zero()
            && self.left <= config.delay
            && (self.phase == Phase::Active || self.from == Position(0))
            && !(config.unselected && self.phase == Phase::Delay)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// This direction is selected.
        pub selected: bool,
        /// The actual position of this channel.
        pub position: Position,
        /// The pulses are enabled.
        pub pulses: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SDI is active (r9722.12 or r9722.13).
        pub active: bool,
        /// The axis has moved the wrong way: C01716 with the value of the direction.
        pub violated: bool,
        /// The stop that is raised.
        pub demand: Stop,
    }
}

/// SDI is on: selected, or for ever; without encoder from the switch-on on.
fn on(config: &Config, inputs: &Inputs) -> bool {
    let off = !config.encoder && !inputs.pulses;
    if config.unselected {
        !off
    } else {
        inputs.selected && !(off && config.inactive_when_off)
    }
}

/// The way against the permitted direction, exact, from where it counts after the step.
fn gone(s: &Step) -> i64 {
    let way = i64::from(s.after.from.0) - i64::from(s.inputs.position.0);
    match s.config.permitted {
        Permitted::Positive => way,
        Permitted::Negative => -way,
    }
}

monitor! { sinamics::sdi;
    /// Active, more travel against the permitted direction than tolerated is a violation with its stop, in the same cycle.
    wrong_way_is_stopped ["S120-SDI-001", "S120-SDI-003", "S120-PF-11"]:
        when |s| s.outputs.active && gone(&s) > i64::from(s.config.tolerance.0)
            => s.outputs.violated && s.outputs.demand == s.config.response;

    /// The tolerance itself is none, nor is any way in the permitted direction, nor anything before SDI is active.
    permitted_way_is_free ["S120-SDI-001", "S120-SDI-002", "S120-SDI-003", "S120-PF-11"]:
        when |s| !s.outputs.active || gone(&s) <= i64::from(s.config.tolerance.0)
            => !s.outputs.violated && s.outputs.demand == Stop::None;

    /// A selection starts the delay.
    selection_starts_the_delay ["S120-SDI-002", "S120-SDI-014"]:
        when |s| s.before.phase == Phase::Idle && on(&s.config, &s.inputs) && !s.config.unselected && !s.config.delay.is_zero()
            => s.after.left == s.config.delay && !s.outputs.active;

    /// It runs down and ends in the monitoring from where the axis then is.
    delay_ends_in_monitoring ["S120-SDI-002", "S120-SDI-003"]:
        when |s| s.before.phase == Phase::Delay && on(&s.config, &s.inputs)
            => s.after.left == s.before.left.tick() && s.outputs.active == (s.before.left == Cycles::new(1))
                && (!s.outputs.active || s.after.from == s.inputs.position);

    /// A deselection ends everything at once.
    deselection_is_at_once ["S120-SDI-002", "S120-SDI-008"]:
        when |s| !s.inputs.selected && !s.config.unselected
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// Where the travel counts from follows the permitted direction (AF-15), or stays; never against it.
    reference_follows ["S120-SDI-003"]:
        when |s| s.before.phase == Phase::Active && s.after.phase == Phase::Active
            => match s.config.reference {
                SdiRef::Fixed => s.after.from == s.before.from,
                SdiRef::Trail => (s.after.from == s.before.from || s.after.from == s.inputs.position) && gone(&s) >= 0,
            };

    /// Without selection SDI is active at once: with encoder always, without one while the drive is on.
    unselected_is_for_ever ["S120-SDI-010"]:
        when |s| s.config.unselected
            => s.outputs.active == (s.config.encoder || s.inputs.pulses);

    /// Without encoder and pulses p9509.8 = 1 shows it as inactive.
    pulses_off_is_inactive ["S120-SDI-007"]:
        when |s| !s.config.encoder && !s.inputs.pulses && s.config.inactive_when_off
            => !s.outputs.active;

    /// With p9509.8 = 0 it stays active.
    pulses_off_stays_active ["S120-SDI-007"]:
        when |s| !s.config.inactive_when_off && s.before.phase == Phase::Active && s.inputs.selected && !s.config.unselected
            => s.outputs.active;

    /// A function without encoder raises STOP A or B only.
    bare_function_raises_a_or_b ["S120-SLS-014"]:
        when |s| !s.config.encoder && s.outputs.violated
            => s.outputs.demand >= Stop::B;

    /// The state stays consistent.
    state_stays_consistent ["S120-SDI-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.active == (s.after.phase == Phase::Active);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !on(config, inputs) {
        return (State::INITIAL, Outputs::default());
    }
    let left = match state.phase {
        Phase::Active => Cycles::ZERO,
        Phase::Delay => state.left.tick(),
        Phase::Idle if config.unselected => Cycles::ZERO,
        Phase::Idle => config.delay,
    };
    if !left.is_zero() {
        let after = State {
            phase: Phase::Delay,
            left,
            from: Position(0),
        };
        return (after, Outputs::default());
    }
    let from = match (state.phase, config.reference) {
        (Phase::Active, SdiRef::Fixed) => state.from,
        (Phase::Active, SdiRef::Trail) => config.further(state.from, inputs.position),
        _ => inputs.position,
    };
    let violated = config.against(from, inputs.position) > config.tolerance;
    let outputs = Outputs {
        active: true,
        violated,
        demand: if violated {
            config.response
        } else {
            Stop::None
        },
    };
    let after = State {
        phase: Phase::Active,
        left,
        from,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SDI-003, S120-SDI-014 with p9564 = 0.1 mm (Table A-5): each direction has its own reference; the trailing one finds a way
    /// back that the fixed one permits.
    #[test]
    fn travel_against_the_direction() {
        for (permitted, sign) in [(Permitted::Positive, 1), (Permitted::Negative, -1)] {
            for (reference, found) in [(SdiRef::Trail, true), (SdiRef::Fixed, false)] {
                let config = Config::new(
                    permitted,
                    Cycles::ZERO,
                    Distance(100),
                    Stop::B,
                    true,
                    false,
                    false,
                    reference,
                );
                let mut monitor = Monitor::new(config.expect("accepted"));
                let mut violated = |way: i32| {
                    let inputs = Inputs {
                        selected: true,
                        position: Position(sign * way),
                        pulses: true,
                    };
                    monitor.step(&inputs).violated
                };
                assert!(!violated(0) && !violated(1000));
                assert!(!violated(900));
                assert_eq!(violated(899), found);
                assert!(!violated(950) && violated(-101));
            }
        }
    }
}
