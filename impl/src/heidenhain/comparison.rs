//! Comparison of the nominal with the actual value of one drive.
//!
//! With a door open the position of an axis must follow its nominal value at once, in the operating stop too. With the doors
//! closed, and always for a spindle, speeds are compared: the actual speed must be within the tolerance at least once in
//! each window of time. Without torque nothing is compared. A failed comparison raises SS1.
//!
//! Each channel looks at an encoder of its own: the CC at that of the motor, the MC at that of the position, or, where there is
//! none, at a value derived from the motor's for this purpose (HFS-NAV-004). So an encoder that fails is seen by one of the two.
//!
//! Recommended readings of the manual implemented here: AMB-17/18 TABLE, which comparison applies follows from table 4.8.15.

use crate::heidenhain::types::{GroupState, Stop};
use crate::kernel::{ConfigError, Cycles, Distance, Percent};

config! {
    /// The tolerances of one drive.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        spindle: bool,
        grouped: bool,
        tolerance: Distance,
        percent: Percent,
        window: Cycles,
    }
    accepted |config| Config::new(config.spindle, config.tolerance, config.percent, config.window).is_ok()
}

impl Config {
    /// `spindle`: a spindle, else an axis. `tolerance`: the permitted deviation of the position (SMP641.x). `percent`: the
    /// permitted deviation of the speed, in percent of the nominal one (SMP630.x, SMP631). `window`: the time within which
    /// the speed must be in the tolerance once (SMP632.x, SMP633).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when `window` is 0.
    pub const fn new(
        spindle: bool,
        tolerance: Distance,
        percent: Percent,
        window: Cycles,
    ) -> Result<Self, ConfigError> {
        if window.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            spindle,
            grouped: true,
            tolerance,
            percent,
            window,
        })
    }
}

impl Config {
    /// The same for a drive without a group (SMP600, SMP601 = -1): the positions of such an axis are not compared.
    #[must_use]
    pub const fn without_group(self) -> Self {
        Self {
            grouped: false,
            ..self
        }
    }

    #[cfg(feature = "mutants")]
    pub(crate) const fn with_group(self) -> Self {
        Self {
            grouped: true,
            ..self
        }
    }
}

fields! {
    /// What is compared.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Compared {
        /// Nothing: no torque.
        #[default]
        Nothing,
        /// The speed, within the window.
        Speed,
        /// The position, at once.
        Position,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How long the speed has been outside its tolerance, at most the window.
        pub outside: Cycles,
    }
}

impl State {
    /// Not outside.
    pub const INITIAL: Self = Self {
        outside: Cycles::ZERO,
    };

    /// No longer than the window.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.outside <= config.window
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The monitoring state of the group.
        pub state: GroupState,
        /// By the encoder of this channel, that of the motor in the CC and that of the position in the MC, or what is derived from
        /// the motor's for it (HFS-NAV-004): the magnitude of nominal minus actual position, the intended following error already taken off.
        pub deviation: Distance,
        /// The nominal speed in increments per cycle, with its sign.
        pub nominal: i32,
        /// The actual speed in increments per cycle, with its sign.
        pub actual: i32,
    }
}

impl Inputs {
    /// What is compared in this state: table 4.8.15.
    pub const fn compared(&self, config: &Config) -> Compared {
        match self.state {
            GroupState::Sto | GroupState::StoO => Compared::Nothing,
            GroupState::Auto => Compared::Speed,
            GroupState::Sls2
            | GroupState::Sls3
            | GroupState::Sls4
            | GroupState::SlsS
            | GroupState::Sos => {
                if config.spindle {
                    Compared::Speed
                } else if config.grouped {
                    Compared::Position
                } else {
                    Compared::Nothing
                }
            }
        }
    }

    /// Whether the speed is outside the tolerance.
    pub const fn speed_deviates(&self, config: &Config) -> bool {
        // 32 bits times at most a hundred.
        self.actual.abs_diff(self.nominal) as u64 * 100
            > self.nominal.unsigned_abs() as u64 * config.percent.get() as u64
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The position deviates by more than its tolerance.
        pub position: bool,
        /// The speed was not within its tolerance for a whole window.
        pub speed: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::comparison;
    /// Door open, also in the operating stop: an axis off its nominal position is stopped in the same cycle.
    position_off_is_stopped ["HFS-ARCH-004/f", "HFS-NAV-001", "HFS-NAV-002", "HFS-SOS-005"]:
        when |s| s.inputs.compared(&s.config) == Compared::Position && s.inputs.deviation > s.config.tolerance
            => s.outputs.position && s.outputs.demand == Stop::Ss1;

    /// At the tolerance and below the position is right.
    position_within_the_tolerance_is_right ["HFS-NAV-002"]:
        when |s| s.inputs.deviation <= s.config.tolerance || s.inputs.compared(&s.config) != Compared::Position
            => !s.outputs.position;

    /// Once within the tolerance the window starts again.
    window_starts_again_within_the_tolerance ["HFS-NAV-003"]:
        when |s| s.inputs.compared(&s.config) == Compared::Speed && !s.inputs.speed_deviates(&s.config)
            => s.after.outside.is_zero() && s.outputs.demand == Stop::None;

    /// A whole window outside is a fault; each cycle outside brings it nearer by one.
    window_outside_is_stopped ["HFS-NAV-003", "HFS-NAV-006"]:
        when |s| s.inputs.compared(&s.config) == Compared::Speed && s.inputs.speed_deviates(&s.config)
            => s.after.outside.count() as u64
                == (s.before.outside.count() as u64 + 1).min(s.config.window.count() as u64)
                && s.outputs.speed == (s.after.outside == s.config.window)
                && s.outputs.speed == (s.outputs.demand == Stop::Ss1);

    /// A spindle is compared by its speed in every state with torque.
    spindle_is_compared_by_speed ["HFS-NAV-001", "HFS-NAV-006"]:
        when |s| s.config.spindle && !matches!(s.inputs.state, GroupState::Sto | GroupState::StoO)
            => s.inputs.compared(&s.config) == Compared::Speed && !s.outputs.position;

    /// The positions of an axis without a group are not compared, in no state.
    axis_without_group_is_not_compared ["HFS-NS-001/f"]:
        when |s| !s.config.grouped && !s.config.spindle
            => !s.outputs.position && (s.outputs.demand == Stop::None || s.outputs.speed);

    /// Without torque nothing is compared.
    nothing_is_compared_without_torque ["HFS-NAV-001"]:
        when |s| matches!(s.inputs.state, GroupState::Sto | GroupState::StoO)
            => s.outputs == Outputs::default() && s.after == State::INITIAL;

    /// Without a deviation nothing is raised, and the time outside stays in its range.
    no_demand_without_deviation ["HFS-NAV-002", "HFS-NAV-003"]:
        when |s| !s.outputs.position && !s.outputs.speed
            => s.outputs.demand == Stop::None && s.after.invariant(&s.config);

    /// The time outside never exceeds the window.
    state_stays_consistent ["HFS-NAV-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let compared = inputs.compared(config);
    let outside = if compared == Compared::Speed && inputs.speed_deviates(config) {
        Cycles::new(state.outside.count().saturating_add(1)).min(config.window)
    } else {
        Cycles::ZERO
    };
    let position = compared == Compared::Position && inputs.deviation > config.tolerance;
    let speed = outside == config.window;
    let outputs = Outputs {
        position,
        speed,
        demand: if position || speed {
            Stop::Ss1
        } else {
            Stop::None
        },
    };
    (State { outside }, outputs)
}
