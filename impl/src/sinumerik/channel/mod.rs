//! One monitoring channel of one axis: the monitors in the order of the cycle, wired to each other.
//!
//! ```text
//! external -> motion -> test_stop -> selection -> standstill, speed, limit_switch, ramp, threshold
//!          -> fault -> stop -> pulses
//! ```
//!
//! The channel adds no behaviour of its own: it passes the results of one monitor on to the next. Two results are of the
//! cycle before, because their monitors step later: the operating stop that the end of a STOP C, D or E forces, and the
//! braking ramp. So the ramp is compared from the first cycle after its stop became effective, with the speed of that cycle
//! as its start, and the position is captured one cycle after the end of the stop.
//!
//! In a cycle with `power_on` nothing of the cycle before is passed on.
//!
//! Bound on the work of a cycle: each of the twelve monitors steps once; there is no loop. What the channel needs of the
//! other one comes as four inputs (see [`crate::sinumerik::axis::Exchange`]).

mod laws;
mod wiring;

use crate::kernel::{Position, Speed};

use crate::sinumerik::level::{ExternalStop, InternalStop, Level};
use crate::sinumerik::selection::Stage;
use crate::sinumerik::{
    external, fault, limit_switch, motion, pulses, ramp, selection, speed, standstill, stop,
    test_stop, threshold,
};

pub use laws::*;

config! {
    /// The parameters of the monitors. Each is valid by its own construction; they belong to the same axis when they come from
    /// [`crate::sinumerik::parameters::Parameters::validate`].
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Stops by signal and the safe logic.
        pub external: external::Config,
        /// Test of the shutdown path.
        pub test: test_stop::Config,
        /// Operating stop and speed stages.
        pub selection: selection::Config,
        /// Window of the operating stop.
        pub standstill: standstill::Config,
        /// Speed stages and the limit of the encoder.
        pub speed: speed::Config,
        /// Limit switches.
        pub limit_switch: limit_switch::Config,
        /// Braking ramp.
        pub ramp: ramp::Config,
        /// Speed threshold.
        pub threshold: threshold::Config,
        /// Delay from STOP F to STOP B.
        pub fault: fault::Config,
        /// Times of the stops.
        pub stop: stop::Config,
        /// Pulse cancellation.
        pub pulses: pulses::Config,
        /// The axis stands still below this speed: STOP B ends in STOP A (`SAFE_STANDSTILL_VELO_TOL`, 36960 / 1360).
        pub standstill_speed: Speed,
        /// Limit switches or a cam are enabled: they count as active functions for STOP F (S840D-STOP-089, A-07).
        pub se_sn_enabled: bool,
    }
    accepted |config| {
        let motion = config.external.accepted() && config.test.accepted() && config.selection.accepted();
        let limits = config.standstill.accepted() && config.speed.accepted() && config.limit_switch.accepted();
        let rest = config.ramp.accepted() && config.threshold.accepted() && config.fault.accepted();
        motion && limits && rest && config.stop.accepted() && config.pulses.accepted()
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Stops by signal and the safe logic.
        pub external: external::State,
        /// Position of the cycle before.
        pub motion: motion::State,
        /// Test of the shutdown path.
        pub test: test_stop::State,
        /// Operating stop and speed stages.
        pub selection: selection::State,
        /// Braking ramp.
        pub ramp: ramp::State,
        /// STOP F.
        pub fault: fault::State,
        /// Arbitration of the stops.
        pub stop: stop::State,
        /// Pulse cancellation.
        pub pulses: pulses::State,
    }
}

const _: () = assert!(size_of::<State>() <= 128);

impl State {
    /// Switched off.
    pub const INITIAL: Self = Self {
        external: external::State::INITIAL,
        motion: motion::State::INITIAL,
        test: test_stop::State::INITIAL,
        selection: selection::State::INITIAL,
        ramp: ramp::State::INITIAL,
        fault: fault::State::INITIAL,
        stop: stop::State::INITIAL,
        pulses: pulses::State::INITIAL,
    };

    /// The state of every monitor is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.external.invariant(&config.external)
            && self.motion.invariant(&motion::Config)
            && self.test.invariant(&config.test)
            && self.selection.invariant(&config.selection)
            && self.ramp.invariant(&config.ramp)
            && self.fault.invariant(&config.fault)
            && self.stop.invariant(&config.stop)
            && self.pulses.invariant(&config.pulses)
    }
}

fields! {
    /// The inputs of one cycle: the signals and measurements of this channel, and what the other channel has told.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// Drive and control have run up; before that the pulses are off.
        pub run_up: bool,
        /// NC-RESET.
        pub reset: bool,
        /// The cross comparison of the safe logic has been started.
        pub spl_started: bool,
        /// An error of the safe logic or of PROFIsafe is present.
        pub spl_error: bool,
        /// SGE "de-select ext. STOP A".
        pub sge_a: bool,
        /// SGE "de-select ext. STOP C".
        pub sge_c: bool,
        /// SGE "de-select ext. STOP D".
        pub sge_d: bool,
        /// SGE "de-select ext. STOP E".
        pub sge_e: bool,
        /// SGE "SBH/SG de-selection".
        pub sge_sbh_sg: bool,
        /// SGE "SBH de-selection".
        pub sge_sbh: bool,
        /// The stage selected by the signals.
        pub sg_select: Stage,
        /// The override selected by the signals.
        pub over: selection::FactorIndex,
        /// The limit switches may act (see [`crate::sinumerik::agreement::Outputs::se_active`]).
        pub se_active: bool,
        /// SGE "SE selection": 0 selects SE1, 1 selects SE2.
        pub se_select: bool,
        /// The position read in this cycle.
        pub position: Position,
        /// The speed at the encoder, for its limit frequency; ignored with two encoders (see [`crate::sinumerik::speed`]).
        pub encoder_speed: Speed,
        /// The axis is parked.
        pub parking: bool,
        /// The position has been set anew in this cycle by referencing (see [`crate::sinumerik::motion`]).
        pub set_anew: bool,
        /// SGE "test stop selection": 1 selects the test.
        pub test_select: bool,
        /// Feedback: the pulses are cancelled.
        pub feedback: bool,
        /// The test of the external shutdown runs (NCK channel only, see [`crate::sinumerik::shutdown_test`]).
        pub external_test: bool,
        /// A stop required from outside the monitors of this channel: by the failed test of the external shutdown.
        pub demand: InternalStop,
        /// The comparison of this channel finds a discrepancy, or a check of the user agreement has failed.
        pub discrepancy: bool,
        /// The other channel has told a STOP F.
        pub rx_fault: bool,
        /// The latched internal stop the other channel has told.
        pub rx_internal: InternalStop,
        /// The stop requested by the signals of the other channel, as told.
        pub rx_external: ExternalStop,
    }
}

fields! {
    /// The outputs of one cycle, by monitor.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Stops by signal and the safe logic.
        pub external: external::Outputs,
        /// Position and speed.
        pub motion: motion::Outputs,
        /// Test of the shutdown path.
        pub test: test_stop::Outputs,
        /// Operating stop and speed stages.
        pub selection: selection::Outputs,
        /// Window of the operating stop.
        pub standstill: standstill::Outputs,
        /// Speed stages and the limit of the encoder.
        pub speed: speed::Outputs,
        /// Limit switches.
        pub limit_switch: limit_switch::Outputs,
        /// Braking ramp.
        pub ramp: ramp::Outputs,
        /// Speed threshold.
        pub threshold: threshold::Outputs,
        /// STOP F.
        pub fault: fault::Outputs,
        /// The effective stop.
        pub stop: stop::Outputs,
        /// Pulse cancellation.
        pub pulses: pulses::Outputs,
        /// SGA "SBH/SG active".
        pub sbh_sg_active: bool,
        /// SGA "SBH active": selected, or begun by a stop that has ended its braking in this cycle or before.
        pub sbh_active: bool,
        /// SGA "SG active bit 1, bit 0": the stage whose limit is monitored; SG1 where none is.
        pub sg_active: Stage,
        /// The highest stop that the monitors of this channel require in this cycle.
        pub demand: InternalStop,
        /// A safety function is active: SBH, SG, or SE or SN in use (S840D-STOP-089).
        pub monitoring: bool,
        /// A restart is prevented: by a latched stop or by STOP F (S840D-STOP-083).
        pub start_inhibit: bool,
    }
}

impl Outputs {
    /// The effective level.
    pub const fn level(&self) -> Level {
        self.stop.level
    }
}

pub(crate) use wiring::transition;
