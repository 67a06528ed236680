//! Wrong monitors of tests, messages and modes.

use crate::kernel::Cycles;
use crate::sinamics::{acceptance_mode, commissioning, io_test, message_buffer, replacement};

variants! { sinamics::io_test:
    /// The test is over when its start signal falls.
    "io-test-breaks-off" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if outputs.running && !inputs.start {
            after.step = io_test::TestStep::Idle;
            after.timer = Cycles::ZERO;
            outputs.running = false;
        }
        (after, outputs)
    }

    /// A failed test begins the interval.
    "io-test-failed-is-done" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if after.failed {
            after.interval = config.interval;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// Each start begins the interval (reading TTIMER_ON_START).
    "io-test-timer-on-start" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if outputs.running && state.step == io_test::TestStep::Idle {
            after.interval = config.interval;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// What is read back is not looked at in the third step.
    "io-test-skips-a-level" |state, config, inputs| {
        let inputs = io_test::Inputs {
            read_back: if state.step == io_test::TestStep::Output3 {
                state.step.expected(config.mode)
            } else {
                inputs.read_back
            },
            ..*inputs
        };
        io_test::transition(state, config, &inputs)
    }

    /// Both supplies are off in the second step (reading T2_OFF_OFF).
    "io-test-both-off" |state, config, inputs| {
        let (after, mut outputs) = io_test::transition(state, config, inputs);
        outputs.l1 &= after.step != io_test::TestStep::SecondInputs || after.failed;
        (after, outputs)
    }
}

variants! { sinamics::message_buffer:
    /// The ninth message is lost.
    "message-buffer-full" |state, config, inputs| {
        let inputs = message_buffer::Inputs {
            message: if state.current.len() == message_buffer::MESSAGES { 0 } else { inputs.message },
            ..*inputs
        };
        message_buffer::transition(state, config, &inputs)
    }

    /// An acknowledgement moves the whole case.
    "message-buffer-moves-all" |state, config, inputs| {
        let inputs = message_buffer::Inputs {
            rectified: if inputs.rectified == 0 { 0 } else { u8::MAX },
            ..*inputs
        };
        message_buffer::transition(state, config, &inputs)
    }

    /// The new case takes the place of case 1.
    "message-buffer-overwrites" |state, config, inputs| {
        let (mut after, outputs) = message_buffer::transition(state, config, inputs);
        if after.acknowledged != state.acknowledged && inputs.acknowledge {
            after.acknowledged[1] = message_buffer::Case::EMPTY;
        }
        (after, outputs)
    }

    /// A message that is written over the eighth is no change.
    "message-buffer-counts-places" |state, config, inputs| {
        let (mut after, mut outputs) = message_buffer::transition(state, config, inputs);
        if after.current.len() == state.current.len() && after.acknowledged == state.acknowledged {
            after.changes = state.changes;
            outputs.changed = false;
        }
        (after, outputs)
    }
}

variants! { sinamics::acceptance_mode:
    /// The time begins anew with each acknowledgement.
    "acceptance-mode-prolonged" |state, config, inputs| {
        let (mut after, outputs) = acceptance_mode::transition(state, config, inputs);
        if outputs.new_reference {
            after.left = config.duration;
        }
        (after, outputs)
    }

    /// SOS is taught anew outside the mode too.
    "acceptance-mode-always-teaches" |state, config, inputs| {
        let (after, mut outputs) = acceptance_mode::transition(state, config, inputs);
        outputs.new_reference = inputs.sos_acknowledged;
        (after, outputs)
    }

    /// The mode begins again by itself while p9570 stays set.
    "acceptance-mode-endless" |mut state, config, inputs| {
        state.requested &= state.left > Cycles::new(0);
        acceptance_mode::transition(state, config, inputs)
    }
}

variants! { sinamics::commissioning:
    /// The mode is left whatever the checksum of the Motor Module is.
    "commissioning-one-checksum" |state, config, inputs| {
        let inputs = commissioning::Inputs { checksum_motor_module: true, ..*inputs };
        commissioning::transition(state, config, &inputs)
    }

    /// Operation goes on without POWER ON.
    "commissioning-without-power-on" |state, config, inputs| {
        let (mut after, mut outputs) = commissioning::transition(state, config, inputs);
        if after.phase == commissioning::Phase::WaitPowerOn {
            after.phase = commissioning::Phase::Operate;
            outputs.power_on_required = false;
            outputs.pulses_off = false;
        }
        (after, outputs)
    }

    /// Parameters are taken in operation.
    "commissioning-open" |state, config, inputs| {
        let (after, mut outputs) = commissioning::transition(state, config, inputs);
        outputs.accepted = inputs.write;
        (after, outputs)
    }

    /// Parameters that were not copied may be left.
    "commissioning-uncopied" |state, config, inputs| {
        let inputs = commissioning::Inputs { copy: inputs.copy || inputs.leave, ..*inputs };
        let (mut after, outputs) = commissioning::transition(state, config, &inputs);
        after.copied &= state.copied && !inputs.write;
        (after, outputs)
    }
}

variants! { sinamics::replacement:
    /// What was acknowledged is not told again.
    "replacement-told-once" |mut state, config, inputs| {
        state.foreign &= state.message != replacement::Message::None || !inputs.power_on;
        replacement::transition(state, config, inputs)
    }

    /// Saving is enough.
    "replacement-unconfirmed" |state, config, inputs| {
        let inputs = replacement::Inputs { confirm: inputs.confirm || inputs.save, ..*inputs };
        replacement::transition(state, config, &inputs)
    }

    /// One confirmation is for every component that follows.
    "replacement-confirmed-for-ever" |state, config, inputs| {
        let (mut after, outputs) = replacement::transition(state, config, inputs);
        after.confirmed |= state.confirmed;
        (after, outputs)
    }
}
