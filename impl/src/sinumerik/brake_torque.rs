//! Torque limits of a brake test (machine `brake_torque`).
//!
//! The torque that holds the axis is measured when the test is selected. The drive adds what is missing to the required
//! torque; its limits lie symmetrically around the parameterised weight, or around the measured torque (S840D-BRAKE-704).
//! All torques have one unit, for instance tenths of a percent of the rated torque, and are positive in the direction of the
//! load: on an axis whose weight is parameterised as negative the signs are turned around.
//!
//! A required torque that is not above the measured one is refused too: the manual names it as the remedy, not as a cause.

use crate::kernel::ConfigError;

config! {
    /// The torques of the axis.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        required: u16,
        weight: u16,
        motor_max: u16,
        deviation: u16,
        automatic: bool,
    }
}

impl Config {
    /// `required`: what the brake must hold in all (SAFE_BRAKETEST_TORQUE). `weight`: the parameterised weight
    /// (FORCE_LIMIT_WEIGHT). `motor_max`: the most that the motor adds. `deviation`: 5 %, how far the measured torque may be
    /// from the weight in both directions of the test. `automatic`: bit 0 of SAFE_BRAKETEST_CONTROL.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] for a weight above 1000 or a required torque above 8000: 100 % and 800 % in tenths.
    pub const fn new(
        required: u16,
        weight: u16,
        motor_max: u16,
        deviation: u16,
        automatic: bool,
    ) -> Result<Self, ConfigError> {
        if required > 8000 || weight > 1000 {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self {
            required,
            weight,
            motor_max,
            deviation,
            automatic,
        })
    }

    /// What the brake is to bear with this torque of the load: the required torque, or less where the motor cannot add it.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn borne(&self, measured: i16) -> i32 {
        (i32::from(self.required)).min(i32::from(measured) + i32::from(self.motor_max))
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Lower torque limit of the drive.
        pub lower: i32,
        /// Upper torque limit of the drive.
        pub upper: i32,
        /// The test must go in the direction of the load.
        pub along: bool,
    }
}

impl State {
    /// Nothing measured.
    pub const INITIAL: Self = Self {
        lower: 0,
        upper: 0,
        along: false,
    };

    /// The state is what was measured last, which may be anything.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The test is selected in this cycle.
        pub measure: bool,
        /// Torque that holds the axis.
        pub measured: i16,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Alarm 20095: the torque cannot be had with these parameters.
        pub unattainable: bool,
    }
}

monitor! { sinumerik::brake_torque;
    /// In the direction of the load the brake bears the required torque, whatever the load is.
    brake_bears_what_is_required ["S840D-BRAKE-702", "S840D-BRAKE-704", "S840D-PARAM-036/a"]:
        when |s| s.inputs.measure && !s.outputs.unattainable
            => i32::from(s.inputs.measured) - s.after.lower == s.config.borne(s.inputs.measured);

    /// The limits lie symmetrically around the weight.
    limits_lie_around_the_weight ["S840D-BRAKE-702"]:
        when |s| s.inputs.measure && !s.outputs.unattainable && !s.config.automatic
            => s.after.lower + s.after.upper == 2 * i32::from(s.config.weight);

    /// With the weight as it was measured the torque limit is the required torque.
    limit_is_the_required_torque ["S840D-BRAKE-702"]:
        when |s| s.inputs.measure && !s.outputs.unattainable && i32::from(s.inputs.measured) == i32::from(s.config.weight)
            && s.config.borne(s.inputs.measured) == i32::from(s.config.required)
            => s.after.upper - i32::from(s.config.weight) == i32::from(s.config.required);

    /// A drive that could not hold the axis with its limit is found when the test is selected.
    drive_can_hold_the_axis ["S840D-BRAKE-703", "S840D-PARAM-036/b"]:
        when |s| s.inputs.measure && !s.outputs.unattainable && !s.config.automatic
            => s.after.upper >= i32::from(s.inputs.measured) && i32::from(s.config.required) > i32::from(s.inputs.measured);

    /// And nothing else is refused.
    refused_for_a_reason ["S840D-BRAKE-703", "S840D-PARAM-036/b"]:
        when |s| s.outputs.unattainable
            => s.inputs.measure && !s.config.automatic && (i32::from(s.config.required) <= i32::from(s.inputs.measured)
                || 2 * i32::from(s.config.weight) + s.config.borne(s.inputs.measured) < 2 * i32::from(s.inputs.measured));

    /// A refused test has no limits.
    refused_has_no_limits ["S840D-BRAKE-703"]:
        when |s| s.outputs.unattainable
            => s.after == State::INITIAL;

    /// Around the measured torque nothing is refused, and both directions load the brake alike.
    automatic_needs_no_weight ["S840D-BRAKE-704"]:
        when |s| s.inputs.measure && s.config.automatic
            => !s.outputs.unattainable && !s.after.along
                && s.after.upper - i32::from(s.inputs.measured) == i32::from(s.inputs.measured) - s.after.lower;

    /// A load that is not the parameterised one wants the test in its direction.
    other_load_wants_its_direction ["S840D-BRAKE-705"]:
        when |s| s.inputs.measure && !s.outputs.unattainable && !s.config.automatic
            => s.after.along == ((i32::from(s.inputs.measured) - i32::from(s.config.weight)).abs() > i32::from(s.config.deviation));

    /// Between the selections nothing changes: the limits are those of the test.
    limits_are_kept ["S840D-BRAKE-702"]:
        when |s| !s.inputs.measure
            => s.after == s.before && !s.outputs.unattainable;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.measure {
        return (
            state,
            Outputs {
                unattainable: false,
            },
        );
    }
    let load = i32::from(inputs.measured);
    let middle = if config.automatic {
        load
    } else {
        i32::from(config.weight)
    };
    // Against the weight the drive gives `added`; the same distance from the middle the other way round.
    let added = (i32::from(config.required) - load).min(i32::from(config.motor_max));
    let (lower, upper) = (-added, 2 * middle + added);
    let holds = upper >= load && load < i32::from(config.required);
    if !holds && !config.automatic {
        return (State::INITIAL, Outputs { unattainable: true });
    }
    let after = State {
        lower,
        upper,
        along: load.abs_diff(middle) > u32::from(config.deviation),
    };
    (
        after,
        Outputs {
            unattainable: false,
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10.9.2: a weight of 32 %, a brake that must hold 6000 N where the axis weighs 4000 N. S840D-BRAKE-702.
    #[test]
    fn the_printed_example() {
        let required = u16::try_from(320_u32 * 6000 / 4000).expect("small");
        assert_eq!(required, 480);
        let config = Config::new(required, 320, 1000, 50, false).expect("in range");
        let inputs = Inputs {
            measure: true,
            measured: 320,
        };
        let (after, outputs) = next(State::INITIAL, &config, &inputs);
        assert!(!outputs.unattainable && !after.along);
        assert_eq!((after.lower, after.upper), (-160, 800));
    }

    /// 10.9.6: the weight is parameterised much too low. S840D-BRAKE-703.
    #[test]
    fn a_weight_far_too_low_is_refused() {
        let config = Config::new(480, 50, 1000, 50, false).expect("in range");
        let inputs = Inputs {
            measure: true,
            measured: 320,
        };
        let (_, outputs) = next(State::INITIAL, &config, &inputs);
        assert!(outputs.unattainable);
        let automatic = Config::new(480, 50, 1000, 50, true).expect("in range");
        let (after, outputs) = next(State::INITIAL, &automatic, &inputs);
        assert!(!outputs.unattainable);
        assert_eq!((after.lower, after.upper), (-160, 800));
    }

    #[test]
    fn torques_out_of_range_are_refused() {
        let out = Err(ConfigError::ValueOutOfRange);
        assert_eq!(Config::new(8001, 0, 0, 0, false), out);
        assert_eq!(Config::new(0, 1001, 0, 0, false), out);
    }
}
