//! Wrong variants of what is asked of an axis group and of its monitoring state.

use crate::heidenhain::types::{GroupState, Kind, Left, Phase, Stop, Unit};
use crate::heidenhain::{axis_release, group, judge, startup};

variants! { heidenhain::judge:
    /// SOM_4 may follow SOM_2 directly.
    "judge-trusts-mode-changes" |state, config, inputs| {
        let mut state = state;
        state.modes = judge::Modes::None;
        judge::transition(state, config, inputs)
    }

    /// A turning spindle goes on without permissive as its door is opened.
    "judge-misses-the-open-door" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.state == GroupState::Auto && !inputs.idle {
            inputs.permissive = true;
        }
        judge::transition(state, config, &inputs)
    }

    /// Restricted operation asked for as the door opens hides that nobody holds the permissive.
    "judge-restricted-needs-no-permissive" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.permissive |= inputs.state == GroupState::Auto && inputs.request == GroupState::SlsS;
        judge::transition(state, config, &inputs)
    }

    /// Auxiliary axes need their permissive at the handwheel only.
    "judge-magazine-unheld" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.permissive |= config.kind() == Kind::Auxiliary && inputs.unit != Unit::Handwheel;
        judge::transition(state, config, &inputs)
    }

    /// Standstill asked for in motion is no stop.
    "judge-moving-standstill" |state, config, inputs| {
        let (after, mut outputs) = judge::transition(state, config, inputs);
        if inputs.request == GroupState::Sos && outputs.demand == Stop::Ss1 {
            outputs.asks_ss1 = false;
            outputs.demand = inputs.stop_request;
        }
        (after, outputs)
    }
}

variants! { heidenhain::group:
    /// Closing the door activates.
    "group-door-starts" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.activate |= inputs.request == GroupState::Auto;
        group::transition(state, config, &inputs)
    }

    /// A change of the mode in motion drops the old limit.
    "group-loosens" |state, config, inputs| {
        let (mut after, mut outputs) = group::transition(state, config, inputs);
        after.left = Left::NONE;
        outputs.left = Left::NONE;
        (after, outputs)
    }

    /// An SS1D makes STO of STO_O.
    "group-soft-lifts-sto" |state, config, inputs| {
        let (mut after, mut outputs) = group::transition(state, config, inputs);
        if inputs.soft && after.state == GroupState::Sto && inputs.phase == Phase::TorqueOff {
            after.state = GroupState::StoO;
            outputs.state = after.state;
        }
        (after, outputs)
    }
}

variants! { heidenhain::startup:
    /// A permissive begins the count anew.
    "startup-forgets-by-permissive" |state, config, inputs| {
        let mut state = state;
        if inputs.permissive {
            state = startup::State::INITIAL;
        }
        startup::transition(state, config, inputs)
    }

    /// It responds only in the cycle in which the count ends.
    "startup-late" |state, config, inputs| {
        let (after, mut outputs) = startup::transition(state, config, inputs);
        outputs.idle = outputs.idle && inputs.limited && state.timer != after.timer;
        (after, outputs)
    }
}

variants! { heidenhain::axis_release:
    /// The enable that comes back breaks the braking off.
    "axis-release-breaks-off" |state, config, inputs| {
        let mut state = state;
        if inputs.feed {
            state = axis_release::State::INITIAL;
        }
        axis_release::transition(state, config, inputs)
    }

    /// Braking may last for ever.
    "axis-release-without-end" |state, config, inputs| {
        let (after, mut outputs) = axis_release::transition(state, config, inputs);
        outputs.asks_ss1 &= after.mode != axis_release::Mode::Ss2;
        (after, outputs)
    }
}
