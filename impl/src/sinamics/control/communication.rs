//! Supervision of the PROFIsafe communication, or of the DRIVE-CLiQ to the TM54F: watchdog, reaction, substitute values, ESR.
//!
//! Without a valid telegram within F_WD_Time the communication has failed: substitute values, all 0, select everything, and the
//! drive is stopped by STOP A, or by STOP B with p9612 = 1. With ESR the drive gets p9580 for it, if every active function has a
//! stop with delayed pulse cancellation; then comes STOP A in any case. Renewed communication alone ends nothing.
//!
//! Readings: AC-21 COMM_LATCH, AC-27 NOESR_PULSES.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::level::Stop;

/// The longest delay of the pulse cancellation, p9580, in ms (S120-STOP-518).
pub const LONGEST_ESR_MS: u32 = 800;

/// The range of F_WD_Time in ms (S120-PSAFE-505).
pub const WATCHDOG_MS: core::ops::RangeInclusive<u32> = 10..=65_535;

config! {
    /// The times in cycles and the reaction.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) watchdog: Cycles,
        pub(crate) esr: Cycles,
        pub(crate) profisafe: bool,
        pub(crate) stop_b: bool,
    }
}

impl Config {
    /// `watchdog`: the cycles without a telegram after which the communication has failed. `esr`: p9580, 0 without ESR.
    /// `profisafe`: PROFIsafe, else TM54F. `stop_b`: p9612 = 1, of no effect for a TM54F (S120-COMM-507).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when the watchdog has no cycle.
    pub const fn new(
        watchdog: Cycles,
        esr: Cycles,
        profisafe: bool,
        stop_b: bool,
    ) -> Result<Self, ConfigError> {
        if watchdog.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            watchdog,
            esr,
            profisafe,
            stop_b,
        })
    }

    /// The same from the times in ms, rounded down: the reaction is never later than they say.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] for F_WD_Time outside [`WATCHDOG_MS`], [`ConfigError::DelayTooLong`] for p9580 above
    /// [`LONGEST_ESR_MS`] (S120-STOP-518); those of [`Config::new`].
    pub fn from_millis(
        watchdog_ms: u32,
        esr_ms: u32,
        profisafe: bool,
        stop_b: bool,
        cycle_us: NonZeroU32,
    ) -> Result<Self, ConfigError> {
        if !WATCHDOG_MS.contains(&watchdog_ms) {
            return Err(ConfigError::ValueOutOfRange);
        }
        if esr_ms > LONGEST_ESR_MS {
            return Err(ConfigError::DelayTooLong);
        }
        let cycles =
            |ms| Cycles::from_millis_down(ms, cycle_us).map_err(|_| ConfigError::DelayTooLong);
        Self::new(cycles(watchdog_ms)?, cycles(esr_ms)?, profisafe, stop_b)
    }

    /// The stop on a failure that is not delayed: with ESR configured and not run, pulses off.
    const fn reaction(&self) -> Stop {
        if self.profisafe && self.stop_b && self.esr.is_zero() {
            Stop::B
        } else {
            Stop::A
        }
    }
}

fields! {
    /// What the communication does to the drive.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// There has been no telegram since POWER ON: substitute values.
        #[default]
        Starting,
        /// It runs.
        Running,
        /// It has failed; ESR runs.
        Delayed,
        /// It has failed and was not acknowledged.
        Failed,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What it does to the drive.
        pub phase: Phase,
        /// What is left until the watchdog ends; 0: no valid telegram is there.
        pub watch: Cycles,
        /// What is left of ESR.
        pub esr: Cycles,
    }
}

impl State {
    /// POWER ON.
    pub const INITIAL: Self = Self {
        phase: Phase::Starting,
        watch: Cycles::ZERO,
        esr: Cycles::ZERO,
    };

    /// Timers run in their phases and within their bounds.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.watch <= config.watchdog
            && self.esr <= config.esr
            && (self.phase == Phase::Delayed) != self.esr.is_zero()
            && (self.phase != Phase::Starting || self.watch.is_zero())
            && (self.phase != Phase::Running || !self.watch.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// A valid telegram has come.
        pub telegram: bool,
        /// The F-CPU is in STOP, or the communication is disturbed (S120-COMM-501).
        pub disturbed: bool,
        /// An active SLS, SDI or SLP has a stop without delayed pulse cancellation, a code below 10.
        pub undelayed: bool,
        /// A safe acknowledgement.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The received values count; else substitute values, all 0.
        pub valid: bool,
        /// The failure is present or was not acknowledged.
        pub fault: bool,
        /// The stop that is requested.
        pub request: Stop,
        /// ESR is requested.
        pub esr: bool,
    }
}

monitor! { sinamics::communication;
    /// Values count only while the last valid telegram is no older than the watchdog.
    values_are_fresh ["S120-PSAFE-505", "S120-PC-29", "S120-PSAFE-526"]:
        when |s| s.outputs.valid
            => !s.inputs.disturbed && (s.inputs.telegram || s.before.watch > Cycles::new(1)) && s.after.watch > Cycles::ZERO;

    /// A watchdog that ends, or a disturbance, is a failure in that cycle.
    lost_communication_fails ["S120-COMM-500", "S120-COMM-501", "S120-PSAFE-505", "S120-PC-18"]:
        when |s| s.before.phase == Phase::Running && !s.inputs.power_on
            && (s.inputs.disturbed || (s.before.watch <= Cycles::new(1) && !s.inputs.telegram))
            => s.outputs.fault && !s.outputs.valid && (s.outputs.request != Stop::None || s.outputs.esr);

    /// The reaction is STOP A, or STOP B where p9612 says so, the communication is PROFIsafe and there is no ESR.
    reaction_is_configured ["S120-COMM-500", "S120-COMM-502", "S120-COMM-507"]:
        when |s| s.outputs.request != Stop::None
            => s.outputs.request == if s.config.stop_b && s.config.profisafe && s.config.esr.is_zero() { Stop::B } else { Stop::A };

    /// ESR runs only if it is configured and every active function is delayed; else the reaction is immediate.
    esr_needs_delayed_stops ["S120-COMM-504", "S120-COMM-505", "S120-STOP-518"]:
        when |s| s.after.phase == Phase::Delayed && (s.before.phase != Phase::Delayed || s.inputs.power_on)
            => !s.inputs.undelayed && s.after.esr == s.config.esr;

    /// ESR ends: in each cycle less of p9580 is left; at its end, or with an active function whose stop is not delayed, comes STOP A,
    /// whether there is communication again or not.
    esr_ends_in_stop_a ["S120-COMM-504", "S120-COMM-505", "S120-PC-18"]:
        when |s| s.before.phase == Phase::Delayed && !s.inputs.power_on
            => if s.before.esr > Cycles::new(1) && !s.inputs.undelayed {
                s.after.phase == Phase::Delayed && s.after.esr == s.before.esr.tick() && s.outputs.esr
            } else {
                s.after.phase == Phase::Failed && s.outputs.request == Stop::A
            };

    /// A failure stays until it is acknowledged while there is communication, or POWER ON.
    failure_is_latched ["S120-COMM-506", "S120-PC-29"]:
        when |s| s.before.phase == Phase::Failed && s.after.phase != Phase::Failed
            => s.inputs.power_on || (s.inputs.acknowledge && s.outputs.valid);

    /// That acknowledgement ends it.
    acknowledgement_reintegrates ["S120-COMM-506", "S120-PC-31"]:
        when |s| s.before.phase == Phase::Failed && s.inputs.acknowledge && s.inputs.telegram && !s.inputs.disturbed
            && !s.inputs.power_on
            => s.after.phase == Phase::Running && !s.outputs.fault && s.outputs.request == Stop::None;

    /// While it has failed a stop is requested.
    failure_requests_a_stop ["S120-COMM-500", "S120-COMM-506"]:
        when |s| s.after.phase == Phase::Failed
            => s.outputs.request != Stop::None && !s.outputs.esr;

    /// Before the first telegram the values are substitutes, and nothing has failed.
    start_is_substituted ["S120-PSAFE-505", "S120-ACK-515"]:
        when |s| s.after.phase == Phase::Starting
            => !s.outputs.valid && !s.outputs.fault && s.outputs.request == Stop::None;

    /// Communication that is kept asks for nothing.
    kept_communication_asks_for_nothing ["S120-PSAFE-505", "S120-PSAFE-507"]:
        when |s| s.before.phase == Phase::Running && s.inputs.telegram && !s.inputs.disturbed && !s.inputs.power_on
            => s.after.phase == Phase::Running && s.after.watch == s.config.watchdog && s.outputs.valid
                && s.outputs.request == Stop::None && !s.outputs.fault;

    /// The step keeps the invariant.
    state_stays_consistent ["S120-PSAFE-505"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    after.watch = if inputs.disturbed {
        Cycles::ZERO
    } else if inputs.telegram {
        config.watchdog
    } else {
        after.watch.tick()
    };
    let valid = !after.watch.is_zero();
    match after.phase {
        Phase::Starting if valid => after.phase = Phase::Running,
        Phase::Running if !valid => {
            if config.esr.is_zero() || inputs.undelayed {
                after.phase = Phase::Failed;
            } else {
                after.phase = Phase::Delayed;
                after.esr = config.esr;
            }
        }
        Phase::Delayed => {
            after.esr = if inputs.undelayed {
                Cycles::ZERO
            } else {
                after.esr.tick()
            };
            if after.esr.is_zero() {
                after.phase = Phase::Failed;
            }
        }
        Phase::Failed if valid && inputs.acknowledge => after.phase = Phase::Running,
        Phase::Starting | Phase::Running | Phase::Failed => {}
    }
    let outputs = Outputs {
        valid,
        fault: matches!(after.phase, Phase::Delayed | Phase::Failed),
        request: if after.phase == Phase::Failed {
            config.reaction()
        } else {
            Stop::None
        },
        esr: after.phase == Phase::Delayed,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle() -> NonZeroU32 {
        NonZeroU32::new(4_000).expect("not zero")
    }

    /// S120-PSAFE-505, S120-STOP-518: the printed ranges.
    #[test]
    fn the_printed_ranges_are_kept() {
        let config = |watchdog, esr| Config::from_millis(watchdog, esr, true, false, cycle());
        assert!(config(10, 0).is_ok() && config(65_535, 800).is_ok());
        assert_eq!(config(9, 0), Err(ConfigError::ValueOutOfRange));
        assert_eq!(config(65_536, 0), Err(ConfigError::ValueOutOfRange));
        assert_eq!(config(100, 801), Err(ConfigError::DelayTooLong));
    }

    /// S120-COMM-504, S120-COMM-506: ESR of 800 ms, then STOP A, which renewed communication does not end.
    #[test]
    fn esr_delays_the_stop_by_its_time() {
        let config = Config::from_millis(100, 800, true, true, cycle()).expect("in range");
        let mut link = Monitor::new(config);
        let telegram = Inputs {
            telegram: true,
            ..Inputs::default()
        };
        link.step(&telegram);
        for _ in 1..25 {
            assert!(link.step(&Inputs::default()).valid);
        }
        for _ in 0..200 {
            assert!(link.step(&Inputs::default()).esr);
        }
        assert_eq!(link.step(&Inputs::default()).request, Stop::A);
        assert_eq!(link.step(&telegram).request, Stop::A);
    }
}
