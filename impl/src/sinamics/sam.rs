//! Safe acceleration monitor (SAM) of one channel: while the drive brakes its speed may not rise by more than a tolerance.
//!
//! The limit follows the falling speed and stays where it is when the speed rises. It starts and ends with the stop, in whose first
//! cycle the speed is only taken.
//!
//! Readings: AF-18 and AF-31 are choices of the configuration, the recommended one first.

use crate::kernel::{ConfigError, Speed};
use crate::sinamics::types::Stop;

fields! {
    /// Reading AF-18: what the raised limit of the first cycle is good for.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SamL0 {
        /// The second cycle is compared with it, and no limit is above it.
        #[default]
        InMin,
        /// The second cycle is not compared, its limit is a new one.
        Drop,
    }
}

fields! {
    /// Reading AF-31: what happens below the shutdown speed.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SamBelow {
        /// Nothing is compared, the limit is held and counts again when the speed rises.
        #[default]
        Hold,
        /// The monitor is off for the rest of the stop.
        LatchOff,
    }
}

config! {
    /// The parameters; speeds in increments per cycle of p9500.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        tolerance: Speed,
        ratio: u8,
        shutdown: Speed,
        ssm_limit: Speed,
        fault_stop: Stop,
        l0: SamL0,
        below: SamBelow,
    }
}

impl Config {
    /// `tolerance`: p9548. `ratio`: p9500 / p9511, by which it is greater in the first cycle. `shutdown`: p9568; where it is 0
    /// `ssm_limit`, p9546, counts (S120-SSM-007). `fault_stop`: p9516.4, the stop of a failed encoder.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] when the ratio is 0, [`ConfigError::StopNotAllowed`] when a failed encoder raises
    /// neither STOP A nor STOP B (S120-SAM-007).
    pub const fn new(
        tolerance: Speed,
        ratio: u8,
        shutdown: Speed,
        ssm_limit: Speed,
        fault_stop: Stop,
        l0: SamL0,
        below: SamBelow,
    ) -> Result<Self, ConfigError> {
        if ratio == 0 {
            return Err(ConfigError::FactorOutOfRange);
        }
        if !fault_stop.allowed(false) {
            return Err(ConfigError::StopNotAllowed);
        }
        Ok(Self {
            tolerance,
            ratio,
            shutdown,
            ssm_limit,
            fault_stop,
            l0,
            below,
        })
    }

    /// Below this speed nothing is compared: p9568, or p9546 where that is 0 (S120-SAM-002, S120-SSM-007).
    pub const fn threshold(&self) -> Speed {
        if self.shutdown.0 == 0 {
            self.ssm_limit
        } else {
            self.shutdown
        }
    }

    /// The limit of the first cycle: the tolerance counts once for each acquisition of an actual value (S120-SAM-004).
    pub const fn first(&self, speed: Speed) -> Speed {
        let raised = self.tolerance.0.saturating_mul(self.ratio as u32);
        Speed(speed.0.saturating_add(raised))
    }

    /// The limit of every other cycle, where the one before is not lower.
    const fn next(&self, speed: Speed) -> Speed {
        Speed(speed.0.saturating_add(self.tolerance.0))
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The drive brakes.
        pub on: bool,
        /// The limit is that of the first cycle.
        pub first: bool,
        /// The monitor is off for the rest of the stop.
        pub off: bool,
        /// The limit; 0 while nothing is monitored.
        pub limit: Speed,
    }
}

impl State {
    /// Nothing is monitored.
    pub const INITIAL: Self = Self {
        on: false,
        first: false,
        off: false,
        limit: Speed(0),
    };

    /// Nothing is kept beyond a stop; the monitor goes off by its own reading only.
    pub fn invariant(&self, config: &Config) -> bool {
        if self.on {
            (!self.off || config.below == SamBelow::LatchOff) && self.limit >= config.next(Speed(0))
        } else {
            *self == Self::INITIAL
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SS1, SS2, STOP B or STOP C brakes, and SAM is what monitors it.
        pub braking: bool,
        /// Magnitude of the actual speed.
        pub speed: Speed,
        /// The only encoder has failed: there is no speed to be monitored.
        pub encoder_fault: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is above the limit: C01706.
        pub violated: bool,
        /// The stop that is raised.
        pub demand: Stop,
        /// The limit of the next cycle; 0 while nothing is monitored.
        pub limit: Speed,
    }
}

/// The comparison is suspended: too slow, or off.
fn suspended(s: &Step) -> bool {
    s.inputs.speed < s.config.threshold() || s.before.off
}

/// The cycle is compared with the limit of the one before.
fn compared(s: &Step) -> bool {
    s.before.on
        && s.inputs.braking
        && !s.inputs.encoder_fault
        && !suspended(s)
        && !(s.before.first && s.config.l0 == SamL0::Drop)
}

monitor! { sinamics::sam;
    /// A speed above the limit of the cycle before is STOP A in the same cycle.
    rise_is_stop_a ["S120-SAM-003", "S120-SAM-005", "S120-PF-17"]:
        when |s| compared(&s) && s.inputs.speed > s.before.limit
            => s.outputs.violated && s.outputs.demand == Stop::A;

    /// The limit itself is no violation, and where nothing is compared there is none.
    limit_is_kept ["S120-SAM-003"]:
        when |s| !compared(&s) || s.inputs.speed <= s.before.limit
            => !s.outputs.violated && (s.outputs.demand == Stop::None || s.inputs.encoder_fault);

    /// The first cycle takes the speed with the raised tolerance, and compares nothing.
    first_cycle_is_raised ["S120-SAM-002", "S120-SAM-004"]:
        when |s| !s.before.on && s.inputs.braking && !s.inputs.encoder_fault
            => s.after.limit == s.config.first(s.inputs.speed) && s.after.on && !s.outputs.violated;

    /// The limit never rises.
    limit_never_rises ["S120-SAM-003", "S120-PF-17"]:
        when |s| s.before.on && s.after.on && !(s.before.first && s.config.l0 == SamL0::Drop)
            => s.after.limit <= s.before.limit;

    /// It follows the falling speed by the tolerance.
    limit_follows ["S120-SAM-003"]:
        when |s| compared(&s) && !s.outputs.violated
            => u64::from(s.after.limit.0)
                <= u64::from(s.inputs.speed.0) + u64::from(s.config.tolerance.0);

    /// It falls no faster than that, and is held where nothing is compared.
    limit_falls_with_the_speed_only ["S120-SAM-003", "S120-SAM-008"]:
        when |s| s.before.on && s.after.on && s.after.limit < s.before.limit
            => u64::from(s.after.limit.0) == u64::from(s.inputs.speed.0) + u64::from(s.config.tolerance.0)
                && !suspended(&s);

    /// Below the shutdown speed nothing is compared.
    slow_axis_is_left_alone ["S120-SAM-002", "S120-SAM-008", "S120-SSM-007"]:
        when |s| s.inputs.speed < s.config.threshold()
            => !s.outputs.violated;

    /// Above it the held limit counts again (AF-31), or the monitor stays off.
    faster_axis_is_compared_again ["S120-SAM-008"]:
        when |s| s.before.on && s.after.on && !s.inputs.encoder_fault && s.inputs.speed < s.config.threshold()
            => s.after.limit == s.before.limit && s.after.off == (s.config.below == SamBelow::LatchOff);

    /// The shutdown speed is p9568, or p9546 where that is 0.
    threshold_is_one_of_two ["S120-SSM-007", "S120-SAM-002"]:
        when |s| s.inputs.braking
            => if s.config.shutdown == Speed(0) {
                s.config.threshold() == s.config.ssm_limit
            } else {
                s.config.threshold() == s.config.shutdown
            };

    /// Without its encoder the monitor is off; a stop of category 0 or 1 takes its place.
    failed_encoder_is_a_stop ["S120-SAM-007"]:
        when |s| s.inputs.braking && s.inputs.encoder_fault
            => !s.outputs.violated && s.outputs.demand == s.config.fault_stop && s.outputs.demand >= Stop::B;

    /// Without braking nothing is monitored, and nothing kept.
    no_braking_no_monitor ["S120-SAM-002"]:
        when |s| !s.inputs.braking
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// The state stays consistent.
    state_stays_consistent ["S120-SAM-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.limit == s.after.limit;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.braking || inputs.encoder_fault {
        let demand = if inputs.braking {
            config.fault_stop
        } else {
            Stop::None
        };
        let outputs = Outputs {
            demand,
            ..Outputs::default()
        };
        return (State::INITIAL, outputs);
    }
    let slow = inputs.speed < config.threshold();
    let off = config.below == SamBelow::LatchOff && (state.off || slow);
    let (limit, violated) = if !state.on {
        (config.first(inputs.speed), false)
    } else if slow || off {
        (state.limit, false)
    } else if state.first && config.l0 == SamL0::Drop {
        (config.next(inputs.speed), false)
    } else {
        let followed = config.next(inputs.speed).min(state.limit);
        (followed, inputs.speed > state.limit)
    };
    let after = State {
        on: true,
        first: !state.on,
        off,
        limit,
    };
    let outputs = Outputs {
        violated,
        demand: if violated { Stop::A } else { Stop::None },
        limit,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(tolerance: u32, ratio: u8) -> Config {
        Config::new(
            Speed(tolerance),
            ratio,
            Speed(10),
            Speed(0),
            Stop::A,
            SamL0::InMin,
            SamBelow::Hold,
        )
        .expect("accepted")
    }

    /// S120-SAM-004, the example of the manual: 12 ms / 1 ms, 300 rpm, 250 rpm give about 3850 rpm.
    #[test]
    fn the_printed_example() {
        assert_eq!(config(300, 12).first(Speed(250)), Speed(3850));
    }

    /// S120-SAM-003: the limit follows the falling speed, a rise up to it is tolerated, one more is STOP A.
    #[test]
    fn the_limit_follows() {
        let mut monitor = Monitor::new(config(300, 12));
        let mut step = |speed| {
            monitor.step(&Inputs {
                braking: true,
                speed: Speed(speed),
                encoder_fault: false,
            })
        };
        assert_eq!(step(1000).limit, Speed(4600));
        assert_eq!(step(900).limit, Speed(1200));
        assert_eq!(step(1200).limit, Speed(1200));
        assert_eq!(step(500).limit, Speed(800));
        assert!(!step(800).violated);
        assert_eq!(step(801).demand, Stop::A);
    }
}
