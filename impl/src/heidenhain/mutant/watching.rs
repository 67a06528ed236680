//! Wrong variants of the monitors of position and speed.

use crate::heidenhain::types::{GroupState, Left, Stop, Unit};
use crate::heidenhain::{
    axis_count, comparison, deceleration, operating_stop, position_limit, revolutions, speed,
    stop_path,
};
use crate::kernel::{Cycles, Speed};

variants! {
    speed_margin_too_wide: speed |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        speed::transition(state, config, &speed::Inputs { speed, ..*inputs })
    }

    speed_higher_of_two: speed |state, config, inputs| {
        let left = Left::NONE;
        speed::transition(state, config, &speed::Inputs { left, ..*inputs })
    }

    speed_zero_is_no_fault: speed |state, config, inputs| {
        let (after, mut outputs) = speed::transition(state, config, inputs);
        outputs.not_set = false;
        (after, outputs)
    }

    operating_stop_follows: operating_stop |state, config, inputs| {
        let (mut after, outputs) = operating_stop::transition(state, config, inputs);
        if inputs.watched {
            after.begin = inputs.position;
        }
        (after, outputs)
    }

    operating_stop_brakes_creeping: operating_stop |state, config, inputs| {
        let (after, mut outputs) = operating_stop::transition(state, config, inputs);
        if outputs.demand == Stop::Ss0 {
            outputs.demand = Stop::Ss1;
        }
        (after, outputs)
    }

    operating_stop_limit_stands: operating_stop |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        operating_stop::transition(state, config, &operating_stop::Inputs { speed, ..*inputs })
    }

    stop_path_every_door: stop_path |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.state == GroupState::Auto {
            inputs.state = GroupState::Sls2;
        }
        stop_path::transition(state, config, &inputs)
    }

    stop_path_restarts: stop_path |state, config, inputs| {
        let (mut after, outputs) = stop_path::transition(state, config, inputs);
        if inputs.braking {
            after.begin = inputs.position;
        }
        (after, outputs)
    }

    position_limit_never_locks: position_limit |state, config, inputs| {
        let (mut after, outputs) = position_limit::transition(state, config, inputs);
        if state.lock != position_limit::Lock::Locked && after.lock == position_limit::Lock::Locked {
            after.lock = position_limit::Lock::ReturnAllowed;
        }
        (after, outputs)
    }

    position_limit_unlocks_inside: position_limit |state, config, inputs| {
        let (mut after, outputs) = position_limit::transition(state, config, inputs);
        if after.lock == position_limit::Lock::Locked && config.inside(inputs.position) {
            after.lock = position_limit::Lock::None;
        }
        (after, outputs)
    }

    position_limit_stops_the_way_back: position_limit |state, config, inputs| {
        let (after, mut outputs) = position_limit::transition(state, config, inputs);
        if after.lock == position_limit::Lock::ReturnAllowed && inputs.position != state.last {
            outputs.demand = Stop::Ss1;
        }
        (after, outputs)
    }

    position_limit_locks_overrun: position_limit |state, config, inputs| {
        let inputs = position_limit::Inputs { stopping: false, ..*inputs };
        position_limit::transition(state, config, &inputs)
    }

    revolutions_add_up: revolutions |state, config, inputs| {
        let step = inputs.step.saturating_abs();
        revolutions::transition(state, config, &revolutions::Inputs { step, ..*inputs })
    }

    revolutions_never_start_anew: revolutions |state, config, inputs| {
        let (after, outputs) = revolutions::transition(state, config, inputs);
        let kept = inputs.state != GroupState::SlsS;
        (if kept { state } else { after }, outputs)
    }

    comparison_not_in_standstill: comparison |state, config, inputs| {
        let (after, mut outputs) = comparison::transition(state, config, inputs);
        if inputs.state == GroupState::Sos {
            outputs = comparison::Outputs::default();
        }
        (after, outputs)
    }

    comparison_of_every_axis: comparison |state, config, inputs| {
        comparison::transition(state, &config.with_group(), inputs)
    }

    comparison_window_adds_up: comparison |state, config, inputs| {
        let (mut after, outputs) = comparison::transition(state, config, inputs);
        if after.outside.is_zero() {
            after = state;
        }
        (after, outputs)
    }

    deceleration_no_wait: deceleration |state, config, inputs| {
        let state = deceleration::State {
            timer: Cycles::ZERO,
            ..state
        };
        deceleration::transition(state, config, inputs)
    }

    deceleration_constant_is_right: deceleration |state, config, inputs| {
        let (after, mut outputs) = deceleration::transition(state, config, inputs);
        if inputs.speed == state.last {
            outputs = deceleration::Outputs::default();
        }
        (after, outputs)
    }

    axis_count_free_handwheel: axis_count |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.unit == Unit::Handwheel {
            inputs.unit = Unit::Panel;
        }
        axis_count::transition(state, config, &inputs)
    }

    axis_count_every_axis: axis_count |state, config, inputs| {
        axis_count::transition(state, config, &axis_count::Inputs { ungrouped: 0, ..*inputs })
    }

    axis_count_closed_door: axis_count |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.state == GroupState::Auto && inputs.unit == Unit::Reference {
            inputs.state = GroupState::Sls2;
        }
        axis_count::transition(state, config, &inputs)
    }
}
