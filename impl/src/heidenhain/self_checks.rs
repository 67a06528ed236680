//! What the kernel of one channel does when one of its own checks finds a fault in operation: the fault tables of 4.8.24.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::Stop;
use crate::kernel::ConfigError;

config! {
    /// The channel and the drive.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        cc: bool,
        safe: bool,
    }
}

impl Config {
    /// `cc`: channel B. `safe`: the drive belongs to an axis group; others have no encoder monitoring.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(cc: bool, safe: bool) -> Result<Self, ConfigError> {
        Ok(Self { cc, safe })
    }
}

fields! {
    /// The faults found in one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The amplitude of an encoder is outside its limits.
        pub amplitude: bool,
        /// The input frequency of an encoder is too high.
        pub frequency: bool,
        /// The temperature of a component is outside its limits.
        pub temperature: bool,
        /// A fan is too slow.
        pub fan: bool,
        /// A supply voltage of a board is outside its limits.
        pub supply: bool,
        /// The check of the watchdog counters failed.
        pub watchdog: bool,
        /// Internal error of the safe software.
        pub software: bool,
        /// Fatal system error.
        pub fatal: bool,
        /// A checksum is wrong.
        pub checksum: bool,
        /// The run-time system of the safe PLC asks for SS1F.
        pub runtime: bool,
        /// Internal emergency stop: from the interpolator or a CC.
        pub internal_es: bool,
        /// A safe output reads back differently from its command.
        pub readback: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A fault asks for SS1F.
        pub asks_ss1f: bool,
        /// A fault asks for SS1.
        pub asks_ss1: bool,
        /// A fault asks for SS2.
        pub asks_ss2: bool,
        /// The highest of them.
        pub demand: Stop,
    }
}

monitor! { heidenhain::self_checks;
    /// Voltages, watchdogs, fatal errors, checksums and the safe PLC's run-time system: SS1F in both channels.
    fatal_faults_are_ss1f ["HFS-MON-005", "HFS-MON-006", "HFS-FAULT-003", "HFS-FAULT-004", "HFS-FAULT-019"]:
        when |s| s.inputs.supply || s.inputs.watchdog || s.inputs.fatal || s.inputs.checksum || s.inputs.runtime
            => s.outputs.asks_ss1f && s.outputs.demand == Stop::Ss1F;

    /// An internal error of the safe software is SS1F in channel A.
    software_error_is_ss1f_in_channel_a ["HFS-FAULT-002"]:
        when |s| s.inputs.software && !s.config.cc
            => s.outputs.demand == Stop::Ss1F;

    /// Encoder signals of a safe drive: SS1.
    encoder_fault_of_a_safe_drive_stops ["HFS-MON-001", "HFS-MON-002"]:
        when |s| s.config.safe && (s.inputs.amplitude || s.inputs.frequency)
            => s.outputs.asks_ss1 && s.outputs.demand >= Stop::Ss1;

    /// Those of a drive without a group are not watched.
    encoder_of_another_drive_is_not_watched ["HFS-NS-001/e", "HFS-NS-003"]:
        when |s| !s.config.safe
            && Inputs { amplitude: false, frequency: false, ..s.inputs } == Inputs::default()
            => s.outputs == Outputs::default();

    /// An internal emergency stop, and an output that does not read back: SS1.
    emergency_stop_and_readback_stop ["HFS-ES-002", "HFS-FAULT-011"]:
        when |s| s.inputs.internal_es || s.inputs.readback
            => s.outputs.asks_ss1 && s.outputs.demand >= Stop::Ss1;

    /// Temperature and fans: SS2.
    heat_is_ss2 ["HFS-MON-003", "HFS-MON-004"]:
        when |s| s.inputs.temperature || s.inputs.fan
            => s.outputs.asks_ss2 && s.outputs.demand >= Stop::Ss2;

    /// Without a fault nothing is raised.
    no_fault_no_stop ["HFS-STOP-001"]:
        when |s| s.inputs == Inputs::default()
            => s.outputs == Outputs::default();

    /// Of all faults of a cycle the highest stop wins.
    highest_stop_wins ["HFS-STOP-001", "HFS-STOP-009"]:
        when |s| s.outputs.asks_ss1f || s.outputs.asks_ss1 || s.outputs.asks_ss2
            => s.outputs.demand == if s.outputs.asks_ss1f {
                Stop::Ss1F
            } else if s.outputs.asks_ss1 {
                Stop::Ss1
            } else {
                Stop::Ss2
            };
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let asks_ss1f = inputs.supply
        || inputs.watchdog
        || inputs.fatal
        || inputs.checksum
        || inputs.runtime
        || (inputs.software && !config.cc);
    let encoder = config.safe && (inputs.amplitude || inputs.frequency);
    let asks_ss1 = encoder || inputs.internal_es || inputs.readback;
    let asks_ss2 = inputs.temperature || inputs.fan;
    let outputs = Outputs {
        asks_ss1f,
        asks_ss1,
        asks_ss2,
        demand: if asks_ss1f {
            Stop::Ss1F
        } else if asks_ss1 {
            Stop::Ss1
        } else if asks_ss2 {
            Stop::Ss2
        } else {
            Stop::None
        },
    };
    (State, outputs)
}
