//! Which safety function an axis or spindle has in which mode (table in 6.1.6).

use crate::heidenhain::types::{Kind, Som};

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// A safety function.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Function {
        /// Safe torque off.
        #[default]
        Sto,
        /// Safe operating stop.
        Sos,
        /// Safely limited speed.
        Sls,
        /// Safely limited increment.
        Sli,
        /// Safely limited position.
        Slp,
        /// The safe stops SS0, SS1, SS1F, SS2.
        Stops,
        /// Safe brake control.
        Sbc,
    }
}

fields! {
    /// What is asked.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What the group consists of.
        pub kind: Kind,
        /// The function.
        pub function: Function,
        /// The mode.
        pub som: Som,
        /// The spindle has a brake.
        pub has_brake: bool,
        /// SMP549: the spindle is kept under control after an SS2.
        pub spindle_sos: bool,
        /// SMP600 or SMP601 is -1: the drive belongs to no group and is not safe.
        pub ungrouped: bool,
    }
}

impl Inputs {
    /// Whether it is an axis without a group (6.1.9); of a spindle without one the manual takes the watch over its encoder only.
    fn unsafe_axis(&self) -> bool {
        self.ungrouped && self.kind != Kind::Spindle
    }
}

fields! {
    /// The answer.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The function is there.
        pub available: bool,
    }
}

monitor! { heidenhain::availability;
    /// Torque off and the stops are there always.
    stops_are_always_there ["HFS-MODE-016"]:
        when |s| matches!(s.inputs.function, Function::Sto | Function::Stops) && !s.inputs.ungrouped
            => s.outputs.available;

    /// Limited speed is no function of automatic operation.
    limited_speed_from_som_2 ["HFS-MODE-016", "HFS-MODE-003"]:
        when |s| s.inputs.function == Function::Sls && !s.inputs.ungrouped
            => s.outputs.available == (s.inputs.som != Som::Som1);

    /// The operating stop: axes always, a spindle by its parameter, auxiliary axes from SOM_2 on.
    operating_stop_by_kind ["HFS-MODE-016"]:
        when |s| s.inputs.function == Function::Sos && !s.inputs.ungrouped
            => s.outputs.available == match s.inputs.kind {
                Kind::NcAxes => true,
                Kind::Spindle => s.inputs.spindle_sos,
                Kind::Auxiliary => s.inputs.som != Som::Som1,
            };

    /// Increments are for axes, limited positions for NC axes.
    increments_and_positions_are_for_axes ["HFS-MODE-016"]:
        when |s| matches!(s.inputs.function, Function::Sli | Function::Slp) && !s.inputs.ungrouped
            => s.outputs.available
                == (s.inputs.kind == Kind::NcAxes
                    || (s.inputs.kind == Kind::Auxiliary && s.inputs.function == Function::Sli));

    /// Brake control: a spindle has it with a brake only.
    brake_control_needs_a_brake ["HFS-MODE-016"]:
        when |s| s.inputs.function == Function::Sbc && !s.inputs.ungrouped
            => s.outputs.available == (s.inputs.kind != Kind::Spindle || s.inputs.has_brake);

    /// An axis without a group is not switched off, held, limited or braked safely, in no mode.
    axis_without_group_has_no_function ["HFS-NS-001/b"]:
        when |s| s.inputs.ungrouped && s.inputs.kind != Kind::Spindle
            => !s.outputs.available || matches!(s.inputs.function, Function::Sli | Function::Stops);
}

/// For each function and kind of group the modes it is there in: bit k for SOM_(k+1). As printed, without the notes.
const TABLE: [[u8; 3]; 7] = [
    // NC axes, spindles, auxiliary axes
    [0b1111, 0b1111, 0b1111],
    [0b1111, 0b0000, 0b1110],
    [0b1110, 0b1110, 0b1110],
    [0b1111, 0b0000, 0b1111],
    [0b1111, 0b0000, 0b0000],
    [0b1111, 0b1111, 0b1111],
    [0b1111, 0b0000, 0b1111],
];

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let row = TABLE
        .get(inputs.function as usize)
        .copied()
        .unwrap_or_default();
    let modes = row.get(inputs.kind as usize).copied().unwrap_or_default();
    let noted = match inputs.function {
        Function::Sos => inputs.spindle_sos,
        Function::Sbc => inputs.has_brake,
        _ => false,
    };
    let available = (modes >> inputs.som as u8) & 1 == 1 || (inputs.kind == Kind::Spindle && noted);
    // 6.1.9 names these five for axes without a group.
    let taken = inputs.unsafe_axis()
        && matches!(
            inputs.function,
            Function::Sto | Function::Sos | Function::Sls | Function::Slp | Function::Sbc
        );
    let available = available && !taken;
    (state, Outputs { available })
}
