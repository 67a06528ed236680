//! Safe operating stop (SOS) of one channel: the axis stays where it was when the stop became active (machine B6).
//!
//! SOS brakes nothing. It is selected, with a delay in which the control brings the axis to standstill, or it follows a stop that has
//! had its time. It stays active under STO and under the stops that its own violation raises.

use crate::kernel::{Cycles, Distance, Position};
use crate::sinamics::types::Stop;

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// p9551: from the selection to the monitoring; the timer value of SLS too (S120-SLS-500).
        pub delay: Cycles,
        /// p9530: the standstill tolerance to either side.
        pub tolerance: Distance,
    }
    accepted |_config| true
}

fields! {
    /// What SOS does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// Selected; nothing is monitored yet.
        Delay,
        /// The position is monitored.
        Active,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What SOS does.
        pub phase: Phase,
        /// What is left of the delay.
        pub left: Cycles,
        /// The position that it is compared with; 0 while there is none.
        pub reference: Position,
    }
}

impl State {
    /// Not selected.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        reference: Position(0),
    };

    /// The delay runs in its phase only, a position is kept while it is needed.
    pub fn invariant(&self, config: &Config) -> bool {
        (self.phase == Phase::Delay) != self.left.is_zero()
            && self.left <= config.delay
            && (self.phase == Phase::Active || self.reference == Position(0))
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SOS is selected.
        pub selected: bool,
        /// SS2, SS2E, STOP C, D or E has ended in SOS and keeps it ([`crate::sinamics::ss2`]).
        pub held: bool,
        /// The actual position of this channel.
        pub position: Position,
        /// A safe acknowledgement in the acceptance test mode takes the position anew.
        pub renew: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// "SOS selected" for the control, which has to keep the axis where it is: STOP D and E correspond to a selection.
        pub selected: bool,
        /// SOS is active (r9722.3, S_ZSW.3).
        pub active: bool,
        /// The position is outside its tolerance: C01707.
        pub violated: bool,
        /// The stop that is raised.
        pub demand: Stop,
    }
}

monitor! { sinamics::sos;
    /// Active, an axis outside its tolerance is STOP B with C01707 in the same cycle.
    creeping_is_stop_b ["S120-SOS-003", "S120-SOS-005", "S120-SS2-004", "S120-PF-07"]:
        when |s| s.outputs.active && s.inputs.position.distance(s.after.reference) > s.config.tolerance
            => s.outputs.violated && s.outputs.demand == Stop::B;

    /// The tolerance itself is none, nor is anything while SOS is not active.
    tolerance_is_kept ["S120-SOS-003"]:
        when |s| !s.outputs.active || s.inputs.position.distance(s.after.reference) <= s.config.tolerance
            => !s.outputs.violated && s.outputs.demand == Stop::None;

    /// A selection is told at once, starts the delay and monitors nothing before its end.
    selection_starts_the_delay ["S120-SOS-003", "S120-SOS-004"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.selected && !s.inputs.held && !s.config.delay.is_zero()
            => s.outputs.selected && !s.outputs.active && s.after.left == s.config.delay;

    /// At the end of the delay SOS is active, at the position that the axis then has.
    delay_ends_in_sos ["S120-SOS-002", "S120-SOS-003"]:
        when |s| s.before.left == Cycles::new(1) && s.inputs.selected
            => s.outputs.active && s.after.reference == s.inputs.position && !s.outputs.violated;

    /// Until then it runs down.
    delay_runs_down ["S120-SOS-003"]:
        when |s| s.before.phase == Phase::Delay && s.inputs.selected && !s.inputs.held && s.before.left > Cycles::new(1)
            => s.after.left.count() + 1 == s.before.left.count() && !s.outputs.active;

    /// A deselection in the delay forgets it at once.
    deselection_clears_the_delay ["S120-SOS-003"]:
        when |s| s.before.phase != Phase::Active && !s.inputs.selected && !s.inputs.held
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// A stop that has had its time needs no delay.
    stop_needs_no_delay ["S120-SOS-002", "S120-SS2-001", "S120-SS2-007"]:
        when |s| s.before.phase != Phase::Active && s.inputs.held
            => s.outputs.active && s.after.reference == s.inputs.position;

    /// The position stays the same until SOS ends, whatever is violated; an acknowledgement of the acceptance test alone renews it.
    reference_stays ["S120-SOS-003", "S120-SOS-005", "S120-SOS-009"]:
        when |s| s.before.phase == Phase::Active && s.after.phase == Phase::Active
            => s.after.reference == if s.inputs.renew {
                s.inputs.position
            } else {
                s.before.reference
            };

    /// SOS stays active as long as it is selected or held.
    sos_stays ["S120-SOS-009", "S120-SOS-010"]:
        when |s| s.before.phase == Phase::Active && (s.inputs.selected || s.inputs.held)
            => s.outputs.active;

    /// Neither, and it ends at once.
    sos_ends ["S120-SOS-003", "S120-SOS-010"]:
        when |s| s.before.phase == Phase::Active && !s.inputs.selected && !s.inputs.held
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// The control is told from the selection on, and as long as a stop keeps it.
    selection_is_told ["S120-SOS-004", "S120-SOS-002"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.selected == (s.inputs.selected || s.inputs.held);

    /// The state stays consistent.
    state_stays_consistent ["S120-SOS-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.active == (s.after.phase == Phase::Active);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.selected && !inputs.held {
        return (State::INITIAL, Outputs::default());
    }
    let active = state.phase == Phase::Active;
    let left = if active || inputs.held {
        Cycles::ZERO
    } else if state.phase == Phase::Delay {
        state.left.tick()
    } else {
        config.delay
    };
    let mut outputs = Outputs {
        selected: true,
        ..Outputs::default()
    };
    if !left.is_zero() {
        let after = State {
            phase: Phase::Delay,
            left,
            reference: Position(0),
        };
        return (after, outputs);
    }
    let reference = if active && !inputs.renew {
        state.reference
    } else {
        inputs.position
    };
    outputs.active = true;
    outputs.violated = inputs.position.distance(reference) > config.tolerance;
    if outputs.violated {
        outputs.demand = Stop::B;
    }
    let after = State {
        phase: Phase::Active,
        left,
        reference,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SOS-003 with p9530 = 1.000 mm and p9551 = 100 ms (Table A-5), in cycles of 12 ms rounded up.
    #[test]
    fn the_window_is_where_the_axis_was_when_the_delay_ended() {
        let mut monitor = Monitor::new(Config {
            delay: Cycles::new(100_u32.div_ceil(12)),
            tolerance: Distance(1000),
        });
        let mut inputs = Inputs {
            selected: true,
            ..Inputs::default()
        };
        for k in 0..9 {
            inputs.position = Position(k * 5000);
            assert!(!monitor.step(&inputs).active, "cycle {k}");
        }
        inputs.position = Position(50_000);
        assert!(monitor.step(&inputs).active);
        inputs.position = Position(51_000);
        assert!(!monitor.step(&inputs).violated);
        inputs.position = Position(48_999);
        assert_eq!(monitor.step(&inputs).demand, Stop::B);
    }
}
