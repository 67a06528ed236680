//! F-DI of TM54F or CU310-2: two inputs, one value.
//!
//! The value is 1 (deselected) only while both inputs say so. If they differ for p10002 the value is frozen at 0 until a safe
//! acknowledgement. During the test stop of the TM54F everything is frozen as it was.
//!
//! A discrepancy at the CU310-2 (C01770) is found by the cross-check and is a STOP F too (lines 4744 to 4748); one at a TM54F (F35151) is none.
//!
//! Readings: AC-03, AC-30 FDI_STOPF. Input levels are filtered ([`crate::sinamics::input_filter`]).

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The discrepancy time p10002, the kind of input 2 (p10040), and where the F-DI is.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) tolerance: Cycles,
        pub(crate) normally_open: bool,
        pub(crate) onboard: bool,
    }
}

impl Config {
    /// `tolerance`: how long the inputs may differ. `normally_open`: input 2 is NO, else NC; input 1 always is NC
    /// (S120-FDI-500). `onboard`: an F-DI of the CU310-2, not of a TM54F.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when the tolerance is 0: contacts never switch in the same cycle for certain.
    pub const fn new(
        tolerance: Cycles,
        normally_open: bool,
        onboard: bool,
    ) -> Result<Self, ConfigError> {
        if tolerance.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            tolerance,
            normally_open,
            onboard,
        })
    }
}

fields! {
    /// What is known of the inputs.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// They have not agreed since POWER ON.
        #[default]
        Start,
        /// Both deselect.
        High,
        /// Both select.
        Low,
        /// They differ; the discrepancy time runs.
        Skew,
        /// They differed for longer: frozen.
        Latched,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the inputs.
        pub phase: Phase,
        /// What is left of the discrepancy time; 0 when it does not run.
        pub timer: Cycles,
    }
}

impl State {
    /// POWER ON: nothing is known, selected (S120-FDI-511).
    pub const INITIAL: Self = Self {
        phase: Phase::Start,
        timer: Cycles::ZERO,
    };

    /// The timer runs in a skew, and at the start once the inputs were seen to differ.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.tolerance
            && match self.phase {
                Phase::Start => true,
                Phase::Skew => !self.timer.is_zero(),
                Phase::High | Phase::Low | Phase::Latched => self.timer.is_zero(),
            }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The level of input 1.
        pub input1: bool,
        /// The level of input 2.
        pub input2: bool,
        /// A test stop of the TM54F runs.
        pub frozen: bool,
        /// A safe acknowledgement.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The value: 1 deselected, 0 selected; r10051. Two that are latched at 0 select the level SLS1 (S120-FDI-504).
        pub value: bool,
        /// The inputs agree and nothing is frozen: an edge of the value is one (S120-ACK-514).
        pub stable: bool,
        /// F35151, or C01770 and C30770.
        pub fault: bool,
        /// The cross-check has found it: STOP F.
        pub stop_f: bool,
    }
}

monitor! { sinamics::fail_safe_input;
    /// The value is 1 only where both inputs are seen to deselect.
    both_inputs_deselect ["S120-FDI-500", "S120-FDI-501", "S120-PC-12", "S120-PC-28", "S120-CTRL-503"]:
        when |s| s.outputs.value && !s.inputs.frozen
            => s.inputs.input1 && s.inputs.input2 != s.config.normally_open && s.after.phase == Phase::High;

    /// One input that selects is enough, in the same cycle.
    one_input_selects_at_once ["S120-FDI-501", "S120-PC-13", "S120-PC-28"]:
        when |s| !s.inputs.frozen && (!s.inputs.input1 || s.inputs.input2 == s.config.normally_open)
            => !s.outputs.value;

    /// Where nothing is frozen, inputs that both deselect make the value 1.
    agreeing_inputs_are_taken ["S120-FDI-501", "S120-FDI-511"]:
        when |s| s.inputs.input1 && s.inputs.input2 != s.config.normally_open && !s.inputs.frozen
            && (s.before.phase != Phase::Latched || s.inputs.acknowledge || s.inputs.power_on)
            => s.outputs.value && s.outputs.stable;

    /// Inputs that differ for p10002 are latched.
    lasting_difference_is_latched ["S120-FDI-502", "S120-CTRL-508", "S120-FDI-511", "S120-PC-28"]:
        when |s| s.before.timer == Cycles::new(1) && s.inputs.input1 != (s.inputs.input2 != s.config.normally_open)
            && !s.inputs.frozen && !s.inputs.power_on
            => s.outputs.fault && s.after.phase == Phase::Latched;

    /// A discrepancy at the CU310-2 is a STOP F, and nothing else is one.
    onboard_discrepancy_is_stop_f ["S120-CTRL-508", "S120-STOP-505"]:
        when |s| s.outputs.fault || s.outputs.stop_f
            => s.outputs.fault && s.outputs.stop_f == s.config.onboard;

    /// Nothing else latches.
    short_difference_is_not_latched ["S120-FDI-502", "S120-FDI-503"]:
        when |s| s.outputs.fault && (s.before.phase != Phase::Latched || s.inputs.power_on)
            => s.before.timer == Cycles::new(1) && !s.inputs.power_on;

    /// The discrepancy time begins with the difference and is not begun again while it lasts.
    discrepancy_is_counted_once ["S120-FDI-502"]:
        when |s| s.after.timer > Cycles::ZERO && !s.inputs.frozen
            => s.inputs.input1 != (s.inputs.input2 != s.config.normally_open)
                && s.after.timer == if s.before.timer > Cycles::ZERO && !s.inputs.power_on {
                    s.before.timer.tick()
                } else {
                    s.config.tolerance
                };

    /// What is latched stays 0, whatever the inputs do, until it is acknowledged.
    latched_value_stays ["S120-FDI-503", "S120-PC-12"]:
        when |s| s.before.phase == Phase::Latched && !s.inputs.acknowledge && !s.inputs.power_on
            => !s.outputs.value && !s.outputs.stable && s.outputs.fault && s.after == s.before;

    /// An acknowledgement while the inputs differ releases nothing: the value stays 0 and the time runs anew.
    early_acknowledgement_releases_nothing ["S120-FDI-503"]:
        when |s| s.before.phase == Phase::Latched && s.inputs.acknowledge && !s.inputs.power_on && !s.inputs.frozen
            && s.inputs.input1 != (s.inputs.input2 != s.config.normally_open)
            => !s.outputs.value && s.after.phase == Phase::Skew && s.after.timer == s.config.tolerance;

    /// During the test stop nothing changes.
    frozen_input_keeps_its_value ["S120-FDI-506", "S120-TESTSTOP-519", "S120-PC-16"]:
        when |s| s.inputs.frozen && !s.inputs.power_on
            => s.after == s.before && s.outputs.value == (s.before.phase == Phase::High) && !s.outputs.stable;

    /// From POWER ON until the inputs agree the value is 0.
    start_is_selected ["S120-FDI-511", "S120-CTRL-504"]:
        when |s| s.after.phase == Phase::Start
            => !s.outputs.value && !s.outputs.stable;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-FDI-500"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == (s.after.phase == Phase::Latched);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let after = if inputs.frozen {
        before
    } else {
        read(before, config, inputs)
    };
    let settled = matches!(after.phase, Phase::High | Phase::Low);
    let fault = after.phase == Phase::Latched;
    let outputs = Outputs {
        value: after.phase == Phase::High,
        stable: settled && !inputs.frozen,
        fault,
        stop_f: fault && config.onboard,
    };
    (after, outputs)
}

/// The state after the inputs were read.
fn read(before: State, config: &Config, inputs: &Inputs) -> State {
    if before.phase == Phase::Latched && !inputs.acknowledge {
        return before;
    }
    let normalised = (inputs.input1, inputs.input2 != config.normally_open);
    let (phase, timer) = match normalised {
        (true, true) => (Phase::High, Cycles::ZERO),
        (false, false) => (Phase::Low, Cycles::ZERO),
        _ if before.timer.is_zero() && before.phase == Phase::Start => {
            (Phase::Start, config.tolerance)
        }
        _ if before.timer.is_zero() => (Phase::Skew, config.tolerance),
        _ => {
            let left = before.timer.tick();
            let phase = if left.is_zero() {
                Phase::Latched
            } else {
                before.phase
            };
            (phase, left)
        }
    };
    State { phase, timer }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(normally_open: bool, input1: bool, input2: bool) -> bool {
        let config = Config::new(Cycles::new(3), normally_open, false).expect("some");
        let inputs = Inputs {
            input1,
            input2,
            ..Inputs::default()
        };
        next(State::INITIAL, &config, &inputs).1.value
    }

    /// S120-FDI-501: the truth tables of NC/NC and NC/NO.
    #[test]
    fn the_printed_truth_tables() {
        let inputs = [(false, false), (false, true), (true, false), (true, true)];
        assert_eq!(
            inputs.map(|(a, b)| value(false, a, b)),
            [false, false, false, true]
        );
        assert_eq!(
            inputs.map(|(a, b)| value(true, a, b)),
            [false, false, true, false]
        );
    }

    /// S120-FDI-503, S120-FDI-504: frozen at 0, until it is acknowledged; both level inputs frozen are level 00.
    #[test]
    fn a_frozen_input_waits_for_the_acknowledgement() {
        let mut input = Monitor::new(Config::new(Cycles::new(2), false, true).expect("some"));
        let high = Inputs {
            input1: true,
            input2: true,
            ..Inputs::default()
        };
        let broken = Inputs {
            input2: false,
            ..high
        };
        assert!(input.step(&high).value);
        assert!(!input.step(&broken).fault);
        assert!(!input.step(&broken).fault);
        assert!(input.step(&broken).stop_f);
        assert!(!input.step(&high).value);
        let acknowledge = Inputs {
            acknowledge: true,
            ..high
        };
        assert!(input.step(&acknowledge).value);
    }
}
