//! Safe brake control (SBC) in one channel: one of the two switches of the brake, TB+ or TB-.
//!
//! The brake is held open by the current through both switches; each channel opens its own, and that closes the brake
//! (closed-circuit principle). SBC cannot be selected by itself: it follows STO.

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// p9602: SBC is enabled.
        pub enabled: bool,
    }
    accepted |_config| true
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// This channel's switch carries current.
        pub on: bool,
    }
}

impl State {
    /// The brake is closed.
    pub const INITIAL: Self = Self { on: false };

    /// Without SBC the switch is no business of this monitor.
    pub fn invariant(&self, config: &Config) -> bool {
        config.enabled || !self.on
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// STO acts in this channel, or power-up is not complete.
        pub sto: bool,
        /// This channel has found a fault of its own.
        pub fault: bool,
        /// The other channel has reported a fault, or does not answer.
        pub other_fault: bool,
        /// The brake is to be open: request of the drive's brake control (p1215).
        pub open: bool,
        /// The other channel's switch carries current.
        pub other_on: bool,
        /// The feedback of this channel's switch: current flows.
        pub feedback: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// This channel's switch carries current.
        pub on: bool,
        /// The brake is open: both switches carry current.
        pub open: bool,
        /// A break or short circuit of the winding, or a switch that does not follow (F01630).
        pub defect: bool,
    }
}

monitor! { sinamics::sbc;
    /// STO closes the brake in the same cycle.
    sto_closes ["S120-SBC-001", "S120-STO-001", "S120-SBC-008"]:
        when |s| s.config.enabled && s.inputs.sto
            => !s.outputs.on && !s.outputs.open;

    /// A fault of either channel closes it.
    fault_of_either_channel_closes ["S120-SBC-002"]:
        when |s| s.config.enabled && (s.inputs.fault || s.inputs.other_fault)
            => !s.outputs.on && !s.outputs.open;

    /// Opening needs both channels.
    open_needs_both ["S120-SBC-002"]:
        when |s| s.outputs.open
            => s.outputs.on && s.inputs.other_on;

    /// It opens when it is to be open, nothing speaks against it, and the other channel does the same.
    brake_opens ["S120-SBC-001", "S120-SBC-002"]:
        when |s| s.config.enabled && !s.inputs.sto && !s.inputs.fault && !s.inputs.other_fault && s.inputs.open
            && s.inputs.other_on && s.inputs.feedback
            => s.outputs.open && !s.outputs.defect;

    /// A switch that does not follow is found when it changes, at no other time.
    diagnosis_at_changes_only ["S120-SBC-003"]:
        when |s| s.config.enabled
            => s.outputs.defect == (s.before.on != s.outputs.on && s.inputs.feedback != s.outputs.on);

    /// A drive without SBC drives no brake safely.
    disabled_does_nothing ["S120-SBC-001"]:
        when |s| !s.config.enabled
            => s.outputs == Outputs::default() && s.after == State::INITIAL;

    /// The state stays consistent.
    state_stays_consistent ["S120-SBC-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.on == s.outputs.on;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let safe = !inputs.sto && !inputs.fault && !inputs.other_fault;
    let on = config.enabled && safe && inputs.open;
    let outputs = Outputs {
        on,
        open: on && inputs.other_on,
        defect: config.enabled && on != state.on && inputs.feedback != on,
    };
    (State { on }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SBC-003: a switch that keeps its current is found when it shall open, and not told again.
    #[test]
    fn a_stuck_switch_is_found_at_the_change() {
        let mut monitor = Monitor::new(Config { enabled: true });
        let mut inputs = Inputs {
            open: true,
            other_on: true,
            feedback: true,
            ..Inputs::default()
        };
        assert!(monitor.step(&inputs).open);
        inputs.sto = true;
        let outputs = monitor.step(&inputs);
        assert!(!outputs.on && outputs.defect);
        assert!(!monitor.step(&inputs).defect);
    }
}
