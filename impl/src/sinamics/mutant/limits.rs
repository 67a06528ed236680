//! Wrong variants of the monitors of speed, direction and range.

use crate::kernel::{Cycles, Distance, Speed};
use crate::sinamics::types::Stop;
use crate::sinamics::{sdi, setpoint_limit, slp, sls, sls_ramp, ssm};

variants! { sinamics::sls:
    /// The limit itself is a violation.
    "sls-at-the-limit" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_add(1));
        let inputs = sls::Inputs { speed, ..*inputs };
        sls::transition(state, config, &inputs)
    }

    /// A lower limit takes effect at once.
    "sls-lower-at-once" |state, config, inputs| {
        let (mut after, outputs) = sls::transition(state, config, inputs);
        if after.phase == sls::Phase::Lower {
            after.phase = sls::Phase::Active;
            after.now = after.next;
            after.next = sls::Request::NONE;
            after.left = Cycles::ZERO;
        }
        (after, outputs)
    }

    /// While a lower limit waits nothing is monitored.
    "sls-blind-while-waiting" |state, config, inputs| {
        let (after, mut outputs) = sls::transition(state, config, inputs);
        if after.phase == sls::Phase::Lower {
            outputs.violated = false;
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }

    /// A higher limit waits for the delay.
    "sls-higher-waits" |state, config, inputs| {
        let (mut after, outputs) = sls::transition(state, config, inputs);
        if state.phase == sls::Phase::Lower && after.phase == sls::Phase::Active {
            after.now = state.now;
        }
        (after, outputs)
    }

    /// A wrong value of the telegram is the whole limit.
    "sls-wrong-value-is-whole" |state, config, inputs| {
        let telegram = if inputs.telegram < 1 { i16::MAX } else { inputs.telegram };
        let inputs = sls::Inputs { telegram, ..*inputs };
        sls::transition(state, config, &inputs)
    }

    /// The stop of the selected level is raised, not that of the monitored one.
    "sls-stop-of-another-level" |state, config, inputs| {
        let (after, mut outputs) = sls::transition(state, config, inputs);
        if outputs.violated {
            outputs.demand = config.response(inputs.level);
        }
        (after, outputs)
    }

    /// The telegram counts at every level.
    "sls-telegram-everywhere" |state, config, inputs| {
        let telegram = inputs.level != sls::Level::FIRST && inputs.telegram < 1;
        let (after, mut outputs) = sls::transition(state, config, inputs);
        outputs.wrong_value |= telegram && inputs.selected;
        (after, outputs)
    }

    /// SLS stays active in the operating stop.
    "sls-active-in-sos" |state, config, inputs| {
        let inputs = sls::Inputs { sos_after_stop: false, ..*inputs };
        sls::transition(state, config, &inputs)
    }
}

variants! { sinamics::sls_ramp:
    /// The new limit counts from the selection on.
    "sls-ramp-limit-at-once" |state, config, inputs| {
        let (mut after, outputs) = sls_ramp::transition(state, config, inputs);
        after.now = after.next.or(after.now);
        (after, outputs)
    }

    /// A violation of the ramp has the stop of the level.
    "sls-ramp-stop-of-the-level" |state, config, inputs| {
        let (after, mut outputs) = sls_ramp::transition(state, config, inputs);
        if outputs.ramp_violated {
            outputs.demand = config.response(outputs.level);
        }
        (after, outputs)
    }

    /// A speed that was once below the limit settles, whatever comes then.
    "sls-ramp-settles-anyhow" |state, config, inputs| {
        let (mut after, outputs) = sls_ramp::transition(state, config, inputs);
        if outputs.braking && after.settling.is_zero() {
            after.settling = state.settling;
        }
        (after, outputs)
    }

    /// The limit takes over only by the ramp.
    "sls-ramp-never-settles" |state, config, inputs| {
        let state = sls_ramp::State { settling: Cycles::ZERO, ..state };
        sls_ramp::transition(state, config, inputs)
    }

    /// The limit of the telegram has no effect.
    "sls-ramp-ignores-the-telegram" |state, config, inputs| {
        let inputs = sls_ramp::Inputs { telegram: i16::MAX, ..*inputs };
        sls_ramp::transition(state, config, &inputs)
    }

    /// A higher limit waits for the ramp.
    "sls-ramp-higher-waits" |state, config, inputs| {
        let (mut after, outputs) = sls_ramp::transition(state, config, inputs);
        if state.next.is_some() && after.next.is_none() && outputs.active {
            after.now = state.now;
        }
        (after, outputs)
    }
}

variants! { sinamics::setpoint_limit:
    /// SDI zeroes the direction that it permits.
    "setpoint-limit-wrong-side" |state, config, inputs| {
        let (after, mut outputs) = setpoint_limit::transition(state, config, inputs);
        core::mem::swap(&mut outputs.positive, &mut outputs.negative);
        (after, outputs)
    }

    /// p9533 is not counted.
    "setpoint-limit-whole" |state, config, inputs| {
        let (after, mut outputs) = setpoint_limit::transition(state, config, inputs);
        if inputs.sls && !inputs.sdi_negative && !inputs.acceptance {
            outputs.positive = inputs.limit;
        }
        (after, outputs)
    }

    /// The acceptance test mode leaves the limits.
    "setpoint-limit-in-acceptance" |state, config, inputs| {
        let inputs = setpoint_limit::Inputs { acceptance: false, ..*inputs };
        setpoint_limit::transition(state, config, &inputs)
    }
}

variants! { sinamics::ssm:
    /// The limit itself is below it.
    "ssm-at-the-limit" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        let inputs = ssm::Inputs { speed, ..*inputs };
        ssm::transition(state, config, &inputs)
    }

    /// The hysteresis is not held.
    "ssm-without-memory" |_, config, inputs| {
        ssm::transition(ssm::State { below: true }, config, inputs)
    }

    /// The answer is frozen whatever p9509.0 says.
    "ssm-always-frozen" |state, config, inputs| {
        let (mut after, mut outputs) = ssm::transition(state, config, inputs);
        if !inputs.pulses && state.below {
            after.below = true;
            outputs.below = true;
        }
        (after, outputs)
    }

    /// SSM without hysteresis counts as a monitoring function.
    "ssm-always-counts" |state, config, inputs| {
        let (after, mut outputs) = ssm::transition(state, config, inputs);
        outputs.counts = config.on();
        (after, outputs)
    }
}

variants! { sinamics::sdi:
    /// Both directions are blocked.
    "sdi-blocks-both" |state, config, inputs| {
        let (after, mut outputs) = sdi::transition(state, config, inputs);
        if inputs.position.distance(state.from) > Distance(5) && state.phase == sdi::Phase::Active {
            outputs.violated = true;
            outputs.demand = Stop::A;
        }
        (after, outputs)
    }

    /// The reference follows the axis in both directions.
    "sdi-follows-the-axis" |state, config, inputs| {
        let (mut after, outputs) = sdi::transition(state, config, inputs);
        if outputs.active {
            after.from = inputs.position;
        }
        (after, outputs)
    }

    /// The reference of an active SDI never moves.
    "sdi-fixed" |state, config, inputs| {
        let (mut after, outputs) = sdi::transition(state, config, inputs);
        if state.phase == sdi::Phase::Active && outputs.active {
            after.from = state.from;
        }
        (after, outputs)
    }

    /// SDI is active during its delay.
    "sdi-without-delay" |state, config, inputs| {
        let (after, mut outputs) = sdi::transition(state, config, inputs);
        outputs.active |= after.phase == sdi::Phase::Delay;
        (after, outputs)
    }

    /// A drive without encoder shows it active whatever p9509.8 says.
    "sdi-active-without-pulses" |state, config, inputs| {
        let inputs = sdi::Inputs { pulses: true, ..*inputs };
        sdi::transition(state, config, &inputs)
    }
}

variants! { sinamics::slp:
    /// The limits count without a safe reference.
    "slp-unreferenced" |state, config, inputs| {
        let inputs = slp::Inputs { safe: true, ..*inputs };
        slp::transition(state, config, &inputs)
    }

    /// The end of a range is outside.
    "slp-open-range" |state, config, inputs| {
        let (after, mut outputs) = slp::transition(state, config, inputs);
        outputs.above = outputs.active && inputs.position >= config.range(inputs.second).upper;
        (after, outputs)
    }

    /// The retraction frees the wrong direction.
    "slp-retracts-outwards" |state, config, inputs| {
        let (after, mut outputs) = slp::transition(state, config, inputs);
        core::mem::swap(&mut outputs.sdi_positive, &mut outputs.sdi_negative);
        (after, outputs)
    }

    /// A level retracts.
    "slp-static-retraction" |state, config, inputs| {
        let state = slp::State { input_held: false, ..state };
        slp::transition(state, config, inputs)
    }

    /// An edge is remembered until the axis is outside.
    "slp-remembers-the-edge" |state, config, inputs| {
        let (mut after, outputs) = slp::transition(state, config, inputs);
        after.input_held = inputs.retract && after.retract != slp::Retract::Off;
        (after, outputs)
    }

    /// The retraction outlives its input.
    "slp-retracts-for-ever" |state, config, inputs| {
        let (mut after, outputs) = slp::transition(state, config, inputs);
        if !inputs.retract {
            after.retract = state.retract;
        }
        (after, outputs)
    }

    /// The stop is that of range 1.
    "slp-stop-of-range-1" |state, config, inputs| {
        let (after, mut outputs) = slp::transition(state, config, inputs);
        if outputs.demand != Stop::None {
            outputs.demand = config.range(false).response;
        }
        (after, outputs)
    }
}
