//! Stories of the manual, told to the monitors cycle by cycle.

use stillpoint_monitors::kernel::{ConfigError, Cycles, Position, Speed};

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::{
    agreement, external, fault, gear, reference, selection, stop,
};

fn cycles(count: u32) -> Cycles {
    Cycles::new(count)
}

fn stops(t_b: u32, t_c: u32, t_d: u32, t_e: u32) -> stop::Monitor {
    stop::Monitor::new(
        stop::Config::new(cycles(t_b), cycles(t_c), cycles(t_d), cycles(t_e)).expect("plausible"),
    )
}

/// S840D-STOP-020, -022, -012: B brakes for its time, becomes A, and only power-on helps.
#[test]
fn stop_b_becomes_stop_a() {
    let mut monitor = stops(2, 1, 1, 1);
    let first = monitor.step(&stop::Inputs {
        demand: InternalStop::B,
        ..Default::default()
    });
    assert!(first.n_set_zero && first.sbr_on && first.sga_stop_ab && !first.cancel_pulses);
    assert_eq!((first.level, first.stopsi), (Level::B, 1));
    assert_eq!(monitor.step(&stop::Inputs::default()).level, Level::B);
    let last = monitor.step(&stop::Inputs {
        reset: true,
        ..Default::default()
    });
    assert!(last.cancel_pulses && last.start_inhibit);
    assert_eq!((last.internal, last.stopsi), (InternalStop::A, 0));
    assert_eq!(
        monitor
            .step(&stop::Inputs {
                reset: true,
                ..Default::default()
            })
            .level,
        Level::A
    );
    assert_eq!(
        monitor
            .step(&stop::Inputs {
                power_on: true,
                ..Default::default()
            })
            .level,
        Level::None
    );
}

/// S840D-STOP-021, -023: B ends early at standstill, at once without delay.
#[test]
fn stop_b_ends_early() {
    let mut monitor = stops(9, 1, 1, 1);
    let _ = monitor.step(&stop::Inputs {
        f_stop_b: true,
        ..Default::default()
    });
    assert_eq!(
        monitor
            .step(&stop::Inputs {
                standstill: true,
                ..Default::default()
            })
            .level,
        Level::A
    );
    let mut at_once = stops(0, 1, 1, 1);
    assert!(
        at_once
            .step(&stop::Inputs {
                demand: InternalStop::B,
                ..Default::default()
            })
            .cancel_pulses
    );
}

/// S840D-STOP-030, -080, -091, -092, S840D-ACK-001: E is superseded by C; the first expiry counts; RESET frees after it.
#[test]
fn stop_e_is_superseded_by_c() {
    let mut monitor = stops(1, 5, 4, 3);
    assert!(
        monitor
            .step(&stop::Inputs {
                demand: InternalStop::E,
                ..Default::default()
            })
            .esr
    );
    let c = monitor.step(&stop::Inputs {
        demand: InternalStop::C,
        ..Default::default()
    });
    assert!(c.n_set_zero && c.sga_stop_c && !c.sga_stop_e && !c.ended);
    assert!(
        !monitor
            .step(&stop::Inputs {
                reset: true,
                ..Default::default()
            })
            .sbh_internal
    );
    let ended = monitor.step(&stop::Inputs::default());
    assert!(ended.sbh_internal && ended.sga_stop_c && !ended.n_set_zero && ended.sbr_on);
    assert_eq!(
        monitor
            .step(&stop::Inputs {
                reset: true,
                ..Default::default()
            })
            .level,
        Level::None
    );
}

/// S840D-EXT-009, -013, S840D-STOP-097: a stop queued beneath external STOP A acts after its withdrawal.
#[test]
fn stop_beneath_external_stop_a_waits() {
    let mut monitor = stops(1, 2, 2, 2);
    let held = stop::Inputs {
        external: ExternalStop::A,
        demand: InternalStop::D,
        ..Default::default()
    };
    let shown = monitor.step(&held);
    assert!(shown.cancel_pulses && !shown.path_brake);
    assert!(monitor.step(&stop::Inputs::default()).path_brake);
    // An external stop alone is not latched.
    let mut other = stops(1, 2, 2, 2);
    let _ = other.step(&stop::Inputs {
        external: ExternalStop::C,
        ..Default::default()
    });
    assert_eq!(other.step(&stop::Inputs::default()).level, Level::None);
}

/// Example 2 of section 5.1.5: STOP F with no function active; later one becomes active, and the delay starts.
#[test]
fn stop_f_example_2() {
    let mut monitor = fault::Monitor::new(fault::Config::new(cycles(2)).expect("plausible"));
    let found = monitor.step(&fault::Inputs {
        discrepancy: true,
        ..Default::default()
    });
    assert!(found.alarm && found.interlock && !found.bit1);
    assert!(!monitor.step(&fault::Inputs::default()).bit1);
    let active = fault::Inputs {
        monitoring: true,
        ..Default::default()
    };
    assert!(monitor.step(&active).bit1);
    assert!(!monitor.step(&active).stop_b);
    assert!(
        monitor
            .step(&fault::Inputs {
                reset: true,
                ..Default::default()
            })
            .stop_b
    );
    assert!(
        !monitor
            .step(&fault::Inputs {
                power_on: true,
                ..Default::default()
            })
            .interlock
    );
}

/// Table 5-12 and the hold until the comparison of the safe logic runs.
#[test]
fn external_stops_are_decoded() {
    let config = external::Config::new(true, false, false).expect("plausible");
    let mut monitor = external::Monitor::new(config);
    let off = external::Inputs {
        sge_a: true,
        sge_c: true,
        sge_d: true,
        sge_e: true,
        ..Default::default()
    };
    assert_eq!(monitor.step(&off).request, ExternalStop::A);
    assert_eq!(
        monitor
            .step(&external::Inputs {
                spl_started: true,
                ..off
            })
            .request,
        ExternalStop::None
    );
    assert_eq!(
        monitor
            .step(&external::Inputs {
                sge_e: false,
                ..off
            })
            .request,
        ExternalStop::None
    );
    assert_eq!(
        monitor
            .step(&external::Inputs {
                sge_d: false,
                sge_c: false,
                ..off
            })
            .request,
        ExternalStop::C
    );
    assert_eq!(
        monitor
            .step(&external::Inputs {
                spl_error: true,
                ..off
            })
            .request,
        ExternalStop::D
    );
    assert!(monitor.step(&off).spl_stop);
    assert!(
        monitor
            .step(&external::Inputs {
                spl_error: true,
                reset: true,
                ..off
            })
            .spl_stop
    );
    assert!(
        !monitor
            .step(&external::Inputs { reset: true, ..off })
            .spl_stop
    );
}

/// S840D-SBH-003, -010, S840D-SG-003, -004: delays down, none up.
#[test]
fn speed_stages_and_operating_stop() {
    let limits = [Speed(100), Speed(300), Speed(200), Speed(300)];
    let mut monitor = selection::Monitor::new(
        selection::Config::new(true, cycles(2), limits).expect("plausible"),
    );
    let sg = |stage| selection::Inputs {
        sge_sbh: true,
        sg_select: stage,
        ..Default::default()
    };
    assert_eq!(monitor.step(&sg(selection::Stage::Sg2)).limit, Speed(300));
    // An equal limit is no lower one.
    assert_eq!(
        monitor.step(&sg(selection::Stage::Sg4)).sga_sg,
        selection::Stage::Sg4
    );
    assert_eq!(monitor.step(&sg(selection::Stage::Sg1)).limit, Speed(300));
    assert_eq!(monitor.step(&sg(selection::Stage::Sg1)).limit, Speed(300));
    assert_eq!(monitor.step(&sg(selection::Stage::Sg1)).limit, Speed(100));
    let stop_at = |position| selection::Inputs {
        position: Position(position),
        ..Default::default()
    };
    assert_eq!(monitor.step(&stop_at(5)).mode, selection::Mode::SbhPend);
    assert!(!monitor.step(&stop_at(6)).sga_sbh_active);
    let active = monitor.step(&stop_at(7));
    assert!(active.sga_sbh_active);
    assert_eq!(active.reference, Position(7));
    // The end of a STOP C in the cycle before forces it; the signals have no effect, and the reference is captured anew.
    let forced = selection::Inputs {
        sbh_internal: true,
        sge_sbh_sg: true,
        ended_at: Position(8),
        ..stop_at(11)
    };
    assert_eq!(monitor.step(&forced).reference, Position(8));
    assert_eq!(monitor.step(&stop_at(9)).reference, Position(8));
}

/// Sections 4.4.3, 4.4.4 and 4.4.6: an axis is referenced, agreed, and loses it with the gear stage.
#[test]
fn axis_becomes_safely_referenced_and_loses_it() {
    let mut gear = gear::Monitor::new(gear::Config::new(3, true).expect("plausible"));
    let config = agreement::Config::new(cycles(5), true).expect("plausible");
    let mut channels = [agreement::Monitor::new(config); 2];
    let mut axis = reference::Monitor::new(reference::Config::new(true).expect("plausible"));
    let mut cycle = |index: u8, set: bool, referenced: bool| {
        let changed = gear.step(&gear::Inputs {
            power_on: false,
            index: gear::GearIndex::new(index).expect("at most 7"),
        });
        let seen = [channels[0].state().agreed, channels[1].state().agreed];
        let inputs = |other| agreement::Inputs {
            set,
            key: true,
            axis_ref: axis.state().axis == reference::AxisState::Ref,
            compare_due: axis.state().fresh,
            gear_changed: changed.changed,
            other_agreed: other,
            ..Default::default()
        };
        let agreed_1 = channels[0].step(&inputs(seen[1])).agreed;
        let agreed_2 = channels[1].step(&inputs(seen[0])).agreed;
        axis.step(&reference::Inputs {
            run_up: true,
            referenced,
            agreed_1,
            agreed_2,
            ..Default::default()
        })
    };
    assert!(!cycle(1, false, false).nst_reference_reached);
    assert!(cycle(1, false, true).compare_due);
    assert!(!cycle(1, false, false).safely_referenced);
    assert!(cycle(1, true, false).safely_referenced);
    assert!(cycle(1, false, false).safely_referenced);
    let lost = cycle(2, false, false);
    assert!(!lost.safely_referenced && lost.message && lost.nst_reference_reached);
}

/// S840D-UA-004, -009, -011: codes 1004 and 1002, and the key.
#[test]
fn agreement_codes() {
    let config = agreement::Config::new(cycles(2), true).expect("plausible");
    let mut monitor = agreement::Monitor::new(config);
    let set = agreement::Inputs {
        set: true,
        key: true,
        ..Default::default()
    };
    assert_eq!(monitor.step(&set).code.number(), 1004);
    assert!(
        !monitor
            .step(&agreement::Inputs {
                set: true,
                axis_ref: true,
                ..Default::default()
            })
            .agreed
    );
    let given = monitor.step(&agreement::Inputs {
        axis_ref: true,
        ..set
    });
    assert!(given.agreed && given.se_active);
    assert!(
        monitor
            .step(&agreement::Inputs {
                cancel: true,
                ..Default::default()
            })
            .agreed
    );
    assert!(monitor.step(&agreement::Inputs::default()).agreed);
    let expired = monitor.step(&agreement::Inputs::default());
    assert!(expired.withdrawn && expired.code == agreement::Code::Differs);
}

/// Every refused configuration is refused for its reason.
#[test]
fn implausible_configurations_are_refused() {
    let (short, long) = (cycles(1), cycles(1_920_001));
    let refused = Err(ConfigError::DelayTooLong);
    assert_eq!(
        stop::Config::new(cycles(320_001), short, short, short),
        refused
    );
    assert_eq!(
        stop::Config::new(short, cycles(320_001), short, short),
        refused
    );
    assert_eq!(stop::Config::new(short, short, long, short), refused);
    assert_eq!(stop::Config::new(short, short, short, long), refused);
    assert_eq!(fault::Config::new(long), Err(ConfigError::DelayTooLong));
    assert_eq!(
        selection::Config::new(true, long, [Speed(0); 4]),
        Err(ConfigError::DelayTooLong)
    );
    assert_eq!(
        agreement::Config::new(long, true),
        Err(ConfigError::DelayTooLong)
    );
    assert_eq!(
        agreement::Config::new(Cycles::ZERO, true),
        Err(ConfigError::NoDelay)
    );
    assert_eq!(
        external::Config::new(true, false, true),
        Err(ConfigError::StopENotEnabled)
    );
    assert_eq!(
        external::Config::new(false, true, true),
        Err(ConfigError::StopENotEnabled)
    );
    assert_eq!(
        gear::Config::new(8, true),
        Err(ConfigError::GearIndexTooHigh)
    );
}

/// A state from outside is taken only if it is consistent.
#[test]
fn resumed_states_are_checked() {
    let config = fault::Config::new(cycles(2)).expect("plausible");
    let delayed = |timer| fault::State {
        fault: fault::FaultState::Delay,
        timer: cycles(timer),
    };
    assert!(fault::Monitor::resume(config, delayed(2)).is_ok());
    assert!(fault::Monitor::resume(config, delayed(0)).is_err());
    assert!(fault::Monitor::resume(config, delayed(3)).is_err());
}

/// The contract is really checked where debug assertions are on.
#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "the state before the step breaks the invariant")]
fn contract_is_checked_in_debug_builds() {
    let config = fault::Config::new(cycles(2)).expect("plausible");
    let broken = fault::State {
        fault: fault::FaultState::Delay,
        timer: cycles(3),
    };
    let _ = fault::next(broken, &config, &fault::Inputs::default());
}
