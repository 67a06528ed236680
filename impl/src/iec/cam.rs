//! Safe cam (SCA): whether the position is within a range. It stops nothing.
//!
//! Positions are those of a line: an endlessly turning shaft is folded before.

use crate::kernel::{ConfigError, Distance, Position};

config! {
    /// The cam.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) lower: Position,
        pub(crate) upper: Position,
        pub(crate) hysteresis: Distance,
    }
}

impl Config {
    /// The cam from `lower` to `upper`, both included. `hysteresis`: so far beyond an end an output of 1 stays.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when `lower` is above `upper` (IEC-MON-011).
    pub const fn new(
        lower: Position,
        upper: Position,
        hysteresis: Distance,
    ) -> Result<Self, ConfigError> {
        if lower.0 > upper.0 {
            return Err(ConfigError::LimitsCrossed);
        }
        Ok(Self {
            lower,
            upper,
            hysteresis,
        })
    }

    /// How far the position is beyond an end; 0 within the range.
    fn beyond(&self, position: Position) -> Distance {
        if position < self.lower {
            position.distance(self.lower)
        } else if position > self.upper {
            position.distance(self.upper)
        } else {
            Distance(0)
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The last output.
        pub on: bool,
    }
}

impl State {
    /// Not known to be within the range.
    pub const INITIAL: Self = Self { on: false };

    /// Every state is possible.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The power has returned.
        pub power_on: bool,
        /// The function is selected.
        pub selected: bool,
        /// The position.
        pub position: Position,
        /// It is valid.
        pub valid: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The shaft is at the cam.
        pub on: bool,
    }
}

/// The position is valid and the function selected.
fn known(s: &Step) -> bool {
    s.inputs.selected && s.inputs.valid
}

/// The position is within the range, widened by this at both ends.
fn within(s: &Step, widened: Distance) -> bool {
    let position = i64::from(s.inputs.position.0);
    let widened = i64::from(widened.0);
    i64::from(s.config.lower.0) - widened <= position
        && position <= i64::from(s.config.upper.0) + widened
}

monitor! { iec::cam;
    /// Within the range, its ends included, the output is 1.
    within_is_one ["IEC-SCA-001", "IEC-MON-003"]:
        when |s| known(&s) && within(&s, Distance(0))
            => s.outputs.on;

    /// An output of 1 stays within the hysteresis.
    hysteresis_holds ["IEC-SCA-002"]:
        when |s| known(&s) && !s.inputs.power_on && s.before.on && within(&s, s.config.hysteresis)
            => s.outputs.on;

    /// Beyond it the output is 0.
    beyond_is_zero ["IEC-SCA-001", "IEC-SCA-002"]:
        when |s| !within(&s, s.config.hysteresis)
            => !s.outputs.on;

    /// Without a valid position, or without selection, it is 0, in the same cycle.
    unknown_is_zero ["IEC-SCA-003", "IEC-MON-002"]:
        when |s| !known(&s)
            => !s.outputs.on;

    /// It becomes 1 only within the range itself.
    rise_wants_the_range ["IEC-SCA-003", "IEC-SCA-001"]:
        when |s| s.outputs.on && !s.before.on
            => within(&s, Distance(0));

    /// What is 1 without a hysteresis is a range with the position in it.
    cam_is_a_range ["IEC-MON-011", "IEC-SCA-001"]:
        when |s| s.outputs.on && s.config.hysteresis == Distance(0)
            => s.config.lower <= s.inputs.position && s.inputs.position <= s.config.upper;

    /// When the power returns nothing is known of the past.
    power_on_forgets ["IEC-MON-010", "IEC-SCA-003"]:
        when |s| s.inputs.power_on && !within(&s, Distance(0))
            => !s.outputs.on;

    /// The output is all that a cam tells: it demands no stop.
    nothing_else_is_told ["IEC-SCA-004"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs == Outputs { on: s.after.on };
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let held = state.on && !inputs.power_on;
    let room = if held { config.hysteresis } else { Distance(0) };
    let on = inputs.selected && inputs.valid && config.beyond(inputs.position) <= room;
    (State { on }, Outputs { on })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(position: i32) -> Inputs {
        Inputs {
            power_on: false,
            selected: true,
            position: Position(position),
            valid: true,
        }
    }

    /// IEC-MON-011; one position is a range.
    #[test]
    fn crossed_ends_are_refused() {
        let new = |lower| Config::new(Position(lower), Position(3), Distance(0));
        assert_eq!(new(4), Err(ConfigError::LimitsCrossed));
        assert!(new(3).is_ok());
    }

    /// IEC-SCA-001 to IEC-SCA-003: 10 to 20, hysteresis 2.
    #[test]
    fn the_shaft_passes_the_cam() {
        let config = Config::new(Position(10), Position(20), Distance(2)).expect("a cam");
        let mut cam = Monitor::new(config);
        let outputs = [8, 9, 10, 8, 7, 9, 20, 22, 23, 22].map(|place| cam.step(&at(place)).on);
        let expected = [
            false, false, true, true, false, false, true, true, false, false,
        ];
        assert_eq!(outputs, expected);
        assert!(cam.step(&at(20)).on);
        let lost = Inputs {
            valid: false,
            ..at(20)
        };
        assert!(!cam.step(&lost).on && !cam.step(&at(21)).on);
    }

    /// The ends of the numbers: nothing wraps.
    #[test]
    fn the_widest_hysteresis() {
        let config = Config::new(Position(i32::MIN), Position(i32::MIN), Distance(u32::MAX));
        let mut cam = Monitor::new(config.expect("a cam"));
        assert!(!cam.step(&at(i32::MAX)).on);
        assert!(cam.step(&at(i32::MIN)).on && cam.step(&at(i32::MAX)).on);
    }
}
