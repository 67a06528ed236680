//! Wrong variants of the monitors of a value, and of what makes an acceleration.

use crate::iec::common::Value;
use crate::iec::{acceleration, window};
use crate::kernel::Cycles;

variants! { iec::window:
    /// The limits themselves are outside.
    "window-without-limits" |state, config, inputs| {
        let beside = |limit: Value, by| Value::new(limit.get() + by).unwrap_or(limit);
        let config = window::Config { lower: beside(config.lower, 1), upper: beside(config.upper, -1), ..*config };
        window::transition(state, &config, inputs)
    }

    /// Only the magnitude is looked at.
    "window-by-magnitude" |state, config, inputs| {
        let value = Value::new(inputs.value.get().abs()).unwrap_or(inputs.value);
        let inputs = window::Inputs { value, ..*inputs };
        window::transition(state, config, &inputs)
    }

    /// One cycle too many is tolerated.
    "window-tolerates-one-more" |state, config, inputs| {
        let tolerance = Cycles::new(config.tolerance.count().saturating_add(1));
        window::transition(state, &window::Config { tolerance, ..*config }, inputs)
    }

    /// One cycle too few is tolerated.
    "window-tolerates-one-less" |state, config, inputs| {
        let tolerance = config.tolerance.tick();
        window::transition(state, &window::Config { tolerance, ..*config }, inputs)
    }

    /// A cycle inside does not begin the count anew.
    "window-counts-on" |state, config, inputs| {
        let (mut after, outputs) = window::transition(state, config, inputs);
        if outputs.in_force && !outputs.stop && after.outside.is_zero() {
            after.outside = state.outside;
        }
        (after, outputs)
    }

    /// A value that is not valid is tolerated like one outside.
    "window-tolerates-invalid" |state, config, inputs| {
        let outside = if inputs.valid { inputs.value } else { Value::positive(u32::MAX) };
        let inputs = window::Inputs { valid: true, value: outside, ..*inputs };
        window::transition(state, config, &inputs)
    }

    /// A value that is not valid keeps the last judgement: none.
    "window-skips-invalid" |state, config, inputs| {
        if !inputs.valid && !inputs.power_on && inputs.selected && state.left.is_zero() && state.selected {
            let outputs = window::Outputs { in_force: true, stop: state.demand, kept: false };
            return (window::State { ack_held: inputs.ack, ..state }, outputs);
        }
        window::transition(state, config, inputs)
    }

    /// A level of the acknowledgement acknowledges.
    "window-static-ack" |state, config, inputs| {
        let state = window::State { ack_held: false, ..state };
        window::transition(state, config, inputs)
    }

    /// An acknowledgement that is 1 when the power returns is remembered as 0.
    "window-edge-at-power-on" |state, config, inputs| {
        let (mut after, outputs) = window::transition(state, config, inputs);
        after.ack_held &= !inputs.power_on;
        (after, outputs)
    }

    /// Deselection takes the demand back.
    "window-demand-lost" |state, config, inputs| {
        let state = window::State { demand: state.demand && inputs.selected, ..state };
        window::transition(state, config, inputs)
    }

    /// The value comes back inside and the demand ends by itself.
    "window-forgives" |state, config, inputs| {
        let back = inputs.selected && state.selected && state.left.is_zero() && inputs.valid && config.within(inputs.value);
        let state = window::State { demand: state.demand && !back, ..state };
        window::transition(state, config, inputs)
    }

    /// It is acknowledged while the value is outside.
    "window-acknowledged-outside" |state, config, inputs| {
        let acknowledged = state.demand && inputs.ack && !state.ack_held;
        let (mut after, mut outputs) = window::transition(state, config, inputs);
        if acknowledged && inputs.valid && !inputs.power_on {
            after.demand = false;
            outputs.stop = false;
        }
        (after, outputs)
    }

    /// The delay lasts a cycle longer.
    "window-delay-late" |state, config, inputs| {
        let delay = Cycles::new(config.delay.count().saturating_add(1));
        window::transition(state, &window::Config { delay, ..*config }, inputs)
    }

    /// A new selection goes on with the delay of the one before.
    "window-delay-once" |state, config, inputs| {
        let (mut after, outputs) = window::transition(state, config, inputs);
        if !inputs.selected {
            after.selected = state.selected;
        }
        (after, outputs)
    }

    /// The range is told to be kept while a cycle outside is tolerated.
    "window-kept-while-tolerating" |state, config, inputs| {
        let (after, mut outputs) = window::transition(state, config, inputs);
        outputs.kept = outputs.in_force && !outputs.stop;
        (after, outputs)
    }

    /// A demand survives the power.
    "window-keeps-its-demand" |state, config, inputs| {
        let (mut after, mut outputs) = window::transition(state, config, inputs);
        if inputs.power_on && state.demand {
            after = window::State { demand: true, outside: Cycles::ZERO, ..after };
            outputs.stop = true;
            outputs.kept = false;
        }
        (after, outputs)
    }
}

variants! { iec::acceleration:
    /// A difference of more than 32 bits wraps.
    "acceleration-wraps" |state, config, inputs| {
        let (after, mut outputs) = acceleration::transition(state, config, inputs);
        if let (Some(last), true) = (state.last, outputs.valid) {
            outputs.acceleration = Value::measured(inputs.speed.wrapping_sub(last));
        }
        (after, outputs)
    }

    /// A difference of more than 32 bits is cut.
    "acceleration-saturates" |state, config, inputs| {
        let (after, mut outputs) = acceleration::transition(state, config, inputs);
        if let (Some(last), true) = (state.last, outputs.valid) {
            outputs.acceleration = Value::measured(inputs.speed.saturating_sub(last));
        }
        (after, outputs)
    }

    /// Before the first speed the shaft is taken to stand.
    "acceleration-from-nothing" |state, config, inputs| {
        let last = if inputs.power_on { None } else { state.last };
        let state = acceleration::State { last: last.or(Some(0)) };
        let inputs = acceleration::Inputs { power_on: false, ..*inputs };
        acceleration::transition(state, config, &inputs)
    }

    /// The speed from before a gap is kept.
    "acceleration-over-a-gap" |state, config, inputs| {
        let (mut after, outputs) = acceleration::transition(state, config, inputs);
        after.last = after.last.or(state.last);
        (after, outputs)
    }

    /// The speeds are exchanged.
    "acceleration-exchanged" |state, config, inputs| {
        let (after, mut outputs) = acceleration::transition(state, config, inputs);
        if let (Some(last), true) = (state.last, outputs.valid) {
            outputs.acceleration = Value::difference(last, inputs.speed);
        }
        (after, outputs)
    }

    /// The difference of the magnitudes is taken.
    "acceleration-of-magnitudes" |state, config, inputs| {
        let (after, mut outputs) = acceleration::transition(state, config, inputs);
        if let (Some(last), true) = (state.last, outputs.valid) {
            let difference = i64::from(inputs.speed).abs() - i64::from(last).abs();
            outputs.acceleration = Value::new(difference).unwrap_or(Value::ZERO);
        }
        (after, outputs)
    }

    /// A speed that is not valid counts.
    "acceleration-of-anything" |state, config, inputs| {
        let inputs = acceleration::Inputs { valid: true, ..*inputs };
        acceleration::transition(state, config, &inputs)
    }

    /// The speed from before the power returned counts.
    "acceleration-over-power-on" |state, config, inputs| {
        let inputs = acceleration::Inputs { power_on: false, ..*inputs };
        acceleration::transition(state, config, &inputs)
    }
}
