//! Tests of the shutdown paths.

use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::level::Level;

use crate::machine::{Machine, both, levels, parameters};

/// S840D-TEST-009, S840D-TEST-015, S840D-TEST-005, S840D-P-17: both shutdown paths are tested one after the other; the
/// test of one channel does not act in the other; the interval starts when both have passed.
#[test]
fn both_paths_are_tested() {
    let mut machine = Machine::powered(&parameters(), false, None);
    assert!(machine.step().nck.forced_check.due);
    let _ = machine.at(9);
    machine.inputs.nck.sge.test_stop = true;
    let outputs = machine.at(10);
    assert_eq!(levels(&outputs), (Level::Test, Level::None));
    assert!(outputs.nck.alarms.contains(Alarm::TestStop));
    assert!(!outputs.nck.channel.pulses.enable && outputs.drive.channel.pulses.enable);
    machine.both(|local| local.feedback = true);
    let _ = machine.at(12);
    machine.inputs.nck.sge.test_stop = false;
    assert!(machine.at(18).nck.channel.test.active);
    let outputs = machine.at(19);
    assert!(outputs.nck.channel.test.passed && outputs.nck.channel.pulses.enable);
    assert!(outputs.nck.forced_check.half && !outputs.drive.forced_check.half);
    machine.both(|local| local.feedback = false);
    let outputs = machine.at(20);
    assert!(outputs.drive.forced_check.half && outputs.drive.forced_check.due);

    let _ = machine.at(29);
    machine.inputs.drive.sge.test_stop = true;
    assert_eq!(levels(&machine.at(30)), (Level::None, Level::Test));
    machine.inputs.drive.feedback = true;
    let _ = machine.at(45);
    machine.inputs.drive.sge.test_stop = false;
    let outputs = machine.at(46);
    assert!(outputs.drive.forced_check.tested && !outputs.drive.forced_check.due);
    machine.inputs.drive.feedback = false;
    let outputs = machine.at(47);
    assert!(outputs.nck.forced_check.tested && !outputs.nck.forced_check.due);

    // A test that fails in one channel counts for neither path, in both channels.
    let _ = machine.at(49);
    machine.inputs.nck.sge.test_stop = true;
    assert!(!machine.at(58).nck.forced_check.due);
    let outputs = machine.at(59);
    assert!(outputs.nck.forced_check.due && !outputs.drive.forced_check.due);
    let outputs = machine.at(60);
    assert!(outputs.drive.forced_check.due && !outputs.drive.forced_check.half);
}

/// S840D-TEST-012, S840D-P-29: without feedback the test ends in STOP A in both channels, code 1009.
#[test]
fn failed_test_stops_both_channels() {
    let mut machine = Machine::powered(&parameters(), false, None);
    let _ = machine.at(9);
    machine.inputs.drive.sge.test_stop = true;
    assert_eq!(levels(&machine.at(18)), (Level::None, Level::Test));
    let outputs = machine.at(19);
    assert_eq!(levels(&outputs), (Level::None, Level::A));
    assert_eq!(outputs.drive.alarms.code(), Code::TEST_FAILED);
    assert!(outputs.drive.alarms.contains(Alarm::StopA));
    assert_eq!(levels(&machine.at(20)), both(Level::A));
}

/// S840D-TEST-016, S840D-TEST-017: the test of the external shutdown without feedback: code 1010 and STOP A. The drive
/// has no such test.
#[test]
fn failed_external_test_stops() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.shutdown_test_select = false);
    let _ = machine.at(9);
    machine.both(|local| local.shutdown_test_select = true);
    let outputs = machine.at(10);
    assert!(outputs.nck.shutdown_test.active && !outputs.drive.shutdown_test.active);
    assert!(!outputs.nck.channel.pulses.enable_external && outputs.nck.channel.pulses.enable);
    assert!(outputs.nck.alarms.contains(Alarm::ExternalTest));
    let outputs = machine.at(19);
    assert_eq!(levels(&outputs), (Level::A, Level::None));
    assert_eq!(outputs.nck.alarms.code(), Code::EXTERNAL_TEST_FAILED);
    assert_eq!(levels(&machine.at(20)), both(Level::A));
}

/// S840D-TEST-025: with STOP A latched no test of the external shutdown starts.
#[test]
fn no_external_test_under_stop_a() {
    let mut machine = Machine::powered(&parameters(), false, None);
    machine.both(|local| local.sge.test_stop = true);
    assert_eq!(levels(&machine.at(10)), both(Level::A));
    machine.both(|local| local.shutdown_test_select = true);
    let outputs = machine.at(11);
    assert!(!outputs.nck.shutdown_test.active && outputs.nck.channel.pulses.enable_external);
}
