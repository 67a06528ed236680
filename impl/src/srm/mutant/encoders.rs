//! Wrong variants of the safe position.

use crate::srm::safe_pos::{self, CountWatch, Phase, SyncPos2};

variants! { srm::safe_pos:
    /// The step of POS1 is not looked for.
    "safe-pos-jumps" |state, config, inputs| {
        let state = safe_pos::State { seen1: false, ..state };
        safe_pos::transition(state, config, inputs)
    }

    /// A second fault takes the place of what was saved at the first.
    "safe-pos-saves-again" |state, config, inputs| {
        let (mut after, outputs) = safe_pos::transition(state, config, inputs);
        if state.phase.faulty() && inputs.pos1_valid {
            after.saved = after.safe_pos;
        }
        (after, outputs)
    }

    /// After a fault of POSSI the reference is taken as valid.
    "safe-pos-trusts-the-motor" |state, config, inputs| {
        let saved = inputs.pos1.saturating_add(state.off1);
        let (mut after, outputs) = safe_pos::transition(safe_pos::State { saved, ..state }, config, inputs);
        if after.phase.faulty() {
            after.saved = state.saved;
        }
        (after, outputs)
    }

    /// An encoder that returns ends the fault by itself.
    "safe-pos-returns" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if after.phase == Phase::Valid && state.phase == Phase::EncoderFault {
            after.phase = Phase::Referenced;
            after.was_ref = false;
            after.si_failed = false;
            outputs.pos_valid = true;
            outputs.referenced = true;
        }
        (after, outputs)
    }

    /// The discrepancy of two encoders can be acknowledged.
    "safe-pos-acknowledged-discrepancy" |state, config, inputs| {
        let state = if inputs.ack && !state.ack_held && state.phase == Phase::Discrepant {
            safe_pos::State { phase: Phase::Synced, apart: false, ..state }
        } else {
            state
        };
        safe_pos::transition(state, config, inputs)
    }

    /// The discrepancy counts also while an encoder is faulty.
    "safe-pos-eager-discrepancy" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if state.phase.formed() && !inputs.possi_valid && !config.pos_config {
            after.apart = true;
            outputs.diag |= 0x100;
        }
        (after, outputs)
    }

    /// SYNC moves the second encoder of a referenced axis.
    "safe-pos-sync-both" |state, config, inputs| {
        let config = safe_pos::Config { sync_pos2: SyncPos2::Align, ..*config };
        safe_pos::transition(state, &config, inputs)
    }

    /// The second encoder counts the same way.
    "safe-pos-not-opposing" |state, config, inputs| {
        let inputs = safe_pos::Inputs { pos2: inputs.pos2.saturating_neg(), ..*inputs };
        safe_pos::transition(state, config, &inputs)
    }

    /// SYNC sets the reference.
    "safe-pos-sync-references" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if after.phase == Phase::Synced && state.phase != Phase::Synced {
            after.phase = Phase::Referenced;
            after.ever = true;
            outputs.referenced = true;
        }
        (after, outputs)
    }

    /// A position out of its range costs the reference.
    "safe-pos-range-costs" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if after.above || after.below {
            outputs.referenced = false;
            after.phase = if after.phase == Phase::Referenced { Phase::Synced } else { after.phase };
        }
        (after, outputs)
    }

    /// The range is exclusive.
    "safe-pos-early" |state, config, inputs| {
        let config = safe_pos::Config { pos_max: config.pos_max.saturating_sub(1), ..*config };
        safe_pos::transition(state, &config, inputs)
    }

    /// The velocity is rounded down.
    "safe-pos-rounds-down" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if after.safe_v > 0 && after.still == 0 {
            after.safe_v -= 1;
            outputs.safe_v -= 1;
        }
        (after, outputs)
    }

    /// The counter does not wrap.
    "safe-pos-counter-ends" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        if inputs.possi_count < state.count {
            after.safe_v = state.safe_v;
            outputs.safe_v = state.safe_v;
        }
        (after, outputs)
    }

    /// A counter that stands holds the velocity for ever.
    "safe-pos-counter-stands" |state, config, inputs| {
        let config = safe_pos::Config { count_watch: CountWatch::Hold, ..*config };
        safe_pos::transition(state, &config, inputs)
    }

    /// The window of the drift never begins anew.
    "safe-pos-endless-window" |state, config, inputs| {
        let (mut after, outputs) = safe_pos::transition(state, config, inputs);
        if state.phase.formed() && after.phase.formed() {
            after.window1 = state.window1;
            after.window_si = state.window_si;
        }
        (after, outputs)
    }

    /// A drift is not found in the last call of its window.
    "safe-pos-forgetful-window" |state, config, inputs| {
        let last = state.window_calls + 1 >= config.window();
        let config = safe_pos::Config { v_disc_window: if last { i32::MAX } else { config.v_disc_window }, ..*config };
        safe_pos::transition(state, &config, inputs)
    }

    /// An offset that is no DInt becomes the substitute of the arithmetic.
    "safe-pos-substitute-offset" |state, config, inputs| {
        let (mut after, mut outputs) = safe_pos::transition(state, config, inputs);
        let command = inputs.reference && !state.reference_held;
        if command && after.overflowed && state.phase == Phase::Unsync && inputs.valid(config) {
            after.phase = Phase::Referenced;
            after.ever = true;
            outputs.diag &= !0x80;
        }
        (after, outputs)
    }

    /// A held REFERENCE references in every call.
    "safe-pos-static-reference" |state, config, inputs| {
        let state = safe_pos::State { reference_held: false, ..state };
        safe_pos::transition(state, config, inputs)
    }

    /// A wrong parameter is reported and no more.
    "safe-pos-only-reports" |state, config, inputs| {
        let (after, mut outputs) = safe_pos::transition(state, config, inputs);
        if config.parameter_bits() != 0 {
            outputs.pos_valid = after.phase.formed() && !after.above && !after.below;
        }
        (after, outputs)
    }
}
