//! Wrong variants of the monitors of a position.

use crate::iec::increment::Phase;
use crate::iec::{cam, increment};
use crate::kernel::{Cycles, Distance, Position};

variants! { iec::cam:
    /// The hysteresis is on the wrong side of the ends: the shaft must be so far inside.
    "cam-hysteresis-inside" |state, config, inputs| {
        let hysteresis = i32::try_from(config.hysteresis.0).unwrap_or(i32::MAX);
        let lower = Position(config.lower.0.saturating_add(hysteresis));
        let upper = Position(config.upper.0.saturating_sub(hysteresis));
        cam::transition(state, &cam::Config { lower, upper, ..*config }, inputs)
    }

    /// The hysteresis also counts on the way in.
    "cam-hysteresis-always" |_, config, inputs| {
        let inputs = cam::Inputs { power_on: false, ..*inputs };
        cam::transition(cam::State { on: true }, config, &inputs)
    }

    /// There is no hysteresis.
    "cam-holds-nothing" |_, config, inputs| {
        cam::transition(cam::State::INITIAL, config, inputs)
    }

    /// The upper end is not of the cam.
    "cam-half-open" |state, config, inputs| {
        let upper = Position(config.upper.0.saturating_sub(1));
        cam::transition(state, &cam::Config { upper, ..*config }, inputs)
    }

    /// A position that is not valid leaves the output.
    "cam-frozen" |state, config, inputs| {
        if !inputs.valid && inputs.selected && !inputs.power_on {
            return (state, cam::Outputs { on: state.on });
        }
        cam::transition(state, config, inputs)
    }

    /// The output goes on without selection.
    "cam-without-selection" |state, config, inputs| {
        let inputs = cam::Inputs { selected: inputs.selected || state.on, ..*inputs };
        cam::transition(state, config, &inputs)
    }

    /// What was lost is found again within the hysteresis.
    "cam-remembers" |state, config, inputs| {
        let (mut after, outputs) = cam::transition(state, config, inputs);
        after.on |= state.on && !inputs.valid;
        (after, outputs)
    }

    /// The past survives the power.
    "cam-over-power-on" |state, config, inputs| {
        let inputs = cam::Inputs { power_on: false, ..*inputs };
        cam::transition(state, config, &inputs)
    }
}

variants! { iec::increment:
    /// A shaft may be one further away than the increment.
    "increment-one-further" |state, config, inputs| {
        let increment = Distance(config.increment.0.saturating_add(1));
        increment::transition(state, &increment::Config { increment, ..*config }, inputs)
    }

    /// At rest the shaft may move by a whole increment.
    "increment-rest-is-wide" |state, config, inputs| {
        let config = increment::Config { window: config.increment, ..*config };
        increment::transition(state, &config, inputs)
    }

    /// The end of the increment itself is too far.
    "increment-without-its-end" |state, config, inputs| {
        let increment = Distance(config.increment.0.saturating_sub(1));
        increment::transition(state, &increment::Config { increment, ..*config }, inputs)
    }

    /// Only motion in the positive direction is limited.
    "increment-one-direction" |state, config, inputs| {
        let position = inputs.position.max(state.from);
        let watched = state.phase == Phase::Moving && inputs.selected;
        let inputs = increment::Inputs { position: if watched { position } else { inputs.position }, ..*inputs };
        increment::transition(state, config, &inputs)
    }

    /// The rest follows the shaft, which creeps away.
    "increment-rest-creeps" |state, config, inputs| {
        let (mut after, outputs) = increment::transition(state, config, inputs);
        if after.phase == Phase::Rest {
            after.from = inputs.position;
        }
        (after, outputs)
    }

    /// The rest after an increment is where that began.
    "increment-rest-at-the-start" |state, config, inputs| {
        let (mut after, outputs) = increment::transition(state, config, inputs);
        if state.phase == Phase::Moving && after.phase == Phase::Rest && !inputs.power_on {
            after.from = state.from;
        }
        (after, outputs)
    }

    /// A start held permits one increment after the other.
    "increment-static-start" |state, config, inputs| {
        let state = increment::State { start_held: false, ..state };
        increment::transition(state, config, inputs)
    }

    /// A start that is 1 when the power returns permits an increment.
    "increment-start-at-power-on" |state, config, inputs| {
        let (mut after, mut outputs) = increment::transition(state, config, inputs);
        if inputs.power_on && inputs.start && after.phase == Phase::Rest {
            after.phase = Phase::Moving;
            after.left = Cycles::new(1);
            outputs.permitted = true;
        }
        (after, outputs)
    }

    /// A start during an increment begins it anew.
    "increment-restarts" |state, config, inputs| {
        let again = inputs.start && !state.start_held && state.phase == Phase::Moving && !inputs.power_on;
        let (after, outputs) = increment::transition(state, config, inputs);
        if again && !outputs.stop && inputs.selected {
            let rest = increment::State { phase: Phase::Rest, from: inputs.position, left: Cycles::ZERO, ..state };
            return increment::transition(rest, config, inputs);
        }
        (after, outputs)
    }

    /// The increment lasts a cycle longer.
    "increment-late" |state, config, inputs| {
        let time = Cycles::new(config.time.count().saturating_add(1));
        increment::transition(state, &increment::Config { time, ..*config }, inputs)
    }

    /// A start with the acknowledgement permits an increment.
    "increment-start-with-the-acknowledgement" |state, config, inputs| {
        let (after, outputs) = increment::transition(state, config, inputs);
        if state.demand && !outputs.stop && !inputs.power_on {
            let acknowledged = increment::State { demand: false, ..state };
            return increment::transition(acknowledged, config, inputs);
        }
        (after, outputs)
    }

    /// A start held over the acknowledgement is one after it.
    "increment-start-over-the-acknowledgement" |state, config, inputs| {
        let (mut after, outputs) = increment::transition(state, config, inputs);
        after.start_held &= !outputs.stop;
        (after, outputs)
    }

    /// A start under a demand permits an increment.
    "increment-start-under-a-demand" |state, config, inputs| {
        let (after, mut outputs) = increment::transition(state, config, inputs);
        outputs.permitted |= outputs.stop && inputs.start && !state.start_held;
        (after, outputs)
    }

    /// A violation does not end the increment.
    "increment-goes-on" |state, config, inputs| {
        let (after, mut outputs) = increment::transition(state, config, inputs);
        outputs.permitted |= state.phase == Phase::Moving && inputs.selected && inputs.valid && outputs.stop;
        (after, outputs)
    }

    /// A position that is not valid is the last one.
    "increment-skips-invalid" |state, config, inputs| {
        let skipped = increment::Inputs { valid: true, position: state.from, ..*inputs };
        increment::transition(state, config, if inputs.valid { inputs } else { &skipped })
    }

    /// A level of the acknowledgement acknowledges.
    "increment-static-ack" |state, config, inputs| {
        let state = increment::State { ack_held: false, ..state };
        increment::transition(state, config, inputs)
    }

    /// Deselection takes the demand back.
    "increment-demand-lost" |state, config, inputs| {
        let state = increment::State { demand: state.demand && inputs.selected, ..state };
        increment::transition(state, config, inputs)
    }

    /// Deselection leaves an increment that runs.
    "increment-without-selection" |state, config, inputs| {
        let inputs = increment::Inputs { selected: inputs.selected || state.phase == Phase::Moving, ..*inputs };
        increment::transition(state, config, &inputs)
    }
}
