//! Comparison of one item between the channels: they may differ for less than a window.
//!
//! The two safe PLCs run in cycles of their own, that of MP7602 in the MC and 21 ms in the CC (HFS-SPLC-003), so that what
//! they hand over changes at different times (up to 22 cycles of 3 ms; the faster one takes one of them at least, so that no
//! regular difference lasts for all of them). How a difference is answered in the meantime, by the stricter of both values, is
//! the business of whoever reads them. Which stop a fault raises depends on the item: SS1F for the flag "axis checked", SS1
//! for all others.
//!
//! Recommended readings of the manual implemented here: AMB-49 22 cycles.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// The window, and the stop of the item.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        window: Cycles,
        fatal: bool,
    }
    accepted |config| Config::new(config.window).is_ok()
}

impl Config {
    /// The response time of the safe PLC (HFS-TIMING-002), for which the channels may differ: 22 cycles.
    pub const PUBLISHED: Self = Self {
        window: Cycles::new(22),
        fatal: false,
    };

    /// `window`: the number of cycles of difference in a row that is a fault.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when `window` is 0.
    pub const fn new(window: Cycles) -> Result<Self, ConfigError> {
        if window.is_zero() {
            Err(ConfigError::NoDelay)
        } else {
            Ok(Self {
                window,
                fatal: false,
            })
        }
    }

    /// The same for the flag "axis checked", whose difference is SS1F.
    #[must_use]
    pub const fn fatal(self) -> Self {
        Self {
            fatal: true,
            ..self
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// For how many cycles the channels have differed, at most the window.
        pub cycles: Cycles,
    }
}

impl State {
    /// They agree.
    pub const INITIAL: Self = Self {
        cycles: Cycles::ZERO,
    };

    /// No longer than the window.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.cycles <= config.window
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The two channels differ in this cycle.
        pub differ: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// They have differed for a whole window.
        pub fault: bool,
        /// The stop to be raised: SS1F for the flag "axis checked", SS1 for everything else.
        pub demand: Stop,
    }
}

monitor! { heidenhain::agreement;
    /// A whole window of difference is a fault, which lasts as long as they differ.
    long_difference_is_a_fault ["HFS-P-31", "HFS-KDV-001", "HFS-KDV-005", "HFS-KDV-006"]:
        when |s| s.inputs.differ && s.before.cycles.count() as u64 + 1 >= s.config.window.count() as u64
            => s.outputs.fault && s.after.cycles == s.config.window;

    /// Within the window each cycle of difference counts one, and is no fault.
    window_runs ["HFS-KDV-005", "HFS-TIMING-002"]:
        when |s| s.inputs.differ && s.before.cycles.count() as u64 + 1 < s.config.window.count() as u64
            => !s.outputs.fault && s.after.cycles.count() as u64 == s.before.cycles.count() as u64 + 1;

    /// As soon as they agree, the window is whole again.
    agreement_ends_the_window ["HFS-KDV-005"]:
        when |s| !s.inputs.differ
            => !s.outputs.fault && s.after == State::INITIAL;

    /// A fault raises SS1, that of the flag "axis checked" SS1F; nothing else raises a stop.
    fault_stops_the_machine ["HFS-KDV-001", "HFS-KDV-006", "HFS-CHK-006", "HFS-P-31"]:
        when |s| s.outputs.fault || s.outputs.demand != Stop::None
            => s.outputs.fault && s.outputs.demand == if s.config.fatal { Stop::Ss1F } else { Stop::Ss1 };

    /// The count stays within the window.
    state_stays_consistent ["HFS-KDV-005"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.differ {
        return (State::INITIAL, Outputs::default());
    }
    let after = State {
        cycles: Cycles::new(state.cycles.count().saturating_add(1)).min(config.window),
    };
    let fault = after.cycles == config.window;
    let demand = match (fault, config.fatal) {
        (false, _) => Stop::None,
        (true, false) => Stop::Ss1,
        (true, true) => Stop::Ss1F,
    };
    (after, Outputs { fault, demand })
}
