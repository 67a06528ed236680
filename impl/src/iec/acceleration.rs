//! The acceleration that SAR and SLA look at: the speed of a cycle less that of the cycle before.
//!
//! It is exact for every pair of speeds: nothing wraps and nothing is cut. Where it is not valid, it is 0, and
//! [`window`](crate::iec::window) takes it for a violation.

use crate::iec::common::Value;

config! {
    /// Nothing is set.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The speed of the cycle before, where it was valid.
        pub last: Option<i32>,
    }
}

impl State {
    /// No speed is known.
    pub const INITIAL: Self = Self { last: None };

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
        /// The speed.
        pub speed: i32,
        /// It is valid.
        pub valid: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Outputs {
        /// The acceleration; 0 where it is not valid.
        pub acceleration: Value,
        /// It is valid.
        pub valid: bool,
    }
}

/// The speed that was known when the cycle began.
fn last(s: &Step) -> Option<i32> {
    if s.inputs.power_on {
        None
    } else {
        s.before.last
    }
}

monitor! { iec::acceleration;
    /// Two valid speeds give their difference, exactly.
    difference_is_exact ["IEC-ACC-001", "IEC-SAR-001", "IEC-SLA-001"]:
        when |s| s.inputs.valid && last(&s).is_some()
            => s.outputs.valid
                && last(&s).is_some_and(|last| s.outputs.acceleration.get() + i64::from(last) == i64::from(s.inputs.speed));

    /// A speed that falls is a negative acceleration, in either direction of the motion.
    falling_is_negative ["IEC-ACC-001", "IEC-SAR-001"]:
        when |s| s.outputs.valid && last(&s).is_some_and(|last| last > s.inputs.speed)
            => s.outputs.acceleration < Value::ZERO;

    /// Nothing is valid but what two valid speeds in a row give.
    first_speed_gives_none ["IEC-ACC-002", "IEC-MON-010"]:
        when |s| !s.inputs.valid || last(&s).is_none()
            => !s.outputs.valid && s.outputs.acceleration == Value::ZERO;

    /// A valid speed is that before the next cycle.
    speed_is_remembered ["IEC-ACC-001"]:
        when |s| s.inputs.valid
            => s.after.last == Some(s.inputs.speed);

    /// A speed that is not valid is none, and those from before it are forgotten.
    gap_forgets ["IEC-ACC-002"]:
        when |s| !s.inputs.valid
            => s.after.last.is_none();
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let last = if inputs.power_on { None } else { state.last };
    let acceleration = match last {
        Some(last) if inputs.valid => Some(Value::difference(inputs.speed, last)),
        _ => None,
    };
    let after = State {
        last: inputs.valid.then_some(inputs.speed),
    };
    let outputs = Outputs {
        acceleration: acceleration.unwrap_or(Value::ZERO),
        valid: acceleration.is_some(),
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IEC-ACC-001, IEC-ACC-002: the widest differences; a gap, and the power.
    #[test]
    fn differences_have_33_bits() {
        let mut monitor = Monitor::new(Config);
        let mut step = |power_on, speed, valid| {
            let outputs = monitor.step(&Inputs {
                power_on,
                speed,
                valid,
            });
            outputs.valid.then_some(outputs.acceleration.get())
        };
        assert_eq!(step(false, i32::MIN, true), None);
        assert_eq!(step(false, i32::MAX, true), Some(4_294_967_295));
        assert_eq!(step(false, i32::MIN, true), Some(-4_294_967_295));
        assert_eq!(step(false, 5, false), None);
        assert_eq!(step(false, 5, true), None);
        assert_eq!(step(false, 3, true), Some(-2));
        assert_eq!(step(true, 3, true), None);
        assert_eq!(step(false, 3, true), Some(0));
    }
}
