//! Brake test by the test stop (p10203 = 2): one request runs the brake test, and then the test stop.
//!
//! Only the motor holding brake that is brake 1 is tested so, with sequence 1 and the sign of p10218. Whatever comes of the brake test,
//! the test stop follows. Reading AF-11 is a choice of the configuration, the recommended one first.

use crate::sinamics::brake_test::Choice;
use crate::sinamics::types::rises;

fields! {
    /// Reading AF-11: whether the automatic test stop at POWER ON runs the brake test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbtAuto {
        /// Never: no torque is built up at power-up.
        #[default]
        Skip,
        /// As any other.
        Run,
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// p10203 is 2.
        pub by_test_stop: bool,
        /// p10218: the torque is negative.
        pub negative: bool,
        /// What the automatic test stop does.
        pub automatic: SbtAuto,
    }
    accepted |_config| true
}

fields! {
    /// How far a request is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// There is none.
        #[default]
        Idle,
        /// The brake test is selected.
        Selected,
        /// Its sequence is started.
        Started,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the request is.
        pub phase: Phase,
        /// The request in the cycle before.
        pub request_held: bool,
    }
}

impl State {
    /// No request; one counts once it has been 0.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        request_held: true,
    };

    /// A brake test is asked for only where it belongs to the test stop.
    pub fn invariant(&self, config: &Config) -> bool {
        config.by_test_stop || self.phase == Phase::Idle
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The request: p9705 or S_STW1B.8.
        pub request: bool,
        /// POWER ON asks for the automatic test stop.
        pub automatic: bool,
        /// The brake test is ready for a sequence.
        pub ready: bool,
        /// Its sequence is complete.
        pub complete: bool,
        /// It was refused, or has ended before.
        pub ended: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The brake test is selected (r10231.0).
        pub select: bool,
        /// Its sequence is started (r10231.1).
        pub start: bool,
        /// What it tests.
        pub choice: Choice,
        /// The test stop begins.
        pub test_stop: bool,
    }
}

/// A test stop is asked for in a cycle in which none is under way.
fn asked(s: &Step) -> bool {
    s.before.phase == Phase::Idle
        && (s.inputs.request && !s.before.request_held || s.inputs.automatic)
}

monitor! { sinamics::brake_test_request;
    /// An edge of the request selects the brake test first, but for one that comes with the automatic test stop.
    brake_test_comes_first ["S120-SBT-015"]:
        when |s| s.config.by_test_stop && s.before.phase == Phase::Idle && s.inputs.request && !s.before.request_held
            && !(s.inputs.automatic && s.config.automatic == SbtAuto::Skip)
            => s.outputs.select && !s.outputs.test_stop;

    /// Without p10203 = 2 the test stop begins at once.
    test_stop_alone ["S120-SBT-015", "S120-TEST-007"]:
        when |s| !s.config.by_test_stop
            => s.outputs.test_stop == asked(&s) && !s.outputs.select && !s.outputs.start;

    /// So does the automatic one at POWER ON (AF-11).
    automatic_skips_the_brake ["S120-SBT-015", "S120-TEST-004"]:
        when |s| s.config.by_test_stop && s.config.automatic == SbtAuto::Skip && s.inputs.automatic
            && s.before.phase == Phase::Idle
            => s.outputs.test_stop && !s.outputs.select;

    /// The sequence is started when the brake test is ready, never sooner.
    start_waits ["S120-SBT-006", "S120-SBT-015"]:
        when |s| s.before.phase == Phase::Selected && !s.inputs.ended
            => s.outputs.select && s.outputs.start == s.inputs.ready;

    /// The end of the sequence, good or bad, withdraws start and selection and begins the test stop.
    test_stop_follows ["S120-SBT-015"]:
        when |s| s.before.phase == Phase::Started && s.inputs.complete || s.before.phase != Phase::Idle && s.inputs.ended
            => s.outputs.test_stop && !s.outputs.select && !s.outputs.start && s.after.phase == Phase::Idle;

    /// It does not begin beside a brake test.
    never_both ["S120-SBT-015", "S120-PF-22"]:
        when |s| s.outputs.test_stop
            => !s.outputs.select && !s.outputs.start;

    /// Brake 1, sequence 1, and the sign of p10218.
    choice_is_fixed ["S120-SBT-015"]:
        when |s| s.outputs.select
            => !s.outputs.choice.second_brake && !s.outputs.choice.second_sequence
                && s.outputs.choice.negative == s.config.negative;

    /// A level asks for nothing.
    request_is_an_edge ["S120-SBT-015"]:
        when |s| s.before.phase == Phase::Idle && s.before.request_held && !s.inputs.automatic
            => !s.outputs.select && !s.outputs.test_stop;

    /// The state stays consistent.
    state_stays_consistent ["S120-SBT-015"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.request_held == s.inputs.request;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let edge = rises(inputs.request, state.request_held);
    let skips = inputs.automatic && config.automatic == SbtAuto::Skip;
    let with_brake = config.by_test_stop && (edge || inputs.automatic) && !skips;
    let (phase, test_stop) = match state.phase {
        Phase::Idle if with_brake => (Phase::Selected, false),
        Phase::Idle => (Phase::Idle, edge || inputs.automatic),
        _ if inputs.ended => (Phase::Idle, true),
        Phase::Selected if inputs.ready => (Phase::Started, false),
        Phase::Selected => (Phase::Selected, false),
        Phase::Started if inputs.complete => (Phase::Idle, true),
        Phase::Started => (Phase::Started, false),
    };
    let outputs = Outputs {
        select: phase != Phase::Idle,
        start: phase == Phase::Started,
        choice: Choice {
            negative: config.negative,
            ..Choice::default()
        },
        test_stop,
    };
    let after = State {
        phase,
        request_held: inputs.request,
    };
    (after, outputs)
}
