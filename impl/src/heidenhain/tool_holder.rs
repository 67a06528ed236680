//! Opening of the tool holder of one spindle by a safe PLC.
//!
//! With the door closed the spindle must stand. With the door open it must also be without torque, which the safe PLC asks
//! for one of its cycles before it opens the holder. It asks only while the spindle stands, since a moving spindle would be
//! stopped by SS1; so an SS2 comes first. While the holder is open the spindle stays without torque.

use crate::heidenhain::types::GroupState;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The holder is open: outputs TH.A and TH.B.
        pub open: bool,
        /// Torque off was asked for in the last cycle, with the door open.
        pub asked: bool,
    }
}

impl State {
    /// Closed.
    pub const INITIAL: Self = Self {
        open: false,
        asked: false,
    };

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
        /// The PLC asks for it: key with permissive.
        pub request: bool,
        /// A door of the working space is open.
        pub door_open: bool,
        /// `NN_AxGrpInMotion` of the spindle.
        pub moving: bool,
        /// `NN_AxGrpState` of the spindle.
        pub state: GroupState,
    }
}

impl Inputs {
    /// Whether the spindle has no torque.
    fn torque_off(&self) -> bool {
        matches!(self.state, GroupState::StoO | GroupState::Sto)
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The holder is open.
        pub open: bool,
        /// `PP_AxGrpStateReq` of the spindle is STO_O.
        pub no_torque: bool,
    }
}

monitor! { heidenhain::tool_holder;
    /// With the door open the holder opens only for a spindle that stands without torque, asked for in an earlier cycle.
    open_door_needs_a_spindle_without_torque ["HFS-P-29", "HFS-TH-001", "HFS-TH-005"]:
        when |s| !s.before.open && s.outputs.open && s.inputs.door_open
            => s.before.asked && s.inputs.request && !s.inputs.moving && s.inputs.torque_off() && s.outputs.no_torque;

    /// With the door closed the request and a standing spindle suffice.
    closed_door_needs_a_standing_spindle ["HFS-TH-002"]:
        when |s| !s.before.open && !s.inputs.door_open
            => s.outputs.open == (s.inputs.request && !s.inputs.moving);

    /// When all conditions are met the holder does open.
    holder_opens ["HFS-TH-001"]:
        when |s| s.before.asked && s.inputs.request && s.inputs.door_open && !s.inputs.moving && s.inputs.torque_off()
            => s.outputs.open;

    /// Without a request the holder closes.
    holder_closes_without_request ["HFS-TH-003"]:
        when |s| !s.inputs.request
            => !s.outputs.open && !s.outputs.no_torque && s.after == State::INITIAL;

    /// Once open, it stays open as long as it is asked for: nothing else is checked.
    open_holder_is_left_alone ["HFS-TH-002"]:
        when |s| s.before.open && s.inputs.request
            => s.outputs.open;

    /// While the holder is open the spindle has no torque, whatever the door does.
    no_torque_while_open ["HFS-TH-001", "HFS-TH-004"]:
        when |s| s.outputs.open
            => s.outputs.no_torque;

    /// Torque off is first asked for while the spindle stands: a turning one must be stopped by SS2 before.
    turning_spindle_is_not_cut_off ["HFS-TH-005", "HFS-AXG-017"]:
        when |s| !s.before.open && !s.before.asked && s.inputs.moving
            => !s.outputs.no_torque;

    /// What is shown is kept.
    outputs_are_kept ["HFS-TH-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.open == s.outputs.open;
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let may_open = !inputs.moving && (!inputs.door_open || (state.asked && inputs.torque_off()));
    let open = inputs.request && (state.open || may_open);
    let asked = inputs.request && inputs.door_open && (state.asked || state.open || !inputs.moving);
    let outputs = Outputs {
        open,
        no_torque: open || asked,
    };
    (State { open, asked }, outputs)
}
