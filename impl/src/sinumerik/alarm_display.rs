//! Whether an active alarm is shown and logged (machine `alarm_display`): suppression and priorities of
//! SAFE_ALARM_SUPPRESS_LEVEL (MD 10094).
//!
//! Display only: nothing here goes back to an alarm or a stop (S840D-ALARM-701). Which alarms are twins, and which have priority
//! over which, says [`crate::sinumerik::message`].
//!
//! The manual does not tell what becomes of a hidden alarm whose twin goes: here it is shown then. One that a priority has hidden
//! stays so.

fields! {
    /// SAFE_ALARM_SUPPRESS_LEVEL.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum SuppressLevel {
        /// 0: everything is shown, of both channels.
        Everything,
        /// 1: of the alarms of both channels the first one.
        First,
        /// 2, the default: what the PLC initiates too is shown once.
        #[default]
        Once,
        /// 3: as 2, and 27000 and 300950 are replaced by 27100.
        Grouped,
        /// 12: as 2, with priorities.
        OncePriorities,
        /// 13: as 3, with priorities.
        GroupedPriorities,
    }
}

impl SuppressLevel {
    /// The level of a value of MD 10094; `None` for a value that is none, which is alarm 27034 (S840D-ALARM-702).
    pub const fn new(value: u8) -> Option<Self> {
        Some(match value {
            0 => Self::Everything,
            1 => Self::First,
            2 => Self::Once,
            3 => Self::Grouped,
            12 => Self::OncePriorities,
            13 => Self::GroupedPriorities,
            _ => return None,
        })
    }

    /// Alarms have priorities.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn prioritises(self) -> bool {
        matches!(self, Self::OncePriorities | Self::GroupedPriorities)
    }

    /// 27100 stands for 27000 and 300950.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn groups(self) -> bool {
        matches!(self, Self::Grouped | Self::GroupedPriorities)
    }
}

fields! {
    /// What an alarm has beside it.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Twin {
        /// Nothing.
        #[default]
        None,
        /// The alarm of the other channel.
        Channel,
        /// Itself, initiated a second time by the PLC.
        Twice,
        /// The group alarm 27100.
        Group,
    }
}

config! {
    /// The alarm.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        twin: Twin,
    }
    accepted |config| *config == Config::new(config.twin)
}

impl Config {
    /// `twin`: what the alarm has beside it.
    pub const fn new(twin: Twin) -> Self {
        Self { twin }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The alarm was active in the cycle before.
        pub was: bool,
        /// It is shown.
        pub shown: bool,
        /// It is in the alarm log.
        pub logged: bool,
        /// It is not shown because its twin is.
        pub twinned: bool,
    }
}

impl State {
    /// No alarm.
    pub const INITIAL: Self = Self {
        was: false,
        shown: false,
        logged: false,
        twinned: false,
    };

    /// What is shown is logged, and nothing is without an alarm.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        (!self.shown || (self.logged && !self.twinned))
            && (self.was || !(self.logged || self.twinned))
            && !(self.twinned && self.logged)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The alarm is active.
        pub active: bool,
        /// Its twin has been active before it.
        pub other: bool,
        /// It is a 27001 with code 0.
        pub code_0: bool,
        /// An alarm that has priority over it is active.
        pub priority: bool,
        /// SAFE_ALARM_SUPPRESS_LEVEL.
        pub level: SuppressLevel,
        /// Acceptance test phase.
        pub phase: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// It is active and not shown; a hidden 27024 has 27124 in its place.
        pub hidden: bool,
        /// 27100 stands in its place.
        pub grouped: bool,
    }
}

monitor! { sinumerik::alarm_display;
    /// Level 0, and the acceptance test phase, show every alarm that comes.
    everything_is_shown ["S840D-ALARM-702", "S840D-ACCEPT-738"]:
        when |s| s.inputs.active && !s.before.was && (s.inputs.level == SuppressLevel::Everything || s.inputs.phase)
            => s.after.shown && s.after.logged && !s.outputs.hidden;

    /// Without twin, code 0 and priority an alarm is shown on every level.
    lonely_alarm_is_shown ["S840D-ALARM-702"]:
        when |s| s.inputs.active && !s.before.was && s.config.twin == Twin::None && !s.inputs.code_0 && !s.inputs.priority
            => s.after.shown;

    /// Of the alarms of both channels the first one is shown, from level 1 on.
    first_channel_is_shown ["S840D-ALARM-702"]:
        when |s| s.inputs.active && !s.before.was && s.config.twin == Twin::Channel && !s.inputs.code_0 && !s.inputs.priority
            && !s.inputs.phase && s.inputs.level != SuppressLevel::Everything
            => s.after.shown != s.inputs.other;

    /// What the PLC initiates a second time is hidden from level 2 on.
    second_initiation_is_hidden ["S840D-ALARM-702"]:
        when |s| s.inputs.active && !s.before.was && s.config.twin == Twin::Twice && !s.inputs.code_0 && !s.inputs.priority
            && !s.inputs.phase && s.inputs.other
            => s.after.shown == matches!(s.inputs.level, SuppressLevel::Everything | SuppressLevel::First);

    /// 27001 with code 0 is hidden from level 1 on.
    code_0_is_hidden ["S840D-ALARM-702", "S840D-KDV-703"]:
        when |s| s.inputs.active && !s.before.was && s.inputs.code_0 && !s.inputs.phase
            && s.inputs.level != SuppressLevel::Everything
            => s.outputs.hidden && !s.after.logged;

    /// With level 3 and 13 the group alarm stands for 27000 and 300950.
    group_alarm_replaces ["S840D-ALARM-702"]:
        when |s| s.inputs.active && !s.before.was && s.config.twin == Twin::Group && !s.inputs.phase && s.inputs.level.groups()
            => s.outputs.grouped && s.outputs.hidden;

    /// A follow-on alarm that comes later is neither shown nor logged.
    later_follow_on_is_silent ["S840D-ALARM-704"]:
        when |s| s.inputs.active && !s.before.was && s.inputs.priority && s.inputs.level.prioritises() && !s.inputs.phase
            => s.outputs.hidden && !s.after.logged;

    /// One that was there before is cleared, and stays in the log.
    earlier_follow_on_is_cleared ["S840D-ALARM-704"]:
        when |s| s.inputs.active && s.before.shown && s.inputs.priority && s.inputs.level.prioritises() && !s.inputs.phase
            => s.outputs.hidden && s.after.logged;

    /// Without priorities no alarm that is shown is hidden again.
    suppression_hides_no_earlier_alarm ["S840D-ALARM-702", "S840D-ALARM-704"]:
        when |s| s.inputs.active && s.before.shown && !(s.inputs.priority && s.inputs.level.prioritises())
            => s.after.shown;

    /// A hidden alarm is told as such as long as it is active: for 27024 that is 27124.
    hidden_alarm_is_told ["S840D-ALARM-701", "S840D-ALARM-709"]:
        when |s| s.inputs.active
            => s.outputs.hidden != s.after.shown;

    /// An alarm that has gone is not shown.
    no_alarm_no_display ["S840D-ALARM-704"]:
        when |s| !s.inputs.active
            => s.after == State::INITIAL && !s.outputs.hidden && !s.outputs.grouped;

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-ALARM-704"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.was == s.inputs.active;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.active {
        return (State::INITIAL, Outputs::default());
    }
    // The acceptance test phase is as level 0.
    let level = if inputs.phase {
        SuppressLevel::Everything
    } else {
        inputs.level
    };
    let replaced = (inputs.code_0 && level >= SuppressLevel::First)
        || (config.twin == Twin::Group && level.groups());
    let from = match config.twin {
        Twin::Channel => Some(SuppressLevel::First),
        Twin::Twice => Some(SuppressLevel::Once),
        Twin::None | Twin::Group => None,
    };
    let twinned = inputs.other && !replaced && from.is_some_and(|from| level >= from);
    let after = if inputs.priority && level.prioritises() {
        State {
            was: true,
            shown: false,
            logged: state.logged,
            twinned: false,
        }
    } else if !state.was {
        let shown = !replaced && !twinned;
        State {
            was: true,
            shown,
            logged: shown,
            twinned,
        }
    } else if state.twinned && !inputs.other {
        State {
            was: true,
            shown: true,
            logged: true,
            twinned: false,
        }
    } else {
        state
    };
    let outputs = Outputs {
        hidden: !after.shown,
        grouped: config.twin == Twin::Group && level.groups(),
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-ALARM-702.
    #[test]
    fn other_values_are_no_levels() {
        let levels = (0..=u8::MAX).filter(|value| SuppressLevel::new(*value).is_some());
        assert!(levels.eq([0, 1, 2, 3, 12, 13]));
    }
}
