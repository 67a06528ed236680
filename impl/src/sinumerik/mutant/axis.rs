//! Wrong variants of selection, referencing, user agreement and gear stage.

use crate::kernel::Cycles;
use crate::sinumerik::{agreement, gear, reference, selection};

variants! { sinumerik::selection:
    /// The delay to a lower limit or to the operating stop is one cycle short.
    "selection-delay-short" |state, config, inputs| {
        let mut state = state;
        if state.timer > Cycles::new(1) {
            state.timer = state.timer.tick();
        }
        selection::transition(state, config, inputs)
    }

    /// The forced operating stop follows the de-selection signal.
    "selection-forced-deselects" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.sbh_internal &= !inputs.sge_sbh_sg;
        selection::transition(state, config, &inputs)
    }

    /// A lower override factor takes effect at once.
    "selection-factor-at-once" |state, config, inputs| {
        let mut state = state;
        let other_factor = state.factor != inputs.choice(config).factor;
        if state.mode.watches_speed()
            && inputs.sge_sbh
            && state.stage == inputs.sg_select
            && other_factor
        {
            // As if nothing had been selected before.
            state = selection::State::INITIAL;
        }
        selection::transition(state, config, inputs)
    }

    /// The override signals make SG3 the stage SG4.
    "selection-override-in-sg3" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.sg_select == selection::Stage::Sg3 && inputs.over != selection::FactorIndex::NONE {
            inputs.sg_select = selection::Stage::Sg4;
        }
        selection::transition(state, config, &inputs)
    }

    /// The reference of the operating stop is captured anew in every cycle.
    "selection-reference-creeps" |state, config, inputs| {
        let mut state = state;
        if state.mode == selection::Mode::Sbh {
            state.reference = inputs.position;
        }
        selection::transition(state, config, inputs)
    }

    /// The forced operating stop takes its reference a cycle after the braking has ended.
    "selection-forced-late" |state, config, inputs| {
        let inputs = selection::Inputs {
            ended_at: inputs.position,
            ..*inputs
        };
        selection::transition(state, config, &inputs)
    }

    /// The window of the operating stop stays where it is when referencing sets the position anew.
    "selection-window-stays" |state, config, inputs| {
        let inputs = selection::Inputs {
            set_anew: false,
            ..*inputs
        };
        selection::transition(state, config, &inputs)
    }
}

variants! { sinumerik::reference:
    /// One agreement of the two is enough for the safe reference.
    "reference-one-agreement" |state, config, inputs| {
        let agreed = inputs.agreed_1 || inputs.agreed_2;
        let inputs = reference::Inputs {
            agreed_1: agreed,
            agreed_2: agreed,
            ..*inputs
        };
        reference::transition(state, config, &inputs)
    }

    /// "Safely referenced" outlives the agreement by a cycle.
    "reference-late-reset" |state, config, inputs| {
        let (after, mut outputs) = reference::transition(state, config, inputs);
        outputs.safely_referenced |= state.axis == reference::AxisState::SafeRef && !inputs.power_on;
        (after, outputs)
    }

    /// The agreement is told as confirmed before it has been compared with the history.
    "reference-tells-uncompared" |state, config, inputs| {
        let (after, mut outputs) = reference::transition(state, config, inputs);
        outputs.confirmed = inputs.agreed_1;
        (after, outputs)
    }
}

variants! { sinumerik::agreement:
    /// The agreement is kept when the gear stage changes.
    "agreement-kept-after-gear" |state, config, inputs| {
        agreement::transition(
            state,
            config,
            &agreement::Inputs {
                gear_changed: false,
                ..*inputs
            },
        )
    }

    /// The agreement is kept when the comparison with the history fails.
    "agreement-no-history" |state, config, inputs| {
        agreement::transition(
            state,
            config,
            &agreement::Inputs {
                compare_due: false,
                ..*inputs
            },
        )
    }

    /// The agreement is given without the key.
    "agreement-without-key" |state, config, inputs| {
        agreement::transition(
            state,
            config,
            &agreement::Inputs {
                key: inputs.key || inputs.set,
                ..*inputs
            },
        )
    }
}

variants! { sinumerik::gear:
    /// A change of the gear stage to stage 1 is overlooked.
    "gear-change-overlooked" |state, config, inputs| {
        let (after, mut outputs) = gear::transition(state, config, inputs);
        outputs.changed &= after.stage != gear::GearIndex::FIRST;
        (after, outputs)
    }
}
