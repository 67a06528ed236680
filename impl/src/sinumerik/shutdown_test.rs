//! Test of the external shutdown, the path over terminal 663; in the NCK channel only (machine `shutdown_test`).
//!
//! The rise of the selection takes away "enable pulses externally" for all drives on that output and starts t_chk. Without
//! the feedback "pulses cancelled" in time: code 1010 and STOP A over the internal path. The safety functions of the axis
//! are not changed by the test. A selection with the pulses already cancelled tests nothing and is not answered: a path
//! that is already off proves nothing.
//!
//! Readings: A-28 EXTTEST_NO_LEVEL (the test is no stop level).

use crate::sinumerik::code::Code;
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::path_test::{Event, advance};

pub use crate::sinumerik::path_test::{Config, Inputs, Phase, State};

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The test runs; message 27006.
        pub active: bool,
        /// The external enable of the pulses as far as the test is concerned: absent while it runs.
        pub enable_external: bool,
        /// STOP A where the test has failed in this cycle, else none.
        pub demand: InternalStop,
        /// 1010 where the test fails, else 0.
        pub code: Code,
        /// The path has been tested: the test ended well in this cycle.
        pub passed: bool,
    }
}

monitor! { sinumerik::shutdown_test;
    /// While the test runs the external enable is absent, and only then.
    test_takes_the_external_enable ["S840D-TEST-016", "S840D-TEST-011", "S840D-SIGNAL-010"]:
        when |s| s.outputs.active || !s.outputs.enable_external
            => s.outputs.active && !s.outputs.enable_external;

    /// The rise of the selection with enabled pulses starts the test with the whole t_chk.
    rise_starts_the_test ["S840D-TEST-016", "S840D-SIGNAL-010"]:
        when |s| !s.inputs.power_on && s.inputs.select && !s.before.selected && s.before.phase == Phase::Idle
            && !s.inputs.pulses_cancelled && !s.inputs.internal_ab && !s.config.t_chk().is_zero()
            => s.after.phase == Phase::Run && s.after.timer == s.config.t_chk();

    /// A test starts by the rise of the selection only, with enabled pulses and without internal STOP A or B.
    starts_with_enabled_pulses_only ["S840D-TEST-016", "S840D-P-55"]:
        when |s| (s.before.phase == Phase::Idle || s.inputs.power_on) && s.after.phase != Phase::Idle
            => s.inputs.select && !s.before.selected && !s.inputs.pulses_cancelled && !s.inputs.internal_ab
                && !s.inputs.power_on;

    /// Awaiting the feedback ends: each cycle the timer is lower, and at its end STOP A is demanded with code 1010.
    missing_feedback_ends_in_stop_a ["S840D-P-29", "S840D-P-35", "S840D-TEST-017", "S840D-PULSE-007", "S840D-KDV-723",
        "S840D-SIGNAL-010"]:
        when |s| s.before.phase == Phase::Run && !s.inputs.power_on && !s.inputs.internal_ab && !s.inputs.pulses_cancelled
            => if s.after.phase == Phase::Run { s.after.timer < s.before.timer }
                else { s.outputs.demand == InternalStop::A && s.outputs.code == Code::EXTERNAL_TEST_FAILED };

    /// Without any time for the feedback the test fails at once.
    no_time_fails_at_once ["S840D-P-29", "S840D-TEST-017"]:
        when |s| !s.inputs.power_on && s.inputs.select && !s.before.selected && s.before.phase == Phase::Idle
            && !s.inputs.pulses_cancelled && !s.inputs.internal_ab && s.config.t_chk().is_zero()
            => s.outputs.demand == InternalStop::A && s.outputs.code == Code::EXTERNAL_TEST_FAILED && !s.outputs.active;

    /// Feedback in the cycle in which t_chk ends is too late.
    feedback_must_be_before_the_end ["S840D-TEST-017"]:
        when |s| s.before.phase == Phase::Run && s.before.timer.count() == 1 && !s.inputs.power_on && !s.inputs.internal_ab
            => s.outputs.demand == InternalStop::A && !s.outputs.active;

    /// Passed means: the feedback came in time while it was awaited, t_chk has passed, the selection is withdrawn.
    passed_means_tested ["S840D-P-55", "S840D-TEST-016"]:
        when |s| s.outputs.passed
            => s.before.phase == Phase::RunOk && !s.inputs.select && s.after.timer.is_zero() && !s.inputs.internal_ab
                && !s.outputs.active;

    /// A test whose feedback has come ends by itself only as passed.
    end_after_feedback_is_a_pass ["S840D-TEST-016"]:
        when |s| s.before.phase == Phase::RunOk && s.after.phase == Phase::Idle && !s.inputs.power_on
            && !s.inputs.internal_ab
            => s.outputs.passed;

    /// The feedback that a passed test rests on came while it was awaited.
    feedback_is_seen_to_change ["S840D-P-55", "S840D-TEST-016"]:
        when |s| s.before.phase != Phase::RunOk && s.after.phase == Phase::RunOk
            => s.before.phase == Phase::Run && s.inputs.pulses_cancelled && !s.inputs.power_on;

    /// The test runs while it is selected and its time runs, unless it fails or a higher stop or power-on ends it.
    held_until_time_and_withdrawal ["S840D-TEST-016"]:
        when |s| s.before.phase == Phase::RunOk && !s.inputs.power_on && !s.inputs.internal_ab
            => s.outputs.active == (s.inputs.select || !s.after.timer.is_zero());

    /// An internal STOP A or B, and power-on, end the test without result and start none.
    higher_stop_ends_the_test ["S840D-TEST-025", "S840D-SH-003"]:
        when |s| s.inputs.internal_ab || s.inputs.power_on
            => !s.outputs.active && !s.outputs.passed && s.outputs.demand == InternalStop::None;

    /// The only stop the test raises is STOP A by its failure, with its code.
    only_failure_stops ["S840D-TEST-017", "S840D-TEST-026"]:
        when |s| s.outputs.demand != InternalStop::None || !s.outputs.code.is_none()
            => s.outputs.demand == InternalStop::A && s.outputs.code == Code::EXTERNAL_TEST_FAILED && !s.outputs.active;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-TEST-016", "S840D-TEST-021"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.active == (s.after.phase != Phase::Idle)
                && s.after.selected == s.inputs.select;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (after, event) = advance(state, config, inputs);
    let failed = event == Event::Failed;
    let outputs = Outputs {
        active: after.active(),
        enable_external: !after.active(),
        demand: if failed {
            InternalStop::A
        } else {
            InternalStop::None
        },
        code: if failed {
            Code::EXTERNAL_TEST_FAILED
        } else {
            Code::NONE
        },
        passed: event == Event::Passed,
    };
    (after, outputs)
}
