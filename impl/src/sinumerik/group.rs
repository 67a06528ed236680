//! What a stop of one axis does to another axis of the same channel (table in 5.2 and MD36964 of the manual).
//!
//! The setting SAFE_IPO_STOP_GROUP of the *stopping* axis decides how far its stop reaches. One call judges one pair, the
//! stopping axis and another one; of several stopping axes the other axis takes the highest reaction ([`worst`]), for
//! any number of axes. The reaction is not a safety function: the other axes are watched by their own monitors.
//!
//! Readings of the manual implemented here: A-21 GROUP1_EXT_NONE. STOP B, of which the table says nothing, acts like STOP A,
//! which it becomes. STOP F and the test stop brake no other axis, and what is queued beneath a test stop not before the test is
//! over. The delay of two interpolator cycles at most with which a wrongly configured ESR falls back to STOP D is not part
//! of this module.

use crate::sinumerik::level::{InternalStop, Level};

fields! {
    /// How far a stop of the axis reaches (SAFE_IPO_STOP_GROUP, MD36964).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Reach {
        /// 0: to every axis of the channel.
        #[default]
        Channel,
        /// 1: to the axes that interpolate with it, and only for stops that its monitors raised.
        Interpolating,
    }
}

fields! {
    /// What an axis does because another one stops, in rising order.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Reaction {
        /// Nothing.
        #[default]
        Unaffected,
        /// It takes part in the extended stop and retract.
        Esr,
        /// It brakes along its parameterised ramp.
        Ramp,
        /// It brakes along the path.
        Path,
        /// It brakes at the current limit.
        CurrentLimit,
        /// Fast stop of the interpolator for the whole channel.
        FastStop,
    }
}

config! {
    /// The setting of the stopping axis.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        reach: Reach,
    }
    accepted |config| *config == Config::new(config.reach)
}

impl Config {
    /// `reach`: SAFE_IPO_STOP_GROUP of the stopping axis.
    pub const fn new(reach: Reach) -> Self {
        Self { reach }
    }
}

fields! {
    /// Nothing is remembered.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State;
}

impl State {
    /// The only state.
    pub const INITIAL: Self = Self;

    /// The only state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The effective stop of the stopping axis.
        pub level: Level,
        /// Its latched internal stop, which comes with an alarm; a level above it was asked for by signals.
        pub internal: InternalStop,
        /// The two axes interpolate together.
        pub interpolates: bool,
        /// Extended stop and retract is configured, and its start programmed.
        pub esr: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What the other axis does.
        pub reaction: Reaction,
    }
}

monitor! { sinumerik::group;
    /// Without a stop that brakes there is no effect: STOP F is a message, the test stop concerns one channel of one axis and
    /// what is queued beneath it is not effective yet.
    message_and_test_affect_nobody ["S840D-STOP-060", "S840D-STOP-082"]:
        when |s| s.inputs.level == Level::Test
            || (s.inputs.level <= Level::F && s.inputs.internal == InternalStop::None)
            => s.outputs.reaction == Reaction::Unaffected;

    /// STOP A and B stop every axis of the channel, whether it interpolates or not.
    stop_a_stops_the_channel ["S840D-STOP-011", "S840D-STOP-082"]:
        when |s| s.config.reach == Reach::Channel && s.inputs.level >= Level::B
            => s.outputs.reaction == Reaction::FastStop;

    /// Setting 0, STOP C: interpolating axes at the current limit, all others along their ramp.
    stop_c_of_the_channel ["S840D-STOP-082", "S840D-EXT-016"]:
        when |s| s.config.reach == Reach::Channel && s.inputs.level == Level::C
            => s.outputs.reaction == if s.inputs.interpolates { Reaction::CurrentLimit } else { Reaction::Ramp };

    /// Setting 0, STOP D: along the path or along the ramp.
    stop_d_of_the_channel ["S840D-STOP-082", "S840D-EXT-016"]:
        when |s| s.config.reach == Reach::Channel && s.inputs.level == Level::D
            => s.outputs.reaction == if s.inputs.interpolates { Reaction::Path } else { Reaction::Ramp };

    /// STOP E with ESR starts it on every axis in reach of the channel.
    stop_e_starts_esr ["S840D-STOP-050", "S840D-STOP-082"]:
        when |s| s.config.reach == Reach::Channel && s.inputs.level == Level::E && s.inputs.esr
            => s.outputs.reaction == Reaction::Esr;

    /// STOP E without ESR does what STOP D does.
    stop_e_without_esr_is_stop_d ["S840D-STOP-051", "S840D-STOP-082", "S840D-EXT-012", "S840D-SIGNAL-014/b"]:
        when |s| s.inputs.level == Level::E && !s.inputs.esr
            => s.outputs.reaction == reaction(s.config, Inputs {
                level: Level::D,
                internal: if s.inputs.internal == InternalStop::E { InternalStop::D } else { s.inputs.internal },
                ..s.inputs
            });

    /// Setting 1: a stop asked for by signals alone leaves the other axes alone.
    group_1_external_stop_affects_nobody ["S840D-EXT-016", "S840D-EXT-017"]:
        when |s| s.config.reach == Reach::Interpolating && s.inputs.internal == InternalStop::None
            => s.outputs.reaction == Reaction::Unaffected;

    /// Setting 1: axes that do not interpolate with the stopping one go on, but for ESR, which is the channel's.
    group_1_others_go_on ["S840D-STOP-082", "S840D-EXT-016"]:
        when |s| s.config.reach == Reach::Interpolating && !s.inputs.interpolates && s.inputs.internal != InternalStop::E
            => s.outputs.reaction == Reaction::Unaffected;

    /// Setting 1: interpolating axes brake, along the ramp under STOP D, at the current limit under C, at once under A and B;
    /// a higher stop by signals changes nothing for them.
    group_1_interpolating_axes_brake ["S840D-STOP-082", "S840D-EXT-017"]:
        when |s| s.config.reach == Reach::Interpolating && s.inputs.interpolates && s.inputs.internal >= InternalStop::D
            && s.inputs.level != Level::Test
            => s.outputs.reaction == match s.inputs.internal {
                InternalStop::A | InternalStop::B => Reaction::FastStop,
                InternalStop::C => Reaction::CurrentLimit,
                InternalStop::None | InternalStop::E | InternalStop::D => Reaction::Ramp,
            };

    /// To interpolate with the stopping axis never makes the reaction weaker, setting 1 never makes it stronger.
    reactions_are_ordered ["S840D-STOP-082"]:
        when |s| s.inputs.level >= s.inputs.internal.level()
            => s.outputs.reaction >= reaction(s.config, Inputs { interpolates: false, ..s.inputs })
                && s.outputs.reaction <= reaction(Config { reach: Reach::Channel }, s.inputs);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let reaction = reaction(*config, *inputs);
    (state, Outputs { reaction })
}

/// The table of 5.2.
fn reaction(config: Config, inputs: Inputs) -> Reaction {
    let channel = config.reach == Reach::Channel;
    let cause = match (inputs.level, channel) {
        // What is queued beneath a test is not effective yet.
        (Level::Test, _) => Level::None,
        (level, true) => level,
        (_, false) => inputs.internal.level(),
    };
    let among = |interpolating, others| {
        if inputs.interpolates {
            interpolating
        } else if channel {
            others
        } else {
            Reaction::Unaffected
        }
    };
    match cause {
        Level::None | Level::F | Level::Test => Reaction::Unaffected,
        Level::E if inputs.esr => Reaction::Esr,
        Level::E | Level::D if channel => among(Reaction::Path, Reaction::Ramp),
        Level::E | Level::D => among(Reaction::Ramp, Reaction::Unaffected),
        Level::C => among(Reaction::CurrentLimit, Reaction::Ramp),
        Level::B | Level::A => among(Reaction::FastStop, Reaction::FastStop),
    }
}

/// The highest of the reactions that several stopping axes cause (S840D-STOP-082).
pub fn worst(reactions: &[Reaction]) -> Reaction {
    reactions.iter().copied().max().unwrap_or_default()
}

/// `$A_STOPESI`: whether a STOP E is active on at least one of the axes (S840D-STOP-054, S840D-SIGNAL-020/c).
pub fn stop_e_active(levels: &[Level]) -> bool {
    levels.contains(&Level::E)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_reaction_counts_for_any_number_of_axes() {
        assert_eq!(worst(&[]), Reaction::Unaffected);
        for a in Reaction::ALL {
            assert_eq!(worst(&[a]), a);
            for b in Reaction::ALL {
                assert_eq!(worst(&[a, Reaction::Unaffected, b]), a.max(b));
            }
        }
    }

    /// S840D-SIGNAL-020/c, S840D-STOP-054.
    #[test]
    fn the_channel_shows_a_stop_e_of_any_axis() {
        assert!(!stop_e_active(&[]));
        for level in Level::ALL {
            assert_eq!(
                stop_e_active(&[Level::None, level, Level::A]),
                level == Level::E
            );
        }
    }
}
