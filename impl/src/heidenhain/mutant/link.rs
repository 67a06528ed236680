//! Wrong variants of the telegrams between controller computers.

use crate::heidenhain::cc_link;
use crate::heidenhain::types::Stop;

variants! { heidenhain::cc_link:
    /// One faulty telegram more than allowed is tolerated.
    "cc-link-one-too-many" |state, config, inputs| {
        let (mut after, mut outputs) = cc_link::transition(state, config, inputs);
        if !state.lost && !inputs.sound && state.faulty == config.tolerated() {
            after.lost = false;
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }

    /// While telegrams are faulty the drive is taken to be as it was.
    "cc-link-trusts-the-last" |state, config, inputs| {
        let (after, mut outputs) = cc_link::transition(state, config, inputs);
        if !inputs.sound {
            outputs.drive.moving = after.last.moving;
        }
        (after, outputs)
    }
}
