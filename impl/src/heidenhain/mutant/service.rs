//! Wrong variants of the outputs, the referencing, the self-test and the checks.

use crate::heidenhain::types::{Som, Stop};
use crate::heidenhain::{
    acceptance, agreement, brakes, reference, sampling, self_checks, self_test, start_checks,
    status_bits, tool_holder,
};

variants! { heidenhain::reference:
    /// A saved position counts whether it was checked or not.
    "reference-position-only" |state, config, inputs| {
        let mut state = state;
        state.saved |= state.axis == reference::AxisRef::Homed;
        reference::transition(state, config, inputs)
    }

    /// The confirmation is accepted in SOM_1.
    "reference-in-som-1" |state, config, inputs| {
        let inputs = reference::Inputs { som: Som::Som2, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// An axis that is not homed moves behind a closed door.
    "reference-unhomed-behind-the-door" |state, config, inputs| {
        let (after, mut outputs) = reference::transition(state, config, inputs);
        outputs.untested &= inputs.door_open;
        outputs.demand = if outputs.untested { Stop::Ss2 } else { Stop::None };
        (after, outputs)
    }

    /// The other channel is not asked.
    "reference-one-channel" |state, config, inputs| {
        let inputs = reference::Inputs { peer_matches: true, peer_checked: true, ..*inputs };
        reference::transition(state, config, &inputs)
    }

    /// A cause for a check counts only if the axis was checked when the power went: a second power-on forgets it.
    "reference-forgets-the-cause" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.check_cause &= state.axis == reference::AxisRef::Checked;
        reference::transition(state, config, &inputs)
    }
}

variants! { heidenhain::agreement:
    /// The window is one cycle short.
    "agreement-early" |state, config, inputs| {
        let (after, _) = agreement::transition(state, config, inputs);
        let (_, outputs) = agreement::transition(after, config, inputs);
        (after, outputs)
    }

    /// The window is not whole again when the channels agree.
    "agreement-adds-up" |state, config, inputs| {
        let (mut after, outputs) = agreement::transition(state, config, inputs);
        if !inputs.differ {
            after = state;
        }
        (after, outputs)
    }

    /// A difference of the flag "axis checked" is SS1 only.
    "agreement-never-fatal" |state, config, inputs| {
        let (after, mut outputs) = agreement::transition(state, config, inputs);
        outputs.demand = outputs.demand.min(Stop::Ss1);
        (after, outputs)
    }
}

variants! { heidenhain::brakes:
    /// In operation one request opens a shared output.
    "brakes-any-request" |state, config, inputs| {
        let (after, mut outputs) = brakes::transition(state, config, inputs);
        outputs.collected = inputs.shared[0].release || inputs.shared[1].release;
        (after, outputs)
    }

    /// In the test a shared output needs all requests.
    "brakes-test-overlooked" |state, config, inputs| {
        brakes::transition(state, config, &brakes::Inputs { test: false, ..*inputs })
    }
}

variants! { heidenhain::tool_holder:
    /// The holder opens in the cycle in which torque off is asked for.
    "tool-holder-at-once" |state, config, inputs| {
        let state = tool_holder::State { asked: true, ..state };
        tool_holder::transition(state, config, inputs)
    }

    /// An open door counts as closed.
    "tool-holder-door-overlooked" |state, config, inputs| {
        let inputs = tool_holder::Inputs { door_open: false, ..*inputs };
        tool_holder::transition(state, config, &inputs)
    }

    /// Torque off is asked for while the spindle turns.
    "tool-holder-cuts-off-turning" |state, config, inputs| {
        let (mut after, mut outputs) = tool_holder::transition(state, config, inputs);
        after.asked = inputs.request && inputs.door_open;
        outputs.no_torque |= after.asked;
        (after, outputs)
    }
}

variants! { heidenhain::acceptance:
    /// The list begins without the password.
    "acceptance-without-password" |state, config, inputs| {
        let inputs = acceptance::Inputs { password: true, ..*inputs };
        acceptance::transition(state, config, &inputs)
    }

    /// One press confirms the whole list.
    "acceptance-one-press" |state, config, inputs| {
        let mut state = state;
        if state.phase == acceptance::Phase::Confirming {
            state.open = 1;
        }
        acceptance::transition(state, config, inputs)
    }
}

variants! { heidenhain::self_test:
    /// The test goes on with open doors.
    "self-test-doors-overlooked" |state, config, inputs| {
        let inputs = self_test::Inputs { doors_shut: true, ..*inputs };
        self_test::transition(state, config, &inputs)
    }

    /// A brake that does not hold passes.
    "self-test-bad-brake-passes" |state, config, inputs| {
        let inputs = self_test::Inputs { brake_good: true, ..*inputs };
        self_test::transition(state, config, &inputs)
    }

    /// A passed test is good for ever.
    "self-test-never-overdue" |state, config, inputs| {
        let (mut after, mut outputs) = self_test::transition(state, config, inputs);
        if state.phase == self_test::Phase::Passed && !inputs.power_on {
            after.rest = state.rest;
            outputs.gen_safe = !after.rest.is_zero();
        }
        (after, outputs)
    }
}

variants! { heidenhain::sampling:
    /// During a pulse neither channel sees an open contact.
    "sampling-blind-in-the-pulse" |state, config, inputs| {
        let (after, mut outputs) = sampling::transition(state, config, inputs);
        outputs.opened &= state.timer.is_zero();

        (after, outputs)
    }

    /// A short circuit of channel B is not found.
    "sampling-b-untested" |state, config, inputs| {
        let (after, mut outputs) = sampling::transition(state, config, inputs);
        if state.pulse == sampling::Pulse::BLow && outputs.short {
            outputs.short = false;
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }
}

variants! { heidenhain::status_bits:
    /// The mask of the PLC also hides -N0.
    "status-bits-mask-too-wide" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.n0 &= !inputs.masked;
        status_bits::transition(state, config, &inputs)
    }

    /// The MC serves its watchdogs without DC-link voltage.
    "status-bits-mc-serves-on" |state, config, inputs| {
        let (after, mut outputs) = status_bits::transition(state, config, inputs);
        outputs.mc_retrigger = true;
        (after, outputs)
    }

    /// -PF.BOARD of any participant switches the outputs of all of them off.
    "status-bits-board-switches-all-off" |state, config, inputs| {
        let (after, mut outputs) = status_bits::transition(state, config, inputs);
        outputs.spl_off |= inputs.pf_board;
        outputs.smop_off |= inputs.pf_board;
        (after, outputs)
    }
}

variants! { heidenhain::self_checks:
    /// A slow fan is not seen.
    "self-checks-fan-overlooked" |state, config, inputs| {
        let inputs = self_checks::Inputs { fan: false, ..*inputs };
        self_checks::transition(state, config, &inputs)
    }

    /// The request of the safe PLC's run-time system is SS1 only.
    "self-checks-runtime-is-ss1" |state, config, inputs| {
        let inputs = self_checks::Inputs {
            runtime: false,
            internal_es: inputs.internal_es || inputs.runtime,
            ..*inputs
        };
        self_checks::transition(state, config, &inputs)
    }
}

variants! { heidenhain::start_checks:
    /// Any motor speed is plausible.
    "start-checks-any-speed" |state, config, inputs| {
        let motor_speed = inputs.motor_speed.min(100);
        start_checks::transition(state, config, &start_checks::Inputs { motor_speed, ..*inputs })
    }

    /// A refused control tries again by itself.
    "start-checks-tries-again" |state, config, inputs| {
        let power_on = inputs.power_on || state.start == start_checks::Start::Refused;
        start_checks::transition(state, config, &start_checks::Inputs { power_on, ..*inputs })
    }
}
