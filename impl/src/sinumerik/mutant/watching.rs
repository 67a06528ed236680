//! Wrong variants of the monitors of position and speed.

use crate::kernel::Speed;

use crate::sinumerik::level::InternalStop;
use crate::sinumerik::selection::Monitored;
use crate::sinumerik::{cam, limit_switch, motion, ramp, results, speed, standstill, threshold};

pub(super) fn motion_parking_overlooked(
    state: motion::State,
    config: &motion::Config,
    inputs: &motion::Inputs,
) -> (motion::State, motion::Outputs) {
    let (mut after, outputs) = motion::transition(state, config, inputs);
    after.known |= inputs.parking && state.known;
    (after, outputs)
}

pub(super) fn motion_reference_counts(
    state: motion::State,
    config: &motion::Config,
    inputs: &motion::Inputs,
) -> (motion::State, motion::Outputs) {
    let inputs = motion::Inputs {
        set_anew: false,
        ..*inputs
    };
    motion::transition(state, config, &inputs)
}

pub(super) fn motion_reference_stops(
    state: motion::State,
    config: &motion::Config,
    inputs: &motion::Inputs,
) -> (motion::State, motion::Outputs) {
    let (mut after, mut outputs) = motion::transition(state, config, inputs);
    if inputs.set_anew {
        (after.speed, outputs.speed) = (Speed(0), Speed(0));
    }
    (after, outputs)
}

pub(super) fn motion_one_direction(
    state: motion::State,
    config: &motion::Config,
    inputs: &motion::Inputs,
) -> (motion::State, motion::Outputs) {
    let (after, mut outputs) = motion::transition(state, config, inputs);
    if inputs.position < state.last {
        outputs.speed = Speed(0);
    }
    (after, outputs)
}

pub(super) fn standstill_one_side(
    state: standstill::State,
    config: &standstill::Config,
    inputs: &standstill::Inputs,
) -> (standstill::State, standstill::Outputs) {
    let (after, mut outputs) = standstill::transition(state, config, inputs);
    if outputs.lower {
        outputs = standstill::Outputs::default();
    }
    (after, outputs)
}

pub(super) fn speed_limit_loose(
    state: speed::State,
    config: &speed::Config,
    inputs: &speed::Inputs,
) -> (speed::State, speed::Outputs) {
    let limit = Speed(inputs.limit.0.saturating_add(1));
    speed::transition(state, config, &speed::Inputs { limit, ..*inputs })
}

pub(super) fn speed_encoder_overlooked(
    state: speed::State,
    config: &speed::Config,
    inputs: &speed::Inputs,
) -> (speed::State, speed::Outputs) {
    let mut inputs = *inputs;
    if inputs.monitored == Monitored::Standstill {
        inputs.encoder_speed = Speed(0);
    }
    speed::transition(state, config, &inputs)
}

pub(super) fn limit_switch_other_pair(
    state: limit_switch::State,
    config: &limit_switch::Config,
    inputs: &limit_switch::Inputs,
) -> (limit_switch::State, limit_switch::Outputs) {
    let select = !inputs.select;
    limit_switch::transition(state, config, &limit_switch::Inputs { select, ..*inputs })
}

pub(super) fn limit_switch_without_agreement(
    state: limit_switch::State,
    config: &limit_switch::Config,
    inputs: &limit_switch::Inputs,
) -> (limit_switch::State, limit_switch::Outputs) {
    let active = true;
    limit_switch::transition(state, config, &limit_switch::Inputs { active, ..*inputs })
}

pub(super) fn ramp_limit_rises(
    state: ramp::State,
    config: &ramp::Config,
    inputs: &ramp::Inputs,
) -> (ramp::State, ramp::Outputs) {
    let (_, mut outputs) = ramp::transition(state, config, inputs);
    let after = ramp::State {
        lowest: inputs.speed,
    };
    outputs.limit = after.limit(config);
    (after, outputs)
}

pub(super) fn ramp_demands_stop_b(
    state: ramp::State,
    config: &ramp::Config,
    inputs: &ramp::Inputs,
) -> (ramp::State, ramp::Outputs) {
    let (after, mut outputs) = ramp::transition(state, config, inputs);
    if outputs.violated {
        outputs.demand = InternalStop::B;
    }
    (after, outputs)
}

pub(super) fn threshold_included(
    state: threshold::State,
    config: &threshold::Config,
    inputs: &threshold::Inputs,
) -> (threshold::State, threshold::Outputs) {
    let speed = Speed(inputs.speed.0.saturating_sub(1));
    threshold::transition(state, config, &threshold::Inputs { speed })
}

pub(super) fn cam_without_hysteresis(
    state: cam::State,
    config: &cam::Config,
    inputs: &cam::Inputs,
) -> (cam::State, cam::Outputs) {
    // As if it had been 1 before: on at the cam.
    let _ = state;
    cam::transition(cam::State { own: true }, config, inputs)
}

pub(super) fn cam_alone(
    state: cam::State,
    config: &cam::Config,
    inputs: &cam::Inputs,
) -> (cam::State, cam::Outputs) {
    let other = true;
    cam::transition(state, config, &cam::Inputs { other, ..*inputs })
}

pub(super) fn results_hide_lower_end(
    state: results::State,
    config: &results::Config,
    inputs: &results::Inputs,
) -> (results::State, results::Outputs) {
    let se_lower = false;
    results::transition(
        state,
        config,
        &results::Inputs {
            se_lower,
            ..*inputs
        },
    )
}

pub(super) fn results_show_sg1(
    state: results::State,
    config: &results::Config,
    inputs: &results::Inputs,
) -> (results::State, results::Outputs) {
    let (after, mut outputs) = results::transition(state, config, inputs);
    if inputs.monitored == Monitored::Speed {
        let [sg1, ..] = &mut outputs.list_1.sg;
        *sg1 = results::Field::Within;
    }
    (after, outputs)
}
