//! The blocks of an axis as its safety program calls them.

use stillpoint_machine::{Axis, Machine};
use stillpoint_monitors::srm::common::UNLIMITED;
use stillpoint_monitors::srm::{
    brake_test, endzone, load_calibration, load_monitor, retraction, safe_pos, sbr_monitor,
    slp_monitor,
};

use super::signals::{Flag, Number, Read};
use super::values::{self, BRAKE_TEST, END_ZONE, LOAD, RAMP, SLP};
use super::wiring::{Logic, cause, logic};

/// A stop of the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stop {
    #[default]
    None,
    Ss1,
    Sto,
}

impl Stop {
    /// That of a place in the list of the names.
    pub(super) const fn of(place: usize) -> Self {
        match place {
            0 => Self::None,
            1 => Self::Ss1,
            _ => Self::Sto,
        }
    }
}

/// What the blocks told last. What no call has told yet is 0.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Told {
    pub pos: safe_pos::Outputs,
    pub range: retraction::Outputs,
    pub ramp: sbr_monitor::Outputs,
    pub brake: brake_test::Outputs,
    pub load: load_monitor::Outputs,
    pub calibration: load_calibration::Outputs,
    pub logic: Logic,
}

impl Told {
    /// Before the first call: a block that the axis does not have enables everything and limits nothing.
    fn before(axis: &Axis) -> Self {
        let mut told = Self::default();
        let has = |function| axis.has(function);
        if !has(SLP) && !has(END_ZONE) {
            told.range = retraction::Outputs {
                sls_threshold: UNLIMITED,
                sls_ok: true,
                x_negative_ok: true,
                x_positive_ok: true,
                move_negative_ok: true,
                move_positive_ok: true,
                ..Default::default()
            };
        }
        if !has(RAMP) {
            told.ramp.sbr_ok = true;
        }
        if !has(BRAKE_TEST) {
            told.brake = brake_test::Outputs {
                sls_threshold: UNLIMITED,
                sls_ok: true,
                release_dir: true,
                ..Default::default()
            };
        }
        if !has(LOAD) {
            told.load = load_monitor::Outputs {
                sls_threshold: UNLIMITED,
                sls_ok: true,
                dyn_load_ok: true,
                stat_load_ok: true,
                min_load_ok: true,
                move_negative_ok: true,
                move_positive_ok: true,
                ..Default::default()
            };
        }
        told
    }

    /// Something can be acknowledged.
    pub(super) const fn acknowledgeable(&self) -> bool {
        self.pos.ack_req
            || self.range.ack_req
            || self.ramp.ack_req
            || self.brake.ack_req
            || self.load.ack_req
            || self.calibration.ack_req
    }

    /// A block reports a fault.
    pub(super) const fn faulty(&self) -> bool {
        self.pos.error
            || self.range.error
            || self.ramp.error
            || self.brake.error
            || self.load.error
            || self.calibration.error
    }

    /// Every limit of the velocity is kept.
    pub(super) const fn keeps_limits(&self) -> bool {
        self.range.sls_ok && self.brake.sls_ok && self.load.sls_ok
    }
}

/// What a call tells of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Said {
    pub told: Told,
    /// The program is called.
    pub called: bool,
    /// The stop that the drive is asked for, and why.
    pub stop: Stop,
    pub cause: &'static str,
}

impl Default for Said {
    /// The program is not called: the outputs of the CPU are 0, which asks for the STO.
    fn default() -> Self {
        Self {
            told: Told::default(),
            called: false,
            stop: Stop::Sto,
            cause: "the CPU does not run",
        }
    }
}

/// How the blocks begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Start {
    /// SAFE_POS of a referenced axis; none: the CPU has just been started.
    pub referenced: Option<i32>,
    /// The last brake test was passed.
    pub tested: bool,
    /// So was the last test of the load measurement.
    pub measures: bool,
}

/// A part of the program, in the order of CALL_ORDER.
#[derive(Clone, Copy)]
enum Call {
    SafePos,
    Range,
    Ramp,
    BrakeTest,
    Load,
    Logic,
}

/// All of them, none before what it reads.
const IN_ORDER: [Call; 6] = [
    Call::SafePos,
    Call::Range,
    Call::Ramp,
    Call::BrakeTest,
    Call::Load,
    Call::Logic,
];

#[derive(Clone)]
enum Range {
    None,
    Slp(slp_monitor::Monitor),
    Endzone(Box<endzone::Monitor>),
}

/// The blocks of an axis.
#[derive(Clone)]
pub(super) struct Blocks<'a> {
    machine: &'a Machine,
    axis: &'a Axis,
    order: [Call; 6],
    pos: safe_pos::Monitor,
    range: Range,
    ramp: Option<sbr_monitor::Monitor>,
    brake: Option<brake_test::Monitor>,
    load: Option<(load_calibration::Monitor, load_monitor::Monitor)>,
    told: Told,
    /// It was called in the cycle before.
    runs: bool,
}

impl<'a> Blocks<'a> {
    /// Before the first call after a start of the CPU.
    pub(super) fn new(machine: &'a Machine, axis: &'a Axis) -> Self {
        let t_sample = values::t_sample(machine);
        let has = |function| axis.has(function);
        let places = values::call_order(machine);
        let mut order = IN_ORDER;
        order.sort_by_key(|call| places[*call as usize]);
        Self {
            machine,
            axis,
            order,
            pos: safe_pos::Monitor::new(values::safe_pos(axis, t_sample)),
            range: if has(END_ZONE) {
                Range::Endzone(Box::new(endzone::Monitor::new(values::endzone(axis))))
            } else if has(SLP) {
                Range::Slp(slp_monitor::Monitor::new(values::slp(axis)))
            } else {
                Range::None
            },
            ramp: has(RAMP).then(|| sbr_monitor::Monitor::new(values::ramp(axis, t_sample))),
            brake: has(BRAKE_TEST)
                .then(|| brake_test::Monitor::new(values::brake_test(axis, t_sample))),
            load: has(LOAD).then(|| {
                (
                    load_calibration::Monitor::new(values::calibration(axis, t_sample)),
                    load_monitor::Monitor::new(values::load(axis, t_sample)),
                )
            }),
            told: Told::before(axis),
            runs: false,
        }
    }

    /// As after many calls in which nothing happened: with a reference by which `read` is where `start` says, and passed tests.
    pub(super) fn begin(machine: &'a Machine, axis: &'a Axis, start: &Start, read: &Read) -> Self {
        let mut blocks = Self::new(machine, axis);
        let Some(place) = start.referenced else {
            return blocks;
        };
        let t_sample = values::t_sample(machine);
        let config = values::safe_pos(axis, t_sample);
        let [one, two, si] = [Number::Pos1, Number::Pos2, Number::Possi].map(|n| read.number(n));
        let state = safe_pos::State {
            phase: safe_pos::Phase::Referenced,
            ever: true,
            off1: place.saturating_sub(one),
            off_si: place.saturating_mul(1_000).saturating_sub(si),
            off2: match config.pos_config {
                true => place.saturating_add(two),
                false => 0,
            },
            saved: place,
            safe_pos: place,
            window1: one,
            window_si: si,
            ..safe_pos::State::INITIAL
        };
        // A state that is not consistent does not come about here; without a reference the axis would stand.
        if let Ok(resumed) = safe_pos::Monitor::resume(config, state) {
            blocks.pos = resumed;
        }
        if let (Some(brake), true) = (&mut blocks.brake, start.tested) {
            let config = values::brake_test(axis, t_sample);
            let state = brake_test::State {
                phase: brake_test::Phase::Passed,
                first_ok: config.tests(false),
                tried: true,
                due: false,
                left: config.t_interval,
                ..brake_test::State::INITIAL
            };
            if let Ok(resumed) = brake_test::Monitor::resume(config, state) {
                *brake = resumed;
            }
        }
        if let (Some((calibration, _)), true) = (&mut blocks.load, start.measures) {
            let config = values::calibration(axis, t_sample);
            let state = load_calibration::State {
                passed: true,
                left: config.t_interval,
                ..load_calibration::State::INITIAL
            };
            if let Ok(resumed) = load_calibration::Monitor::resume(config, state) {
                *calibration = resumed;
            }
        }
        // What was told in the call before: where CALL_ORDER makes a block wait, it reads that.
        let mut before = blocks.clone();
        for call in IN_ORDER {
            before.call(call, read);
        }
        blocks.told = before.told;
        blocks.runs = true;
        blocks
    }

    /// A call, where the CPU runs.
    pub(super) fn step(&mut self, read: &Read) -> Said {
        if !read.is(Flag::Run) {
            self.runs = false;
            return Said::default();
        }
        if !self.runs {
            *self = Self::new(self.machine, self.axis);
            self.runs = true;
        }
        for call in self.order {
            self.call(call, read);
        }
        let told = self.told;
        let stop = match (told.logic.torque, told.logic.run) {
            (false, _) => Stop::Sto,
            (true, false) => Stop::Ss1,
            (true, true) => Stop::None,
        };
        let cause = match stop {
            Stop::None => "",
            Stop::Ss1 | Stop::Sto => cause(&told, read),
        };
        Said {
            told,
            called: true,
            stop,
            cause,
        }
    }

    fn call(&mut self, call: Call, read: &Read) {
        let told = &mut self.told;
        let pos = told.pos;
        let (release, ack) = (read.is(Flag::Release), read.is(Flag::Ack));
        match call {
            Call::SafePos => {
                told.pos = self.pos.step(&safe_pos::Inputs {
                    pos1: read.number(Number::Pos1),
                    pos1_valid: read.is(Flag::Pos1Valid),
                    pos2: read.number(Number::Pos2),
                    pos2_valid: read.is(Flag::Pos2Valid),
                    possi: read.number(Number::Possi),
                    possi_valid: read.is(Flag::PossiValid),
                    possi_count: read.number(Number::PossiCount),
                    reference: read.is(Flag::Reference),
                    sync: read.is(Flag::Sync),
                    ack,
                });
            }
            Call::Range => {
                let pos_valid = pos.pos_valid && pos.referenced;
                match &mut self.range {
                    Range::None => {}
                    Range::Slp(monitor) => {
                        told.range = monitor.step(&slp_monitor::Inputs {
                            safe_pos: pos.safe_pos,
                            pos_valid,
                            safe_v: pos.safe_v,
                            v_valid: pos.v_valid,
                            release,
                            ack,
                        });
                    }
                    Range::Endzone(monitor) => {
                        let [x_negative, x_positive] = values::ends(self.axis);
                        told.range = monitor.step(&endzone::Inputs {
                            safe_pos: pos.safe_pos,
                            pos_valid,
                            safe_v: pos.safe_v,
                            v_valid: pos.v_valid,
                            x_negative,
                            x_positive,
                            release,
                            ack,
                        });
                    }
                }
            }
            Call::Ramp => {
                if let Some(monitor) = &mut self.ramp {
                    told.ramp = monitor.step(&sbr_monitor::Inputs {
                        safe_pos: pos.safe_pos,
                        safe_v: pos.safe_v,
                        execute: read.is(Flag::Ss1Active),
                        ack,
                    });
                }
            }
            Call::BrakeTest => {
                if let Some(monitor) = &mut self.brake {
                    told.brake = monitor.step(&brake_test::Inputs {
                        safe_v: pos.safe_v,
                        safe_pos: pos.safe_pos,
                        v_valid: pos.v_valid,
                        pos_valid: pos.pos_valid,
                        fdback_drive: read.is(Flag::FdbackDrive),
                        fdback_br_1: read.is(Flag::FdbackBr1),
                        fdback_br_2: read.is(Flag::FdbackBr2),
                        sbt: read.status(),
                        execute: read.is(Flag::Execute),
                        ack,
                    });
                }
            }
            Call::Load => {
                if let Some((calibration, monitor)) = &mut self.load {
                    let [load1, load2] = [Number::Load1, Number::Load2].map(|n| read.number(n));
                    told.calibration = calibration.step(&load_calibration::Inputs {
                        load1,
                        load2,
                        calibrate: read.is(Flag::Calibrate),
                        ack,
                    });
                    told.load = monitor.step(&load_monitor::Inputs {
                        load1,
                        load2,
                        maxload_mode: read.is(Flag::MaxloadMode),
                        safe_v: pos.safe_v,
                        v_valid: pos.v_valid,
                        // Bit 11.
                        calibration_overflow: told.calibration.diag & 0x800 != 0,
                        release,
                        ack,
                    });
                }
            }
            Call::Logic => told.logic = logic(told, read),
        }
    }
}
