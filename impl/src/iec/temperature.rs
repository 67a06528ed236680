//! Safe motor temperature (SMT).
//!
//! A hysteresis that leads below the lowest temperature is accepted: the demand of a function that stays selected then never ends.
//! The warning asks for no selection (IEC-SMT-003).

use crate::iec::common::{latch, rises};
use crate::kernel::ConfigError;

config! {
    /// The parameters, in the unit of the temperature.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) limit: i32,
        pub(crate) warning: i32,
        pub(crate) hysteresis: u32,
    }
}

impl Config {
    /// `limit`: the highest temperature of the motor. `warning`: from here on the function warns. `hysteresis`: so far below the
    /// limit the motor must have cooled down.
    ///
    /// # Errors
    /// [`ConfigError::LimitsCrossed`] when the warning threshold is above the limit (IEC-SMT-005).
    pub const fn new(limit: i32, warning: i32, hysteresis: u32) -> Result<Self, ConfigError> {
        if warning > limit {
            return Err(ConfigError::LimitsCrossed);
        }
        Ok(Self {
            limit,
            warning,
            hysteresis,
        })
    }

    /// The temperature is below the limit by the hysteresis at least.
    const fn cooled(&self, temperature: i32) -> bool {
        temperature as i64 + self.hysteresis as i64 <= self.limit as i64
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// A stop is demanded.
        pub demand: bool,
        /// The acknowledgement was 1.
        pub ack_held: bool,
    }
}

impl State {
    /// Nothing is demanded; an acknowledgement that is 1 is no edge.
    pub const INITIAL: Self = Self {
        demand: false,
        ack_held: true,
    };

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
        /// The temperature of the motor.
        pub temperature: i32,
        /// A wire of the sensor is broken.
        pub wire_broken: bool,
        /// The sensor is short-circuited.
        pub short_circuit: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

impl Inputs {
    /// The temperature is that of the motor.
    pub const fn valid(&self) -> bool {
        !self.wire_broken && !self.short_circuit
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The function demands a stop.
        pub stop: bool,
        /// It warns.
        pub warning: bool,
    }
}

/// A stop was demanded when the cycle began.
fn demanded(s: &Step) -> bool {
    s.before.demand && !s.inputs.power_on
}

/// The acknowledgement has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held && !s.inputs.power_on
}

/// An acknowledgement may end a demand.
fn ready(s: &Step) -> bool {
    let below = i64::from(s.config.limit) - i64::from(s.inputs.temperature);
    !s.inputs.selected || s.inputs.valid() && below >= i64::from(s.config.hysteresis)
}

monitor! { iec::temperature;
    /// A temperature above the limit is a violation in the same cycle.
    hot_motor_is_stopped ["IEC-SMT-001", "IEC-MON-006"]:
        when |s| s.inputs.selected && s.inputs.temperature > s.config.limit
            => s.outputs.stop;

    /// A valid temperature up to the limit, the limit included, is none.
    limit_is_within ["IEC-SMT-001", "IEC-MON-003"]:
        when |s| s.inputs.valid() && s.inputs.temperature <= s.config.limit && !demanded(&s)
            => !s.outputs.stop;

    /// A broken wire and a short circuit are violations in the same cycle, whatever the temperature.
    sensor_is_watched ["IEC-SMT-002", "IEC-MON-005", "IEC-MON-006"]:
        when |s| s.inputs.selected && (s.inputs.wire_broken || s.inputs.short_circuit)
            => s.outputs.stop;

    /// A function that is not selected judges nothing, in the same cycle.
    deselection_is_at_once ["IEC-SMT-001", "IEC-SMT-002", "IEC-MON-002"]:
        when |s| !s.inputs.selected && !demanded(&s)
            => !s.outputs.stop;

    /// From the threshold on, and without a valid temperature, the function warns.
    warning_comes ["IEC-SMT-003"]:
        when |s| !s.inputs.valid() || s.inputs.temperature >= s.config.warning
            => s.outputs.warning;

    /// The warning ends by itself.
    warning_ends ["IEC-SMT-003"]:
        when |s| s.inputs.valid() && s.inputs.temperature < s.config.warning
            => !s.outputs.warning;

    /// A demand stays without an edge of this channel's acknowledgement.
    demand_stays ["IEC-SMT-004", "IEC-MON-006", "IEC-MON-007", "IEC-MON-012"]:
        when |s| demanded(&s) && !acknowledges(&s)
            => s.outputs.stop;

    /// It ends only below the limit by the hysteresis, or without selection.
    acknowledged_when_cool ["IEC-SMT-004", "IEC-MON-012"]:
        when |s| demanded(&s) && !s.outputs.stop
            => acknowledges(&s) && ready(&s);

    /// There an edge ends it.
    acknowledgement_is_heard ["IEC-SMT-004"]:
        when |s| demanded(&s) && acknowledges(&s) && ready(&s)
            => !s.outputs.stop;

    /// A demand outlives the deselection.
    deselection_is_no_acknowledgement ["IEC-MON-008", "IEC-SMT-004"]:
        when |s| demanded(&s) && !s.inputs.selected && !acknowledges(&s)
            => s.outputs.stop && s.after.demand;

    /// No stop comes without a warning: the threshold is not above the limit.
    warned_before ["IEC-SMT-005", "IEC-SMT-003"]:
        when |s| s.outputs.stop && !demanded(&s)
            => s.outputs.warning;

    /// When the power returns nothing is demanded but what is violated in that cycle.
    power_on_begins ["IEC-MON-010"]:
        when |s| s.inputs.power_on
            => s.outputs.stop == (s.inputs.selected && (!s.inputs.valid() || s.inputs.temperature > s.config.limit));

    /// The state is the demand, and remembers the acknowledgement.
    state_stays_consistent ["IEC-MON-006", "IEC-MON-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after == State { demand: s.outputs.stop, ack_held: s.inputs.ack };
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let state = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let valid = inputs.valid();
    let violated = inputs.selected && (!valid || inputs.temperature > config.limit);
    let ready = !inputs.selected || valid && config.cooled(inputs.temperature);
    let edge = rises(inputs.ack, state.ack_held);
    let demand = latch(state.demand, violated, edge, ready);
    let after = State {
        demand,
        ack_held: inputs.ack,
    };
    let outputs = Outputs {
        stop: demand,
        warning: !valid || inputs.temperature >= config.warning,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(temperature: i32) -> Inputs {
        Inputs {
            selected: true,
            temperature,
            ..Inputs::default()
        }
    }

    /// IEC-SMT-005; equal ones are accepted.
    #[test]
    fn a_warning_above_the_limit_is_refused() {
        assert_eq!(Config::new(120, 121, 5), Err(ConfigError::LimitsCrossed));
        assert!(Config::new(120, 120, 5).is_ok());
    }

    /// IEC-SMT-001, IEC-SMT-004: 121 is above, 110 is below by 10, 111 is not.
    #[test]
    fn a_motor_cools_down() {
        let config = Config::new(120, 100, 10).expect("accepted");
        let mut monitor = Monitor::new(config);
        assert!(!monitor.step(&at(120)).stop);
        assert!(monitor.step(&at(121)).stop);
        for (temperature, stop) in [(111, true), (110, false)] {
            assert!(monitor.step(&at(temperature)).stop);
            let acknowledged = Inputs {
                ack: true,
                ..at(temperature)
            };
            let outputs = monitor.step(&acknowledged);
            assert_eq!((outputs.stop, outputs.warning), (stop, true));
        }
    }

    /// IEC-SMT-004 at the ends of the numbers: nothing wraps.
    #[test]
    fn the_hysteresis_does_not_wrap() {
        let config = |limit, hysteresis| Config::new(limit, limit, hysteresis).expect("accepted");
        assert!(!config(i32::MIN, 1).cooled(i32::MIN) && config(i32::MIN, 0).cooled(i32::MIN));
        assert!(config(i32::MAX, u32::MAX).cooled(i32::MIN));
        assert!(!config(i32::MAX, u32::MAX).cooled(i32::MIN + 1));
    }
}
