//! Wrong variants of the temperature of the motor.

use crate::iec::temperature;

variants! { iec::temperature:
    /// The limit itself is a violation.
    "temperature-at-the-limit" |state, config, inputs| {
        let limit = config.limit.saturating_sub(1);
        temperature::transition(state, &temperature::Config { limit, ..*config }, inputs)
    }

    /// A short circuit is taken for a cold motor.
    "temperature-short-circuit-is-cold" |state, config, inputs| {
        let temperature = if inputs.short_circuit { i32::MIN } else { inputs.temperature };
        let inputs = temperature::Inputs { temperature, short_circuit: false, ..*inputs };
        temperature::transition(state, config, &inputs)
    }

    /// A broken wire only warns.
    "temperature-broken-wire-warns" |state, config, inputs| {
        let whole = temperature::Inputs { wire_broken: false, ..*inputs };
        let (after, mut outputs) = temperature::transition(state, config, &whole);
        outputs.warning |= inputs.wire_broken;
        (after, outputs)
    }

    /// The warning begins above the threshold.
    "temperature-warns-late" |state, config, inputs| {
        let warning = config.warning.saturating_add(1);
        temperature::transition(state, &temperature::Config { warning, ..*config }, inputs)
    }

    /// The warning stays with the demand.
    "temperature-warning-latched" |state, config, inputs| {
        let (after, mut outputs) = temperature::transition(state, config, inputs);
        outputs.warning |= outputs.stop;
        (after, outputs)
    }

    /// Any temperature up to the limit is cool enough: the hysteresis is not waited for.
    "temperature-without-hysteresis" |state, config, inputs| {
        temperature::transition(state, &temperature::Config { hysteresis: 0, ..*config }, inputs)
    }

    /// It is acknowledged while the motor is hot, and demanded again in the next cycle.
    "temperature-acknowledged-hot" |state, config, inputs| {
        let (mut after, mut outputs) = temperature::transition(state, config, inputs);
        if state.demand && inputs.ack && !state.ack_held && !inputs.power_on && inputs.valid() {
            after.demand = false;
            outputs.stop = false;
        }
        (after, outputs)
    }

    /// It is acknowledged without a valid temperature.
    "temperature-acknowledged-blind" |state, config, inputs| {
        let (mut after, mut outputs) = temperature::transition(state, config, inputs);
        if state.demand && inputs.ack && !state.ack_held && !inputs.valid() {
            after.demand = false;
            outputs.stop = false;
        }
        (after, outputs)
    }

    /// A level of the acknowledgement acknowledges.
    "temperature-static-ack" |state, config, inputs| {
        let state = temperature::State { ack_held: false, ..state };
        temperature::transition(state, config, inputs)
    }

    /// Deselection takes the demand back.
    "temperature-demand-lost" |state, config, inputs| {
        let state = temperature::State { demand: state.demand && inputs.selected, ..state };
        temperature::transition(state, config, inputs)
    }

    /// The temperature is watched also without selection.
    "temperature-always" |state, config, inputs| {
        let inputs = temperature::Inputs { selected: true, ..*inputs };
        temperature::transition(state, config, &inputs)
    }

    /// A demand survives the power.
    "temperature-keeps-its-demand" |state, config, inputs| {
        let (mut after, mut outputs) = temperature::transition(state, config, inputs);
        after.demand |= state.demand && inputs.power_on;
        outputs.stop |= after.demand;
        (after, outputs)
    }
}
