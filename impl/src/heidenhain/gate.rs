//! What the kernel of one channel takes over from its safe PLC for one axis group: every field is checked against the codes
//! of the interface, none is trusted.
//!
//! A code that does not exist, and restricted spindle operation for a group without spindle, is answered by SS1F, and the
//! whole request neither activates nor counts as permissive. A code that does not exist counts as the strictest value there
//! is: STO, and SOM_1, in which no permissive counts for the check of an axis.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{GroupState, Kind, Som, Stop};
use crate::kernel::ConfigError;

config! {
    /// What the group consists of.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        kind: Kind,
    }
}

impl Config {
    /// `kind`: what the group consists of (MP100).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(kind: Kind) -> Result<Self, ConfigError> {
        Ok(Self { kind })
    }

    /// What the group consists of.
    pub const fn kind(&self) -> Kind {
        self.kind
    }
}

fields! {
    /// The fields of one cycle as the safe PLC has set them.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// `PP_AxGrpStateReq`: see [`GroupState::from_code`].
        pub state_code: u8,
        /// `PP_AxGrpStopReq`: see [`Stop::from_code`].
        pub stop_code: u8,
        /// `PP_GenSOM`: see [`Som::from_code`].
        pub som_code: u8,
        /// `PP_AxGrpActivate`: an event permits motion of the group.
        pub activate: bool,
        /// `PP_AxGrpPB`: a permissive button or key is pressed for the group.
        pub permissive: bool,
    }
}

fields! {
    /// What the kernel goes on with.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The requested monitoring state; the strictest where its code does not exist.
        pub request: GroupState,
        /// The requested stop; SS1F where any field is illegal.
        pub stop: Stop,
        /// The selected mode; SOM_1 where it is illegal.
        pub som: Som,
        /// The group is activated.
        pub starts: bool,
        /// A permissive is valid for the group.
        pub held: bool,
    }
}

monitor! { heidenhain::gate;
    /// A legal request is taken over as it is.
    legal_request_is_taken_over ["HFS-API-001", "HFS-API-018", "HFS-API-031"]:
        when |s| legal(&s.config, &s.inputs)
            => s.outputs.request.code() == s.inputs.state_code
                && Stop::from_code(s.inputs.stop_code) == Some(s.outputs.stop)
                && Som::from_code(s.inputs.som_code) == Some(s.outputs.som)
                && s.outputs.starts == s.inputs.activate && s.outputs.held == s.inputs.permissive;

    /// A field outside its enumeration, the missing code of SS0 among them, leads to SS1F, and nothing is activated.
    illegal_field_stops ["HFS-FAULT-001", "HFS-FAULT-006", "HFS-SS0-002"]:
        when |s| GroupState::from_code(s.inputs.state_code).is_none()
            || Stop::from_code(s.inputs.stop_code).is_none()
            || Som::from_code(s.inputs.som_code).is_none()
            => s.outputs.stop == Stop::Ss1F && !s.outputs.starts && !s.outputs.held;

    /// A state that does not exist is the strictest one.
    unknown_state_is_the_strictest ["HFS-FAULT-006", "HFS-STOP-006/a"]:
        when |s| GroupState::from_code(s.inputs.state_code).is_none()
            => s.outputs.request == GroupState::Sto;

    /// A group without spindle that asks for restricted spindle operation gets SS1F and is not activated.
    spindle_mode_needs_a_spindle ["HFS-FAULT-008/a", "HFS-P-39"]:
        when |s| s.inputs.state_code == GroupState::SlsS.code() && s.config.kind != Kind::Spindle
            => s.outputs.stop == Stop::Ss1F && !s.outputs.starts && !s.outputs.held;

    /// SLI of axes has no constant in the interface; a spindle group that asks for it, by whatever code, gets SS1F.
    increment_of_axes_is_not_for_spindles ["HFS-FAULT-008/b"]:
        when |s| s.inputs.state_code > GroupState::Sto.code() && s.config.kind == Kind::Spindle
            => s.outputs.stop == Stop::Ss1F && !s.outputs.starts && !s.outputs.held;

    /// A mode that does not exist is SOM_1.
    unknown_mode_is_som_1 ["HFS-FAULT-006"]:
        when |s| Som::from_code(s.inputs.som_code).is_none()
            => s.outputs.som == Som::Som1;
}

/// Whether every field is a code of the interface that a group of this kind may ask for.
#[cfg_attr(creusot, creusot_contracts::macros::logic)]
fn legal(config: &Config, inputs: &Inputs) -> bool {
    let state = match GroupState::from_code(inputs.state_code) {
        Some(GroupState::SlsS) => matches!(config.kind, Kind::Spindle),
        Some(_) => true,
        None => false,
    };
    state
        && Stop::from_code(inputs.stop_code).is_some()
        && Som::from_code(inputs.som_code).is_some()
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let legal = legal(config, inputs);
    let stop = match Stop::from_code(inputs.stop_code) {
        Some(stop) if legal => stop,
        _ => Stop::Ss1F,
    };
    let outputs = Outputs {
        request: GroupState::from_code(inputs.state_code).unwrap_or(GroupState::Sto),
        stop,
        som: Som::from_code(inputs.som_code).unwrap_or(Som::Som1),
        starts: inputs.activate && legal,
        held: inputs.permissive && legal,
    };
    (State, outputs)
}
