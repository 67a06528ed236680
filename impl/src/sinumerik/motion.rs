//! Actual position and speed of one channel, from the position of each cycle.
//!
//! The speed is the distance of the positions of two cycles, as the manual forms it (S840D-TIMING-512). Each channel forms
//! it from its own position. While the axis is parked nothing is updated; the first position afterwards, like the first one
//! after power-on, has no predecessor and gives the speed 0. Nor has a position a predecessor that is set anew by referencing, or by
//! synchronising the spindle after a change of the gear stage: its distance to the one before is no motion (S840D-REF-002,
//! S840D-GEAR-506). For that cycle the speed of the one before is kept: to call it 0 would let a STOP B take a moving axis for
//! one that stands, and would pull the braking ramp down to nothing.

use crate::kernel::{Position, Speed};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The position of the last cycle in which the axis was not parked.
        pub last: Position,
        /// `last` belongs to the cycle just before.
        pub known: bool,
        /// The speed of the last cycle; 0 where `last` is not known.
        pub speed: Speed,
    }
}

impl State {
    /// No position read yet.
    pub const INITIAL: Self = Self {
        last: Position(0),
        known: false,
        speed: Speed(0),
    };

    /// Without a position there is no speed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        self.known || self.speed.0 == 0
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// The position read in this cycle.
        pub position: Position,
        /// The axis is parked: the encoder may be unplugged.
        pub parking: bool,
        /// From this cycle on the position counts from another zero: it has been set anew.
        pub set_anew: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The actual position; frozen while the axis is parked.
        pub position: Position,
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

monitor! { sinumerik::motion;
    /// The speed is the distance of the positions of two cycles, in either direction and over the whole range.
    speed_is_the_distance_of_two_cycles ["S840D-TIMING-512", "S840D-SBR-007", "S840D-KDV-711"]:
        when |s| s.before.known && !s.inputs.power_on && !s.inputs.parking && !s.inputs.set_anew
            => s.outputs.speed.0 == s.inputs.position.distance(s.before.last).0;

    /// Without a position of the cycle before there is no speed.
    first_position_has_no_speed ["S840D-REF-016", "S840D-INTERACT-718"]:
        when |s| !s.before.known || s.inputs.power_on
            => s.outputs.speed == Speed(0);

    /// A position set anew is no motion: the speed stays what it was.
    setting_anew_is_no_motion ["S840D-REF-002", "S840D-REF-003", "S840D-GEAR-506"]:
        when |s| s.inputs.set_anew && s.before.known && !s.inputs.power_on && !s.inputs.parking
            => s.outputs.speed == s.before.speed;

    /// The position is the one read, and is kept for the next cycle.
    position_is_the_one_read ["S840D-ARCH-501", "S840D-TIMING-501"]:
        when |s| !s.inputs.parking
            => s.outputs.position == s.inputs.position
                && s.after == State { last: s.inputs.position, known: true, speed: s.outputs.speed };

    /// While the axis is parked position and speed are frozen, and the time in between is no motion.
    parked_axis_is_frozen ["S840D-REF-016", "S840D-INTERACT-718", "S840D-INTERACT-719"]:
        when |s| s.inputs.parking && !s.inputs.power_on
            => s.outputs.position == s.before.last && s.outputs.speed == Speed(0)
                && s.after == State { known: false, speed: Speed(0), ..s.before };

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-TIMING-512"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    if inputs.parking {
        let outputs = Outputs {
            position: before.last,
            speed: Speed(0),
        };
        return (
            State {
                known: false,
                speed: Speed(0),
                ..before
            },
            outputs,
        );
    }
    let speed = match (before.known, inputs.set_anew) {
        (false, _) => Speed(0),
        (true, true) => before.speed,
        (true, false) => Speed(inputs.position.distance(before.last).0),
    };
    let after = State {
        last: inputs.position,
        known: true,
        speed,
    };
    (
        after,
        Outputs {
            position: inputs.position,
            speed,
        },
    )
}
