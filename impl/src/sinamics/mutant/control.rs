//! Wrong monitors of the control part.

use crate::kernel::Cycles;
use crate::sinamics::level::{Function, Stop};
use crate::sinamics::{
    acceptance_mode, acknowledgement, acknowledgement_edge, basic_stop, chatter, commissioning,
    communication, fail_safe_input, fail_safe_output, input_filter, io_test, message_buffer,
    restart, safe_state, stop_arbiter, terminal_pair,
};

variants! { sinamics::input_filter:
    /// A level is taken over one cycle early: a pulse as long as the filter passes.
    "input-filter-short" |mut state, config, inputs| {
        if inputs.terminal != state.level && config.time > Cycles::ZERO {
            state.other = Cycles::new(state.other.count().saturating_add(1)).min(config.time);
        }
        input_filter::transition(state, config, inputs)
    }

    /// Pulses add up.
    "input-filter-adds-up" |state, config, inputs| {
        let (mut after, outputs) = input_filter::transition(state, config, inputs);
        if inputs.terminal == state.level {
            after.other = state.other;
        }
        (after, outputs)
    }
}

variants! { sinamics::terminal_pair:
    /// The other terminal selects too, so that one broken wire is not seen by its own channel alone.
    "terminal-pair-waits-for-the-other" |state, config, inputs| {
        let (after, mut outputs) = terminal_pair::transition(state, config, inputs);
        outputs.selected = outputs.both;
        (after, outputs)
    }

    /// A swap of the two levels begins the tolerance anew.
    "terminal-pair-prolongs" |state, config, inputs| {
        let (mut after, outputs) = terminal_pair::transition(state, config, inputs);
        if inputs.own && after.phase == terminal_pair::Phase::Skew {
            after.timer = config.tolerance;
        }
        (after, outputs)
    }

    /// The fault goes away when both deselect.
    "terminal-pair-forgets" |state, config, inputs| {
        let inputs = terminal_pair::Inputs { acknowledge: true, ..*inputs };
        terminal_pair::transition(state, config, &inputs)
    }

    /// Terminals that differ while the Extended Functions hold STO are a fault.
    "terminal-pair-ignores-the-hold" |state, config, inputs| {
        let inputs = terminal_pair::Inputs { held: false, ..*inputs };
        terminal_pair::transition(state, config, &inputs)
    }
}

variants! { sinamics::chatter:
    /// Each change gives the whole time again.
    "chatter-never-ends" |mut state, config, inputs| {
        if inputs.request != state.last {
            state.watch = Cycles::ZERO;
        }
        chatter::transition(state, config, inputs)
    }

    /// A static input is a fault (reading CHATTER_LITERAL).
    "chatter-literal" |state, config, inputs| {
        let (mut after, mut outputs) = chatter::transition(state, config, inputs);
        outputs.fault |= inputs.request == state.last && state.watch == Cycles::new(1) && !inputs.power_on;
        after.fault = outputs.fault;
        (after, outputs)
    }
}

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

variants! { sinamics::fail_safe_input:
    /// The value is the OR of both inputs.
    "fail-safe-input-or" |state, config, inputs| {
        let (after, mut outputs) = fail_safe_input::transition(state, config, inputs);
        outputs.value |= after.phase == fail_safe_input::Phase::Skew;
        (after, outputs)
    }

    /// Inputs that agree again release what was latched.
    "fail-safe-input-releases" |state, config, inputs| {
        let agree = inputs.input1 == (inputs.input2 != config.normally_open);
        let inputs = fail_safe_input::Inputs { acknowledge: inputs.acknowledge || agree, ..*inputs };
        fail_safe_input::transition(state, config, &inputs)
    }

    /// Input 2 is always taken for NC.
    "fail-safe-input-closed" |state, config, inputs| {
        let inputs = fail_safe_input::Inputs {
            input2: inputs.input2 != config.normally_open,
            ..*inputs
        };
        fail_safe_input::transition(state, config, &inputs)
    }

    /// During the test the supply that was taken away is seen.
    "fail-safe-input-not-frozen" |state, config, inputs| {
        let inputs = fail_safe_input::Inputs { frozen: false, ..*inputs };
        fail_safe_input::transition(state, config, &inputs)
    }

    /// A difference at POWER ON is never latched.
    "fail-safe-input-patient-start" |mut state, config, inputs| {
        if state.phase == fail_safe_input::Phase::Start {
            state.timer = Cycles::ZERO;
        }
        fail_safe_input::transition(state, config, inputs)
    }
}

variants! { sinamics::fail_safe_output:
    /// An output without a source is on.
    "fail-safe-output-empty" |state, config, inputs| {
        let (after, mut outputs) = fail_safe_output::transition(state, config, inputs);
        let empty = !config.connected.contains(&true) && !inputs.testing;
        outputs.plus |= empty;
        outputs.minus |= empty;
        (after, outputs)
    }

    /// Outputs that are not registered keep their values in the test.
    "fail-safe-output-not-off" |state, config, inputs| {
        let inputs = fail_safe_output::Inputs { testing: inputs.testing && config.tested, ..*inputs };
        fail_safe_output::transition(state, config, &inputs)
    }

    /// The sixth source does not count.
    "fail-safe-output-of-five" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.sources[5] = true;
        fail_safe_output::transition(state, config, &inputs)
    }
}

variants! { sinamics::safe_state:
    /// First OR over the functions of each drive, then AND over the drives.
    "safe-state-order" |state, config, inputs| {
        let (after, mut outputs) = safe_state::transition(state, config, inputs);
        let mut drives = inputs.active.iter().take(usize::from(config.drives));
        outputs.safe = drives.all(|active| active & config.functions != 0);
        (after, outputs)
    }

    /// The last drive does not count.
    "safe-state-forgets-a-drive" |state, config, inputs| {
        let mut inputs = *inputs;
        if config.drives > 1 {
            inputs.active[usize::from(config.drives) - 1] = u8::MAX;
        }
        safe_state::transition(state, config, &inputs)
    }
}

variants! { sinamics::stop_arbiter:
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
            after.timer = Cycles::new(1);
            outputs.off3 = false;
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
        after.event &= !(outputs.acknowledge && !inputs.cause);
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

variants! { sinamics::restart:
    /// A drive that is on when STO ends runs again.
    "restart-by-itself" |state, config, inputs| {
        let (mut after, mut outputs) = restart::transition(state, config, inputs);
        if after.phase == restart::Phase::Inhibit && inputs.on && inputs.enabled {
            after.phase = restart::Phase::Run;
            outputs.torque = true;
        }
        (after, outputs)
    }

    /// A latched stop does not keep the drive from starting (reading PEND_RESUMES).
    "restart-ignores-the-latch" |state, config, inputs| {
        let inputs = restart::Inputs { latched: false, ..*inputs };
        restart::transition(state, config, &inputs)
    }

    /// An ON that was there before the drive was ready starts it.
    "restart-by-level" |mut state, config, inputs| {
        state.last &= state.phase != restart::Phase::Ready;
        restart::transition(state, config, inputs)
    }
}

variants! { sinamics::communication:
    /// Renewed communication ends the failure (reading COMM_AUTO).
    "communication-recovers" |state, config, inputs| {
        let inputs = communication::Inputs { acknowledge: true, ..*inputs };
        communication::transition(state, config, &inputs)
    }

    /// ESR runs whatever stops are set.
    "communication-always-delays" |state, config, inputs| {
        let inputs = communication::Inputs { undelayed: false, ..*inputs };
        communication::transition(state, config, &inputs)
    }

    /// p9612 counts for a TM54F too.
    "communication-stop-b-of-tm54f" |state, config, inputs| {
        let (after, mut outputs) = communication::transition(state, config, inputs);
        if outputs.request != Stop::None && config.stop_b && config.esr.is_zero() {
            outputs.request = Stop::B;
        }
        (after, outputs)
    }

    /// The last values are kept while there is no telegram.
    "communication-keeps-values" |state, config, inputs| {
        let (after, mut outputs) = communication::transition(state, config, inputs);
        outputs.valid |= after.phase == communication::Phase::Failed;
        (after, outputs)
    }

    /// The watchdog comes one cycle late.
    "communication-late" |mut state, config, inputs| {
        if state.phase == communication::Phase::Running && state.watch == Cycles::new(1) {
            state.watch = Cycles::new(2);
        }
        communication::transition(state, config, inputs)
    }
}

variants! { sinamics::io_test:
    /// The test is over when its start signal falls.
    "io-test-breaks-off" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if outputs.running && !inputs.start {
            after.step = io_test::Step::Idle;
            after.timer = Cycles::ZERO;
            outputs.running = false;
        }
        (after, outputs)
    }

    /// A failed test begins the interval.
    "io-test-failed-is-done" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if after.failed {
            after.interval = config.interval;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// Each start begins the interval (reading TTIMER_ON_START).
    "io-test-timer-on-start" |state, config, inputs| {
        let (mut after, mut outputs) = io_test::transition(state, config, inputs);
        if outputs.running && state.step == io_test::Step::Idle {
            after.interval = config.interval;
            outputs.due = false;
        }
        (after, outputs)
    }

    /// What is read back is not looked at in the third step.
    "io-test-skips-a-level" |state, config, inputs| {
        let inputs = io_test::Inputs {
            read_back: if state.step == io_test::Step::Output3 {
                state.step.expected(config.mode)
            } else {
                inputs.read_back
            },
            ..*inputs
        };
        io_test::transition(state, config, &inputs)
    }

    /// Both supplies are off in the second step (reading T2_OFF_OFF).
    "io-test-both-off" |state, config, inputs| {
        let (after, mut outputs) = io_test::transition(state, config, inputs);
        outputs.l1 &= after.step != io_test::Step::SecondInputs || after.failed;
        (after, outputs)
    }
}

variants! { sinamics::message_buffer:
    /// The ninth message is lost.
    "message-buffer-full" |state, config, inputs| {
        let inputs = message_buffer::Inputs {
            message: if state.current.len() == message_buffer::MESSAGES { 0 } else { inputs.message },
            ..*inputs
        };
        message_buffer::transition(state, config, &inputs)
    }

    /// An acknowledgement moves the whole case.
    "message-buffer-moves-all" |state, config, inputs| {
        let inputs = message_buffer::Inputs {
            rectified: if inputs.rectified == 0 { 0 } else { u8::MAX },
            ..*inputs
        };
        message_buffer::transition(state, config, &inputs)
    }

    /// The new case takes the place of case 1.
    "message-buffer-overwrites" |state, config, inputs| {
        let (mut after, outputs) = message_buffer::transition(state, config, inputs);
        if after.acknowledged != state.acknowledged && inputs.acknowledge {
            after.acknowledged[1] = message_buffer::Case::EMPTY;
        }
        (after, outputs)
    }

    /// A message that is written over the eighth is no change.
    "message-buffer-counts-places" |state, config, inputs| {
        let (mut after, mut outputs) = message_buffer::transition(state, config, inputs);
        if after.current.len() == state.current.len() && after.acknowledged == state.acknowledged {
            after.changes = state.changes;
            outputs.changed = false;
        }
        (after, outputs)
    }
}

variants! { sinamics::acceptance_mode:
    /// The time begins anew with each acknowledgement.
    "acceptance-mode-prolonged" |state, config, inputs| {
        let (mut after, outputs) = acceptance_mode::transition(state, config, inputs);
        if outputs.new_reference {
            after.left = config.duration;
        }
        (after, outputs)
    }

    /// SOS is taught anew outside the mode too.
    "acceptance-mode-always-teaches" |state, config, inputs| {
        let (after, mut outputs) = acceptance_mode::transition(state, config, inputs);
        outputs.new_reference = inputs.sos_acknowledged;
        (after, outputs)
    }

    /// The mode begins again by itself while p9570 stays set.
    "acceptance-mode-endless" |mut state, config, inputs| {
        state.requested &= state.left > Cycles::new(0);
        acceptance_mode::transition(state, config, inputs)
    }
}

variants! { sinamics::commissioning:
    /// The mode is left whatever the checksum of the Motor Module is.
    "commissioning-one-checksum" |state, config, inputs| {
        let inputs = commissioning::Inputs { checksum_motor_module: true, ..*inputs };
        commissioning::transition(state, config, &inputs)
    }

    /// Operation goes on without POWER ON.
    "commissioning-without-power-on" |state, config, inputs| {
        let (mut after, mut outputs) = commissioning::transition(state, config, inputs);
        if after.phase == commissioning::Phase::WaitPowerOn {
            after.phase = commissioning::Phase::Operate;
            outputs.power_on_required = false;
            outputs.pulses_off = false;
        }
        (after, outputs)
    }

    /// Parameters are taken in operation.
    "commissioning-open" |state, config, inputs| {
        let (after, mut outputs) = commissioning::transition(state, config, inputs);
        outputs.accepted = inputs.write;
        (after, outputs)
    }

    /// Parameters that were not copied may be left.
    "commissioning-uncopied" |state, config, inputs| {
        let inputs = commissioning::Inputs { copy: inputs.copy || inputs.leave, ..*inputs };
        let (mut after, outputs) = commissioning::transition(state, config, &inputs);
        after.copied &= state.copied && !inputs.write;
        (after, outputs)
    }
}
