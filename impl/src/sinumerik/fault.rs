//! STOP F of one channel: what follows a discrepancy found by the cross comparison (machine M1, F region).
//!
//! With a safety function active and no STOP C, D or E effective before, STOP B follows after the delay t_F, whatever
//! happens in the meantime. Otherwise the fault is latched: a restart is prevented, machining goes on.
//!
//! Recommended readings of the manual implemented here: A-08 F_DELAY_STICKY, A-29 F_REARM_LATCHED, A-36 KDV_ON_EXTA.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The delay from STOP F to STOP B.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_f: Cycles,
    }
}

impl Config {
    /// `t_f`: the delay from STOP F to STOP B (`STOP_SWITCH_TIME_F`); 0 means at once.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above [`Cycles::SIXTY_SECONDS`].
    pub fn new(t_f: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            t_f: t_f.at_most(Cycles::SIXTY_SECONDS)?,
        })
    }
}

fields! {
    /// How far a discrepancy has come.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum FaultState {
        /// No discrepancy.
        #[default]
        None,
        /// Found without an active function, or under a STOP C, D or E: message and interlock only.
        Latched,
        /// The delay to STOP B runs.
        Delay,
        /// STOP B is requested, until power-on.
        Expired,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far a discrepancy has come.
        pub fault: FaultState,
        /// What is left of t_F in [`FaultState::Delay`], else 0.
        pub timer: Cycles,
    }
}

impl State {
    /// No discrepancy.
    pub const INITIAL: Self = Self {
        fault: FaultState::None,
        timer: Cycles::ZERO,
    };

    /// The timer runs exactly in the delay, and for at most t_F.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        (self.fault == FaultState::Delay) != self.timer.is_zero() && self.timer <= config.t_f
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// NC-RESET.
        pub reset: bool,
        /// This channel's comparison finds a discrepancy now.
        pub discrepancy: bool,
        /// STOP F received from the other channel: counts as a discrepancy (S840D-STOP-093).
        pub rx_fault: bool,
        /// A safety function is active in this channel now (S840D-STOP-089).
        pub monitoring: bool,
        /// A STOP C, D or E was effective before this cycle.
        pub cde_before: bool,
        /// A STOP B or A was latched before this cycle.
        pub ab_before: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// How far a discrepancy has come.
        pub fault: FaultState,
        /// The alarm "defect in a monitoring channel" (27001 / 300911) is raised in this cycle.
        pub alarm: bool,
        /// STOP B is requested.
        pub stop_b: bool,
        /// Bit 1 of `$VA_XFAULTSI`: the delay to STOP B is running or has expired (S840D-STOP-065).
        pub bit1: bool,
        /// NC start and traversing are interlocked.
        pub interlock: bool,
    }
}

monitor! { sinumerik::fault;
    /// A discrepancy with an active function and no STOP C, D or E before starts the full delay, or STOP B if it is 0.
    active_function_leads_to_stop_b ["S840D-P-21", "S840D-STOP-061", "S840D-STOP-063", "S840D-SIGNAL-019",
        "S840D-MDTIM-013",
        "S840D-ALARM-713", "S840D-ALARM-735"]:
        when |s| s.before.fault == FaultState::None && s.inputs.discrepancy && s.inputs.monitoring
            && !s.inputs.cde_before && !s.inputs.ab_before
            => s.outputs.alarm && s.after.timer == s.config.t_f
                && s.after.fault == if s.config.t_f.is_zero() { FaultState::Expired } else { FaultState::Delay };

    /// The delay cannot be stopped but by power-on: each cycle it is shorter or STOP B is requested.
    delay_cannot_be_aborted ["S840D-P-21", "S840D-P-24", "S840D-STOP-063", "S840D-STOP-099", "S840D-MDTIM-013"]:
        when |s| s.before.fault == FaultState::Delay && !s.inputs.power_on
            => s.outputs.stop_b || (s.after.fault == FaultState::Delay && s.after.timer < s.before.timer);

    /// The delay is not cut short: STOP B is requested only when the last cycle of the delay is over.
    delay_is_kept ["S840D-STOP-063", "S840D-MDTIM-013"]:
        when |s| s.before.fault == FaultState::Delay && !s.inputs.power_on && s.before.timer > Cycles::new(1)
            => s.after.fault == FaultState::Delay && s.after.timer == s.before.timer.tick();

    /// The request for STOP B stays until power-on.
    expired_until_power_on ["S840D-STOP-084", "S840D-ACK-001"]:
        when |s| s.before.fault == FaultState::Expired && !s.inputs.power_on
            => s.after.fault == FaultState::Expired && s.outputs.stop_b;

    /// A latched fault brakes nothing.
    latched_fault_does_not_brake ["S840D-P-22", "S840D-STOP-060", "S840D-STOP-062", "S840D-STOP-067", "S840D-SIGNAL-019",
        "S840D-SIGNAL-021", "S840D-SERVICE-701/a",
        "S840D-ALARM-713", "S840D-ALARM-735"]:
        when |s| s.after.fault == FaultState::Latched || s.after.fault == FaultState::None
            => !s.outputs.stop_b && !s.outputs.bit1;

    /// While a fault is present the start is interlocked.
    fault_interlocks_the_start ["S840D-P-22", "S840D-P-43", "S840D-STOP-060", "S840D-STOP-083", "S840D-ALARM-713"]:
        when |s| s.after.fault != FaultState::None
            => s.outputs.interlock;

    /// Under a STOP C, D or E a discrepancy is only latched, and stays so while that stop lasts.
    fault_under_cde_is_only_latched ["S840D-P-23", "S840D-STOP-062", "S840D-ALARM-735"]:
        when |s| s.inputs.cde_before && !s.inputs.power_on
            && ((s.before.fault == FaultState::None && s.inputs.discrepancy && !s.inputs.ab_before)
                || (s.before.fault == FaultState::Latched && !s.inputs.reset))
            => s.after.fault == FaultState::Latched;

    /// A latched fault starts the way to STOP B as soon as a function is active and no STOP C, D or E was.
    latched_fault_rearms ["S840D-P-25", "S840D-STOP-064", "S840D-STOP-096"]:
        when |s| s.before.fault == FaultState::Latched && !s.inputs.reset && !s.inputs.power_on
            && s.inputs.monitoring && !s.inputs.cde_before
            => s.after.timer == s.config.t_f
                && s.after.fault == if s.config.t_f.is_zero() { FaultState::Expired } else { FaultState::Delay };

    /// RESET acknowledges a latched fault; nothing is raised in that cycle.
    reset_acknowledges_a_latched_fault ["S840D-ACK-001", "S840D-STOP-060", "S840D-STOP-095"]:
        when |s| s.before.fault == FaultState::Latched && s.inputs.reset && !s.inputs.power_on
            => s.after.fault == FaultState::None && !s.outputs.alarm;

    /// A present fault leaves only by RESET in the latched form or by power-on.
    fault_is_not_lost ["S840D-P-43", "S840D-STOP-083", "S840D-STOP-084"]:
        when |s| s.before.fault != FaultState::None && !s.inputs.power_on
            && !(s.inputs.reset && s.before.fault == FaultState::Latched)
            => s.after.fault != FaultState::None;

    /// Under a latched STOP B or A no fault is raised.
    no_alarm_under_b_and_a ["S840D-ALARM-708", "S840D-ALARM-735"]:
        when |s| s.before.fault == FaultState::None && s.inputs.ab_before
            => s.after.fault == FaultState::None && !s.outputs.alarm;

    /// A discrepancy of either channel is never overlooked otherwise, in a cycle without power-on.
    discrepancy_is_raised ["S840D-STOP-060", "S840D-STOP-068", "S840D-STOP-093", "S840D-SIGNAL-021"]:
        when |s| s.before.fault == FaultState::None && !s.inputs.power_on && !s.inputs.ab_before
            && (s.inputs.discrepancy || s.inputs.rx_fault)
            => s.after.fault != FaultState::None && s.outputs.alarm;

    /// Power-on acknowledges every fault; only a discrepancy found in the same cycle raises a new one.
    power_on_acknowledges ["S840D-ACK-001", "S840D-STOP-084"]:
        when |s| s.inputs.power_on && !s.inputs.discrepancy
            => s.after == State::INITIAL;

    /// An alarm needs a discrepancy: found here, or received without power-on.
    no_alarm_without_discrepancy ["S840D-STOP-068"]:
        when |s| s.outputs.alarm
            => s.inputs.discrepancy || (s.inputs.rx_fault && !s.inputs.power_on);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-STOP-065", "S840D-SIGNAL-021", "S840D-SIGNAL-020/b", "S840D-KDV-730"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == s.after.fault
                && s.outputs.stop_b == (s.after.fault == FaultState::Expired)
                && s.outputs.bit1 == matches!(s.after.fault, FaultState::Delay | FaultState::Expired);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let found = inputs.discrepancy || (inputs.rx_fault && !inputs.power_on);
    let escalates = inputs.monitoring && !inputs.cde_before;
    let latched = State {
        fault: FaultState::Latched,
        timer: Cycles::ZERO,
    };
    let after = match before.fault {
        FaultState::None if !found || inputs.ab_before => State::INITIAL,
        FaultState::None if escalates => delay(config.t_f),
        FaultState::None => latched,
        // RESET comes first: one RESET for a STOP C, D or E and the fault under it does not start the delay.
        FaultState::Latched if inputs.reset => State::INITIAL,
        FaultState::Latched if escalates => delay(config.t_f),
        FaultState::Latched => latched,
        FaultState::Delay => delay(before.timer.tick()),
        FaultState::Expired => delay(Cycles::ZERO),
    };
    let outputs = Outputs {
        fault: after.fault,
        alarm: before.fault == FaultState::None && after.fault != FaultState::None,
        stop_b: after.fault == FaultState::Expired,
        bit1: matches!(after.fault, FaultState::Delay | FaultState::Expired),
        interlock: after.fault != FaultState::None,
    };
    (after, outputs)
}

/// On the way to STOP B with `left` still to go.
fn delay(left: Cycles) -> State {
    let fault = if left.is_zero() {
        FaultState::Expired
    } else {
        FaultState::Delay
    };
    State { fault, timer: left }
}
