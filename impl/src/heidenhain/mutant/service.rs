//! Wrong variants of the outputs, the referencing, the self-test and the checks.

use crate::heidenhain::types::{Som, Stop};
use crate::heidenhain::{
    acceptance, agreement, brakes, reference, sampling, self_checks, self_test, start_checks,
    status_bits, tool_holder,
};

variants! {
    brakes_any_request: brakes |state, config, inputs| {
        let (after, mut outputs) = brakes::transition(state, config, inputs);
        outputs.collected = inputs.shared[0].release || inputs.shared[1].release;
        (after, outputs)
    }

    brakes_test_overlooked: brakes |state, config, inputs| {
        brakes::transition(state, config, &brakes::Inputs { test: false, ..*inputs })
    }

    tool_holder_at_once: tool_holder |state, config, inputs| {
        let state = tool_holder::State { asked: true, ..state };
        tool_holder::transition(state, config, inputs)
    }

    tool_holder_door_overlooked: tool_holder |state, config, inputs| {
        let inputs = tool_holder::Inputs { door_open: false, ..*inputs };
        tool_holder::transition(state, config, &inputs)
    }

    tool_holder_cuts_off_turning: tool_holder |state, config, inputs| {
        let (mut after, mut outputs) = tool_holder::transition(state, config, inputs);
        after.asked = inputs.request && inputs.door_open;
        outputs.no_torque |= after.asked;
        (after, outputs)
    }

    acceptance_without_password: acceptance |state, config, inputs| {
        let inputs = acceptance::Inputs { password: true, ..*inputs };
        acceptance::transition(state, config, &inputs)
    }

    acceptance_one_press: acceptance |state, config, inputs| {
        let mut state = state;
        if state.phase == acceptance::Phase::Confirming {
            state.open = 1;
        }
        acceptance::transition(state, config, inputs)
    }

    reference_position_only: reference |state, config, inputs| {
        let mut state = state;
        state.saved |= state.axis == reference::AxisRef::Homed;
        reference::transition(state, config, inputs)
    }

    reference_in_som_1: reference |state, config, inputs| {
        let inputs = reference::Inputs { som: Som::Som2, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    reference_one_channel: reference |state, config, inputs| {
        let inputs = reference::Inputs { peer_matches: true, peer_checked: true, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    reference_forgets_the_cause: reference |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.check_cause &= state.axis == reference::AxisRef::Checked;
        reference::transition(state, config, &inputs)
    }

    agreement_early: agreement |state, config, inputs| {
        let (after, _) = agreement::transition(state, config, inputs);
        let (_, outputs) = agreement::transition(after, config, inputs);
        (after, outputs)
    }

    agreement_adds_up: agreement |state, config, inputs| {
        let (mut after, outputs) = agreement::transition(state, config, inputs);
        if !inputs.differ {
            after = state;
        }
        (after, outputs)
    }

    agreement_never_fatal: agreement |state, config, inputs| {
        let (after, mut outputs) = agreement::transition(state, config, inputs);
        outputs.demand = outputs.demand.min(Stop::Ss1);
        (after, outputs)
    }

    self_test_doors_overlooked: self_test |state, config, inputs| {
        let inputs = self_test::Inputs { doors_shut: true, ..*inputs };
        self_test::transition(state, config, &inputs)
    }

    self_test_bad_brake_passes: self_test |state, config, inputs| {
        let inputs = self_test::Inputs { brake_good: true, ..*inputs };
        self_test::transition(state, config, &inputs)
    }

    self_test_never_overdue: self_test |state, config, inputs| {
        let (mut after, mut outputs) = self_test::transition(state, config, inputs);
        if state.phase == self_test::Phase::Passed && !inputs.power_on {
            after.rest = state.rest;
            outputs.gen_safe = !after.rest.is_zero();
        }
        (after, outputs)
    }

    sampling_blind_in_the_pulse: sampling |state, config, inputs| {
        let (after, mut outputs) = sampling::transition(state, config, inputs);
        outputs.opened &= state.timer.is_zero();

        (after, outputs)
    }

    sampling_b_untested: sampling |state, config, inputs| {
        let (after, mut outputs) = sampling::transition(state, config, inputs);
        if state.pulse == sampling::Pulse::BLow && outputs.short {
            outputs.short = false;
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }

    status_bits_mask_too_wide: status_bits |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.n0 &= !inputs.masked;
        status_bits::transition(state, config, &inputs)
    }

    status_bits_mc_serves_on: status_bits |state, config, inputs| {
        let (after, mut outputs) = status_bits::transition(state, config, inputs);
        outputs.mc_retrigger = true;
        (after, outputs)
    }

    status_bits_board_switches_all_off: status_bits |state, config, inputs| {
        let (after, mut outputs) = status_bits::transition(state, config, inputs);
        outputs.spl_off |= inputs.pf_board;
        outputs.smop_off |= inputs.pf_board;
        (after, outputs)
    }

    self_checks_fan_overlooked: self_checks |state, config, inputs| {
        let inputs = self_checks::Inputs { fan: false, ..*inputs };
        self_checks::transition(state, config, &inputs)
    }

    self_checks_runtime_is_ss1: self_checks |state, config, inputs| {
        let inputs = self_checks::Inputs {
            runtime: false,
            internal_es: inputs.internal_es || inputs.runtime,
            ..*inputs
        };
        self_checks::transition(state, config, &inputs)
    }

    start_checks_any_speed: start_checks |state, config, inputs| {
        let motor_speed = inputs.motor_speed.min(100);
        start_checks::transition(state, config, &start_checks::Inputs { motor_speed, ..*inputs })
    }

    start_checks_tries_again: start_checks |state, config, inputs| {
        let power_on = inputs.power_on || state.start == start_checks::Start::Refused;
        start_checks::transition(state, config, &start_checks::Inputs { power_on, ..*inputs })
    }
}
