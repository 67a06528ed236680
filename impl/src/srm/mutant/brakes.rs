//! Wrong variants of the brake test.

use crate::kernel::Cycles;
use crate::srm::brake_test::{self, Phase, SbtFresh, Status};

variants! { srm::brake_test:
    /// The levels of the drive alone decide.
    "brake-test-level" |state, config, inputs| {
        let config = brake_test::Config { sbt_fresh: SbtFresh::Level, ..*config };
        brake_test::transition(state, &config, inputs)
    }

    /// That the drive has run counts for the sequences after it too.
    "brake-test-ran-once" |state, config, inputs| {
        let (mut after, outputs) = brake_test::transition(state, config, inputs);
        after.ran |= state.ran && after.phase.tests();
        (after, outputs)
    }

    /// Brake 2 is not tested.
    "brake-test-one-brake" |state, config, inputs| {
        let keeps = *config;
        let config = brake_test::Config { sequence_br_2: 0, ..*config };
        if state.second {
            return brake_test::transition(state, &keeps, inputs);
        }
        brake_test::transition(state, &config, inputs)
    }

    /// A negative result waits for a better one.
    "brake-test-patient" |state, config, inputs| {
        let sbt = Status { finished: inputs.sbt.finished && inputs.sbt.result, ..inputs.sbt };
        brake_test::transition(state, config, &brake_test::Inputs { sbt, ..*inputs })
    }

    /// An acknowledgement lifts the restriction.
    "brake-test-acknowledged-is-free" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        if inputs.ack && !state.ack_held && state.phase == Phase::Failed {
            outputs.sls_threshold = i32::MAX;
            outputs.release_dir = true;
        }
        (after, outputs)
    }

    /// A brake that reads back is taken at once.
    "brake-test-hasty" |state, config, inputs| {
        let timer = if inputs.fdback_br_1 { Cycles::ZERO } else { state.timer };
        brake_test::transition(brake_test::State { timer, ..state }, config, inputs)
    }

    /// A brake is not read back.
    "brake-test-trusts-the-brake" |state, config, inputs| {
        let closed = state.phase == Phase::Close;
        let inputs = brake_test::Inputs { fdback_br_1: closed, fdback_br_2: closed, ..*inputs };
        brake_test::transition(state, config, &inputs)
    }

    /// Both brakes are closed for the test of one.
    "brake-test-closes-both" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        let both = outputs.open_br_1 && outputs.open_br_2;
        outputs.open_br_1 = both;
        outputs.open_br_2 = both;
        (after, outputs)
    }

    /// An axis that moves is no fault.
    "brake-test-moves" |state, config, inputs| {
        let inputs = brake_test::Inputs { safe_pos: state.start, ..*inputs };
        let (mut after, outputs) = brake_test::transition(state, config, &inputs);
        if state.phase == Phase::Passed || state.phase == Phase::Unproven {
            after.start = 0;
        }
        (after, outputs)
    }

    /// A lost selection is no fault.
    "brake-test-unselected" |state, config, inputs| {
        let sbt = Status { selected: inputs.sbt.selected || state.phase.tests(), ..inputs.sbt };
        brake_test::transition(state, config, &brake_test::Inputs { sbt, ..*inputs })
    }

    /// The drive may name any brake.
    "brake-test-any-brake" |state, config, inputs| {
        let sbt = Status { active_br: state.second, ..inputs.sbt };
        brake_test::transition(state, config, &brake_test::Inputs { sbt, ..*inputs })
    }

    /// A test goes on without a position.
    "brake-test-no-position" |state, config, inputs| {
        let pos_valid = inputs.pos_valid || state.phase.busy();
        brake_test::transition(state, config, &brake_test::Inputs { pos_valid, ..*inputs })
    }

    /// A held EXECUTE begins again and again.
    "brake-test-static-execute" |state, config, inputs| {
        let state = brake_test::State { execute_held: false, ..state };
        brake_test::transition(state, config, inputs)
    }

    /// A failed test is tried again without an acknowledgement.
    "brake-test-unacknowledged" |state, config, inputs| {
        let state = if state.phase == Phase::Failed && inputs.execute && !state.execute_held {
            brake_test::State { phase: Phase::Unproven, ..state }
        } else {
            state
        };
        brake_test::transition(state, config, inputs)
    }

    /// A passed test is asked for again at once.
    "brake-test-asks-on" |state, config, inputs| {
        let (mut after, mut outputs) = brake_test::transition(state, config, inputs);
        after.due |= state.due;
        outputs.test_req = after.due;
        (after, outputs)
    }

    /// A wrong parameter leaves the brakes to the drive.
    "brake-test-open-brakes" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        if config.parameter_bits() != 0 {
            outputs.open_br_1 = inputs.fdback_drive;
        }
        (after, outputs)
    }

    /// The drive has all the time to report its selection.
    "brake-test-waits-for-ever" |state, config, inputs| {
        let timer = if state.phase == Phase::Select { Cycles::new(3) } else { state.timer };
        brake_test::transition(brake_test::State { timer, ..state }, config, inputs)
    }

    /// The start command stays between two sequences.
    "brake-test-start-stays" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        outputs.stw.start = after.phase.tests();
        (after, outputs)
    }
}
