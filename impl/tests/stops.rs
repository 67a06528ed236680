//! What the stops do to the end: categories, both channels with their own timers, the delay of STOP F; and what raises none.

use core::num::NonZeroU32;

use stillpoint_monitors::kernel::{Cycles, Distance, DurationTooLong, Position, Speed};

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{Monitored, Stage};
use stillpoint_monitors::sinumerik::{cam, external, fault, group, selection, speed, stop};
use stillpoint_monitors::units::ModuloRange;

fn cycles(count: u32) -> Cycles {
    Cycles::new(count)
}

fn stops(time: u32) -> stop::Monitor {
    let t = cycles(time);
    stop::Monitor::new(stop::Config::new(t, t, t, t).expect("plausible"))
}

/// S840D-STOP-008: the category of EN 60204-1 is what the stop does: 0 takes the torque at once, 1 brakes before it does, 2
/// brakes and keeps it.
#[test]
fn stops_do_what_their_category_says() {
    for demand in InternalStop::ALL {
        let mut monitor = stops(3);
        let first = monitor.step(&stop::Inputs {
            demand,
            ..Default::default()
        });
        let mut last = first;
        for _ in 0..4 {
            last = monitor.step(&stop::Inputs::default());
        }
        let brakes = first.n_set_zero || first.path_brake || first.esr;
        let seen = match (brakes, first.cancel_pulses, last.cancel_pulses) {
            (false, true, true) => Some(0),
            (true, false, true) => Some(1),
            (true, false, false) if last.sbh_internal => Some(2),
            _ => None,
        };
        assert_eq!(demand.level().category(), seen, "{demand:?}");
    }
    assert_eq!(Level::F.category(), None);
    assert_eq!(Level::Test.category(), None);
}

/// S840D-STOP-088: signals can ask for A, C, D and E, not for B, F or a test.
#[test]
fn there_is_no_external_stop_b_or_f() {
    let possible: Vec<Level> = Level::ALL
        .into_iter()
        .filter(|l| ExternalStop::from_level(*l).is_some())
        .collect();
    assert_eq!(
        possible,
        [Level::None, Level::E, Level::D, Level::C, Level::A]
    );
}

/// S840D-TIMING-510: two PLC cycles and one interpolator cycle, rounded up to monitoring cycles.
#[test]
fn the_least_tolerance_covers_two_plc_cycles_and_one_interpolator_cycle() {
    let cycle = NonZeroU32::new(12_000).expect("not zero");
    let least = |plc, ipo| Cycles::least_change_tolerance(plc, ipo, cycle);
    assert_eq!(least(50_000, 16_000), Ok(cycles(10)));
    assert_eq!(least(52_000, 16_000), Ok(cycles(10)));
    assert_eq!(least(52_001, 16_000), Ok(cycles(11)));
    assert_eq!(least(0, 0), Ok(Cycles::ZERO));
    assert_eq!(
        Cycles::least_change_tolerance(u32::MAX, u32::MAX, NonZeroU32::MIN),
        Err(DurationTooLong)
    );
}

/// Two channels that tell each other their stops with a delay of one cycle: the only way from one to the other
/// (S840D-ARCH-501).
struct Pair {
    stops: [stop::Monitor; 2],
    faults: [fault::Monitor; 2],
    sent: [(InternalStop, bool); 2],
}

impl Pair {
    fn new(time: u32, t_f: u32) -> Self {
        let fault = fault::Monitor::new(fault::Config::new(cycles(t_f)).expect("plausible"));
        Self {
            stops: [stops(time); 2],
            faults: [fault; 2],
            sent: [(InternalStop::None, false); 2],
        }
    }

    /// One cycle; for each channel what its monitors demand, whether it finds a difference, whether a function is active.
    fn step(
        &mut self,
        own: [(InternalStop, bool, bool); 2],
    ) -> [(stop::Outputs, fault::Outputs); 2] {
        let received = [self.sent[1], self.sent[0]];
        core::array::from_fn(|k| {
            let (demand, discrepancy, monitoring) = own[k];
            let before = self.stops[k].state();
            let fault = self.faults[k].step(&fault::Inputs {
                discrepancy,
                rx_fault: received[k].1,
                monitoring,
                cde_before: before.level.ends_in_standstill(),
                ab_before: before.internal >= InternalStop::B,
                ..Default::default()
            });
            let stop = self.stops[k].step(&stop::Inputs {
                demand,
                f_stop_b: fault.stop_b,
                rx_internal: received[k].0,
                ..Default::default()
            });
            self.sent[k] = (stop.internal, fault.fault != fault::FaultState::None);
            (stop, fault)
        })
    }
}

const QUIET: (InternalStop, bool, bool) = (InternalStop::None, false, true);

/// S840D-STOP-085: each channel starts its own timer when it enters the stop; both have the same time, the second one
/// later by the way of the request.
#[test]
fn the_timers_of_the_channels_run_apart_by_the_delay_between_them() {
    for demand in [
        InternalStop::E,
        InternalStop::D,
        InternalStop::C,
        InternalStop::B,
    ] {
        let mut pair = Pair::new(4, 0);
        let _ = pair.step([(demand, false, true), QUIET]);
        let mut ends = [None, None];
        for cycle in 1..8 {
            let out = pair.step([QUIET, QUIET]);
            for k in 0..2 {
                assert_eq!(out[k].0.internal, pair.stops[k].state().internal);
                let over = out[k].0.sbh_internal || out[k].0.cancel_pulses;
                if over && ends[k].is_none() {
                    ends[k] = Some(cycle);
                }
            }
        }
        // A STOP B that has become A in the first channel takes the other one along at once.
        assert_eq!(ends, [Some(4), Some(5)], "{demand:?}");
    }
}

/// S840D-STOP-067, reading A-06 F_PASS_B: with a function active in channel 2 only, its STOP F becomes STOP B; channel 1 has
/// a message and no bit 1, and gets the STOP B of the other one.
#[test]
fn a_one_sided_stop_f_brakes_both_but_shows_in_one() {
    let mut pair = Pair::new(4, 2);
    let idle = (InternalStop::None, false, false);
    let _ = pair.step([
        (InternalStop::None, true, false),
        (InternalStop::None, true, true),
    ]);
    for _ in 0..2 {
        let _ = pair.step([idle, QUIET]);
    }
    let [one, two] = pair.step([idle, QUIET]);
    assert_eq!(
        (one.1.fault, one.1.bit1),
        (fault::FaultState::Latched, false)
    );
    assert_eq!(
        (two.1.fault, two.1.bit1),
        (fault::FaultState::Expired, true)
    );
    assert!(one.0.internal == InternalStop::B && two.0.internal == InternalStop::B);
}

/// S840D-STOP-066: the delay of STOP F delays no monitor: what it demands meanwhile is effective in the same cycle.
#[test]
fn the_delay_of_stop_f_delays_no_monitor() {
    for demand in InternalStop::ALL {
        let mut pair = Pair::new(4, 9);
        let found = (InternalStop::None, true, true);
        let _ = pair.step([found, found]);
        let [one, _] = pair.step([(demand, false, true), QUIET]);
        assert_eq!(one.1.fault, fault::FaultState::Delay);
        assert_eq!(one.0.level, demand.level());
    }
}

/// S840D-STOP-054: `$A_STOPESI` shows a STOP E of any axis, in its braking and in the operating stop after it, and nothing
/// else.
#[test]
fn a_stop_e_of_any_axis_shows_in_the_channel() {
    for demand in InternalStop::ALL {
        let mut axes = [stops(2); 3];
        for _ in 0..4 {
            let levels: Vec<Level> = axes
                .iter_mut()
                .enumerate()
                .map(|(k, axis)| {
                    let demand = if k == 1 { demand } else { InternalStop::None };
                    axis.step(&stop::Inputs {
                        demand,
                        ..Default::default()
                    })
                    .level
                })
                .collect();
            assert_eq!(group::stop_e_active(&levels), demand == InternalStop::E);
        }
    }
}

/// S840D-ARCH-508: two axes each just at its limit move on the path at 1.4 times of it; no monitor says anything.
#[test]
fn the_speed_of_a_path_is_not_monitored() {
    let config = speed::Config::new(0, [0; 4], None).expect("plausible");
    let mut axes = [speed::Monitor::new(config); 2];
    let inputs = |speed| speed::Inputs {
        monitored: Monitored::Speed,
        speed: Speed(speed),
        limit: Speed(100),
        ..Default::default()
    };
    for axis in &mut axes {
        assert!(!axis.step(&inputs(100)).violated);
    }
    assert!(axes[0].step(&inputs(101)).violated);
    assert!(!axes[1].step(&inputs(100)).violated);
}

/// S840D-SG-013: each channel follows its own signals at once, so that they may monitor different limits for a while.
#[test]
fn channels_may_monitor_different_limits_for_a_while() {
    let limits = [100, 200, 300, 400].map(Speed);
    let config = selection::Config::new(true, cycles(0), limits).expect("plausible");
    let mut channels = [selection::Monitor::new(config); 2];
    let mut step = |k: usize, sg_select| {
        let inputs = selection::Inputs {
            sge_sbh: true,
            sg_select,
            ..Default::default()
        };
        channels[k].step(&inputs).limit
    };
    assert_eq!(
        (step(0, Stage::Sg3), step(1, Stage::Sg3)),
        (Speed(300), Speed(300))
    );
    assert_eq!(
        (step(0, Stage::Sg2), step(1, Stage::Sg3)),
        (Speed(200), Speed(300))
    );
    assert_eq!(
        (step(0, Stage::Sg2), step(1, Stage::Sg2)),
        (Speed(200), Speed(200))
    );
}

/// S840D-SN-004: a cam has signals as outputs and nothing that could ask for a stop. The pattern names every output, so
/// that a new one has to be judged here.
#[test]
fn a_cam_raises_no_stop() {
    let config = cam::Config::new(
        true,
        Position(100),
        Distance(10),
        false,
        ModuloRange::LINEAR,
        Distance(10),
    )
    .expect("plausible");
    let mut monitor = cam::Monitor::new(config);
    for (position, beyond) in [(0, false), (100, false), (101, true), (-5, false)] {
        let inputs = cam::Inputs {
            position: Position(position),
            ..Default::default()
        };
        let cam::Outputs { own, sga } = monitor.step(&inputs);
        assert_eq!((own, sga), (beyond, beyond), "{position}");
    }
}

/// S840D-KDV-513: a difference between the channels and an error of the safe logic in one cycle: both are kept, neither
/// hides the other, also when the first is acknowledged.
#[test]
fn the_comparison_of_the_safe_logic_is_another_one() {
    let config = external::Config::new(true, false, false).expect("plausible");
    let mut logic = external::Monitor::new(config);
    let mut pair = Pair::new(4, 3);
    let spl = logic.step(&external::Inputs {
        spl_started: true,
        spl_error: true,
        ..Default::default()
    });
    let found = (InternalStop::None, true, true);
    let [one, two] = pair.step([found, found]);
    assert!(spl.spl_stop && one.1.alarm && two.1.alarm);
    let quiet = logic.step(&external::Inputs {
        reset: true,
        sge_a: true,
        sge_c: true,
        sge_d: true,
        sge_e: true,
        ..Default::default()
    });
    assert!(!quiet.spl_stop);
    let [one, two] = pair.step([QUIET, QUIET]);
    assert!(one.1.interlock && two.1.interlock);
}

/// S840D-TEST-014: what a channel tells the other one has no test stop in it, so that a test in one channel, run or failed,
/// is no test in the other; only the STOP A of a failed test is passed on.
#[test]
fn a_test_stop_stays_in_its_channel() {
    let mut channels = [stops(2); 2];
    for _ in 0..3 {
        let sent = channels[0].state();
        let tested = channels[0].step(&stop::Inputs {
            test: true,
            ..Default::default()
        });
        let other = channels[1].step(&stop::Inputs {
            rx_internal: sent.internal,
            rx_external: sent.external,
            ..Default::default()
        });
        assert_eq!((tested.level, other.level), (Level::Test, Level::None));
        assert!(tested.cancel_pulses && !other.cancel_pulses);
    }
    assert_eq!(InternalStop::from_level(Level::Test), None);
    assert_eq!(ExternalStop::from_level(Level::Test), None);
}
