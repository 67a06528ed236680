//! Watchdog of one channel of the safe logic over its exchange with the other one (machine `spl_link`).
//!
//! A channel that has received nothing for longer than a second raises alarm 27092. From then on five seconds are left in which
//! the programs may bring the machine to rest; then the external outputs are 0, and where the channel is the PLC it goes to
//! STOP. Communication that comes back changes nothing: only power-on does. The stop on the axes, which only a
//! protected channel asks for, is that of [`crate::sinumerik::spl_comparison`], whose input `lost` is the alarm.
//!
//! The channel of the NCK also takes an alarm of the PLC for its own (`told`); for the PLC that input is never set.
//!
//! Reading B-38: COMM_LATCHED.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Cycles};
use crate::sinumerik::relay::ONE_SECOND;

/// Five seconds in cycles of 31.25 us, the shortest possible ones.
pub const FIVE_SECONDS: Cycles = Cycles::new(160_000);

config! {
    /// The times of the watchdog.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        patience: Cycles,
        grace: Cycles,
    }
}

impl Config {
    /// `patience`: one second, as long as nothing may be received. `grace`: five seconds, from the alarm to the reaction.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] where one of them is zero, [`ConfigError::DelayTooLong`] for more cycles than the times have in
    /// the shortest cycle.
    pub const fn new(patience: Cycles, grace: Cycles) -> Result<Self, ConfigError> {
        if patience.is_zero() || grace.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        if patience.count() > ONE_SECOND.count() || grace.count() > FIVE_SECONDS.count() {
            return Err(ConfigError::DelayTooLong);
        }
        Ok(Self { patience, grace })
    }

    /// The times for a cycle of `cycle_us` microseconds. The second is rounded down, so that the first cycle beyond it is found;
    /// the five seconds are rounded up, so that the programs have them whole (S840D-SPLCOMM-001, S840D-SPLCOMM-009).
    ///
    /// # Errors
    /// Those of [`Config::new`]: the cycle is longer than a second or shorter than 31.25 us.
    pub const fn of_cycle(cycle_us: NonZeroU32) -> Result<Self, ConfigError> {
        match (
            Cycles::from_millis_down(1_000, cycle_us),
            Cycles::from_millis_up(5_000, cycle_us),
        ) {
            (Ok(patience), Ok(grace)) => Self::new(patience, grace),
            _ => Err(ConfigError::DelayTooLong),
        }
    }

    /// As long as nothing may be received.
    pub const fn patience(&self) -> Cycles {
        self.patience
    }

    /// From the alarm to the reaction.
    pub const fn grace(&self) -> Cycles {
        self.grace
    }
}

fields! {
    /// What the channel knows of the other one.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Link {
        /// It is heard.
        #[default]
        Heard,
        /// It has not been heard for too long; the grace runs.
        Lost,
        /// The grace is over.
        Ended,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the channel knows of the other one.
        pub link: Link,
        /// `Heard`: cycles without an exchange that are behind; `Lost`: cycles of the grace that are left; else 0.
        pub time: Cycles,
    }
}

impl State {
    /// Nothing has failed.
    pub const INITIAL: Self = Self {
        link: Link::Heard,
        time: Cycles::ZERO,
    };

    /// The times are within their bounds, and a grace that runs is not over.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        match self.link {
            Link::Heard => self.time <= config.patience,
            Link::Lost => !self.time.is_zero() && self.time <= config.grace,
            Link::Ended => self.time.is_zero(),
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// The comparison has been started: before that nobody has to be heard.
        pub running: bool,
        /// Data of the other channel have come in this cycle.
        pub exchange: bool,
        /// NCK: the PLC has raised its alarm (DB18.DBX119.5).
        pub told: bool,
        /// External outputs as the program sets them (`$A_OUTSED[1,2]`).
        pub outsed: [u32; 2],
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Alarm 27092.
        pub alarm: bool,
        /// NCK: `$A_STATSID` bit 29. PLC: DB18.DBX119.5. The programs may react to it (S840D-SPLCOMM-007).
        pub pending: bool,
        /// The reaction is there. PLC: STOP by SFC46 with message 400253, after which no program runs (S840D-SPLCOMM-006).
        pub stopped: bool,
        /// The external outputs as they are, and as the program reads them back. The internal ones are not touched
        /// (S840D-SPLCOMM-011).
        pub outsed: [u32; 2],
    }
}

impl Outputs {
    const fn of(state: &State, outsed: [u32; 2]) -> Self {
        let stopped = matches!(state.link, Link::Ended);
        let failed = !matches!(state.link, Link::Heard);
        Self {
            alarm: failed,
            pending: failed,
            stopped,
            outsed: if stopped { [0; 2] } else { outsed },
        }
    }
}

monitor! { sinumerik::spl_link;
    /// A channel that has heard nothing for exactly the time it may, and hears nothing again, has its alarm.
    silence_is_noticed ["S840D-SPLCOMM-001", "S840D-SPLCOMM-002", "S840D-SPLCOMM-004", "S840D-SPLCOMM-009",
        "S840D-ALARM-722", "S840D-TIMING-701"]:
        when |s| s.before.link == Link::Heard && s.before.time == s.config.patience && s.inputs.running
            && !s.inputs.exchange && !s.inputs.power_on
            => s.outputs.alarm && s.outputs.pending && s.after.link == Link::Lost;

    /// A shorter silence is counted and raises nothing.
    silence_is_counted ["S840D-SPLCOMM-001"]:
        when |s| s.before.link == Link::Heard && s.before.time < s.config.patience && s.inputs.running
            && !s.inputs.exchange && !s.inputs.told && !s.inputs.power_on
            => !s.outputs.alarm && s.after.time.count() == s.before.time.count() + 1;

    /// Who is heard has no silence behind, and nobody has to be heard before the comparison runs.
    exchange_ends_the_silence ["S840D-SPLCOMM-001"]:
        when |s| s.before.link == Link::Heard && (s.inputs.exchange || !s.inputs.running) && !s.inputs.told
            => s.after == State::INITIAL && !s.outputs.alarm;

    /// The alarm of the PLC is one of the NCK, whoever is heard.
    told_is_as_good_as_noticed ["S840D-SPLCOMM-002"]:
        when |s| s.inputs.told
            => s.outputs.alarm && s.outputs.pending;

    /// The grace begins whole.
    grace_is_whole ["S840D-SPLCOMM-003", "S840D-SPLCOMM-007", "S840D-SPLCOMM-009", "S840D-ALARM-722", "S840D-TIMING-701"]:
        when |s| s.before.link == Link::Heard && s.after.link == Link::Lost
            => s.after.time == s.config.grace && !s.outputs.stopped;

    /// It runs down, whatever is heard, and when it is over the reaction is there.
    grace_runs_down ["S840D-SPLCOMM-003", "S840D-SPLCOMM-004", "S840D-SPLCOMM-010", "S840D-ALARM-722", "S840D-TIMING-701"]:
        when |s| s.before.link == Link::Lost && !s.inputs.power_on
            => s.after.time == s.before.time.tick() && s.outputs.stopped == s.after.time.is_zero() && s.outputs.alarm;

    /// Only power-on ends the reaction.
    only_power_on_ends_it ["S840D-SPLCOMM-003", "S840D-SPLCOMM-006", "S840D-SPLCOMM-008"]:
        when |s| s.before.link == Link::Ended && !s.inputs.power_on
            => s.outputs.stopped && s.outputs.alarm && s.outputs.pending;

    /// With the reaction every external output is 0.
    outputs_are_cleared ["S840D-SPLCOMM-003", "S840D-SPLCOMM-005", "S840D-ALARM-722"]:
        when |s| s.outputs.stopped
            => s.outputs.outsed == [0; 2];

    /// Before it every one is as the program sets it.
    outputs_are_passed_on ["S840D-SPLCOMM-011", "S840D-SPL-012"]:
        when |s| !s.outputs.stopped
            => s.outputs.outsed == s.inputs.outsed;

    /// Power-on forgets everything.
    power_on_begins_anew ["S840D-SPLCOMM-008"]:
        when |s| s.inputs.power_on && !s.inputs.told
            => !s.outputs.alarm && !s.outputs.stopped && s.after.time.count() <= 1;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SPLCOMM-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.pending == (s.after.link != Link::Heard)
                && s.outputs.stopped == (s.after.link == Link::Ended);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let lost = State {
        link: Link::Lost,
        time: config.grace,
    };
    let heard = inputs.exchange || !inputs.running;
    let after = match before.link {
        Link::Ended => before,
        Link::Lost => {
            let time = before.time.tick();
            let link = if time.is_zero() {
                Link::Ended
            } else {
                Link::Lost
            };
            State { link, time }
        }
        Link::Heard if inputs.told => lost,
        Link::Heard if heard => State::INITIAL,
        Link::Heard if before.time >= config.patience => lost,
        Link::Heard => State {
            link: Link::Heard,
            time: Cycles::new(before.time.count().saturating_add(1)),
        },
    };
    (after, Outputs::of(&after, inputs.outsed))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-SPLCOMM-001, S840D-SPLCOMM-009: in a cycle of 12 ms 83 cycles without an exchange, 996 ms, may pass; the grace
    /// is 417 cycles, 5004 ms.
    #[test]
    fn times_in_cycles() {
        let of = |us| Config::of_cycle(NonZeroU32::new(us).expect("not 0"));
        let config = of(12_000).expect("a cycle");
        assert_eq!(config.patience(), Cycles::new(83));
        assert_eq!(config.grace(), Cycles::new(417));
        assert_eq!(of(1_000_001), Err(ConfigError::NoDelay));
        assert_eq!(of(31), Err(ConfigError::DelayTooLong));
        let none = Cycles::ZERO;
        assert_eq!(Config::new(ONE_SECOND, none), Err(ConfigError::NoDelay));
        let longer = Cycles::new(FIVE_SECONDS.count() + 1);
        assert_eq!(
            Config::new(ONE_SECOND, longer),
            Err(ConfigError::DelayTooLong)
        );
        assert!(Config::new(ONE_SECOND, FIVE_SECONDS).is_ok());
    }
}
