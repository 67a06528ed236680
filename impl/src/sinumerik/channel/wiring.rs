//! Who gets what from whom, in the order of the cycle.

use super::{Config, Inputs, Outputs, State};
use crate::sinumerik::level::InternalStop;
use crate::sinumerik::selection::Stage;
use crate::sinumerik::{
    external, fault, limit_switch, motion, pulses, ramp, selection, speed, standstill, stop,
    test_stop, threshold,
};

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let power_on = inputs.power_on;
    // What later monitors left behind for earlier ones; power-on acknowledges it.
    let stop_before = if power_on {
        stop::State::INITIAL
    } else {
        state.stop
    };
    let internal_ab = stop_before.internal >= InternalStop::B;

    let (external, external_out) = external::next(
        state.external,
        &config.external,
        &external::Inputs {
            power_on,
            reset: inputs.reset,
            spl_started: inputs.spl_started,
            sge_a: inputs.sge_a,
            sge_c: inputs.sge_c,
            sge_d: inputs.sge_d,
            sge_e: inputs.sge_e,
            spl_error: inputs.spl_error,
        },
    );
    let (motion, motion_out) = motion::next(
        state.motion,
        &motion::Config,
        &motion::Inputs {
            power_on,
            position: inputs.position,
            parking: inputs.parking,
            set_anew: inputs.set_anew,
        },
    );
    let (position, actual) = (motion_out.position, motion_out.speed);
    let (test, test_out) = test_stop::next(
        state.test,
        &config.test,
        &test_stop::Inputs {
            power_on,
            select: inputs.test_select,
            pulses_cancelled: inputs.feedback,
            internal_ab,
        },
    );
    let (selection, selection_out) = selection::next(
        state.selection,
        &config.selection,
        &selection::Inputs {
            power_on,
            sge_sbh_sg: inputs.sge_sbh_sg,
            sge_sbh: inputs.sge_sbh,
            sg_select: inputs.sg_select,
            over: inputs.over,
            sbh_internal: stop_before.phase == stop::Phase::SbhInt,
            position,
            ended_at: state.motion.last,
            set_anew: inputs.set_anew,
        },
    );

    let (_, standstill_out) = standstill::next(
        standstill::State::INITIAL,
        &config.standstill,
        &standstill::Inputs {
            monitored: selection_out.monitored,
            position,
            reference: selection_out.reference,
        },
    );
    let (_, speed_out) = speed::next(
        speed::State::INITIAL,
        &config.speed,
        &speed::Inputs {
            monitored: selection_out.monitored,
            speed: actual,
            limit: selection_out.limit,
            stage: selection_out.sga_sg,
            encoder_speed: inputs.encoder_speed,
        },
    );
    let (_, limit_switch_out) = limit_switch::next(
        limit_switch::State::INITIAL,
        &config.limit_switch,
        &limit_switch::Inputs {
            active: inputs.se_active,
            select: inputs.se_select,
            position,
        },
    );
    let (ramp, ramp_out) = ramp::next(
        state.ramp,
        &config.ramp,
        &ramp::Inputs {
            power_on,
            on: stop_before.sbr_on(),
            speed: actual,
        },
    );
    let (_, threshold_out) = threshold::next(
        threshold::State::INITIAL,
        &config.threshold,
        &threshold::Inputs { speed: actual },
    );

    let demand = standstill_out
        .demand
        .max(speed_out.demand)
        .max(limit_switch_out.demand)
        .max(ramp_out.demand)
        .max(test_out.demand)
        .max(inputs.demand);
    let monitoring = selection_out.sga_active || config.se_sn_enabled;
    let (fault, fault_out) = fault::next(
        state.fault,
        &config.fault,
        &fault::Inputs {
            power_on,
            reset: inputs.reset,
            discrepancy: inputs.discrepancy || test_out.refused,
            rx_fault: inputs.rx_fault,
            monitoring,
            cde_before: stop_before.level.ends_in_standstill(),
            ab_before: internal_ab,
        },
    );
    let (stop, stop_out) = stop::next(
        state.stop,
        &config.stop,
        &stop::Inputs {
            power_on,
            reset: inputs.reset,
            demand,
            f_stop_b: fault_out.stop_b,
            rx_internal: inputs.rx_internal,
            external: external_out.request,
            rx_external: inputs.rx_external,
            test: test_out.active,
            standstill: actual < config.standstill_speed,
            fault: fault_out.interlock,
            external_test: inputs.external_test,
        },
    );
    let (pulses, pulses_out) = pulses::next(
        state.pulses,
        &config.pulses,
        &pulses::Inputs {
            power_on,
            run_up: inputs.run_up,
            cancel: stop_out.cancel_pulses,
            external_test: inputs.external_test,
            feedback: inputs.feedback,
        },
    );

    let after = State {
        external,
        motion,
        test,
        selection,
        ramp,
        fault,
        stop,
        pulses,
    };
    // The operating stop is active from the cycle on in which the braking ends, for the monitor to compare in the next one.
    let begun = config.selection.enabled() && stop_out.sbh_internal;
    let sbh_active = selection_out.sga_sbh_active || begun;
    let outputs = Outputs {
        sbh_sg_active: selection_out.sga_active || begun,
        sbh_active,
        sg_active: if sbh_active {
            Stage::Sg1
        } else {
            selection_out.sga_sg
        },
        external: external_out,
        motion: motion_out,
        test: test_out,
        selection: selection_out,
        standstill: standstill_out,
        speed: speed_out,
        limit_switch: limit_switch_out,
        ramp: ramp_out,
        threshold: threshold_out,
        fault: fault_out,
        stop: stop_out,
        pulses: pulses_out,
        demand,
        monitoring,
        start_inhibit: stop_out.start_inhibit || fault_out.interlock,
    };
    (after, outputs)
}
