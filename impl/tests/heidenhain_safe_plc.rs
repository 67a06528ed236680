//! The logic of the safe PLC, block by block: what the sample sequences do not show.

use stillpoint_monitors::heidenhain::jog_increment::Jog;
use stillpoint_monitors::heidenhain::key_filter::Keys;
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Left, Phase, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{
    axes_logic, axis_count, jog_increment, judge, key_filter, magazine_logic, safe_plc, speed,
    spindle_logic, stop,
};
use stillpoint_monitors::kernel::{Cycles, Speed};

/// HFS-SLI-001, HFS-SLI-002, HFS-SLI-003: one press is one increment; the release before its end stops by SS2. What is watched
/// are the conditions: how far the axis goes is no input at all.
#[test]
fn increment_stops_with_its_key() {
    let mut jog =
        jog_increment::Monitor::new(jog_increment::Config::new(false).expect("plausible"));
    let mut step = |key, done| jog.step(&jog_increment::Inputs { key, done });
    assert!(!step(true, true).feed, "held when the control came up");
    step(false, true);
    assert!(step(true, true).feed);
    assert!(step(true, false).feed);
    assert_eq!(step(true, true).stop, Stop::None, "it has ended by itself");
    assert!(!step(true, true).feed, "the key has to be released");
    step(false, true);
    assert!(step(true, false).feed);
    let lost = step(false, false);
    assert_eq!((lost.feed, lost.stop), (false, Stop::Ss2));
    assert_eq!(step(false, false).stop, Stop::None, "one cycle");
}

/// HFS-SEQ-005: the other variant: the feed stays after the release until the group is in SOS, also where the motion begins
/// after it only.
#[test]
fn increment_runs_to_its_end() {
    let mut jog = jog_increment::Monitor::new(jog_increment::Config::new(true).expect("plausible"));
    let mut step = |key, state| {
        let done = state == GroupState::Sos;
        jog.step(&jog_increment::Inputs { key, done })
    };
    step(false, GroupState::Sos);
    assert!(step(true, GroupState::Sos).feed);
    for _ in 0..5 {
        let out = step(false, GroupState::Sls2);
        assert!(out.feed && out.stop == Stop::None);
    }
    assert!(!step(false, GroupState::Sos).feed);
    assert_eq!(jog.state().jog, Jog::Ready);
}

/// HFS-GRP-002, HFS-GRP-006: three groups; the door of the working space concerns axes and spindle, that of the magazine the
/// magazine.
#[test]
fn two_doors_three_groups() {
    let config = safe_plc::Config::new(Cycles::new(48), true, false).expect("plausible");
    for (door_open, t_open) in [(false, false), (false, true), (true, false), (true, true)] {
        let inputs = safe_plc::Inputs {
            keys: key_filter::Inputs {
                door_open,
                t_open,
                ..Default::default()
            },
            som: Som::Som3,
            ..Default::default()
        };
        let (_, out) = safe_plc::next(safe_plc::State::INITIAL, &config, &inputs);
        let space = if door_open {
            GroupState::Sls3
        } else {
            GroupState::Auto
        };
        let magazine = if t_open {
            GroupState::Sls2
        } else {
            GroupState::Auto
        };
        assert_eq!((out.axes.request, out.spindle.request), (space, space));
        assert_eq!(out.magazine.request, magazine);
    }
}

/// HFS-MAG-006/a/b/c, HFS-MAG-005: the handwheel has no effect on the magazine, whatever the doors and the operating mode; behind its
/// closed door it takes part in a reference run. The stops know no kind of group: an SS1 brakes it like the axes.
#[test]
fn magazine_and_handwheel() {
    let config = safe_plc::Config::new(Cycles::new(48), true, false).expect("plausible");
    for unit in Unit::ALL {
        for (door_open, t_open) in [(false, false), (false, true), (true, true)] {
            let calm = safe_plc::Inputs {
                keys: key_filter::Inputs {
                    door_open,
                    t_open,
                    unit,
                    ..Default::default()
                },
                gen_safe: true,
                ..Default::default()
            };
            let mut busy = calm;
            busy.keys.wheel = Keys {
                permissive: true,
                axes: u8::MAX,
                nc_start: true,
                jog: true,
                spindle_start: true,
            };
            let run = |inputs| safe_plc::next(safe_plc::State::INITIAL, &config, inputs);
            let ((calm_state, calm), (busy_state, busy)) = (run(&calm), run(&busy));
            assert_eq!(calm.magazine, busy.magazine);
            assert_eq!(calm_state.magazine, busy_state.magazine);
            assert_eq!(calm.magazine.feed == axes_logic::ALL_AXES, !t_open);
        }
    }
    let t = Cycles::new(5);
    let config = stop::Config::new(false, t, t, t).expect("plausible");
    let mut braked = stop::Monitor::new(config);
    let out = braked.step(&stop::Inputs {
        demand: Stop::Ss1,
        ..Default::default()
    });
    assert_eq!((out.level, out.phase), (Stop::Ss1, Phase::EmergencyBrake));
}

/// HFS-MAG-001, HFS-MAG-004, HFS-FILT-004, HFS-API-012, HFS-API-017: two keys at once move nothing behind the open door; behind the
/// closed one the keys need no permissive.
#[test]
fn magazine_keys() {
    let step = |t_open, keys, permissive| {
        magazine_logic::Monitor::new(magazine_logic::Config).step(&magazine_logic::Inputs {
            t_open,
            keys,
            permissive,
            gen_safe: true,
            ..Default::default()
        })
    };
    assert!(step(true, 0b01, true).activate);
    assert!(!step(true, 0b11, true).activate && step(true, 0b11, true).feed == 0);
    assert!(!step(true, 0b01, false).activate);
    assert_eq!(step(false, 0b01, false).feed, axes_logic::ALL_AXES);
}

/// HFS-MODE-004/a, HFS-MODE-004/b, HFS-MODE-004/c: set-up in SOM_2 with the door open: the limit of the mode, one axis at a time.
#[test]
fn set_up_limits_speed_and_number_of_axes() {
    let limits = speed::Limits {
        som_2: Speed(1_000),
        som_3: Speed(2_000),
        ..speed::Limits::default()
    };
    let at = |speed| {
        let config = speed::Config::new(limits, false).expect("fits");
        let inputs = speed::Inputs {
            state: axes_logic::limited(Som::Som2),
            left: Left::NONE,
            speed: Speed(speed),
        };
        speed::Monitor::new(config).step(&inputs).demand
    };
    assert_eq!((at(1_050), at(1_051)), (Stop::None, Stop::Ss1));
    let moving = |moving| {
        let inputs = axis_count::Inputs {
            state: axes_logic::limited(Som::Som2),
            unit: Unit::Panel,
            moving,
            ungrouped: 0,
        };
        let mut monitor = axis_count::Monitor::new(axis_count::Config);
        monitor.step(&inputs).demand
    };
    assert_eq!((moving(1), moving(2)), (Stop::None, Stop::Ss2));
}

/// HFS-MODE-004/d, HFS-MODE-004/e, HFS-MODE-004/f, HFS-MODE-004/g, HFS-MODE-004/h: and each motion by its key: axis keys alone, NC start with the permissive of the panel, the handwheel with its own,
/// the spindle by jog or start with the permissive, which keeps it turning.
#[test]
fn set_up_moves_by_key_and_permissive() {
    let axes = |keys, unit, start, panel, wheel| {
        let config = axes_logic::Config::new(Cycles::new(48), true, false).expect("plausible");
        let mut monitor = axes_logic::Monitor::new(config);
        let released = axes_logic::Inputs {
            door_open: true,
            som: Som::Som2,
            unit,
            gen_safe: true,
            ..Default::default()
        };
        monitor.step(&released);
        let pressed = axes_logic::Inputs {
            keys,
            nc_start: start,
            start_held: start,
            key_held: keys != 0 || start || wheel,
            panel,
            wheel,
            ..released
        };
        monitor.step(&pressed).activate
    };
    assert!(axes(1, Unit::Panel, false, false, false));
    assert!(axes(0, Unit::Panel, true, true, false));
    assert!(!axes(0, Unit::Panel, true, false, false));
    assert!(!axes(0, Unit::Panel, false, true, false));
    assert!(axes(0, Unit::Handwheel, false, false, true));
    assert!(!axes(1, Unit::Handwheel, true, true, false));
    let spindle = |jog, start, panel| {
        let mut monitor = spindle_logic::Monitor::new(spindle_logic::Config);
        let released = spindle_logic::Inputs {
            door_open: true,
            som: Som::Som2,
            gen_safe: true,
            ..Default::default()
        };
        monitor.step(&released);
        let pressed = spindle_logic::Inputs {
            jog,
            jog_held: jog,
            spindle_start: start,
            start_held: start,
            key_held: jog || start,
            panel,
            ..released
        };
        monitor.step(&pressed).activate
    };
    assert!(spindle(true, false, true) && spindle(false, true, true));
    assert!(!spindle(true, false, false) && !spindle(false, true, false));
    assert!(!spindle(false, false, true));
    let turning = |permissive| {
        let config = judge::Config::new(Kind::Spindle, true).expect("plausible");
        let inputs = judge::Inputs {
            request: GroupState::Sls2,
            state: GroupState::Sls2,
            moving: true,
            permissive,
            gen_safe: true,
            ..Default::default()
        };
        judge::Monitor::new(config).step(&inputs).demand
    };
    assert_eq!((turning(true), turning(false)), (Stop::None, Stop::Ss1D));
}

/// HFS-KSW-003/c, HFS-API-023: a change of the mode stops the magazine behind its open door although permissive and key are held,
/// and behind the closed one nothing.
#[test]
fn a_change_of_the_mode_stops_the_magazine() {
    let step = |t_open, som_changed| {
        magazine_logic::Monitor::new(magazine_logic::Config)
            .step(&magazine_logic::Inputs {
                t_open,
                keys: 1,
                permissive: true,
                som_changed,
                gen_safe: true,
                ..Default::default()
            })
            .stop
    };
    assert_eq!(
        (step(true, false), step(true, true)),
        (Stop::None, Stop::Ss2)
    );
    assert_eq!(step(false, true), Stop::None);
}

/// HFS-API-024: the simple logic for manual operation: without permissive the group is stopped all the time.
#[test]
fn manual_operation_with_permissive() {
    let config = axes_logic::Config::new(Cycles::new(48), true, true).expect("plausible");
    let step = |panel| {
        axes_logic::Monitor::new(config).step(&axes_logic::Inputs {
            door_open: true,
            som: Som::Som2,
            keys: 1,
            key_held: true,
            panel,
            gen_safe: true,
            ..Default::default()
        })
    };
    assert_eq!((step(false).feed, step(false).stop), (u8::MAX, Stop::Ss2));
    assert_eq!((step(true).feed, step(true).stop), (u8::MAX, Stop::None));
}

/// HFS-MODE-001, HFS-MODE-003, HFS-MODE-010, HFS-API-003: the keylock counts behind the open door only, SOM_1 permits nothing
/// there, and no program starts the spindle.
#[test]
fn spindle_by_mode() {
    for (som, open) in Som::ALL.into_iter().zip([
        GroupState::Sos,
        GroupState::Sls2,
        GroupState::Sls3,
        GroupState::Sls4,
    ]) {
        let step = |door_open| {
            spindle_logic::Monitor::new(spindle_logic::Config).step(&spindle_logic::Inputs {
                door_open,
                som,
                panel: true,
                key_held: true,
                gen_safe: true,
                ..Default::default()
            })
        };
        assert_eq!(
            (step(true).request, step(false).request),
            (open, GroupState::Auto)
        );
        assert!(
            !step(true).activate,
            "NC start and permissive without a key of the spindle"
        );
    }
}

/// HFS-KSW-003/a/b (6.1.6; AMB-74): every change of the mode with the door open is SS2 for axes and spindle, that to SOM_1 too.
#[test]
fn every_change_of_the_mode_stops_axes_and_spindle() {
    for (som, door_open) in Som::ALL.into_iter().flat_map(|s| [(s, false), (s, true)]) {
        let spindle =
            spindle_logic::Monitor::new(spindle_logic::Config).step(&spindle_logic::Inputs {
                door_open,
                som,
                som_changed: true,
                ..Default::default()
            });
        let config = axes_logic::Config::new(Cycles::new(48), true, false).expect("plausible");
        let axes = axes_logic::Monitor::new(config).step(&axes_logic::Inputs {
            door_open,
            som,
            som_changed: true,
            ..Default::default()
        });
        let asked = if door_open { Stop::Ss2 } else { Stop::None };
        assert_eq!((axes.stop, spindle.stop), (asked, asked), "{som:?}");
    }
}

/// HFS-DOOR-003: with an overdue self-test no group is activated behind an open door.
#[test]
fn overdue_self_test() {
    let config = safe_plc::Config::new(Cycles::new(48), true, false).expect("plausible");
    let mut inputs = safe_plc::Inputs {
        som: Som::Som2,
        ..Default::default()
    };
    (
        inputs.keys.door_open,
        inputs.keys.panel.permissive,
        inputs.keys.panel.axes,
    ) = (true, true, 1);
    inputs.keys.panel.jog = true;
    for gen_safe in [false, true] {
        inputs.gen_safe = gen_safe;
        let (_, out) = safe_plc::next(safe_plc::State::INITIAL, &config, &inputs);
        assert_eq!(
            (out.axes.activate, out.spindle.activate),
            (gen_safe, gen_safe)
        );
    }
}

/// HFS-FILT-001, HFS-FILT-002, HFS-FILT-003, HFS-FILT-006, HFS-UNIT-001, HFS-PB-004, HFS-SPLC-008, HFS-API-030, HFS-MKEY-001: the table of active
/// units with every key pressed on both.
#[test]
fn active_units_as_printed() {
    let all = Keys {
        permissive: true,
        axes: 1,
        nc_start: true,
        jog: true,
        spindle_start: true,
    };
    for unit in Unit::ALL {
        for (door_open, t_open) in [(false, false), (false, true), (true, false), (true, true)] {
            let inputs = key_filter::Inputs {
                door_open,
                t_open,
                unit,
                panel: all,
                wheel: all,
                stop: true,
                ..Default::default()
            };
            let out = key_filter::Monitor::new(key_filter::Config).step(&inputs);
            let wheel = unit == Unit::Handwheel;
            let shown = |active| if active { all } else { Keys::NONE };
            assert_eq!(
                out.panel,
                shown(!door_open || (!wheel && !t_open)),
                "{inputs:?}"
            );
            assert_eq!(
                out.wheel,
                shown(!door_open || (wheel && !t_open)),
                "{inputs:?}"
            );
            assert!(out.stop && out.machine_keys, "{inputs:?}");
        }
    }
    let direction = key_filter::Inputs {
        wheel: Keys {
            axes: 1,
            ..Keys::NONE
        },
        ..Default::default()
    };
    assert!(
        !key_filter::Monitor::new(key_filter::Config)
            .step(&direction)
            .machine_keys
    );
}

/// HFS-SPLC-006: what comes from the PLC alone (keys of the handwheel, operating mode, requests) moves nothing behind
/// an open door: a safe input has to join it.
#[test]
fn imports_of_the_plc_move_nothing() {
    let config = safe_plc::Config::new(Cycles::new(48), true, false).expect("plausible");
    for unit in Unit::ALL {
        let mut inputs = safe_plc::Inputs {
            som: Som::Som2,
            restricted: true,
            gen_safe: true,
            ..Default::default()
        };
        inputs.keys.door_open = true;
        inputs.keys.unit = unit;
        let (state, _) = safe_plc::next(safe_plc::State::INITIAL, &config, &inputs);
        inputs.keys.wheel = Keys {
            permissive: false,
            axes: u8::MAX,
            nc_start: true,
            jog: true,
            spindle_start: true,
        };
        let (_, out) = safe_plc::next(state, &config, &inputs);
        assert!(
            !out.axes.activate && !out.spindle.activate && out.axes.feed == 0,
            "{unit:?}"
        );
    }
}

/// HFS-API-004/b: auxiliary axes in the normal working space: the keylock decides, and their motion key needs the permissive.
#[test]
fn auxiliary_axes_in_the_working_space() {
    let step = |door_open, som, panel| {
        spindle_logic::Monitor::new(spindle_logic::Config).step(&spindle_logic::Inputs {
            door_open,
            som,
            panel,
            jog: true,
            jog_held: true,
            gen_safe: true,
            ..Default::default()
        })
    };
    assert_eq!(step(false, Som::Som1, false).request, GroupState::Auto);
    assert_eq!(step(true, Som::Som1, true).request, GroupState::Sos);
    assert!(!step(true, Som::Som1, true).activate);
    assert_eq!(step(true, Som::Som3, true).request, GroupState::Sls3);
    assert!(step(true, Som::Som3, true).activate && !step(true, Som::Som3, false).activate);
}

/// HFS-REF-004, HFS-REF-005, HFS-REF-015: a reference run behind the open door by NC start with the permissive, never by a
/// direction key; behind the closed one by either.
#[test]
fn reference_run() {
    let config = axes_logic::Config::new(Cycles::new(48), true, false).expect("plausible");
    let run = |door_open, keys, nc_start| {
        let calm = axes_logic::Inputs {
            door_open,
            som: Som::Som2,
            unit: Unit::Reference,
            panel: true,
            gen_safe: true,
            ..Default::default()
        };
        let mut plc = axes_logic::Monitor::new(config);
        plc.step(&calm);
        let out = plc.step(&axes_logic::Inputs {
            keys,
            nc_start,
            start_held: nc_start,
            key_held: true,
            ..calm
        });
        (out.activate, out.feed)
    };
    assert_eq!(run(true, 0b11, false), (false, 0));
    assert_eq!(run(true, 0, true), (true, axes_logic::ALL_AXES));
    assert_eq!(run(false, 0b11, false), (true, axes_logic::ALL_AXES));
    assert_eq!(run(false, 0, true), (true, axes_logic::ALL_AXES));
}
