//! Safe stop 1 of the Extended Functions, and STOP B, which brakes in the same way (machine B4), in one channel.
//!
//! The drive brakes along OFF3 while SAM or SBR watch; STO follows below the shutdown speed p9560 or after p9556. With SBR and no
//! encoder (p9506 = 1) there is no time: the ramp bounds it (S120-SBR-006). With an external stop (p9507.3) the time alone counts.
//! What began the braking keeps its time: a STOP B during SS1 changes none (S120-STOP-524), but makes STOP A of its end.
//!
//! Readings: AF-1 and AF-16 as settled; AF-29 is a choice of the configuration, the recommended one first.

use crate::kernel::{ConfigError, Cycles, Speed};
use crate::sinamics::types::Braking;

fields! {
    /// Reading AF-29: whether STOP B has a time beside SBR without encoder.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum StopbTimer {
        /// p9556 ends it (Table 9-1).
        #[default]
        Timer,
        /// As SS1: the shutdown speed alone.
        NoTimer,
    }
}

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        time: Cycles,
        shutdown: Speed,
        braking: Braking,
        external: bool,
        stop_b: StopbTimer,
    }
}

impl Config {
    /// `time`: p9556. `shutdown`: p9560, below which STO follows; 0 is never undershot. `braking`: p9506. `external`: p9507.3.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] without a shutdown speed where nothing else ends SS1: p9506 = 1 (S120-ENC-002,
    /// S120-SS1-013).
    pub const fn new(
        time: Cycles,
        shutdown: Speed,
        braking: Braking,
        external: bool,
        stop_b: StopbTimer,
    ) -> Result<Self, ConfigError> {
        if matches!(braking, Braking::BareSbr) && shutdown.0 == 0 {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self {
            time,
            shutdown,
            braking,
            external,
            stop_b,
        })
    }

    /// Whether the time ends a stop that begins: with a STOP B, or SS1 alone.
    fn timed(&self, stop_b: bool) -> bool {
        self.external
            || self.braking != Braking::BareSbr
            || stop_b && self.stop_b == StopbTimer::Timer
    }
}

fields! {
    /// What SS1 does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// The drive brakes, or the control does.
        Braking,
        /// It has ended in STO.
        Sto,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What SS1 does.
        pub phase: Phase,
        /// What is left of p9556.
        pub left: Cycles,
        /// The end of the braking is STOP A: a STOP B was raised since it began.
        pub stop_b: bool,
    }
}

impl State {
    /// Nothing is asked for.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
        stop_b: false,
    };

    /// Time and STOP B are kept while braking only; a time that counts has not run out, and no other runs.
    pub fn invariant(&self, config: &Config) -> bool {
        if self.phase == Phase::Braking {
            self.left <= config.time
                && if self.left.is_zero() {
                    !config.timed(false)
                } else {
                    config.timed(self.stop_b)
                }
        } else {
            self.left.is_zero() && !self.stop_b
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SS1 is selected in this channel.
        pub selected: bool,
        /// The latched stop is STOP B.
        pub stop_b: bool,
        /// STO is selected, or the latched stop is STOP A.
        pub sto: bool,
        /// The drive is switched on: its pulses are enabled.
        pub drive_on: bool,
        /// SAM or SBR is violated.
        pub ramp_violated: bool,
        /// Magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The drive brakes along OFF3.
        pub off3: bool,
        /// SAM or SBR watch.
        pub monitored: bool,
        /// SS1 is active (r9722.1): from the selection or STOP B to STO.
        pub active: bool,
        /// SS1 has ended: STO.
        pub sto: bool,
        /// STOP A is raised: by a violation, or as the end of STOP B.
        pub stop_a: bool,
        /// The violation is reported (C01706).
        pub violated: bool,
    }
}

/// The speed is below the shutdown speed, and that counts.
fn slow(config: &Config, inputs: &Inputs) -> bool {
    !config.external && inputs.speed < config.shutdown
}

monitor! { sinamics::ss1;
    /// A drive that is on brakes: OFF3, monitor and time begin in the same cycle.
    braking_begins ["S120-SS1-010", "S120-SS1-011", "S120-SS1-012", "S120-SAM-002", "S120-SBR-001", "S120-ARCH-003"]:
        when |s| s.before.phase == Phase::Idle && (s.inputs.selected || s.inputs.stop_b) && !s.inputs.sto
            && s.inputs.drive_on && !s.config.external && !s.config.time.is_zero() && s.inputs.speed >= s.config.shutdown
            => s.outputs.off3 && s.outputs.monitored && s.outputs.active && !s.outputs.sto
                && s.after.left == if s.config.timed(s.inputs.stop_b) {
                    s.config.time
                } else {
                    Cycles::ZERO
                };

    /// With an external stop nothing but the time begins.
    external_stop_is_not_monitored ["S120-SS1-016"]:
        when |s| s.config.external
            => !s.outputs.off3 && !s.outputs.monitored && !s.outputs.violated;

    /// Its time alone ends it, however slow the axis is.
    external_stop_waits_for_its_time ["S120-SS1-016"]:
        when |s| s.config.external && s.before.phase == Phase::Braking && !s.inputs.sto
            => s.outputs.sto == (s.before.left == Cycles::new(1));

    /// A drive that is switched off has no torque any more, at once.
    switched_off_is_sto ["S120-SS1-014"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.selected && !s.inputs.drive_on
            => s.outputs.sto && !s.outputs.off3;

    /// Below the shutdown speed STO follows in the same cycle, also in that of the selection.
    shutdown_speed_ends_it ["S120-SS1-010", "S120-SS1-011", "S120-SS1-012", "S120-SS1-013", "S120-SBR-004"]:
        when |s| (s.before.phase == Phase::Braking || s.before.phase == Phase::Idle && (s.inputs.selected || s.inputs.stop_b))
            && !s.config.external && s.inputs.speed < s.config.shutdown
            => s.outputs.sto && !s.outputs.active;

    /// So it does when the time is over, but for SS1 with SBR and no encoder.
    time_ends_it ["S120-SS1-010", "S120-SS1-011", "S120-SS1-012", "S120-SBR-004", "S120-PF-04", "S120-PF-30"]:
        when |s| s.before.phase == Phase::Braking && s.before.left == Cycles::new(1)
            && s.config.braking != Braking::BareSbr
            => s.outputs.sto && !s.outputs.active;

    /// Nothing else ends it: no deselection, no standstill of its own.
    nothing_else_ends_it ["S120-SS1-015", "S120-SS1-010", "S120-SS1-017"]:
        when |s| s.before.phase == Phase::Braking && !s.inputs.sto && !s.outputs.violated
            && s.inputs.speed >= s.config.shutdown && s.before.left > Cycles::new(1)
            => s.outputs.active && !s.outputs.sto;

    /// Without encoder SS1 by the ramp knows no time, and none begins with a STOP B on the way.
    ramp_without_encoder_has_no_time ["S120-SS1-013", "S120-ENC-002"]:
        when |s| s.before.phase == Phase::Braking && s.config.braking == Braking::BareSbr && !s.config.external
            && s.before.left.is_zero() && !s.inputs.sto && !s.inputs.ramp_violated
            && s.inputs.speed >= s.config.shutdown
            => s.outputs.active && s.outputs.monitored;

    /// Each cycle takes one off; no selection, STOP B or other event restarts the time.
    time_is_never_restarted ["S120-SS1-015", "S120-SS1-021", "S120-SS1-017", "S120-PF-37"]:
        when |s| s.before.phase == Phase::Braking && s.after.phase == Phase::Braking
            => s.after.left == s.before.left.tick();

    /// A violated ramp is STOP A in the same cycle, with its message.
    violation_is_stop_a ["S120-SAM-005", "S120-SBR-005", "S120-SAM-003", "S120-PF-17"]:
        when |s| s.before.phase == Phase::Braking && !s.config.external && s.inputs.ramp_violated && !s.inputs.sto
            => s.outputs.stop_a && s.outputs.violated && s.outputs.sto;

    /// STO and STOP A end the braking at once.
    sto_ends_it ["S120-STO-010", "S120-SS1-021"]:
        when |s| s.inputs.sto
            => !s.outputs.active && !s.outputs.off3 && !s.outputs.monitored;

    /// STOP B ends in STOP A, whatever ends it.
    stop_b_ends_in_stop_a ["S120-SS1-017", "S120-PF-30"]:
        when |s| s.before.phase == Phase::Braking && (s.before.stop_b || s.inputs.stop_b) && s.outputs.sto
            => s.outputs.stop_a;

    /// An SS1 that nothing has disturbed ends without a stop.
    ss1_ends_without_a_stop ["S120-SS1-015", "S120-SS1-010"]:
        when |s| !s.before.stop_b && !s.inputs.stop_b && !s.outputs.violated
            => !s.outputs.stop_a;

    /// At the end what is still asked for stays off, all else lets go in the cycle after.
    end_lasts_a_cycle ["S120-SS1-015", "S120-SS1-016"]:
        when |s| s.before.phase == Phase::Sto && !s.inputs.sto
            => s.outputs.sto == (s.inputs.selected || s.inputs.stop_b) && !s.outputs.active;

    /// The status is that of the braking.
    status_is_the_braking ["S120-SS1-018"]:
        when |s| s.before.phase != Phase::Sto
            => s.outputs.active == (s.after.phase == Phase::Braking) && !(s.outputs.active && s.outputs.sto);

    /// The state stays consistent.
    state_stays_consistent ["S120-SS1-010"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let asked = inputs.selected || inputs.stop_b;
    let braking = state.phase == Phase::Braking;
    let stop_b = (braking && state.stop_b) || inputs.stop_b;
    let timed = if braking {
        !state.left.is_zero()
    } else {
        config.timed(inputs.stop_b)
    };
    let left = match timed {
        true if braking => state.left.tick(),
        true => config.time,
        false => Cycles::ZERO,
    };
    let violated = braking && !config.external && inputs.ramp_violated && !inputs.sto;
    let over = timed && left.is_zero();
    let off = !braking && !inputs.drive_on;
    let ends = inputs.sto || violated || over || slow(config, inputs) || off;
    let phase = match state.phase {
        Phase::Idle | Phase::Sto if !asked => Phase::Idle,
        Phase::Sto => Phase::Sto,
        _ if ends => Phase::Sto,
        _ => Phase::Braking,
    };
    let active = phase == Phase::Braking;
    let sto = phase == Phase::Sto;
    let outputs = Outputs {
        off3: active && !config.external,
        monitored: active && !config.external,
        active,
        sto,
        stop_a: violated || sto && stop_b,
        violated,
    };
    let after = State {
        phase,
        left: if active { left } else { Cycles::ZERO },
        stop_b: active && stop_b,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(braking: Braking, external: bool) -> Config {
        let (time, shutdown) = (Cycles::new(4), Speed(10));
        Config::new(time, shutdown, braking, external, StopbTimer::Timer).expect("accepted")
    }

    fn braking(speed: u32) -> Inputs {
        Inputs {
            selected: true,
            drive_on: true,
            speed: Speed(speed),
            ..Inputs::default()
        }
    }

    /// S120-SS1-010, S120-SS1-016: the shutdown speed itself does not end SS1, one below does; an external stop waits.
    #[test]
    fn below_the_shutdown_speed() {
        for external in [false, true] {
            let mut monitor = Monitor::new(config(Braking::EncoderSam, external));
            monitor.step(&braking(100));
            assert!(monitor.step(&braking(10)).active);
            assert_eq!(monitor.step(&braking(9)).sto, !external);
            monitor.step(&braking(9));
            assert!(monitor.step(&braking(9)).sto);
        }
    }

    /// S120-SS1-013, S120-ENC-002: without encoder the ramp needs a shutdown speed.
    #[test]
    fn the_ramp_without_encoder_needs_a_shutdown_speed() {
        let new =
            |braking| Config::new(Cycles::new(1), Speed(0), braking, false, StopbTimer::Timer);
        assert_eq!(new(Braking::BareSbr), Err(ConfigError::ValueOutOfRange));
        assert!(new(Braking::EncoderSbr).is_ok());
    }
}
