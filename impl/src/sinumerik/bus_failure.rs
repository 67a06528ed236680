//! Failure of the drive bus in one channel: the pulses go off at once, or after a time for a reaction within the drive.
//!
//! Without the bus the NCK has no actual value and cannot give setpoints, so its monitors are no longer processed; the drive
//! still has its encoder and monitors alone what was selected when the bus failed. Both cancel the pulses, the NCK by terminal
//! 663. Where the machine data allow it they wait, so that the drive can stop or retract the axis by itself: while
//! the operating stop is neither active nor selected, each stage that is active or selected has a stop mode from 10 on, and
//! neither an external STOP A nor a test is requested.
//!
//! The NCK steps this monitor in each cycle, its other monitors only while [`Outputs::monitoring`]; it hands over the signals
//! it can still read, and what its monitors had in force last. The drive hands over what it has: no signal reaches it any
//! more. What the terminals of several axes on one output get is [`crate::sinumerik::shutdown_group::enabled`]
//! (S840D-BUSFAIL-713). A bus that comes back ends nothing: reading X-05 BUSFAIL_LATCH.

use crate::kernel::{ConfigError, Cycles};
use crate::sinumerik::selection::{Monitored, Stage};

/// 0.8 s in cycles of 31.25 us, the shortest possible ones: the longest delay (MD10089, MD1380).
pub const LONGEST: Cycles = Cycles::new(25_600);

config! {
    /// How a channel reacts.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        nck: bool,
        enable: bool,
        delay: Cycles,
        patient: [bool; 4],
    }
    accepted |config| config.delay <= LONGEST
}

impl Config {
    /// `nck`: the channel of the NCK, else that of the drive. `enable`: operating stop and stages exist (bit 0 of the enable word). `delay`: from the failure
    /// to the cancellation (`SAFE_PULSE_DIS_TIME_BUSFAIL`, 10089 / 1380). `stop_mode`, `reactions`: the stop modes of the
    /// stages (36961, 36963 / 1361, 1363) as in [`crate::sinumerik::speed::Config::new`]: a stage with 10 to 14 can wait.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] for a delay above [`LONGEST`], [`ConfigError::StopNotAllowed`] for a stop mode that is
    /// none, also one of `reactions` that is not used.
    pub fn new(
        nck: bool,
        enable: bool,
        delay: Cycles,
        stop_mode: u8,
        reactions: [u8; 4],
    ) -> Result<Self, ConfigError> {
        let [sg1, sg2, sg3, sg4] = reactions;
        let own = [waits(sg1)?, waits(sg2)?, waits(sg3)?, waits(sg4)?];
        Ok(Self {
            nck,
            enable,
            delay: delay.at_most(LONGEST)?,
            patient: if stop_mode == 5 {
                own
            } else {
                [waits(stop_mode)?; 4]
            },
        })
    }

    /// The time from the failure to the cancellation, where nothing forbids to wait.
    pub const fn delay(&self) -> Cycles {
        self.delay
    }

    /// Whether the pulses may stay on for a while in a stage.
    const fn patient(&self, stage: Stage) -> bool {
        let [sg1, sg2, sg3, sg4] = self.patient;
        match stage {
            Stage::Sg1 => sg1,
            Stage::Sg2 => sg2,
            Stage::Sg3 => sg3,
            Stage::Sg4 => sg4,
        }
    }
}

/// Whether a stop mode is one of those that let the pulses on for a while.
const fn waits(mode: u8) -> Result<bool, ConfigError> {
    match mode {
        0..=4 => Ok(false),
        10..=14 => Ok(true),
        _ => Err(ConfigError::StopNotAllowed),
    }
}

fields! {
    /// What the failure has led to.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// The bus runs.
        #[default]
        Runs,
        /// It has failed; the pulses are still on.
        Waits,
        /// The pulses are off.
        Off,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the failure has led to.
        pub phase: Phase,
        /// What is left of the delay; 0 unless it runs.
        pub left: Cycles,
    }
}

impl State {
    /// A bus that runs.
    pub const INITIAL: Self = Self {
        phase: Phase::Runs,
        left: Cycles::ZERO,
    };

    const OFF: Self = Self {
        phase: Phase::Off,
        left: Cycles::ZERO,
    };

    /// Something is left of the delay exactly while it runs.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.delay && self.left.is_zero() == (self.phase != Phase::Waits)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// The drive bus does not run.
        pub failed: bool,
        /// An external STOP A is requested.
        pub stop_a: bool,
        /// The test stop, or the test of the external shutdown, is selected.
        pub test: bool,
        /// SGE "SBH/SG de-selection" as it is effective in this channel: 1 selects neither.
        pub sge_sbh_sg: bool,
        /// SGE "SBH de-selection": 0 selects SBH, 1 selects SG.
        pub sge_sbh: bool,
        /// The stage selected by the signals.
        pub sg_select: Stage,
        /// What is monitored; in the NCK, after the failure, what was.
        pub monitored: Monitored,
        /// The stage in force (see [`crate::sinumerik::selection::Outputs::sga_sg`]).
        pub stage: Stage,
    }
}

impl Inputs {
    /// Whether nothing forbids to wait (S840D-ESR-703).
    fn permits_waiting(&self, config: &Config) -> bool {
        if self.stop_a || self.test {
            return false;
        }
        if !config.enable {
            return true;
        }
        let selected = match (self.sge_sbh_sg, self.sge_sbh) {
            (true, _) => true,
            (false, false) => false,
            (false, true) => config.patient(self.sg_select),
        };
        let active = match self.monitored {
            Monitored::Nothing => true,
            Monitored::Standstill => false,
            Monitored::Speed => config.patient(self.stage),
        };
        selected && active
    }
}

fields! {
    /// Where the output signals of a channel come from.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Signals {
        /// Its monitors.
        #[default]
        Current,
        /// They stay as they were when the bus failed.
        Held,
        /// All are 0.
        Cleared,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The pulses are to be off; from the NCK by terminal 663, not over the bus.
        pub cancel: bool,
        /// The monitors of this channel are processed.
        pub monitoring: bool,
        /// The drive gets setpoints: a STOP C, D or E can be carried out.
        pub setpoints: bool,
        /// Where the output signals come from.
        pub signals: Signals,
    }
}

monitor! { sinumerik::bus_failure;
    /// STOP A requested or a test selected: nothing waits.
    requests_do_not_wait ["S840D-MDBUS-002", "S840D-MDBUS-006", "S840D-BUSFAIL-704", "S840D-BUSFAIL-708",
        "S840D-BUSFAIL-706/c", "S840D-BUSFAIL-707/a"]:
        when |s| s.inputs.failed && (s.inputs.stop_a || s.inputs.test)
            => s.outputs.cancel;

    /// The operating stop active or selected, when the bus fails or later: nothing waits.
    operating_stop_does_not_wait ["S840D-MDBUS-003", "S840D-MDBUS-006", "S840D-BUSFAIL-704", "S840D-BUSFAIL-705",
        "S840D-BUSFAIL-706/c"]:
        when |s| s.inputs.failed && s.config.enable
            && (s.inputs.monitored == Monitored::Standstill || (!s.inputs.sge_sbh_sg && !s.inputs.sge_sbh))
            => s.outputs.cancel;

    /// A stage with a stop mode below 10 active or selected, when the bus fails or later: nothing waits.
    stage_for_people_does_not_wait ["S840D-MDBUS-004", "S840D-MDBUS-006", "S840D-BUSFAIL-704", "S840D-BUSFAIL-705",
        "S840D-PARAM-025"]:
        when |s| s.inputs.failed && s.config.enable
            && ((s.inputs.monitored == Monitored::Speed && !s.config.patient(s.inputs.stage))
                || (!s.inputs.sge_sbh_sg && s.inputs.sge_sbh && !s.config.patient(s.inputs.sg_select)))
            => s.outputs.cancel;

    /// Without a delay nothing waits.
    no_delay_no_waiting ["S840D-BUSFAIL-701", "S840D-PARAM-027"]:
        when |s| s.inputs.failed && s.config.delay.is_zero()
            => s.outputs.cancel;

    /// Where nothing forbids it the pulses stay on, and the whole delay lies ahead.
    delay_begins_whole ["S840D-MDBUS-001", "S840D-BUSFAIL-702", "S840D-PARAM-025"]:
        when |s| s.inputs.failed && (s.inputs.power_on || s.before.phase == Phase::Runs)
            && !s.config.delay.is_zero() && s.inputs.permits_waiting(&s.config)
            => s.after == (State { phase: Phase::Waits, left: s.config.delay }) && !s.outputs.cancel;

    /// The delay runs down in each cycle, whether the bus comes back or not, and at its end the pulses are off.
    delay_runs_down ["S840D-MDBUS-001", "S840D-BUSFAIL-702", "S840D-PARAM-027", "S840D-BUSFAIL-710"]:
        when |s| s.before.phase == Phase::Waits && !s.inputs.power_on
            => s.outputs.cancel || s.after == (State { phase: Phase::Waits, left: s.before.left.tick() });

    /// The pulses do not go off before the end of the delay without a reason.
    delay_is_granted ["S840D-MDBUS-001", "S840D-BUSFAIL-702", "S840D-BUSFAIL-710"]:
        when |s| s.before.phase == Phase::Waits && !s.inputs.power_on && s.before.left > Cycles::new(1)
            && s.inputs.permits_waiting(&s.config)
            => !s.outputs.cancel;

    /// Only power-on ends the cancellation.
    cancellation_is_kept ["S840D-BUSFAIL-702"]:
        when |s| s.before.phase == Phase::Off && !s.inputs.power_on
            => s.outputs.cancel;

    /// Nothing happens to a bus that has not failed.
    running_bus_is_left_alone ["S840D-BUSFAIL-701"]:
        when |s| !s.inputs.failed && (s.inputs.power_on || s.before.phase == Phase::Runs)
            => s.after == State::INITIAL && !s.outputs.cancel && s.outputs.monitoring && s.outputs.setpoints
                && s.outputs.signals == Signals::Current;

    /// The NCK monitors nothing from the failure on; its signals stay, and are 0 once the pulses are off.
    nck_is_blind ["S840D-BUSFAIL-702", "S840D-BUSFAIL-703", "S840D-BUSFAIL-708", "S840D-BUSFAIL-706/a"]:
        when |s| s.config.nck && s.after.phase != Phase::Runs
            => !s.outputs.monitoring && !s.outputs.setpoints
                && s.outputs.signals == if s.outputs.cancel { Signals::Cleared } else { Signals::Held };

    /// The drive monitors on while its pulses are on; its signals stay as the PLC had them.
    drive_monitors_on ["S840D-BUSFAIL-705", "S840D-BUSFAIL-711/a"]:
        when |s| !s.config.nck && s.after.phase != Phase::Runs
            => s.outputs.monitoring != s.outputs.cancel && !s.outputs.setpoints && s.outputs.signals == Signals::Held;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-BUSFAIL-702"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.cancel == (s.after.phase == Phase::Off);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    // What is left of the delay after this cycle, where the pulses are still on and the bus is down.
    let left = match before.phase {
        Phase::Runs if !inputs.failed => None,
        Phase::Runs => Some(config.delay),
        Phase::Waits => Some(before.left.tick()),
        Phase::Off => Some(Cycles::ZERO),
    };
    let after = match left {
        None => State::INITIAL,
        Some(left) if left.is_zero() || !inputs.permits_waiting(config) => State::OFF,
        Some(left) => State {
            phase: Phase::Waits,
            left,
        },
    };
    let nck = config.nck;
    let outputs = Outputs {
        cancel: after.phase == Phase::Off,
        monitoring: match after.phase {
            Phase::Runs => true,
            Phase::Waits => !nck,
            Phase::Off => false,
        },
        setpoints: after.phase == Phase::Runs,
        signals: match after.phase {
            Phase::Runs => Signals::Current,
            Phase::Off if nck => Signals::Cleared,
            Phase::Waits | Phase::Off => Signals::Held,
        },
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinumerik::shutdown_group;

    /// The bus fails with a stage active and selected: whether the pulses go off at once.
    fn at_once(config: Config, stage: Stage) -> bool {
        let inputs = Inputs {
            failed: true,
            sge_sbh: true,
            sg_select: stage,
            monitored: Monitored::Speed,
            stage,
            ..Inputs::default()
        };
        transition(State::INITIAL, &config, &inputs).1.cancel
    }

    const STAGES: [Stage; 4] = [Stage::Sg1, Stage::Sg2, Stage::Sg3, Stage::Sg4];

    /// S840D-PARAM-025, S840D-MDBUS-004, lines 15169 to 15221: the six axes of example 1.
    #[test]
    fn example_1_of_the_manual() {
        let axes = [
            (3, [2; 4], [true; 4]),
            (13, [2; 4], [false; 4]),
            (5, [3, 3, 2, 2], [true; 4]),
            (5, [13, 13, 12, 12], [false; 4]),
            (5, [3, 13, 3, 13], [true, false, true, false]),
            (5, [3, 13, 2, 14], [true, false, true, false]),
        ];
        for nck in [true, false] {
            for (mode, reactions, expected) in axes {
                let config =
                    Config::new(nck, true, Cycles::new(17), mode, reactions).expect("allowed");
                assert_eq!(STAGES.map(|stage| at_once(config, stage)), expected);
            }
        }
    }

    /// S840D-BUSFAIL-713, lines 15223 to 15275: the three axes of example 2 with one output.
    #[test]
    fn example_2_of_the_manual() {
        let axes = [[3, 13, 12, 12], [2, 14, 14, 14], [3, 14, 14, 14]]
            .map(|r| Config::new(true, true, Cycles::new(42), 5, r).expect("allowed"));
        for x in STAGES {
            for y in STAGES {
                for z in STAGES {
                    let enables = [
                        !at_once(axes[0], x),
                        !at_once(axes[1], y),
                        !at_once(axes[2], z),
                    ];
                    let waits = [x, y, z].iter().all(|stage| *stage != Stage::Sg1);
                    assert_eq!(shutdown_group::enabled(&[1; 3], &enables), [waits; 3]);
                }
            }
        }
    }

    #[test]
    fn values_that_the_manual_refuses() {
        let new =
            |delay, mode, reactions| Config::new(true, true, Cycles::new(delay), mode, reactions);
        assert_eq!(new(25_601, 5, [2; 4]), Err(ConfigError::DelayTooLong));
        assert_eq!(new(0, 6, [2; 4]), Err(ConfigError::StopNotAllowed));
        assert_eq!(new(0, 5, [2, 2, 5, 2]), Err(ConfigError::StopNotAllowed));
        assert!(new(25_600, 14, [0, 4, 10, 14]).is_ok());
    }
}
