//! Wrong variants of the external stops, of STOP F, of the arbitration and of the effect on other axes.

use crate::kernel::Cycles;

use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::{external, fault, group, stop};

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
