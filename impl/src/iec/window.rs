//! A value stays in a range: SSR (speed), STR (torque), SAR (acceleration), and with a limit of the magnitude SLT and SLA.
//!
//! The value of SAR and SLA is that of [`acceleration`](crate::iec::acceleration), with its validity.

use crate::iec::common::{Value, latch, rises};
use crate::kernel::{ConfigError, Cycles};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) lower: Value,
        pub(crate) upper: Value,
        pub(crate) delay: Cycles,
        pub(crate) tolerance: Cycles,
    }
}

impl Config {
    /// SSR, STR, SAR: the range from `lower` to `upper`, both of either sign. `delay`: from the selection until the function is in
    /// force. `tolerance`: so many consecutive cycles outside are no violation.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when `lower` is above `upper` (IEC-MON-011).
    pub const fn new(
        lower: Value,
        upper: Value,
        delay: Cycles,
        tolerance: Cycles,
    ) -> Result<Self, ConfigError> {
        if lower.get() > upper.get() {
            return Err(ConfigError::LimitsCrossed);
        }
        Ok(Self {
            lower,
            upper,
            delay,
            tolerance,
        })
    }

    /// SLT, SLA: the range from the negative to the positive value of a limit of the magnitude.
    pub const fn limit(magnitude: u32, delay: Cycles, tolerance: Cycles) -> Self {
        Self {
            lower: Value::negative(magnitude),
            upper: Value::positive(magnitude),
            delay,
            tolerance,
        }
    }

    /// The value is within the range, its limits included (IEC-MON-003).
    pub fn within(&self, value: Value) -> bool {
        self.lower <= value && value <= self.upper
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The function was selected.
        pub selected: bool,
        /// What is left of the delay.
        pub left: Cycles,
        /// So many cycles outside were tolerated up to now.
        pub outside: Cycles,
        /// A stop is demanded.
        pub demand: bool,
        /// The acknowledgement was 1.
        pub ack_held: bool,
    }
}

impl State {
    /// Nothing is in force, nothing demanded; an acknowledgement that is 1 is no edge.
    pub const INITIAL: Self = Self {
        selected: false,
        left: Cycles::ZERO,
        outside: Cycles::ZERO,
        demand: false,
        ack_held: true,
    };

    /// A delay runs for a selected function only. Cycles outside are counted while the function is in force and demands nothing, and
    /// no more of them than are tolerated.
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.delay
            && (self.selected || self.left.is_zero())
            && self.outside <= config.tolerance
            && (self.outside.is_zero() || self.selected && self.left.is_zero() && !self.demand)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Inputs {
        /// The power has returned.
        pub power_on: bool,
        /// The function is selected.
        pub selected: bool,
        /// The value.
        pub value: Value,
        /// It is valid.
        pub valid: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The function is in force.
        pub in_force: bool,
        /// It demands a stop.
        pub stop: bool,
        /// The range is kept.
        pub kept: bool,
    }
}

/// The value is valid and within the range.
fn inside(s: &Step) -> bool {
    s.inputs.valid && s.config.within(s.inputs.value)
}

/// A stop was demanded when the cycle began.
fn demanded(s: &Step) -> bool {
    s.before.demand && !s.inputs.power_on
}

/// The acknowledgement has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held && !s.inputs.power_on
}

/// So many cycles outside had been tolerated when the cycle began.
fn tolerated(s: &Step) -> u64 {
    if s.inputs.power_on {
        0
    } else {
        u64::from(s.before.outside.count())
    }
}

monitor! { iec::window;
    /// A selection begins the delay; without one the function is in force in that cycle.
    selection_begins_the_delay ["IEC-MON-001", "IEC-MON-002", "IEC-MON-010"]:
        when |s| s.inputs.selected && (s.inputs.power_on || !s.before.selected)
            => s.after.left == s.config.delay && s.outputs.in_force == s.config.delay.is_zero();

    /// The delay runs to its end, whatever the value; then the function is in force.
    delay_ends ["IEC-MON-001"]:
        when |s| s.inputs.selected && !s.inputs.power_on && s.before.selected
            => s.after.left == s.before.left.tick() && s.outputs.in_force == s.after.left.is_zero();

    /// A function that is not in force judges nothing.
    nothing_is_judged_before ["IEC-MON-001", "IEC-MON-002"]:
        when |s| !s.outputs.in_force
            => !s.outputs.kept && s.after.outside.is_zero() && (!s.outputs.stop || demanded(&s));

    /// A function that is not selected is not in force, in the same cycle, and no delay goes on.
    deselection_is_at_once ["IEC-MON-002"]:
        when |s| !s.inputs.selected
            => !s.outputs.in_force && !s.after.selected && s.after.left.is_zero();

    /// A value equal to a limit is within the range.
    limit_is_within ["IEC-MON-003", "IEC-SSR-001", "IEC-STR-001", "IEC-SAR-001"]:
        when |s| s.outputs.in_force && s.inputs.valid
            && (s.inputs.value == s.config.lower || s.inputs.value == s.config.upper)
            => s.after.outside.is_zero() && s.outputs.kept != s.outputs.stop && (!s.outputs.stop || demanded(&s));

    /// A value outside is counted as long as it is tolerated, then it is a violation, in the same cycle.
    outside_is_a_violation ["IEC-MON-004", "IEC-MON-006", "IEC-SSR-001", "IEC-STR-001", "IEC-SAR-001"]:
        when |s| s.outputs.in_force && s.inputs.valid && !demanded(&s)
            && (s.inputs.value < s.config.lower || s.inputs.value > s.config.upper)
            => !s.outputs.kept && if tolerated(&s) < u64::from(s.config.tolerance.count()) {
                !s.outputs.stop && u64::from(s.after.outside.count()) == tolerated(&s) + 1
            } else {
                s.outputs.stop
            };

    /// A cycle inside begins the count anew.
    inside_begins_anew ["IEC-MON-004"]:
        when |s| inside(&s)
            => s.after.outside.is_zero();

    /// A value that is not valid is a violation at once, whatever is tolerated.
    invalid_is_a_violation ["IEC-MON-005", "IEC-MON-006"]:
        when |s| s.outputs.in_force && !s.inputs.valid
            => s.outputs.stop && !s.outputs.kept;

    /// No stop is demanded without a violation.
    demand_has_a_cause ["IEC-MON-004", "IEC-MON-005", "IEC-MON-006"]:
        when |s| s.outputs.stop && !demanded(&s)
            => s.outputs.in_force && !inside(&s)
                && (!s.inputs.valid || tolerated(&s) >= u64::from(s.config.tolerance.count()));

    /// A demand stays without an edge of this channel's acknowledgement: a level is none, nor is anything else.
    demand_stays ["IEC-MON-006", "IEC-MON-007", "IEC-MON-012"]:
        when |s| demanded(&s) && !acknowledges(&s)
            => s.outputs.stop;

    /// It ends only where this channel's function is not in force, or its own value valid and within the range.
    acknowledged_inside ["IEC-MON-007", "IEC-MON-012"]:
        when |s| demanded(&s) && !s.outputs.stop
            => acknowledges(&s) && (!s.outputs.in_force || inside(&s));

    /// There an edge ends it.
    acknowledgement_is_heard ["IEC-MON-007"]:
        when |s| demanded(&s) && acknowledges(&s) && (!s.outputs.in_force || inside(&s))
            => !s.outputs.stop;

    /// A demand outlives the deselection.
    deselection_is_no_acknowledgement ["IEC-MON-008"]:
        when |s| demanded(&s) && !s.inputs.selected && !acknowledges(&s)
            => s.outputs.stop && s.after.demand;

    /// The range is told to be kept exactly while the function is in force, demands nothing and tolerates nothing.
    kept_is_exact ["IEC-MON-009"]:
        when |s| s.outputs.in_force || s.outputs.kept
            => s.outputs.kept == (s.outputs.in_force && !s.outputs.stop && s.after.outside.is_zero());

    /// What is told to be kept is a range, and the value is in it.
    kept_is_a_range ["IEC-MON-003", "IEC-MON-009", "IEC-MON-011", "IEC-SSR-001", "IEC-STR-001", "IEC-SAR-001"]:
        when |s| s.outputs.kept
            => s.inputs.valid && s.config.lower <= s.inputs.value && s.inputs.value <= s.config.upper;

    /// With a limit of the magnitude both signs have the same limit.
    limit_of_the_magnitude ["IEC-SLT-001", "IEC-SLA-001"]:
        when |s| s.config.lower.get() == -s.config.upper.get() && s.outputs.in_force && s.inputs.valid && !s.outputs.stop
            => s.outputs.kept == (s.inputs.value.get().unsigned_abs() <= s.config.upper.get().unsigned_abs());

    /// When the power returns nothing is demanded but what is violated in that cycle, by a function without a delay.
    power_on_begins ["IEC-MON-010"]:
        when |s| s.inputs.power_on
            => s.outputs.stop == (s.inputs.selected && s.config.delay.is_zero()
                && (!s.inputs.valid || !inside(&s) && s.config.tolerance.is_zero()));

    /// The state stays consistent and remembers the signals.
    state_stays_consistent ["IEC-MON-006", "IEC-MON-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.demand == s.outputs.stop && s.after.ack_held == s.inputs.ack
                && s.after.selected == s.inputs.selected;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let state = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let left = if !inputs.selected {
        Cycles::ZERO
    } else if state.selected {
        state.left.tick()
    } else {
        config.delay
    };
    let in_force = inputs.selected && left.is_zero();
    let inside = inputs.valid && config.within(inputs.value);
    let outside = in_force && !inside;
    let violated = outside && (!inputs.valid || state.outside >= config.tolerance);
    let edge = rises(inputs.ack, state.ack_held);
    let demand = latch(state.demand, violated, edge, !outside);
    let tolerating = outside && !demand;
    let after = State {
        selected: inputs.selected,
        left,
        // A demand ends only with a value inside or a function that is not in force, and both begin anew.
        outside: if tolerating {
            Cycles::new(state.outside.count().saturating_add(1))
        } else {
            Cycles::ZERO
        },
        demand,
        ack_held: inputs.ack,
    };
    let outputs = Outputs {
        in_force,
        stop: demand,
        kept: in_force && !demand && !tolerating,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(value: i32) -> Inputs {
        Inputs {
            power_on: false,
            selected: true,
            value: Value::measured(value),
            valid: true,
            ack: false,
        }
    }

    fn speed_range(delay: u32, tolerance: u32) -> Monitor {
        let config = Config::new(
            Value::measured(-5),
            Value::measured(20),
            Cycles::new(delay),
            Cycles::new(tolerance),
        );
        Monitor::new(config.expect("a range"))
    }

    /// IEC-MON-011; one value is a range.
    #[test]
    fn crossed_limits_are_refused() {
        let new = |lower| {
            let (lower, upper) = (Value::measured(lower), Value::measured(3));
            Config::new(lower, upper, Cycles::ZERO, Cycles::ZERO)
        };
        assert_eq!(new(4), Err(ConfigError::LimitsCrossed));
        assert!(new(3).is_ok());
    }

    /// IEC-SLT-001: also for the greatest limit, and for none.
    #[test]
    fn the_magnitude_has_two_signs() {
        let limit = |magnitude| Config::limit(magnitude, Cycles::ZERO, Cycles::ZERO);
        assert!(limit(u32::MAX).within(Value::difference(i32::MIN, i32::MAX)));
        assert!(limit(0).within(Value::ZERO) && !limit(0).within(Value::measured(-1)));
        assert!(limit(7).within(Value::measured(-7)) && !limit(7).within(Value::measured(-8)));
        assert!(limit(7).accepted() && limit(u32::MAX).accepted());
    }

    /// IEC-MON-001, IEC-MON-002: a delay of 2 cycles, and a new one.
    #[test]
    fn the_delay_counts_from_the_selection() {
        let mut monitor = speed_range(2, 0);
        let off = Inputs {
            selected: false,
            ..at(99)
        };
        for inputs in [at(99), at(99), off, at(99), at(99)] {
            let outputs = monitor.step(&inputs);
            assert!(!outputs.in_force && !outputs.stop);
        }
        assert!(monitor.step(&at(99)).stop);
    }

    /// IEC-MON-004: with a tolerance of 2 the third consecutive cycle is the violation.
    #[test]
    fn the_tolerance_is_consecutive() {
        let mut monitor = speed_range(0, 2);
        let stops = [21, 21, 20, -6, 21, -6].map(|value| monitor.step(&at(value)).stop);
        assert_eq!(stops, [false, false, false, false, false, true]);
    }

    /// IEC-MON-007: neither the level from before the power returned, nor an edge outside.
    #[test]
    fn an_edge_inside_acknowledges() {
        let mut monitor = speed_range(0, 0);
        let back = Inputs {
            power_on: true,
            ack: true,
            ..at(21)
        };
        assert!(monitor.step(&back).stop);
        let held = Inputs {
            ack: true,
            ..at(20)
        };
        assert!(monitor.step(&held).stop);
        assert!(monitor.step(&at(20)).stop);
        assert!(
            monitor
                .step(&Inputs {
                    ack: true,
                    ..at(21)
                })
                .stop
        );
        assert!(monitor.step(&held).stop);
        assert!(monitor.step(&at(20)).stop);
        assert!(monitor.step(&held).kept);
    }
}
