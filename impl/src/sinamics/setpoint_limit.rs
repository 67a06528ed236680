//! Setpoint limit r9733: what the safety functions leave of the speed setpoint, for the ramp-function generator or the control.
//!
//! The limit is no safety function: it keeps the drive from what the monitors would stop. Both directions are told as magnitudes;
//! r9733\[1\] is the negative of `negative`. Without a function there is no limit.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Percent, Speed};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        factor: Percent,
        motor: u16,
        load: u16,
        none_during_stop_f: bool,
    }
}

impl Config {
    /// `factor`: p9533. `motor`, `load`: the speed of the motor for one of the load, as the quotient of p9522 and p9521, for a linear
    /// axis with the spindle pitch p9520. `none_during_stop_f`: p9507.1.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] when a part of the quotient is 0.
    pub const fn new(
        factor: Percent,
        motor: u16,
        load: u16,
        none_during_stop_f: bool,
    ) -> Result<Self, ConfigError> {
        if motor == 0 || load == 0 {
            return Err(ConfigError::FactorOutOfRange);
        }
        Ok(Self {
            factor,
            motor,
            load,
            none_during_stop_f,
        })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SLS is selected; its limit of the selected level counts at once.
        pub sls: bool,
        /// That limit, of the load.
        pub limit: Speed,
        /// SDI positive is selected.
        pub sdi_positive: bool,
        /// SDI negative is selected.
        pub sdi_negative: bool,
        /// The acceptance test mode removes all limits.
        pub acceptance: bool,
        /// The reaction to a STOP F runs.
        pub stop_f: bool,
    }
}

fields! {
    /// The outputs of one cycle: magnitudes of speeds of the motor; the greatest number is no limit.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// r9733\[0\].
        pub positive: Speed,
        /// The magnitude of r9733\[1\].
        pub negative: Speed,
        /// r9733\[2\]: the greater of both, for S_V_LIMIT_B.
        pub absolute: Speed,
    }
}

/// No limit.
pub const UNLIMITED: Speed = Speed(u32::MAX);

/// Something removes or zeroes the limits, whatever is selected.
fn overruled(s: &Step) -> bool {
    s.inputs.acceptance || s.inputs.stop_f && s.config.none_during_stop_f
}

monitor! { sinamics::setpoint_limit;
    /// The limit is p9533 percent of that of SLS, on the side of the motor, and never above it.
    limit_is_a_part_of_sls ["S120-SLS-008"]:
        when |s| s.inputs.sls && !overruled(&s) && !s.inputs.sdi_negative
            => {
                let exact = u128::from(s.inputs.limit.0) * u128::from(s.config.factor.get()) * u128::from(s.config.motor);
                let unit = 100 * u128::from(s.config.load);
                u128::from(s.outputs.positive.0) * unit <= exact
                    && (s.outputs.positive == UNLIMITED
                        || exact < (u128::from(s.outputs.positive.0) + 1) * unit + u128::from(s.config.motor) * 100)
            };

    /// Both directions have the same.
    directions_are_even ["S120-SLS-008"]:
        when |s| s.inputs.sdi_positive == s.inputs.sdi_negative
            => s.outputs.positive == s.outputs.negative;

    /// SDI leaves nothing of the direction that it blocks.
    blocked_direction_is_zero ["S120-SDI-005"]:
        when |s| (s.inputs.sdi_positive || s.inputs.sdi_negative) && !overruled(&s)
            => (!s.inputs.sdi_positive || s.outputs.negative == Speed(0))
                && (!s.inputs.sdi_negative || s.outputs.positive == Speed(0));

    /// Without SLS the other one is not limited.
    nothing_else_limits ["S120-SLS-008", "S120-SDI-005"]:
        when |s| !s.inputs.sls && !overruled(&s)
            => (s.inputs.sdi_negative || s.outputs.positive == UNLIMITED)
                && (s.inputs.sdi_positive || s.outputs.negative == UNLIMITED);

    /// The absolute limit is the greater of both.
    absolute_is_the_greater ["S120-SDI-005", "S120-SLS-008"]:
        when |s| s.outputs.positive != s.outputs.negative
            => s.outputs.absolute >= s.outputs.positive && s.outputs.absolute >= s.outputs.negative
                && (s.outputs.absolute == s.outputs.positive || s.outputs.absolute == s.outputs.negative);

    /// The acceptance test mode removes all three.
    acceptance_removes_all ["S120-SLS-008"]:
        when |s| s.inputs.acceptance
            => s.outputs == Outputs { positive: UNLIMITED, negative: UNLIMITED, absolute: UNLIMITED };

    /// With p9507.1 a STOP F leaves nothing.
    stop_f_leaves_nothing ["S120-REACT-001"]:
        when |s| s.inputs.stop_f && s.config.none_during_stop_f && !s.inputs.acceptance
            => s.outputs == Outputs::default();
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let sls = if inputs.acceptance || !inputs.sls {
        UNLIMITED
    } else {
        let load = inputs.limit.reduced(config.factor);
        let motor = u64::from(load.0) * u64::from(config.motor) / u64::from(config.load.max(1));
        Speed(u32::try_from(motor).unwrap_or(u32::MAX))
    };
    let nothing = inputs.stop_f && config.none_during_stop_f;
    let side = |blocked: bool| {
        if !inputs.acceptance && (blocked || nothing) {
            Speed(0)
        } else {
            sls
        }
    };
    let (positive, negative) = (side(inputs.sdi_negative), side(inputs.sdi_positive));
    let outputs = Outputs {
        positive,
        negative,
        absolute: positive.max(negative),
    };
    (state, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SLS-008: 2000 (Table A-5) at 80 % and a gear of 3 to 2; p9533 = 0, the value of the table, leaves nothing.
    #[test]
    fn limits_on_the_side_of_the_motor() {
        for (percent, expected) in [(80, 2400), (0, 0)] {
            let factor = Percent::new(percent).expect("at most 100");
            let config = Config::new(factor, 3, 2, false).expect("accepted");
            let outputs = Monitor::new(config).step(&Inputs {
                sls: true,
                limit: Speed(2000),
                sdi_positive: true,
                ..Inputs::default()
            });
            assert_eq!(outputs.positive, Speed(expected));
            assert_eq!(
                (outputs.negative, outputs.absolute),
                (Speed(0), Speed(expected))
            );
        }
    }
}
