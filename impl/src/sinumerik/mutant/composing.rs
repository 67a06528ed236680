//! Wrong wirings of the channel.

use crate::kernel::Speed;

use crate::sinumerik::level::Level;
use crate::sinumerik::{channel, fault, pulses, selection};

variants! { sinumerik::channel:
    /// The braking ramp watches nothing.
    "channel-ramp-unwired" |mut state, config, inputs| {
        state.ramp.lowest = Speed(u32::MAX);
        channel::transition(state, config, inputs)
    }

    /// The end of a STOP C, D or E does not force the operating stop.
    "channel-forced-stop-unwired" |state, config, inputs| {
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

    /// The pulses are cancelled one cycle after their stop.
    "channel-pulses-late" |state, config, inputs| {
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

    /// The operating stop that a stop ends in is shown a cycle late.
    "channel-standstill-shown-late" |state, config, inputs| {
        let (after, mut outputs) = channel::transition(state, config, inputs);
        outputs.sbh_active = outputs.selection.sga_sbh_active;
        outputs.sbh_sg_active = outputs.selection.sga_active;
        outputs.sg_active = outputs.selection.sga_sg;
        (after, outputs)
    }

    /// `$VA_STOPSI` hides STOP F and the test of the external shutdown.
    "channel-stopsi-hides-fault" |state, config, inputs| {
        let (after, mut outputs) = channel::transition(state, config, inputs);
        if matches!(outputs.stop.stopsi, 5 | 11) {
            outputs.stop.stopsi = -1;
        }
        (after, outputs)
    }

    /// Referencing is not told to the monitors: the new position counts as motion.
    "channel-reference-overlooked" |state, config, inputs| {
        channel::transition(
            state,
            config,
            &channel::Inputs {
                set_anew: false,
                ..*inputs
            },
        )
    }

    /// A STOP C, D or E of the same cycle keeps STOP F from starting its delay.
    "channel-fault-sees-the-new-stop" |state, config, inputs| {
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
}
