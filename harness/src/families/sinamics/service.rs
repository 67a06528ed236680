//! What a channel does beside its functions: the test stops, and the safe brake test.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::{brake_test, brake_test_request, drive_test, path_test};

use super::signals::{Flag, Read};
use super::values::Values;

/// The monitors.
pub(super) struct Service {
    paths: Option<path_test::Monitor>,
    drive: Option<drive_test::Monitor>,
    brake: Option<brake_test::Monitor>,
    /// What asks for the test stop, and for the brake test before it.
    request: brake_test_request::Monitor,
    /// What the brake test told in the cycle before.
    tested: brake_test::Outputs,
    /// Cycles for which the axis has stood since the brake test was selected: the load is measured then.
    stands: u32,
}

/// What they read beside the bits.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub power_on: bool,
    pub position: Position,
    pub speed: Speed,
    /// STO or SS1 is selected.
    pub selected: bool,
    /// Something but a test asks for STO.
    pub off: bool,
    /// A function stops the axis, or a stop is latched.
    pub stops: bool,
    /// The Extended Functions keep the pulses off.
    pub held: bool,
    /// The drive has its pulses.
    pub pulses: bool,
    /// The switch-off paths of both channels have suppressed them.
    pub paths_off: [bool; 2],
    /// That of this channel has not.
    pub path_error: bool,
    /// Safety telegrams come.
    pub valid: bool,
}

/// What they tell.
#[derive(Clone, Copy)]
pub(super) struct Told {
    /// A test of the switch-off paths is due: A01699.
    pub path_due: bool,
    /// A test stop is due: A01697.
    pub due: bool,
    /// It runs: STO.
    pub tests: bool,
    pub failed: bool,
    pub brake: brake_test::Outputs,
    /// With the sign of the torque.
    pub negative: bool,
    /// How much of the torque of the brake test is built up: cycles of so many.
    pub share: [u32; 2],
}

impl Default for Told {
    fn default() -> Self {
        Self {
            path_due: false,
            due: false,
            tests: false,
            failed: false,
            brake: brake_test::Outputs::default(),
            negative: false,
            share: [0, 1],
        }
    }
}

impl Service {
    /// At POWER ON, or as long after the last tests as no one would be due.
    pub(super) fn new(values: &Values, running: bool) -> Self {
        let paths = |config: path_test::Config| {
            let mut monitor = path_test::Monitor::new(config);
            if running {
                // A test that was passed.
                let _ = monitor.step(&path_test::Inputs {
                    passed: true,
                    ..path_test::Inputs::default()
                });
            }
            monitor
        };
        let drive = |config: drive_test::Config| {
            let mut monitor = drive_test::Monitor::new(config);
            let inputs = drive_test::Inputs {
                allowed: true,
                ..drive_test::Inputs::default()
            };
            if running {
                // Asked for, and passed.
                for (request, pulses_off) in [(false, false), (true, false), (false, true)] {
                    let _ = monitor.step(&drive_test::Inputs {
                        request,
                        pulses_off,
                        ..inputs
                    });
                }
            }
            monitor
        };
        Self {
            paths: values.path_test.map(paths),
            drive: values.drive_test.map(drive),
            brake: values.brake_test.map(brake_test::Monitor::new),
            request: brake_test_request::Monitor::new(values.test_request),
            tested: brake_test::Outputs::default(),
            stands: 0,
        }
    }

    /// One cycle.
    pub(super) fn step(&mut self, values: &Values, read: &Read, seen: &Seen) -> Told {
        let mut told = Told::default();
        let mut passed = false;
        let before = self.tested;
        let under_way = self.request.state().phase != brake_test_request::Phase::Idle;
        let request = self.request.step(&brake_test_request::Inputs {
            request: read.is(Flag::TestStop),
            // The drive's own test asks at POWER ON, and tests no brake then (AF-11).
            automatic: false,
            ready: before.ready,
            complete: before.complete,
            ended: under_way
                && (!before.selected || before.refused || before.interrupted || before.late),
        });
        if let Some(drive) = &mut self.drive {
            let said = drive.step(&drive_test::Inputs {
                power_on: seen.power_on,
                request: request.test_stop,
                stop: seen.off,
                allowed: read.is(Flag::PoweredUp) && !seen.stops,
                pulses_off: seen.paths_off == [true; 2],
                path_error: false,
                disturbed: !seen.valid,
            });
            (told.due, told.tests, told.failed) = (said.due, said.sto, said.failed);
            passed = said.passed;
        }
        if let Some(paths) = &mut self.paths {
            let said = paths.step(&path_test::Inputs {
                power_on: seen.power_on,
                selected: seen.selected,
                test_stop: told.tests,
                passed,
                activated: false,
                path_error: seen.path_error,
                extended_sto: seen.held,
            });
            told.path_due = said.due;
        }
        if let Some(brake) = &mut self.brake {
            // With p10203 = 2 the test stop alone asks for it.
            let (select, start, choice) = match values.test_request.by_test_stop {
                true => (request.select, request.start, request.choice),
                false => (
                    read.is(Flag::BrakeTest),
                    read.is(Flag::BrakeTestStart),
                    brake_test::Choice {
                        second_brake: read.is(Flag::SecondBrake),
                        negative: read.is(Flag::NegativeTorque),
                        second_sequence: read.is(Flag::SecondSequence),
                    },
                ),
            };
            self.stands = match select && seen.speed == Speed(0) {
                true => self.stands.saturating_add(1),
                false => 0,
            };
            told.brake = brake.step(&brake_test::Inputs {
                select,
                start,
                choice,
                external_closed: read.is(Flag::ExternalClosed),
                pulses: seen.pulses,
                slow: seen.speed <= values.slow,
                load_known: self.stands >= values.measuring,
                stop: seen.stops || seen.off || told.tests,
                position: seen.position,
            });
            self.tested = told.brake;
            let state = brake.state();
            told.negative = state.choice.negative;
            let ramp = values.test_ramps[usize::from(state.choice.second_brake)];
            let left = state.left.count();
            let done = match state.phase {
                brake_test::Phase::RampUp => ramp.saturating_sub(left),
                brake_test::Phase::Hold => ramp,
                brake_test::Phase::RampDown => left,
                _ => 0,
            };
            told.share = [done.min(ramp), ramp.max(1)];
        }
        told
    }
}
