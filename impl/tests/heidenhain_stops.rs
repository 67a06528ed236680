//! Stop reactions of HEIDENHAIN Functional Safety as scenarios: what the manual describes, cycle by cycle.

use stillpoint_monitors::heidenhain::stop;
use stillpoint_monitors::heidenhain::types::{Phase, Stop};
use stillpoint_monitors::kernel::{ConfigError, Cycles};

fn monitor(cc: bool) -> stop::Monitor {
    let [t_ss1, t_ss2, t_brake] = [5, 3, 2].map(Cycles::new);
    stop::Monitor::new(stop::Config::new(cc, t_ss1, t_ss2, t_brake).expect("plausible"))
}

/// A group that moves, and whose predecessors of SMP610 stand.
fn moving(demand: Stop) -> stop::Inputs {
    stop::Inputs {
        demand,
        listed_still: true,
        ..Default::default()
    }
}

fn standing() -> stop::Inputs {
    stop::Inputs {
        still: true,
        ..moving(Stop::None)
    }
}

/// HFS-SS1-006: ramp, standstill, brakes, and after their overlap torque off.
#[test]
fn channel_b_closes_the_brakes_before_it_takes_the_torque() {
    let mut b = monitor(true);
    assert!(b.step(&moving(Stop::Ss1)).emergency_ramp);
    assert!(b.step(&moving(Stop::None)).emergency_ramp);
    let first = b.step(&standing());
    assert!(first.brake_closed && !first.torque_off);
    assert!(!b.step(&standing()).torque_off);
    let off = b.step(&standing());
    assert!(off.torque_off && off.brake_closed && !off.needs_switch);
}

/// HFS-SS1-007: channel A follows the report of channel B.
#[test]
fn channel_a_follows_channel_b() {
    let mut a = monitor(false);
    a.step(&moving(Stop::Ss1));
    assert!(
        !a.step(&standing()).torque_off,
        "standstill alone is not enough"
    );
    let told = stop::Inputs {
        peer_off: true,
        ..standing()
    };
    let out = a.step(&told);
    assert!(out.torque_off && out.level == Stop::Ss1);
}

/// HFS-SS1-005: no standstill in time is SS0, in each channel alone.
#[test]
fn an_ss1_that_takes_too_long_becomes_ss0() {
    for cc in [false, true] {
        let mut monitor = monitor(cc);
        monitor.step(&moving(Stop::Ss1));
        for _ in 0..4 {
            assert!(monitor.step(&moving(Stop::None)).emergency_ramp);
        }
        let out = monitor.step(&moving(Stop::None));
        assert!(out.torque_off && out.needs_switch && out.level == Stop::Ss0);
    }
}

/// HFS-STOP-010: an SS1F during the ramp changes neither ramp nor timer.
#[test]
fn ss1f_takes_over_a_running_ramp() {
    let mut b = monitor(true);
    b.step(&moving(Stop::Ss1));
    b.step(&moving(Stop::None));
    let before = b.state().timer;
    let out = b.step(&moving(Stop::Ss1F));
    assert_eq!(b.state().timer, before.tick());
    assert!(out.needs_switch && out.emergency_ramp);
}

/// HFS-SS2-001, HFS-SS2-004: standstill in time ends the SS2, too long a way makes it an SS1 of the whole machine.
#[test]
fn an_ss2_ends_at_standstill_or_becomes_an_ss1() {
    let mut in_time = monitor(true);
    assert!(in_time.step(&moving(Stop::Ss2)).on_contour);
    let out = in_time.step(&standing());
    assert!(out.ss2_ended && out.level == Stop::None && !out.torque_off);
    let mut late = monitor(true);
    late.step(&moving(Stop::Ss2));
    late.step(&moving(Stop::None));
    late.step(&moving(Stop::None));
    let out = late.step(&moving(Stop::None));
    assert!(out.emergency_ramp && out.wide && out.level == Stop::Ss1);
}

/// HFS-SS1D-004: the spindle waits for the axes and goes on with the SS2 it had begun.
#[test]
fn an_ss1d_waits_for_the_axes() {
    let mut spindle = monitor(true);
    spindle.step(&moving(Stop::Ss2));
    let waits = stop::Inputs {
        listed_still: false,
        ..moving(Stop::Ss1D)
    };
    let out = spindle.step(&waits);
    assert_eq!(out.phase, Phase::Ss1DWait);
    assert!(out.on_contour && out.brake_listed);
    let out = spindle.step(&moving(Stop::Ss1D));
    assert!(out.emergency_ramp && !out.brake_listed);
    let mut last = out;
    for _ in 0..3 {
        last = spindle.step(&standing());
    }
    assert!(last.torque_off && last.keeps_enable);
}

/// HFS-ACK-005, HFS-ACK-006: the restart is an edge after torque off, with the cause gone; after SS1F only the main switch.
#[test]
fn the_restart_needs_the_operator() {
    let mut a = monitor(false);
    let told = stop::Inputs {
        peer_off: true,
        ..moving(Stop::Ss1)
    };
    a.step(&told);
    assert!(a.step(&told).torque_off);
    let restart = stop::Inputs {
        restart: true,
        ..standing()
    };
    let pressed_with_cause = stop::Inputs {
        demand: Stop::Ss1,
        ..restart
    };
    assert!(!a.step(&pressed_with_cause).restarted);
    assert!(a.step(&restart).restarted);
    a.step(&moving(Stop::Ss0));
    assert!(!a.step(&restart).restarted);
    let main_switch = stop::Inputs {
        main_switch: true,
        ..standing()
    };
    assert!(!a.step(&main_switch).torque_off);
}

/// SMP525 to SMP528 are at most 10 s.
#[test]
fn times_beyond_the_manual_are_refused() {
    let long = Cycles::new(stop::Config::LONGEST.count() + 1);
    let refused = stop::Config::new(true, long, Cycles::ZERO, Cycles::ZERO);
    assert_eq!(refused, Err(ConfigError::DelayTooLong));
}
