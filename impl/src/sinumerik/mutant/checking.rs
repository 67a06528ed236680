//! Mutants of the monitors that check the monitoring.

use crate::kernel::Cycles;
use crate::sinumerik::compare::list::Kind;
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::{
    compare, forced_check, history, pulses, relay, shutdown_test, slip, test_stop,
};

variants! { sinumerik::test_stop:
    /// Feedback in the cycle in which t_chk ends still counts.
    "test-stop-late-feedback" |state, config, inputs| {
        let mut state = state;
        if state.phase == test_stop::Phase::Run && inputs.pulses_cancelled {
            state.timer = state.timer.max(Cycles::new(2));
        }
        test_stop::transition(state, config, inputs)
    }

    /// The test passes without feedback.
    "test-stop-without-feedback" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.pulses_cancelled |= state.phase == test_stop::Phase::Run;
        test_stop::transition(state, config, &inputs)
    }
}

variants! { sinumerik::shutdown_test:
    /// A failed test raises no stop.
    "shutdown-test-silent" |state, config, inputs| {
        let (after, mut outputs) = shutdown_test::transition(state, config, inputs);
        outputs.demand = InternalStop::None;
        (after, outputs)
    }
}

variants! { sinumerik::pulses:
    /// A failed internal cancellation does not take the external enable away.
    "pulses-no-fallback" |state, config, inputs| {
        let mut state = state;
        if state.timer == Cycles::new(1) {
            state.timer = Cycles::new(2);
        }
        pulses::transition(state, config, inputs)
    }

    /// The pulses are enabled before the run-up is complete.
    "pulses-before-run-up" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.run_up = true;
        pulses::transition(state, config, &inputs)
    }
}

variants! { sinumerik::compare:
    /// Static items are not compared either while a signal changes.
    "compare-static-suspended" |state, config, inputs| {
        let mut inputs = *inputs;
        let static_item = state.due(config, inputs.power_on).kind() == Kind::Static;
        inputs.differs &= !(static_item && (inputs.change || inputs.other_changing));
        compare::transition(state, config, &inputs)
    }

    /// The checking timer starts anew instead of ending.
    "compare-checking-restarts" |state, config, inputs| {
        let mut state = state;
        state.checking &= !inputs.change;
        if state.check_timer == Cycles::new(1) {
            state.checking = false;
        }
        compare::transition(state, config, inputs)
    }

    /// A change of a signal begins the list anew.
    "compare-skips-after-change" |state, config, inputs| {
        let (mut after, outputs) = compare::transition(state, config, inputs);
        if inputs.change {
            after.item = 0;
        }
        (after, outputs)
    }
}

variants! { sinumerik::slip:
    /// Each channel corrects the whole difference.
    "slip-whole-difference" |state, config, inputs| {
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
}

variants! { sinumerik::history:
    /// A difference equal to the tolerance fails.
    "history-at-tolerance" |state, config, inputs| {
        let (after, mut outputs) = history::transition(state, config, inputs);
        let expected = i64::from(state.standstill.0) + i64::from(inputs.travelled);
        let apart = i64::from(inputs.refpos.0).abs_diff(expected);
        outputs.history_ok &= apart < u64::from(config.tol().0);
        (after, outputs)
    }

    /// The reference position overwrites the stored one before they are compared.
    "history-overtaken" |state, config, inputs| {
        let inputs = history::Inputs {
            reached: false,
            ..*inputs
        };
        history::transition(state, config, &inputs)
    }
}

variants! { sinumerik::forced_check:
    /// The test of one path is enough.
    "forced-check-one-path" |state, config, inputs| {
        let (after, mut outputs) = forced_check::transition(state, config, inputs);
        outputs.due = after.drive.is_zero() && after.nck.is_zero();
        (after, outputs)
    }
}

variants! { sinumerik::relay:
    /// Of several shutdowns only the last one counts for the window.
    "relay-counts-last-shutdown" |state, config, inputs| {
        let (mut after, outputs) = relay::transition(state, config, inputs);
        if after.armed {
            after.least = after.left;
        }
        (after, outputs)
    }

    /// The button acknowledges as long as it is pressed.
    "relay-held-button" |mut state, config, inputs| {
        state.held_1 &= inputs.power_on;
        relay::transition(state, config, inputs)
    }

    /// A button that is pressed during the run-up acknowledges in the next cycle.
    "relay-button-at-run-up" |state, config, inputs| {
        let (mut after, outputs) = relay::transition(state, config, inputs);
        after.held_1 &= !inputs.power_on;
        (after, outputs)
    }

    /// An acknowledged shutdown leaves the delays as they were.
    "relay-delay-goes-on" |state, config, inputs| {
        let (mut after, outputs) = relay::transition(state, config, inputs);
        if after.on {
            after.off_3 = state.off_3.tick();
        }
        (after, outputs)
    }
}
