//! Wrong variants of the monitor of the end zones.

use crate::srm::endzone::{self, Direction, EzDir, VinvRetract};
use crate::srm::retraction::Phase;

variants! { srm::endzone:
    /// Away from an end nothing limits: the far end is not looked at.
    "endzone-far-end" |state, config, inputs| {
        let (after, mut outputs) = endzone::transition(state, config, inputs);
        let valid = inputs.pos_valid && inputs.v_valid && !after.phase.released();
        if valid && after.direction == Direction::Falling {
            outputs.sls_threshold = config.interpolation.v_16;
        }
        (after, outputs)
    }

    /// An unknown direction is taken for the better one.
    "endzone-hopes" |state, config, inputs| {
        let (mut after, outputs) = endzone::transition(state, config, inputs);
        if after.direction == Direction::Unknown && inputs.safe_v != 0 {
            after.direction = Direction::Rising;
        }
        (after, outputs)
    }

    /// A direction never expires.
    "endzone-old-direction" |state, config, inputs| {
        let config = endzone::Config { ez_dir: EzDir::Hold, ..*config };
        endzone::transition(state, &config, inputs)
    }

    /// A suspended retraction keeps its enable.
    "endzone-suspended-enable" |state, config, inputs| {
        let config = endzone::Config { vinv_retract: VinvRetract::Hold, ..*config };
        endzone::transition(state, &config, inputs)
    }

    /// In a retraction the opposite end is not looked at.
    "endzone-retracts-blindly" |state, config, inputs| {
        let (after, mut outputs) = endzone::transition(state, config, inputs);
        if after.phase.retracts() {
            outputs.sls_threshold = config.vmax_release.max(1);
        }
        (after, outputs)
    }

    /// Limits that have crossed count as one violated end.
    "endzone-crossed-limits" |state, config, inputs| {
        let (after, mut outputs) = endzone::transition(state, config, inputs);
        if inputs.crossed() {
            outputs.move_positive_ok = true;
        }
        (after, outputs)
    }

    /// While the position is invalid nothing is supervised.
    "endzone-invalid-is-free" |state, config, inputs| {
        let (mut after, mut outputs) = endzone::transition(state, config, inputs);
        if !inputs.pos_valid {
            after.fast = state.fast;
            outputs.sls_ok = !after.fast && !after.retracts_fast;
        }
        (after, outputs)
    }

    /// An invalid position opens the threshold at once.
    "endzone-invalid-opens" |state, config, inputs| {
        let (mut after, mut outputs) = endzone::transition(state, config, inputs);
        if !inputs.pos_valid && inputs.v_valid && !after.phase.released() {
            after.threshold = config.interpolation.v_16;
            outputs.sls_threshold = config.interpolation.v_16;
        }
        (after, outputs)
    }

    /// A velocity fault of the envelope is gone with the velocity.
    "endzone-forgives" |state, config, inputs| {
        let state = endzone::State { fast: false, ..state };
        endzone::transition(state, config, inputs)
    }

    /// RELEASE inside the range is not heard.
    "endzone-no-release-inside" |state, config, inputs| {
        let (mut after, outputs) = endzone::transition(state, config, inputs);
        if after.phase == Phase::Inside {
            after.phase = Phase::Normal;
        }
        (after, outputs)
    }

    /// A distance that is no DInt is a free way.
    "endzone-hides-overflow" |state, config, inputs| {
        let (mut after, mut outputs) = endzone::transition(state, config, inputs);
        after.overflowed = false;
        outputs.diag &= !0x800;
        outputs.error = outputs.diag & 0xA1F != 0;
        (after, outputs)
    }

    /// A velocity of the retraction above the envelope is no wrong parameter.
    "endzone-any-retraction" |state, config, inputs| {
        let (after, mut outputs) = endzone::transition(state, config, inputs);
        if config.vmax_release > config.interpolation.v_16 {
            outputs.diag &= !0x10;
        }
        (after, outputs)
    }
}
