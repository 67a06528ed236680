//! What the comparison of the channels finds. The item due in cycle n is item n modulo 84 of the list.

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::axis::Local;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::fault::FaultState;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::selection::Mode;

use crate::machine::{Machine, both, levels, parameters, referenced};

/// S840D-KDV-506, S840D-STOP-061, S840D-STOP-063, S840D-P-40: one channel loses a signal. It selects the operating stop
/// after t_vel; the comparison waits for t_chg and then finds it in both channels with code 1; STOP B after t_F, STOP A
/// after t_B.
#[test]
fn lost_signal_in_one_channel() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    assert!(!machine.step().nck.sga.sbh_active);
    let _ = machine.at(99);
    machine.inputs.drive.sge.sbh_off = false;
    let outputs = machine.at(100);
    assert_eq!(outputs.drive.channel.selection.mode, Mode::SbhPend);
    assert_eq!(outputs.nck.channel.selection.mode, Mode::Sg);
    let outputs = machine.at(109);
    assert!(outputs.drive.sga.sbh_active && !outputs.nck.sga.sbh_active);
    // Changing from cycle 100 on for 42 cycles; the other channel knows one cycle later.
    let outputs = machine.at(141);
    assert!(outputs.nck.compare.suspended && outputs.drive.compare.suspended);
    let outputs = machine.at(142);
    assert!(outputs.nck.compare.suspended && !outputs.drive.compare.suspended);
    // Result list 1 is item 0: cycles 84 (before the loss) and 168.
    let outputs = machine.at(167);
    assert!(!outputs.nck.channel.fault.interlock && !outputs.drive.channel.fault.interlock);
    let outputs = machine.at(168);
    for axis in [outputs.nck, outputs.drive] {
        assert_eq!(axis.code, Code::RESULTS_1);
        assert!(axis.alarms.contains(Alarm::CrossComparison) && axis.channel.start_inhibit);
        assert_eq!(axis.channel.stop.level, Level::None);
    }
    assert_eq!(levels(&machine.at(176)), both(Level::None));
    let outputs = machine.at(177);
    assert_eq!(levels(&outputs), both(Level::B));
    assert!(outputs.nck.alarms.contains(Alarm::StopB));
    assert_eq!(levels(&machine.at(186)), both(Level::A));
}

/// S840D-KDV-508, S840D-P-26: a parameter of the drive differs. Its item (code 10, item 8) is due in cycle 8.
#[test]
fn different_parameter_is_found_in_the_first_pass() {
    let wrong = Parameters {
        standstill_tol: 1_001,
        ..parameters()
    };
    let config = Config::different(
        parameters().validate().expect("plausible"),
        wrong.validate().expect("plausible"),
    );
    let mut machine = Machine::with(&config, false, None);
    assert_eq!(
        machine.first(99, |o| o.nck.code == Code::STANDSTILL_TOLERANCE
            && o.drive.code == Code::STANDSTILL_TOLERANCE),
        Some(8)
    );
    assert_eq!(machine.first(99, |o| levels(o) == both(Level::B)), Some(17));
}

/// S840D-STOP-093, S840D-P-51: only one channel finds the fault; the other one shows code 0 one cycle later.
#[test]
fn fault_of_one_channel_is_told() {
    let mut machine = referenced(&parameters(), 0);
    let _ = machine.at(9);
    // The key is turned and the agreement given again in one channel only: code 1004.
    machine.inputs.nck.set_agreement = true;
    machine.inputs.nck.key = true;
    let outputs = machine.at(10);
    assert_eq!(outputs.nck.alarms.code(), Code::AGREEMENT_PLAUSIBILITY);
    assert!(!outputs.drive.channel.fault.interlock);
    machine.inputs = Inputs::both(Local::idle());
    let outputs = machine.at(11);
    assert!(outputs.drive.alarms.contains(Alarm::CrossComparison));
    assert!(outputs.drive.alarms.code().is_none());
    assert_eq!(outputs.drive.channel.fault.fault, FaultState::Delay);
}

/// S840D-UA-009: the agreement is withdrawn in one channel only. After 2 s (167 cycles) the other one withdraws it too, code 1002.
#[test]
fn agreements_differ_too_long() {
    let mut machine = referenced(&parameters(), 0);
    let _ = machine.at(9);
    machine.inputs.nck.altered = true;
    let outputs = machine.at(10);
    assert!(outputs.nck.agreement.withdrawn && outputs.drive.sga.safely_referenced);
    machine.inputs.nck.altered = false;
    assert!(!machine.at(11).drive.sga.safely_referenced);
    // The drive learns of it in cycle 11.
    assert_eq!(
        machine.first(300, |o| o.drive.code == Code::AGREEMENT_DIFFERS),
        Some(11 + 167)
    );
}

/// S840D-KDV-504, S840D-ACK-001: power-on begins the comparison anew; what was told before it counts no more.
#[test]
fn power_on_forgets_what_was_told() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.inputs.drive.sge.sbh_sg_off = false;
    let _ = machine.at(60);
    let outputs = machine.once(|local| {
        local.power_on = true;
        local.sge.sbh_sg_off = true;
    });
    assert!(outputs.nck.code.is_none() && outputs.drive.code.is_none());
    machine.inputs = Inputs::both(Local::idle());
    assert_eq!(machine.first(400, |o| !o.nck.code.is_none()), None);
}

/// S840D-TIMING-512, S840D-KDV-711: the limits that are compared are made of the position and the parameters of the channel.
#[test]
fn limits_are_told() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| {
        local.position = Position(5_000);
        local.sge.sbh_sg_off = false;
        local.sge.sbh_off = false;
    });
    let snapshot = machine.step().nck.exchange.snapshot;
    // SG1 to SG4 2000 mm/min, window 1 mm, n_x 20 mm/min, tolerance 0.1 mm.
    let around = |way: i32| [Position(5_000 + way), Position(5_000 - way)];
    let [above, below] = around(400);
    assert_eq!(snapshot.limits.0[..8], [above, below].repeat(4));
    assert_eq!(snapshot.limits.0[8..10], around(1_000));
    let ([far_up, far_down], [up, down]) = (around(104), around(4));
    assert_eq!(snapshot.limits.0[10..], [far_up, up, down, far_down]);
    assert_eq!(snapshot.position, Position(5_000));
}

/// S840D-SN-005, S840D-SN-006, S840D-KDV-515: around a cam the channels may differ for ever; beyond its tolerance the
/// difference is found with result list 2 (item 1).
#[test]
fn cams_differ_within_their_tolerance_only() {
    let wide = Parameters {
        function_enable: 0x0301,
        pos_tol: 10_000,
        cam_tol: 100,
        ..parameters()
    };
    for (nck, drive, found) in [
        (9_999, 10_001, None),
        (10_100, 10_000, None),
        (9_900, 19_000, None),
        (9_899, 10_101, Some(85)),
    ] {
        let mut machine = Machine::powered(&wide, false, None);
        machine.inputs.nck.position = Position(nck);
        machine.inputs.drive.position = Position(drive);
        let seen = machine.first(300, |o| o.nck.channel.fault.interlock);
        assert_eq!(seen, found, "at {nck} and {drive}");
    }
}

/// S840D-SN-010, S840D-SN-011: at the end of the modulo range one channel is folded and the other not.
#[test]
fn modulo_range_has_no_false_difference_at_its_ends() {
    let turning = Parameters {
        function_enable: 0x0301,
        is_rot_ax: true,
        modulo_range: 360_000,
        cam_pos_plus: [10_000; 4],
        cam_pos_minus: [20_000; 4],
        ..parameters()
    };
    let mut machine = Machine::powered(&turning, false, None);
    machine.inputs.nck.position = Position(359_990);
    machine.inputs.drive.position = Position(360_010);
    let outputs = machine.at(10);
    assert!(outputs.nck.sga.sn_1_plus && !outputs.drive.sga.sn_1_plus);
    assert_eq!(machine.first(300, |o| o.nck.channel.fault.interlock), None);
    // Elsewhere a difference of the cams is one; only its own tolerance counts.
    let mut machine = Machine::powered(&turning, false, None);
    machine.inputs.nck.position = Position(9_950);
    machine.inputs.drive.position = Position(10_050);
    assert_eq!(machine.first(300, |o| o.nck.channel.fault.interlock), None);
}

/// S840D-SIGNAL-018/a, S840D-NX-001: at n_x the signal may be different in the channels for ever. 20 mm/min are 4 um a cycle.
#[test]
fn threshold_may_differ_at_its_limit() {
    let mut machine = Machine::powered(&parameters(), false, None);
    for cycle in 1..300 {
        machine.inputs.nck.position.0 += 3;
        machine.inputs.drive.position.0 += if cycle % 2 == 0 { 4 } else { 2 };
        let outputs = machine.step();
        assert!(outputs.nck.sga.below_n_x);
        assert_eq!(outputs.drive.sga.below_n_x, cycle % 2 != 0);
        assert!(!outputs.nck.channel.fault.interlock);
    }
}

/// S840D-KDV-505/a, S840D-KDV-516, S840D-ALARM-718, S840D-P-33: a difference of the positions is displayed at once beyond
/// the tolerance (NCK only); STOP F comes with the next item made of positions. That is the position itself (item 2, code
/// 3), or, when it is just over, the first of the limits (item 41, code 44).
#[test]
fn positions_differ_beyond_the_tolerance() {
    for (from, found, code) in [(83, 84 + 2, Code::POSITION), (87, 84 + 41, Code::LIMITS)] {
        let mut machine = referenced(&parameters(), 0);
        machine.inputs.drive.position = Position(100);
        let outputs = machine.at(from - 1);
        assert!(outputs.nck.code.is_none() && outputs.nck.alarms.is_empty());
        machine.inputs.drive.position = Position(101);
        let _ = machine.at(from);
        let outputs = machine.at(from + 1);
        assert!(outputs.nck.alarms.contains(Alarm::StaticDifference));
        assert!(!outputs.drive.alarms.contains(Alarm::StaticDifference));
        let _ = machine.at(found - 1);
        let outputs = machine.step();
        assert_eq!(
            (outputs.nck.alarms.code(), outputs.drive.alarms.code()),
            (code, code)
        );
        assert_eq!(
            machine.first(300, |o| levels(o) == both(Level::B)),
            Some(found + 9)
        );
        // Not displayed while the axis is parked.
        assert!(machine.step().nck.alarms.contains(Alarm::StaticDifference));
        let parked = machine.once(|local| local.parking = true);
        assert!(!parked.nck.alarms.contains(Alarm::StaticDifference));
    }
}

/// S840D-STOP-007, S840D-KDV-506: a stop that one channel was told ends one cycle later there. That this is no discrepancy shows
/// where result list 1 is due just then.
#[test]
fn end_of_a_told_stop_is_no_discrepancy() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.sbh_sg_off = false);
    let _ = machine.at(72);
    machine.inputs.nck.position = Position(401);
    assert_eq!(levels(&machine.at(73)), (Level::C, Level::None));
    machine.inputs.nck.position = Position(0);
    let outputs = machine.at(82);
    assert!(outputs.nck.sga.sbh_active && !outputs.drive.sga.sbh_active);
    let _ = machine.step();
    let outputs = machine.at(84);
    assert!(outputs.nck.compare.suspended && outputs.drive.compare.suspended);
    assert!(outputs.nck.sga.sbh_active && outputs.drive.sga.sbh_active);
    assert_eq!(machine.first(300, |o| o.nck.channel.fault.interlock), None);
}

/// S840D-KDV-507, S840D-P-50: a signal of one channel changes again and again within t_chg. The other channel watches it for
/// 10 t_chg = 420 cycles and raises code 1000.
#[test]
fn endless_changes_are_found() {
    let mut machine = Machine::powered(&parameters(), false, None);
    let _ = machine.at(9);
    while machine.cycle < 431 {
        if machine.cycle % 40 == 10 {
            machine.inputs.nck.sge.sg_0 = !machine.inputs.nck.sge.sg_0;
        }
        let outputs = machine.step();
        assert!(!outputs.nck.channel.fault.interlock && !outputs.drive.channel.fault.interlock);
    }
    // Told in cycle 10, watched from cycle 11 on.
    let outputs = machine.at(431);
    assert_eq!(outputs.drive.code, Code::TOO_MANY_CHANGES);
    assert!(outputs.nck.code.is_none());
    assert!(machine.at(432).nck.alarms.contains(Alarm::CrossComparison));
}
