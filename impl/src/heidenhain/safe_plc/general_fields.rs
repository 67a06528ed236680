//! What the kernel of one channel takes over of the general fields that its safe PLC has set.
//!
//! A number that is no value of its field makes all of them void: the fields permit nothing, and the machine stops by SS1F. No
//! copy of an input is trusted further than that.

use crate::heidenhain::types::{Som, Stop};

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The fields as double words and markers: 0 and 1 are the values of a marker.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// `PP_GenSOM`: 0 to 3.
        pub som: u8,
        /// `PP_GenCVO`.
        pub voltage: u8,
        /// `PP_AxGrpPermitDrvOn`.
        pub drives: u8,
        /// `PP_GenFB_NCC`: 1 closed, a copy of the input.
        pub chain: u8,
        /// `PP_GenMKG`.
        pub keys: u8,
        /// `PP_GenTBRK`: 0 active, a copy of the input.
        pub brakes: u8,
        /// `PP_AxFeedEnable` of an axis; the spindle has index 18.
        pub feed: u8,
    }
}

impl Inputs {
    /// Whether every number is a value of its field.
    fn legal(&self) -> bool {
        let markers = [
            self.voltage,
            self.drives,
            self.chain,
            self.keys,
            self.brakes,
            self.feed,
        ];
        Som::from_code(self.som).is_some() && markers.iter().all(|marker| *marker <= 1)
    }
}

fields! {
    /// What is taken over.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SS1F for an unknown number.
        pub stop: Stop,
        /// The safe operating mode.
        pub som: Som,
        /// Control voltage is asked for, or on.
        pub voltage: bool,
        /// The drives of the group may be switched on.
        pub drives: bool,
        /// The chain of normally closed contacts is closed.
        pub chain: bool,
        /// A machine key is pressed: the self-test waits.
        pub keys: bool,
        /// The test input of the brakes is active.
        pub brakes: bool,
        /// The axis may move.
        pub feed: bool,
    }
}

monitor! { heidenhain::general_fields;
    /// An unknown number is a fatal fault, and nothing is permitted by any field.
    unknown_number_is_ss1f ["HFS-FAULT-006", "HFS-MODE-021"]:
        when |s| Som::from_code(s.inputs.som).is_none() || s.inputs.voltage > 1 || s.inputs.drives > 1
            || s.inputs.chain > 1 || s.inputs.keys > 1 || s.inputs.brakes > 1 || s.inputs.feed > 1
            => s.outputs.stop == Stop::Ss1F && s.outputs.som == Som::Som1 && !s.outputs.voltage && !s.outputs.drives
                && !s.outputs.chain && s.outputs.keys && !s.outputs.feed;

    /// What is known raises no stop, and each field is taken over as it is.
    known_numbers_are_taken_over ["HFS-API-027", "HFS-API-028", "HFS-API-029", "HFS-API-030", "HFS-API-016", "HFS-MODE-021"]:
        when |s| s.outputs.stop == Stop::None
            => Som::from_code(s.inputs.som) == Some(s.outputs.som) && s.outputs.voltage == (s.inputs.voltage == 1)
                && s.outputs.drives == (s.inputs.drives == 1) && s.outputs.chain == (s.inputs.chain == 1)
                && s.outputs.keys == (s.inputs.keys == 1) && s.outputs.feed == (s.inputs.feed == 1);

    /// The test input is active at 0.
    brake_input_is_active_low ["HFS-BCT-005"]:
        when |s| s.outputs.stop == Stop::None
            => s.outputs.brakes == (s.inputs.brakes == 0);

    /// No other stop is raised here.
    no_other_stop ["HFS-FAULT-006"]:
        when |s| s.outputs.stop != Stop::None
            => s.outputs.stop == Stop::Ss1F;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let som = Som::from_code(inputs.som);
    let outputs = match som {
        Some(som) if inputs.legal() => Outputs {
            stop: Stop::None,
            som,
            voltage: inputs.voltage == 1,
            drives: inputs.drives == 1,
            chain: inputs.chain == 1,
            keys: inputs.keys == 1,
            brakes: inputs.brakes == 0,
            feed: inputs.feed == 1,
        },
        _ => Outputs {
            stop: Stop::Ss1F,
            som: Som::Som1,
            voltage: false,
            drives: false,
            chain: false,
            keys: true,
            brakes: false,
            feed: false,
        },
    };
    (state, outputs)
}
