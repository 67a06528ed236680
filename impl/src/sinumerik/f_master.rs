//! Clock of the F master: PROFIsafe communication between NCK and PLC (machine `f_master`).
//!
//! One call is one interpolator cycle. In each PROFIsafe cycle, a multiple of it, the NCK starts OB40 of the PLC, and with it forms
//! the data for all F modules. Where OB40 has not finished in time, the NCK tries again in each interpolator cycle. After 50 ms
//! without a start the axes are stopped; the attempts go on, and RESET acknowledges once the communication runs.
//!
//! What the monitor cannot see: that the PLC really executes what was started. It takes the ready signal for it.
//!
//! Readings: B-41 PST_GRID_STAYS (repeated attempts do not move the grid of the PROFIsafe cycles), and AMB-25: how many PROFIsafe
//! cycles may be exceeded one after the other is a parameter.

use core::num::{NonZeroU8, NonZeroU32};

use crate::kernel::{Cycles, DurationTooLong};

/// The longest PROFIsafe cycle in microseconds (S840D-PSAFE-011, S840D-PSAFE-025).
pub const LONGEST_PROFISAFE_CYCLE_US: u32 = 25_000;

/// So long the NCK tries to start OB40 without an alarm, in microseconds (S840D-PSAFE-013, S840D-PSTIME-001).
pub const TOLERATED_US: u32 = 50_000;

/// The most interpolator cycles in a PROFIsafe cycle: MD10098.
pub const LARGEST_RATIO: u8 = 25;

/// Why a clock is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockError {
    /// The PROFIsafe cycle is no 1 to 25 interpolator cycles, or no overrun is permitted to count.
    OutOfRange,
    /// The PROFIsafe cycle is longer than 25 ms: alarm 27200 (S840D-PSAFE-025).
    CycleTooLong,
}

impl core::fmt::Display for ClockError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::OutOfRange => {
                "a PROFIsafe cycle has 1 to 25 interpolator cycles, and at least one overrun is reported"
            }
            Self::CycleTooLong => "the PROFIsafe cycle is longer than 25 ms",
        })
    }
}

impl core::error::Error for ClockError {}

config! {
    /// The clock of the communication.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        ratio: u8,
        tolerated: Cycles,
        overruns: u8,
    }
}

impl Config {
    /// `ratio`: the interpolator cycles of a PROFIsafe cycle, 1 to 25. `tolerated`: the whole interpolator cycles in 50 ms.
    /// `overruns`: how many PROFIsafe cycles exceeded one after the other are reported as continuous.
    ///
    /// # Errors
    /// [`ClockError::OutOfRange`] for a ratio or a number of overruns outside their range;
    /// [`ClockError::CycleTooLong`] for a tolerated time of less than two PROFIsafe cycles: one is at most half of
    /// the 50 ms.
    pub const fn new(ratio: u8, tolerated: Cycles, overruns: u8) -> Result<Self, ClockError> {
        if ratio == 0 || ratio > LARGEST_RATIO || overruns == 0 {
            return Err(ClockError::OutOfRange);
        }
        if tolerated.count() < 2 * ratio as u32 {
            return Err(ClockError::CycleTooLong);
        }
        Ok(Self {
            ratio,
            tolerated,
            overruns,
        })
    }

    /// The clock for an interpolator cycle of so many microseconds.
    ///
    /// # Errors
    /// Those of [`Config::new`]; [`ClockError::CycleTooLong`] for a PROFIsafe cycle above 25 ms, alarm 27200
    /// (S840D-PSAFE-011, S840D-PSAFE-025).
    pub const fn of(
        interpolator_us: NonZeroU32,
        ratio: NonZeroU8,
        overruns: NonZeroU8,
    ) -> Result<Self, ClockError> {
        if interpolator_us.get() as u64 * ratio.get() as u64 > LONGEST_PROFISAFE_CYCLE_US as u64 {
            return Err(ClockError::CycleTooLong);
        }
        match tolerated(interpolator_us) {
            Ok(cycles) => Self::new(ratio.get(), cycles, overruns.get()),
            Err(DurationTooLong) => Err(ClockError::CycleTooLong),
        }
    }
}

/// The whole interpolator cycles in 50 ms: the first one after them is the first with an alarm (S840D-PSAFE-013,
/// S840D-PSAFE-014).
///
/// # Errors
/// None that can occur: at most 50,000 cycles.
pub const fn tolerated(interpolator_us: NonZeroU32) -> Result<Cycles, DurationTooLong> {
    Cycles::from_micros_down(TOLERATED_US as u64, interpolator_us)
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How many cycles the next PROFIsafe cycle is away; 0: the coming one begins it.
        pub until: u8,
        /// The cycles since OB40 was last started, up to the tolerated ones.
        pub since: Cycles,
        /// OB40 was not ready in time and has not been started since.
        pub waiting: bool,
        /// The PROFIsafe cycles exceeded one after the other, up to the number that is reported.
        pub exceeded: u8,
        /// Alarm 27253.
        pub lost: bool,
        /// Alarm 27256.
        pub slow: bool,
        /// Alarm 27250.
        pub ended: bool,
        /// One of the alarms 27200 to 27242.
        pub invalid: bool,
    }
}

impl State {
    /// Power-on: the first cycle begins a PROFIsafe cycle.
    pub const INITIAL: Self = Self {
        until: 0,
        since: Cycles::ZERO,
        waiting: false,
        exceeded: 0,
        lost: false,
        slow: false,
        ended: false,
        invalid: false,
    };

    /// Counters within their bounds. While nothing is waited for, the next PROFIsafe cycle comes within one after the last start;
    /// continuous overruns are reported.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.until < config.ratio
            && self.since <= config.tolerated
            && (self.waiting
                || self.since.count().saturating_add(self.until as u32) < config.ratio as u32)
            && self.exceeded <= config.overruns
            && (self.slow || self.exceeded < config.overruns)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// NC-RESET.
        pub reset: bool,
        /// A check at run-up has found an error: see [`crate::sinumerik::f_setup`].
        pub refused: bool,
        /// The DP master reports another configuration than at run-up.
        pub changed: bool,
        /// OB40 as started last has finished.
        pub ready: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// OB40 is started; the data for the F modules are formed now (S840D-PSAFE-051).
        pub trigger: bool,
        /// There is no F communication until power-on.
        pub stopped: bool,
        /// STOP D or E of all safety axes; channel not ready.
        pub stop: bool,
        /// Mode group not ready, no NC start, NC stop.
        pub inhibit: bool,
    }
}

/// Whether the step speaks of a communication that exists.
const fn communicates(state: &State, inputs: &Inputs) -> bool {
    !(inputs.power_on || inputs.refused || inputs.changed || state.ended || state.invalid)
}

monitor! { sinumerik::f_master;
    /// A PROFIsafe cycle that finds OB40 ready starts it, and nothing else is waited for.
    cycle_in_time_starts ["S840D-PSAFE-011", "S840D-PSAFE-013"]:
        when |s| communicates(&s.before, &s.inputs) && s.inputs.ready && s.before.until == 0
            => s.outputs.trigger && !s.after.waiting && s.after.since.is_zero();

    /// Between PROFIsafe cycles that are kept OB40 is not started.
    nothing_starts_between ["S840D-PSAFE-011", "S840D-PSAFE-051"]:
        when |s| communicates(&s.before, &s.inputs) && !s.before.waiting && s.before.until > 0
            => !s.outputs.trigger && !s.after.waiting && s.after.since.count() == s.before.since.count().saturating_add(1);

    /// What is not ready is not started, and the time since the last start runs on to its end.
    only_what_is_ready_starts ["S840D-PSAFE-013", "S840D-PSAFE-014"]:
        when |s| communicates(&s.before, &s.inputs) && !s.inputs.ready
            => !s.outputs.trigger
                && (s.after.since.count() == s.before.since.count().saturating_add(1) || s.after.since == s.config.tolerated);

    /// Once OB40 was not ready, each interpolator cycle tries again, also after the 50 ms.
    each_cycle_tries_again ["S840D-PSAFE-013", "S840D-PSAFE-014", "S840D-PSAFE-052"]:
        when |s| communicates(&s.before, &s.inputs) && s.before.waiting
            => s.outputs.trigger == s.inputs.ready && s.after.waiting != s.inputs.ready;

    /// An overrun is waited for.
    overrun_is_waited_for ["S840D-PSAFE-013", "S840D-PSAFE-016"]:
        when |s| communicates(&s.before, &s.inputs) && !s.before.waiting && s.before.until == 0 && !s.inputs.ready
            => s.after.waiting && s.after.exceeded >= 1 && s.after.exceeded >= s.before.exceeded;

    /// Within 50 ms an overrun raises no 27253.
    no_alarm_within_the_time ["S840D-PSAFE-013", "S840D-P-20"]:
        when |s| !s.before.lost && s.before.since < s.config.tolerated
            => !s.after.lost;

    /// The first cycle after the 50 ms raises 27253 and the stop, even where OB40 starts in it.
    alarm_after_the_time ["S840D-PSAFE-014", "S840D-PSAFE-020", "S840D-PSTIME-001", "S840D-P-20"]:
        when |s| communicates(&s.before, &s.inputs) && s.before.since == s.config.tolerated
            => s.after.lost && s.outputs.stop;

    /// 27253 goes away by RESET while the communication runs, or by power-on.
    alarm_needs_a_reset_while_it_runs ["S840D-PSAFE-020", "S840D-PSAFE-052"]:
        when |s| s.before.lost && !s.after.lost
            => s.inputs.power_on
                || (s.inputs.reset && !s.before.waiting && !s.after.waiting && communicates(&s.before, &s.inputs));

    /// RESET while the communication runs clears it.
    reset_acknowledges ["S840D-PSAFE-052"]:
        when |s| s.inputs.reset && communicates(&s.before, &s.inputs) && !s.before.waiting && !s.after.waiting
            => !s.after.lost;

    /// 27256 comes with an overrun that makes the number full, and asks for no stop.
    continuous_overrun_is_reported ["S840D-PSAFE-016", "S840D-PSAFE-023", "S840D-PSAFE-053", "S840D-PSAFE-705"]:
        when |s| !s.before.slow && s.after.slow
            => s.after.waiting && !s.before.waiting && s.after.exceeded == s.config.overruns
                && s.outputs.inhibit && s.outputs.stop == (s.after.lost || s.after.ended);

    /// A PROFIsafe cycle that is kept makes the overruns before it sporadic.
    kept_cycle_ends_the_row ["S840D-PSAFE-016"]:
        when |s| communicates(&s.before, &s.inputs) && !s.before.waiting && s.before.until == 0 && s.inputs.ready
            => s.after.exceeded == 0 && s.after.slow == (s.before.slow && !s.inputs.reset);

    /// 27256 stays until RESET, and with it while the overruns go on.
    continuous_overrun_waits_for_reset ["S840D-PSAFE-023"]:
        when |s| s.before.slow && !s.inputs.power_on && (!s.inputs.reset || s.after.exceeded == s.config.overruns)
            => s.after.slow && s.outputs.inhibit;

    /// A changed configuration ends the communication and stops the axes.
    changed_configuration_ends ["S840D-PSAFE-017", "S840D-PSAFE-703"]:
        when |s| (s.inputs.changed || s.before.ended) && !s.inputs.power_on
            => s.after.ended && !s.outputs.trigger && s.outputs.stopped && s.outputs.stop && s.outputs.inhibit;

    /// After an error at run-up there is no communication and no start, but no stop by itself.
    run_up_error_keeps_off ["S840D-PSAFE-025", "S840D-PSAFE-026", "S840D-PSAFE-027", "S840D-PSAFE-028", "S840D-PSAFE-029",
        "S840D-PSAFE-030", "S840D-PSAFE-031", "S840D-PSAFE-032", "S840D-PSAFE-033", "S840D-PSAFE-034", "S840D-PSAFE-035",
        "S840D-PSAFE-036", "S840D-PSAFE-037", "S840D-PSAFE-038", "S840D-PSAFE-039", "S840D-PSAFE-040", "S840D-PSAFE-041",
        "S840D-PSAFE-042"]:
        when |s| (s.inputs.refused || s.before.invalid) && !s.inputs.power_on
            => s.after.invalid && !s.outputs.trigger && s.outputs.stopped && s.outputs.inhibit
                && s.outputs.stop == (s.after.lost || s.after.ended);

    /// Power-on begins anew.
    power_on_begins_anew ["S840D-PSAFE-017", "S840D-PSAFE-025"]:
        when |s| s.inputs.power_on
            => s.after == State::INITIAL && !s.outputs.trigger && !s.outputs.stop && !s.outputs.inhibit;

    /// Where nothing is wrong the outputs ask for nothing.
    no_alarm_no_reaction ["S840D-PSAFE-013", "S840D-PSAFE-024"]:
        when |s| !s.after.lost && !s.after.ended
            => !s.outputs.stop && s.outputs.inhibit == (s.after.slow || s.after.invalid);

    /// The step keeps the invariant; the grid of the PROFIsafe cycles goes on.
    state_stays_consistent ["S840D-PSAFE-011"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config)
                && (!communicates(&s.before, &s.inputs)
                    || s.after.until == if s.before.until == 0 { s.config.ratio - 1 } else { s.before.until - 1 });
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let mut after = before;
    after.invalid |= inputs.refused && !inputs.power_on;
    after.ended |= inputs.changed && !inputs.power_on;
    let trigger = if inputs.power_on || after.invalid || after.ended {
        false
    } else {
        communicate(&mut after, config, inputs)
    };
    let stop = after.lost || after.ended;
    let outputs = Outputs {
        trigger,
        stopped: after.ended || after.invalid,
        stop,
        inhibit: stop || after.invalid || after.slow,
    };
    (after, outputs)
}

/// One cycle of the communication: whether OB40 is started.
fn communicate(state: &mut State, config: &Config, inputs: &Inputs) -> bool {
    let due = state.until == 0;
    let waited = state.waiting;
    let overdue = state.since >= config.tolerated;
    let attempt = due || waited;
    let trigger = attempt && inputs.ready;
    state.until = if due {
        config.ratio.saturating_sub(1)
    } else {
        state.until.saturating_sub(1)
    };
    state.waiting = attempt && !trigger;
    state.since = if trigger {
        Cycles::ZERO
    } else {
        Cycles::new(state.since.count().saturating_add(1)).min(config.tolerated)
    };
    if due && !waited {
        state.exceeded = if trigger {
            0
        } else {
            state.exceeded.saturating_add(1).min(config.overruns)
        };
    }
    let acknowledged = inputs.reset && !waited && !state.waiting;
    state.lost = overdue || (state.lost && !acknowledged);
    state.slow = state.exceeded >= config.overruns || (state.slow && !inputs.reset);
    trigger
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(interpolator_us: u32, ratio: u8) -> Result<Config, ClockError> {
        let us = NonZeroU32::new(interpolator_us).expect("not zero");
        let ratio = NonZeroU8::new(ratio).expect("not zero");
        Config::of(us, ratio, NonZeroU8::MIN)
    }

    /// S840D-PSAFE-011, S840D-PSAFE-025: alarm 27200.
    #[test]
    fn a_profisafe_cycle_is_25_ms_at_most() {
        let longest = of(5_000, 5).expect("25 ms");
        assert_eq!(longest.tolerated, Cycles::new(10));
        assert_eq!(of(5_001, 5), Err(ClockError::CycleTooLong));
        assert_eq!(of(12_500, 2).expect("25 ms").tolerated, Cycles::new(4));
        assert_eq!(of(125, 25).expect("3 ms").tolerated, Cycles::new(400));
        let beyond = Config::new(26, Cycles::new(400), 1);
        assert_eq!(beyond, Err(ClockError::OutOfRange));
    }

    /// S840D-PSAFE-013, S840D-PSAFE-014, S840D-PSTIME-001: the whole way from an overrun to the stop and back.
    #[test]
    fn after_50_ms_the_axes_are_stopped() {
        let mut master = Monitor::new(of(8_000, 2).expect("16 ms"));
        let ready = Inputs {
            ready: true,
            ..Inputs::default()
        };
        assert!(master.step(&ready).trigger);
        // 48 ms are six cycles of 8 ms; the seventh is more than 50 ms after the start.
        for cycle in 1..=6 {
            let outputs = master.step(&Inputs::default());
            assert!(!outputs.stop && !outputs.trigger, "cycle {cycle}");
        }
        assert!(master.step(&Inputs::default()).stop);
        let reset = Inputs {
            reset: true,
            ..Inputs::default()
        };
        assert!(master.step(&reset).stop, "nothing runs yet");
        let back = master.step(&ready);
        assert!(back.trigger && back.stop);
        let reset = Inputs {
            reset: true,
            ..ready
        };
        assert!(!master.step(&reset).stop);
    }
}
