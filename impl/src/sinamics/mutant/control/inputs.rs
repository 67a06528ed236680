//! Wrong monitors of inputs, outputs and their supervision.

use crate::kernel::Cycles;
use crate::sinamics::level::Stop;
use crate::sinamics::{
    basic_selection, chatter, communication, fail_safe_input, fail_safe_output, input_filter,
    restart, safe_state, terminal_pair,
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

    /// A discrepancy at the CU310-2 only freezes.
    "fail-safe-input-freezes-only" |state, config, inputs| {
        let (after, mut outputs) = fail_safe_input::transition(state, config, inputs);
        outputs.stop_f = false;
        (after, outputs)
    }

    /// One at a TM54F is a STOP F too.
    "fail-safe-input-stops-all" |state, config, inputs| {
        let (after, mut outputs) = fail_safe_input::transition(state, config, inputs);
        outputs.stop_f = outputs.fault;
        (after, outputs)
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

variants! { sinamics::basic_selection:
    /// SS1 of the terminals keeps STO of PROFIsafe waiting.
    "basic-selection-ss1-first" |state, config, inputs| {
        let (after, mut outputs) = basic_selection::transition(state, config, inputs);
        if outputs.ss1_terminals {
            outputs.sto = false;
            outputs.ss1 = true;
        }
        (after, outputs)
    }

    /// EP counts though the terminals are not enabled.
    "basic-selection-always-ep" |state, config, inputs| {
        let config = basic_selection::Config { terminals: true, ..*config };
        basic_selection::transition(state, &config, inputs)
    }
}
