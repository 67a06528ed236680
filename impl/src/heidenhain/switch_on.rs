//! Control voltage on, in one channel: the fresh edge that switches the drives on, after the chain of normally closed
//! contacts has been found closed.
//!
//! Recommended readings of the manual implemented here: AMB-44 EDGE (a control voltage that merely stays on restarts
//! nothing), AMB-69 SS1 (its loss in operation stops the machine).

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

config! {
    /// How long the contacts may take.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_chain: Cycles,
    }
}

impl Config {
    /// The time of the manual: 200 ms in cycles of 3 ms, rounded down.
    pub const STANDARD: Self = Self {
        t_chain: Cycles::new(66),
    };

    /// The longest time accepted: 3 s.
    pub const LONGEST: Cycles = Cycles::new(1000);

    /// `t_chain`: the wait for slow relays, 1 cycle to [`Config::LONGEST`]. The manual fixes it to 200 ms
    /// ([`Config::STANDARD`]).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(t_chain: Cycles) -> Result<Self, ConfigError> {
        if t_chain.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_chain: t_chain.at_most(Self::LONGEST)?,
        })
    }

    /// The wait for slow relays.
    pub const fn t_chain(&self) -> Cycles {
        self.t_chain
    }
}

fields! {
    /// The control voltage as the kernel sees it.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Voltage {
        /// Off.
        #[default]
        Off,
        /// The contact chain is being checked.
        ChainCheck,
        /// -STO.A.G is on.
        On,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The control voltage.
        pub voltage: Voltage,
        /// What is left of the wait for the chain, else 0.
        pub timer: Cycles,
        /// `PP_GenCVO` in the cycle before.
        pub seen: bool,
    }
}

impl State {
    /// Off; a signal that is already on gives no edge.
    pub const INITIAL: Self = Self {
        voltage: Voltage::Off,
        timer: Cycles::ZERO,
        seen: true,
    };

    /// A timer runs exactly during the check.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_chain
            && (self.voltage == Voltage::ChainCheck) != self.timer.is_zero()
    }
}

impl Default for State {
    fn default() -> Self {
        Self::INITIAL
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// `PP_GenCVO`: the key is pressed or the latch relay K1 has picked up.
        pub cvo: bool,
        /// `PP_GenFB_NCC`: all contacts of the chain are closed.
        pub chain: bool,
        /// T.BRK: the brakes are supplied; `PP_GenTBRK` is 0 then.
        pub t_brk: bool,
        /// The kernel switches -STO.A.G off: emergency stop, SS0, SS1F, or all safe groups in STO.
        pub dropped: bool,
        /// Stops have ended, there is no cause of SS1 or higher, and no main switch is needed.
        pub may_on: bool,
        /// The self-test runs.
        pub testing: bool,
        /// The door of the spindle is open and it stands.
        pub spindle_rests: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The control voltage.
        pub voltage: Voltage,
        /// -STO.A.G is 1.
        pub sto_a_g: bool,
        /// -STOS.A.G is 1: the power modules of the spindles are enabled too.
        pub stos_a_g: bool,
        /// The chain has not closed in time, or a brake is supplied.
        pub fault: bool,
        /// The stop that follows: SS1, in the self-test SS1F.
        pub demand: Stop,
    }
}

monitor! { heidenhain::switch_on;
    /// The check begins with an edge only, and only when everything has ended.
    edge_starts_the_check ["HFS-P-06", "HFS-ACK-005", "HFS-ACK-006", "HFS-CVO-001"]:
        when |s| s.before.voltage == Voltage::Off && s.after.voltage != Voltage::Off
            => s.inputs.cvo && !s.before.seen && s.inputs.may_on && !s.inputs.dropped
                && s.after.voltage == Voltage::ChainCheck && s.after.timer == s.config.t_chain;

    /// -STO.A.G comes on only after the chain was found closed in the time, and no brake supplied.
    chain_before_torque ["HFS-NCC-001", "HFS-TEST-013", "HFS-P-06"]:
        when |s| s.outputs.sto_a_g && s.before.voltage != Voltage::On
            => s.before.voltage == Voltage::ChainCheck && s.inputs.chain && !s.inputs.t_brk && s.inputs.may_on
                && !s.inputs.dropped;

    /// A chain that does not close in time, or a brake that is supplied, is a fault: SS1, in the self-test SS1F.
    open_chain_is_a_fault ["HFS-TEST-012/a", "HFS-NCC-001", "HFS-NCC-002", "HFS-TEST-013", "HFS-FAULT-010"]:
        when |s| s.before.voltage == Voltage::ChainCheck && s.before.timer.count() == 1
            && (!s.inputs.chain || s.inputs.t_brk)
            && s.inputs.may_on && !s.inputs.dropped
            => s.outputs.fault && s.after.voltage == Voltage::Off
                && s.outputs.demand == (if s.inputs.testing { Stop::Ss1F } else { Stop::Ss1 });

    /// The check ends: its timer is lower in each cycle.
    check_ends_in_time ["HFS-NCC-001"]:
        when |s| s.before.voltage == Voltage::ChainCheck
            => s.after.voltage != Voltage::ChainCheck || s.after.timer < s.before.timer;

    /// A stop that drops -STO.A.G wins over everything.
    stop_drops_the_voltage ["HFS-STO-005", "HFS-SS0-003/a", "HFS-SS1-010", "HFS-CVO-001"]:
        when |s| s.inputs.dropped
            => s.after.voltage == Voltage::Off && !s.outputs.sto_a_g && s.outputs.demand == Stop::None;

    /// Control voltage that goes in operation by itself stops the machine.
    lost_voltage_stops ["HFS-CVO-002"]:
        when |s| s.before.voltage == Voltage::On && s.before.seen && !s.inputs.cvo && !s.inputs.dropped
            => s.outputs.demand == Stop::Ss1 && !s.outputs.fault;

    /// Nothing else raises a stop.
    nothing_else_stops ["HFS-CVO-002", "HFS-PDO-002", "HFS-NCC-001"]:
        when |s| s.outputs.demand != Stop::None
            => s.outputs.fault || (s.before.voltage == Voltage::On && s.before.seen && !s.inputs.cvo);

    /// -STOS.A.G is off with -STO.A.G and behind an open door while the spindle stands, else on with it.
    spindle_signal_follows ["HFS-STO-008"]:
        when |s| s.outputs.stos_a_g || s.outputs.sto_a_g || s.inputs.spindle_rests
            => s.outputs.stos_a_g == (s.outputs.sto_a_g && !s.inputs.spindle_rests);

    /// -STO.A.G stays on until a stop drops it.
    voltage_stays_on ["HFS-P-33", "HFS-STO-004"]:
        when |s| s.before.voltage == Voltage::On && !s.inputs.dropped
            => s.outputs.sto_a_g;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-CVO-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.seen == s.inputs.cvo
                && s.outputs.voltage == s.after.voltage && s.outputs.sto_a_g == (s.after.voltage == Voltage::On);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let edge = inputs.cvo && !state.seen;
    let left = state.timer.tick();
    let closed = inputs.chain && !inputs.t_brk && inputs.may_on;
    let (voltage, timer) = match state.voltage {
        _ if inputs.dropped => (Voltage::Off, Cycles::ZERO),
        Voltage::Off if edge && inputs.may_on => (Voltage::ChainCheck, config.t_chain),
        Voltage::ChainCheck if closed => (Voltage::On, Cycles::ZERO),
        Voltage::ChainCheck if inputs.may_on && !left.is_zero() => (Voltage::ChainCheck, left),
        Voltage::Off | Voltage::ChainCheck => (Voltage::Off, Cycles::ZERO),
        Voltage::On => (Voltage::On, Cycles::ZERO),
    };
    // A check that a stop breaks off is no fault of the chain.
    let fault = state.voltage == Voltage::ChainCheck
        && voltage == Voltage::Off
        && inputs.may_on
        && !inputs.dropped;
    let lost = state.voltage == Voltage::On && state.seen && !inputs.cvo && !inputs.dropped;
    let demand = if fault && inputs.testing {
        Stop::Ss1F
    } else if fault || lost {
        Stop::Ss1
    } else {
        Stop::None
    };
    let after = State {
        voltage,
        timer,
        seen: inputs.cvo,
    };
    let outputs = Outputs {
        voltage,
        sto_a_g: voltage == Voltage::On,
        stos_a_g: voltage == Voltage::On && !inputs.spindle_rests,
        fault,
        demand,
    };
    (after, outputs)
}
