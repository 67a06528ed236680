//! Wrong variants of the monitors of position and speed.

use crate::kernel::Speed;

use crate::sinumerik::level::InternalStop;
use crate::sinumerik::selection::Monitored;
use crate::sinumerik::{
    cam, limit_switch, motion, ramp, results, setpoint, speed, standstill, threshold,
};

variants! { sinumerik::motion:
    /// The way made while parked counts as speed.
    "motion-parking-overlooked" |state, config, inputs| {
        let (mut after, outputs) = motion::transition(state, config, inputs);
        after.known |= inputs.parking && state.known;
        (after, outputs)
    }

    /// Only motion in the positive direction has a speed.
    "motion-one-direction" |state, config, inputs| {
        let (after, mut outputs) = motion::transition(state, config, inputs);
        if inputs.position < state.last {
            outputs.speed = Speed(0);
        }
        (after, outputs)
    }

    /// A position set anew by referencing counts as motion.
    "motion-reference-counts" |state, config, inputs| {
        let inputs = motion::Inputs {
            set_anew: false,
            ..*inputs
        };
        motion::transition(state, config, &inputs)
    }

    /// A position set anew by referencing takes a moving axis for one that stands.
    "motion-reference-stops" |state, config, inputs| {
        let (mut after, mut outputs) = motion::transition(state, config, inputs);
        if inputs.set_anew {
            (after.speed, outputs.speed) = (Speed(0), Speed(0));
        }
        (after, outputs)
    }
}

variants! { sinumerik::standstill:
    /// The lower limit of the window is not watched.
    "standstill-one-side" |state, config, inputs| {
        let (after, mut outputs) = standstill::transition(state, config, inputs);
        if outputs.lower {
            outputs = standstill::Outputs::default();
        }
        (after, outputs)
    }
}

variants! { sinumerik::speed:
    /// One increment more than the limit is permitted.
    "speed-limit-loose" |state, config, inputs| {
        let limit = Speed(inputs.limit.0.saturating_add(1));
        speed::transition(state, config, &speed::Inputs { limit, ..*inputs })
    }

    /// The encoder limit is not watched in the operating stop.
    "speed-encoder-overlooked" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.monitored == Monitored::Standstill {
            inputs.encoder_speed = Speed(0);
        }
        speed::transition(state, config, &inputs)
    }
}

variants! { sinumerik::setpoint:
    /// The first channel that changes over raises the limit.
    "setpoint-first-channel-raises" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.nck_goal == Monitored::Speed && inputs.drive_goal == Monitored::Speed {
            let higher = inputs.nck_limit.max(inputs.drive_limit);
            (inputs.nck_limit, inputs.drive_limit) = (higher, higher);
        }
        setpoint::transition(state, config, &inputs)
    }

    /// A channel with nothing selected lifts the limit of the other one.
    "setpoint-one-channel-frees" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.drive_goal == Monitored::Nothing {
            inputs.nck_goal = Monitored::Nothing;
        }
        setpoint::transition(state, config, &inputs)
    }
}

variants! { sinumerik::limit_switch:
    /// The pair that is not selected is watched.
    "limit-switch-other-pair" |state, config, inputs| {
        let select = !inputs.select;
        limit_switch::transition(state, config, &limit_switch::Inputs { select, ..*inputs })
    }

    /// The limit switches act without agreement.
    "limit-switch-without-agreement" |state, config, inputs| {
        let active = true;
        limit_switch::transition(state, config, &limit_switch::Inputs { active, ..*inputs })
    }
}

variants! { sinumerik::ramp:
    /// The limit follows the speed up again.
    "ramp-limit-rises" |state, config, inputs| {
        let (_, mut outputs) = ramp::transition(state, config, inputs);
        let after = ramp::State {
            lowest: inputs.speed,
        };
        outputs.limit = after.limit(config);
        (after, outputs)
    }

    /// A violation demands STOP B only.
    "ramp-demands-stop-b" |state, config, inputs| {
        let (after, mut outputs) = ramp::transition(state, config, inputs);
        if outputs.violated {
            outputs.demand = InternalStop::B;
        }
        (after, outputs)
    }
}

variants! { sinumerik::threshold:
    /// At the threshold the axis counts as below it.
    "threshold-included" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        threshold::transition(state, config, &threshold::Inputs { speed })
    }
}

variants! { sinumerik::cam:
    /// A synchronised cam has no hysteresis.
    "cam-without-hysteresis" |state, config, inputs| {
        // As if it had been 1 before: on at the cam.
        let _ = state;
        cam::transition(cam::State { own: true }, config, inputs)
    }

    /// A synchronised cam does not ask the other channel.
    "cam-alone" |state, config, inputs| {
        let other = true;
        cam::transition(state, config, &cam::Inputs { other, ..*inputs })
    }
}

variants! { sinumerik::results:
    /// A position beyond the minus end is not shown.
    "results-hide-lower-end" |state, config, inputs| {
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

    /// SG1 is shown as selected whatever stage is in force.
    "results-show-sg1" |state, config, inputs| {
        let (after, mut outputs) = results::transition(state, config, inputs);
        if inputs.monitored == Monitored::Speed {
            let [sg1, ..] = &mut outputs.list_1.sg;
            *sg1 = results::Field::Within;
        }
        (after, outputs)
    }
}
