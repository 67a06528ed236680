//! `NN_AxGrpInMotion`: whether an axis of a group moves, as the kernel tells the safe PLC.

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Bit k is set while axis k of the group moves.
        pub axes: u8,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// At least one axis of the group moves.
        pub moving: bool,
    }
}

monitor! { heidenhain::group_motion;
    /// One axis is enough.
    one_axis_is_enough ["HFS-ARCH-004/j", "HFS-API-033"]:
        when |s| s.inputs.axes != 0
            => s.outputs.moving;

    /// When all stand the group stands.
    all_axes_stand ["HFS-API-033"]:
        when |s| !s.outputs.moving
            => s.inputs.axes == 0;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let moving = inputs.axes != 0;
    (state, Outputs { moving })
}
