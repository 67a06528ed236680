//! Monitoring states of HEIDENHAIN Functional Safety as scenarios: doors, modes, keys and permissives.

use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Left, Phase, Stop, Unit};
use stillpoint_monitors::heidenhain::{axis_release, group, judge, speed, startup};
use stillpoint_monitors::kernel::{Cycles, Speed};

fn at(kind: Kind, state: GroupState) -> group::Monitor {
    let config = group::Config::new(kind).expect("plausible");
    let left = Left::NONE;
    let state = group::State { state, left };
    group::Monitor::resume(config, state).expect("consistent")
}

fn asks(request: GroupState) -> group::Inputs {
    group::Inputs {
        request,
        gen_safe: true,
        ..Default::default()
    }
}

/// HFS-AXG-003, HFS-AXG-004, HFS-AXG-005: switch on, close the door, press a key.
#[test]
fn closing_the_door_starts_nothing_the_key_does() {
    let mut axes = at(Kind::NcAxes, GroupState::Sto);
    let on = group::Inputs {
        switch_on: true,
        ..asks(GroupState::Auto)
    };
    assert_eq!(axes.step(&on).state, GroupState::Sos);
    assert_eq!(axes.step(&asks(GroupState::Auto)).state, GroupState::Sos);
    let key = group::Inputs {
        activate: true,
        ..asks(GroupState::Auto)
    };
    let out = axes.step(&key);
    assert!(out.may_move && out.state == GroupState::Auto);
    // A spindle is switched on without torque.
    assert_eq!(
        at(Kind::Spindle, GroupState::Sto).step(&on).state,
        GroupState::StoO
    );
}

/// HFS-AXG-006: the door is opened in SOM_2 while the axes move.
#[test]
fn opening_the_door_limits_the_speed_at_once() {
    let mut axes = at(Kind::NcAxes, GroupState::Auto);
    let moving = group::Inputs {
        moving: true,
        ..asks(GroupState::Sls2)
    };
    assert_eq!(axes.step(&moving).state, GroupState::Sls2);
}

/// HFS-AXG-018: from SOM_3 to SOM_2 and back in motion, the lower limit stays until standstill.
#[test]
fn old_limits_apply_until_standstill() {
    let mut axes = at(Kind::NcAxes, GroupState::Sls3);
    let moving = |request| group::Inputs {
        moving: true,
        ..asks(request)
    };
    assert!(axes.step(&moving(GroupState::Sls2)).left.sls_3);
    assert!(axes.step(&moving(GroupState::Sls3)).left.sls_2);
    assert!(axes.step(&asks(GroupState::Sls3)).left.is_none());
}

/// HFS-AXG-018: the door is closed and opened in SOM_4 without a key between, while the axes move: the limit of SOM_2 still
/// counts, whatever the one of SOM_4 is, until the axes stand.
#[test]
fn the_limit_of_som_2_counts_in_som_4_until_standstill() {
    let limits = speed::Limits {
        som_2: Speed(20),
        som_3: Speed(40),
        som_4: Speed(30),
        restricted: Speed(10),
    };
    let config = speed::Config::new(limits, true).expect("plausible");
    let stop_at = |out: group::Outputs, speed| {
        let inputs = speed::Inputs {
            state: out.state,
            left: out.left,
            speed: Speed(speed),
        };
        speed::Monitor::new(config).step(&inputs).demand
    };
    let mut axes = at(Kind::NcAxes, GroupState::Sls2);
    let moving = |request| group::Inputs {
        moving: true,
        ..asks(request)
    };
    assert_eq!(axes.step(&moving(GroupState::Auto)).state, GroupState::Sls2);
    let out = axes.step(&moving(GroupState::Sls4));
    assert_eq!(out.state, GroupState::Sls4);
    assert_eq!(stop_at(out, 25), Stop::Ss1);
    assert_eq!(stop_at(out, 21), Stop::None);
    axes.step(&moving(GroupState::Auto));
    let out = axes.step(&moving(GroupState::Sls3));
    assert_eq!(stop_at(out, 25), Stop::Ss1, "through three modes");
    let out = axes.step(&asks(GroupState::Sls3));
    assert_eq!(stop_at(out, 41), Stop::None);
}

/// HFS-SS1D-003: an SS1D ends in STO_O, which an activation leaves; it never lifts an STO.
#[test]
fn a_soft_end_is_sto_o() {
    let off = group::Inputs {
        phase: Phase::TorqueOff,
        soft: true,
        ..asks(GroupState::Sls2)
    };
    assert_eq!(
        at(Kind::Spindle, GroupState::Sls2).step(&off).state,
        GroupState::StoO
    );
    assert_eq!(
        at(Kind::Spindle, GroupState::Sto).step(&off).state,
        GroupState::Sto
    );
}

fn judged(kind: Kind, inputs: judge::Inputs) -> judge::Outputs {
    let config = judge::Config::new(kind, true).expect("plausible");
    judge::Monitor::new(config).step(&inputs)
}

fn running(state: GroupState) -> judge::Inputs {
    judge::Inputs {
        request: state,
        state,
        moving: true,
        gen_safe: true,
        ..Default::default()
    }
}

/// HFS-SOS-004, HFS-FAULT-014: the door is opened in SOM_1 during motion.
#[test]
fn the_open_door_in_som_1_stops_the_machine() {
    let inputs = judge::Inputs {
        request: GroupState::Sos,
        ..running(GroupState::Auto)
    };
    assert_eq!(judged(Kind::NcAxes, inputs).demand, Stop::Ss1);
}

/// HFS-FAULT-007: SOM_4 without SOM_1 between.
#[test]
fn a_direct_change_to_som_4_is_fatal() {
    let config = judge::Config::new(Kind::NcAxes, true).expect("plausible");
    let mut monitor = judge::Monitor::new(config);
    assert_eq!(monitor.step(&running(GroupState::Sls3)).demand, Stop::None);
    assert_eq!(monitor.step(&running(GroupState::Sls4)).demand, Stop::Ss1F);
    let mut monitor = judge::Monitor::new(config);
    monitor.step(&running(GroupState::Sls3));
    monitor.step(&judge::Inputs {
        moving: false,
        ..running(GroupState::Sos)
    });
    assert_eq!(monitor.step(&running(GroupState::Sls4)).demand, Stop::None);
}

/// HFS-AXG-014, HFS-MODE-011, HFS-MODE-024: where the spindle needs its permissive.
#[test]
fn a_spindle_needs_its_permissive() {
    let by = |unit, request, state| {
        judged(
            Kind::Spindle,
            judge::Inputs {
                unit,
                request,
                ..running(state)
            },
        )
    };
    use GroupState::{Auto, Sls2, Sls4, SlsS};
    for (unit, request, state, stops) in [
        (Unit::Panel, Sls2, Sls2, true),
        (Unit::Panel, Sls4, Sls4, false),
        (Unit::Panel, SlsS, SlsS, false),
        (Unit::Panel, Sls4, Auto, true),
    ] {
        let out = by(unit, request, state);
        assert_eq!(out.asks_ss1d, stops, "{request:?} in {state:?}");
        assert_eq!(out.stops_axes, stops);
    }
    assert!(by(Unit::Handwheel, Sls4, Sls4).asks_ss1d);
}

/// HFS-USTART-001, HFS-USTART-003: 3 s of standstill, and the permissive.
#[test]
fn a_group_that_stands_for_three_seconds_is_stopped() {
    let mut protection = startup::Monitor::new(startup::Config::STANDARD);
    let stands = startup::Inputs {
        limited: true,
        unit: Unit::Program,
        ..Default::default()
    };
    for cycle in 0..999 {
        assert!(!protection.step(&stands).idle, "cycle {cycle}");
    }
    let held = startup::Inputs {
        permissive: true,
        ..stands
    };
    assert!(!protection.step(&held).idle);
    assert!(protection.step(&stands).idle);
}

/// HFS-AXG-009: one axis-direction key of two is released.
#[test]
fn an_axis_without_enable_brakes_by_itself() {
    let config = axis_release::Config::new(Cycles::new(2)).expect("plausible");
    let mut axis = axis_release::Monitor::new(config);
    let jog = axis_release::Inputs {
        group_released: true,
        feed: true,
        moving: true,
    };
    let released = axis_release::Inputs { feed: false, ..jog };
    axis.step(&jog);
    assert_eq!(axis.step(&released).mode, axis_release::Mode::Ss2);
    assert!(!axis.step(&released).asks_ss1);
    assert!(axis.step(&jog).asks_ss1, "the enable does not break it off");
}
