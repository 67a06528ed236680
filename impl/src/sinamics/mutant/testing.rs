//! Wrong variants of the tests of the switch-off paths.

use crate::kernel::Cycles;
use crate::sinamics::{drive_test, path_test};

variants! { sinamics::drive_test:
    /// A test begins beside STO.
    "drive-test-beside-sto" |state, config, inputs| {
        let stop = inputs.stop && state.phase == drive_test::Phase::Running;
        let inputs = drive_test::Inputs { stop, ..*inputs };
        drive_test::transition(state, config, &inputs)
    }

    /// A test that was begun is no longer due.
    "drive-test-passed-at-once" |state, config, inputs| {
        let (mut after, mut outputs) = drive_test::transition(state, config, inputs);
        if outputs.sto {
            after.left = Cycles::new(1);
            after.due = false;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// Pulses that stay are waited for.
    "drive-test-patient" |state, config, inputs| {
        let pulses_left = if state.pulses_left == Cycles::new(1) { Cycles::new(2) } else { state.pulses_left };
        drive_test::transition(drive_test::State { pulses_left, ..state }, config, inputs)
    }

    /// An aborted automatic test does not come back.
    "drive-test-gives-up" |state, config, inputs| {
        let (mut after, outputs) = drive_test::transition(state, config, inputs);
        if after.phase == drive_test::Phase::Retry {
            after.phase = drive_test::Phase::Idle;
            after.by_itself = false;
        }
        (after, outputs)
    }

    /// A held request begins a test.
    "drive-test-static-request" |state, config, inputs| {
        let state = drive_test::State { request_held: false, ..state };
        drive_test::transition(state, config, inputs)
    }

    /// A path error passes.
    "drive-test-forgives" |state, config, inputs| {
        let inputs = drive_test::Inputs { path_error: false, ..*inputs };
        drive_test::transition(state, config, &inputs)
    }

    /// POWER ON leaves the interval.
    "drive-test-remembers" |state, config, inputs| {
        let (mut after, mut outputs) = drive_test::transition(state, config, inputs);
        if inputs.power_on && !state.due {
            after.due = false;
            after.left = state.left;
            outputs.due = false;
        }
        (after, outputs)
    }
}

variants! { sinamics::path_test:
    /// The selection begins the interval anew.
    "path-test-counts-from-selection" |state, config, inputs| {
        let (mut after, mut outputs) = path_test::transition(state, config, inputs);
        if inputs.selected && !state.selected_held {
            after.left = state.left.max(Cycles::new(1));
            outputs.left = after.left;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// A failed test clears the alarm.
    "path-test-forgives" |state, config, inputs| {
        let inputs = path_test::Inputs { path_error: false, ..*inputs };
        path_test::transition(state, config, &inputs)
    }

    /// The terminals are compared in a test stop.
    "path-test-compares-terminals" |state, config, inputs| {
        let inputs = path_test::Inputs { extended_sto: false, ..*inputs };
        path_test::transition(state, config, &inputs)
    }

    /// The test stop of the Extended Functions does not test the paths.
    "path-test-basic-only" |state, config, inputs| {
        let inputs = path_test::Inputs { test_stop: false, ..*inputs };
        path_test::transition(state, config, &inputs)
    }
}
