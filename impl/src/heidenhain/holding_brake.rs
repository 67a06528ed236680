//! Test of the holding brake of one axis by a test torque (part of the self-test).
//!
//! The drive holds the axis and its torque is taken down; the brake closes; the drive lets go; the test torque is added, and
//! path and current are looked at. An axis without a brake, or whose brake is not tested (SMP2230 = 0), counts as passed.
//! What is found stays until the axis has been moved to a safe position and is tested again.

use crate::kernel::ConfigError;

config! {
    /// The test of this brake.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        factor: u16,
    }
}

impl Config {
    /// The highest SMP2230 in tenths.
    pub const HIGHEST: u16 = 300;

    /// `factor`: SMP2230 in tenths of the stall current of the motor, 1 to 300 (0.1 to 30.0), or 0: no brake, or no test of
    /// it.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] above [`Config::HIGHEST`] (HFS-PARAM-022).
    pub const fn new(factor: u16) -> Result<Self, ConfigError> {
        if factor > Self::HIGHEST {
            Err(ConfigError::ValueOutOfRange)
        } else {
            Ok(Self { factor })
        }
    }

    /// Whether there is a brake to be tested.
    pub const fn is_tested(&self) -> bool {
        self.factor != 0
    }
}

fields! {
    /// The step of the test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Not tested yet.
        #[default]
        Idle,
        /// Position and holding torque are known; the drive controls the axis.
        TorqueKnown,
        /// The brake closes while the control is reduced.
        Closes,
        /// The drive lets go.
        ControlOff,
        /// The test torque acts.
        TestTorque,
        /// The brake holds.
        Good,
        /// It does not: the axis has moved further than SMP2232 (message 8300).
        Defective,
        /// The current has not risen with the test torque (message 8310).
        NoCurrent,
    }
}

impl Phase {
    /// Whether the test has found a fault.
    pub const fn is_bad(self) -> bool {
        matches!(self, Self::Defective | Self::NoCurrent)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The step.
        pub step: Phase,
    }
}

impl State {
    /// Not tested yet.
    pub const INITIAL: Self = Self { step: Phase::Idle };

    /// A brake that is not tested is never found bad, nor its axis let go.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        config.is_tested() || matches!(self.step, Phase::Idle | Phase::Good)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The self-test comes to this part.
        pub start: bool,
        /// The step has had its time.
        pub done: bool,
        /// The axis has moved further than SMP2232.
        pub too_far: bool,
        /// The current has risen with the test torque.
        pub current: bool,
        /// The axis has been moved to a safe position.
        pub safe_now: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The step.
        pub step: Phase,
        /// The brake is closed.
        pub closed: bool,
        /// The drive holds the axis.
        pub controlled: bool,
        /// The test is passed.
        pub passed: bool,
    }
}

monitor! { heidenhain::holding_brake;
    /// The test takes its steps in their order: holding torque, brake, control off, test torque.
    steps_follow_each_other ["HFS-BRT-006"]:
        when |s| s.config.is_tested() && s.after.step != s.before.step
            => match s.after.step {
                Phase::Idle => false,
                Phase::TorqueKnown => s.inputs.start && (matches!(s.before.step, Phase::Idle | Phase::Good)
                    || (s.before.step.is_bad() && s.inputs.safe_now)),
                Phase::Closes => s.before.step == Phase::TorqueKnown && s.inputs.done,
                Phase::ControlOff => s.before.step == Phase::Closes && s.inputs.done,
                Phase::TestTorque => s.before.step == Phase::ControlOff && s.inputs.done && !s.inputs.too_far,
                Phase::Defective => matches!(s.before.step, Phase::ControlOff | Phase::TestTorque),
                Phase::Good | Phase::NoCurrent => s.before.step == Phase::TestTorque,
            };

    /// The drive lets go of the axis only behind a closed brake.
    brake_closes_before_the_drive_lets_go ["HFS-BRT-006", "HFS-BRT-002"]:
        when |s| !s.outputs.controlled
            => s.outputs.closed && matches!(s.before.step, Phase::Closes | Phase::ControlOff | Phase::TestTorque);

    /// More path than SMP2232 while the drive has let go, with the test torque or before it: the brake is defective, and the drive
    /// takes the axis.
    path_shows_a_defect ["HFS-BRT-002", "HFS-PARAM-022"]:
        when |s| s.config.is_tested() && matches!(s.before.step, Phase::ControlOff | Phase::TestTorque)
            && s.inputs.too_far
            => s.after.step == Phase::Defective && s.outputs.controlled && !s.outputs.passed;

    /// Without a rise of the current there was no test torque: not passed.
    missing_current_is_no_pass ["HFS-BRT-003"]:
        when |s| s.config.is_tested() && s.before.step == Phase::TestTorque && s.inputs.done && !s.inputs.current
            && !s.inputs.too_far
            => s.after.step == Phase::NoCurrent && !s.outputs.passed;

    /// A fault stays until the axis is in a safe position and tested again.
    fault_stays ["HFS-BRT-003"]:
        when |s| s.config.is_tested() && s.before.step.is_bad() && !(s.inputs.start && s.inputs.safe_now)
            => s.after.step == s.before.step && !s.outputs.passed;

    /// A brake passes by its test only: little path, and the current has risen.
    passed_means_tested ["HFS-BRT-001", "HFS-BRT-006"]:
        when |s| s.config.is_tested() && s.outputs.passed
            => s.before.step == Phase::Good
                || (s.before.step == Phase::TestTorque && s.inputs.done && s.inputs.current && !s.inputs.too_far);

    /// Without a brake, or without its test, the drive holds the axis and the part is passed.
    no_test_is_passed ["HFS-BRT-007", "HFS-PARAM-022"]:
        when |s| !s.config.is_tested() && s.before.invariant(&s.config)
            => s.outputs.controlled && !s.outputs.closed && (!s.inputs.start || s.outputs.passed);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-BRT-006"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.step == s.after.step;
}

/// The step one cycle later.
const fn advanced(step: Phase, config: &Config, inputs: &Inputs) -> Phase {
    match step {
        _ if !config.is_tested() => {
            if inputs.start {
                Phase::Good
            } else {
                step
            }
        }
        Phase::Idle | Phase::Good if inputs.start => Phase::TorqueKnown,
        Phase::Defective | Phase::NoCurrent if inputs.start && inputs.safe_now => {
            Phase::TorqueKnown
        }
        // The path counts from when the drive lets go: a brake that does not hold at all lets the axis fall before there is a torque.
        Phase::ControlOff | Phase::TestTorque if inputs.too_far => Phase::Defective,
        Phase::TestTorque if inputs.done && inputs.current => Phase::Good,
        Phase::TestTorque if inputs.done => Phase::NoCurrent,
        Phase::TorqueKnown if inputs.done => Phase::Closes,
        Phase::Closes if inputs.done => Phase::ControlOff,
        Phase::ControlOff if inputs.done => Phase::TestTorque,
        _ => step,
    }
}

pub(crate) const fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let step = advanced(state.step, config, inputs);
    let outputs = Outputs {
        step,
        closed: matches!(step, Phase::Closes | Phase::ControlOff | Phase::TestTorque),
        controlled: !matches!(step, Phase::ControlOff | Phase::TestTorque),
        passed: matches!(step, Phase::Good),
    };
    (State { step }, outputs)
}
