//! Wrong variants of the parts of the self-test.

use crate::heidenhain::{cut_out, holding_brake};

variants! { heidenhain::cut_out:
    /// While the CC alone has no torque nobody watches.
    "cut-out-unwatched" |state, config, inputs| {
        let (after, mut outputs) = cut_out::transition(state, config, inputs);
        outputs.watch_mc = false;
        (after, outputs)
    }

    /// A power module that stays ready passes.
    "cut-out-passes-ready" |state, config, inputs| {
        let mut inputs = *inputs;
        if state.step == cut_out::Phase::McOff {
            inputs.ready = false;
        }
        cut_out::transition(state, config, &inputs)
    }

    /// An axis that moves does not break the brake test off.
    "cut-out-moves-on" |state, config, inputs| {
        let moved = inputs.moved && state.step == cut_out::Phase::Idle;
        cut_out::transition(state, config, &cut_out::Inputs { moved, ..*inputs })
    }
}

variants! { heidenhain::holding_brake:
    /// A path too long passes when the current has risen.
    "holding-brake-slips" |state, config, inputs| {
        let too_far = inputs.too_far && !inputs.current;
        holding_brake::transition(state, config, &holding_brake::Inputs { too_far, ..*inputs })
    }

    /// The drive lets go while the brake closes.
    "holding-brake-lets-go" |state, config, inputs| {
        let (after, mut outputs) = holding_brake::transition(state, config, inputs);
        outputs.controlled &= outputs.step != holding_brake::Phase::Closes;
        (after, outputs)
    }
}
