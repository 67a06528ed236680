//! Wrong monitors of the safe logic: comparison, communication, start.

use crate::sinumerik::spl_comparison::{self, Number};
use crate::sinumerik::spl_signal::{self, Phase};
use crate::sinumerik::{
    spl_access, spl_file, spl_link, spl_output_test, spl_protection, spl_signal as signal,
    spl_start, spl_stop_test,
};

variants! { sinumerik::spl_protection:
    /// A setting acts as soon as it is changed.
    "spl-protection-at-once" |mut state, config, inputs| {
        state.protected = inputs.lock;
        state.shown &= !inputs.lock;
        spl_protection::transition(state, config, inputs)
    }

    /// Alarm 27095 is raised again after each start of the comparison.
    "spl-protection-alarm-again" |mut state, config, inputs| {
        state.shown &= inputs.running;
        spl_protection::transition(state, config, inputs)
    }
}

variants! { sinumerik::spl_signal:
    /// A difference is an error in the cycle in which its time is just over.
    "spl-signal-not-strictly" |state, config, inputs| {
        let mut state = state;
        if state.phase == Phase::Differs {
            state.left = state.left.tick();
        }
        signal::transition(state, config, inputs)
    }

    /// CMDSI counts as it was when the difference appeared: the time that it gave is not taken back.
    "spl-signal-keeps-cmdsi" |state, config, inputs| {
        let over = state.left.count() < config.extended().count() - config.plain().count();
        let inputs = spl_signal::Inputs { cmd: inputs.cmd || (over && state.phase == Phase::Differs), ..*inputs };
        signal::transition(state, config, &inputs)
    }

    /// RESET gives a running difference its whole time again.
    "spl-signal-reset-prolongs" |mut state, config, inputs| {
        if inputs.reset && state.phase == Phase::Differs {
            state.left = config.extended();
        }
        signal::transition(state, config, inputs)
    }

    /// An error goes away when the signals are equal again.
    "spl-signal-forgets-error" |mut state, config, inputs| {
        if inputs.own == inputs.other {
            state = spl_signal::State::INITIAL;
        }
        signal::transition(state, config, inputs)
    }

    /// Differences add up.
    "spl-signal-adds-up" |state, config, inputs| {
        let (mut after, outputs) = signal::transition(state, config, inputs);
        if state.phase == Phase::Differs && after.phase == Phase::Equal && inputs.running && !inputs.power_on {
            after = spl_signal::State { phase: Phase::Differs, left: state.left };
        }
        (after, outputs)
    }
}

variants! { sinumerik::spl_comparison:
    /// The last error is shown.
    "spl-comparison-last-error" |mut state, config, inputs| {
        if inputs.found.is_some() {
            state.number = Number::NONE;
        }
        spl_comparison::transition(state, config, inputs)
    }

    /// The stop follows the other channel's protection.
    "spl-comparison-other-protection" |state, config, inputs| {
        let inputs = spl_comparison::Inputs {
            protected: inputs.protected_other,
            protected_other: inputs.protected,
            ..*inputs
        };
        spl_comparison::transition(state, config, &inputs)
    }

    /// RESET acknowledges an error that comes in the same cycle.
    "spl-comparison-reset-wins" |state, config, inputs| {
        let (mut after, mut outputs) = spl_comparison::transition(state, config, inputs);
        if inputs.reset {
            after = spl_comparison::State::INITIAL;
            outputs.request = crate::sinumerik::level::ExternalStop::None;
        }
        (after, outputs)
    }

    /// Different protection is shown, but is no error.
    "spl-comparison-mismatch-only-shown" |state, config, inputs| {
        let equal = spl_comparison::Inputs { protected_other: inputs.protected, ..*inputs };
        let (after, outputs) = spl_comparison::transition(state, config, &equal);
        let shown = spl_comparison::transition(state, config, inputs).1;
        (after, spl_comparison::Outputs { bit_28: shown.bit_28, ..outputs })
    }
}

variants! { sinumerik::spl_link:
    /// A silence of just as long as it may last is one too many.
    "spl-link-not-strictly" |mut state, config, inputs| {
        if state.link == spl_link::Link::Heard && state.time.count() + 1 == config.patience().count() {
            state.time = config.patience();
        }
        spl_link::transition(state, config, inputs)
    }

    /// Communication that comes back ends the grace.
    "spl-link-revocable" |mut state, config, inputs| {
        if inputs.exchange && state.link == spl_link::Link::Lost {
            state = spl_link::State::INITIAL;
        }
        spl_link::transition(state, config, inputs)
    }

    /// The NCK does not listen to the alarm of the PLC.
    "spl-link-deaf" |state, config, inputs| {
        let inputs = spl_link::Inputs { told: false, ..*inputs };
        spl_link::transition(state, config, &inputs)
    }

    /// The second half of the outputs is not cleared.
    "spl-link-half" |state, config, inputs| {
        let (after, mut outputs) = spl_link::transition(state, config, inputs);
        outputs.outsed[1] = inputs.outsed[1];
        (after, outputs)
    }
}

variants! { sinumerik::spl_start:
    /// The start via PROG_EVENT releases the PLC-SPL.
    "spl-start-event-releases" |state, config, inputs| {
        let (mut after, mut outputs) = spl_start::transition(state, config, inputs);
        if after.by_event && after.stage == spl_start::Stage::Executing && !after.failed {
            after.stage = spl_start::Stage::Released;
            outputs.plc_spl = true;
        }
        (after, outputs)
    }

    /// The end of the program is not waited for: the report of FC9 is enough.
    "spl-start-without-end" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.call == spl_start::Call::Started && inputs.program == spl_start::Program::Runs {
            inputs.program = spl_start::Program::Ends;
        }
        spl_start::transition(state, config, &inputs)
    }

    /// The comparison counts as started with the assignment of the interrupt.
    "spl-start-compares-early" |state, config, inputs| {
        let (mut after, outputs) = spl_start::transition(state, config, inputs);
        after.compared |= after.stage == spl_start::Stage::Ready;
        (after, outputs)
    }

    /// Only the protection of the NCK keeps a logic without axes from its start.
    "spl-start-plc-protection-overlooked" |state, config, inputs| {
        let inputs = spl_start::Inputs { protected_p: inputs.protected_n, ..*inputs };
        spl_start::transition(state, config, &inputs)
    }

    /// A start that has failed goes on by itself.
    "spl-start-forgets-failure" |mut state, config, inputs| {
        state.failed = false;
        spl_start::transition(state, config, inputs)
    }
}

variants! { sinumerik::spl_file:
    /// A change of the content that keeps the length is not seen.
    "spl-file-length-only" |state, config, inputs| {
        let sum = if inputs.power_on { inputs.sum } else { state.sum };
        let inputs = spl_file::Inputs { sum, ..*inputs };
        spl_file::transition(state, config, &inputs)
    }

    /// The reference is formed anew by each check.
    "spl-file-reference-follows" |state, config, inputs| {
        let (mut after, outputs) = spl_file::transition(state, config, inputs);
        if inputs.check {
            after.sum = inputs.sum;
        }
        (after, outputs)
    }

    /// A file without a checksum in it counts as the one of the last run-up.
    "spl-file-without-mark" |state, config, inputs| {
        let inputs = spl_file::Inputs { mark: inputs.mark.or(Some(inputs.sum)), ..*inputs };
        spl_file::transition(state, config, &inputs)
    }
}

variants! { sinumerik::spl_access:
    /// The last protected action is not protected.
    "spl-access-last-action" |state, config, inputs| {
        let (state, mut outputs) = spl_access::transition(state, config, inputs);
        let next = spl_access::Inputs { action: inputs.action.saturating_add(1), ..*inputs };
        if inputs.data == spl_access::Object::Action {
            outputs.allowed |= spl_access::transition(state, config, &next).1.allowed;
        }
        (state, outputs)
    }

    /// SAFE.SPF may read the images of the PLC for ever.
    "spl-access-images-for-the-program" |state, config, inputs| {
        let protected = inputs.protected && !(inputs.by_spl && inputs.data == spl_access::Object::Image);
        spl_access::transition(state, config, &spl_access::Inputs { protected, ..*inputs })
    }
}

variants! { sinumerik::spl_output_test:
    /// The answer counts in the cycle in which the test begins, when it cannot have followed.
    "spl-output-test-at-once" |state, config, inputs| {
        let (after, outputs) = spl_output_test::transition(state, config, inputs);
        if after.check == spl_output_test::Use::Tested && state.check == spl_output_test::Use::Free && inputs.answer {
            return (spl_output_test::State::INITIAL, spl_output_test::Outputs { driven: inputs.wanted, passed: true, ..outputs });
        }
        (after, outputs)
    }

    /// The acknowledgement alone unlocks.
    "spl-output-test-unlocked-by-button" |mut state, config, inputs| {
        if inputs.ack && state.check == spl_output_test::Use::Locked {
            state = spl_output_test::State::INITIAL;
        }
        spl_output_test::transition(state, config, inputs)
    }

    /// A test input that stays at 1 is not noticed.
    "spl-output-test-trusts-its-input" |mut state, config, inputs| {
        if state.check == spl_output_test::Use::Free {
            state = spl_output_test::State::INITIAL;
        }
        spl_output_test::transition(state, config, inputs)
    }
}

variants! { sinumerik::spl_stop_test:
    /// An answer that was there before the step counts.
    "spl-stop-test-level" |mut state, config, inputs| {
        state.low |= state.item != spl_stop_test::Item::None;
        spl_stop_test::transition(state, config, inputs)
    }

    /// The drive is not tested for the external stops.
    "spl-stop-test-one-channel" |mut state, config, inputs| {
        state.drive |= state.item > spl_stop_test::Item::Path;
        spl_stop_test::transition(state, config, inputs)
    }
}
