//! Runs of the monitors of position and speed of HEIDENHAIN Functional Safety, with the values of the manual.

use stillpoint_monitors::heidenhain::types::{GroupState, Left, Stop};
use stillpoint_monitors::heidenhain::{
    comparison, deceleration, operating_stop, parameters, position_limit, revolutions, speed,
    stop_path,
};
use stillpoint_monitors::kernel::{ConfigError, Cycles, Distance, Percent, Position, Speed};

fn limits() -> speed::Limits {
    speed::Limits {
        som_2: parameters::axis_limit(2_000, 2_000).expect("in the range"),
        som_3: parameters::axis_limit(5_000, 5_000).expect("in the range"),
        som_4: parameters::axis_limit(5_000, 5_000).expect("in the range"),
        restricted: parameters::RESTRICTED_SPEED,
    }
}

#[test]
fn som_2_stops_an_axis_above_2100_mm_per_minute() {
    let config = speed::Config::new(limits(), false).expect("fits");
    let mut monitor = speed::Monitor::new(config);
    let at = |per_minute: u32| speed::Inputs {
        state: GroupState::Sls2,
        left: Left::NONE,
        speed: Speed(per_minute / 2),
    };
    assert_eq!(monitor.step(&at(2_100)).demand, Stop::None);
    assert_eq!(monitor.step(&at(2_102)).demand, Stop::Ss1);
    let auto = speed::Inputs {
        state: GroupState::Auto,
        ..at(30_000)
    };
    assert_eq!(monitor.step(&auto).demand, Stop::None);
}

#[test]
fn a_limit_that_is_not_set_stops_by_channel_b_at_rest() {
    for cc in [false, true] {
        let config = speed::Config::new(speed::Limits::default(), cc).expect("fits");
        let out = speed::Monitor::new(config).step(&speed::Inputs {
            state: GroupState::Sls3,
            ..speed::Inputs::default()
        });
        assert_eq!(out.not_set, cc);
        assert_eq!(out.demand == Stop::Ss1, cc);
    }
}

#[test]
fn a_standing_axis_that_creeps_half_a_millimetre_loses_its_torque() {
    let path = parameters::standstill_path(500).expect("the default of SMP545");
    let config = operating_stop::Config::new(path, parameters::AXIS_STILL).expect("not 0");
    let mut monitor = operating_stop::Monitor::new(config);
    let at = |increments: i32, speed: u32| operating_stop::Inputs {
        watched: true,
        self_test: false,
        position: Position(100_000 + increments),
        speed: Speed(speed),
    };
    assert_eq!(monitor.step(&at(0, 0)).demand, Stop::None);
    for creep in 1..=5_000 {
        assert_eq!(monitor.step(&at(creep, 1)).demand, Stop::None);
    }
    assert_eq!(monitor.step(&at(5_001, 1)).demand, Stop::Ss0);
    // 50 mm/min is motion, and motion is braked even where the path is exceeded as well.
    assert_eq!(monitor.step(&at(5_002, 25)).demand, Stop::Ss1);
}

#[test]
fn the_path_of_an_ss2_counts_with_an_open_door_only() {
    let path = parameters::stop_path(5_000).expect("the default of SMP550");
    let config = stop_path::Config::new(path).expect("any");
    for (state, demand) in [
        (GroupState::Sls3, Stop::Ss1),
        (GroupState::Auto, Stop::None),
    ] {
        let mut monitor = stop_path::Monitor::new(config);
        let at = |position: i32| stop_path::Inputs {
            braking: true,
            state,
            position: Position(position),
        };
        assert_eq!(monitor.step(&at(-7)).demand, Stop::None);
        assert_eq!(monitor.step(&at(4_993)).demand, Stop::None);
        assert_eq!(monitor.step(&at(4_994)).demand, demand);
    }
}

#[test]
fn an_axis_beyond_its_limit_is_driven_back_or_locked() {
    let end = parameters::absolute(1_000_000).expect("100 mm");
    let config = position_limit::Config::new(Position(0), end).expect("in order");
    let mut monitor = position_limit::Monitor::new(config);
    let mut step = |position: i32, changed: bool| {
        let inputs = position_limit::Inputs {
            checked: true,
            changed,
            stopping: false,
            position: Position(position),
        };
        let demand = monitor.step(&inputs).demand;
        (demand, monitor.state().lock)
    };
    use position_limit::Lock;
    assert_eq!(step(1_000_000, false), (Stop::None, Lock::None));
    assert_eq!(step(1_000_001, false), (Stop::Ss1, Lock::ReturnAllowed));
    assert_eq!(step(1_000_001, false), (Stop::None, Lock::ReturnAllowed));
    assert_eq!(step(999_999, false), (Stop::None, Lock::None));
    assert_eq!(step(1_000_010, false), (Stop::Ss1, Lock::ReturnAllowed));
    assert_eq!(step(1_000_011, false), (Stop::Ss1, Lock::Locked));
    assert_eq!(step(1_000_000, false), (Stop::Ss1, Lock::Locked));
    assert_eq!(step(1_000_000, false), (Stop::None, Lock::Locked));
    assert_eq!(step(1_000_000, true), (Stop::None, Lock::None));
}

#[test]
fn an_axis_that_overruns_its_limit_is_not_locked() {
    let config = position_limit::Config::new(Position(0), Position(10)).expect("in order");
    let mut monitor = position_limit::Monitor::new(config);
    let at = |position: i32, stopping: bool| position_limit::Inputs {
        checked: true,
        changed: false,
        stopping,
        position: Position(position),
    };
    assert_eq!(monitor.step(&at(11, false)).demand, Stop::Ss1);
    for overrun in 12..20 {
        assert_eq!(monitor.step(&at(overrun, true)).demand, Stop::None);
    }
    assert_eq!(monitor.step(&at(18, false)).demand, Stop::None);
    assert_eq!(monitor.step(&at(19, false)).demand, Stop::Ss1);
    assert_eq!(monitor.state().lock, position_limit::Lock::Locked);
}

#[test]
fn a_lock_outlasts_power_off() {
    let config = position_limit::Config::new(Position(0), Position(10)).expect("in order");
    let state = position_limit::State::restored(true, Position(4));
    let mut monitor = position_limit::Monitor::resume(config, state).expect("consistent");
    let inputs = position_limit::Inputs {
        checked: false,
        changed: false,
        stopping: false,
        position: Position(5),
    };
    assert_eq!(monitor.step(&inputs).demand, Stop::Ss1);
}

#[test]
fn restricted_operation_ends_after_two_revolutions_from_its_start() {
    let config = revolutions::Config::new(parameters::RESTRICTED_ANGLE).expect("fits");
    let mut monitor = revolutions::Monitor::new(config);
    // 50 rpm for 800 cycles of 3 ms are two revolutions.
    let turn = |state| revolutions::Inputs { state, step: 9_000 };
    for _ in 0..800 {
        assert_eq!(monitor.step(&turn(GroupState::SlsS)).demand, Stop::None);
    }
    assert_eq!(monitor.step(&turn(GroupState::SlsS)).demand, Stop::Ss1);
    assert_eq!(monitor.step(&turn(GroupState::Sls2)).demand, Stop::None);
    assert_eq!(monitor.step(&turn(GroupState::SlsS)).demand, Stop::None);
}

#[test]
fn speeds_are_compared_over_a_window_positions_at_once() {
    let config = comparison::Config::new(
        false,
        parameters::deviation(1_000).expect("1 mm"),
        Percent::new(10).expect("the practical value"),
        Cycles::new(3),
    )
    .expect("a window");
    let mut monitor = comparison::Monitor::new(config);
    let auto = |actual: i32| comparison::Inputs {
        state: GroupState::Auto,
        deviation: Distance(u32::MAX),
        nominal: -1_000,
        actual,
    };
    for actual in [-1_101, -1_101, -1_100, 0, 900] {
        assert_eq!(monitor.step(&auto(actual)).demand, Stop::None);
    }
    // The sign counts: the same speed in the wrong direction deviates.
    assert_eq!(monitor.step(&auto(1_000)).demand, Stop::Ss1);
    let open = |deviation: u32| comparison::Inputs {
        state: GroupState::Sos,
        deviation: Distance(deviation),
        nominal: 0,
        actual: 0,
    };
    assert_eq!(monitor.step(&open(10_000)).demand, Stop::None);
    assert_eq!(monitor.step(&open(10_001)).demand, Stop::Ss1);
}

#[test]
fn a_drive_that_does_not_brake_loses_its_torque_after_the_wait() {
    let wait = parameters::stop_time(30).expect("the default of SMP530");
    assert_eq!(wait, Cycles::new(10));
    for (spindle, speeds, expected) in [
        // An axis may keep its speed, and become faster until the wait is over.
        (false, [100, 101, 102, 102, 102], Stop::None),
        (true, [100, 101, 102, 102, 102], Stop::Ss0),
        (true, [100, 101, 102, 0, 0], Stop::None),
    ] {
        let config = deceleration::Config::new(spindle, Cycles::new(3), false).expect("any");
        let mut monitor = deceleration::Monitor::new(config);
        let mut worst = Stop::None;
        for speed in speeds {
            let out = monitor.step(&deceleration::Inputs {
                braking: true,
                speed: Speed(speed),
            });
            worst = worst.max(out.demand);
        }
        assert_eq!(worst, expected, "spindle {spindle}, {speeds:?}");
    }
}

#[test]
fn values_outside_their_ranges_are_refused() {
    let refused = Err(ConfigError::ValueOutOfRange);
    assert_eq!(parameters::axis_limit(2_001, 2_000), refused);
    assert_eq!(parameters::spindle_limit(6_001), refused);
    assert_eq!(
        parameters::standstill_path(0),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        parameters::stop_path(1_000_001),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        parameters::absolute(-1_000_000_000),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        parameters::test_interval(10_081),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        parameters::permissive_time(18_001),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        parameters::Options::new(1 << 9),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        operating_stop::Config::new(Distance(1), Speed(0)),
        Err(ConfigError::ValueOutOfRange)
    );
    assert_eq!(
        position_limit::Config::new(Position(1), Position(1)),
        Err(ConfigError::LimitsCrossed)
    );
}

#[test]
fn values_round_to_the_earlier_reaction() {
    assert_eq!(parameters::axis_limit(1_999, 2_000), Ok(Speed(999)));
    assert_eq!(
        parameters::spindle_limit(50),
        Ok(parameters::RESTRICTED_SPEED)
    );
    assert_eq!(parameters::stop_time(1_000), Ok(Cycles::new(333)));
    assert_eq!(parameters::brake_time(200), Ok(Cycles::new(67)));
    assert_eq!(parameters::window(4_000), Ok(Cycles::new(1_333)));
    assert_eq!(parameters::window(5), Ok(Cycles::new(1)));
    assert!(parameters::window(2).is_err() && parameters::window(60_001).is_err());
    assert_eq!(
        parameters::test_interval(10_080),
        Ok(Cycles::new(201_600_000))
    );
    assert_eq!(parameters::switch_off_time(0), Ok(Cycles::new(1_000)));
    let options = parameters::Options::new(0b1_1001_0100_1011).expect("every known bit");
    assert!(options.som_4 && options.no_output_test && options.spindle_ramp_off);
    assert_eq!(
        parameters::Options::new(0),
        Ok(parameters::Options::default())
    );
}

/// HFS-NAV-004, HFS-ARCH-012: each channel compares with an encoder of its own. One that freezes while the axis moves is found
/// by its channel alone, which is enough.
#[test]
fn a_frozen_encoder_is_found_by_the_channel_that_has_it() {
    let config = comparison::Config::new(
        false,
        Distance(10),
        Percent::new(50).expect("in the range"),
        Cycles::new(4),
    )
    .expect("plausible");
    for frozen in 0..2 {
        // The MC with the encoder of the position, the CC with that of the motor.
        let mut channels = [
            comparison::Monitor::new(config),
            comparison::Monitor::new(config),
        ];
        let mut found = [false; 2];
        for cycle in 1..=4_u32 {
            for (channel, monitor) in channels.iter_mut().enumerate() {
                let stands = channel == frozen;
                let inputs = comparison::Inputs {
                    state: GroupState::Sls2,
                    deviation: Distance(if stands { 5 * cycle } else { 0 }),
                    nominal: 5,
                    actual: if stands { 0 } else { 5 },
                };
                found[channel] |= monitor.step(&inputs).demand == Stop::Ss1;
            }
        }
        assert_eq!(found, [frozen == 0, frozen == 1]);
    }
}

/// HFS-SS1-003: MP2590 counts when it is at least MP1060, else that one; 0 is the limit of current.
#[test]
fn the_emergency_ramp_is_at_least_that_of_normal_operation() {
    use parameters::Ramp::{Current, Deceleration};
    for (mp2590, mp1060, ramp) in [
        (3_000, 1_000, Deceleration(3_000)),
        (1_000, 1_000, Deceleration(1_000)),
        (400, 1_000, Deceleration(1_000)),
        (0, 1_000, Current),
    ] {
        assert_eq!(parameters::emergency_ramp(mp2590, mp1060), ramp);
    }
}
