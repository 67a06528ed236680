//! Functions of a machine that one safe PLC prevents while a person may be in its working space.

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// A function that is not a motion of a safe axis.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Function {
        /// Automatic change of the pallet.
        #[default]
        PalletChange,
        /// Automatic change of tool or workpiece.
        ToolChange,
        /// Coolant under high pressure.
        Coolant,
        /// Measurement of the tool, with a laser for instance.
        ToolMeasurement,
        /// Turning on a milling machine.
        Turning,
        /// Chip conveyor.
        ChipConveyor,
    }
}

fields! {
    /// What is asked.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// A guard door of the working space is open.
        pub door_open: bool,
        /// An additional permissive key is valid.
        pub permissive: bool,
        /// The function.
        pub function: Function,
    }
}

fields! {
    /// The answer.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The function may run.
        pub allowed: bool,
    }
}

monitor! { heidenhain::allowed_functions;
    /// With the door open only the chip conveyor runs, with its permissive.
    open_door_forbids ["HFS-MODE-012"]:
        when |s| s.inputs.door_open
            => s.outputs.allowed == (s.inputs.function == Function::ChipConveyor && s.inputs.permissive);

    /// With the door closed everything may run.
    closed_door_allows ["HFS-MODE-012"]:
        when |s| !s.inputs.door_open
            => s.outputs.allowed;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let conveyor = inputs.function == Function::ChipConveyor && inputs.permissive;
    let allowed = !inputs.door_open || conveyor;
    (state, Outputs { allowed })
}
