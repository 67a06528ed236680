//! Safe torque off (STO) of one channel: each cause switches off the path of this channel in the same cycle.
//!
//! What latches a stop is the arbiter, what lets a drive start again is the restart chain; both are monitors of their own. A
//! channel acts by itself: it does not ask the other one (S120-STO-001).

use crate::sinamics::types::falls;

config! {
    /// What this drive has.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// A hydraulic drive: STO is active once the shut-off valve reports closed (p9625, p9626).
        pub valve: bool,
    }
    accepted |_config| true
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Power-up is complete.
        pub started: bool,
        /// STO was selected in the cycle before.
        pub selected_held: bool,
    }
}

impl State {
    /// Power-up has just begun.
    pub const INITIAL: Self = Self {
        started: false,
        selected_held: false,
    };

    /// A selection is remembered only once power-up is complete.
    pub fn invariant(&self, _config: &Config) -> bool {
        self.started || !self.selected_held
    }
}

fields! {
    /// The inputs of one cycle; a selection is true where its signal is 0.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-up is complete; what is lost again needs POWER ON.
        pub powered_up: bool,
        /// STO is selected in this channel, from whatever source p9601 allows.
        pub selected: bool,
        /// SS1 has ended in STO.
        pub ss1_ended: bool,
        /// The latched stop is STOP A or one that cannot be acknowledged.
        pub stop_a: bool,
        /// The axis is parked.
        pub parking: bool,
        /// A test of the switch-off paths asks for it.
        pub test_stop: bool,
        /// A drive without encoder keeps itself off after the pulses were suppressed.
        pub internal: bool,
        /// Safety commissioning mode.
        pub commissioning: bool,
        /// The shut-off valve of a hydraulic drive reports closed.
        pub valve_closed: bool,
        /// Internal armature short-circuit is requested.
        pub armature_short: bool,
    }
}

impl Inputs {
    /// A reason for STO is there.
    fn any(&self) -> bool {
        self.selected
            || self.ss1_ended
            || self.stop_a
            || self.parking
            || self.test_stop
            || self.internal
            || self.commissioning
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// This channel suppresses the pulses.
        pub pulses_off: bool,
        /// STO acts in this channel: the drive is inhibited, the brake closes.
        pub active: bool,
        /// STO is shown as active (r9722.0, S_ZSW.0).
        pub shown: bool,
        /// STO is selected internally by parking (r9772.19).
        pub parked: bool,
        /// The armature is short-circuited.
        pub armature_short: bool,
        /// STO was deselected: a STOP F or STOP A of the basic functions whose cause has gone is cancelled, entries of the fault
        /// memory stay.
        pub deselected: bool,
    }
}

monitor! { sinamics::sto;
    /// A selection switches off this channel in the same cycle, whatever else happens.
    selection_is_off_at_once ["S120-STO-001", "S120-STO-003", "S120-STO-010", "S120-TIMING-002", "S120-PF-01"]:
        when |s| s.inputs.selected
            => s.outputs.pulses_off && (s.outputs.active || !s.after.started);

    /// So do SS1 at its end, a latched STOP A, a test of the paths, the drive without encoder and commissioning.
    each_cause_is_off_at_once ["S120-STO-001", "S120-TEST-007", "S120-ENC-016", "S120-PF-02"]:
        when |s| s.inputs.ss1_ended || s.inputs.stop_a || s.inputs.test_stop || s.inputs.internal || s.inputs.commissioning
            => s.outputs.pulses_off && (s.outputs.active || !s.after.started);

    /// A parked axis is off without a message, and says why.
    parking_selects ["S120-STO-011"]:
        when |s| s.after.started && s.inputs.parking
            => s.outputs.pulses_off && s.outputs.active && s.outputs.parked;

    /// Until power-up is complete there is no torque, and nothing is reported active.
    no_torque_at_startup ["S120-ARCH-004"]:
        when |s| !s.after.started
            => s.outputs.pulses_off && !s.outputs.active && !s.outputs.shown && !s.outputs.parked
                && !s.outputs.armature_short;

    /// Power-up ends once, for good; a selection that is there then acts at once.
    startup_loses_no_selection ["S120-ARCH-004"]:
        when |s| s.before.started || s.inputs.powered_up
            => s.after.started && (s.outputs.active || !s.inputs.selected);

    /// Nothing else switches off: without a reason there is torque to be had.
    nothing_else_is_off ["S120-STO-001", "S120-STO-004"]:
        when |s| s.after.started && !s.inputs.selected && !s.inputs.ss1_ended && !s.inputs.stop_a && !s.inputs.parking
            && !s.inputs.test_stop && !s.inputs.internal && !s.inputs.commissioning
            => !s.outputs.pulses_off && !s.outputs.active && !s.outputs.shown;

    /// STO disables the short-circuit of the armature.
    armature_short_gives_way ["S120-STO-008"]:
        when |s| s.inputs.armature_short
            => s.outputs.armature_short != s.outputs.pulses_off;

    /// Without a request the armature is not short-circuited.
    armature_short_wants_a_request ["S120-STO-008"]:
        when |s| !s.inputs.armature_short
            => !s.outputs.armature_short;

    /// A deselection is told once, in its cycle.
    deselection_acknowledges ["S120-STO-004"]:
        when |s| s.after.started
            => s.outputs.deselected == (s.before.selected_held && !s.inputs.selected)
                && s.after.selected_held == s.inputs.selected;

    /// A hydraulic drive shows STO only with the feedback of its valve; every other one at once.
    valve_is_waited_for ["S120-STO-012", "S120-STO-007"]:
        when |s| s.outputs.active
            => s.outputs.shown == (!s.config.valve || s.inputs.valve_closed);

    /// The state stays consistent.
    state_stays_consistent ["S120-STO-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && (s.outputs.pulses_off || !s.outputs.active);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let started = state.started || inputs.powered_up;
    let active = started && inputs.any();
    let pulses_off = !started || active;
    let outputs = Outputs {
        pulses_off,
        active,
        shown: active && (!config.valve || inputs.valve_closed),
        parked: started && inputs.parking,
        armature_short: inputs.armature_short && !pulses_off,
        deselected: falls(inputs.selected, state.selected_held),
    };
    let after = State {
        started,
        selected_held: started && inputs.selected,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-ARCH-004, S120-STO-004: a request during power-up acts when it ends; its end is a deselection.
    #[test]
    fn a_request_during_power_up_is_not_lost() {
        let mut monitor = Monitor::new(Config { valve: false });
        let mut inputs = Inputs {
            selected: true,
            ..Inputs::default()
        };
        let outputs = monitor.step(&inputs);
        assert!(outputs.pulses_off && !outputs.active && !outputs.shown);
        inputs.powered_up = true;
        assert!(monitor.step(&inputs).shown);
        inputs.selected = false;
        let outputs = monitor.step(&inputs);
        assert!(outputs.deselected && !outputs.pulses_off);
        assert!(!monitor.step(&inputs).deselected);
    }
}
