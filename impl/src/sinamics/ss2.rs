//! Safe stop 2 with its stops of equal effect, in one channel: SS2 and STOP C brake, SS2E and STOP D let the control brake, STOP E
//! lets it retract; all end in the operating stop (machine B5).
//!
//! Only the times end them: standstill does not shorten them. Whether the axis then stands is the operating stop's business
//! ([`crate::sinamics::sos`]), which is told by `sos` and takes its position anew.
//!
//! Reading AF-17 is a choice of the configuration, the recommended one first. A delay whose stop is acknowledged meanwhile runs to
//! its end, as that of a deselected SS2E does.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::types::{Braking, Stop};

fields! {
    /// Reading AF-17: what the deselection of SS2 does while it brakes.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Ss2Deselect {
        /// Nothing: the time runs on, the operating stop acts for a cycle at least.
        #[default]
        RunToEnd,
        /// It ends SS2 at once.
        Cancel,
    }
}

config! {
    /// The times, each at least one cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        time_c: Cycles,
        time_d: Cycles,
        time_e: Cycles,
        braking: Braking,
        deselect: Ss2Deselect,
    }
}

impl Config {
    /// `time_c`: p9552 of SS2 and STOP C. `time_d`: p9553 of SS2E and STOP D. `time_e`: p9554 of STOP E. `braking`: p9506.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for a time of 0, [`ConfigError::ValueOutOfRange`] without an encoder (S120-SS2-005).
    pub const fn new(
        time_c: Cycles,
        time_d: Cycles,
        time_e: Cycles,
        braking: Braking,
        deselect: Ss2Deselect,
    ) -> Result<Self, ConfigError> {
        if time_c.is_zero() || time_d.is_zero() || time_e.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        if !braking.encoder() {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self {
            time_c,
            time_d,
            time_e,
            braking,
            deselect,
        })
    }
}

fields! {
    /// Where the stop is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing is asked for.
        #[default]
        Idle,
        /// STOP E: the control retracts.
        DelayE,
        /// SS2E or STOP D: the control brakes.
        DelayD,
        /// SS2 or STOP C: the drive brakes along OFF3.
        Braking,
        /// The operating stop.
        Sos,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the stop is.
        pub phase: Phase,
        /// What is left of its time.
        pub left: Cycles,
    }
}

impl State {
    /// Nothing is asked for.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        left: Cycles::ZERO,
    };

    /// A time runs exactly while its phase lasts.
    pub fn invariant(&self, config: &Config) -> bool {
        let runs = |time: Cycles| !self.left.is_zero() && self.left <= time;
        match self.phase {
            Phase::Idle => *self == Self::INITIAL,
            Phase::DelayE => runs(config.time_e),
            Phase::DelayD => runs(config.time_d),
            Phase::Braking => runs(config.time_c),
            Phase::Sos => self.left.is_zero(),
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// SS2 is selected.
        pub ss2: bool,
        /// SS2E is selected (p9501.18).
        pub ss2e: bool,
        /// The latched stop.
        pub stop: Stop,
        /// SS1 or STO is selected.
        pub ss1_or_sto: bool,
        /// The operating stop is active without this monitor: nothing is left to be braked.
        pub sos_active: bool,
        /// SAM or SBR is violated.
        pub ramp_violated: bool,
    }
}

impl Inputs {
    /// SS1, STO, or a stop that does as they do.
    fn higher(&self) -> bool {
        self.ss1_or_sto || self.stop >= Stop::B
    }

    /// SS2 or STOP C.
    fn brakes(&self) -> bool {
        self.ss2 || self.stop == Stop::C
    }

    /// SS2E or STOP D.
    fn external(&self) -> bool {
        self.ss2e || self.stop == Stop::D
    }

    /// A latched stop finds the axis in the operating stop already (Table 9-3, row SOS); a function that is selected goes its own way.
    fn stands(&self) -> bool {
        self.sos_active
            && matches!(self.stop, Stop::C | Stop::D | Stop::E)
            && !self.ss2
            && !self.ss2e
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The drive brakes along OFF3; SAM (p9506 = 0) or SBR (p9506 = 2) watch.
        pub off3: bool,
        /// The setpoint of the control is inhibited: while the drive brakes, and as long as SS2 is selected or STOP C latched.
        pub inhibited: bool,
        /// SS2 or STOP C is active (r9722.2): braking, or the operating stop that it keeps.
        pub ss2_active: bool,
        /// SS2E or STOP D is active (r9722.28, r10234.11): its delay, or the operating stop that it keeps.
        pub ss2e_active: bool,
        /// Extended stop and retract is asked for.
        pub esr: bool,
        /// The operating stop is asked for.
        pub sos: bool,
        /// The braking is violated: C01706, STOP A.
        pub violated: bool,
    }
}

monitor! { sinamics::ss2;
    /// SS2 and STOP C brake at once, for their whole time, with the setpoint inhibited; a delay that runs gives way.
    braking_begins ["S120-SS2-001", "S120-SS2-010", "S120-SAM-002", "S120-SBR-001"]:
        when |s| (s.inputs.ss2 || s.inputs.stop == Stop::C && !s.inputs.sos_active) && !s.inputs.ss1_or_sto
            && s.inputs.stop < Stop::B && s.before.phase != Phase::Braking && s.before.phase != Phase::Sos
            => s.outputs.off3 && s.outputs.inhibited && s.outputs.ss2_active && s.after.left == s.config.time_c;

    /// SS2E and STOP D run their time, with the setpoint followed and nothing monitored.
    external_stop_begins ["S120-SS2-007", "S120-SS2-004"]:
        when |s| (s.inputs.ss2e || s.inputs.stop == Stop::D) && !s.inputs.ss2 && s.inputs.stop < Stop::C
            && !s.inputs.ss1_or_sto && !s.inputs.sos_active && s.before.phase == Phase::Idle
            => s.after.left == s.config.time_d && s.outputs.ss2e_active && !s.outputs.off3 && !s.outputs.inhibited
                && !s.outputs.sos;

    /// STOP E runs its time and asks for the retraction.
    stop_e_retracts ["S120-SOS-002"]:
        when |s| s.inputs.stop == Stop::E && !s.inputs.ss2 && !s.inputs.ss2e && !s.inputs.ss1_or_sto
            && !s.inputs.sos_active && s.before.phase == Phase::Idle
            => s.after.left == s.config.time_e && s.outputs.esr && !s.outputs.off3 && !s.outputs.sos;

    /// Braking takes its whole time: nothing restarts it, no standstill ends it sooner, and then comes the operating stop.
    braking_ends_in_sos ["S120-SS2-001", "S120-SS2-002", "S120-SS2-003", "S120-SS2-012", "S120-SBR-004", "S120-PF-33", "S120-PF-37"]:
        when |s| s.before.phase == Phase::Braking && !s.inputs.ss1_or_sto && s.inputs.stop < Stop::B
            && !s.inputs.ramp_violated && (s.inputs.ss2 || s.inputs.stop == Stop::C)
            => s.after.left == s.before.left.tick() && s.outputs.sos == (s.before.left == Cycles::new(1))
                && s.outputs.off3 != s.outputs.sos;

    /// A deselection on the way changes nothing of that (AF-17), or ends it.
    deselected_braking ["S120-SS2-011"]:
        when |s| s.before.phase == Phase::Braking && !s.inputs.ss1_or_sto && s.inputs.stop == Stop::None
            && !s.inputs.ramp_violated && !s.inputs.ss2
            => match s.config.deselect {
                Ss2Deselect::RunToEnd => s.after.left == s.before.left.tick()
                    && s.outputs.sos == (s.before.left == Cycles::new(1)),
                Ss2Deselect::Cancel => !s.outputs.off3 && !s.outputs.sos && !s.outputs.inhibited,
            };

    /// A delay runs to its end, selected or not, and ends in the operating stop.
    delay_ends_in_sos ["S120-SS2-007", "S120-SS2-009", "S120-SOS-002", "S120-PF-30", "S120-PF-37"]:
        when |s| (s.before.phase == Phase::DelayD || s.before.phase == Phase::DelayE && !s.inputs.ss2e)
            && !s.inputs.ss2 && !s.inputs.ss1_or_sto && !s.inputs.sos_active
            && (s.inputs.stop == Stop::None || s.inputs.stop == Stop::E)
            => s.after.left == s.before.left.tick() && s.outputs.sos == (s.before.left == Cycles::new(1));

    /// SS2E takes over from STOP E with a time of its own.
    external_stop_takes_over ["S120-SS2-010"]:
        when |s| s.before.phase == Phase::DelayE && (s.inputs.ss2e || s.inputs.stop == Stop::D) && !s.inputs.ss2
            && s.inputs.stop < Stop::C && !s.inputs.ss1_or_sto && !s.inputs.sos_active
            => s.after.phase == Phase::DelayD && s.after.left == s.config.time_d;

    /// A violated ramp is told, for STOP A; SS2 does no more.
    violation_is_told ["S120-SS2-004", "S120-SAM-005", "S120-SBR-005"]:
        when |s| s.before.phase == Phase::Braking && s.inputs.ramp_violated && !s.inputs.ss1_or_sto && s.inputs.stop < Stop::B
            => s.outputs.violated && !s.outputs.off3 && s.after.phase == Phase::Idle;

    /// Only while it brakes: a delay of the control is not monitored.
    delays_are_not_monitored ["S120-SS2-004", "S120-SS2-007"]:
        when |s| s.before.phase != Phase::Braking
            => !s.outputs.violated;

    /// SS1, STO, STOP A and STOP B take over what runs.
    higher_stop_takes_over ["S120-SS2-010", "S120-STO-010"]:
        when |s| (s.inputs.ss1_or_sto || s.inputs.stop >= Stop::B) && s.before.phase != Phase::Sos
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// The operating stop lasts while a function is selected or any stop is latched.
    sos_stays ["S120-SOS-009", "S120-SOS-010", "S120-PF-38"]:
        when |s| s.before.phase == Phase::Sos && (s.inputs.ss2 || s.inputs.ss2e || s.inputs.stop != Stop::None)
            => s.outputs.sos && !s.outputs.off3;

    /// It ends when none is.
    sos_ends ["S120-SOS-010", "S120-SS2-009"]:
        when |s| s.before.phase == Phase::Sos && !s.inputs.ss2 && !s.inputs.ss2e && s.inputs.stop == Stop::None
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// In the operating stop SS2 inhibits the setpoint.
    ss2_inhibits_the_setpoint ["S120-SS2-001"]:
        when |s| s.outputs.sos && s.inputs.ss2
            => s.outputs.inhibited && s.outputs.ss2_active;

    /// A latched stop that finds the axis in the operating stop keeps it there.
    latched_stop_holds_sos ["S120-SOS-010", "S120-SOS-002"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.sos_active && !s.inputs.ss2 && !s.inputs.ss2e && !s.inputs.ss1_or_sto
            && (s.inputs.stop == Stop::C || s.inputs.stop == Stop::D || s.inputs.stop == Stop::E)
            => s.outputs.sos && !s.outputs.off3 && s.outputs.esr == (s.inputs.stop == Stop::E);

    /// The bits say what runs.
    status_is_exact ["S120-SS2-001", "S120-SS2-008", "S120-SOS-002"]:
        when |s| s.before.invariant(&s.config)
            => {
                let sos = s.after.phase == Phase::Sos;
                s.outputs.sos == sos
                    && s.outputs.off3 == (s.after.phase == Phase::Braking)
                    && s.outputs.ss2_active
                        == (s.outputs.off3 || sos && (s.inputs.ss2 || s.inputs.stop == Stop::C))
                    && s.outputs.inhibited == s.outputs.ss2_active
                    && s.outputs.ss2e_active
                        == (s.after.phase == Phase::DelayD || sos && (s.inputs.ss2e || s.inputs.stop == Stop::D))
                    && s.outputs.esr == (s.after.phase == Phase::DelayE || sos && s.inputs.stop == Stop::E)
            };

    /// The state stays consistent.
    state_stays_consistent ["S120-SS2-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

/// What begins when nothing runs, or instead of what runs; none where nothing does.
fn begins(phase: Phase, config: &Config, inputs: &Inputs) -> Option<(Phase, Cycles)> {
    let (begun, time) = if phase == Phase::Idle && inputs.stands() {
        (Phase::Sos, Cycles::ZERO)
    } else if inputs.brakes() {
        (Phase::Braking, config.time_c)
    } else if inputs.external() {
        (Phase::DelayD, config.time_d)
    } else if inputs.stop == Stop::E {
        (Phase::DelayE, config.time_e)
    } else {
        return None;
    };
    let rank = |phase: Phase| phase as u8;
    (rank(begun) > rank(phase)).then_some((begun, time))
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut outputs = Outputs::default();
    let asked = inputs.brakes() || inputs.external() || inputs.stop != Stop::None;
    let cancelled =
        state.phase == Phase::Braking && config.deselect == Ss2Deselect::Cancel && !inputs.brakes();
    let running = if cancelled { Phase::Idle } else { state.phase };
    let (phase, left) = match running {
        Phase::Sos if asked => (Phase::Sos, Cycles::ZERO),
        Phase::Sos => (Phase::Idle, Cycles::ZERO),
        _ if inputs.higher() => (Phase::Idle, Cycles::ZERO),
        _ if state.phase == Phase::Braking && inputs.ramp_violated => {
            outputs.violated = true;
            (Phase::Idle, Cycles::ZERO)
        }
        _ => match begins(running, config, inputs) {
            Some(begun) => begun,
            None if running == Phase::Idle => (Phase::Idle, Cycles::ZERO),
            None if state.left.tick().is_zero() => (Phase::Sos, Cycles::ZERO),
            None => (running, state.left.tick()),
        },
    };
    // A function is active while it runs, and in the operating stop as long as it asks for it.
    let sos = phase == Phase::Sos;
    outputs.off3 = phase == Phase::Braking;
    outputs.ss2_active = outputs.off3 || sos && inputs.brakes();
    outputs.inhibited = outputs.ss2_active;
    outputs.ss2e_active = phase == Phase::DelayD || sos && inputs.external();
    outputs.esr = phase == Phase::DelayE || sos && inputs.stop == Stop::E;
    outputs.sos = sos;
    (State { phase, left }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn monitor(deselect: Ss2Deselect) -> Monitor {
        let time = Cycles::new(3);
        let config = Config::new(time, time, time, Braking::EncoderSam, deselect);
        Monitor::new(config.expect("accepted"))
    }

    /// S120-SS2-009, Image 4-5: deselected early, SS2E ends in one cycle of the operating stop, then the setpoint counts.
    #[test]
    fn a_deselected_external_stop_is_a_cycle_of_sos() {
        let mut monitor = monitor(Ss2Deselect::RunToEnd);
        let mut inputs = Inputs {
            ss2e: true,
            ..Inputs::default()
        };
        assert!(monitor.step(&inputs).ss2e_active);
        inputs.ss2e = false;
        assert!(monitor.step(&inputs).ss2e_active);
        assert!(monitor.step(&inputs).ss2e_active);
        let outputs = monitor.step(&inputs);
        assert!(outputs.sos && !outputs.inhibited);
        assert_eq!(monitor.step(&inputs), Outputs::default());
    }

    /// S120-SS2-010, Image 4-6: SS2 during SS2E brakes for the whole p9552.
    #[test]
    fn ss2_interrupts_ss2e() {
        let mut monitor = monitor(Ss2Deselect::RunToEnd);
        let mut inputs = Inputs {
            ss2e: true,
            ..Inputs::default()
        };
        monitor.step(&inputs);
        monitor.step(&inputs);
        inputs.ss2 = true;
        for _ in 0..3 {
            assert!(monitor.step(&inputs).off3);
        }
        assert!(monitor.step(&inputs).sos);
    }
}
