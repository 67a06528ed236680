//! Runs of referencing, outputs, self-test and checks of HEIDENHAIN Functional Safety.

use stillpoint_monitors::heidenhain::reference::AxisRef;
use stillpoint_monitors::heidenhain::types::{GroupState, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{
    acceptance, agreement, axis_count, cut_out, holding_brake, reference, sampling, self_test,
    start_checks, tool_holder,
};
use stillpoint_monitors::kernel::Cycles;

#[test]
fn a_new_machine_is_checked_at_the_mark_and_found_again_after_power_off() {
    let config = reference::Config::new(true).expect("any");
    let mut monitor = reference::Monitor::new(config);
    let homing = reference::Inputs {
        homed: true,
        own_matches: true,
        peer_matches: true,
        unit: Unit::Reference,
        ..reference::Inputs::default()
    };
    monitor.step(&homing);
    monitor.step(&homing);
    assert_eq!(monitor.state().axis, AxisRef::NotChecked);
    let at_the_mark = reference::Inputs {
        own_at_mark: true,
        peer_at_mark: true,
        confirm: true,
        som: Som::Som2,
        peer_checked: true,
        ..homing
    };
    let in_som_1 = reference::Inputs {
        som: Som::Som1,
        ..at_the_mark
    };
    assert!(!monitor.step(&in_som_1).checked);
    assert!(monitor.step(&at_the_mark).ax_safe);
    let power_on = reference::Inputs {
        power_on: true,
        ..reference::Inputs::default()
    };
    assert!(!monitor.step(&power_on).may_move);
    monitor.step(&homing);
    assert!(monitor.step(&homing).checked);
    // An exchanged encoder: found, but to be checked, even when the control is started twice.
    let exchanged = reference::Inputs {
        check_cause: true,
        ..power_on
    };
    monitor.step(&exchanged);
    monitor.step(&power_on);
    monitor.step(&homing);
    assert!(!monitor.step(&homing).checked);
}

#[test]
fn an_axis_not_checked_moves_with_closed_doors_or_in_its_own_mode() {
    let config = reference::Config::new(true).expect("any");
    let state = reference::State {
        axis: AxisRef::NotChecked,
        saved: false,
    };
    for (unit, door_open, demand) in [
        (Unit::Panel, true, Stop::Ss2),
        (Unit::Panel, false, Stop::None),
        (Unit::Reference, true, Stop::None),
    ] {
        let mut monitor = reference::Monitor::resume(config, state).expect("consistent");
        let out = monitor.step(&reference::Inputs {
            unit,
            door_open,
            moving: true,
            ..reference::Inputs::default()
        });
        assert_eq!(out.demand, demand);
        assert_eq!(out.may_move, demand == Stop::None);
    }
}

#[test]
fn a_difference_of_22_cycles_is_a_fault() {
    let mut monitor = agreement::Monitor::new(agreement::Config::PUBLISHED);
    let differ = agreement::Inputs { differ: true };
    for _ in 0..21 {
        assert!(!monitor.step(&differ).fault);
    }
    assert!(monitor.step(&differ).fault);
    assert!(!monitor.step(&agreement::Inputs { differ: false }).fault);
    assert!(!monitor.step(&differ).fault);
}

/// HFS-NS-001/a, HFS-MODE-004/c: an axis without a group may move beside the one safe axis of SOM_2, two safe axes not.
#[test]
fn an_axis_without_a_group_is_not_counted() {
    let mut monitor = axis_count::Monitor::new(axis_count::Config);
    let mut demand = |moving, ungrouped| {
        let inputs = axis_count::Inputs {
            state: GroupState::Sls2,
            unit: Unit::Program,
            moving,
            ungrouped,
        };
        monitor.step(&inputs).demand
    };
    assert_eq!(demand(2, 1), Stop::None);
    assert_eq!(demand(3, 2), Stop::None);
    assert_eq!(demand(3, 1), Stop::Ss2);
}

#[test]
fn two_axes_move_together_by_program_not_by_handwheel() {
    let mut monitor = axis_count::Monitor::new(axis_count::Config);
    let mut demand = |state, unit| {
        let inputs = axis_count::Inputs {
            state,
            unit,
            moving: 2,
            ungrouped: 0,
        };
        monitor.step(&inputs).demand
    };
    assert_eq!(demand(GroupState::Sls3, Unit::Program), Stop::None);
    assert_eq!(demand(GroupState::Sls3, Unit::Handwheel), Stop::Ss2);
    assert_eq!(demand(GroupState::Sls2, Unit::Program), Stop::Ss2);
    assert_eq!(demand(GroupState::Auto, Unit::Reference), Stop::None);
}

#[test]
fn the_holder_opens_one_cycle_after_torque_off_was_asked_for() {
    let mut monitor = tool_holder::Monitor::new(tool_holder::Config);
    let request = tool_holder::Inputs {
        request: true,
        door_open: true,
        moving: false,
        state: GroupState::StoO,
    };
    let turning = tool_holder::Inputs {
        moving: true,
        ..request
    };
    assert!(!monitor.step(&turning).no_torque);
    let asked = monitor.step(&request);
    assert!(asked.no_torque && !asked.open);
    let open = monitor.step(&request);
    assert!(open.no_torque && open.open);
    let closed = monitor.step(&tool_holder::Inputs::default());
    assert!(!closed.no_torque && !closed.open);
}

#[test]
fn two_changed_parameters_need_the_password_and_two_presses() {
    let config = acceptance::Config::new(100).expect("not 0");
    let mut monitor = acceptance::Monitor::new(config);
    let idle = acceptance::Inputs::default();
    let boot = acceptance::Inputs {
        boot: true,
        changes: 2,
        ..idle
    };
    let press = acceptance::Inputs {
        permissive: true,
        ..idle
    };
    let password = acceptance::Inputs {
        password: true,
        ..idle
    };
    monitor.step(&boot);
    monitor.step(&press);
    monitor.step(&password);
    assert!(!monitor.step(&press).in_service);
    assert!(monitor.step(&press).in_service);
    // From here on the stored checksum is that of this set.
    assert_eq!(monitor.step(&idle).demand, Stop::Ss1F);
    monitor.step(&boot);
    monitor.step(&acceptance::Inputs {
        cancel: true,
        ..idle
    });
    assert!(!monitor.step(&password).in_service);
    assert_eq!(monitor.state().phase, acceptance::Phase::Interrupted);
}

#[test]
fn the_first_test_ends_with_the_brakes_a_repeated_one_begins_with_them() {
    use self_test::Phase;
    let config = self_test::Config::new(Cycles::new(50), false, false, true).expect("an interval");
    let mut monitor = self_test::Monitor::new(config);
    let good = self_test::Inputs {
        configured: true,
        done: true,
        es_closed: true,
        keys_free: true,
        doors_shut: true,
        brake_good: true,
        ..self_test::Inputs::default()
    };
    let mut run = |start: bool| {
        let mut phases = Vec::new();
        for cycle in 0..20 {
            let asked = monitor.state().phase == Phase::VoltageOn;
            let inputs = self_test::Inputs {
                start: start && cycle == 0,
                cvo: asked,
                ..good
            };
            monitor.step(&inputs);
            phases.push(monitor.state().phase);
            if monitor.state().phase == Phase::Passed {
                break;
            }
        }
        phases
    };
    let part_1 = [
        Phase::Internal,
        Phase::Chain,
        Phase::EsCircuit,
        Phase::VoltageOff,
        Phase::VoltageOn,
        Phase::Keys,
        Phase::Doors,
        Phase::BrakeControl,
        Phase::CutOut,
    ];
    let first = [&part_1[..], &[Phase::HoldingBrakes, Phase::Passed]].concat();
    assert_eq!(run(false), first);
    let repeated = [
        &[Phase::HoldingBrakes, Phase::DrivesOff, Phase::Configuration],
        &part_1[..],
        &[Phase::Passed],
    ]
    .concat();
    assert_eq!(run(true), repeated);
    for _ in 0..49 {
        assert!(monitor.step(&good).gen_safe);
    }
    assert!(!monitor.step(&good).gen_safe);
}

#[test]
fn sampling_finds_a_short_circuit_and_never_hides_an_emergency_stop() {
    let config = sampling::Config::new(Cycles::new(2), true).expect("not 0");
    let mut monitor = sampling::Monitor::new(config);
    let closed = sampling::Inputs {
        due: true,
        contact_a: true,
        contact_b: true,
        ..sampling::Inputs::default()
    };
    let open = sampling::Inputs {
        contact_a: false,
        contact_b: false,
        ..closed
    };
    for cycle in 0..14 {
        let out = monitor.step(if cycle < 7 { &closed } else { &open });
        assert_eq!(out.opened, cycle >= 7);
        assert_eq!(out.demand == Stop::Ss1, cycle >= 7);
    }
    let stuck = sampling::Inputs {
        stuck_b: true,
        ..closed
    };
    let demands: Vec<Stop> = (0..7).map(|_| monitor.step(&stuck).demand).collect();
    assert!(demands.contains(&Stop::Ss1));
}

#[test]
fn a_mixed_group_keeps_the_control_out_of_service() {
    let config = start_checks::Config::new(false).expect("any");
    let mut monitor = start_checks::Monitor::new(config);
    let mixed = start_checks::Inputs {
        mixed: true,
        booted: true,
        ..start_checks::Inputs::default()
    };
    let sorted = start_checks::Inputs {
        mixed: false,
        ..mixed
    };
    assert_eq!(monitor.step(&mixed).demand, Stop::Ss1F);
    monitor.step(&sorted);
    assert_eq!(monitor.state().start, start_checks::Start::Refused);
    monitor.step(&start_checks::Inputs {
        power_on: true,
        ..sorted
    });
    monitor.step(&sorted);
    assert_eq!(monitor.state().start, start_checks::Start::InService);
}

/// HFS-PARAM-022, HFS-BRT-007: SMP2230 is 0.1 to 30.0, or 0 for no test.
#[test]
fn the_test_torque_has_its_range() {
    for (tenths, tested) in [
        (0, Some(false)),
        (1, Some(true)),
        (300, Some(true)),
        (301, None),
    ] {
        let made = holding_brake::Config::new(tenths).ok();
        assert_eq!(made.map(|config| config.is_tested()), tested, "{tenths}");
    }
}

/// HFS-BRT-006, HFS-BRT-002: torque known, brake closed, drive off, test torque; the brake slips and the drive takes the axis.
#[test]
fn a_brake_that_slips_is_defective_until_it_is_tested_in_a_safe_place() {
    let mut brake =
        holding_brake::Monitor::new(holding_brake::Config::new(10).expect("in the range"));
    let start = holding_brake::Inputs {
        start: true,
        ..Default::default()
    };
    let done = holding_brake::Inputs {
        done: true,
        ..Default::default()
    };
    assert!(brake.step(&start).controlled);
    let closes = brake.step(&done);
    assert!(closes.closed && closes.controlled);
    let off = brake.step(&done);
    assert!(off.closed && !off.controlled);
    assert_eq!(brake.step(&done).step, holding_brake::Phase::TestTorque);
    let slips = holding_brake::Inputs {
        too_far: true,
        current: true,
        ..done
    };
    let bad = brake.step(&slips);
    assert!(bad.step == holding_brake::Phase::Defective && bad.controlled && !bad.passed);
    assert_eq!(brake.step(&start).step, holding_brake::Phase::Defective);
    let safe = holding_brake::Inputs {
        safe_now: true,
        ..start
    };
    assert_eq!(brake.step(&safe).step, holding_brake::Phase::TorqueKnown);
}

/// HFS-BRT-002: a brake that does not hold at all lets the axis fall as soon as the drive lets go; the drive takes it at once.
#[test]
fn an_axis_that_falls_before_the_test_torque_is_taken() {
    let mut brake =
        holding_brake::Monitor::new(holding_brake::Config::new(10).expect("in the range"));
    let start = holding_brake::Inputs {
        start: true,
        ..holding_brake::Inputs::default()
    };
    let done = holding_brake::Inputs {
        done: true,
        ..holding_brake::Inputs::default()
    };
    brake.step(&start);
    brake.step(&done);
    assert_eq!(brake.step(&done).step, holding_brake::Phase::ControlOff);
    let falls = holding_brake::Inputs {
        too_far: true,
        ..holding_brake::Inputs::default()
    };
    let bad = brake.step(&falls);
    assert!(bad.step == holding_brake::Phase::Defective && bad.controlled && !bad.passed);
}

/// HFS-STO-003, HFS-TEST-010, HFS-BCT-004, HFS-BCT-005: the whole test with sound feedback, and its beginning with an axis that
/// leaves its place.
#[test]
fn the_cut_out_test_ends_with_the_voltage_on() {
    let [relay, ready, off] = [2, 2, 2].map(Cycles::new);
    let config = cut_out::Config::new(relay, ready, off, false, false).expect("plausible");
    let mut test = cut_out::Monitor::new(config);
    let idle = cut_out::Inputs::default();
    let mut out = test.step(&cut_out::Inputs {
        start: true,
        ..idle
    });
    assert!(out.brake_a && out.brake_b);
    let mut watched = [false; 2];
    let mut cycles = 0;
    while !out.done {
        let inputs = cut_out::Inputs {
            t_brk: out.brake_a && out.brake_b,
            chain: !out.sto_a_g,
            ready: out.on_mc && out.on_cc,
            ..idle
        };
        out = test.step(&inputs);
        watched = [watched[0] | out.watch_mc, watched[1] | out.watch_cc];
        assert!(!out.stos_a_g && out.others == Stop::None);
        cycles += 1;
        assert!(cycles < 20, "{:?}", out.step);
    }
    assert!(out.sto_a_g && watched == [true; 2]);
    let mut test = cut_out::Monitor::new(config);
    test.step(&cut_out::Inputs {
        start: true,
        ..idle
    });
    let moved = cut_out::Inputs {
        moved: true,
        ..idle
    };
    let out = test.step(&moved);
    assert!(out.ask_place && out.step == cut_out::Phase::Idle && !out.brake_a && !out.brake_b);
    // A brake that channel A cannot close: SS0 of the tested axes, SS1F of the others.
    let supplied = cut_out::Inputs {
        t_brk: true,
        ..idle
    };
    test.step(&cut_out::Inputs {
        start: true,
        ..supplied
    });
    let stops: Vec<_> = (0..3).map(|_| test.step(&supplied)).collect();
    assert_eq!(
        stops.iter().map(|out| (out.tested, out.others)).next_back(),
        Some((Stop::Ss0, Stop::Ss1F))
    );
}

/// HFS-BCT-002, HFS-TEST-015: relays and power modules that follow one cycle late. A channel that cannot be switched off is found, and a
/// sound one passes.
#[test]
fn a_dead_channel_is_found_though_feedback_is_slow() {
    let [relay, ready, off] = [3, 3, 3].map(Cycles::new);
    let config = cut_out::Config::new(relay, ready, off, false, false).expect("plausible");
    // Stuck at 1: the brake outputs of both channels, the pulses of both.
    let tested = |stuck: [bool; 4]| {
        let mut test = cut_out::Monitor::new(config);
        let start = cut_out::Inputs {
            start: true,
            ..cut_out::Inputs::default()
        };
        let mut out = test.step(&start);
        let (mut t_brk, mut ready) = (false, false);
        for _ in 0..40 {
            let inputs = cut_out::Inputs {
                t_brk,
                ready,
                chain: !out.sto_a_g,
                ..cut_out::Inputs::default()
            };
            t_brk = (out.brake_a || stuck[0]) && (out.brake_b || stuck[1]);
            ready = (out.on_mc || stuck[2]) && (out.on_cc || stuck[3]);
            out = test.step(&inputs);
        }
        out.step
    };
    assert_eq!(tested([false; 4]), cut_out::Phase::Done);
    for k in 0..4 {
        let mut stuck = [false; 4];
        stuck[k] = true;
        assert_eq!(tested(stuck), cut_out::Phase::Fault, "{k}");
    }
}
