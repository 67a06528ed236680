//! Wrong variants of the parts of the self-test.

use crate::heidenhain::{cut_out, holding_brake};

variants! {
    cut_out_unwatched: cut_out |state, config, inputs| {
        let (after, mut outputs) = cut_out::transition(state, config, inputs);
        outputs.watch_mc = false;
        (after, outputs)
    }

    cut_out_passes_ready: cut_out |state, config, inputs| {
        let mut inputs = *inputs;
        if state.step == cut_out::Phase::McOff {
            inputs.ready = false;
        }
        cut_out::transition(state, config, &inputs)
    }

    cut_out_moves_on: cut_out |state, config, inputs| {
        let moved = inputs.moved && state.step == cut_out::Phase::Idle;
        cut_out::transition(state, config, &cut_out::Inputs { moved, ..*inputs })
    }

    holding_brake_slips: holding_brake |state, config, inputs| {
        let too_far = inputs.too_far && !inputs.current;
        holding_brake::transition(state, config, &holding_brake::Inputs { too_far, ..*inputs })
    }

    holding_brake_lets_go: holding_brake |state, config, inputs| {
        let (after, mut outputs) = holding_brake::transition(state, config, inputs);
        outputs.controlled &= outputs.step != holding_brake::Phase::Closes;
        (after, outputs)
    }
}
