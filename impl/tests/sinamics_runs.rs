//! Runs of the functions of SINAMICS S120 together: what one cycle of one monitor cannot show.

use stillpoint_monitors::kernel::{Cycles, Distance, Position, Speed};
use stillpoint_monitors::sinamics::sam::{self, SamBelow, SamL0};
use stillpoint_monitors::sinamics::sls::{self, Level, Slsd};
use stillpoint_monitors::sinamics::sos;
use stillpoint_monitors::sinamics::ss1::{self, StopbTimer};
use stillpoint_monitors::sinamics::ss1_basic;
use stillpoint_monitors::sinamics::ss2::{self, Ss2Deselect};
use stillpoint_monitors::sinamics::sto;
use stillpoint_monitors::sinamics::types::{Braking, Stop};

/// One channel of an axis with encoder and SAM, wired as the manual's Table 9-3 says; the arbiter is no more than a latch.
struct Axis {
    sls: sls::Monitor,
    ss2: ss2::Monitor,
    sos: sos::Monitor,
    sam: sam::Monitor,
    ss1: ss1::Monitor,
    sto: sto::Monitor,
    stop: Stop,
    braking: bool,
    sos_active: bool,
}

/// What an axis does in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Seen {
    sls: bool,
    braking: bool,
    sos: bool,
    sto: bool,
    stop: Stop,
}

impl Axis {
    fn new(response: Stop) -> Self {
        let time = Cycles::new(4);
        let braking = Braking::EncoderSam;
        let sls = sls::Config::new(
            [Speed(100); 4],
            [response; 4],
            Cycles::new(2),
            true,
            false,
            false,
            Slsd::Keep,
        );
        let sam = sam::Config::new(
            Speed(20),
            1,
            Speed(5),
            Speed(0),
            Stop::A,
            SamL0::InMin,
            SamBelow::Hold,
        );
        let ss2 = ss2::Config::new(time, time, time, braking, Ss2Deselect::RunToEnd);
        let ss1 = ss1::Config::new(time, Speed(10), braking, false, StopbTimer::Timer);
        Self {
            sls: sls::Monitor::new(sls.expect("accepted")),
            ss2: ss2::Monitor::new(ss2.expect("accepted")),
            sos: sos::Monitor::new(sos::Config {
                delay: Cycles::new(2),
                tolerance: Distance(3),
            }),
            sam: sam::Monitor::new(sam.expect("accepted")),
            ss1: ss1::Monitor::new(ss1.expect("accepted")),
            sto: sto::Monitor::new(sto::Config { valve: false }),
            stop: Stop::None,
            braking: false,
            sos_active: false,
        }
    }

    /// A cycle at this speed and position, with SLS selected.
    fn step(&mut self, speed: u32, position: i32) -> Seen {
        let speed = Speed(speed);
        let sam = self.sam.step(&sam::Inputs {
            braking: self.braking,
            speed,
            encoder_fault: false,
        });
        let sls = self.sls.step(&sls::Inputs {
            selected: true,
            level: Level::FIRST,
            speed,
            sos_after_stop: self.sos_active,
            ..sls::Inputs::default()
        });
        self.stop = self.stop.max(sam.demand).max(sls.demand);
        let ss2 = self.ss2.step(&ss2::Inputs {
            stop: self.stop,
            ramp_violated: sam.violated,
            ..ss2::Inputs::default()
        });
        let sos = self.sos.step(&sos::Inputs {
            held: ss2.sos,
            position: Position(position),
            ..sos::Inputs::default()
        });
        self.stop = self.stop.max(sos.demand);
        let ss1 = self.ss1.step(&ss1::Inputs {
            stop_b: self.stop == Stop::B,
            sto: self.stop == Stop::A,
            drive_on: true,
            ramp_violated: sam.violated,
            speed,
            ..ss1::Inputs::default()
        });
        if ss1.stop_a {
            self.stop = Stop::A;
        }
        let sto = self.sto.step(&sto::Inputs {
            powered_up: true,
            ss1_ended: ss1.sto,
            stop_a: self.stop == Stop::A,
            ..sto::Inputs::default()
        });
        self.braking = ss2.off3 || ss1.monitored;
        self.sos_active = ss2.sos;
        Seen {
            sls: sls.active,
            braking: ss2.off3 || ss1.off3,
            sos: sos.active,
            sto: sto.active,
            stop: self.stop,
        }
    }
}

/// S120-SLS-003, S120-SLS-024, S120-SS2-003, S120-SOS-005, S120-SOS-009, S120-SS1-010: a violated SLS with STOP C brakes for p9552,
/// with SLS still active, then stands; the axis creeps away: STOP B, below the shutdown speed STOP A, and SOS goes on all the time.
#[test]
fn a_violated_speed_ends_in_the_operating_stop_and_creeping_in_sto() {
    let mut axis = Axis::new(Stop::C);
    for _ in 0..3 {
        assert!(!axis.step(100, 0).braking);
    }
    let seen = axis.step(101, 0);
    assert!(seen.sls && seen.braking && seen.stop == Stop::C);
    for speed in [80, 40, 0] {
        let seen = axis.step(speed, 7);
        assert!(seen.sls && seen.braking && !seen.sos);
    }
    let seen = axis.step(0, 7);
    assert!(seen.sos && !seen.braking);
    let seen = axis.step(0, 10);
    assert!(!seen.sls && seen.sos && seen.stop == Stop::C && !seen.sto);
    let seen = axis.step(12, 11);
    assert!(seen.sos && seen.braking && seen.stop == Stop::B && !seen.sto);
    let seen = axis.step(9, 12);
    assert!(seen.sto && seen.sos && seen.stop == Stop::A);
    for _ in 0..3 {
        let seen = axis.step(0, 12);
        assert!(seen.sto && seen.sos && seen.stop == Stop::A);
    }
}

/// S120-SAM-003, S120-SAM-005, S120-SS2-004: a drive that does not brake but accelerates is STOP A by SAM.
#[test]
fn an_accelerating_drive_loses_its_torque() {
    let mut axis = Axis::new(Stop::C);
    for speed in [0, 0, 0, 101, 110] {
        assert!(!axis.step(speed, 0).sto);
    }
    let seen = axis.step(131, 0);
    assert!(seen.sto && seen.stop == Stop::A && !seen.braking);
}

/// S120-SLS-003, S120-SS1-010: the same with STOP B and STOP A as the response of SLS.
#[test]
fn responses_b_and_a() {
    let mut axis = Axis::new(Stop::B);
    for speed in [0, 0, 0, 101, 50] {
        assert!(!axis.step(speed, 0).sto);
    }
    assert!(axis.step(9, 0).sto);
    let mut axis = Axis::new(Stop::A);
    for _ in 0..3 {
        axis.step(0, 0);
    }
    assert!(axis.step(101, 0).sto);
}

/// S120-SS1-002, S120-SS1-004, S120-SS1-021: whatever selection and STO do after the first selection of the Basic SS1, STO acts p9652
/// later at the latest.
#[test]
fn the_basic_ss1_ends_in_time_whatever_is_asked_for() {
    for time in 1..=6_u32 {
        for pattern in 0..1_u32 << time {
            let mut monitor = ss1_basic::Monitor::new(ss1_basic::Config {
                time: Cycles::new(time),
                external: pattern % 2 == 1,
            });
            let mut inputs = ss1_basic::Inputs {
                selected: true,
                sto: false,
            };
            assert!(!monitor.step(&inputs).sto);
            for cycle in 1..=time {
                inputs.selected = pattern >> (cycle - 1) & 1 == 1;
                assert_eq!(monitor.step(&inputs).sto, cycle == time);
            }
        }
    }
}
