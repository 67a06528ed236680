//! Wrong wirings of the channel.

use crate::heidenhain::channel;
use crate::heidenhain::types::Stop;

variants! { heidenhain::channel:
    /// A permission that is merely on restarts.
    "channel-permits-by-level" |state, config, inputs| {
        let mut state = state;
        state.permitted = false;
        channel::transition(state, config, inputs)
    }

    /// A stop that the other channel tells is not taken over.
    "channel-misses-told" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.told = Stop::None;
        channel::transition(state, config, &inputs)
    }

    /// A cause that the other channel has told is told back to it.
    "channel-tells-back" |state, config, inputs| {
        let (after, mut outputs) = channel::transition(state, config, inputs);
        outputs.tells = outputs.tells.max(inputs.told);
        (after, outputs)
    }

    /// The requests of the other channel are taken to be the own ones.
    "channel-alone" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.peer = channel::transition(state, config, &inputs).1.taken;
        channel::transition(state, config, &inputs)
    }
}
