//! Mutants of the monitors that check the monitoring.

use crate::kernel::Cycles;
use crate::sinumerik::compare::list::Kind;
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::{compare, forced_check, history, pulses, shutdown_test, slip, test_stop};

pub(super) fn test_stop_late_feedback(
    state: test_stop::State,
    config: &test_stop::Config,
    inputs: &test_stop::Inputs,
) -> (test_stop::State, test_stop::Outputs) {
    let mut state = state;
    if state.phase == test_stop::Phase::Run && inputs.pulses_cancelled {
        state.timer = state.timer.max(Cycles::new(2));
    }
    test_stop::transition(state, config, inputs)
}

pub(super) fn test_stop_without_feedback(
    state: test_stop::State,
    config: &test_stop::Config,
    inputs: &test_stop::Inputs,
) -> (test_stop::State, test_stop::Outputs) {
    let mut inputs = *inputs;
    inputs.pulses_cancelled |= state.phase == test_stop::Phase::Run;
    test_stop::transition(state, config, &inputs)
}

pub(super) fn shutdown_test_silent(
    state: shutdown_test::State,
    config: &shutdown_test::Config,
    inputs: &shutdown_test::Inputs,
) -> (shutdown_test::State, shutdown_test::Outputs) {
    let (after, mut outputs) = shutdown_test::transition(state, config, inputs);
    outputs.demand = InternalStop::None;
    (after, outputs)
}

pub(super) fn pulses_no_fallback(
    state: pulses::State,
    config: &pulses::Config,
    inputs: &pulses::Inputs,
) -> (pulses::State, pulses::Outputs) {
    let mut state = state;
    if state.timer == Cycles::new(1) {
        state.timer = Cycles::new(2);
    }
    pulses::transition(state, config, inputs)
}

pub(super) fn pulses_before_run_up(
    state: pulses::State,
    config: &pulses::Config,
    inputs: &pulses::Inputs,
) -> (pulses::State, pulses::Outputs) {
    let mut inputs = *inputs;
    inputs.run_up = true;
    pulses::transition(state, config, &inputs)
}

pub(super) fn compare_static_suspended(
    state: compare::State,
    config: &compare::Config,
    inputs: &compare::Inputs,
) -> (compare::State, compare::Outputs) {
    let mut inputs = *inputs;
    let static_item = state.due(config, inputs.power_on).kind() == Kind::Static;
    inputs.differs &= !(static_item && (inputs.change || inputs.other_changing));
    compare::transition(state, config, &inputs)
}

pub(super) fn compare_checking_restarts(
    state: compare::State,
    config: &compare::Config,
    inputs: &compare::Inputs,
) -> (compare::State, compare::Outputs) {
    let mut state = state;
    state.checking &= !inputs.change;
    if state.check_timer == Cycles::new(1) {
        state.checking = false;
    }
    compare::transition(state, config, inputs)
}

pub(super) fn compare_skips_after_change(
    state: compare::State,
    config: &compare::Config,
    inputs: &compare::Inputs,
) -> (compare::State, compare::Outputs) {
    let (mut after, outputs) = compare::transition(state, config, inputs);
    if inputs.change {
        after.item = 0;
    }
    (after, outputs)
}

pub(super) fn slip_whole_difference(
    state: slip::State,
    config: &slip::Config,
    inputs: &slip::Inputs,
) -> (slip::State, slip::Outputs) {
    let (after, outputs) = slip::transition(state, config, inputs);
    let rest = after.ahead(inputs.own, inputs.other);
    if inputs.due && rest.unsigned_abs() > 1 {
        let after = slip::State {
            offset: after.offset - rest,
        };
        let position = after.correct(inputs.own);
        (
            after,
            slip::Outputs {
                position,
                ..outputs
            },
        )
    } else {
        (after, outputs)
    }
}

pub(super) fn history_at_tolerance(
    state: history::State,
    config: &history::Config,
    inputs: &history::Inputs,
) -> (history::State, history::Outputs) {
    let (after, mut outputs) = history::transition(state, config, inputs);
    let expected = i64::from(state.standstill.0) + i64::from(inputs.travelled);
    let apart = i64::from(inputs.refpos.0).abs_diff(expected);
    outputs.history_ok &= apart < u64::from(config.tol().0);
    (after, outputs)
}

pub(super) fn history_overtaken(
    state: history::State,
    config: &history::Config,
    inputs: &history::Inputs,
) -> (history::State, history::Outputs) {
    let inputs = history::Inputs {
        reached: false,
        ..*inputs
    };
    history::transition(state, config, &inputs)
}

pub(super) fn forced_check_one_path(
    state: forced_check::State,
    config: &forced_check::Config,
    inputs: &forced_check::Inputs,
) -> (forced_check::State, forced_check::Outputs) {
    let (after, mut outputs) = forced_check::transition(state, config, inputs);
    outputs.due = after.drive.is_zero() && after.nck.is_zero();
    (after, outputs)
}
