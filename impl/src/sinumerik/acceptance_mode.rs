//! Acceptance test mode of one axis in one channel (machine `acceptance_mode`).
//!
//! A step of the acceptance test that tries SBH or SG (group 1) is carried out in a mode that lets the axis reach the limit
//! of the monitor and has RESET acknowledge what follows; both channels must permit it. A step that tries SE (group 2) only
//! takes the software limit switches of the NCK away. Stops are not weakened in either.
//!
//! What is a condition of the entry only (pulses, alarms) does not end the mode: the tested response cancels the pulses.
//!
//! Not printed, and so chosen here: the mode also ends with the phase and with the selection of its step, and a step that has
//! had its mode gets another one only after a new selection.
//!
//! The RESET key and the NCK reset are two things: the first acknowledges in the mode ([`crate::sinumerik::acceptance_alarm`]),
//! the second ends it.

use crate::kernel::{ConfigError, Cycles, Percent};

/// The longest mode, 100 s, in cycles of 31.25 us.
pub const HUNDRED_SECONDS: Cycles = Cycles::new(3_200_000);

config! {
    /// The mode as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        nck: bool,
        t_test: Cycles,
        t_differ: Cycles,
        setpoint_percent: Percent,
    }
}

impl Config {
    /// `nck`: this is the NCK channel, which alone has group 2. `t_test`: the longest mode (SAFE_ACCEPTANCE_TST_TIMEOUT, in
    /// the drive SAFE_ACC_TEST_TIMEOUT). `t_differ`: how long the channels may differ, 2 s. `setpoint_percent`: the setpoint limit
    /// outside of the mode (SAFE_DES_VELO_LIMIT).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0, [`ConfigError::DelayTooLong`] for a mode above [`HUNDRED_SECONDS`].
    pub fn new(
        nck: bool,
        t_test: Cycles,
        t_differ: Cycles,
        setpoint_percent: Percent,
    ) -> Result<Self, ConfigError> {
        if t_test.is_zero() || t_differ.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            nck,
            t_test: t_test.at_most(HUNDRED_SECONDS)?,
            t_differ,
            setpoint_percent,
        })
    }
}

fields! {
    /// What a step of the acceptance test tries, and which mode is in force.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Group {
        /// Nothing.
        #[default]
        None,
        /// SBH or SG.
        One,
        /// SE.
        Two,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The mode in force.
        pub mode: Group,
        /// Cycles since it began.
        pub lasted: Cycles,
        /// The selected step has had its mode.
        pub spent: bool,
        /// This channel permits the mode of group 1.
        pub permits: bool,
        /// The channels differ.
        pub unlike: bool,
        /// For so many cycles since.
        pub differed: Cycles,
    }
}

impl State {
    /// No mode.
    pub const INITIAL: Self = Self {
        mode: Group::None,
        lasted: Cycles::ZERO,
        spent: false,
        permits: false,
        unlike: false,
        differed: Cycles::ZERO,
    };

    /// Each time has not yet run out, and runs only where there is something to measure; group 2 is the NCK's.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let timed = match self.mode {
            Group::None => self.lasted.is_zero(),
            Group::One => self.lasted < config.t_test && !self.spent,
            Group::Two => self.lasted < config.t_test && config.nck && !self.spent && !self.permits,
        };
        timed
            && !(self.permits && self.spent)
            && self.differed < config.t_differ
            && (self.unlike || self.differed.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The acceptance test function is selected.
        pub phase: bool,
        /// What the selected step tries.
        pub test: Group,
        /// An SI alarm that needs power-on is active on the axis.
        pub power_on_alarm: bool,
        /// The pulses of the axis are enabled.
        pub pulses: bool,
        /// JOG is the active mode of the NC.
        pub jog: bool,
        /// The monitoring function that the step tries is the active one.
        pub tested_active: bool,
        /// The measured value has been recorded.
        pub recorded: bool,
        /// NCK reset, not the RESET key.
        pub nck_reset: bool,
        /// The other channel has permitted the mode.
        pub other_permits: bool,
        /// The other channel is in the mode of group 1.
        pub other_mode: bool,
        /// A stop of this axis inhibits traversing, that of an external STOP C or D left out.
        pub own_inhibit: bool,
        /// An external STOP C or D is active.
        pub external_cd: bool,
        /// A stop of another axis inhibits traversing of this one.
        pub other_stop: bool,
    }
}

impl Inputs {
    /// What must hold when a mode begins.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn allows(&self) -> bool {
        self.phase
            && self.jog
            && self.pulses
            && self.tested_active
            && !self.power_on_alarm
            && !self.recorded
            && !self.nck_reset
    }

    /// What must hold while one lasts.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn keeps(&self, mode: Group) -> bool {
        self.phase
            && self.jog
            && self.tested_active
            && !self.recorded
            && !self.nck_reset
            && self.test == mode
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The mode of group 1: alarm 27007, in the drive 300952.
        pub active: bool,
        /// The mode of group 2: the software limit switches of the NCK are off, alarm 27008.
        pub limits_off: bool,
        /// The setpoint limit in force; 0 is no limit.
        pub percent: Percent,
        /// Traversing is inhibited.
        pub inhibit: bool,
        /// No alarm is suppressed.
        pub show_all: bool,
        /// The channels have differed too long: code 1011.
        pub differs: bool,
    }
}

monitor! { sinumerik::acceptance_mode;
    /// The mode of group 1 begins under all its conditions, which both channels see.
    group_1_begins_under_conditions ["S840D-ACCEPT-739"]:
        when |s| s.before.mode != Group::One && s.after.mode == Group::One
            => s.inputs.allows() && s.inputs.test == Group::One && s.inputs.other_permits && !s.before.spent
                && s.before.mode == Group::None;

    /// And then it does.
    group_1_begins ["S840D-ACCEPT-739"]:
        when |s| s.before.mode == Group::None && !s.before.spent && s.inputs.allows() && s.inputs.test == Group::One
            => s.after.permits && (s.after.mode == Group::One) == s.inputs.other_permits;

    /// The mode of group 2 begins under the same conditions, without the other channel, and in the NCK only.
    group_2_begins_under_conditions ["S840D-ACCEPT-748"]:
        when |s| s.before.mode == Group::None && s.inputs.test == Group::Two
            => (s.after.mode == Group::Two) == (s.inputs.allows() && s.config.nck && !s.before.spent);

    /// Pulses and alarms are conditions of the entry: they end no mode.
    response_does_not_end_the_mode ["S840D-ACCEPT-739", "S840D-ACCEPT-748"]:
        when |s| s.before.mode != Group::None && s.inputs.keeps(s.before.mode)
            && s.before.lasted.count() + 1 < s.config.t_test.count()
            => s.after.mode == s.before.mode && s.after.lasted.count() == s.before.lasted.count() + 1;

    /// What the manual names ends the mode in the same cycle.
    mode_ends_with_its_conditions ["S840D-ACCEPT-746", "S840D-ACCEPT-750"]:
        when |s| s.before.mode != Group::None && !s.inputs.keeps(s.before.mode)
            => s.after.mode == Group::None;

    /// So does its time.
    mode_ends_with_its_time ["S840D-ACCEPT-746", "S840D-ACCEPT-750", "S840D-PARAM-023/a", "S840D-PARAM-023/c", "S840D-MDTIM-016/a"]:
        when |s| s.before.mode != Group::None && s.before.lasted.count().saturating_add(1) >= s.config.t_test.count()
            => s.after.mode == Group::None;

    /// A step has its mode once.
    step_has_its_mode_once ["S840D-ACCEPT-746", "S840D-ACCEPT-750"]:
        when |s| s.inputs.test != Group::None && (s.before.spent || (s.before.mode != Group::None && s.after.mode == Group::None))
            => s.after.spent && s.after.mode == Group::None && !s.after.permits;

    /// The NCK reset ends everything of the axis.
    nck_reset_ends_the_mode ["S840D-ACCEPT-746", "S840D-ACCEPT-750"]:
        when |s| s.inputs.nck_reset
            => s.after.mode == Group::None && !s.after.permits && !s.after.unlike && !s.outputs.differs;

    /// The message of the mode of group 1 is there as long as the mode.
    mode_is_told ["S840D-ACCEPT-740", "S840D-PARAM-023/a"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.active == (s.after.mode == Group::One);

    /// The setpoint limit is off in the mode of group 1 only.
    setpoint_limit_is_off ["S840D-ACCEPT-741"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.percent.get() == if s.after.mode == Group::One { 0 } else { s.config.setpoint_percent.get() };

    /// In the mode of group 1 neither an external STOP C or D nor another axis keeps the axis from traversing.
    mode_lets_traverse ["S840D-ACCEPT-743", "S840D-ACCEPT-744"]:
        when |s| s.after.mode == Group::One
            => s.outputs.inhibit == s.inputs.own_inhibit;

    /// Outside of it each of them does.
    others_inhibit ["S840D-ACCEPT-743", "S840D-ACCEPT-744"]:
        when |s| s.after.mode != Group::One
            => s.outputs.inhibit == (s.inputs.own_inhibit || s.inputs.external_cd || s.inputs.other_stop);

    /// The software limit switches are off in the mode of group 2 only, with their message.
    limit_switches_are_off ["S840D-ACCEPT-749", "S840D-ACCEPT-750", "S840D-PARAM-023/c"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.limits_off == (s.after.mode == Group::Two);

    /// In the phase every alarm is shown.
    phase_shows_every_alarm ["S840D-ACCEPT-738"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.show_all == s.inputs.phase;

    /// Channels that differ for the whole time are told, and no sooner.
    difference_is_told ["S840D-ACCEPT-747", "S840D-TIMING-702/c"]:
        when |s| s.before.unlike && !s.inputs.nck_reset && s.inputs.other_mode != (s.before.mode == Group::One)
            => s.outputs.differs == (s.before.differed.count() + 1 == s.config.t_differ.count());

    /// A difference counts from its first cycle on, without a gap.
    difference_counts ["S840D-ACCEPT-747"]:
        when |s| !s.inputs.nck_reset && s.inputs.other_mode != (s.before.mode == Group::One) && !s.outputs.differs
            => s.after.unlike && s.after.differed.count() == if s.before.unlike { s.before.differed.count() + 1 } else { 0 };

    /// Channels that agree are no error.
    agreement_is_none ["S840D-ACCEPT-747"]:
        when |s| !s.before.unlike || s.inputs.other_mode == (s.before.mode == Group::One)
            => !s.outputs.differs;

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-ACCEPT-739"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = state;
    // The mode.
    let lasts = Cycles::new(state.lasted.count().saturating_add(1));
    match state.mode {
        Group::None => {
            after.spent = state.spent && inputs.test != Group::None;
            let ready = inputs.allows() && !after.spent;
            after.permits = ready && inputs.test == Group::One;
            if after.permits && inputs.other_permits {
                after.mode = Group::One;
            } else if ready && config.nck && inputs.test == Group::Two {
                after.mode = Group::Two;
            }
            if inputs.nck_reset {
                after.spent = inputs.test != Group::None;
            }
        }
        mode if inputs.keeps(mode) && lasts < config.t_test => {
            after.lasted = lasts;
            after.permits = inputs.allows() && mode == Group::One;
        }
        _ => {
            after.mode = Group::None;
            after.lasted = Cycles::ZERO;
            after.spent = inputs.test != Group::None;
            after.permits = false;
        }
    }
    // The comparison with the other channel: of what both were after the last cycle.
    let unlike = inputs.other_mode != (state.mode == Group::One) && !inputs.nck_reset;
    let told =
        state.unlike && Cycles::new(state.differed.count().saturating_add(1)) >= config.t_differ;
    let differs = unlike && told;
    after.unlike = unlike && !differs;
    after.differed = if after.unlike && state.unlike {
        Cycles::new(state.differed.count().saturating_add(1))
    } else {
        Cycles::ZERO
    };
    let active = after.mode == Group::One;
    let free = Percent::new(0).unwrap_or(config.setpoint_percent);
    let outputs = Outputs {
        active,
        limits_off: after.mode == Group::Two,
        percent: if active {
            free
        } else {
            config.setpoint_percent
        },
        inhibit: inputs.own_inhibit || (!active && (inputs.external_cd || inputs.other_stop)),
        show_all: inputs.phase,
        differs,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-ACCEPT-746.
    #[test]
    fn a_mode_lasts_for_a_hundred_seconds_at_most() {
        let new = |test| Config::new(true, Cycles::new(test), Cycles::new(1), Percent::WHOLE);
        let longest = HUNDRED_SECONDS.count();
        assert!(new(longest).is_ok());
        assert_eq!(new(longest + 1), Err(ConfigError::DelayTooLong));
        assert_eq!(new(0), Err(ConfigError::NoDelay));
    }
}
