//! Tests of the shutdown paths.

use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::level::Level;

use stillpoint_monitors::sinumerik::shutdown_group;

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

/// S840D-TEST-018, S840D-TEST-016: the test selected at one axis runs at every axis of the output, shows 27006 there, and
/// finds the dead terminal of another axis; an axis of another output is left alone.
#[test]
fn the_external_test_covers_every_axis_of_the_output() {
    let mut axes: [Machine; 4] =
        std::array::from_fn(|_| Machine::powered(&parameters(), false, None));
    let outputs = [0x0101, 0x0101, 0x0101, 0x0201];
    // The terminal of the third axis is not wired.
    let sound = [true, true, false, true];
    let mut enabled = [true; 4];
    for cycle in 1..=30 {
        let selections = [false, (10..25).contains(&cycle), false, false];
        let tests = shutdown_group::selected(&outputs, &selections);
        let mut enables = [true; 4];
        for (k, axis) in axes.iter_mut().enumerate() {
            axis.inputs.nck.shutdown_test_select = tests[k];
            let off = sound[k] && !enabled[k];
            axis.both(|local| local.feedback = off);
            let out = axis.step();
            enables[k] = out.nck.channel.pulses.enable_external;
            let runs = k < 3 && (10..19).contains(&cycle) || k < 2 && (19..25).contains(&cycle);
            assert_eq!(
                out.nck.alarms.contains(Alarm::ExternalTest),
                runs,
                "axis {k}, cycle {cycle}"
            );
            assert_eq!(
                out.nck.alarms.code() == Code::EXTERNAL_TEST_FAILED,
                k == 2 && cycle == 19,
                "axis {k}, cycle {cycle}"
            );
            let stopped = k == 2 && cycle >= 19;
            assert_eq!(
                out.nck.channel.stop.level == Level::A,
                stopped,
                "axis {k}, cycle {cycle}"
            );
            assert_eq!(
                out.nck.shutdown_test.passed,
                k < 2 && cycle == 25,
                "axis {k}, cycle {cycle}"
            );
        }
        enabled = shutdown_group::enabled(&outputs, &enables);
    }
}

/// S840D-TEST-019/a, S840D-TEST-019/b: an external stop under a test that lasts longer than t_chg is code 58 in both channels; the stop itself
/// goes on. A test shorter than t_chg, and one without a stop, raise nothing.
#[test]
fn an_external_stop_under_the_external_test_is_code_58() {
    let run = |selected: std::ops::Range<u32>, stop: bool| {
        let mut machine = Machine::powered(&parameters(), false, None);
        if stop {
            machine.both(|local| local.sge.stop_c_off = false);
        }
        let mut codes = (None, None);
        for cycle in 1..400 {
            machine.inputs.nck.shutdown_test_select = selected.contains(&cycle);
            let active = machine.state().nck.shutdown_test.active();
            machine.both(|local| local.feedback = active);
            let out = machine.step();
            assert_eq!(
                levels(&out),
                both(if stop { Level::C } else { Level::None }),
                "cycle {cycle}"
            );
            let found = |alarms: stillpoint_monitors::sinumerik::alarm::Alarms| {
                (alarms.contains(Alarm::CrossComparison) && !alarms.code().is_none())
                    .then(|| (cycle, alarms.code().number()))
            };
            codes.0 = codes.0.or(found(out.nck.alarms));
            codes.1 = codes.1.or(found(out.drive.alarms));
        }
        codes
    };
    // t_chg is 42 cycles, a pass of the list 84.
    let (nck, drive) = run(100..390, true);
    for found in [nck, drive] {
        let (cycle, code) = found.expect("the alarm comes");
        assert_eq!(code, 58);
        assert!((142..=142 + 2 + 84).contains(&cycle), "{cycle}");
    }
    assert_eq!(run(100..390, false), (None, None));
    assert_eq!(run(100..140, true), (None, None));
}
