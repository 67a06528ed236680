//! Wrong variants of the check of the safe PLC program.

use crate::heidenhain::program_check;

variants! {
    program_check_any_version: program_check |state, config, inputs| {
        let (mut after, mut outputs) = program_check::transition(state, config, inputs);
        if config.is_commissioning() && inputs.translated {
            after.good = true;
            outputs.good = true;
        }
        (after, outputs)
    }

    program_check_reports_only: program_check |state, config, inputs| {
        let (mut after, mut outputs) = program_check::transition(state, config, inputs);
        after.good = inputs.version_equal && (inputs.translated || state.good);
        outputs.good = after.good;
        (after, outputs)
    }
}
