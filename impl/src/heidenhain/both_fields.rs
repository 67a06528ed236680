//! The general fields of both safe PLCs, joined and compared: mode, control voltage, drives, chain of contacts, keys, test of the
//! brakes, feed enable.
//!
//! Everything that a safe PLC hands to its kernel is part of the cross comparison, not only the requests for a group
//! ([`both_channels`](crate::heidenhain::both_channels)). While the fields differ, what permits needs both, a pressed key of one
//! is pressed, and no mode but SOM_1 is in force; how long they may differ is decided by [`agreement`](crate::heidenhain::agreement).
//!
//! Recommended reading of the manual implemented here: AMB-49 CMP_WINDOW.

pub use crate::contract::Stateless as State;
use crate::heidenhain::general_fields;
use crate::heidenhain::types::{Som, Stop};

config! {
    /// Nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The fields of both channels, as each kernel has taken them over (see [`general_fields`]).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Those of the MC.
        pub mc: general_fields::Outputs,
        /// Those of the CC.
        pub cc: general_fields::Outputs,
    }
}

fields! {
    /// What is in force.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The higher of the stops for an unknown number: none, or SS1F.
        pub stop: Stop,
        /// The safe operating mode; SOM_1 while the channels differ in it.
        pub som: Som,
        /// Control voltage is asked for, or on.
        pub voltage: bool,
        /// The drives of the group may be switched on.
        pub drives: bool,
        /// The chain of normally closed contacts is closed.
        pub chain: bool,
        /// A machine key is pressed: the self-test waits.
        pub keys: bool,
        /// The axis may move.
        pub feed: bool,
        /// A field differs.
        pub differ: bool,
    }
}

monitor! { heidenhain::both_fields;
    /// Any field that differs is a difference; the test input of the brakes too, with which each channel tests by itself.
    every_field_is_compared ["HFS-KDV-001", "HFS-KDV-002/a"]:
        when |s| s.inputs.mc.som != s.inputs.cc.som || s.inputs.mc.voltage != s.inputs.cc.voltage
            || s.inputs.mc.drives != s.inputs.cc.drives || s.inputs.mc.chain != s.inputs.cc.chain
            || s.inputs.mc.keys != s.inputs.cc.keys || s.inputs.mc.brakes != s.inputs.cc.brakes
            || s.inputs.mc.feed != s.inputs.cc.feed || s.inputs.mc.stop != s.inputs.cc.stop
            => s.outputs.differ;

    /// Fields that agree are taken over as they are, and are no difference.
    equal_fields_are_taken_over ["HFS-KDV-002/a"]:
        when |s| s.inputs.mc == s.inputs.cc
            => !s.outputs.differ
                && s.outputs == Outputs {
                    stop: s.inputs.mc.stop,
                    som: s.inputs.mc.som,
                    voltage: s.inputs.mc.voltage,
                    drives: s.inputs.mc.drives,
                    chain: s.inputs.mc.chain,
                    keys: s.inputs.mc.keys,
                    feed: s.inputs.mc.feed,
                    differ: false,
                };

    /// What permits needs both channels.
    permission_needs_both ["HFS-KDV-005", "HFS-ARCH-001"]:
        when |s| s.outputs.voltage || s.outputs.drives || s.outputs.chain || s.outputs.feed || !s.outputs.keys
            => (!s.outputs.voltage || (s.inputs.mc.voltage && s.inputs.cc.voltage))
                && (!s.outputs.drives || (s.inputs.mc.drives && s.inputs.cc.drives))
                && (!s.outputs.chain || (s.inputs.mc.chain && s.inputs.cc.chain))
                && (!s.outputs.feed || (s.inputs.mc.feed && s.inputs.cc.feed))
                && (s.outputs.keys || (!s.inputs.mc.keys && !s.inputs.cc.keys));

    /// A mode with open doors is in force only when both channels have selected it.
    mode_needs_both ["HFS-KDV-005"]:
        when |s| s.outputs.som != Som::Som1
            => s.inputs.mc.som == s.outputs.som && s.inputs.cc.som == s.outputs.som;

    /// A number that one kernel refuses stops the machine, whatever the other one has.
    one_refusal_is_enough ["HFS-FAULT-006"]:
        when |s| s.inputs.mc.stop == Stop::Ss1F || s.inputs.cc.stop == Stop::Ss1F
            => s.outputs.stop >= Stop::Ss1F;

    /// No other stop is raised here.
    no_other_stop ["HFS-KDV-005"]:
        when |s| s.inputs.mc.stop == Stop::None && s.inputs.cc.stop == Stop::None
            => s.outputs.stop == Stop::None;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (mc, cc) = (inputs.mc, inputs.cc);
    let outputs = Outputs {
        stop: mc.stop.max(cc.stop),
        som: if mc.som == cc.som { mc.som } else { Som::Som1 },
        voltage: mc.voltage && cc.voltage,
        drives: mc.drives && cc.drives,
        chain: mc.chain && cc.chain,
        keys: mc.keys || cc.keys,
        feed: mc.feed && cc.feed,
        differ: mc != cc,
    };
    (state, outputs)
}
