//! Pulse cancellation of the NCK channel: over the drive bus first, externally where that fails (machine M7).
//!
//! With internal cancellation the pulses are cancelled over the drive bus; if they are not reported cancelled within
//! t_chk, or the report is lost later, the external enable (terminal 663, perhaps common to several drives) is taken away
//! too, and stays away until the request for cancellation ends. Without internal cancellation the enable of the pulses is
//! the signal to terminal 663 itself and nothing is supervised.
//!
//! Readings: A-19 CANCEL_FAIL_TCHK (internal cancellation has failed after t_chk).

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The shutdown path as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        internal: bool,
        t_chk: Cycles,
    }
    accepted |config| Config::new(config.internal, config.internal, config.t_chk).is_ok()
}

impl Config {
    /// `internal`: cancellation over the drive bus (bit 30 of 36986). `external_path`: an output "enable pulses externally"
    /// and an input for its test are assigned. `t_chk`: the time in which the pulses must be cancelled.
    ///
    /// # Errors
    /// [`ConfigError::NoExternalPath`] when `internal` lacks the external path (S840D-PARAM-507),
    /// [`ConfigError::DelayTooLong`] when `t_chk` is above [`Cycles::TEN_SECONDS`].
    pub fn new(internal: bool, external_path: bool, t_chk: Cycles) -> Result<Self, ConfigError> {
        if internal && !external_path {
            return Err(ConfigError::NoExternalPath);
        }
        Ok(Self {
            internal,
            t_chk: t_chk.at_most(Cycles::TEN_SECONDS)?,
        })
    }
}

fields! {
    /// What has been done to the pulses.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Enabled.
        Enabled,
        /// Cancelled over the drive bus; the feedback is awaited.
        CancelInt,
        /// Cancelled, and with internal cancellation reported so.
        #[default]
        Cancelled,
        /// The external enable is taken away too.
        CancelExt,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What has been done to the pulses.
        pub phase: Phase,
        /// What is left of t_chk; 0 unless the feedback is awaited.
        pub timer: Cycles,
    }
}

impl State {
    /// Cancelled: the pulses are off before run-up.
    pub const INITIAL: Self = Self {
        phase: Phase::Cancelled,
        timer: Cycles::ZERO,
    };

    /// The timer runs exactly while the feedback is awaited, for at most t_chk; nothing is supervised without internal
    /// cancellation.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_chk
            && self.timer.is_zero() == (self.phase != Phase::CancelInt)
            && (config.internal || matches!(self.phase, Phase::Enabled | Phase::Cancelled))
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: the cancellation is supervised from its beginning.
        pub power_on: bool,
        /// The run-up is complete: before it the pulses are off.
        pub run_up: bool,
        /// The pulses are to be cancelled in this cycle (see [`crate::sinumerik::stop`]).
        pub cancel: bool,
        /// The test of the external shutdown runs (see [`crate::sinumerik::shutdown_test`]).
        pub external_test: bool,
        /// Feedback: the pulses are cancelled.
        pub feedback: bool,
    }
}

impl Inputs {
    /// The pulses are to be off.
    const fn off(&self) -> bool {
        self.cancel || !self.run_up
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// "Enable pulses": 0 requests their cancellation.
        pub enable: bool,
        /// "Enable pulses externally".
        pub enable_external: bool,
    }
}

monitor! { sinumerik::pulses;
    /// A request to cancel acts in the same cycle, and so does an incomplete run-up.
    cancellation_acts_at_once ["S840D-SH-001", "S840D-P-01", "S840D-P-54", "S840D-PULSE-001", "S840D-PULSE-002", "S840D-ARCH-505"]:
        when |s| s.inputs.cancel || !s.inputs.run_up
            => !s.outputs.enable;

    /// Without reason the pulses are not cancelled.
    enabled_without_reason_against ["S840D-PULSE-006/b"]:
        when |s| !s.inputs.cancel && s.inputs.run_up
            => s.outputs.enable && s.after.phase == Phase::Enabled;

    /// Internal cancellation that begins awaits its feedback for the whole t_chk; without that time it falls back at once.
    cancellation_starts_its_time ["S840D-PULSE-005", "S840D-PULSE-007", "S840D-SIGNAL-015"]:
        when |s| s.config.internal && (s.inputs.cancel || !s.inputs.run_up)
            && (s.before.phase == Phase::Enabled || s.inputs.power_on)
            => if s.config.t_chk.is_zero() { s.after.phase == Phase::CancelExt }
                else { s.after.phase == Phase::CancelInt && s.after.timer == s.config.t_chk };

    /// Without feedback the timer is lower each cycle, and at its end the external enable is taken away.
    missing_feedback_falls_back ["S840D-PULSE-005", "S840D-PULSE-007"]:
        when |s| s.before.phase == Phase::CancelInt && (s.inputs.cancel || !s.inputs.run_up) && !s.inputs.feedback
            && !s.inputs.power_on
            => if s.after.phase == Phase::CancelInt { s.after.timer < s.before.timer }
                else { s.after.phase == Phase::CancelExt && !s.outputs.enable_external };

    /// Pulses reported as no longer cancelled, while they are to be, take the external enable away.
    lost_feedback_falls_back ["S840D-PULSE-005", "S840D-PULSE-007"]:
        when |s| s.config.internal && s.before.phase == Phase::Cancelled && (s.inputs.cancel || !s.inputs.run_up)
            && !s.inputs.feedback && !s.inputs.power_on
            => s.after.phase == Phase::CancelExt && !s.outputs.enable_external;

    /// Feedback in time keeps the external enable of the group.
    feedback_keeps_the_external_enable ["S840D-PULSE-005", "S840D-PULSE-008"]:
        when |s| matches!(s.before.phase, Phase::CancelInt | Phase::Cancelled) && (s.inputs.cancel || !s.inputs.run_up)
            && s.inputs.feedback && !s.inputs.power_on
            => s.after.phase == Phase::Cancelled && s.outputs.enable_external != s.inputs.external_test;

    /// The external enable that was taken away comes back only when the pulses need no longer be cancelled, or by power-on.
    fallback_is_kept ["S840D-PULSE-005"]:
        when |s| s.before.phase == Phase::CancelExt && (s.inputs.cancel || !s.inputs.run_up) && !s.inputs.power_on
            => s.after.phase == Phase::CancelExt && !s.outputs.enable_external;

    /// The test of the external shutdown takes the external enable away and leaves the internal one.
    external_test_acts_externally ["S840D-TEST-016", "S840D-TEST-011", "S840D-SIGNAL-010"]:
        when |s| s.inputs.external_test
            => !s.outputs.enable_external && s.outputs.enable == (!s.inputs.cancel && s.inputs.run_up);

    /// Without internal cancellation nothing is supervised: the enable is the signal to terminal 663.
    direct_path_follows_the_request ["S840D-PULSE-004"]:
        when |s| !s.config.internal
            => matches!(s.after.phase, Phase::Enabled | Phase::Cancelled)
                && s.outputs.enable_external != s.inputs.external_test;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-PULSE-006/b"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.enable == (s.after.phase == Phase::Enabled);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State {
            phase: Phase::Enabled,
            timer: Cycles::ZERO,
        }
    } else {
        state
    };
    let (phase, timer) = if !inputs.off() {
        (Phase::Enabled, Cycles::ZERO)
    } else if !config.internal {
        (Phase::Cancelled, Cycles::ZERO)
    } else {
        match before.phase {
            Phase::Enabled => awaiting(config.t_chk),
            Phase::CancelInt | Phase::Cancelled if inputs.feedback => {
                (Phase::Cancelled, Cycles::ZERO)
            }
            Phase::CancelInt => awaiting(before.timer.tick()),
            Phase::Cancelled | Phase::CancelExt => (Phase::CancelExt, Cycles::ZERO),
        }
    };
    let outputs = Outputs {
        enable: phase == Phase::Enabled,
        enable_external: phase != Phase::CancelExt && !inputs.external_test,
    };
    (State { phase, timer }, outputs)
}

/// The feedback is awaited for `timer`; without time left the external enable is taken away.
const fn awaiting(timer: Cycles) -> (Phase, Cycles) {
    if timer.is_zero() {
        (Phase::CancelExt, Cycles::ZERO)
    } else {
        (Phase::CancelInt, timer)
    }
}
