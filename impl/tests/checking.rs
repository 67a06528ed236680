//! The monitors that check the monitoring, in the sequences the manual describes, with cycles of 12 ms.

use stillpoint_monitors::kernel::{ConfigError, Cycles, Distance, Position};
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::compare::list::{self, ITEMS, Parameters, Snapshot, Tolerance};
use stillpoint_monitors::sinumerik::level::InternalStop;
use stillpoint_monitors::sinumerik::{
    compare, forced_check, history, pulses, shutdown_test, slip, test_stop,
};

/// t_chk of 100 ms.
const T_CHK: Cycles = Cycles::new(9);

fn test_of_path() -> test_stop::Monitor {
    test_stop::Monitor::new(test_stop::Config::new(T_CHK).expect("100 ms"))
}

fn selected(pulses_cancelled: bool) -> test_stop::Inputs {
    test_stop::Inputs {
        select: true,
        pulses_cancelled,
        ..test_stop::Inputs::default()
    }
}

/// Runs a whole test whose feedback comes one cycle after the start; the number of cycles with cancelled pulses.
fn run(monitor: &mut test_stop::Monitor) -> (u32, test_stop::Outputs) {
    let mut outputs = monitor.step(&selected(false));
    let mut cycles = 0;
    while outputs.active {
        cycles += 1;
        // The selection is withdrawn early, which changes nothing.
        outputs = monitor.step(&test_stop::Inputs {
            select: cycles < 3,
            ..selected(true)
        });
    }
    (cycles, outputs)
}

/// S840D-TEST-001/a, S840D-TEST-005, S840D-TEST-009, S840D-TEST-010, S840D-TEST-029: both paths, one after the other.
#[test]
fn both_paths_tested_one_after_the_other_make_the_axis_tested() {
    let interval = Cycles::new(100);
    let config = forced_check::Config::new(interval).expect("short");
    let mut check = forced_check::Monitor::new(config);
    assert!(check.step(&forced_check::Inputs::default()).due);

    let (cycles, drive) = run(&mut test_of_path());
    assert_eq!(
        (cycles, drive.passed, drive.code),
        (T_CHK.count(), true, Code::NONE)
    );
    let half = check.step(&forced_check::Inputs {
        passed_drive: drive.passed,
        ..forced_check::Inputs::default()
    });
    assert!(half.half && half.due && !half.tested);

    let (_, nck) = run(&mut test_of_path());
    let whole = check.step(&forced_check::Inputs {
        passed_nck: nck.passed,
        ..forced_check::Inputs::default()
    });
    assert!(whole.tested && !whole.due);
    // The path tested first is the first to become due again.
    let mut cycles = 0;
    while !check.step(&forced_check::Inputs::default()).due {
        cycles += 1;
    }
    assert_eq!(cycles, interval.count() - 2);
}

/// S840D-TEST-007, S840D-TEST-008, S840D-TEST-013, S840D-KDV-721: code 1005.
#[test]
fn a_second_test_before_the_pulses_are_enabled_again_is_refused() {
    let mut monitor = test_of_path();
    let refused = monitor.step(&selected(true));
    assert!(refused.refused && !refused.active);
    assert_eq!(refused.code.number(), 1005);
    // The selection must be withdrawn and come again.
    assert!(!monitor.step(&selected(false)).active);
    monitor.step(&test_stop::Inputs::default());
    assert!(monitor.step(&selected(false)).active);
}

/// S840D-TEST-016, S840D-TEST-017, S840D-KDV-723: code 1010.
#[test]
fn a_failed_external_test_stops_over_the_internal_path() {
    let config = shutdown_test::Config::new(Cycles::new(1)).expect("short");
    let mut monitor = shutdown_test::Monitor::new(config);
    let started = monitor.step(&selected(false));
    assert!(started.active && !started.enable_external);
    let failed = monitor.step(&selected(true));
    assert_eq!(
        (failed.demand, failed.code.number()),
        (InternalStop::A, 1010)
    );
    assert!(failed.enable_external);
}

/// S840D-PULSE-005, S840D-PULSE-006, S840D-PULSE-007: over the drive bus first.
#[test]
fn internal_cancellation_falls_back_to_the_external_path() {
    let config = pulses::Config::new(true, true, Cycles::new(2)).expect("short");
    let mut monitor = pulses::Monitor::new(config);
    let running = pulses::Inputs {
        run_up: true,
        ..pulses::Inputs::default()
    };
    assert!(monitor.step(&running).enable);
    let cancel = pulses::Inputs {
        cancel: true,
        ..running
    };
    let external: Vec<bool> = (0..4)
        .map(|_| monitor.step(&cancel).enable_external)
        .collect();
    assert_eq!(external, [true, true, false, false]);
    assert!(monitor.step(&running).enable_external);
}

/// S840D-KDV-504, S840D-KDV-506, S840D-KDV-516, S840D-KDV-701, S840D-KDV-707: one item in a cycle, parameters always.
#[test]
fn a_parameter_that_differs_is_found_within_one_pass() {
    let config = compare::Config::new(Cycles::new(42), &ITEMS).expect("the whole list");
    let mut monitor = compare::Monitor::new(config);
    let own = Snapshot::default();
    let other = Snapshot {
        parameters: Parameters {
            refp_pos_tol: Distance(10),
            ..Parameters::default()
        },
        // A position within the tolerance is no difference.
        position: Position(100),
        ..own
    };
    let mut findings = Vec::new();
    for _ in 0..config.pass() {
        let due = monitor.state().due(&config, false);
        let tolerance = Tolerance::Position(Distance(100));
        let outputs = monitor.step(&compare::Inputs {
            // A signal bounces all the time: parameters are compared nevertheless.
            change: true,
            differs: list::differs(due, &own, &other, tolerance),
            ..compare::Inputs::default()
        });
        findings.extend(outputs.discrepancy.then_some(outputs.code.number()));
    }
    assert_eq!(findings, [32]);
}

/// S840D-SLIP-502, S840D-SLIP-503, S840D-SLIP-504: half of the difference each.
#[test]
fn slipping_channels_meet() {
    let config = slip::Config::new(slip::DEAD_BAND, Distance(50), true, false).expect("allowed");
    let mut nck = slip::Monitor::new(config);
    let mut drive = slip::Monitor::new(config);
    let at = |own, other| slip::Inputs {
        due: true,
        own: Position(own),
        other: Position(other),
        ..slip::Inputs::default()
    };
    let (shown_nck, shown_drive) = (nck.step(&at(1_000, 1_041)), drive.step(&at(1_041, 1_000)));
    assert_eq!(
        (shown_nck.position, shown_drive.position),
        (Position(1_020), Position(1_021))
    );
    assert!(!shown_nck.error && !shown_drive.error);
    // Further apart than the tolerance: an error, and corrected all the same.
    let far = nck.step(&at(1_000, 1_071));
    assert!(far.error && far.position == Position(1_045));
}

/// S840D-REF-004, S840D-REF-007, S840D-REF-009, S840D-KDV-516: exact at the tolerance.
#[test]
fn the_history_survives_power_off() {
    let config = history::Config::new(Distance(10)).expect("every tolerance");
    let mut monitor = history::Monitor::new(config);
    monitor.step(&history::Inputs {
        save: true,
        position: Position(500),
        ..history::Inputs::default()
    });
    let stored = monitor.state();
    let mut monitor = history::Monitor::resume(config, stored).expect("as stored");
    let reference = |refpos| history::Inputs {
        power_on: true,
        refpos: Position(refpos),
        travelled: 100,
        ..history::Inputs::default()
    };
    assert!(monitor.step(&reference(610)).history_ok);
    assert!(!monitor.step(&reference(611)).history_ok);
}

/// S840D-PARAM-507, S840D-SLIP-501, S840D-SLIP-701, S840D-TEST-001/a: plausibility of the parameters.
#[test]
fn configurations_the_manual_does_not_allow_are_refused() {
    let eleven_seconds = Cycles::new(11_000 * 32);
    assert_eq!(
        test_stop::Config::new(eleven_seconds),
        Err(ConfigError::DelayTooLong)
    );
    assert_eq!(
        pulses::Config::new(true, false, T_CHK),
        Err(ConfigError::NoExternalPath)
    );
    assert!(pulses::Config::new(false, false, T_CHK).is_ok());
    assert_eq!(
        pulses::Config::new(true, true, eleven_seconds),
        Err(ConfigError::DelayTooLong)
    );
    assert_eq!(
        compare::Config::new(eleven_seconds, &ITEMS),
        Err(ConfigError::DelayTooLong)
    );
    assert_eq!(
        compare::Config::new(T_CHK, &[]),
        Err(ConfigError::ListLength)
    );
    for (two_encoders, se_sn) in [(false, false), (false, true), (true, true)] {
        assert_eq!(
            slip::Config::new(slip::DEAD_BAND, Distance(50), two_encoders, se_sn),
            Err(ConfigError::SynchronisationNotAllowed)
        );
    }
    assert_eq!(
        forced_check::Config::new(Cycles::ZERO),
        Err(ConfigError::NoDelay)
    );
    let longer = Cycles::new(forced_check::EIGHT_HOURS.count() + 1);
    assert_eq!(
        forced_check::Config::new(longer),
        Err(ConfigError::DelayTooLong)
    );
}
