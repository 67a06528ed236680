//! The safe PLC program of one channel: its checksum and the version of the interface it was written for.
//!
//! When the program is translated its checksum is compared with the accepted one (SMP691). Another one is reported with the
//! present checksum, which only the password puts into SMP691. SMP690 = 1 leaves that comparison out, while commissioning.
//! The version of the interface (SMP693) must always be that of the software.
//!
//! The manual names the messages only. The reading here is the safe one: such a program does not run.

use crate::kernel::ConfigError;

/// Whether the checksum is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    commissioning: bool,
}

impl Config {
    /// `commissioning`: SMP690 = 1, the checksum is not compared.
    ///
    /// # Errors
    /// None: both values of SMP690 are allowed. The type is that of the other monitors.
    pub const fn new(commissioning: bool) -> Result<Self, ConfigError> {
        Ok(Self { commissioning })
    }

    /// SMP690 = 1.
    pub const fn is_commissioning(&self) -> bool {
        self.commissioning
    }
}

/// The state between two cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct State {
    /// The program may run.
    pub good: bool,
}

impl State {
    /// No program has been checked.
    pub const INITIAL: Self = Self { good: false };

    /// Every state is possible.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

/// The inputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The program is translated in this cycle.
    pub translated: bool,
    /// Its checksum is that of SMP691.
    pub crc_equal: bool,
    /// SMP693 is the version of the interface of the NC software.
    pub version_equal: bool,
}

/// The outputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The program may run.
    pub good: bool,
    /// The message with the present checksum.
    pub message_crc: bool,
    /// The message 'Changed NC software version'.
    pub message_version: bool,
}

contract! {
    /// A program with another checksum than the accepted one does not run, and is reported.
    changed_program_does_not_run ["HFS-SPLC-002", "HFS-PARAM-018"]:
        when |s| s.inputs.translated && !s.inputs.crc_equal && !s.config.is_commissioning()
            => !s.outputs.good && s.outputs.message_crc;

    /// While commissioning the checksum is neither judged nor reported.
    commissioning_leaves_the_checksum_out ["HFS-PARAM-018"]:
        when |s| s.config.is_commissioning()
            => !s.outputs.message_crc
                && (!s.inputs.translated || s.outputs.good == s.inputs.version_equal);

    /// A program for another version of the interface does not run, and is reported.
    other_version_does_not_run ["HFS-PARAM-019"]:
        when |s| !s.inputs.version_equal
            => !s.outputs.good && s.outputs.message_version;

    /// A program begins to run only when it is translated and accepted.
    starts_only_when_translated ["HFS-SPLC-002", "HFS-PARAM-019"]:
        when |s| !s.before.good && s.outputs.good
            => s.inputs.translated && s.inputs.version_equal
                && (s.inputs.crc_equal || s.config.is_commissioning());

    /// An accepted program runs on.
    accepted_program_runs ["HFS-SPLC-002"]:
        when |s| s.inputs.version_equal && (s.before.good || s.inputs.translated)
            && (s.inputs.crc_equal || !s.inputs.translated)
            => s.outputs.good && !s.outputs.message_crc && !s.outputs.message_version;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let differs = !inputs.crc_equal && !config.commissioning;
    let known = if inputs.translated {
        !differs
    } else {
        state.good
    };
    let good = known && inputs.version_equal;
    let outputs = Outputs {
        good,
        message_crc: inputs.translated && differs,
        message_version: !inputs.version_equal,
    };
    (State { good }, outputs)
}
