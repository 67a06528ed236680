//! Wrong variants of the monitors of position and speed.

use crate::heidenhain::types::{GroupState, Left, Stop, Unit};
use crate::heidenhain::{
    axis_count, comparison, deceleration, operating_stop, position_limit, revolutions, speed,
    stop_path,
};
use crate::kernel::{Cycles, Speed};

variants! { heidenhain::speed:
    /// One increment more than the limit plus 5 % is permitted.
    "speed-margin-too-wide" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        speed::transition(state, config, &speed::Inputs { speed, ..*inputs })
    }

    /// After a change of the mode in motion the new limit counts at once, also a higher one.
    "speed-higher-of-two" |state, config, inputs| {
        let left = Left::NONE;
        speed::transition(state, config, &speed::Inputs { left, ..*inputs })
    }

    /// A limit that is not set is not shown.
    "speed-zero-is-no-fault" |state, config, inputs| {
        let (after, mut outputs) = speed::transition(state, config, inputs);
        outputs.not_set = false;
        (after, outputs)
    }
}

variants! { heidenhain::operating_stop:
    /// The reference follows the axis.
    "operating-stop-follows" |state, config, inputs| {
        let (mut after, outputs) = operating_stop::transition(state, config, inputs);
        if inputs.watched {
            after.begin = inputs.position;
        }
        (after, outputs)
    }

    /// A creeping axis is braked instead of losing its torque.
    "operating-stop-brakes-creeping" |state, config, inputs| {
        let (after, mut outputs) = operating_stop::transition(state, config, inputs);
        if outputs.demand == Stop::Ss0 {
            outputs.demand = Stop::Ss1;
        }
        (after, outputs)
    }

    /// An axis as fast as the limit counts as standing.
    "operating-stop-limit-stands" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        operating_stop::transition(state, config, &operating_stop::Inputs { speed, ..*inputs })
    }
}

variants! { heidenhain::stop_path:
    /// The path is limited with the door closed too.
    "stop-path-every-door" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.state == GroupState::Auto {
            inputs.state = GroupState::Sls2;
        }
        stop_path::transition(state, config, &inputs)
    }

    /// The path counts from each cycle anew.
    "stop-path-restarts" |state, config, inputs| {
        let (mut after, outputs) = stop_path::transition(state, config, inputs);
        if inputs.braking {
            after.begin = inputs.position;
        }
        (after, outputs)
    }
}

variants! { heidenhain::position_limit:
    /// Driving further out does not lock the axis.
    "position-limit-never-locks" |state, config, inputs| {
        let (mut after, outputs) = position_limit::transition(state, config, inputs);
        if state.lock != position_limit::Lock::Locked && after.lock == position_limit::Lock::Locked {
            after.lock = position_limit::Lock::ReturnAllowed;
        }
        (after, outputs)
    }

    /// A locked axis is free again inside its limits.
    "position-limit-unlocks-inside" |state, config, inputs| {
        let (mut after, outputs) = position_limit::transition(state, config, inputs);
        if after.lock == position_limit::Lock::Locked && config.inside(inputs.position) {
            after.lock = position_limit::Lock::None;
        }
        (after, outputs)
    }

    /// The way back is stopped like the way out.
    "position-limit-stops-the-way-back" |state, config, inputs| {
        let (after, mut outputs) = position_limit::transition(state, config, inputs);
        if after.lock == position_limit::Lock::ReturnAllowed && inputs.position != state.last {
            outputs.demand = Stop::Ss1;
        }
        (after, outputs)
    }

    /// What the axis overruns while it is stopped locks it.
    "position-limit-locks-overrun" |state, config, inputs| {
        let inputs = position_limit::Inputs { stopping: false, ..*inputs };
        position_limit::transition(state, config, &inputs)
    }
}

variants! { heidenhain::revolutions:
    /// What the spindle turns back adds up.
    "revolutions-add-up" |state, config, inputs| {
        let step = inputs.step.saturating_abs();
        revolutions::transition(state, config, &revolutions::Inputs { step, ..*inputs })
    }

    /// The angle is kept to the next restricted operation.
    "revolutions-never-start-anew" |state, config, inputs| {
        let (after, outputs) = revolutions::transition(state, config, inputs);
        let kept = inputs.state != GroupState::SlsS;
        (if kept { state } else { after }, outputs)
    }
}

variants! { heidenhain::comparison:
    /// Nothing is compared in the operating stop.
    "comparison-not-in-standstill" |state, config, inputs| {
        let (after, mut outputs) = comparison::transition(state, config, inputs);
        if inputs.state == GroupState::Sos {
            outputs = comparison::Outputs::default();
        }
        (after, outputs)
    }

    /// The positions of an axis without a group are compared.
    "comparison-of-every-axis" |state, config, inputs| {
        comparison::transition(state, &config.with_group(), inputs)
    }

    /// The window does not start again within the tolerance.
    "comparison-window-adds-up" |state, config, inputs| {
        let (mut after, outputs) = comparison::transition(state, config, inputs);
        if after.outside.is_zero() {
            after = state;
        }
        (after, outputs)
    }
}

variants! { heidenhain::deceleration:
    /// There is no waiting time.
    "deceleration-no-wait" |state, config, inputs| {
        let state = deceleration::State {
            timer: Cycles::ZERO,
            ..state
        };
        deceleration::transition(state, config, inputs)
    }

    /// A spindle that keeps its speed counts as braking.
    "deceleration-constant-is-right" |state, config, inputs| {
        let (after, mut outputs) = deceleration::transition(state, config, inputs);
        if inputs.speed == state.last {
            outputs = deceleration::Outputs::default();
        }
        (after, outputs)
    }
}

variants! { heidenhain::axis_count:
    /// By handwheel several axes may move.
    "axis-count-free-handwheel" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.unit == Unit::Handwheel {
            inputs.unit = Unit::Panel;
        }
        axis_count::transition(state, config, &inputs)
    }

    /// Axes without a group count.
    "axis-count-every-axis" |state, config, inputs| {
        axis_count::transition(state, config, &axis_count::Inputs { ungrouped: 0, ..*inputs })
    }

    /// Homing several axes is stopped with the door closed too.
    "axis-count-closed-door" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.state == GroupState::Auto && inputs.unit == Unit::Reference {
            inputs.state = GroupState::Sls2;
        }
        axis_count::transition(state, config, &inputs)
    }
}
