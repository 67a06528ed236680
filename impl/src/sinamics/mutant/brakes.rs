//! Wrong variants of what monitors braking, and of the brakes.

use crate::kernel::{Cycles, Speed};
use crate::sinamics::types::Stop;
use crate::sinamics::{brake_test, brake_test_request, sam, sbc, sbr};

variants! { sinamics::sam:
    /// The limit follows a rising speed too.
    "sam-limit-rises" |state, config, inputs| {
        let (mut after, outputs) = sam::transition(state, config, inputs);
        if state.on && after.on {
            after.limit = after.limit.max(Speed(state.limit.0.saturating_add(1)));
        }
        (after, outputs)
    }

    /// The tolerance of the first cycle is not raised.
    "sam-first-cycle-as-any" |state, config, inputs| {
        let (mut after, mut outputs) = sam::transition(state, config, inputs);
        if !state.on && after.on {
            after.limit = Speed(inputs.speed.0);
            outputs.limit = after.limit;
        }
        (after, outputs)
    }

    /// The limit itself is a violation.
    "sam-at-the-limit" |state, config, inputs| {
        let (after, mut outputs) = sam::transition(state, config, inputs);
        if state.on && after.on && inputs.speed == state.limit {
            outputs.violated = true;
            outputs.demand = Stop::A;
        }
        (after, outputs)
    }

    /// Below the shutdown speed the limit goes on falling.
    "sam-limit-falls-below" |state, config, inputs| {
        let (mut after, mut outputs) = sam::transition(state, config, inputs);
        if state.on && after.on && inputs.speed < config.threshold() {
            after.limit = after.limit.min(config.threshold());
            outputs.limit = after.limit;
        }
        (after, outputs)
    }

    /// A failed encoder stops nothing.
    "sam-blind" |state, config, inputs| {
        let (after, mut outputs) = sam::transition(state, config, inputs);
        if inputs.encoder_fault {
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }
}

variants! { sinamics::sbr:
    /// The ramp starts without its delay.
    "sbr-without-delay" |state, config, inputs| {
        let (mut after, outputs) = sbr::transition(state, config, inputs);
        if state.phase == sbr::Phase::Idle && after.phase == sbr::Phase::Delay {
            after.left = Cycles::new(1);
        }
        (after, outputs)
    }

    /// The rest of an increment is lost in each cycle.
    "sbr-loses-the-rest" |state, config, inputs| {
        let (mut after, outputs) = sbr::transition(state, config, inputs);
        after.rest = 0;
        (after, outputs)
    }

    /// The ramp follows the speed.
    "sbr-follows-the-speed" |state, config, inputs| {
        let (mut after, outputs) = sbr::transition(state, config, inputs);
        if state.phase == sbr::Phase::Ramp && after.phase == sbr::Phase::Ramp {
            after.ramp = after.ramp.min(inputs.speed);
        }
        (after, outputs)
    }

    /// The ramp itself is a violation.
    "sbr-at-the-ramp" |state, config, inputs| {
        let (after, mut outputs) = sbr::transition(state, config, inputs);
        outputs.violated |= outputs.monitored && inputs.speed == outputs.limit;
        (after, outputs)
    }

    /// The ramp stays at its last value above 0.
    "sbr-never-ends" |state, config, inputs| {
        let (mut after, outputs) = sbr::transition(state, config, inputs);
        if after.phase == sbr::Phase::Ramp && after.ramp == Speed(0) && state.phase == sbr::Phase::Ramp {
            after.ramp = state.ramp;
        }
        (after, outputs)
    }
}

variants! { sinamics::sbc:
    /// A fault of the other channel leaves the brake open.
    "sbc-alone" |state, config, inputs| {
        let inputs = sbc::Inputs { other_fault: false, ..*inputs };
        sbc::transition(state, config, &inputs)
    }

    /// One switch opens the brake.
    "sbc-one-switch" |state, config, inputs| {
        let (after, mut outputs) = sbc::transition(state, config, inputs);
        outputs.open = outputs.on;
        (after, outputs)
    }

    /// A defect is told in every cycle.
    "sbc-static-diagnosis" |state, config, inputs| {
        let (after, mut outputs) = sbc::transition(state, config, inputs);
        outputs.defect = config.enabled && inputs.feedback != outputs.on;
        (after, outputs)
    }
}

variants! { sinamics::brake_test:
    /// A sequence starts before the load is known.
    "brake-test-without-load" |state, config, inputs| {
        let inputs = brake_test::Inputs { load_known: true, ..*inputs };
        brake_test::transition(state, config, &inputs)
    }

    /// A held start starts.
    "brake-test-static-start" |state, config, inputs| {
        let start_held = state.start_held && state.phase != brake_test::Phase::Ready;
        let state = brake_test::State { start_held, ..state };
        brake_test::transition(state, config, inputs)
    }

    /// The choice changes on the way.
    "brake-test-changes-its-mind" |state, config, inputs| {
        let (mut after, outputs) = brake_test::transition(state, config, inputs);
        if outputs.torque {
            after.choice.negative = inputs.choice.negative;
        }
        (after, outputs)
    }

    /// The torque does not wait for an external brake.
    "brake-test-torque-on-open-brake" |state, config, inputs| {
        let external_closed = inputs.external_closed || state.phase == brake_test::Phase::Close;
        let inputs = brake_test::Inputs { external_closed, ..*inputs };
        brake_test::transition(state, config, &inputs)
    }

    /// A brake that slips at the end has held.
    "brake-test-forgives" |state, config, inputs| {
        let position = if state.phase == brake_test::Phase::RampDown { state.begin } else { inputs.position };
        let inputs = brake_test::Inputs { position, ..*inputs };
        brake_test::transition(state, config, &inputs)
    }

    /// STO does not end the torque.
    "brake-test-beside-sto" |state, config, inputs| {
        let inputs = brake_test::Inputs { stop: false, ..*inputs };
        brake_test::transition(state, config, &inputs)
    }

    /// Every complete sequence is successful.
    "brake-test-always-good" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        outputs.successful = outputs.complete;
        (after, outputs)
    }

    /// The normal end gives an alarm.
    "brake-test-alarm-at-the-end" |state, config, inputs| {
        let (after, mut outputs) = brake_test::transition(state, config, inputs);
        outputs.interrupted |= state.phase == brake_test::Phase::Result && !inputs.start;
        (after, outputs)
    }

    /// A late external brake is waited for.
    "brake-test-late-brake" |state, config, inputs| {
        let waits = matches!(state.phase, brake_test::Phase::Close | brake_test::Phase::Open);
        let left = if waits && state.left == Cycles::new(1) { Cycles::new(2) } else { state.left };
        brake_test::transition(brake_test::State { left, ..state }, config, inputs)
    }
}

variants! { sinamics::brake_test_request:
    /// The automatic test stop at POWER ON builds up torque.
    "brake-test-request-at-power-on" |state, config, inputs| {
        let automatic = brake_test_request::SbtAuto::Run;
        let config = brake_test_request::Config { automatic, ..*config };
        brake_test_request::transition(state, &config, inputs)
    }

    /// A brake test that has failed leaves out the test stop.
    "brake-test-request-gives-up" |state, config, inputs| {
        let (after, mut outputs) = brake_test_request::transition(state, config, inputs);
        outputs.test_stop &= !inputs.ended;
        (after, outputs)
    }

    /// Both begin together.
    "brake-test-request-both" |state, config, inputs| {
        let (after, mut outputs) = brake_test_request::transition(state, config, inputs);
        outputs.test_stop |= outputs.start;
        (after, outputs)
    }
}
