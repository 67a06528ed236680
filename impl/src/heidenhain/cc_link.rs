//! What one controller computer (CC) is told about a drive of another one by the telegrams between them (CC-CC communication).
//!
//! Every 3 ms a CC tells the others of each of its drives whether it moves, its axis group, its actual position, the control
//! of its brake, the cut-out port of channel B, and whether it has found a fatal fault in itself (HFS-ARCH-003). A faulty telegram
//! leads to a reaction within four of these cycles, its own counted (HFS-TIMING-003). Until then the last sound telegram
//! counts, but the drive is taken to move.
//!
//! The manual says neither which reaction it is nor how many faulty telegrams are tolerated. The reading here: a lost link is
//! fatal, SS1F, and so is the fault that the other CC reports; up to three faulty telegrams in a row are tolerated. A lost
//! link stays lost until the main switch is operated.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Position};

config! {
    /// How many faulty telegrams in a row are tolerated.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        tolerated: u8,
    }
}

impl Config {
    /// The most that may be tolerated: with the fourth one the 12 ms of the manual are over.
    pub const MOST: u8 = 3;

    /// `tolerated`: faulty telegrams in a row without a reaction, 0 to [`Config::MOST`].
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] above [`Config::MOST`].
    pub const fn new(tolerated: u8) -> Result<Self, ConfigError> {
        if tolerated > Self::MOST {
            Err(ConfigError::ValueOutOfRange)
        } else {
            Ok(Self { tolerated })
        }
    }

    /// Faulty telegrams in a row without a reaction.
    pub const fn tolerated(&self) -> u8 {
        self.tolerated
    }
}

fields! {
    /// What a telegram says about a drive.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Drive {
        /// It moves; else it stands still.
        pub moving: bool,
        /// Its axis group, 0 to 7; none: no safe axis.
        pub group: Option<u8>,
        /// Its actual position.
        pub position: Position,
        /// Its brake is controlled to be open: -BRK_REL.B.x or -BRK.B.x is 1.
        pub brake_open: bool,
        /// Its cut-out port of channel B gives it torque: -STO.B.x is 1.
        pub torque: bool,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The faulty telegrams in a row, at most those that are tolerated.
        pub faulty: u8,
        /// The last sound telegram.
        pub last: Drive,
        /// The link is lost.
        pub lost: bool,
    }
}

impl State {
    /// Nothing has been told yet: the link is sound, the drive stands without torque.
    pub const INITIAL: Self = Self {
        faulty: 0,
        last: Drive {
            moving: false,
            group: None,
            position: Position(0),
            brake_open: false,
            torque: false,
        },
        lost: false,
    };

    /// No more faulty telegrams than are tolerated.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        self.faulty <= config.tolerated
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub main_switch: bool,
        /// A telegram has come, and its checks find no fault.
        pub sound: bool,
        /// What it says; without meaning where it is not sound.
        pub drive: Drive,
        /// It reports a fatal fault of the other CC; without meaning where it is not sound.
        pub fatal: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The drive as this CC has to take it.
        pub drive: Drive,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::cc_link;
    /// A sound telegram counts as it is, and ends a row of faulty ones.
    sound_telegram_counts ["HFS-TIMING-003/a", "HFS-ARCH-003"]:
        when |s| s.inputs.sound && !s.inputs.main_switch
            => s.outputs.drive == s.inputs.drive && s.after.last == s.inputs.drive && s.after.faulty == 0;

    /// Without a sound telegram the drive is taken to move, and nothing else changes.
    faulty_telegram_is_motion ["HFS-TIMING-003/b", "HFS-ARCH-003"]:
        when |s| !s.inputs.sound && !s.inputs.main_switch
            => s.outputs.drive.moving && s.after.last == s.before.last
                && s.outputs.drive.position == s.before.last.position
                && s.outputs.drive.group == s.before.last.group
                && s.outputs.drive.brake_open == s.before.last.brake_open
                && s.outputs.drive.torque == s.before.last.torque;

    /// More faulty telegrams in a row than are tolerated: the link is lost.
    row_of_faulty_telegrams_stops ["HFS-TIMING-003/b"]:
        when |s| !s.inputs.sound && !s.inputs.main_switch && s.before.faulty >= s.config.tolerated()
            => s.outputs.demand == Stop::Ss1F && s.after.lost;

    /// Each faulty telegram counts one, so that the reaction comes with the fourth at the latest.
    faulty_telegrams_are_counted ["HFS-TIMING-003/b"]:
        when |s| !s.inputs.sound && !s.inputs.main_switch && s.before.faulty < s.config.tolerated()
            => s.after.faulty as u32 == s.before.faulty as u32 + 1 && s.config.tolerated() <= Config::MOST;

    /// A fatal fault of the other CC acts in the cycle of its telegram.
    fatal_fault_stops ["HFS-ARCH-003"]:
        when |s| s.inputs.sound && s.inputs.fatal && !s.inputs.main_switch
            => s.outputs.demand == Stop::Ss1F;

    /// A lost link stays lost until the main switch is operated.
    lost_link_stays_lost ["HFS-TIMING-003/b"]:
        when |s| s.before.lost && !s.inputs.main_switch
            => s.after.lost && s.outputs.demand == Stop::Ss1F;

    /// Nothing else stops.
    sound_link_stops_nothing ["HFS-TIMING-003/b", "HFS-ARCH-003"]:
        when |s| s.outputs.demand != Stop::None
            => s.outputs.demand == Stop::Ss1F && s.after.lost;

    /// The state stays consistent.
    state_stays_consistent ["HFS-TIMING-003/b"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.main_switch {
        return (State::INITIAL, Outputs::default());
    }
    let (last, drive) = if inputs.sound {
        (inputs.drive, inputs.drive)
    } else {
        let moving = Drive {
            moving: true,
            ..state.last
        };
        (state.last, moving)
    };
    let too_many = !inputs.sound && state.faulty >= config.tolerated;
    let lost = state.lost || too_many || (inputs.sound && inputs.fatal);
    let after = State {
        faulty: if inputs.sound {
            0
        } else {
            state.faulty.saturating_add(1).min(config.tolerated)
        },
        last,
        lost,
    };
    let demand = if lost { Stop::Ss1F } else { Stop::None };
    (after, Outputs { drive, demand })
}
