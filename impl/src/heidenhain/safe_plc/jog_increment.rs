//! Jog increments of one axis by its direction key in one safe PLC (SLI).
//!
//! The increment itself is executed by the NC software, in one channel; neither safe PLC nor kernel watches its length. What is
//! watched are the conditions: the key, the permissive where one is needed (it is part of the key handed in), and by the kernel
//! the limited speed of the mode.
//!
//! Recommended reading of the manual implemented here: AMB-16 HOLD, with the other one by the configuration; the manual has
//! both, to be chosen for each machine.

use crate::heidenhain::types::Stop;
use crate::kernel::ConfigError;

config! {
    /// What the release of the key does.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        to_end: bool,
    }
}

impl Config {
    /// `to_end`: the increment runs to its end after the key is released (8.11.1); else the release stops it (4.8.14).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(to_end: bool) -> Result<Self, ConfigError> {
        Ok(Self { to_end })
    }
}

fields! {
    /// What is known of the increment.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Jog {
        /// The key is released: the next press begins an increment.
        Ready,
        /// The increment runs.
        Runs,
        /// It has ended, and the key is still pressed.
        #[default]
        Ended,
    }
}

fields! {
    /// The state between two cycles of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the increment.
        pub jog: Jog,
    }
}

impl State {
    /// As if the key had been held when the control came up.
    pub const INITIAL: Self = Self { jog: Jog::Ended };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The axis-direction key with every other condition: filter, permissive.
        pub key: bool,
        /// The NC has ended the increment: the axis stands, and the group is in SOS.
        pub done: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `PP_AxFeedEnable` of the axis.
        pub feed: bool,
        /// `PP_AxGrpStopReq` of its group.
        pub stop: Stop,
    }
}

monitor! { heidenhain::jog_increment;
    /// A lost condition stops the group, and the axis has no feed any more.
    lost_condition_stops ["HFS-SLI-003", "HFS-SLI-001"]:
        when |s| !s.config.to_end && s.before.jog == Jog::Runs && !s.inputs.key && !s.inputs.done
            => s.outputs.stop == Stop::Ss2 && !s.outputs.feed;

    /// A stop is asked for in no other case.
    nothing_else_stops ["HFS-SLI-003"]:
        when |s| s.outputs.stop != Stop::None
            => !s.config.to_end && s.before.jog == Jog::Runs && !s.inputs.key && !s.inputs.done;

    /// One press is one increment: the next one needs a release between.
    one_press_is_one_increment ["HFS-SLI-002"]:
        when |s| s.before.jog == Jog::Ended && s.inputs.key
            => !s.outputs.feed && s.after.jog == Jog::Ended;

    /// An increment begins with a key that was released.
    increment_begins_with_a_press ["HFS-SLI-002", "HFS-SLI-001"]:
        when |s| s.after.jog == Jog::Runs && s.before.jog != Jog::Runs
            => s.before.jog == Jog::Ready && s.inputs.key;

    /// The axis is enabled exactly while its increment runs.
    feed_while_it_runs ["HFS-SLI-001", "HFS-SEQ-005"]:
        when |s| s.outputs.feed || s.after.jog == Jog::Runs
            => s.outputs.feed == (s.after.jog == Jog::Runs);

    /// Where it runs to its end, the feed stays after the key is released, until the motion has ended.
    feed_stays_to_the_end ["HFS-SEQ-005"]:
        when |s| s.config.to_end && s.before.jog == Jog::Runs
            => s.outputs.feed != s.inputs.done;

    /// It ends by itself, and with it the feed.
    increment_ends_by_itself ["HFS-SLI-002", "HFS-SEQ-005"]:
        when |s| s.before.jog == Jog::Runs && s.inputs.done
            => !s.outputs.feed && s.outputs.stop == Stop::None;

    /// A press after a release begins.
    press_begins ["HFS-SLI-002"]:
        when |s| s.before.jog == Jog::Ready && s.inputs.key
            => s.outputs.feed;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let rests = if inputs.key { Jog::Ended } else { Jog::Ready };
    let (jog, stop) = match state.jog {
        Jog::Ready if inputs.key => (Jog::Runs, Stop::None),
        Jog::Ready | Jog::Ended => (rests, Stop::None),
        Jog::Runs if inputs.done => (rests, Stop::None),
        Jog::Runs if inputs.key || config.to_end => (Jog::Runs, Stop::None),
        Jog::Runs => (Jog::Ready, Stop::Ss2),
    };
    let outputs = Outputs {
        feed: jog == Jog::Runs,
        stop,
    };
    (State { jog }, outputs)
}
