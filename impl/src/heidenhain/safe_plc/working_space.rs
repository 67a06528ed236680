//! Whether a working space is protected: all its guard doors are closed.
//!
//! Several groups take the state of the space they are in; one door may belong to two spaces (HFS-GRP-005).

use crate::kernel::ConfigError;

pub use crate::contract::Stateless as State;

config! {
    /// The doors of the space.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        doors: u8,
    }
}

impl Config {
    /// `doors`: bit k is set if guard door k protects the space. A space without a door is never protected.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(doors: u8) -> Result<Self, ConfigError> {
        Ok(Self { doors })
    }
}

fields! {
    /// The doors of the machine.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Markers of the door switches (-SD): bit k is set while door k is closed, by both contacts.
        pub closed: u8,
    }
}

fields! {
    /// The state of the space.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// At least one of its doors is not closed.
        pub open: bool,
    }
}

monitor! { heidenhain::working_space;
    /// A space is protected only with every one of its doors closed.
    protected_by_all_its_doors ["HFS-DOOR-001", "HFS-DOOR-002"]:
        when |s| !s.outputs.open
            => s.config.doors != 0 && s.config.doors & !s.inputs.closed == 0;

    /// Then it is, whatever the doors of other spaces do.
    other_doors_do_not_matter ["HFS-DOOR-002", "HFS-GRP-005"]:
        when |s| s.config.doors != 0 && s.config.doors & !s.inputs.closed == 0
            => !s.outputs.open;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let open = config.doors == 0 || inputs.closed & config.doors != config.doors;
    (state, Outputs { open })
}
