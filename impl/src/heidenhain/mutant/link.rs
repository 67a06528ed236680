//! Wrong variants of the telegrams between controller computers.

use crate::heidenhain::cc_link;
use crate::heidenhain::types::Stop;

variants! {
    cc_link_one_too_many: cc_link |state, config, inputs| {
        let (mut after, mut outputs) = cc_link::transition(state, config, inputs);
        if !state.lost && !inputs.sound && state.faulty == config.tolerated() {
            after.lost = false;
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }

    cc_link_trusts_the_last: cc_link |state, config, inputs| {
        let (after, mut outputs) = cc_link::transition(state, config, inputs);
        if !inputs.sound {
            outputs.drive.moving = after.last.moving;
        }
        (after, outputs)
    }
}
