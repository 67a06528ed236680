//! What the kernels compare beside the fields of their safe PLCs: whether the programs are executed at all, whether the run-time
//! systems ask for SS1F, and how the safe outputs read back.
//!
//! The channels may differ for less than a window ([`agreement`](crate::heidenhain::agreement)): a program starts, and an output
//! is set, in the cycle of its own safe PLC. The outputs are compared always, in operation as at rest.
//!
//! Recommended reading of the manual implemented here: AMB-49 CMP_WINDOW.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::Stop;

config! {
    /// Nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// What one channel tells the other.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Status {
        /// The program of its safe PLC is being executed.
        pub executed: bool,
        /// The run-time system of its safe PLC asks for SS1F.
        pub runtime: bool,
        /// Its half of the dual-channel outputs as they read back, one bit each.
        pub outputs: u16,
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What the MC tells.
        pub mc: Status,
        /// What the CC tells.
        pub cc: Status,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The channels differ.
        pub differ: bool,
        /// SS1F that a run-time system asks for.
        pub stop: Stop,
    }
}

monitor! { heidenhain::both_status;
    /// A program that is executed in one channel only is a difference.
    programs_are_compared ["HFS-KDV-001", "HFS-KDV-002/d"]:
        when |s| s.inputs.mc.executed != s.inputs.cc.executed
            => s.outputs.differ;

    /// An SS1F that one run-time system asks for alone is a difference, and acts without waiting for the window.
    run_time_systems_are_compared ["HFS-KDV-001", "HFS-KDV-002/e", "HFS-FAULT-019"]:
        when |s| s.inputs.mc.runtime != s.inputs.cc.runtime
            => s.outputs.differ && s.outputs.stop == Stop::Ss1F;

    /// An output that reads back differently in the channels is a difference, whichever it is.
    outputs_are_compared ["HFS-KDV-001", "HFS-KDV-002/c", "HFS-KDV-004"]:
        when |s| s.inputs.mc.outputs != s.inputs.cc.outputs
            => s.outputs.differ;

    /// Nothing else is a difference.
    agreement_is_no_difference ["HFS-KDV-002/c", "HFS-KDV-002/d", "HFS-KDV-002/e"]:
        when |s| s.inputs.mc == s.inputs.cc
            => !s.outputs.differ;

    /// Without a run-time system that asks for it no stop is raised here.
    no_other_stop ["HFS-FAULT-019"]:
        when |s| !s.inputs.mc.runtime && !s.inputs.cc.runtime
            => s.outputs.stop == Stop::None;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let outputs = Outputs {
        differ: inputs.mc != inputs.cc,
        stop: if inputs.mc.runtime || inputs.cc.runtime {
            Stop::Ss1F
        } else {
            Stop::None
        },
    };
    (state, outputs)
}
