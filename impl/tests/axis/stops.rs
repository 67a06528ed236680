//! Stops, their acknowledgement and the shutdown of the pulses.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::axis::Local;
use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::selection::Mode;
use stillpoint_monitors::sinumerik::stop::Phase;

use crate::machine::{ENABLED, Machine, both, levels, move_to, parameters};

/// S840D-SBH-005, S840D-P-04, S840D-P-05, S840D-STOP-012: the operating stop is left. STOP B in the same cycle in both
/// channels, STOP A after t_B, RESET does not help, power-on does.
#[test]
fn standstill_violation_ends_in_stop_a() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.sge.sbh_off = false;
    });
    assert!(machine.step().nck.sga.sbh_active);
    machine.both(move_to(1_000));
    assert_eq!(levels(&machine.at(9)), both(Level::None));
    machine.both(move_to(1_001));
    let outputs = machine.at(10);
    assert_eq!(levels(&outputs), both(Level::B));
    for axis in [outputs.nck, outputs.drive] {
        assert!(axis.alarms.contains(Alarm::Standstill) && axis.alarms.contains(Alarm::StopB));
        assert!(axis.sga.stop_ab && axis.channel.stop.n_set_zero && axis.channel.pulses.enable);
    }
    // The stop is raised once, the violation lasts.
    let outputs = machine.at(18);
    assert_eq!(levels(&outputs), both(Level::B));
    assert!(
        outputs
            .nck
            .alarms
            .iter()
            .eq([Alarm::NotSafelyReferenced, Alarm::Standstill])
    );
    let outputs = machine.at(19);
    assert_eq!(levels(&outputs), both(Level::A));
    assert!(!outputs.nck.channel.pulses.enable && !outputs.drive.channel.pulses.enable);
    machine.both(move_to(0));
    let outputs = machine.once(|local| local.reset = true);
    assert_eq!(levels(&outputs), both(Level::A));
    assert!(outputs.nck.channel.start_inhibit);
    let outputs = machine.once(|local| local.power_on = true);
    assert_eq!(levels(&outputs), both(Level::None));
    assert!(!outputs.nck.channel.start_inhibit && outputs.nck.channel.pulses.enable);
}

/// S840D-SG-006, S840D-STOP-030, S840D-STOP-080, S840D-ACK-001: too fast in SG1. STOP C at once, the forced operating
/// stop after t_C, RESET only then.
#[test]
fn speed_violation_is_acknowledged_after_its_end() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    let _ = machine.at(8);
    // 400 um a cycle are permitted.
    machine.both(move_to(400));
    assert_eq!(levels(&machine.at(9)), both(Level::None));
    machine.both(move_to(801));
    let outputs = machine.at(10);
    assert_eq!(levels(&outputs), both(Level::C));
    assert!(outputs.nck.alarms.contains(Alarm::SpeedLimit) && outputs.nck.sga.stop_c);
    let early = machine.once(|local| local.reset = true);
    assert!(!early.nck.reset_taken && early.nck.channel.stop.phase == Phase::Braking);
    assert_eq!(machine.at(18).nck.channel.stop.phase, Phase::Braking);
    let outputs = machine.at(19);
    assert_eq!(outputs.nck.channel.stop.phase, Phase::SbhInt);
    assert_eq!(outputs.nck.channel.selection.mode, Mode::Sg);
    assert!(outputs.nck.sga.sbh_active && outputs.drive.sga.sbh_active);
    let outputs = machine.at(20);
    assert_eq!(outputs.nck.channel.selection.mode, Mode::SbhForced);
    assert_eq!(outputs.nck.channel.selection.reference, Position(801));
    let outputs = machine.once(|local| local.reset = true);
    assert!(outputs.nck.reset_taken && outputs.drive.reset_taken);
    assert_eq!(levels(&outputs), both(Level::None));
    assert_eq!(machine.step().nck.channel.selection.mode, Mode::Sg);
}

/// S840D-STOP-007, S840D-STOP-090, S840D-P-16, S840D-P-45: only one channel sees the violation. The other one has the
/// stop one cycle later; RESET waits for both and then acknowledges both.
#[test]
fn stop_is_told_and_acknowledged_jointly() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    let _ = machine.at(9);
    machine.inputs.nck.position = Position(401);
    assert_eq!(levels(&machine.at(10)), (Level::C, Level::None));
    machine.inputs.nck.position = Position(0);
    assert_eq!(levels(&machine.at(11)), both(Level::C));
    let outputs = machine.at(19);
    assert_eq!(outputs.nck.channel.stop.phase, Phase::SbhInt);
    assert_eq!(outputs.drive.channel.stop.phase, Phase::Braking);
    let outputs = machine.once(|local| local.reset = true);
    assert!(!outputs.nck.reset_taken && !outputs.drive.reset_taken);
    assert_eq!(outputs.drive.channel.stop.phase, Phase::SbhInt);
    let outputs = machine.once(|local| local.reset = true);
    assert!(outputs.nck.reset_taken && outputs.drive.reset_taken);
    for _ in 0..20 {
        assert_eq!(levels(&machine.step()), both(Level::None));
    }
}

/// S840D-EXT-009, S840D-EXT-013/a, S840D-STOP-007: external STOP A of one channel acts in both, one cycle later in the
/// other, and ends with its signal.
#[test]
fn external_stop_of_one_channel() {
    let mut machine = Machine::powered(&parameters(), false, None);
    let _ = machine.at(9);
    machine.inputs.nck.sge.stop_a_off = false;
    let outputs = machine.at(10);
    assert_eq!(levels(&outputs), (Level::A, Level::None));
    assert!(!outputs.nck.channel.pulses.enable && outputs.drive.channel.pulses.enable);
    assert!(!outputs.nck.alarms.contains(Alarm::StopA));
    assert_eq!(levels(&machine.at(11)), both(Level::A));
    machine.inputs.nck.sge.stop_a_off = true;
    assert_eq!(levels(&machine.at(12)), (Level::None, Level::A));
    assert_eq!(levels(&machine.at(13)), both(Level::None));
}

/// S840D-EXT-013/b, S840D-EXT-013/d: an external STOP D gives way to a STOP C that is asked for in addition. After both signals
/// are 1 again the axis is in its stage of SG, although the operating stop had become active through the timer.
#[test]
fn external_stop_gives_way_to_a_higher_one_and_ends_with_its_signal() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    let _ = machine.at(9);
    machine.both(|local| local.sge.stop_d_off = false);
    assert_eq!(levels(&machine.at(10)), both(Level::D));
    machine.both(|local| local.sge.stop_c_off = false);
    assert_eq!(levels(&machine.at(11)), both(Level::C));
    let outputs = machine.at(400);
    assert_eq!(outputs.nck.channel.selection.mode, Mode::SbhForced);
    machine.both(|local| {
        local.sge.stop_c_off = true;
        local.sge.stop_d_off = true;
    });
    let _ = machine.at(401);
    assert_eq!(levels(&machine.at(402)), both(Level::None));
    let outputs = machine.at(404);
    for axis in [outputs.nck, outputs.drive] {
        assert_eq!(axis.channel.selection.mode, Mode::Sg);
        assert!(axis.sga.sbh_sg_active && !axis.sga.sbh_active);
    }
}

/// S840D-EXT-013/c, S840D-EXT-013/e: the axis leaves the operating stop that an external STOP C has ended in. The internal STOP B
/// is higher, and stays when the external request has gone.
#[test]
fn an_internal_stop_outlasts_the_external_one() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.sge.stop_c_off = false;
    });
    assert_eq!(machine.at(400).nck.channel.selection.mode, Mode::SbhForced);
    // It creeps below the tolerance of the braking ramp, until it has left the window of 1 mm.
    for _ in 0..51 {
        machine.both(|local| local.position.0 += 20);
        let _ = machine.step();
    }
    assert!(levels(&machine.step()) >= both(Level::B));
    machine.both(|local| local.sge.stop_c_off = true);
    for cycle in 460..480 {
        let (nck, drive) = levels(&machine.at(cycle));
        assert!(nck >= Level::B && drive >= Level::B, "cycle {cycle}");
    }
}

/// S840D-SBR-003, S840D-P-11: the axis accelerates while STOP C brakes: STOP A in the cycle in which it is seen.
#[test]
fn braking_ramp_cancels_the_pulses() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    let _ = machine.at(9);
    machine.both(move_to(500));
    assert_eq!(levels(&machine.at(10)), both(Level::C));
    // The tolerance is 300 mm/min = 60 um a cycle over the 500 um of the start.
    machine.both(move_to(1_060));
    assert_eq!(levels(&machine.at(11)), both(Level::C));
    machine.both(move_to(1_621));
    let outputs = machine.at(12);
    assert_eq!(levels(&outputs), both(Level::A));
    assert!(outputs.nck.alarms.contains(Alarm::BrakingRamp));
    assert!(!outputs.nck.channel.pulses.enable && !outputs.drive.channel.pulses.enable);
}

/// S840D-PARAM-504, S840D-ARCH-505: before run-up the pulses are off, whatever is selected.
#[test]
fn pulses_are_off_before_run_up() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.run_up = false);
    let outputs = machine.step();
    assert!(!outputs.nck.channel.pulses.enable && !outputs.drive.channel.pulses.enable);
    machine.both(|local| local.run_up = true);
    assert!(machine.step().nck.channel.pulses.enable);
}

/// S840D-P-34, S840D-P-44: a machine without causes comes back to work with RESET from every stop that RESET
/// acknowledges.
#[test]
fn without_cause_every_stop_c_d_e_is_acknowledged() {
    for (value, stop) in [
        (2, InternalStop::C),
        (3, InternalStop::D),
        (4, InternalStop::E),
    ] {
        let parameters = Parameters {
            velo_stop_mode: value,
            function_enable: ENABLED,
            ..parameters()
        };
        let mut machine = Machine::powered(&parameters, false, None);
        machine.both(|local| local.sge.sbh_sg_off = false);
        let _ = machine.at(9);
        machine.both(move_to(401));
        assert_eq!(machine.at(10).drive.channel.stop.internal, stop);
        let _ = machine.at(30);
        machine.both(|local| local.reset = true);
        assert_eq!(
            machine.first(40, |o| levels(o) == both(Level::None)),
            Some(31)
        );
        assert_eq!(
            machine.state().nck.channel.stop.internal,
            InternalStop::None
        );
    }
}

/// S840D-OVR-001, S840D-OVR-003, S840D-P-08, S840D-P-09: the override lowers the limit of SG2 after t_vel and raises it
/// at once.
#[test]
fn override_follows_the_rules_of_the_stages() {
    let mut factors = [100; 16];
    factors[3] = 50;
    let slowed = Parameters {
        velo_ovr_factor: factors,
        ..parameters()
    };
    let mut machine = Machine::powered(&slowed, false, None);
    machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.sge.sg_0 = true;
    });
    let _ = machine.at(9);
    machine.both(|local| {
        local.sge.override_0 = true;
        local.sge.override_1 = true;
    });
    assert_eq!(machine.at(18).nck.channel.selection.limit, Speed(400));
    assert_eq!(machine.at(19).drive.channel.selection.limit, Speed(200));
    machine.both(|local| local.sge.override_0 = false);
    assert_eq!(machine.at(20).nck.channel.selection.limit, Speed(400));

    // It is the reduced limit that is watched.
    machine.both(|local| local.sge.override_0 = true);
    machine.both(move_to(200));
    assert_eq!(levels(&machine.at(40)), both(Level::None));
    machine.both(move_to(401));
    assert_eq!(levels(&machine.at(41)), both(Level::C));
}

/// S840D-FREQ-001, S840D-FREQ-002: with one encoder its limit frequency is watched while SG or SBH is active: 300 kHz are
/// 3600 pulses a cycle.
#[test]
fn encoder_limit_frequency_stops() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.encoder_speed = Speed(3_601));
    assert_eq!(levels(&machine.at(9)), both(Level::None));
    machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.encoder_speed = Speed(3_600);
    });
    assert_eq!(levels(&machine.at(10)), both(Level::None));
    machine.both(|local| local.encoder_speed = Speed(3_601));
    let outputs = machine.at(11);
    assert_eq!(levels(&outputs), both(Level::C));
    assert!(outputs.nck.alarms.contains(Alarm::SpeedLimit));
}

/// S840D-EXT-015, S840D-STOP-040: an error of the safe logic is STOP D until RESET with its cause gone.
#[test]
fn error_of_the_safe_logic_stops() {
    let mut machine = Machine::powered(&parameters(), false, None);
    let _ = machine.at(9);
    machine.both(|local| local.spl_error = true);
    assert_eq!(levels(&machine.at(10)), both(Level::D));
    assert_eq!(machine.at(19).nck.channel.stop.phase, Phase::SbhInt);
    assert_eq!(
        levels(&machine.once(|local| local.reset = true)),
        both(Level::D)
    );
    machine.both(|local| local.spl_error = false);
    assert_eq!(levels(&machine.step()), both(Level::D));
    // The request of the other channel is one cycle old.
    assert_eq!(
        levels(&machine.once(|local| local.reset = true)),
        both(Level::D)
    );
    assert_eq!(levels(&machine.step()), both(Level::None));
}

/// S840D-EXT-005, S840D-EXT-010, S840D-EXT-011, S840D-EXT-012: each signal requests its stop; a stop held by one channel
/// alone is none for the comparison, however long.
#[test]
fn external_stops_by_signal() {
    type Request = fn(&mut Local);
    let signals: [(Request, Level); 3] = [
        (|local| local.sge.stop_c_off = false, Level::C),
        (|local| local.sge.stop_d_off = false, Level::D),
        (|local| local.sge.stop_e_off = false, Level::E),
    ];
    for (request, level) in signals {
        let mut machine = Machine::powered(&parameters(), false, None);
        let _ = machine.at(9);
        request(&mut machine.inputs.nck);
        assert_eq!(levels(&machine.at(10)), (level, Level::None));
        assert_eq!(levels(&machine.at(11)), both(level));
        assert_eq!(machine.first(400, |o| o.nck.channel.fault.interlock), None);
        let outputs = machine.step();
        assert_eq!(levels(&outputs), both(level));
        assert_eq!(outputs.drive.channel.selection.mode, Mode::SbhForced);
    }
}

/// S840D-SG-002, S840D-SG-009: the signals show the stage that is monitored.
#[test]
fn stages_are_shown() {
    for (sg_1, sg_0) in [(false, false), (false, true), (true, false), (true, true)] {
        let mut machine = Machine::powered(&parameters(), false, None);
        machine.both(|local| {
            local.sge.sbh_sg_off = false;
            local.sge.sg_0 = sg_0;
            local.sge.sg_1 = sg_1;
        });
        let sga = machine.step().drive.sga;
        assert!(sga.sbh_sg_active && !sga.sbh_active);
        assert_eq!((sga.sg_active_1, sga.sg_active_0), (sg_1, sg_0));
    }
}

/// S840D-STOP-021, S840D-PARAM-024: STOP B cancels the pulses as soon as the axis is slower than STANDSTILL_VELO_TOL, here
/// 20 mm/min = 4 um a cycle.
#[test]
fn stop_b_ends_at_standstill() {
    let patient = Parameters {
        standstill_velo_tol: 20_000,
        pulse_disable_delay: 10_000_000,
        ..parameters()
    };
    let mut machine = Machine::powered(&patient, false, None);
    machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.sge.sbh_off = false;
    });
    let _ = machine.at(9);
    machine.both(move_to(1_001));
    assert_eq!(levels(&machine.at(10)), both(Level::B));
    for cycle in 11..20 {
        machine.both(|local| local.position.0 += 4);
        assert_eq!(levels(&machine.at(cycle)), both(Level::B));
    }
    machine.both(|local| local.position.0 += 3);
    assert_eq!(levels(&machine.at(20)), both(Level::A));
}

/// Table 5-3 and the examples of STOP F (S840D-STOP-021, S840D-STOP-023): the axis stands already when STOP B comes, so the
/// pulses are cancelled in that very cycle, in both channels.
#[test]
fn stop_b_on_an_axis_that_stands_cancels_the_pulses_at_once() {
    let parameters = Parameters {
        standstill_velo_tol: 50_000,
        ..parameters()
    };
    let mut machine = Machine::powered(&parameters, false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    // Different signals, which the comparison finds after t_chg: STOP F, and after t_F STOP B.
    let _ = machine.at(5);
    machine.inputs.drive.sge.sg_0 = true;
    let mut stopped = None;
    for cycle in 6..400 {
        let out = machine.step();
        assert_ne!(out.nck.channel.stop.level, Level::B, "cycle {cycle}");
        assert_ne!(out.drive.channel.stop.level, Level::B, "cycle {cycle}");
        if levels(&out) == both(Level::A) {
            stopped = stopped.or(Some(cycle));
            assert!(!out.nck.channel.pulses.enable && !out.drive.channel.pulses.enable);
        }
    }
    assert!(stopped.is_some());
}

/// Table 5-3 (S840D-STOP-031): with t_C = 0 the operating stop is active in the cycle of the STOP C, around the position of
/// that cycle. An axis that does not brake leaves the window with the next sample that lies beyond it.
#[test]
fn stop_c_without_a_time_is_the_operating_stop_at_once() {
    let parameters = Parameters {
        stop_switch_time_c: 0,
        ..parameters()
    };
    let mut machine = Machine::powered(&parameters, false, None);
    for cycle in 1..=12 {
        machine.both(move_to(cycle * 1_001));
        machine.inputs.nck.sge.stop_c_off = cycle < 10;
        let out = machine.step();
        assert_eq!(
            out.nck.sga.sbh_active,
            (10..=11).contains(&cycle),
            "cycle {cycle}"
        );
        assert_eq!(
            out.drive.sga.sbh_active,
            (11..=12).contains(&cycle),
            "cycle {cycle}"
        );
        let level = match cycle {
            ..10 => Level::None,
            10 => Level::C,
            _ => Level::B,
        };
        assert_eq!(out.nck.channel.stop.level, level, "cycle {cycle}");
    }
}

/// S840D-STOP-053/b, S840D-STOP-053/c: `$VA_STOPSI` shows STOP F where no stop is effective, and the test of the external shutdown.
#[test]
fn stopsi_shows_stop_f_and_the_external_test() {
    let mut machine = Machine::powered(&parameters(), false, None);
    assert_eq!(machine.step().nck.channel.stop.stopsi, -1);
    machine.inputs.nck.shutdown_test_select = true;
    let out = machine.step();
    assert_eq!(out.nck.channel.stop.stopsi, 11);
    assert_eq!(out.drive.channel.stop.stopsi, -1);
    let mut machine = Machine::powered(
        &Parameters {
            function_enable: 1,
            ..parameters()
        },
        false,
        None,
    );
    machine.inputs.drive.position = Position(500);
    let found = machine.first(300, |out| out.nck.alarms.contains(Alarm::CrossComparison));
    assert!(found.is_some());
    let out = machine.step();
    assert_eq!(levels(&out), both(Level::None));
    assert_eq!(out.nck.channel.stop.stopsi, 5);
    assert_eq!(out.drive.channel.stop.stopsi, 5);
}
