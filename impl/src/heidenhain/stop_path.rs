//! The path of an axis while an SS2 brakes it: with a door open it ends in SS1 when it grows too long.
//!
//! The path counts from the position at which the braking began, in every monitoring state; it is limited only where the
//! group was in SLS_2, SLS_3 or SLS_4 before the stop (5.2: "only active in the SOM_2, SOM_3 and SOM_4 operating modes when
//! the guard doors are open").

use crate::heidenhain::types::{GroupState, Stop};
use crate::kernel::{ConfigError, Distance, Position};

config! {
    /// The limit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        path: Distance,
    }
}

impl Config {
    /// `path`: the longest path of an SS2 (SMP550.x).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(path: Distance) -> Result<Self, ConfigError> {
        Ok(Self { path })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// An SS2 braked the axis in the last cycle.
        pub on: bool,
        /// The position in the first cycle of it; 0 without one.
        pub begin: Position,
    }
}

impl State {
    /// No SS2.
    pub const INITIAL: Self = Self {
        on: false,
        begin: Position(0),
    };

    /// A position is kept only while it is needed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        self.on || self.begin == Position(0)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// An SS2 brakes the axis.
        pub braking: bool,
        /// The monitoring state of before the stop.
        pub state: GroupState,
        /// The actual position of this channel.
        pub position: Position,
    }
}

impl Inputs {
    /// Whether the path is limited: a door is open and speeds are.
    fn limited(&self) -> bool {
        matches!(
            self.state,
            GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4
        )
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::stop_path;
    /// Further than permitted since the braking began: SS1 in the same cycle.
    long_path_is_braked_harder ["HFS-P-15", "HFS-SS2-005"]:
        when |s| s.inputs.braking && s.inputs.limited() && s.before.on
            && s.inputs.position.distance(s.before.begin) > s.config.path
            => s.outputs.demand == Stop::Ss1;

    /// Up to the permitted path nothing is raised.
    permitted_path_is_left_alone ["HFS-SS2-005"]:
        when |s| s.before.on && s.inputs.position.distance(s.before.begin) <= s.config.path
            => s.outputs.demand == Stop::None;

    /// With the door closed, at standstill states and in restricted spindle operation the path is free.
    path_is_free_without_a_limited_speed ["HFS-SS2-005"]:
        when |s| !s.inputs.limited() || !s.inputs.braking
            => s.outputs.demand == Stop::None;

    /// The path counts from the first cycle of the braking, and this position is kept to its end.
    path_counts_from_the_beginning ["HFS-SS2-005"]:
        when |s| s.inputs.braking
            => s.after.on && s.after.begin == if s.before.on { s.before.begin } else { s.inputs.position };

    /// After the braking nothing is kept.
    nothing_is_kept_after_the_stop ["HFS-SS2-005"]:
        when |s| !s.inputs.braking
            => s.after == State::INITIAL;

    /// The state stays consistent.
    state_stays_consistent ["HFS-SS2-005"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.braking {
        return (State::INITIAL, Outputs::default());
    }
    let begin = if state.on {
        state.begin
    } else {
        inputs.position
    };
    let demand = if inputs.limited() && inputs.position.distance(begin) > config.path {
        Stop::Ss1
    } else {
        Stop::None
    };
    (State { on: true, begin }, Outputs { demand })
}
