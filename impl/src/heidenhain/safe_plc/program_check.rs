//! Whether the program of a safe PLC may run in its channel: its checksum is the accepted one, and it was made for the interface
//! that the control has.
//!
//! Each run-time system checks its own program: the checksum at every translation (SMP691), the version of the interface always
//! (SMP693). The manual names the messages only; that such a program does not run is the safe reading.

use crate::kernel::ConfigError;

config! {
    /// Whether the check is on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        commissioning: bool,
    }
}

impl Config {
    /// `commissioning`: SMP690 = 1, the checksum is not looked at; never in operation.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(commissioning: bool) -> Result<Self, ConfigError> {
        Ok(Self { commissioning })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The program may run.
        pub good: bool,
    }
}

impl State {
    /// No program.
    pub const INITIAL: Self = Self { good: false };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The program is translated in this cycle.
        pub translated: bool,
        /// Its checksum is that of SMP691.
        pub crc_equal: bool,
        /// SMP693 is the version of the interface in the NC software.
        pub version_equal: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The program may run.
        pub good: bool,
        /// Message with the present checksum, to be entered in SMP691 with the password of the machine builder.
        pub message_crc: bool,
        /// Message "Changed NC software version".
        pub message_version: bool,
    }
}

monitor! { heidenhain::program_check;
    /// A program that differs from the accepted one does not run, and the operator is told why.
    changed_program_does_not_run ["HFS-SPLC-002", "HFS-PARAM-018"]:
        when |s| s.inputs.translated && !s.inputs.crc_equal && !s.config.commissioning
            => !s.outputs.good && s.outputs.message_crc;

    /// A program for another interface does not run either, translated or not, and during commissioning neither.
    other_interface_does_not_run ["HFS-PARAM-019"]:
        when |s| !s.inputs.version_equal
            => !s.outputs.good && s.outputs.message_version;

    /// During commissioning any program for the interface runs.
    commissioning_checks_no_program ["HFS-SPLC-002"]:
        when |s| s.config.commissioning && s.inputs.translated && s.inputs.version_equal
            => s.outputs.good && !s.outputs.message_crc;

    /// The accepted program runs, without a message.
    accepted_program_runs ["HFS-SPLC-002"]:
        when |s| s.inputs.translated && s.inputs.crc_equal && s.inputs.version_equal
            => s.outputs.good && !s.outputs.message_crc && !s.outputs.message_version;

    /// Between translations nothing changes.
    verdict_stays ["HFS-SPLC-002"]:
        when |s| !s.inputs.translated && s.inputs.version_equal
            => s.outputs.good == s.before.good && !s.outputs.message_crc && !s.outputs.message_version;

    /// What is shown is kept.
    verdict_is_kept ["HFS-SPLC-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.good == s.outputs.good;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let checked = inputs.translated && !config.commissioning;
    let message_crc = checked && !inputs.crc_equal;
    let message_version = !inputs.version_equal;
    let known = if inputs.translated {
        !message_crc
    } else {
        state.good
    };
    let good = known && inputs.version_equal;
    let outputs = Outputs {
        good,
        message_crc,
        message_version,
    };
    (State { good }, outputs)
}
