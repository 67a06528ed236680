//! Reference, agreement and what needs a safe position.

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::fault::FaultState;
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::sinumerik::reference::AxisState;

use crate::machine::{Machine, both, levels, move_to, parameters, reference, referenced};

/// S840D-REF-003, S840D-REF-004, S840D-REF-007: power-up with stored agreement; the axis is safely referenced once both
/// channels have compared with the history, without the user.
#[test]
fn stored_agreement_is_verified() {
    let mut machine = Machine::powered(&parameters(), true, Some(1_000));
    assert_eq!(machine.step().nck.reference.axis, AxisState::NotRef);
    // The tolerance is 10 um: at the tolerance the agreement is kept.
    machine.both(|local| reference(local, 1_010));
    let outputs = machine.step();
    assert_eq!(outputs.nck.reference.axis, AxisState::Ref);
    assert!(!outputs.nck.sga.safely_referenced);
    assert!(outputs.nck.alarms.contains(Alarm::NotSafelyReferenced));
    // Each channel compares, and tells the other one.
    let outputs = machine.step();
    assert!(!outputs.nck.sga.safely_referenced && !outputs.drive.sga.safely_referenced);
    let outputs = machine.step();
    assert!(outputs.nck.sga.safely_referenced && outputs.drive.sga.safely_referenced);
    assert!(outputs.nck.alarms.is_empty());
}

/// S840D-UA-003/c, S840D-REF-008, S840D-STOP-061, S840D-STOP-063: the axis was moved while switched off. Code 1003, the agreement is
/// lost, STOP F, and after t_F STOP B in both channels, because limit switches are enabled.
#[test]
fn moved_while_switched_off() {
    let mut machine = Machine::powered(&parameters(), true, Some(1_000));
    machine.both(|local| reference(local, 1_011));
    assert_eq!(machine.step().nck.reference.axis, AxisState::Ref);
    let outputs = machine.step();
    for axis in [outputs.nck, outputs.drive] {
        assert_eq!(axis.alarms.code(), Code::AGREEMENT_POSITION);
        assert!(!axis.agreement.agreed && !axis.sga.safely_referenced);
        assert_eq!(axis.channel.fault.fault, FaultState::Delay);
    }
    assert_eq!(
        machine.first(99, |o| levels(o) == both(Level::B)),
        Some(2 + 9)
    );
}

/// S840D-GEAR-505, S840D-P-37: a new gear stage withdraws agreement and safe reference in the same cycle in both channels.
#[test]
fn gear_change_withdraws_the_agreement() {
    let mut machine = referenced(&parameters(), 0);
    let _ = machine.at(9);
    machine.both(|local| local.sge.gear_0 = true);
    let outputs = machine.at(10);
    for axis in [outputs.nck, outputs.drive] {
        assert!(axis.gear.changed && axis.agreement.withdrawn && !axis.sga.safely_referenced);
        assert_eq!(axis.reference.axis, AxisState::Ref);
        assert!(axis.code.is_none());
    }
    // The user agrees again with the key switch; both channels know of each other one cycle later.
    let outputs = machine.once(|local| {
        local.set_agreement = true;
        local.key = true;
    });
    assert!(outputs.nck.agreement.agreed && !outputs.nck.sga.safely_referenced);
    assert!(machine.step().nck.sga.safely_referenced);
}

/// S840D-INTERACT-719, S840D-REF-016, S840D-INTERACT-718: parking freezes the position and takes the safe reference; after a new reference approach the
/// stored position decides.
#[test]
fn parking_takes_the_reference() {
    let quiet = Parameters {
        park_alarm_suppress: true,
        ..parameters()
    };
    let mut machine = referenced(&quiet, 5_000);
    let _ = machine.at(9);
    machine.both(|local| {
        local.parking = true;
        local.referenced = false;
        local.position = Position(-77_000);
    });
    let outputs = machine.at(10);
    for axis in [outputs.nck, outputs.drive] {
        assert!(!axis.sga.safely_referenced && axis.agreement.agreed);
        assert_eq!(axis.reference.axis, AxisState::NotRef);
        assert_eq!(axis.position, Position(5_000));
        assert!(axis.alarms.is_empty());
    }
    let _ = machine.at(200);
    machine.both(|local| {
        local.parking = false;
        reference(local, 5_009);
    });
    assert_eq!(machine.at(201).nck.reference.axis, AxisState::Ref);
    let outputs = machine.at(203);
    assert!(outputs.nck.sga.safely_referenced && outputs.nck.code.is_none());
}

/// S840D-UA-003/b, S840D-UA-003/c, S840D-UA-003/d: parked and moved further than MD36944 the axis loses its agreement when it is
/// referenced again, and the user gives it anew; a smaller change leaves it.
#[test]
fn parking_takes_the_agreement_beyond_the_tolerance_only() {
    for (position, kept) in [(5_009, true), (6_000, false)] {
        let quiet = Parameters {
            park_alarm_suppress: true,
            ..parameters()
        };
        let mut machine = referenced(&quiet, 5_000);
        let _ = machine.at(9);
        machine.both(|local| {
            local.parking = true;
            local.referenced = false;
        });
        assert!(machine.at(20).nck.agreement.agreed, "parking alone");
        machine.both(|local| {
            local.parking = false;
            reference(local, position);
        });
        let outputs = machine.at(25);
        for axis in [outputs.nck, outputs.drive] {
            assert_eq!(axis.agreement.agreed, kept, "{position}");
            assert_eq!(axis.sga.safely_referenced, kept, "{position}");
        }
        let _ = machine.once(|local| {
            local.key = true;
            local.set_agreement = true;
        });
        let outputs = machine.at(30);
        assert!(outputs.nck.agreement.agreed && outputs.nck.sga.safely_referenced);
    }
}

/// S840D-SN-007, S840D-SN-008, S840D-P-32: with synchronisation the cam signal needs both channels, so it is one cycle
/// late, and has a hysteresis.
#[test]
fn cams_are_synchronised() {
    let mut machine = referenced(&parameters(), 9_900);
    machine.both(move_to(10_100));
    assert!(!machine.at(10).nck.sga.sn_1_plus);
    machine.both(move_to(10_101));
    assert!(!machine.at(11).nck.sga.sn_1_plus);
    let outputs = machine.at(12);
    assert!(outputs.nck.sga.sn_1_plus && outputs.drive.sga.sn_1_plus);
    // Back into the hysteresis it stays, at the cam it goes, at once.
    machine.both(move_to(10_001));
    assert!(machine.at(20).nck.sga.sn_1_plus);
    machine.both(move_to(10_000));
    assert!(!machine.at(21).nck.sga.sn_1_plus);
    // Only one channel is beyond the cam.
    machine.inputs.nck.position = Position(10_101);
    let outputs = machine.at(30);
    assert!(!outputs.nck.sga.sn_1_plus && !outputs.drive.sga.sn_1_plus);
}

/// S840D-SE-003, S840D-SE-004, S840D-P-12, S840D-P-49: a limit switch stops with the agreement, and not without.
#[test]
fn limit_switches_need_the_agreement() {
    let near = Parameters {
        pos_limit_plus: [1_000, 2_000],
        ..parameters()
    };
    let mut machine = referenced(&near, 900);
    machine.both(move_to(1_000));
    assert_eq!(levels(&machine.at(9)), both(Level::None));
    machine.both(move_to(1_001));
    let outputs = machine.at(10);
    assert_eq!(levels(&outputs), both(Level::C));
    assert!(outputs.nck.alarms.contains(Alarm::EndStop));

    // The other pair reaches further: the way out.
    let mut machine = referenced(&near, 900);
    machine.both(|local| local.sge.se = true);
    machine.both(move_to(2_000));
    assert_eq!(levels(&machine.at(10)), both(Level::None));
    machine.both(move_to(2_001));
    assert_eq!(levels(&machine.at(11)), both(Level::C));

    let mut machine = Machine::powered(&near, false, None);
    machine.both(move_to(1_001));
    assert_eq!(levels(&machine.at(10)), both(Level::None));
}

/// S840D-REF-009, S840D-PWR-001, A-23: the position is stored in the operating stop, and cyclically with limit switches or cams; not
/// before the axis is referenced.
#[test]
fn position_is_stored() {
    let stored = |machine: &Machine| machine.state().drive.history.standstill;
    let mut machine = referenced(&parameters(), 5_000);
    machine.both(move_to(5_400));
    let _ = machine.step();
    assert_eq!(stored(&machine), Position(5_400));

    let only_sbh = Parameters {
        function_enable: 1,
        ..parameters()
    };
    let mut machine = referenced(&only_sbh, 5_000);
    machine.both(move_to(5_400));
    let _ = machine.at(9);
    assert_eq!(stored(&machine), Position(5_000));
    machine.both(|local| local.sge = Sge::UNUSED);
    let _ = machine.at(11);
    assert_eq!(stored(&machine), Position(5_400));

    // The operating stop of an axis that is not referenced stores nothing.
    let mut machine = Machine::powered(&only_sbh, true, Some(7));
    machine.both(|local| local.sge = Sge::UNUSED);
    machine.both(move_to(5_400));
    let _ = machine.at(20);
    assert_eq!(stored(&machine), Position(7));
}

/// S840D-REF-004, S840D-REF-015: the check is made in the drive and in the NCK. Where it fails in one of them the axis is
/// safely referenced in neither, not even for a cycle, whichever is referenced first.
#[test]
fn a_failed_comparison_in_one_channel_counts_for_both() {
    for (fails_in_the_drive, delay_nck, delay_drive) in [
        (true, 1, 1),
        (false, 1, 1),
        (true, 1, 3),
        (true, 3, 1),
        (false, 1, 3),
        (false, 3, 1),
    ] {
        let mut machine = Machine::powered(&parameters(), true, Some(1_000));
        for cycle in 1..40 {
            for (local, delay, fails) in [
                (&mut machine.inputs.nck, delay_nck, !fails_in_the_drive),
                (&mut machine.inputs.drive, delay_drive, fails_in_the_drive),
            ] {
                if cycle > delay {
                    reference(local, if fails { 1_011 } else { 1_010 });
                }
            }
            let out = machine.step();
            assert!(
                !out.nck.sga.safely_referenced && !out.drive.sga.safely_referenced,
                "cycle {cycle}, fails in the drive: {fails_in_the_drive}, {delay_nck}, {delay_drive}"
            );
        }
    }
}

/// S840D-REF-002, S840D-REF-003: referencing sets the position anew. An axis that stands in SG1 or SBH has not moved, and one
/// that moves is not taken for one that stands: its speed stays what it was.
#[test]
fn referencing_is_no_motion() {
    for operating_stop in [true, false] {
        let mut machine = Machine::powered(&parameters(), false, None);
        machine.both(|local| {
            local.sge.sbh_sg_off = false;
            local.sge.sbh_off = !operating_stop;
            local.position = Position(300);
        });
        let _ = machine.at(20);
        machine.both(|local| reference(local, 750_000));
        for cycle in 21..200 {
            let out = machine.step();
            assert_eq!(levels(&out), both(Level::None), "cycle {cycle}");
            assert!(!out.nck.alarms.contains(Alarm::Standstill), "cycle {cycle}");
            assert!(!out.nck.alarms.contains(Alarm::SpeedLimit), "cycle {cycle}");
        }
        // The window lies around the new position: 1 mm.
        if operating_stop {
            assert_eq!(levels(&machine.once(move_to(751_000))), both(Level::None));
            let out = machine.once(move_to(751_001));
            assert!(out.nck.alarms.contains(Alarm::Standstill));
        }
    }

    let mut machine = Machine::powered(&parameters(), false, None);
    for cycle in 1..40 {
        let way = cycle * 300;
        machine.both(|local| local.position = Position(way));
        if cycle >= 20 {
            machine.both(|local| reference(local, 500_000 + way));
        }
        let out = machine.step();
        let speed = if cycle == 1 {
            300
        } else {
            out.nck.channel.motion.speed.0
        };
        assert_eq!(speed, 300, "cycle {cycle}");
    }
}
