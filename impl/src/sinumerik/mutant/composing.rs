//! Wrong wirings of the channel.

use crate::kernel::Speed;

use crate::sinumerik::level::Level;
use crate::sinumerik::{channel, fault, pulses, selection};

pub(super) fn channel_ramp_unwired(
    mut state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    state.ramp.lowest = Speed(u32::MAX);
    channel::transition(state, config, inputs)
}

pub(super) fn channel_forced_stop_unwired(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (mut after, mut outputs) = channel::transition(state, config, inputs);
    (after.selection, outputs.selection) = selection::transition(
        state.selection,
        &config.selection,
        &selection::Inputs {
            power_on: inputs.power_on,
            sge_sbh_sg: inputs.sge_sbh_sg,
            sge_sbh: inputs.sge_sbh,
            sg_select: inputs.sg_select,
            over: inputs.over,
            sbh_internal: false,
            position: outputs.motion.position,
            ended_at: state.motion.last,
            set_anew: inputs.set_anew,
        },
    );
    (after, outputs)
}

pub(super) fn channel_pulses_late(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (mut after, mut outputs) = channel::transition(state, config, inputs);
    (after.pulses, outputs.pulses) = pulses::transition(
        state.pulses,
        &config.pulses,
        &pulses::Inputs {
            power_on: inputs.power_on,
            run_up: inputs.run_up,
            cancel: matches!(state.stop.level, Level::A | Level::Test),
            external_test: inputs.external_test,
            feedback: inputs.feedback,
        },
    );
    (after, outputs)
}

pub(super) fn channel_fault_sees_the_new_stop(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (mut after, mut outputs) = channel::transition(state, config, inputs);
    (after.fault, outputs.fault) = fault::transition(
        state.fault,
        &config.fault,
        &fault::Inputs {
            power_on: inputs.power_on,
            reset: inputs.reset,
            discrepancy: inputs.discrepancy || outputs.test.refused,
            rx_fault: inputs.rx_fault,
            monitoring: outputs.monitoring,
            cde_before: after.stop.level.ends_in_standstill(),
            ab_before: false,
        },
    );
    (after, outputs)
}

pub(super) fn channel_standstill_shown_late(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (after, mut outputs) = channel::transition(state, config, inputs);
    outputs.sbh_active = outputs.selection.sga_sbh_active;
    outputs.sbh_sg_active = outputs.selection.sga_active;
    outputs.sg_active = outputs.selection.sga_sg;
    (after, outputs)
}

pub(super) fn channel_stopsi_hides_fault(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (after, mut outputs) = channel::transition(state, config, inputs);
    if matches!(outputs.stop.stopsi, 5 | 11) {
        outputs.stop.stopsi = -1;
    }
    (after, outputs)
}

pub(super) fn channel_reference_overlooked(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    channel::transition(
        state,
        config,
        &channel::Inputs {
            set_anew: false,
            ..*inputs
        },
    )
}
