//! Wrong monitors of stops and acknowledgement.

use crate::kernel::Cycles;
use crate::sinamics::level::{Function, Stop};
use crate::sinamics::{
    acknowledgement, acknowledgement_edge, basic_stop, cross_check, stop_arbiter,
};

variants! { sinamics::basic_stop:
    /// STOP F without a selected function has no consequence (reading F_BF_IF_SELECTED).
    "basic-stop-if-selected" |state, config, inputs| {
        let (mut after, mut outputs) = basic_stop::transition(state, config, inputs);
        if state.stop == basic_stop::Latched::F && after.stop == basic_stop::Latched::A && !inputs.selected
            && !inputs.fault
        {
            after.stop = basic_stop::Latched::F;
            after.timer = Cycles::new(1);
            outputs.stop = after.stop;
            outputs.pulses_off = false;
        }
        (after, outputs)
    }

    /// The general acknowledgement ends the stop.
    "basic-stop-plain-acknowledgement" |state, config, inputs| {
        let inputs = basic_stop::Inputs {
            internal_event_ack: inputs.internal_event_ack || inputs.acknowledge,
            ..*inputs
        };
        basic_stop::transition(state, config, &inputs)
    }

    /// A deselection clears the message too.
    "basic-stop-deselection-clears" |state, config, inputs| {
        let deselected = state.selected && !inputs.selected;
        let inputs = basic_stop::Inputs { acknowledge: inputs.acknowledge || deselected, ..*inputs };
        basic_stop::transition(state, config, &inputs)
    }

    /// A level that is deselected ends the stop.
    "basic-stop-static" |mut state, config, inputs| {
        state.selected = true;
        basic_stop::transition(state, config, inputs)
    }
}

variants! { sinamics::stop_arbiter:
    /// An acknowledgement ends a braking whose cause is gone.
    "stop-arbiter-interrupted" |state, config, inputs| {
        let state = match state.phase {
            stop_arbiter::Phase::Running if inputs.acknowledge && inputs.remaining == Default::default() => {
                stop_arbiter::State { fault: state.fault, fault_timer: state.fault_timer, ..stop_arbiter::State::INITIAL }
            }
            _ => state,
        };
        stop_arbiter::transition(state, config, inputs)
    }

    /// SS1 does not cover STOP B, which begins its ramp anew.
    "stop-arbiter-restarts-the-ramp" |state, config, inputs| {
        let function = if inputs.function == Function::Ss1 { Function::Ss2 } else { inputs.function };
        let inputs = stop_arbiter::Inputs { function, ..*inputs };
        stop_arbiter::transition(state, config, &inputs)
    }

    /// A request of the running class begins its time anew.
    "stop-arbiter-repeats" |state, config, inputs| {
        let (mut after, outputs) = stop_arbiter::transition(state, config, inputs);
        if inputs.request == after.stop && after.phase == stop_arbiter::Phase::Running {
            after.timer = config.time(after.stop);
        }
        (after, outputs)
    }

    /// STOP C in standstill of SOS brakes again.
    "stop-arbiter-leaves-standstill" |state, config, inputs| {
        let (mut after, outputs) = stop_arbiter::transition(state, config, inputs);
        if inputs.request == Stop::C && after.phase == stop_arbiter::Phase::Holding && after.stop == Stop::C
            && !config.t_c.is_zero()
        {
            after.phase = stop_arbiter::Phase::Running;
            after.timer = config.t_c;
        }
        (after, outputs)
    }

    /// Standstill ends STOP B also where SS1 is braked externally.
    "stop-arbiter-standstill-of-the-external" |state, config, inputs| {
        let (mut after, mut outputs) = stop_arbiter::transition(state, config, inputs);
        if after.stop == Stop::B && after.phase == stop_arbiter::Phase::Running && inputs.standstill {
            after.stop = Stop::A;
            after.phase = stop_arbiter::Phase::PulsesOff;
            after.timer = Cycles::ZERO;
            outputs = stop_arbiter::Outputs {
                stop: Stop::A,
                fault: after.fault,
                pulses_off: true,
                initiated: Stop::A,
                blocks_run: true,
                ..stop_arbiter::Outputs::default()
            };
        }
        (after, outputs)
    }

    /// A STOP C, D or E takes the place of STOP F (reading F_REPLACED).
    "stop-arbiter-replaces-the-fault" |state, config, inputs| {
        let (mut after, mut outputs) = stop_arbiter::transition(state, config, inputs);
        if after.stop.ends_in_standstill() {
            after.fault = false;
            after.fault_timer = Cycles::ZERO;
            outputs.fault = false;
        }
        (after, outputs)
    }

    /// STOP F is followed up only if the function is there when its time ends.
    "stop-arbiter-looks-once" |state, config, inputs| {
        let mut inputs = *inputs;
        if state.fault && state.fault_timer.is_zero() && inputs.function.follows_up() {
            inputs.function = Function::None;
        }
        stop_arbiter::transition(state, config, &inputs)
    }

    /// An acknowledgement clears a stop whose cause persists.
    "stop-arbiter-clears-causes" |state, config, inputs| {
        let inputs = stop_arbiter::Inputs { remaining: Stop::None, ..*inputs };
        stop_arbiter::transition(state, config, &inputs)
    }

    /// The setpoint counts again as soon as STOP C stands.
    "stop-arbiter-frees-the-setpoint" |state, config, inputs| {
        let (after, mut outputs) = stop_arbiter::transition(state, config, inputs);
        outputs.setpoint_zero &= !outputs.sos;
        (after, outputs)
    }

    /// STO ends what is latched.
    "stop-arbiter-forgets-under-sto" |state, config, inputs| {
        let acknowledge = inputs.acknowledge || inputs.function == Function::Sto;
        let inputs = stop_arbiter::Inputs { acknowledge, ..*inputs };
        stop_arbiter::transition(state, config, &inputs)
    }

    /// A safe acknowledgement clears what POWER ON alone may clear.
    "stop-arbiter-unlocks" |mut state, config, inputs| {
        if state.stop == Stop::Locked && inputs.acknowledge {
            state.stop = Stop::A;
        }
        stop_arbiter::transition(state, config, inputs)
    }
}

variants! { sinamics::acknowledgement_edge:
    /// A level that was there at the start arms.
    "acknowledgement-edge-static" |mut state, config, inputs| {
        if state.phase == acknowledgement_edge::Phase::Unknown {
            state.phase = acknowledgement_edge::Phase::Idle;
        }
        acknowledgement_edge::transition(state, config, inputs)
    }

    /// The substitute value of a failure is an edge.
    "acknowledgement-edge-substitute" |state, config, inputs| {
        let inputs = acknowledgement_edge::Inputs {
            valid: true,
            level: inputs.level && inputs.valid,
            ..*inputs
        };
        acknowledgement_edge::transition(state, config, &inputs)
    }

    /// One input that falls is an edge (reading ACK_EDGE_AND).
    "acknowledgement-edge-and" |state, config, inputs| {
        let inputs = acknowledgement_edge::Inputs {
            level: inputs.level && inputs.stable,
            stable: true,
            ..*inputs
        };
        acknowledgement_edge::transition(state, config, &inputs)
    }

    /// The rising edge acknowledges.
    "acknowledgement-edge-rising" |state, config, inputs| {
        let (after, mut outputs) = acknowledgement_edge::transition(state, config, inputs);
        outputs.acknowledge = after.phase == acknowledgement_edge::Phase::Armed
            && state.phase == acknowledgement_edge::Phase::Idle;
        (after, outputs)
    }
}

variants! { sinamics::acknowledgement:
    /// STO selected and deselected always acknowledges.
    "acknowledgement-always-extended" |state, config, inputs| {
        let inputs = acknowledgement::Inputs {
            input_edge: inputs.input_edge || inputs.reselected,
            ..*inputs
        };
        acknowledgement::transition(state, config, &inputs)
    }

    /// An acknowledgement wins over a message of the same cycle.
    "acknowledgement-wins" |state, config, inputs| {
        let (mut after, mut outputs) = acknowledgement::transition(state, config, inputs);
        after.event &= !outputs.acknowledge || inputs.cause;
        outputs.event = after.event;
        outputs.no_event = !after.event;
        (after, outputs)
    }

    /// The acknowledgement at the Control Unit alone clears faults of the module.
    "acknowledgement-plain" |mut state, config, inputs| {
        if inputs.standard && state.module == acknowledgement::Module::Faulty {
            state.module = acknowledgement::Module::Waiting;
        }
        acknowledgement::transition(state, config, inputs)
    }

    /// r9722.7 has the polarity of the telegrams.
    "acknowledgement-polarity" |state, config, inputs| {
        let (after, mut outputs) = acknowledgement::transition(state, config, inputs);
        outputs.no_event = outputs.event;
        (after, outputs)
    }
}

variants! { sinamics::cross_check:
    /// What the channels say of SLP is not compared.
    "cross-check-forgets-slp" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.other.slp = inputs.own.slp;
        cross_check::transition(state, config, &inputs)
    }

    /// The second direction of SDI is not compared.
    "cross-check-one-direction" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.other.sdi[1] = inputs.own.sdi[1];
        cross_check::transition(state, config, &inputs)
    }

    /// What the terminals may differ in is a defect.
    "cross-check-ignores-the-tolerance" |state, config, inputs| {
        let inputs = cross_check::Inputs { tolerated: false, ..*inputs };
        cross_check::transition(state, config, &inputs)
    }

    /// The time of a difference goes on where the channels were equal in between.
    "cross-check-adds-up" |state, config, inputs| {
        let (mut after, outputs) = cross_check::transition(state, config, inputs);
        if !inputs.power_on && after.since.is_zero() {
            after.since = state.since;
        }
        (after, outputs)
    }

    /// A difference is found a cycle late.
    "cross-check-late" |state, config, inputs| {
        let (after, mut outputs) = cross_check::transition(state, config, inputs);
        outputs.found &= state.since == config.apart || cross_check::alone(inputs);
        (after, outputs)
    }

    /// The value of a position that is too wide is that of the gear.
    "cross-check-wrong-value" |state, config, inputs| {
        let (after, mut outputs) = cross_check::transition(state, config, inputs);
        if outputs.value == 7_001 {
            outputs.value = 1_015;
        }
        (after, outputs)
    }
}
