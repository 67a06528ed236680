//! Wrong variants of what belongs to PROFIsafe.

use crate::sinumerik::{f_master, f_module};

variants! { sinumerik::f_master:
    /// A repeated attempt that fails begins the 50 ms anew.
    "f-master-attempt-counts-as-start" |state, config, inputs| {
        let (mut after, outputs) = f_master::transition(state, config, inputs);
        if state.waiting && after.waiting {
            after.since = crate::kernel::Cycles::ZERO;
        }
        (after, outputs)
    }

    /// Repeated attempts wait for the next PROFIsafe cycle.
    "f-master-retries-in-its-cycle" |state, config, inputs| {
        let inputs = f_master::Inputs {
            ready: inputs.ready && state.until == 0,
            ..*inputs
        };
        f_master::transition(state, config, &inputs)
    }

    /// A start after the 50 ms takes the alarm back.
    "f-master-recovers-by-itself" |state, config, inputs| {
        let (mut after, mut outputs) = f_master::transition(state, config, inputs);
        if state.lost && outputs.trigger {
            after.lost = false;
            outputs.stop = after.ended;
        }
        (after, outputs)
    }

    /// RESET acknowledges also while nothing runs.
    "f-master-reset-in-the-fault" |state, config, inputs| {
        let (mut after, mut outputs) = f_master::transition(state, config, inputs);
        if inputs.reset {
            after.lost = false;
            outputs.stop = after.ended;
        }
        (after, outputs)
    }

    /// Continuous overruns stop the axes.
    "f-master-overrun-stops" |state, config, inputs| {
        let (after, mut outputs) = f_master::transition(state, config, inputs);
        outputs.stop |= after.slow;
        (after, outputs)
    }

    /// Each overrun is reported as continuous.
    "f-master-sporadic-is-continuous" |state, config, inputs| {
        let (mut after, mut outputs) = f_master::transition(state, config, inputs);
        if after.waiting {
            after.slow = true;
            outputs.inhibit = true;
        }
        (after, outputs)
    }

    /// A changed configuration is forgotten with RESET.
    "f-master-reset-restores-configuration" |mut state, config, inputs| {
        state.ended &= !inputs.reset;
        f_master::transition(state, config, inputs)
    }

    /// After an error at run-up the communication is started all the same.
    "f-master-starts-unchecked" |state, config, inputs| {
        let (after, mut outputs) = f_master::transition(state, config, inputs);
        outputs.trigger |= after.invalid && inputs.ready;
        (after, outputs)
    }
}

variants! { sinumerik::f_module:
    /// The NCK alone decides on the outputs.
    "f-module-one-channel" |state, config, inputs| {
        let inputs = f_module::Inputs {
            outsep: inputs.outse,
            ..*inputs
        };
        f_module::transition(state, config, &inputs)
    }

    /// The data for the module are formed in each cycle.
    "f-module-data-in-each-cycle" |state, config, inputs| {
        let (mut after, outputs) = f_module::transition(state, config, inputs);
        if !inputs.power_on {
            after.net = (after.net & !1) | (inputs.outse & inputs.outsep & 1);
        }
        (after, outputs)
    }

    /// A faulty input is cleared only with the next telegram.
    "f-module-clears-with-telegram" |state, config, inputs| {
        let (mut after, mut outputs) = f_module::transition(state, config, inputs);
        if !inputs.trigger && !inputs.power_on {
            after.shown = state.shown;
            after.blocked &= !after.shown;
            outputs.inse = after.shown;
            outputs.insep = after.shown;
        }
        (after, outputs)
    }

    /// Only the NCK sees the cleared input.
    "f-module-clears-one-channel" |state, config, inputs| {
        let (after, mut outputs) = f_module::transition(state, config, inputs);
        if !inputs.power_on {
            outputs.insep |= state.shown & after.blocked;
        }
        (after, outputs)
    }

    /// An input comes back with its signal, without RESET.
    "f-module-input-comes-back" |mut state, config, inputs| {
        state.blocked = 0;
        f_module::transition(state, config, inputs)
    }

    /// A fault clears the inputs, and nothing stops.
    "f-module-channel-without-stop" |state, config, inputs| {
        let (mut after, mut outputs) = f_module::transition(state, config, inputs);
        after.a_channel = false;
        outputs.stop = after.a_failed || after.a_life;
        (after, outputs)
    }

    /// A general error stops the axes.
    "f-module-general-stops" |state, config, inputs| {
        let (after, mut outputs) = f_module::transition(state, config, inputs);
        outputs.stop |= after.a_general;
        (after, outputs)
    }
}
