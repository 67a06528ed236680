//! What the two channels were asked for, joined: the stricter of both is in force while they differ.
//!
//! The safe PLC programs of the channels run in different cycles, so their fields change at different times; only a
//! difference that lasts longer than the window is a fault (see `agreement`).
//!
//! Recommended reading of the manual implemented here: AMB-49 CMP_WINDOW.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{GroupState, Stop};
use crate::kernel::ConfigError;

config! {
    /// Nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

impl Config {
    /// The only configuration.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new() -> Result<Self, ConfigError> {
        Ok(Self)
    }
}

fields! {
    /// The checked fields of both channels (see [`crate::heidenhain::gate`]).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Requested state of channel A.
        pub request_mc: GroupState,
        /// Requested state of channel B.
        pub request_cc: GroupState,
        /// Requested stop of channel A.
        pub stop_mc: Stop,
        /// Requested stop of channel B.
        pub stop_cc: Stop,
        /// Channel A activates the group.
        pub starts_mc: bool,
        /// Channel B activates the group.
        pub starts_cc: bool,
        /// Channel A has a valid permissive.
        pub held_mc: bool,
        /// Channel B has a valid permissive.
        pub held_cc: bool,
        /// They have differed for longer than the window.
        pub late: bool,
    }
}

fields! {
    /// What is in force.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The requested state.
        pub request: GroupState,
        /// The group is activated.
        pub starts: bool,
        /// A permissive is valid.
        pub held: bool,
        /// The requested stop; at least SS1 where the channels differ for too long.
        pub stop: Stop,
        /// The channels differ.
        pub differ: bool,
    }
}

monitor! { heidenhain::both_channels;
    /// The request in force is one of the two, and neither is stricter.
    stricter_request_counts ["HFS-KDV-005", "HFS-STOP-006/a", "HFS-API-001"]:
        when |s| s.inputs.request_mc != s.inputs.request_cc
            => s.outputs.request.strictness() >= s.inputs.request_mc.strictness()
                && s.outputs.request.strictness() >= s.inputs.request_cc.strictness()
                && (s.outputs.request == s.inputs.request_mc || s.outputs.request == s.inputs.request_cc);

    /// The higher stop counts, and a difference that lasts too long is an SS1.
    higher_stop_counts ["HFS-KDV-001", "HFS-KDV-005", "HFS-P-31"]:
        when |s| s.inputs.stop_mc != Stop::None || s.inputs.stop_cc != Stop::None || s.inputs.late
            => s.outputs.stop == s.inputs.stop_mc.max(s.inputs.stop_cc)
                .max(if s.inputs.late { Stop::Ss1 } else { Stop::None });

    /// What permits motion needs both channels.
    permission_needs_both ["HFS-KDV-005"]:
        when |s| s.outputs.starts || s.outputs.held
            => (!s.outputs.starts || (s.inputs.starts_mc && s.inputs.starts_cc))
                && (!s.outputs.held || (s.inputs.held_mc && s.inputs.held_cc));

    /// Without a difference everything is taken over.
    equal_requests_are_taken_over ["HFS-KDV-001", "HFS-KDV-002/a"]:
        when |s| !s.outputs.differ
            => s.inputs.request_mc == s.inputs.request_cc && s.outputs.request == s.inputs.request_mc
                && s.inputs.stop_mc == s.inputs.stop_cc
                && s.outputs.starts == s.inputs.starts_mc && s.inputs.starts_mc == s.inputs.starts_cc
                && s.outputs.held == s.inputs.held_mc && s.inputs.held_mc == s.inputs.held_cc;

    /// Any field that differs is a difference.
    every_field_is_compared ["HFS-ARCH-004/h", "HFS-KDV-001", "HFS-KDV-002/a"]:
        when |s| s.inputs.request_mc != s.inputs.request_cc || s.inputs.stop_mc != s.inputs.stop_cc
            || s.inputs.starts_mc != s.inputs.starts_cc || s.inputs.held_mc != s.inputs.held_cc
            => s.outputs.differ;
}

pub(crate) const fn transition(_: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let differ = inputs.request_mc.code() != inputs.request_cc.code()
        || inputs.stop_mc as u8 != inputs.stop_cc as u8
        || inputs.starts_mc != inputs.starts_cc
        || inputs.held_mc != inputs.held_cc;
    let late = if inputs.late { Stop::Ss1 } else { Stop::None };
    let outputs = Outputs {
        request: inputs.request_mc.stricter(inputs.request_cc),
        starts: inputs.starts_mc && inputs.starts_cc,
        held: inputs.held_mc && inputs.held_cc,
        stop: inputs.stop_mc.max(inputs.stop_cc).max(late),
        differ,
    };
    (State, outputs)
}
