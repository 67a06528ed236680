//! Wrong variants of the monitors of actual values and of drives without encoder.

use crate::kernel::Cycles;
use crate::sinamics::{
    actual_value, data_set, encoderless, gear, reference, safe_position, start_phase,
};

variants! { sinamics::reference:
    /// The agreement of one channel is enough.
    "reference-of-one-channel" |state, config, inputs| {
        let one = inputs.agrees || inputs.other_agrees;
        let inputs = reference::Inputs { agrees: one, other_agrees: one, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// POWER ON deletes the agreement.
    "reference-forgets-at-power-on" |state, config, inputs| {
        let gear_change = inputs.gear_change || inputs.power_on;
        let inputs = reference::Inputs { gear_change, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// A change of the gear stage keeps it.
    "reference-survives-the-gear" |state, config, inputs| {
        let parking = inputs.parking || inputs.gear_change;
        let inputs = reference::Inputs { parking, gear_change: false, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// A declaration in motion counts.
    "reference-in-motion" |state, config, inputs| {
        let inputs = reference::Inputs { standstill: true, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// The place is not compared.
    "reference-any-place" |state, config, inputs| {
        let position = if state.agreed { state.stored } else { inputs.position };
        let inputs = reference::Inputs { position, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// A missed agreement is made good later.
    "reference-makes-good" |state, config, inputs| {
        let missed = state.missed && !(inputs.agrees && inputs.other_agrees);
        let state = reference::State { missed, ..state };
        reference::transition(state, config, inputs)
    }
}

variants! { sinamics::safe_position:
    /// The mean is rounded down.
    "safe-position-rounds-down" |state, config, inputs| {
        let (after, mut outputs) = safe_position::transition(state, config, inputs);
        if inputs.first.0 < 0 && inputs.second.0 < 0 && outputs.short > i16::MIN && !outputs.too_wide {
            outputs.short -= 1;
        }
        (after, outputs)
    }

    /// The position of one channel is transferred.
    "safe-position-of-one-channel" |state, config, inputs| {
        let inputs = safe_position::Inputs { second: inputs.first, ..*inputs };
        safe_position::transition(state, config, &inputs)
    }

    /// An absolute position needs no reference.
    "safe-position-unreferenced" |state, config, inputs| {
        let inputs = safe_position::Inputs { referenced: true, ..*inputs };
        safe_position::transition(state, config, &inputs)
    }

    /// A position that is sent in 32 bits is too wide, too.
    "safe-position-too-wide-for-32-bits" |state, config, inputs| {
        let short = safe_position::Config { short: true, ..*config };
        let (after, mut outputs) = safe_position::transition(state, config, inputs);
        outputs.too_wide = safe_position::transition(state, &short, inputs).1.too_wide;
        (after, outputs)
    }

    /// A wide position wraps.
    "safe-position-wraps" |state, config, inputs| {
        let (after, mut outputs) = safe_position::transition(state, config, inputs);
        outputs.too_wide = false;
        (after, outputs)
    }
}

variants! { sinamics::actual_value:
    /// A difference to one side is not seen.
    "actual-value-one-side" |state, config, inputs| {
        let (after, mut outputs) = actual_value::transition(state, config, inputs);
        outputs.exceeded &= outputs.apart > 0;
        (after, outputs)
    }

    /// Positions are aligned in each cycle.
    "actual-value-always-aligned" |state, config, inputs| {
        let (mut after, outputs) = actual_value::transition(state, config, inputs);
        after.aligned = i64::from(inputs.own.0) - i64::from(inputs.other.0);
        (after, outputs)
    }

    /// The tolerance is always increased.
    "actual-value-always-raised" |state, config, inputs| {
        let (after, mut outputs) = actual_value::transition(state, config, inputs);
        let raised = actual_value::Inputs { raised: true, ..*inputs };
        outputs.exceeded = actual_value::transition(state, config, &raised).1.exceeded;
        (after, outputs)
    }

    /// A change of the gear stage is not aligned.
    "actual-value-remembers-the-gear" |state, config, inputs| {
        let inputs = actual_value::Inputs { synchronise: false, ..*inputs };
        actual_value::transition(state, config, &inputs)
    }
}

variants! { sinamics::gear:
    /// The stage is synchronised while the tolerance is increased.
    "gear-synchronises-early" |state, config, inputs| {
        let (after, mut outputs) = gear::transition(state, config, inputs);
        outputs.synchronise |= outputs.changed;
        (after, outputs)
    }

    /// The increased tolerance may last for ever.
    "gear-for-ever" |state, config, inputs| {
        let (after, mut outputs) = gear::transition(state, config, inputs);
        outputs.too_long = false;
        (after, outputs)
    }

    /// A change with increased tolerance keeps the reference.
    "gear-keeps-the-reference" |state, config, inputs| {
        let (after, mut outputs) = gear::transition(state, config, inputs);
        outputs.changed &= !inputs.raise;
        (after, outputs)
    }
}

variants! { sinamics::encoderless:
    /// ON alone opens the window.
    "encoderless-on-starts" |state, config, inputs| {
        let on = state.phase == encoderless::Phase::Off && inputs.on && !state.on_held;
        let phase = if on { encoderless::Phase::Selected } else { state.phase };
        encoderless::transition(encoderless::State { phase, ..state }, config, inputs)
    }

    /// The window never ends.
    "encoderless-open-window" |state, config, inputs| {
        let left = if state.left == Cycles::new(1) { Cycles::new(2) } else { state.left };
        encoderless::transition(encoderless::State { left, ..state }, config, inputs)
    }

    /// SLS follows p9509 too: with SDI free it keeps nothing off.
    "encoderless-sls-by-p9509" |state, config, inputs| {
        let sls = inputs.sls && config.sdi_keeps();
        let inputs = encoderless::Inputs { sls, ..*inputs };
        encoderless::transition(state, config, &inputs)
    }

    /// What waits for standstill does not wait.
    "encoderless-no-coasting" |state, config, inputs| {
        let inputs = encoderless::Inputs { still: true, ..*inputs };
        encoderless::transition(state, config, &inputs)
    }

    /// Pulses that have not come yet after ON are taken as suppressed.
    "encoderless-impatient" |state, config, inputs| {
        let came = state.came || state.phase == encoderless::Phase::Run;
        encoderless::transition(encoderless::State { came, ..state }, config, inputs)
    }

    /// A missing current is not told.
    "encoderless-quiet" |state, config, inputs| {
        let (after, mut outputs) = encoderless::transition(state, config, inputs);
        outputs.no_current = false;
        (after, outputs)
    }
}

variants! { sinamics::start_phase:
    /// Only the first start has a start phase.
    "start-phase-once" |state, config, inputs| {
        let (after, outputs) = start_phase::transition(state, config, inputs);
        let enabled = state.enabled || inputs.pulses;
        (start_phase::State { enabled, ..after }, outputs)
    }

    /// It ends a cycle early.
    "start-phase-short" |state, config, inputs| {
        let left = if state.left == Cycles::new(2) { Cycles::new(1) } else { state.left };
        start_phase::transition(start_phase::State { left, ..state }, config, inputs)
    }

    /// What is wrong meanwhile is told.
    "start-phase-hasty" |state, config, inputs| {
        let (after, mut outputs) = start_phase::transition(state, config, inputs);
        outputs.stop_f = inputs.pulses && !inputs.plausible;
        (after, outputs)
    }

    /// A wrong value is hidden for good.
    "start-phase-quiet" |state, config, inputs| {
        let (after, mut outputs) = start_phase::transition(state, config, inputs);
        outputs.stop_f = false;
        (after, outputs)
    }

    /// What is wrong takes the actual value from SLS and SDI.
    "start-phase-blind" |state, config, inputs| {
        let (after, mut outputs) = start_phase::transition(state, config, inputs);
        outputs.known &= inputs.plausible;
        (after, outputs)
    }
}

variants! { sinamics::data_set:
    /// An acknowledged change ends the stop.
    "data-set-forgives" |state, config, inputs| {
        let power_on = inputs.power_on || inputs.changes && inputs.same;
        let inputs = data_set::Inputs { power_on, ..*inputs };
        data_set::transition(state, config, &inputs)
    }

    /// Other data are only told.
    "data-set-only-tells" |state, config, inputs| {
        let (_, outputs) = data_set::transition(state, config, inputs);
        (state, data_set::Outputs { stop_a: state.locked, ..outputs })
    }
}
