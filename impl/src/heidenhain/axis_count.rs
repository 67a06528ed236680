//! How many safe axes of a working space may move at a time while its door is open.
//!
//! One in SOM_2, one by handwheel in SOM_3 and SOM_4, and one during homing. More than that is SS2 of the groups. With the
//! door closed, and by program in SOM_3 and SOM_4, there is no limit. Spindles and axes without a group do not count. Groups
//! in SOM_1 (doors open, in the operating stop) are left out, as 4.8.12 says of homing: there nothing may move at all.
//!
//! Recommended readings of the manual implemented here: AMB-62. SMP560 bit 9 is not in this version.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{GroupState, Stop, Unit};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The monitoring state of the groups of this working space.
        pub state: GroupState,
        /// The machine operating mode.
        pub unit: Unit,
        /// How many NC and auxiliary axes of the working space move.
        pub moving: u8,
        /// How many of these belong to no group (SMP600 = -1).
        pub ungrouped: u8,
    }
}

impl Inputs {
    /// How many axes count.
    pub const fn counted(&self) -> u8 {
        self.moving.saturating_sub(self.ungrouped)
    }

    /// Whether one axis only may move.
    pub const fn one_only(&self) -> bool {
        match self.state {
            GroupState::Sls2 => true,
            GroupState::Sls3 | GroupState::Sls4 => {
                matches!(self.unit, Unit::Handwheel | Unit::Reference)
            }
            // Restricted operation is of spindles only.
            GroupState::Auto
            | GroupState::SlsS
            | GroupState::Sos
            | GroupState::StoO
            | GroupState::Sto => false,
        }
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// One axis only may move.
        pub one_only: bool,
        /// The stop to be raised for the groups of the working space.
        pub demand: Stop,
    }
}

monitor! { heidenhain::axis_count;
    /// SOM_2: a second moving axis stops all of them.
    one_axis_in_som_2 ["HFS-MODE-004/c", "HFS-P-32", "HFS-MON-007", "HFS-MON-008"]:
        when |s| s.inputs.state == GroupState::Sls2 && s.inputs.moving > 1 && s.inputs.ungrouped == 0
            => s.outputs.demand == Stop::Ss2;

    /// SOM_3 and SOM_4 by handwheel: the same.
    one_axis_by_handwheel ["HFS-MON-007", "HFS-MON-009", "HFS-HW-001"]:
        when |s| matches!(s.inputs.state, GroupState::Sls3 | GroupState::Sls4) && s.inputs.unit == Unit::Handwheel
            && s.inputs.moving > 1 && s.inputs.ungrouped == 0
            => s.outputs.demand == Stop::Ss2;

    /// Homing with the door open: the same. With the door closed several axes may be homed together; in a standstill state
    /// it is the operating stop that answers motion.
    one_axis_when_homing ["HFS-REF-003", "HFS-REF-014"]:
        when |s| s.inputs.unit == Unit::Reference && s.inputs.moving > 1 && s.inputs.ungrouped == 0
            => (s.outputs.demand == Stop::Ss2)
                == (s.inputs.state.is_limited() && s.inputs.state != GroupState::SlsS);

    /// At the panel SOM_3 and SOM_4 let several axes move.
    several_axes_at_the_panel ["HFS-MON-009", "HFS-MODE-005/c", "HFS-MODE-006"]:
        when |s| matches!(s.inputs.state, GroupState::Sls3 | GroupState::Sls4) && s.inputs.unit.at_panel()
            => s.outputs.demand == Stop::None;

    /// With the door closed there is no limit.
    no_limit_with_the_door_closed ["HFS-MODE-002", "HFS-REF-014"]:
        when |s| s.inputs.state == GroupState::Auto
            => s.outputs == Outputs::default();

    /// One moving axis never raises anything.
    one_axis_may_always_move ["HFS-MON-007"]:
        when |s| s.inputs.moving <= 1
            => s.outputs.demand == Stop::None;

    /// Axes without a group are ignored: beside any number of them one safe axis may move, and no further one.
    axes_without_group_are_ignored ["HFS-NS-001/a", "HFS-MODE-004/c"]:
        when |s| s.inputs.state == GroupState::Sls2 && s.inputs.ungrouped > 0 && s.inputs.ungrouped <= s.inputs.moving
            => (s.outputs.demand == Stop::Ss2) == (s.inputs.moving - s.inputs.ungrouped > 1);
}

pub(crate) fn transition(_: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let one_only = inputs.one_only();
    let demand = if one_only && inputs.counted() > 1 {
        Stop::Ss2
    } else {
        Stop::None
    };
    (State, Outputs { one_only, demand })
}
