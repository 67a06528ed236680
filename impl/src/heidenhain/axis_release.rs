//! One axis in a released group: with its feed enable it may move, without it it brakes by an SS2 of its own and is then
//! monitored for standstill, while the group keeps its state.

use crate::heidenhain::stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// The time of the axis' own SS2.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_ss2: Cycles,
    }
}

impl Config {
    /// `t_ss2`: time until standstill (SMP527).
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above 10 s ([`stop::Config::LONGEST`]).
    pub fn new(t_ss2: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            t_ss2: t_ss2.at_most(stop::Config::LONGEST)?,
        })
    }

    /// What a timer of this time starts with: one cycle at least.
    pub const fn started(&self) -> Cycles {
        if self.t_ss2.is_zero() {
            Cycles::new(1)
        } else {
            self.t_ss2
        }
    }
}

fields! {
    /// What the axis does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Mode {
        /// Monitored for standstill.
        #[default]
        Sos,
        /// Released: the limits of the group apply.
        Released,
        /// Braking by an SS2 of its own.
        Ss2,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the axis does.
        pub mode: Mode,
        /// What is left of the time of its SS2 while it brakes; 0 when it is over.
        pub timer: Cycles,
    }
}

impl State {
    /// Monitored for standstill.
    pub const INITIAL: Self = Self {
        mode: Mode::Sos,
        timer: Cycles::ZERO,
    };

    /// A timer runs only while the axis brakes.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.started() && (matches!(self.mode, Mode::Ss2) || self.timer.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The group was released at the start of the cycle.
        pub group_released: bool,
        /// Feed enable of the axis (`PP_AxFeedEnable`).
        pub feed: bool,
        /// The axis moves: 50 mm/min or more.
        pub moving: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What the axis does.
        pub mode: Mode,
        /// It was not braked in time, or moves without feed enable: SS1.
        pub asks_ss1: bool,
        /// It has come to rest: where it is the last one, the group goes to its standstill state.
        pub stands: bool,
    }
}

monitor! { heidenhain::axis_release;
    /// Without feed enable a moving axis brakes, in the cycle in which the enable goes, with its whole time.
    lost_enable_brakes ["HFS-SS2-008/a", "HFS-P-48", "HFS-AXG-009", "HFS-SS2-011", "HFS-FAULT-023"]:
        when |s| s.inputs.group_released && s.before.mode == Mode::Released && !s.inputs.feed && s.inputs.moving
            => s.after.mode == Mode::Ss2 && s.after.timer == s.config.started() && !s.outputs.asks_ss1;

    /// An axis that stands without feed enable is monitored for standstill; released it is only by the enable.
    release_needs_the_enable ["HFS-P-48", "HFS-AXG-010"]:
        when |s| s.inputs.group_released && !s.inputs.feed
            => s.after.mode != Mode::Released && (s.inputs.moving || s.after.mode == Mode::Sos);

    /// Braking runs to its end, also when the enable comes back.
    braking_runs_to_its_end ["HFS-STOP-002", "HFS-AXG-009"]:
        when |s| s.inputs.group_released && s.before.mode == Mode::Ss2 && s.inputs.moving
            => s.after.mode == Mode::Ss2 && s.after.timer == s.before.timer.tick()
                && s.outputs.asks_ss1 == s.after.timer.is_zero();

    /// Braking ends in the monitoring for standstill, which is reported.
    braking_ends_at_rest ["HFS-AXG-009", "HFS-SS2-001"]:
        when |s| s.before.mode != Mode::Sos && s.after.mode == Mode::Sos
            => (!s.inputs.moving || !s.inputs.group_released) && s.outputs.stands;

    /// Motion without enable from standstill is a fault.
    motion_without_enable_stops ["HFS-AXG-010", "HFS-SOS-002"]:
        when |s| s.inputs.group_released && s.before.mode == Mode::Sos && !s.inputs.feed && s.inputs.moving
            => s.outputs.asks_ss1;

    /// A released axis with its enable moves freely.
    enabled_axis_is_released ["HFS-AXG-004", "HFS-AXG-009"]:
        when |s| s.inputs.group_released && s.inputs.feed && s.before.mode != Mode::Ss2
            => s.after.mode == Mode::Released && !s.outputs.asks_ss1 && !s.outputs.stands;

    /// In a group that is not released no axis is.
    no_release_without_the_group ["HFS-AXG-009"]:
        when |s| !s.inputs.group_released
            => s.after == State::INITIAL && !s.outputs.asks_ss1;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-AXG-009"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.mode == s.after.mode;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.group_released {
        let outputs = Outputs {
            stands: state.mode != Mode::Sos,
            ..Outputs::default()
        };
        return (State::INITIAL, outputs);
    }
    let after = match state.mode {
        Mode::Ss2 if inputs.moving => State {
            timer: state.timer.tick(),
            ..state
        },
        Mode::Ss2 => State::INITIAL,
        Mode::Sos | Mode::Released if inputs.feed => State {
            mode: Mode::Released,
            timer: Cycles::ZERO,
        },
        Mode::Released if inputs.moving => State {
            mode: Mode::Ss2,
            timer: config.started(),
        },
        Mode::Sos | Mode::Released => State::INITIAL,
    };
    let late = after.mode == Mode::Ss2 && after.timer.is_zero();
    let outputs = Outputs {
        mode: after.mode,
        asks_ss1: late || (after.mode == Mode::Sos && inputs.moving),
        stands: after.mode == Mode::Sos && state.mode != Mode::Sos,
    };
    (after, outputs)
}
