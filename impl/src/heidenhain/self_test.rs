//! The self-test of the whole machine, seen by the kernel of one channel.
//!
//! After every start it runs from the configuration through the internal checks, the chain of normally closed contacts and
//! the emergency stop circuit with the control voltage off; then, with the voltage on, the keys free and the doors shut,
//! through the brake control, the cut-out channels and last the holding brakes. Repeated in time, it begins with the
//! holding brakes instead, and switches the drives off after them; the rest is the whole test again (7.1: "the complete
//! safety self-test"). What is tested is the business of each step; this machine keeps their order, waits where a person
//! has something to do, and stops where a step has found a fault. The cycle of the main switch is a reset and nothing else.
//!
//! A brake that does not hold raises no stop, since its drive must hold the axis; but no test is good any more.
//!
//! Recommended readings of the manual implemented here: AMB-37 SS0_PLUS_SS1F, a fault of the brake control is SS0 of the
//! drives concerned and SS1F of all others.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// The interval and the parts that are left out.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        interval: Cycles,
        doors_free: bool,
        no_control: bool,
        cc: bool,
    }
}

impl Config {
    /// `interval`: how long a passed test is good for (SMP511). `doors_free`: the test runs with open doors too (SMP560
    /// bit 1). `no_control`: the brake control is not tested (SMP560 bit 3). `cc`: channel B, which watches that channel A
    /// tests the brake control and switches the drives off.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when `interval` is 0: no test would ever be good.
    pub const fn new(
        interval: Cycles,
        doors_free: bool,
        no_control: bool,
        cc: bool,
    ) -> Result<Self, ConfigError> {
        if interval.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            interval,
            doors_free,
            no_control,
            cc,
        })
    }
}

fields! {
    /// A step of the test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Serial numbers of the components against the stored list.
        #[default]
        Configuration,
        /// Internal checks and watchdogs.
        Internal,
        /// The chain of normally closed contacts.
        Chain,
        /// The emergency stop circuit.
        EsCircuit,
        /// The control voltage must be off.
        VoltageOff,
        /// The operator is asked to switch it on.
        VoltageOn,
        /// No machine key and no permissive is pressed.
        Keys,
        /// The doors are shut.
        Doors,
        /// The brakes can be switched by either channel alone.
        BrakeControl,
        /// Either channel can take the torque away.
        CutOut,
        /// The brakes hold.
        HoldingBrakes,
        /// Repeated test: the drives are switched off after the test of the brakes.
        DrivesOff,
        /// Passed.
        Passed,
        /// Failed: main switch.
        Failed,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The step.
        pub phase: Phase,
        /// The test is a repeated one: its holding brakes came first.
        pub repeated: bool,
        /// How long the last passed test is still good for.
        pub rest: Cycles,
    }
}

impl State {
    /// The control has just been started; nothing is tested.
    pub const INITIAL: Self = Self {
        phase: Phase::Configuration,
        repeated: false,
        rest: Cycles::ZERO,
    };

    /// No test is good for longer than the interval, nor before the first one has passed, nor after one has failed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let tested = self.phase == Phase::Passed || (self.repeated && self.phase != Phase::Failed);
        self.rest <= config.interval
            && (tested || self.rest.is_zero())
            && (self.repeated || self.phase != Phase::DrivesOff)
    }

    /// Whether a test runs.
    pub fn running(&self) -> bool {
        !matches!(self.phase, Phase::Passed | Phase::Failed)
    }

    fn failed(self) -> Self {
        Self {
            phase: Phase::Failed,
            rest: Cycles::ZERO,
            ..self
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// The PLC starts a repeated test.
        pub start: bool,
        /// The serial numbers match the stored list, or the password of the machine builder confirms them.
        pub configured: bool,
        /// The step has done its work.
        pub done: bool,
        /// The step has found a fault of the control or the drives.
        pub fault: bool,
        /// The emergency stop circuit is closed and follows its test pulses.
        pub es_closed: bool,
        /// The control voltage is on.
        pub cvo: bool,
        /// `PP_GenMKG` = 0: no machine key, no permissive pressed.
        pub keys_free: bool,
        /// AUTO is requested for all groups: the doors are shut.
        pub doors_shut: bool,
        /// Channel A has not run the test of the brake control.
        pub omitted: bool,
        /// The path of every braked axis stays within SMP2232.x, and its current rises.
        pub brake_good: bool,
    }
}

impl Inputs {
    /// Whether the doors let the test go on.
    fn doors(&self, config: &Config) -> bool {
        self.doors_shut || config.doors_free
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `NN_GenSafe`: a test has passed and its interval is not over.
        pub gen_safe: bool,
        /// A test runs (M4190).
        pub running: bool,
        /// `NN_BrkActivationTest`.
        pub brake_test: bool,
        /// The operating stop watches the path, not the speed.
        pub path_only: bool,
        /// The operator is asked for the control voltage (M4192).
        pub ask_voltage: bool,
        /// The cut-out channels are tested: the groups may leave STO.
        pub cut_out_done: bool,
        /// The stop to be raised for the whole machine.
        pub demand: Stop,
        /// The stop of the drives whose brake control has failed.
        pub brake_demand: Stop,
    }
}

monitor! { heidenhain::self_test;
    /// A test is good from the cycle in which it passes, for the interval, and not before the first.
    passed_test_is_good_for_the_interval ["HFS-P-30", "HFS-TEST-003", "HFS-TEST-004", "HFS-TEST-030"]:
        when |s| s.before.phase != Phase::Passed && s.after.phase == Phase::Passed
            => s.outputs.gen_safe && s.after.rest == s.config.interval && s.before.phase == if s.before.repeated {
                Phase::CutOut
            } else {
                Phase::HoldingBrakes
            };

    /// The interval runs in operation and during a repeated test.
    interval_runs ["HFS-TEST-001", "HFS-TEST-030"]:
        when |s| !s.inputs.power_on && s.after.phase != Phase::Failed
            && (s.before.phase != Phase::HoldingBrakes || s.inputs.brake_good || !s.inputs.done)
            && (s.before.phase == Phase::Passed || s.after.phase != Phase::Passed)
            => s.after.rest == s.before.rest.tick();

    /// The operator is told exactly whether a test is good.
    gen_safe_tells_the_rest ["HFS-P-30", "HFS-TEST-004"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.gen_safe != s.after.rest.is_zero() && s.outputs.running == s.after.running();

    /// Power-on starts the whole test anew.
    power_on_starts_anew ["HFS-TEST-001", "HFS-SS1F-003"]:
        when |s| s.inputs.power_on
            => s.after == State::INITIAL && !s.outputs.gen_safe && s.outputs.demand == Stop::None;

    /// A configuration that nobody confirms stops the test where it is.
    unknown_configuration_waits ["HFS-TEST-009"]:
        when |s| s.before.phase == Phase::Configuration && !s.inputs.configured
            => s.after.phase == Phase::Configuration && s.outputs.demand == Stop::None;

    /// Circuit open, voltage on too early or not yet, keys pressed, doors open: the test waits, without a stop.
    test_waits_for_people ["HFS-TEST-005", "HFS-TEST-006", "HFS-TEST-011", "HFS-TEST-016", "HFS-TEST-017", "HFS-HW-006"]:
        when |s| !s.inputs.power_on && match s.before.phase {
            Phase::EsCircuit => !s.inputs.es_closed && !s.inputs.fault,
            Phase::VoltageOff => s.inputs.cvo,
            Phase::VoltageOn => !s.inputs.cvo,
            Phase::Keys => !s.inputs.keys_free,
            Phase::Doors => !s.inputs.doors_shut && !s.config.doors_free,
            _ => false,
        }
            => s.after.phase == s.before.phase && s.outputs.demand == Stop::None;

    /// The tests that move or release something go on with the doors shut only.
    open_door_holds_the_test ["HFS-TEST-005", "HFS-TEST-014", "HFS-BRT-004"]:
        when |s| !s.inputs.power_on && !s.inputs.fault && !s.inputs.omitted
            && matches!(s.before.phase, Phase::BrakeControl | Phase::CutOut | Phase::HoldingBrakes)
            && !s.inputs.doors_shut && !s.config.doors_free
            => s.after.phase == s.before.phase && s.outputs.demand == Stop::None;

    /// A fault of the control or the drives ends the test with SS1F.
    fault_ends_the_test ["HFS-TEST-012", "HFS-TEST-015", "HFS-TEST-019", "HFS-TEST-020", "HFS-TEST-021", "HFS-TEST-022",
        "HFS-TEST-023"]:
        when |s| !s.inputs.power_on && s.inputs.fault
            && matches!(s.before.phase, Phase::Internal | Phase::Chain | Phase::BrakeControl | Phase::CutOut
                | Phase::DrivesOff)
            => s.outputs.demand == Stop::Ss1F && s.after.phase == Phase::Failed && !s.outputs.gen_safe;

    /// A fault of the emergency stop circuit is SS1.
    fault_of_the_circuit_is_ss1 ["HFS-TEST-016"]:
        when |s| !s.inputs.power_on && s.inputs.fault && s.before.phase == Phase::EsCircuit
            => s.outputs.demand == Stop::Ss1 && s.after.phase == Phase::EsCircuit;

    /// A fault of the brake control is also SS0 of its drives; nothing else is.
    fault_of_the_brake_control_is_ss0 ["HFS-BCT-002", "HFS-BCT-003"]:
        when |s| s.inputs.fault || s.outputs.brake_demand != Stop::None
            => (s.outputs.brake_demand == Stop::Ss0)
                == (s.before.phase == Phase::BrakeControl && s.inputs.fault && !s.inputs.power_on);

    /// Channel B answers a test of the brake control that channel A leaves out by SS1F.
    channel_b_watches_channel_a ["HFS-BCT-008"]:
        when |s| !s.inputs.power_on && s.config.cc && s.before.phase == Phase::BrakeControl && s.inputs.omitted
            => s.outputs.demand == Stop::Ss1F && s.after.phase == Phase::Failed;

    /// A brake that does not hold keeps the test from passing and leaves no test good, but stops nothing: the drive holds
    /// the axis.
    bad_brake_fails_without_a_stop ["HFS-BRT-001", "HFS-BRT-002", "HFS-BRT-003"]:
        when |s| !s.inputs.power_on && s.before.phase == Phase::HoldingBrakes && s.inputs.done && !s.inputs.brake_good
            && s.inputs.doors(&s.config)
            => s.after.phase == Phase::HoldingBrakes && s.outputs.demand == Stop::None && !s.outputs.gen_safe;

    /// A failed test stays failed until the main switch.
    failure_lasts_until_the_main_switch ["HFS-BRT-002", "HFS-SS1F-003", "HFS-SS0-005"]:
        when |s| s.before.phase == Phase::Failed && !s.inputs.power_on
            => s.after.phase == Phase::Failed && !s.outputs.gen_safe && s.outputs.demand == Stop::None;

    /// A repeated test begins with the holding brakes, and with the doors shut: until then the request waits.
    repeated_test_begins_with_the_brakes ["HFS-ARCH-004/l", "HFS-TEST-014", "HFS-TEST-024", "HFS-TEST-025", "HFS-BRT-005"]:
        when |s| !s.inputs.power_on && s.before.phase == Phase::Passed
            => if s.inputs.start && s.inputs.doors(&s.config) {
                s.after.phase == Phase::HoldingBrakes && s.after.repeated
            } else {
                s.after.phase == Phase::Passed
            };

    /// The drives are off before a repeated test goes on, with the whole self-test.
    drives_are_off_before_the_rest ["HFS-TEST-001", "HFS-TEST-015", "HFS-TEST-025"]:
        when |s| s.before.phase == Phase::DrivesOff && !s.inputs.power_on && !s.inputs.fault
            => s.after.phase == if s.inputs.done { Phase::Configuration } else { Phase::DrivesOff };

    /// The brake control is tested unless SMP560 bit 3 leaves it out.
    brake_control_is_tested ["HFS-BCT-001", "HFS-TEST-008"]:
        when |s| s.before.phase == Phase::Doors && !s.inputs.power_on && s.inputs.doors(&s.config)
            => s.after.phase == if s.config.no_control { Phase::CutOut } else { Phase::BrakeControl };

    /// The safe PLC is told while the brake control is tested, the operating stop while anything of the drives is.
    test_is_told ["HFS-BCT-007", "HFS-TEST-018", "HFS-TEST-011"]:
        when |s| s.outputs.running
            => s.outputs.brake_test == (s.after.phase == Phase::BrakeControl)
                && s.outputs.path_only == (s.after.phase != Phase::Configuration)
                && s.outputs.ask_voltage == (s.after.phase == Phase::VoltageOn);

    /// The drives stay without torque until the cut-out channels are tested.
    no_torque_before_the_cut_out_test ["HFS-TEST-022", "HFS-AXG-002"]:
        when |s| s.outputs.cut_out_done
            => matches!(s.after.phase, Phase::HoldingBrakes | Phase::Passed);

    /// Part 1 begins by itself, without control voltage: configuration, internal monitors, contact chain, emergency stop
    /// circuit. Part 2 follows with the voltage on: keys, doors, brake control, cut-out channels, holding brakes.
    parts_follow_each_other ["HFS-TEST-002", "HFS-TEST-007"]:
        when |s| s.after.phase != s.before.phase && s.after.phase != Phase::Failed && !s.inputs.power_on
            => match s.after.phase {
                Phase::Configuration => s.before.phase == Phase::DrivesOff,
                Phase::Internal => s.before.phase == Phase::Configuration,
                Phase::Chain => s.before.phase == Phase::Internal,
                Phase::EsCircuit => s.before.phase == Phase::Chain,
                Phase::VoltageOff => s.before.phase == Phase::EsCircuit,
                Phase::VoltageOn => s.before.phase == Phase::VoltageOff && !s.inputs.cvo,
                Phase::Keys => s.before.phase == Phase::VoltageOn && s.inputs.cvo,
                Phase::Doors => s.before.phase == Phase::Keys && s.inputs.keys_free,
                Phase::BrakeControl => s.before.phase == Phase::Doors && s.inputs.doors(&s.config),
                Phase::CutOut => matches!(s.before.phase, Phase::BrakeControl | Phase::Doors)
                    && s.inputs.doors(&s.config),
                Phase::HoldingBrakes => matches!(s.before.phase, Phase::CutOut | Phase::Passed)
                    && s.inputs.doors(&s.config),
                Phase::DrivesOff => s.before.phase == Phase::HoldingBrakes,
                Phase::Passed => matches!(s.before.phase, Phase::HoldingBrakes | Phase::CutOut),
                Phase::Failed => true,
            };

    /// The state stays consistent.
    state_stays_consistent ["HFS-TEST-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

/// What a step comes to in one cycle.
enum Outcome {
    /// It goes on.
    Wait,
    /// The next step.
    Next(Phase),
    /// SS1, and the step is tried again.
    Stop,
    /// The test has failed: SS1F.
    Fail,
    /// No test is good any more; the step is tried again.
    Spoilt,
}

/// What the step of `state` comes to.
fn outcome(state: &State, config: &Config, inputs: &Inputs) -> Outcome {
    let when = |condition: bool, next: Phase| {
        if condition {
            Outcome::Next(next)
        } else {
            Outcome::Wait
        }
    };
    let doors = inputs.doors(config);
    let done = inputs.done && doors;
    match state.phase {
        Phase::Internal | Phase::Chain | Phase::BrakeControl | Phase::CutOut | Phase::DrivesOff
            if inputs.fault =>
        {
            Outcome::Fail
        }
        Phase::EsCircuit if inputs.fault => Outcome::Stop,

        Phase::Configuration => when(inputs.configured, Phase::Internal),
        Phase::Internal => when(inputs.done, Phase::Chain),
        Phase::Chain => when(inputs.done, Phase::EsCircuit),
        Phase::EsCircuit => when(inputs.es_closed, Phase::VoltageOff),
        Phase::VoltageOff => when(!inputs.cvo, Phase::VoltageOn),
        Phase::VoltageOn => when(inputs.cvo, Phase::Keys),
        Phase::Keys => when(inputs.keys_free, Phase::Doors),
        Phase::Doors if config.no_control => when(doors, Phase::CutOut),
        Phase::Doors => when(doors, Phase::BrakeControl),
        Phase::BrakeControl if config.cc && inputs.omitted => Outcome::Fail,
        Phase::BrakeControl => when(done, Phase::CutOut),
        Phase::CutOut if state.repeated => when(done, Phase::Passed),
        Phase::CutOut => when(done, Phase::HoldingBrakes),
        Phase::HoldingBrakes if done && !inputs.brake_good => Outcome::Spoilt,
        Phase::HoldingBrakes if state.repeated => when(done, Phase::DrivesOff),
        Phase::HoldingBrakes => when(done, Phase::Passed),
        Phase::DrivesOff => when(inputs.done, Phase::Configuration),
        Phase::Passed => when(inputs.start && doors, Phase::HoldingBrakes),
        Phase::Failed => Outcome::Wait,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.power_on {
        return (State::INITIAL, shown(State::INITIAL));
    }
    let before = State {
        rest: state.rest.tick(),
        ..state
    };
    let (after, demand) = match outcome(&before, config, inputs) {
        Outcome::Wait => (before, Stop::None),
        Outcome::Stop => (before, Stop::Ss1),
        Outcome::Fail => (before.failed(), Stop::Ss1F),
        Outcome::Spoilt => {
            let spoilt = State {
                rest: Cycles::ZERO,
                ..before
            };
            (spoilt, Stop::None)
        }
        Outcome::Next(Phase::Passed) => {
            let passed = State {
                phase: Phase::Passed,
                repeated: false,
                rest: config.interval,
            };
            (passed, Stop::None)
        }
        Outcome::Next(phase) => {
            let repeated = before.repeated || before.phase == Phase::Passed;
            let next = State {
                phase,
                repeated,
                ..before
            };
            (next, Stop::None)
        }
    };
    let brake_fault = before.phase == Phase::BrakeControl && inputs.fault;
    let outputs = Outputs {
        demand,
        brake_demand: if brake_fault { Stop::Ss0 } else { Stop::None },
        ..shown(after)
    };
    (after, outputs)
}

/// What a state shows, without a stop.
fn shown(state: State) -> Outputs {
    let running = state.running();
    Outputs {
        gen_safe: !state.rest.is_zero(),
        running,
        brake_test: state.phase == Phase::BrakeControl,
        path_only: running && state.phase != Phase::Configuration,
        ask_voltage: state.phase == Phase::VoltageOn,
        cut_out_done: matches!(state.phase, Phase::HoldingBrakes | Phase::Passed),
        demand: Stop::None,
        brake_demand: Stop::None,
    }
}
