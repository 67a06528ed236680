//! Safely limited position (SLP) of one NC axis, with the lock against driving further out.
//!
//! Beyond a limit the axis is stopped by SS1. Then the operator may drive it back: to stand outside, or to move inwards,
//! raises nothing. Moving further out is another SS1 and locks the axis: any motion is stopped until the limits in the
//! safe machine parameters have been changed. The lock is kept through power-off. While the stop still brakes the axis, or
//! its torque is off, nobody drives it: what it overruns is not the wrong way (4.8.12: the axis may be returned "after
//! switching the machine back on").
//!
//! New limits come with a restart: their cycle resets the lock and nothing else, since no axis is checked yet.
//!
//! Recommended readings of the manual implemented here: AMB-13 (settled), AMB-14 PER_EXCURSION: the way back is offered
//! anew each time the axis has been inside.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Position};

config! {
    /// The limits.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        minus: Position,
        plus: Position,
    }
}

impl Config {
    /// `minus`: the lowest permitted position (SMP670.x). `plus`: the highest one (SMP650.x).
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when `plus` is not above `minus`.
    pub const fn new(minus: Position, plus: Position) -> Result<Self, ConfigError> {
        if minus.0 < plus.0 {
            Ok(Self { minus, plus })
        } else {
            Err(ConfigError::LimitsCrossed)
        }
    }

    /// Whether a position is permitted; a limit itself is.
    pub fn inside(&self, position: Position) -> bool {
        self.minus <= position && position <= self.plus
    }

    /// Whether a position outside is further out than the one of the cycle before, on its own side.
    pub fn outwards(&self, last: Position, position: Position) -> bool {
        (position > self.plus && position > last) || (position < self.minus && position < last)
    }
}

fields! {
    /// How far an axis may be driven outside its limits.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Lock {
        /// Inside, or not yet found outside.
        #[default]
        None,
        /// Found outside and stopped: it may be driven back.
        ReturnAllowed,
        /// Driven further out: no motion until the limits are changed.
        Locked,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the axis may be driven; `Locked` is kept through power-off.
        pub lock: Lock,
        /// The position of the last cycle.
        pub last: Position,
    }
}

impl State {
    /// Not locked; position 0.
    pub const INITIAL: Self = Self {
        lock: Lock::None,
        last: Position(0),
    };

    /// The state at power-on: a lock is kept, the position is the one read in this cycle.
    pub const fn restored(locked: bool, position: Position) -> Self {
        Self {
            lock: if locked { Lock::Locked } else { Lock::None },
            last: position,
        }
    }

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
        /// `NN_AxSafe`: a safe NC axis whose position is checked.
        pub checked: bool,
        /// The limits have been changed: OEM password and restart.
        pub changed: bool,
        /// An SS1 or a higher stop brakes the axis or has taken its torque.
        pub stopping: bool,
        /// The actual position of this channel.
        pub position: Position,
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

monitor! { heidenhain::position_limit;
    /// A checked axis found beyond a limit for the first time is stopped in the same cycle and may then be driven back.
    axis_beyond_a_limit_stops ["HFS-ARCH-004/e", "HFS-SLP-001", "HFS-SLP-002", "HFS-SLP-003", "HFS-SLP-004"]:
        when |s| s.inputs.checked && !s.inputs.changed && s.before.lock == Lock::None && !s.config.inside(s.inputs.position)
            => s.outputs.demand == Stop::Ss1 && s.after.lock == Lock::ReturnAllowed;

    /// On the way back, standing outside or moving inwards raises nothing.
    way_back_is_free ["HFS-P-40", "HFS-SLP-004", "HFS-SLP-009"]:
        when |s| s.before.lock == Lock::ReturnAllowed && !s.inputs.changed
            && !s.config.outwards(s.before.last, s.inputs.position)
            => s.outputs.demand == Stop::None && s.after.lock != Lock::Locked;

    /// Driving a checked axis further out stops and locks it.
    wrong_way_locks ["HFS-P-40", "HFS-SLP-005"]:
        when |s| s.before.lock == Lock::ReturnAllowed && !s.inputs.changed && s.inputs.checked && !s.inputs.stopping
            && s.config.outwards(s.before.last, s.inputs.position)
            => s.outputs.demand == Stop::Ss1 && s.after.lock == Lock::Locked;

    /// What the axis overruns while it is stopped does not lock it.
    overrun_does_not_lock ["HFS-SLP-004"]:
        when |s| s.before.lock != Lock::Locked && s.inputs.stopping
            => s.after.lock != Lock::Locked;

    /// A locked axis is stopped whenever it moves, in either direction, checked or not.
    locked_axis_does_not_move ["HFS-P-42", "HFS-SLP-005", "HFS-SLP-009"]:
        when |s| s.before.lock == Lock::Locked && !s.inputs.changed
            => s.after.lock == Lock::Locked
                && (s.outputs.demand == Stop::Ss1) == (s.inputs.position != s.before.last);

    /// Only a change of the limits ends the lock.
    only_new_limits_unlock ["HFS-P-42", "HFS-SLP-005"]:
        when |s| s.before.lock == Lock::Locked && s.after.lock != Lock::Locked
            => s.inputs.changed;

    /// New limits end every lock, and their cycle raises nothing.
    new_limits_reset_the_lock ["HFS-SLP-005"]:
        when |s| s.inputs.changed
            => s.after.lock == Lock::None && s.outputs.demand == Stop::None;

    /// Back inside, the axis is watched as before.
    inside_ends_the_way_back ["HFS-SLP-004"]:
        when |s| s.before.lock == Lock::ReturnAllowed && s.inputs.checked && s.config.inside(s.inputs.position)
            => s.after.lock == Lock::None && s.outputs.demand == Stop::None;

    /// The limits themselves and everything between them are permitted.
    inside_is_free ["HFS-SLP-002"]:
        when |s| s.config.inside(s.inputs.position) && s.before.lock != Lock::Locked
            => s.outputs.demand == Stop::None;

    /// The position of an axis that is not checked means nothing: no violation, and no end of the way back.
    unchecked_axis_is_not_watched ["HFS-SLP-006", "HFS-CHK-007"]:
        when |s| !s.inputs.checked && !s.inputs.changed && s.before.lock != Lock::Locked
            => s.outputs.demand == Stop::None && s.after.lock == s.before.lock;

    /// The position is kept for the next cycle.
    position_is_kept ["HFS-SLP-005"]:
        when |s| s.before.invariant(&s.config)
            => s.after.last == s.inputs.position;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let position = inputs.position;
    let inside = config.inside(position);
    let outwards = config.outwards(state.last, position);
    let (lock, stops) = match state.lock {
        _ if inputs.changed => (Lock::None, false),
        Lock::Locked => (Lock::Locked, position != state.last),
        lock if !inputs.checked => (lock, false),
        Lock::None if inside => (Lock::None, false),
        Lock::None => (Lock::ReturnAllowed, true),
        Lock::ReturnAllowed if inside => (Lock::None, false),
        Lock::ReturnAllowed if outwards && !inputs.stopping => (Lock::Locked, true),
        Lock::ReturnAllowed => (Lock::ReturnAllowed, false),
    };
    let demand = if stops { Stop::Ss1 } else { Stop::None };
    (
        State {
            lock,
            last: position,
        },
        Outputs { demand },
    )
}
