//! The part of the self-test that switches off one channel after the other and looks at the feedback: brake control, contact
//! chain, power modules, safe outputs.
//!
//! Both channels are on, and seen to be, before each of them is switched off: a feedback that is slow to rise would pass for one that
//! fell. Every step waits for its feedback. One that does not come in its time is a fault: the axes whose brake control is being
//! tested lose their torque at once, all others brake by SS1F; in the later steps SS1F is for all. Which output carries the
//! brake of channel B (MP2234 bit 0) makes no difference: the supply of the brakes is looked at, not the output (HFS-BCT-006).
//!
//! Recommended readings of the manual implemented here: AMB-37 BCT_SS0_PLUS_SS1F.

use crate::heidenhain::types::Stop;
use crate::kernel::{ConfigError, Cycles};

mod laws;

pub use laws::*;

config! {
    /// Times and options.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_relay: Cycles,
        t_ready: Cycles,
        t_off: Cycles,
        no_control: bool,
        no_outputs: bool,
    }
}

impl Config {
    /// 200 ms in cycles of 3 ms, rounded down: contact chain and relays of the brakes.
    pub const T_RELAY: Cycles = Cycles::new(66);
    /// 10 s in cycles of 3 ms, rounded down: a power module gets ready.
    pub const T_READY: Cycles = Cycles::new(3333);
    /// The longest time accepted: 60 s.
    pub const LONGEST: Cycles = Cycles::new(20_000);

    /// `t_relay`: relays of chain and brakes ([`Config::T_RELAY`]). `t_ready`: power module on ([`Config::T_READY`]). `t_off`:
    /// power module off (SMP2172). `no_control`: SMP560 bit 3, no test of the brake control. `no_outputs`: SMP560 bit 12, the
    /// safe outputs are not switched off.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(
        t_relay: Cycles,
        t_ready: Cycles,
        t_off: Cycles,
        no_control: bool,
        no_outputs: bool,
    ) -> Result<Self, ConfigError> {
        if t_relay.is_zero() || t_ready.is_zero() || t_off.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_relay: t_relay.at_most(Self::LONGEST)?,
            t_ready: t_ready.at_most(Self::LONGEST)?,
            t_off: t_off.at_most(Self::LONGEST)?,
            no_control,
            no_outputs,
        })
    }

    /// The time a step has, 0 for one that waits for nothing.
    pub const fn time(&self, step: Phase) -> Cycles {
        match step {
            Phase::Idle | Phase::Done | Phase::Fault => Cycles::ZERO,
            Phase::BrakesOn
            | Phase::BrakeAOff
            | Phase::BrakesAgain
            | Phase::BrakeBOff
            | Phase::ChainClosed
            | Phase::ChainOpens => self.t_relay,
            Phase::ModulesOn | Phase::ModulesAgain => self.t_ready,
            Phase::CcOff | Phase::McOff | Phase::OutputsOff => self.t_off,
        }
    }
}

fields! {
    /// The step of the test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// It does not run.
        #[default]
        Idle,
        /// Both channels release the brakes.
        BrakesOn,
        /// Channel B alone would release them.
        BrakeAOff,
        /// Both channels release them once more.
        BrakesAgain,
        /// Channel A alone would release them.
        BrakeBOff,
        /// The contact chain must be closed.
        ChainClosed,
        /// -STO.A.G comes on, and the chain must open.
        ChainOpens,
        /// Pulses by both channels: the power modules must get ready.
        ModulesOn,
        /// Pulses by the MC alone: they must not be ready any more.
        CcOff,
        /// Pulses by both channels once more.
        ModulesAgain,
        /// Pulses by the CC alone: they must not be ready any more.
        McOff,
        /// The safe outputs must read 0.
        OutputsOff,
        /// Passed.
        Done,
        /// A feedback has not come.
        Fault,
    }
}

impl Phase {
    /// Whether the brake control is being tested.
    pub const fn is_brake_control(self) -> bool {
        matches!(
            self,
            Self::BrakesOn | Self::BrakeAOff | Self::BrakesAgain | Self::BrakeBOff
        )
    }

    /// Whether the test has ended, well or not.
    pub const fn is_over(self) -> bool {
        matches!(self, Self::Done | Self::Fault)
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The step.
        pub step: Phase,
        /// What is left of its time.
        pub timer: Cycles,
        /// The axes must be moved to a safe position before the test begins anew.
        pub ask: bool,
    }
}

impl State {
    /// The test does not run.
    pub const INITIAL: Self = Self {
        step: Phase::Idle,
        timer: Cycles::ZERO,
        ask: false,
    };

    /// The time of the step runs; a position is asked for only before the test.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let waits = !matches!(self.step, Phase::Idle | Phase::Done | Phase::Fault);
        waits != self.timer.is_zero()
            && self.timer <= config.time(self.step)
            && (!self.ask || matches!(self.step, Phase::Idle))
            && (!config.no_control || !(self.ask || self.step.is_brake_control()))
            && (!config.no_outputs || !matches!(self.step, Phase::OutputsOff))
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// The self-test comes to this part.
        pub start: bool,
        /// T.BRK: the brakes are supplied. `PP_GenTBRK` is 0 then (HFS-BCT-005).
        pub t_brk: bool,
        /// FB_NCC: all contacts of the chain are closed.
        pub chain: bool,
        /// RDY.x: the power modules are ready.
        pub ready: bool,
        /// A safe output reads 1.
        pub outputs: bool,
        /// An axis has left the limits of its operating stop.
        pub moved: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The step.
        pub step: Phase,
        /// Channel A releases the brakes.
        pub brake_a: bool,
        /// Channel B releases the brakes, by whatever output carries it.
        pub brake_b: bool,
        /// -STO.A.G is 1.
        pub sto_a_g: bool,
        /// -STOS.A.G is 1: never here, no spindle is released by the test (HFS-TEST-010).
        pub stos_a_g: bool,
        /// -STO.A.x is 1.
        pub on_mc: bool,
        /// -STO.B.x is 1.
        pub on_cc: bool,
        /// The MC watches the standstill position, because the CC alone has no torque.
        pub watch_mc: bool,
        /// The CC watches it, because the MC alone has no torque.
        pub watch_cc: bool,
        /// The axes must be moved to a safe position.
        pub ask_place: bool,
        /// The test is passed.
        pub done: bool,
        /// A feedback has not come, in this cycle.
        pub fault: bool,
        /// The stop of the tested axes.
        pub tested: Stop,
        /// The stop of the other ones.
        pub others: Stop,
    }
}

/// Whether the feedback is as a step wants it.
const fn seen(step: Phase, inputs: &Inputs) -> bool {
    match step {
        Phase::Idle | Phase::Done | Phase::Fault => false,
        Phase::BrakesOn | Phase::BrakesAgain => inputs.t_brk,
        Phase::BrakeAOff | Phase::BrakeBOff => !inputs.t_brk,
        Phase::ChainClosed => inputs.chain,
        Phase::ChainOpens => !inputs.chain,
        Phase::CcOff | Phase::McOff => !inputs.ready,
        Phase::ModulesOn | Phase::ModulesAgain => inputs.ready,
        Phase::OutputsOff => !inputs.outputs,
    }
}

/// The step after one whose feedback has come.
const fn following(step: Phase, config: &Config) -> Phase {
    match step {
        Phase::Idle => Phase::Idle,
        Phase::BrakesOn => Phase::BrakeAOff,
        Phase::BrakeAOff => Phase::BrakesAgain,
        Phase::BrakesAgain => Phase::BrakeBOff,
        Phase::BrakeBOff => Phase::ChainClosed,
        Phase::ChainClosed => Phase::ChainOpens,
        Phase::ChainOpens => Phase::ModulesOn,
        Phase::ModulesOn => Phase::CcOff,
        Phase::CcOff => Phase::ModulesAgain,
        Phase::ModulesAgain => Phase::McOff,
        Phase::McOff if !config.no_outputs => Phase::OutputsOff,
        Phase::McOff | Phase::OutputsOff | Phase::Done => Phase::Done,
        Phase::Fault => Phase::Fault,
    }
}

impl State {
    /// A step that begins.
    const fn at(step: Phase, config: &Config) -> Self {
        Self {
            step,
            timer: config.time(step),
            ask: false,
        }
    }

    /// The state one cycle later.
    fn advanced(self, config: &Config, inputs: &Inputs) -> Self {
        let timer = self.timer.tick();
        match self.step {
            _ if inputs.power_on => Self::INITIAL,
            Phase::Idle if inputs.start && !inputs.moved => {
                let first = if config.no_control {
                    Phase::ChainClosed
                } else {
                    Phase::BrakesOn
                };
                Self::at(first, config)
            }
            Phase::Idle | Phase::Done | Phase::Fault => self,
            step if step.is_brake_control() && inputs.moved => Self {
                ask: true,
                ..Self::INITIAL
            },
            step if seen(step, inputs) => Self::at(following(step, config), config),
            _ if timer.is_zero() => Self::at(Phase::Fault, config),
            _ => Self { timer, ..self },
        }
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = state.advanced(config, inputs);
    let step = after.step;
    let fault = step == Phase::Fault && state.step != Phase::Fault;
    let (tested, others) = match fault {
        true if state.step.is_brake_control() => (Stop::Ss0, Stop::Ss1F),
        true => (Stop::Ss1F, Stop::Ss1F),
        false => (Stop::None, Stop::None),
    };
    let outputs = Outputs {
        step,
        brake_a: step.is_brake_control() && step != Phase::BrakeAOff,
        brake_b: step.is_brake_control() && step != Phase::BrakeBOff,
        sto_a_g: matches!(
            step,
            Phase::ChainOpens
                | Phase::ModulesOn
                | Phase::CcOff
                | Phase::ModulesAgain
                | Phase::McOff
                | Phase::OutputsOff
                | Phase::Done
        ),
        stos_a_g: false,
        on_mc: matches!(step, Phase::ModulesOn | Phase::CcOff | Phase::ModulesAgain),
        on_cc: matches!(step, Phase::ModulesOn | Phase::ModulesAgain | Phase::McOff),
        watch_mc: step == Phase::CcOff,
        watch_cc: step == Phase::McOff,
        ask_place: after.ask,
        done: step == Phase::Done,
        fault,
        tested,
        others,
    };
    (after, outputs)
}
