//! Wrong couplings of the two channels: what one tells, and what the other one makes of it.

use crate::sinumerik::axis::{Exchange, TestResult};
use crate::sinumerik::fault::FaultState;
use crate::sinumerik::level::{ExternalStop, Level};
use crate::sinumerik::pair::{Config, Inputs, Outputs, State, next};

/// A cycle after which something else has been told.
fn told(
    state: State,
    config: &Config,
    inputs: &Inputs,
    alter: impl Fn(&mut State),
) -> (State, Outputs) {
    let (mut after, outputs) = next(state, config, inputs);
    alter(&mut after);
    (after, outputs)
}

variants! { sinumerik::pair:
    /// The drive is told a latched stop of the NCK a cycle late.
    "pair-stop-late" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.internal = state.nck.channel.stop.internal;
        })
    }

    /// The NCK is told an external stop of the drive a cycle late.
    "pair-request-late" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_drive.external = state.drive.channel.stop.external;
        })
    }

    /// A channel passes on an external stop that it was told itself.
    "pair-request-passed-back" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.external = after.from_nck.external.max(state.from_drive.external);
            after.from_drive.external = after.from_drive.external.max(state.from_nck.external);
        })
    }

    /// The drive reads its own external stop instead of that of the NCK.
    "pair-own-request-read" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.external = after.from_drive.external;
        })
    }

    /// The test stop of the NCK is passed on as an external stop.
    "pair-test-passed-on" |state, config, inputs| {
        told(state, config, inputs, |after| {
            if after.nck.channel.stop.level == Level::Test {
                after.from_nck.external = ExternalStop::A;
            }
        })
    }

    /// The NCK is not told a STOP F of the drive.
    "pair-fault-not-told" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_drive.fault = false
        })
    }

    /// The drive is told a STOP F of the NCK a cycle late.
    "pair-fault-late" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.fault = state.nck.channel.fault.fault != FaultState::None;
        })
    }

    /// The NCK takes RESET while the drive brakes.
    "pair-reset-while-other-brakes" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_drive.braking = false
        })
    }

    /// The NCK is told the agreement of the drive a cycle late.
    "pair-agreement-stale" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_drive.agreed = state.drive.agreement.agreed;
        })
    }

    /// The drive reads its own agreement instead of that of the NCK.
    "pair-own-agreement-read" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.agreed = after.from_drive.agreed;
        })
    }

    /// The drive does not compare its position with the history.
    "pair-history-not-compared-in-drive" |mut state, config, inputs| {
        state.drive.reference.fresh = false;
        next(state, config, inputs)
    }

    /// The drive is not told that signals of the NCK change.
    "pair-change-not-told" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.changing = false;
        })
    }

    /// The drive compares result lists that are a cycle apart.
    "pair-lists-apart" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_nck.snapshot.results_1 = state.nck.told.results_1;
        })
    }

    /// The NCK does not hear of a test of the drive.
    "pair-test-result-lost" |state, config, inputs| {
        told(state, config, inputs, |after| {
            after.from_drive.test = TestResult::None;
        })
    }

    /// The NCK is told nothing but what is compared.
    "pair-nothing-told" |state, config, inputs| {
        told(state, config, inputs, |after| {
            let snapshot = after.from_drive.snapshot;
            after.from_drive = Exchange {
                snapshot,
                ..Exchange::default()
            };
        })
    }
}
