//! Wrong variants of what is taken over from the safe PLC.

use crate::heidenhain::types::{GroupState, Kind, Stop};
use crate::heidenhain::{both_channels, both_fields, both_status, gate};

variants! { heidenhain::gate:
    /// A request with an illegal field still activates.
    "gate-activates-illegal" |state, config, inputs| {
        let (after, mut outputs) = gate::transition(state, config, inputs);
        outputs.starts = inputs.activate;
        (after, outputs)
    }

    /// A code that does not exist raises no stop.
    "gate-trusts-codes" |state, config, inputs| {
        let (after, mut outputs) = gate::transition(state, config, inputs);
        outputs.stop = Stop::from_code(inputs.stop_code).unwrap_or(outputs.stop);
        (after, outputs)
    }

    /// Restricted spindle operation is granted to a group without spindle.
    "gate-grants-spindle-mode" |state, config, inputs| {
        let (after, mut outputs) = gate::transition(state, config, inputs);
        if inputs.state_code == GroupState::SlsS.code() && config.kind() != Kind::Spindle {
            outputs.stop = Stop::from_code(inputs.stop_code).unwrap_or(Stop::Ss1F);
        }
        (after, outputs)
    }
}

variants! { heidenhain::both_channels:
    /// The request of channel A counts alone.
    "both-channels-trusts-a" |state, config, inputs| {
        let (after, mut outputs) = both_channels::transition(state, config, inputs);
        outputs.request = inputs.request_mc;
        (after, outputs)
    }

    /// A permissive of one channel is enough.
    "both-channels-one-permissive" |state, config, inputs| {
        let (after, mut outputs) = both_channels::transition(state, config, inputs);
        outputs.held = inputs.held_mc || inputs.held_cc;
        (after, outputs)
    }
}

variants! { heidenhain::both_fields:
    /// The mode is not compared.
    "both-fields-forgets-mode" |state, config, inputs| {
        let (after, mut outputs) = both_fields::transition(state, config, inputs);
        let mut inputs = *inputs;
        inputs.cc.som = inputs.mc.som;
        outputs.differ = inputs.mc != inputs.cc;
        (after, outputs)
    }

    /// The drives may be switched on by one channel.
    "both-fields-one-drives" |state, config, inputs| {
        let (after, mut outputs) = both_fields::transition(state, config, inputs);
        outputs.drives = inputs.mc.drives || inputs.cc.drives;
        (after, outputs)
    }
}

variants! { heidenhain::both_status:
    /// A program that is not executed in one channel is overlooked.
    "both-status-forgets-program" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.cc.executed = inputs.mc.executed;
        both_status::transition(state, config, &inputs)
    }

    /// The outputs are not compared.
    "both-status-forgets-outputs" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.cc.outputs = inputs.mc.outputs;
        both_status::transition(state, config, &inputs)
    }

    /// Both run-time systems must ask for SS1F.
    "both-status-needs-both" |state, config, inputs| {
        let (after, mut outputs) = both_status::transition(state, config, inputs);
        if !(inputs.mc.runtime && inputs.cc.runtime) {
            outputs.stop = Stop::None;
        }
        (after, outputs)
    }
}
