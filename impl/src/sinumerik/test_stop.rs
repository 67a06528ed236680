//! Test of the shutdown path of one channel (machine M6 `test`).
//!
//! The rise of the selection cancels the pulses through this channel only and starts t_chk. Without the feedback "pulses
//! cancelled" in time STOP A follows (code 1009, alarm 27024/300900); with it the cancellation is held until t_chk has
//! passed and the selection is withdrawn, and the path counts as tested. The test ranks between STOP B and STOP C: an
//! internal STOP A or B ends it without result and suppresses its selection.
//!
//! Readings: A-27 (B and A win, RESET has no effect: it is no input), A-35 TEST_EXTA_1005 (an external STOP A has
//! cancelled the pulses: the test is refused like any other with cancelled pulses, so the external STOP A is no input
//! either), A-32 TEST_ENV (standstill before the test is a duty of the user, S840D-TEST-031).

use crate::sinumerik::code::Code;
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::path_test::{Event, advance};

pub use crate::sinumerik::path_test::{Config, Inputs, Phase, State};

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The test runs: the pulses are to be cancelled through this channel; message 27002/300951.
        pub active: bool,
        /// STOP A where the test has failed in this cycle, else none.
        pub demand: InternalStop,
        /// The test was refused in this cycle, the pulses being cancelled already: STOP F.
        pub refused: bool,
        /// 1005 where the test is refused, 1009 where it fails, else 0.
        pub code: Code,
        /// The path has been tested: the test ended well in this cycle.
        pub passed: bool,
    }
}

monitor! { sinumerik::test_stop;
    /// A test selected while the pulses are cancelled is refused with code 1005, unless STOP A or B holds internally.
    cancelled_pulses_refuse_the_test ["S840D-P-28", "S840D-TEST-008", "S840D-TEST-030", "S840D-ALARM-736",
        "S840D-TEST-007", "S840D-TEST-013", "S840D-KDV-721"]:
        when |s| !s.inputs.power_on && s.inputs.select && !s.before.selected && s.before.phase == Phase::Idle
            && s.inputs.pulses_cancelled && !s.inputs.internal_ab
            => s.outputs.refused && s.outputs.code == Code::ALREADY_CANCELLED && !s.outputs.active;

    /// A test is refused for that reason only.
    refused_for_cancelled_pulses_only ["S840D-TEST-008"]:
        when |s| s.outputs.refused
            => s.inputs.pulses_cancelled && s.inputs.select && !s.before.selected && !s.inputs.internal_ab
                && !s.inputs.power_on && s.before.phase == Phase::Idle;

    /// The rise of the selection with enabled pulses starts the test with the whole t_chk.
    rise_starts_the_test ["S840D-TEST-009", "S840D-TEST-010", "S840D-TEST-015", "S840D-SH-002/c", "S840D-TEST-031",
        "S840D-SIGNAL-009"]:
        when |s| !s.inputs.power_on && s.inputs.select && !s.before.selected && s.before.phase == Phase::Idle
            && !s.inputs.pulses_cancelled && !s.inputs.internal_ab && !s.config.t_chk().is_zero()
            => s.after.phase == Phase::Run && s.after.timer == s.config.t_chk() && s.outputs.active;

    /// A test starts by the rise of the selection only, and not while STOP A or B holds internally.
    starts_on_the_rise_only ["S840D-TEST-025", "S840D-TEST-030"]:
        when |s| (s.before.phase == Phase::Idle || s.inputs.power_on) && s.after.phase != Phase::Idle
            => s.inputs.select && !s.before.selected && !s.inputs.internal_ab && !s.inputs.power_on;

    /// Awaiting the feedback ends: each cycle the timer is lower, and at its end STOP A is demanded.
    missing_feedback_ends_in_stop_a ["S840D-P-29", "S840D-P-35", "S840D-TEST-012", "S840D-PULSE-007", "S840D-KDV-723",
        "S840D-SIGNAL-008", "S840D-SIGNAL-009", "S840D-MDTIM-015"]:
        when |s| s.before.phase == Phase::Run && !s.inputs.power_on && !s.inputs.internal_ab && !s.inputs.pulses_cancelled
            => if s.after.phase == Phase::Run { s.after.timer < s.before.timer }
                else { s.outputs.demand == InternalStop::A && s.outputs.code == Code::TEST_FAILED };

    /// Without any time for the feedback the test fails at once.
    no_time_fails_at_once ["S840D-P-29", "S840D-TEST-012"]:
        when |s| !s.inputs.power_on && s.inputs.select && !s.before.selected && s.before.phase == Phase::Idle
            && !s.inputs.pulses_cancelled && !s.inputs.internal_ab && s.config.t_chk().is_zero()
            => s.outputs.demand == InternalStop::A && s.outputs.code == Code::TEST_FAILED && !s.outputs.active;

    /// Feedback in the cycle in which t_chk ends is too late.
    feedback_must_be_before_the_end ["S840D-P-29", "S840D-TEST-012"]:
        when |s| s.before.phase == Phase::Run && s.before.timer.count() == 1 && !s.inputs.power_on && !s.inputs.internal_ab
            => s.outputs.demand == InternalStop::A && !s.outputs.active;

    /// Feedback in time is kept: the test goes on without stop, whatever the feedback shows later.
    feedback_in_time_is_kept ["S840D-P-29", "S840D-TEST-009", "S840D-TEST-022", "S840D-TEST-020", "S840D-MDTIM-015"]:
        when |s| !s.inputs.power_on && !s.inputs.internal_ab
            && (s.before.phase == Phase::RunOk
                || s.before.phase == Phase::Run && s.inputs.pulses_cancelled && s.before.timer.count() > 1)
            => s.outputs.demand == InternalStop::None && s.after.timer == s.before.timer.tick()
                && (s.after.phase == Phase::RunOk || s.outputs.passed);

    /// The cancellation is held until t_chk has passed and the selection is withdrawn, whichever comes last.
    held_until_time_and_withdrawal ["S840D-TEST-009", "S840D-TEST-029", "S840D-SIGNAL-009"]:
        when |s| s.before.phase == Phase::RunOk && !s.inputs.power_on && !s.inputs.internal_ab
            => s.outputs.active == (s.inputs.select || !s.after.timer.is_zero());

    /// An early withdrawal of the selection neither ends the test nor its check.
    early_withdrawal_changes_nothing ["S840D-TEST-029"]:
        when |s| s.before.phase != Phase::Idle && s.before.timer.count() > 1 && !s.inputs.select && !s.inputs.power_on
            && !s.inputs.internal_ab
            => s.outputs.active && !s.outputs.passed;

    /// Passed means: the feedback had come in time, t_chk has passed, the selection is withdrawn.
    passed_means_tested ["S840D-P-55", "S840D-TEST-009", "S840D-TEST-015"]:
        when |s| s.outputs.passed
            => s.before.phase == Phase::RunOk && !s.inputs.select && s.after.timer.is_zero() && !s.inputs.internal_ab
                && !s.outputs.active;

    /// The feedback that a passed test rests on came while it was awaited: it was absent at the start and present then.
    feedback_is_seen_to_change ["S840D-P-55", "S840D-TEST-022", "S840D-SIGNAL-008"]:
        when |s| s.before.phase != Phase::RunOk && s.after.phase == Phase::RunOk
            => s.before.phase == Phase::Run && s.inputs.pulses_cancelled && !s.inputs.power_on;

    /// An internal STOP A or B ends the test without result.
    higher_stop_ends_the_test ["S840D-TEST-025"]:
        when |s| s.inputs.internal_ab
            => !s.outputs.active && !s.outputs.passed && s.outputs.demand == InternalStop::None && !s.outputs.refused;

    /// Power-on ends the test without result and starts none.
    power_on_ends_the_test ["S840D-SH-003"]:
        when |s| s.inputs.power_on
            => !s.outputs.active && !s.outputs.passed && s.outputs.demand == InternalStop::None && !s.outputs.refused;

    /// The only stop a test raises is STOP A, by its failure; the code names the reason.
    only_failure_stops ["S840D-P-29", "S840D-TEST-012", "S840D-TEST-026"]:
        when |s| s.outputs.demand != InternalStop::None || !s.outputs.code.is_none()
            => (s.outputs.demand == InternalStop::A && s.outputs.code == Code::TEST_FAILED && !s.outputs.refused)
                || (s.outputs.demand == InternalStop::None && s.outputs.refused && s.outputs.code == Code::ALREADY_CANCELLED);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-TEST-015", "S840D-TEST-021"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.active == (s.after.phase != Phase::Idle)
                && s.after.selected == s.inputs.select;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (after, event) = advance(state, config, inputs);
    let (demand, code) = match event {
        Event::AlreadyOff => (InternalStop::None, Code::ALREADY_CANCELLED),
        Event::Failed => (InternalStop::A, Code::TEST_FAILED),
        Event::None | Event::Passed => (InternalStop::None, Code::NONE),
    };
    let outputs = Outputs {
        active: after.active(),
        demand,
        refused: event == Event::AlreadyOff,
        code,
        passed: event == Event::Passed,
    };
    (after, outputs)
}
