//! Safe operating stop (SOS) of one axis: it stands, and stays where it stood when the stop began.
//!
//! An axis that moves is braked by SS1. One that creeps away, slower than counts as motion but further than the permitted
//! path, has nothing to be braked: SS0. In the self-test the path alone is watched.
//!
//! Recommended readings of the manual implemented here: AMB-11 GE, the limit itself is no standstill.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Distance, Position, Speed};

config! {
    /// The limits.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        path: Distance,
        still: Speed,
    }
}

impl Config {
    /// `path`: how far the axis may get from the position where the stop began (SMP545.x). `still`: the speed from which on
    /// it does not stand: 50 mm/min, or 10 rpm of a spindle.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] when `still` is 0: nothing would ever stand.
    pub const fn new(path: Distance, still: Speed) -> Result<Self, ConfigError> {
        if still.0 == 0 {
            Err(ConfigError::ValueOutOfRange)
        } else {
            Ok(Self { path, still })
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Standstill was watched in the last cycle.
        pub on: bool,
        /// The position in the first cycle of it; 0 while nothing is watched.
        pub begin: Position,
    }
}

impl State {
    /// Nothing is watched.
    pub const INITIAL: Self = Self {
        on: false,
        begin: Position(0),
    };

    /// A position is kept only while it is needed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        self.on || self.begin == Position(0)
    }

    /// The position that a cycle at `position` is compared with.
    fn reference(&self, position: Position) -> Position {
        if self.on { self.begin } else { position }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The group is in SOS, or the axis has no feed enable.
        pub watched: bool,
        /// The self-test runs: the path alone counts.
        pub self_test: bool,
        /// The actual position of this channel.
        pub position: Position,
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The axis moves.
        pub too_fast: bool,
        /// The axis does not move, but is further from where it stood than it may be.
        pub too_far: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::operating_stop;
    /// An axis that does not stand is braked by SS1 in the same cycle.
    moving_axis_is_braked ["HFS-P-14", "HFS-SOS-001", "HFS-SOS-002", "HFS-TIMING-012"]:
        when |s| s.inputs.watched && !s.inputs.self_test && s.inputs.speed >= s.config.still
            => s.outputs.too_fast && !s.outputs.too_far && s.outputs.demand == Stop::Ss1;

    /// One that creeps further than it may from where it stood gets SS0.
    creeping_axis_loses_its_torque ["HFS-ARCH-004/b", "HFS-P-14", "HFS-SOS-003"]:
        when |s| s.inputs.watched && s.before.on && (s.inputs.self_test || s.inputs.speed < s.config.still)
            && s.inputs.position.distance(s.before.begin) > s.config.path
            => s.outputs.too_far && s.outputs.demand == Stop::Ss0;

    /// In the self-test the speed does not count, in either direction.
    self_test_watches_the_path_only ["HFS-TEST-018", "HFS-P-43"]:
        when |s| s.inputs.watched && s.inputs.self_test
            => !s.outputs.too_fast && (s.outputs.demand == Stop::Ss0) == s.outputs.too_far;

    /// Standing within the path raises nothing.
    standing_axis_is_left_alone ["HFS-SOS-001", "HFS-SOS-007"]:
        when |s| s.inputs.watched && s.inputs.speed < s.config.still
            && s.inputs.position.distance(s.before.reference(s.inputs.position)) <= s.config.path
            => s.outputs == Outputs::default();

    /// The path counts from the first cycle of the operating stop, and this position is kept to its end.
    path_counts_from_the_beginning ["HFS-SOS-003"]:
        when |s| s.inputs.watched
            => s.after.on && s.after.begin == s.before.reference(s.inputs.position);

    /// Outside the operating stop nothing is watched and nothing kept.
    released_axis_is_free ["HFS-SOS-001", "HFS-STO-002"]:
        when |s| !s.inputs.watched
            => s.outputs == Outputs::default() && s.after == State::INITIAL;

    /// The state stays consistent.
    state_stays_consistent ["HFS-SOS-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.watched {
        return (State::INITIAL, Outputs::default());
    }
    let begin = state.reference(inputs.position);
    let too_fast = !inputs.self_test && inputs.speed >= config.still;
    let too_far = !too_fast && inputs.position.distance(begin) > config.path;
    let outputs = Outputs {
        too_fast,
        too_far,
        demand: if too_fast {
            Stop::Ss1
        } else if too_far {
            Stop::Ss0
        } else {
            Stop::None
        },
    };
    (State { on: true, begin }, outputs)
}
