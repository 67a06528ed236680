//! User agreement of one channel: an authorised person confirms the safe position (machine M10).
//!
//! The agreement is non-volatile. It is given only with the key switch in position 3 (or the password) on a referenced
//! axis, and withdrawn by the user, by a change of the gear stage, by a failed comparison with the history, by altered
//! machine data, and when the channels differ for too long.
//!
//! Steps before [`mod@crate::sinumerik::reference`] in the cycle and sees its state of the cycle before. Recommended reading of the manual
//! implemented here: A-30 SE_ON_UA.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// Parameters of the agreement.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_differ: Cycles,
        se_sn_enabled: bool,
    }
}

impl Config {
    /// `t_differ`: how long the agreements of the channels may differ (2 s). `se_sn_enabled`: limit switches or cams are
    /// enabled on the axis.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when `t_differ` is zero, [`ConfigError::DelayTooLong`] above [`Cycles::SIXTY_SECONDS`].
    pub fn new(t_differ: Cycles, se_sn_enabled: bool) -> Result<Self, ConfigError> {
        if t_differ.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_differ: t_differ.at_most(Cycles::SIXTY_SECONDS)?,
            se_sn_enabled,
        })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The agreement is given. Non-volatile: kept through power-off.
        pub agreed: bool,
        /// What is left until agreements that differ are withdrawn; 0 while they are equal.
        pub timer: Cycles,
    }
}

impl State {
    /// No agreement, as delivered.
    pub const INITIAL: Self = Self {
        agreed: false,
        timer: Cycles::ZERO,
    };

    /// The state after power-on with the agreement read from the non-volatile memory.
    pub const fn restored(agreed: bool) -> Self {
        Self {
            agreed,
            timer: Cycles::ZERO,
        }
    }

    /// The timer runs for at most its time.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_differ
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: the agreement is kept.
        pub power_on: bool,
        /// The user gives the agreement.
        pub set: bool,
        /// The user withdraws the agreement.
        pub cancel: bool,
        /// Key switch in position 3, or the password has been entered.
        pub key: bool,
        /// The axis was in state "referenced" after the last cycle.
        pub axis_ref: bool,
        /// The axis has been referenced in the last cycle: compare with the history now.
        pub compare_due: bool,
        /// The reference position agrees with the stored one within the tolerance, in this channel.
        pub history_ok: bool,
        /// A stored standstill position exists.
        pub stored: bool,
        /// The gear stage has changed in this cycle (see [`crate::sinumerik::gear`]).
        pub gear_changed: bool,
        /// The machine data of the agreement have been altered by hand.
        pub altered: bool,
        /// The agreement of the other channel after the last cycle.
        pub other_agreed: bool,
    }
}

fields! {
    /// The fault code raised by the agreement (STOP F).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Code {
        /// No code.
        #[default]
        None = 0,
        /// 1002: the agreements of the channels differ too long.
        Differs = 1002,
        /// 1003: the position is not the stored one.
        Position = 1003,
        /// 1004: given again, or given on an axis that is not referenced.
        Plausibility = 1004,
    }
}

impl Code {
    /// The printed number: 0, 1002, 1003 or 1004.
    pub const fn number(self) -> u16 {
        self as u16
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The agreement is given.
        pub agreed: bool,
        /// The fault code raised in this cycle; of several the position comes before the difference before the plausibility.
        pub code: Code,
        /// The agreement has been withdrawn in this cycle.
        pub withdrawn: bool,
        /// The limit switches act (with the unverified agreement too: A-30 SE_ON_UA).
        pub se_active: bool,
    }
}

monitor! { sinumerik::agreement;
    /// The agreement is given only with the key and on a referenced axis, and only when the user gives it.
    given_only_with_key_and_reference ["S840D-P-48", "S840D-UA-004", "S840D-UA-005", "S840D-UA-003/a", "S840D-UA-003/b"]:
        when |s| !s.before.agreed && s.after.agreed
            => s.inputs.set && s.inputs.key && s.inputs.axis_ref;

    /// A change of the gear stage withdraws the agreement, also against a simultaneous agreement.
    gear_change_withdraws ["S840D-P-37", "S840D-GEAR-505", "S840D-UA-006", "S840D-PARAM-030/b"]:
        when |s| s.inputs.gear_changed
            => !s.after.agreed && !s.outputs.agreed;

    /// Altered machine data withdraw the agreement.
    alteration_withdraws ["S840D-UA-006", "S840D-UA-007", "S840D-PARAM-031"]:
        when |s| s.inputs.altered
            => !s.after.agreed;

    /// A due comparison without stored position or beyond the tolerance withdraws the agreement.
    failed_history_withdraws ["S840D-REF-012/b", "S840D-P-13", "S840D-REF-004", "S840D-REF-008", "S840D-REF-010",
        "S840D-UA-003/c", "S840D-REF-014", "S840D-REPLACE-701", "S840D-PARAM-030/b"]:
        when |s| s.before.agreed && s.inputs.compare_due && !(s.inputs.stored && s.inputs.history_ok)
            => !s.after.agreed && s.outputs.withdrawn;

    /// A position beyond the tolerance is reported with code 1003, where nothing else has withdrawn the agreement before.
    failed_history_is_reported ["S840D-REF-008", "S840D-REPLACE-701"]:
        when |s| s.before.agreed && s.inputs.compare_due && s.inputs.stored && !s.inputs.history_ok
            && !s.inputs.gear_changed && !s.inputs.altered
            => s.outputs.code == Code::Position;

    /// Without an agreement nothing is compared with the stored position: no code 1003.
    nothing_compared_without_agreement ["S840D-REPLACE-705"]:
        when |s| !s.before.agreed
            => s.outputs.code != Code::Position;

    /// The user withdraws with the key.
    user_withdraws_with_key ["S840D-UA-003/b", "S840D-UA-006", "S840D-UA-011"]:
        when |s| s.inputs.cancel && s.inputs.key
            => !s.after.agreed;

    /// Without the key neither giving nor withdrawing has an effect.
    locked_without_key ["S840D-UA-005", "S840D-UA-011"]:
        when |s| !s.inputs.key && !s.inputs.gear_changed && !s.inputs.altered && !s.inputs.compare_due
            && s.before.timer.is_zero()
            => s.after.agreed == s.before.agreed && s.outputs.code == Code::None;

    /// Nothing but the listed causes withdraws a given agreement; power-on keeps it.
    withdrawn_only_for_a_reason ["S840D-UA-003/d", "S840D-UA-006", "S840D-UA-007", "S840D-RETRACT-705"]:
        when |s| s.before.agreed && !s.after.agreed
            => s.inputs.gear_changed || s.inputs.altered
                || (s.inputs.compare_due && !(s.inputs.stored && s.inputs.history_ok)) || (s.inputs.cancel && s.inputs.key)
                || (!s.inputs.other_agreed && s.outputs.code == Code::Differs);

    /// Agreements that differ are withdrawn in time: each cycle the timer is lower, and at its end there is none.
    difference_ends_in_time ["S840D-UA-009", "S840D-TIMING-702/b"]:
        when |s| !s.before.timer.is_zero() && s.before.agreed != s.inputs.other_agreed && !s.inputs.power_on
            => s.after.timer < s.before.timer && (!s.after.timer.is_zero() || !s.after.agreed);

    /// Agreements that begin to differ start the whole time.
    difference_starts_its_timer ["S840D-UA-009", "S840D-TIMING-702/b"]:
        when |s| s.before.agreed != s.inputs.other_agreed && (s.before.timer.is_zero() || s.inputs.power_on)
            => s.after.timer == s.config.t_differ;

    /// Equal agreements stop the timer.
    equal_agreements_stop_the_timer ["S840D-UA-009"]:
        when |s| s.before.agreed == s.inputs.other_agreed
            => s.after.timer.is_zero() && s.outputs.code != Code::Differs;

    /// Given again, or given on an axis that is not referenced: code 1004 and no change, if no other cause acts.
    implausible_agreement_is_reported ["S840D-UA-004"]:
        when |s| s.inputs.set && s.inputs.key && (s.before.agreed || !s.inputs.axis_ref) && !s.inputs.cancel
            && !s.inputs.gear_changed && !s.inputs.altered && !s.inputs.compare_due
            && s.before.agreed == s.inputs.other_agreed
            => s.outputs.code == Code::Plausibility && s.after.agreed == s.before.agreed;

    /// Without agreement the limit switches raise nothing; with it they act where they are enabled.
    limit_switches_need_the_agreement ["S840D-P-12", "S840D-UA-002/a", "S840D-UA-008", "S840D-SE-010", "S840D-MDCOM-001",
        "S840D-RETRACT-702",
        "S840D-ALARM-719", "S840D-ACCEPT-706/b"]:
        when |s| !s.outputs.se_active || s.after.agreed
            => s.outputs.se_active == (s.after.agreed && s.config.se_sn_enabled);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-P-14", "S840D-UA-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.agreed == s.after.agreed
                && s.outputs.withdrawn == (s.before.agreed && !s.after.agreed);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let (agreed, code) = agree(state.agreed, inputs);
    let running = if inputs.power_on {
        Cycles::ZERO
    } else {
        state.timer
    };
    let differs = state.agreed != inputs.other_agreed;
    let (timer, expired) = match (differs, running.is_zero()) {
        (false, _) => (Cycles::ZERO, false),
        (true, true) => (config.t_differ, false),
        (true, false) => (running.tick(), running.tick().is_zero()),
    };
    let after = State {
        agreed: agreed && !expired,
        timer,
    };
    let outputs = Outputs {
        agreed: after.agreed,
        code: if expired && code != Code::Position {
            Code::Differs
        } else {
            code
        },
        withdrawn: state.agreed && !after.agreed,
        se_active: after.agreed && config.se_sn_enabled,
    };
    (after, outputs)
}

/// The agreement and the code by the events of this channel alone. Every withdrawal wins over giving.
fn agree(agreed: bool, inputs: &Inputs) -> (bool, Code) {
    let fails = inputs.compare_due && agreed && !(inputs.stored && inputs.history_ok);
    if inputs.gear_changed || inputs.altered {
        (false, Code::None)
    } else if fails {
        (
            false,
            if inputs.stored {
                Code::Position
            } else {
                Code::None
            },
        )
    } else if inputs.cancel && inputs.key {
        (false, Code::None)
    } else if inputs.set && inputs.key {
        let plausible = inputs.axis_ref && !agreed;
        (
            agreed || plausible,
            if plausible {
                Code::None
            } else {
                Code::Plausibility
            },
        )
    } else {
        (agreed, Code::None)
    }
}
