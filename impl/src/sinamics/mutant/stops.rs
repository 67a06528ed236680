//! Wrong variants of the stops.

use crate::kernel::{Cycles, Distance, Position, Speed};
use crate::sinamics::types::Stop;
use crate::sinamics::{sos, ss1, ss1_basic, ss2, sto};

variants! { sinamics::sto:
    /// Parking does not select STO.
    "sto-forgets-parking" |state, config, inputs| {
        let inputs = sto::Inputs { parking: false, ..*inputs };
        sto::transition(state, config, &inputs)
    }

    /// A request during power-up is lost.
    "sto-loses-early-request" |state, config, inputs| {
        let selected = inputs.selected && state.started;
        let inputs = sto::Inputs { selected, ..*inputs };
        sto::transition(state, config, &inputs)
    }

    /// The short-circuit of the armature outlives STO.
    "sto-keeps-armature-short" |state, config, inputs| {
        let (after, mut outputs) = sto::transition(state, config, inputs);
        outputs.armature_short = inputs.armature_short;
        (after, outputs)
    }

    /// STO shows at once that a hydraulic valve is closed.
    "sto-does-not-wait-for-valve" |state, config, inputs| {
        let (after, mut outputs) = sto::transition(state, config, inputs);
        outputs.shown = outputs.active;
        (after, outputs)
    }

    /// A selection is told as a deselection.
    "sto-acknowledges-at-selection" |state, config, inputs| {
        let (after, mut outputs) = sto::transition(state, config, inputs);
        outputs.deselected = inputs.selected && !state.selected_held;
        (after, outputs)
    }
}

variants! { sinamics::ss1_basic:
    /// A selection on the way restarts the time.
    "ss1-basic-restarts" |state, config, inputs| {
        let (mut after, outputs) = ss1_basic::transition(state, config, inputs);
        if outputs.active && inputs.selected {
            after.left = config.time;
        }
        (after, outputs)
    }

    /// A deselection cancels it.
    "ss1-basic-cancelled" |state, config, inputs| {
        let state = if inputs.selected { state } else { ss1_basic::State::INITIAL };
        ss1_basic::transition(state, config, inputs)
    }

    /// The external stop brakes along OFF3.
    "ss1-basic-brakes-external" |state, config, inputs| {
        let (after, mut outputs) = ss1_basic::transition(state, config, inputs);
        outputs.off3 = outputs.active;
        (after, outputs)
    }

    /// STO waits for the end of SS1.
    "ss1-basic-before-sto" |state, config, inputs| {
        let inputs = ss1_basic::Inputs { sto: false, ..*inputs };
        ss1_basic::transition(state, config, &inputs)
    }
}

variants! { sinamics::ss1:
    /// The shutdown speed itself ends SS1.
    "ss1-ends-at-the-shutdown-speed" |state, config, inputs| {
        let speed = Speed(inputs.speed.0.saturating_sub(1));
        let inputs = ss1::Inputs { speed, ..*inputs };
        ss1::transition(state, config, &inputs)
    }

    /// STOP B restarts the time of a running SS1.
    "ss1-stop-b-restarts" |state, config, inputs| {
        let stop_b = inputs.stop_b && !state.stop_b && state.phase == ss1::Phase::Braking;
        let (mut after, outputs) = ss1::transition(state, config, inputs);
        if stop_b && outputs.active {
            after.left = state.left;
        }
        (after, outputs)
    }

    /// The external stop ends at standstill.
    "ss1-external-sees-standstill" |state, config, inputs| {
        let (after, mut outputs) = ss1::transition(state, config, inputs);
        if outputs.active && !outputs.off3 && inputs.speed == Speed(0) {
            outputs.sto = true;
        }
        (after, outputs)
    }

    /// A violated ramp is ignored.
    "ss1-ignores-the-ramp" |state, config, inputs| {
        let inputs = ss1::Inputs { ramp_violated: false, ..*inputs };
        ss1::transition(state, config, &inputs)
    }

    /// A drive that is off is braked.
    "ss1-brakes-a-coasting-drive" |state, config, inputs| {
        let inputs = ss1::Inputs { drive_on: true, ..*inputs };
        ss1::transition(state, config, &inputs)
    }

    /// STOP B ends without STOP A.
    "ss1-stop-b-without-stop-a" |state, config, inputs| {
        let (after, mut outputs) = ss1::transition(state, config, inputs);
        outputs.stop_a = outputs.violated;
        (after, outputs)
    }

    /// A deselection cancels it.
    "ss1-cancelled" |state, config, inputs| {
        let goes_on = inputs.selected || inputs.stop_b || state.stop_b;
        let state = if goes_on { state } else { ss1::State::INITIAL };
        ss1::transition(state, config, inputs)
    }
}

variants! { sinamics::ss2:
    /// STOP C restarts the ramp of SS2.
    "ss2-stop-c-restarts" |state, config, inputs| {
        let (mut after, outputs) = ss2::transition(state, config, inputs);
        if inputs.stop == Stop::C && outputs.off3 && state.left > Cycles::new(1) {
            after.left = state.left;
        }
        (after, outputs)
    }

    /// SS2 during SS2E goes on with its time.
    "ss2-inherits-the-time" |state, config, inputs| {
        let (mut after, outputs) = ss2::transition(state, config, inputs);
        if state.phase == ss2::Phase::DelayD && outputs.off3 {
            after.left = state.left;
        }
        (after, outputs)
    }

    /// A deselected SS2E is cancelled.
    "ss2-external-cancelled" |state, config, inputs| {
        let asked = inputs.ss2e || inputs.stop != Stop::None;
        let state = if state.phase == ss2::Phase::DelayD && !asked { ss2::State::INITIAL } else { state };
        ss2::transition(state, config, inputs)
    }

    /// The operating stop after a stop ends with the selection.
    "ss2-sos-forgets-the-stop" |state, config, inputs| {
        let selected = inputs.ss2 || inputs.ss2e;
        let stop = if state.phase == ss2::Phase::Sos && !selected { Stop::None } else { inputs.stop };
        let inputs = ss2::Inputs { stop, ..*inputs };
        ss2::transition(state, config, &inputs)
    }

    /// The external stop inhibits the setpoint.
    "ss2-external-inhibits" |state, config, inputs| {
        let (after, mut outputs) = ss2::transition(state, config, inputs);
        outputs.inhibited |= outputs.ss2e_active;
        (after, outputs)
    }

    /// A violated ramp only ends SS2.
    "ss2-does-not-tell" |state, config, inputs| {
        let (after, mut outputs) = ss2::transition(state, config, inputs);
        outputs.violated = false;
        (after, outputs)
    }

    /// STOP E asks for no retraction.
    "ss2-no-retraction" |state, config, inputs| {
        let (after, mut outputs) = ss2::transition(state, config, inputs);
        outputs.esr = false;
        (after, outputs)
    }
}

variants! { sinamics::sos:
    /// The position is compared with that of the cycle before.
    "sos-follows-the-axis" |state, config, inputs| {
        let (mut after, outputs) = sos::transition(state, config, inputs);
        if outputs.active {
            after.reference = inputs.position;
        }
        (after, outputs)
    }

    /// The position is taken at the selection.
    "sos-takes-the-position-early" |state, config, inputs| {
        let (mut after, outputs) = sos::transition(state, config, inputs);
        if outputs.active && state.phase == sos::Phase::Delay {
            after.reference = Position(0);
        }
        (after, outputs)
    }

    /// The tolerance is one increment wider.
    "sos-wider" |state, config, inputs| {
        let tolerance = Distance(config.tolerance.0.saturating_add(1));
        let config = sos::Config { tolerance, ..*config };
        sos::transition(state, &config, inputs)
    }

    /// A stop that has had its time waits once more.
    "sos-delays-the-stop" |state, config, inputs| {
        let selected = inputs.selected || inputs.held;
        let inputs = sos::Inputs { selected, held: false, ..*inputs };
        sos::transition(state, config, &inputs)
    }

    /// The deselection waits for the delay.
    "sos-deselection-waits" |state, config, inputs| {
        let selected = inputs.selected || state.phase == sos::Phase::Delay;
        let inputs = sos::Inputs { selected, ..*inputs };
        sos::transition(state, config, &inputs)
    }
}
