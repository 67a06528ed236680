//! Wrong variants of the external stops, of STOP F, of the arbitration and of the effect on other axes.

use crate::kernel::Cycles;

use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::selection::Monitored;
use crate::sinumerik::{bus_failure, external, fault, group, stop};

variants! { sinumerik::stop:
    /// STOP B never becomes STOP A by its timer, only by standstill.
    "stop-b-no-timer-exit" |state, config, inputs| {
        let mut state = state;
        if state.phase == stop::Phase::BBraking && state.timer == Cycles::new(1) {
            state.timer = Cycles::new(2);
        }
        stop::transition(state, config, inputs)
    }

    /// STOP B on an axis that stands waits a cycle before it becomes STOP A.
    "stop-b-on-standing-axis" |state, config, inputs| {
        let braked = state.phase == stop::Phase::BBraking && !inputs.power_on;
        let inputs = stop::Inputs {
            standstill: inputs.standstill && braked,
            ..*inputs
        };
        stop::transition(state, config, &inputs)
    }

    /// `$VA_STOPSI` shows neither STOP F nor the test of the external shutdown.
    "stop-without-f-and-test" |state, config, inputs| {
        let inputs = stop::Inputs {
            fault: false,
            external_test: false,
            ..*inputs
        };
        stop::transition(state, config, &inputs)
    }

    /// A lower stop displaces a higher latched one.
    "stop-lower-displaces" |state, config, inputs| {
        let mut state = state;
        if inputs.demand != InternalStop::None && inputs.demand < state.internal {
            state = stop::State::INITIAL;
        }
        stop::transition(state, config, inputs)
    }

    /// RESET acknowledges a STOP C, D or E already while it brakes.
    "stop-reset-while-braking" |state, config, inputs| {
        let mut state = state;
        if inputs.reset && state.phase == stop::Phase::Braking {
            state = stop::State::INITIAL;
        }
        stop::transition(state, config, inputs)
    }

    /// A rise to a higher stop in the operating stop starts a new braking phase.
    "stop-releases-standstill" |state, config, inputs| {
        let mut state = state;
        if state.phase == stop::Phase::SbhInt && !inputs.reset && inputs.demand.level() > state.level {
            state = stop::State {
                internal: state.internal,
                ..stop::State::INITIAL
            };
        }
        stop::transition(state, config, inputs)
    }
}

variants! { sinumerik::external:
    /// The signals count before the comparison of the safe logic has been started.
    "external-before-start" |state, config, inputs| {
        let (after, mut outputs) = external::transition(state, config, inputs);
        if !after.started && !after.spl_latched {
            outputs.request = outputs.selected;
        }
        (after, outputs)
    }

    /// STOP D comes before STOP C.
    "external-wrong-priority" |state, config, inputs| {
        let (after, mut outputs) = external::transition(state, config, inputs);
        if outputs.request == ExternalStop::C && !inputs.sge_d {
            outputs.request = ExternalStop::D;
        }
        (after, outputs)
    }
}

variants! { sinumerik::fault:
    /// RESET aborts the delay from STOP F to STOP B.
    "fault-delay-aborted" |state, config, inputs| {
        let mut state = state;
        if inputs.reset && state.fault == fault::FaultState::Delay {
            state = fault::State::INITIAL;
        }
        fault::transition(state, config, inputs)
    }

    /// A STOP C, D or E keeps STOP B from following also when it comes during the delay.
    "fault-delay-held-by-stop" |state, config, inputs| {
        let mut state = state;
        if inputs.cde_before && state.fault == fault::FaultState::Delay {
            state = fault::State {
                fault: fault::FaultState::Latched,
                timer: Cycles::ZERO,
            };
        }
        fault::transition(state, config, inputs)
    }
}

variants! { sinumerik::group:
    /// With setting 1 an external stop acts on the interpolating axes like an internal one.
    "group-external-reaches" |state, config, inputs| {
        let mut inputs = *inputs;
        if let Some(level) = InternalStop::from_level(inputs.level) {
            inputs.internal = level;
        }
        group::transition(state, config, &inputs)
    }
}

variants! { sinumerik::bus_failure:
    /// Only what was active when the bus failed counts: the operating stop selected during the delay does not.
    "bus-failure-selection-comes-too-late" |state, config, inputs| {
        let mut inputs = *inputs;
        if state.phase == bus_failure::Phase::Waits && !inputs.power_on && !inputs.sge_sbh {
            inputs.sge_sbh_sg = true;
        }
        bus_failure::transition(state, config, &inputs)
    }

    /// An operating stop that is active without being selected waits.
    "bus-failure-forced-standstill-waits" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.monitored == Monitored::Standstill {
            inputs.monitored = Monitored::Nothing;
        }
        bus_failure::transition(state, config, &inputs)
    }

    /// A bus that comes back ends the delay.
    "bus-failure-forgiven" |state, config, inputs| {
        let state = if !inputs.failed && state.phase == bus_failure::Phase::Waits {
            bus_failure::State::INITIAL
        } else {
            state
        };
        bus_failure::transition(state, config, inputs)
    }

    /// The signals are taken away when the bus fails, not when the pulses go off.
    "bus-failure-signals-cleared-early" |state, config, inputs| {
        let (after, mut outputs) = bus_failure::transition(state, config, inputs);
        if outputs.signals == bus_failure::Signals::Held {
            outputs.signals = bus_failure::Signals::Cleared;
        }
        (after, outputs)
    }
}
