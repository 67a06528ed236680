//! Too frequent switching of STO or SS1: F01611 with fault value 1000.
//!
//! Within 5 x p9650 the request must rest for p9650 once. Readings: AC-02 CHATTER_WATCHDOG.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The tolerance time p9650.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) rest: Cycles,
    }
}

impl Config {
    /// `rest`: how long the request must rest, in cycles.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is 0, [`ConfigError::DelayTooLong`] when five times it is more than 32 bits hold.
    pub const fn new(rest: Cycles) -> Result<Self, ConfigError> {
        if rest.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        if rest.count() > u32::MAX / 5 {
            return Err(ConfigError::DelayTooLong);
        }
        Ok(Self { rest })
    }

    /// How long it may go on without a rest.
    pub const fn limit(&self) -> Cycles {
        Cycles::new(self.rest.count().saturating_mul(5))
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The request in the last cycle.
        pub last: bool,
        /// What is left until the request has rested; 0: it has.
        pub unrested: Cycles,
        /// What is left until the switching is too frequent; 0: nothing runs.
        pub watch: Cycles,
        /// F01611, fault value 1000.
        pub fault: bool,
    }
}

impl State {
    /// Selected, at rest.
    pub const INITIAL: Self = Self {
        last: false,
        unrested: Cycles::ZERO,
        watch: Cycles::ZERO,
        fault: false,
    };

    /// Timers within their bounds; while the request has not rested, it is watched or a fault.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.unrested <= config.rest
            && self.watch <= config.limit()
            && (self.watch.is_zero() == self.unrested.is_zero() || self.fault)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The level of the request.
        pub request: bool,
        /// The fault is acknowledged.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// F01611 with fault value 1000.
        pub fault: bool,
    }
}

monitor! { sinamics::chatter;
    /// A request that rests long enough ends the watch.
    rest_ends_the_watch ["S120-CTRL-511"]:
        when |s| s.inputs.request == s.before.last && s.before.unrested <= Cycles::new(1) && !s.inputs.power_on
            => s.after.unrested.is_zero() && s.after.watch.is_zero();

    /// Each change begins the rest anew, but not the watch that runs.
    change_does_not_prolong_the_watch ["S120-CTRL-511"]:
        when |s| s.inputs.request != s.before.last && !s.inputs.power_on && s.before.watch > Cycles::new(1)
            => s.after.unrested == s.config.rest && s.after.watch == s.before.watch.tick();

    /// The first change after a rest begins the watch.
    first_change_begins_the_watch ["S120-CTRL-511"]:
        when |s| s.inputs.request != s.before.last && s.before.watch.is_zero() && !s.before.fault && !s.inputs.power_on
            => s.after.watch == s.config.limit() && s.after.unrested == s.config.rest && !s.outputs.fault;

    /// Switching that goes on for 5 x p9650 is a fault.
    endless_switching_is_a_fault ["S120-CTRL-511"]:
        when |s| s.before.watch == Cycles::new(1) && !s.inputs.power_on
            && (s.inputs.request != s.before.last || s.before.unrested > Cycles::new(1))
            => s.outputs.fault;

    /// Nothing else is: a static input least of all.
    only_endless_switching_is_a_fault ["S120-CTRL-511"]:
        when |s| s.outputs.fault && !s.before.fault
            => s.before.watch == Cycles::new(1)
                && (s.inputs.request != s.before.last || s.before.unrested > Cycles::new(1));

    /// The fault stays until it is acknowledged while the request rests, or POWER ON.
    fault_needs_a_rest ["S120-CTRL-511", "S120-ACK-506"]:
        when |s| s.before.fault && !s.outputs.fault
            => s.inputs.power_on || (s.inputs.acknowledge && s.after.unrested.is_zero());

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-CTRL-511"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == s.after.fault && s.after.last == s.inputs.request;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State {
            last: inputs.request,
            ..State::INITIAL
        }
    } else {
        state
    };
    let changed = inputs.request != before.last;
    let unrested = if changed {
        config.rest
    } else {
        before.unrested.tick()
    };
    let rested = unrested.is_zero();
    let watch = if rested {
        Cycles::ZERO
    } else if before.watch.is_zero() && changed && !before.fault {
        config.limit()
    } else {
        before.watch.tick()
    };
    let over = !rested && watch.is_zero();
    let fault = (over || before.fault) && !(inputs.acknowledge && rested);
    let after = State {
        last: inputs.request,
        unrested,
        watch,
        fault,
    };
    (after, Outputs { fault })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-CTRL-511: a rest of p9650 within 5 x p9650 is enough, and a static input needs none.
    #[test]
    fn switching_must_rest() {
        let config = Config::new(Cycles::new(3)).expect("some");
        let mut chatter = Monitor::new(config);
        let step = |chatter: &mut Monitor, request| {
            let inputs = Inputs {
                request,
                ..Inputs::default()
            };
            chatter.step(&inputs).fault
        };
        for cycle in 0..100 {
            assert!(!step(&mut chatter, cycle % 8 < 4), "it rests for 3 cycles");
        }
        let first = (0..100).find(|cycle| step(&mut chatter, cycle % 2 == 0));
        assert!(first.is_some_and(|cycle| (15..18).contains(&cycle)));
    }
}
