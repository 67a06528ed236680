//! The stop reaction of one axis group in one channel: SS2, SS1D, SS1, SS1F and SS0 with their timers, up to torque off and
//! the restart.
//!
//! SS2 brakes along the contour and leaves the group under control. SS1 brakes along the emergency ramp; channel B closes the
//! brakes at standstill and takes the torque after their overlap time, channel A follows its report. SS1D is an SS1 that
//! waits until the groups listed in SMP610 stand still. A stop that lasts longer than its time becomes the next higher one,
//! in each channel alone.
//!
//! A stop begins in the cycle of its demand, so that its time counts from the signal that asked for it (HFS-TIMING-005,
//! HFS-TIMING-006). In the cycle after the drives have come to stand channel B closes the brakes (-BRK_REL.B.x), MP2308 later
//! it takes the torque (-STO.B.x), and channel A takes its own and closes its brakes (-STO.A.x, -BRK_REL.A.x) in the cycle
//! of the report (HFS-TIMING-010, HFS-TIMING-011).
//!
//! Only a higher stop displaces a running one, and no stop ends because its cause does (HFS-STOP-002, HFS-STOP-003). Further
//! readings of the manual implemented here: AMB-02 MACHINE (an SS1 after a failed SS2 is found by the kernel), AMB-06 BOTH
//! (SS2 waits as well), AMB-07 STO_O, AMB-44 EDGE (the restart is a fresh edge, found outside), AMB-73 FROM_REQUEST.
//!
//! The standstill of a group that is asked for an SS2 ends it in the same cycle. A braking SS2 that comes to stand in the
//! very cycle in which its time is up has ended in time; so has an SS1 whose torque is off in that cycle. A group that waits
//! for others is not braked by its own stop; a request for SS1D takes the place of an SS2 that waits, with its time, while
//! one that brakes goes on.

use crate::heidenhain::types::{Phase, Stop};
use crate::kernel::{ConfigError, Cycles};

mod laws;

pub use laws::*;

config! {
    /// The times of a group, equal in both channels, and which channel it is.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        cc: bool,
        t_ss1: Cycles,
        t_ss2: Cycles,
        t_brake: Cycles,
    }
}

impl Config {
    /// The longest of SMP525 to SMP528: 10 s in cycles of 3 ms, rounded up.
    pub const LONGEST: Cycles = Cycles::new(3334);

    /// `cc`: channel B, which brakes the drives. `t_ss1`: time of an SS1 until torque off (SMP525, SMP526). `t_ss2`: time of
    /// an SS2 until standstill (SMP527, SMP528). `t_brake`: overlap of the brake (MP2308).
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] when one of them is above [`Config::LONGEST`].
    pub fn new(
        cc: bool,
        t_ss1: Cycles,
        t_ss2: Cycles,
        t_brake: Cycles,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            cc,
            t_ss1: t_ss1.at_most(Self::LONGEST)?,
            t_ss2: t_ss2.at_most(Self::LONGEST)?,
            t_brake: t_brake.at_most(Self::LONGEST)?,
        })
    }

    /// Channel B.
    pub const fn is_cc(&self) -> bool {
        self.cc
    }

    /// Time of an SS1 until torque off.
    pub const fn t_ss1(&self) -> Cycles {
        self.t_ss1
    }

    /// Time of an SS2 until standstill.
    pub const fn t_ss2(&self) -> Cycles {
        self.t_ss2
    }

    /// Overlap of the brake.
    pub const fn t_brake(&self) -> Cycles {
        self.t_brake
    }
}

/// What a timer of this time starts with: one cycle at least.
pub const fn started(time: Cycles) -> Cycles {
    if time.is_zero() { Cycles::new(1) } else { time }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The stop in force.
        pub level: Stop,
        /// What it is doing.
        pub phase: Phase,
        /// What is left of the time of the SS2 or SS1 that runs, else 0.
        pub timer: Cycles,
        /// What is left of the overlap of the brake while it closes, else 0.
        pub brake: Cycles,
        /// The SS1 that brakes concerns the whole machine: it stops the other groups too.
        pub wide: bool,
    }
}

impl State {
    /// No stop.
    pub const INITIAL: Self = Self {
        level: Stop::None,
        phase: Phase::Run,
        timer: Cycles::ZERO,
        brake: Cycles::ZERO,
        wide: false,
    };

    /// Level, phase and timers belong together.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let timed = !self.timer.is_zero();
        let (t_ss1, t_ss2) = (started(config.t_ss1), started(config.t_ss2));
        let fits = match self.phase {
            Phase::Run => self.level == Stop::None && !timed,
            Phase::Ss2Wait | Phase::Ss2Brake => {
                self.level == Stop::Ss2 && timed && self.timer <= t_ss2
            }
            // Its own wait has no time; that of an SS2 that goes on braking runs on.
            Phase::Ss1DWait => self.level == Stop::Ss1D && self.timer <= t_ss2,
            Phase::EmergencyBrake | Phase::BrakeCloses => {
                matches!(self.level, Stop::Ss1D | Stop::Ss1 | Stop::Ss1F)
                    && timed
                    && self.timer <= t_ss1
            }
            Phase::TorqueOff => self.level >= Stop::Ss1D && !timed,
        };
        let closes = matches!(self.phase, Phase::BrakeCloses);
        let ramp = closes || matches!(self.phase, Phase::EmergencyBrake);
        fits && closes != self.brake.is_zero()
            && self.brake <= started(config.t_brake)
            && (config.cc || !closes)
            && (!self.wide || (ramp && self.level >= Stop::Ss1))
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub main_switch: bool,
        /// The highest cause of this cycle for this group, in this channel or told by the other.
        pub demand: Stop,
        /// An SS1 among the causes concerns the whole machine: emergency stop, or found by the safety kernel.
        pub wide_cause: bool,
        /// All drives of the group are below 50 mm/min or 10 rpm.
        pub still: bool,
        /// The groups that SMP610 lists for this one stand still, or none is listed.
        pub listed_still: bool,
        /// The other channel has reported torque off.
        pub peer_off: bool,
        /// The operator switches the drives on: a fresh edge after torque off, the contact chain closed.
        pub restart: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop in force.
        pub level: Stop,
        /// What it is doing.
        pub phase: Phase,
        /// The SS1 that brakes concerns the whole machine: it stops the other groups too.
        pub wide: bool,
        /// -STO.A.x or -STO.B.x is 0.
        pub torque_off: bool,
        /// Safe brake control: the brakes of the group are closed by this channel.
        pub brake_closed: bool,
        /// The NC brakes the group along the contour.
        pub on_contour: bool,
        /// The drives brake along the emergency ramp.
        pub emergency_ramp: bool,
        /// The groups that SMP610 lists get an SS2.
        pub brake_listed: bool,
        /// Only the main switch allows a restart.
        pub needs_switch: bool,
        /// An SS2 has ended in this cycle, or was asked of a group that stands.
        pub ss2_ended: bool,
        /// The drives are switched on again.
        pub restarted: bool,
        /// The torque is off at the end of an SS1D, which needs no drive-on.
        pub keeps_enable: bool,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.main_switch {
        return (State::INITIAL, Outputs::default());
    }
    let restarted = restarts(state, inputs);
    let after = if restarted {
        State::INITIAL
    } else {
        stopped(state, config, inputs)
    };
    let controlled = matches!(state.phase, Phase::Run | Phase::Ss2Brake);
    let asked = state.level == Stop::Ss2 || inputs.demand == Stop::Ss2;
    let ss2_ended = after.level == Stop::None && controlled && asked;
    (after, outputs(after, ss2_ended, restarted))
}

/// The operator's restart counts after an ended SS1, and while nothing of that rank is asked for; an SS1D that has ended in
/// both channels needs no restart.
fn restarts(state: State, inputs: &Inputs) -> bool {
    let soft_end = state.level == Stop::Ss1D && inputs.peer_off;
    state.phase == Phase::TorqueOff
        && state.level < Stop::Ss1F
        && inputs.demand < Stop::Ss1D
        && (inputs.restart || soft_end)
}

/// One cycle of a stop, or of the wait for one.
fn stopped(before: State, config: &Config, inputs: &Inputs) -> State {
    let level = before.level.max(inputs.demand);
    let raised = State { level, ..before };
    if inputs.demand == Stop::Ss0 {
        return torque_off(raised);
    }
    match before.phase {
        Phase::TorqueOff => raised,
        Phase::EmergencyBrake | Phase::BrakeCloses => brake(
            State {
                wide: before.wide || widens(inputs),
                ..raised
            },
            config,
            inputs,
        ),
        _ if level >= Stop::Ss1 => emergency(level, widens(inputs), config),
        _ if level == Stop::Ss1D => delay(before, config, inputs),
        Phase::Ss2Wait => wait(before, config, inputs),
        Phase::Ss2Brake if inputs.still => State::INITIAL,
        Phase::Ss2Brake => run(before.phase, before.timer, config),
        Phase::Run | Phase::Ss1DWait => start(config, inputs),
    }
}

/// An SS1 is asked for that concerns the whole machine; SS1F and SS0 do so by themselves.
fn widens(inputs: &Inputs) -> bool {
    inputs.wide_cause && inputs.demand == Stop::Ss1
}

/// An SS2, if one is asked for: it waits for the listed groups, brakes, or has ended where the group stands.
fn start(config: &Config, inputs: &Inputs) -> State {
    let timer = started(config.t_ss2);
    let phase = if inputs.listed_still {
        Phase::Ss2Brake
    } else {
        Phase::Ss2Wait
    };
    if inputs.demand < Stop::Ss2 || (inputs.listed_still && inputs.still) {
        State::INITIAL
    } else {
        State {
            level: Stop::Ss2,
            phase,
            timer,
            ..State::INITIAL
        }
    }
}

/// One cycle of an SS2 that waits for the listed groups. Its time runs from the request.
fn wait(before: State, config: &Config, inputs: &Inputs) -> State {
    let phase = if inputs.listed_still {
        Phase::Ss2Brake
    } else {
        Phase::Ss2Wait
    };
    run(phase, before.timer, config)
}

/// One cycle of the time of an SS2; when it is up the SS2 has failed.
fn run(phase: Phase, timer: Cycles, config: &Config) -> State {
    let timer = timer.tick();
    if timer.is_zero() {
        failed_ss2(config)
    } else {
        State {
            level: Stop::Ss2,
            phase,
            timer,
            ..State::INITIAL
        }
    }
}

/// An SS2 that has not come to stand in its time is an SS1, found by the kernel: of the whole machine.
fn failed_ss2(config: &Config) -> State {
    emergency(Stop::Ss1, true, config)
}

/// One cycle of an SS1D: it waits for the listed groups, and an SS2 that was braking goes on until the group stands.
fn delay(before: State, config: &Config, inputs: &Inputs) -> State {
    let braking = matches!(before.phase, Phase::Ss2Brake | Phase::Ss1DWait)
        && !before.timer.is_zero()
        && !inputs.still;
    let timer = if braking {
        before.timer.tick()
    } else {
        Cycles::ZERO
    };
    if braking && timer.is_zero() {
        failed_ss2(config)
    } else if inputs.listed_still {
        emergency(Stop::Ss1D, false, config)
    } else {
        State {
            level: Stop::Ss1D,
            phase: Phase::Ss1DWait,
            timer,
            ..State::INITIAL
        }
    }
}

/// The emergency ramp begins.
fn emergency(level: Stop, wide: bool, config: &Config) -> State {
    State {
        level,
        phase: Phase::EmergencyBrake,
        timer: started(config.t_ss1),
        wide,
        ..State::INITIAL
    }
}

/// One cycle of an SS1: the brake closes at standstill (channel B) or the other channel reports (channel A), and its time
/// runs.
fn brake(state: State, config: &Config, inputs: &Inputs) -> State {
    let timer = state.timer.tick();
    let closing = state.phase == Phase::BrakeCloses;
    let brake = if closing {
        state.brake.tick()
    } else {
        started(config.t_brake)
    };
    let done = if config.cc {
        closing && brake.is_zero()
    } else {
        inputs.peer_off
    };
    if done {
        torque_off(state)
    } else if timer.is_zero() {
        torque_off(State {
            level: Stop::Ss0,
            ..state
        })
    } else if config.cc && (closing || inputs.still) {
        State {
            phase: Phase::BrakeCloses,
            timer,
            brake,
            ..state
        }
    } else {
        State { timer, ..state }
    }
}

/// Torque off, at the end of a stop or at once.
fn torque_off(state: State) -> State {
    State {
        level: state.level,
        phase: Phase::TorqueOff,
        ..State::INITIAL
    }
}

fn outputs(state: State, ss2_ended: bool, restarted: bool) -> Outputs {
    let off = state.phase == Phase::TorqueOff;
    Outputs {
        level: state.level,
        phase: state.phase,
        wide: state.wide,
        torque_off: off,
        brake_closed: off || state.phase == Phase::BrakeCloses,
        on_contour: state.phase == Phase::Ss2Brake
            || (state.phase == Phase::Ss1DWait && !state.timer.is_zero()),
        emergency_ramp: state.phase == Phase::EmergencyBrake,
        brake_listed: matches!(state.phase, Phase::Ss2Wait | Phase::Ss1DWait),
        needs_switch: state.level >= Stop::Ss1F,
        ss2_ended,
        restarted,
        keeps_enable: off && state.level == Stop::Ss1D,
    }
}
