//! Worked cases of the brake test.

use super::*;

fn brake(kind: Kind) -> Brake {
    let sequence = Sequence {
        duration: Cycles::new(3),
        tolerance: Distance(10),
    };
    Brake {
        kind,
        ramp: Cycles::new(2),
        first: sequence,
        second: sequence,
    }
}

fn ready(kind: Kind) -> (Monitor, Inputs) {
    let (external, motor) = (Cycles::new(11), Cycles::new(1));
    let config = Config::new(brake(kind), brake(Kind::None), external, motor, motor);
    let mut monitor = Monitor::new(config.expect("accepted"));
    let mut inputs = Inputs {
        pulses: true,
        slow: true,
        load_known: true,
        ..Inputs::default()
    };
    monitor.step(&inputs);
    inputs.select = true;
    assert!(monitor.step(&inputs).selected);
    assert!(!monitor.step(&inputs).runs);
    inputs.start = true;
    assert!(monitor.step(&inputs).runs);
    (monitor, inputs)
}

/// S120-SBT-006, S120-SBT-010, Image 4-13: close, ramp, hold, ramp, open; the axis stays.
#[test]
fn a_motor_brake_holds() {
    let (mut monitor, mut inputs) = ready(Kind::Motor);
    for _ in 0..7 {
        assert!(monitor.step(&inputs).torque);
    }
    assert!(monitor.step(&inputs).runs);
    let outputs = monitor.step(&inputs);
    assert!(outputs.complete && outputs.successful && !outputs.close_motor);
    inputs.start = false;
    assert!(!monitor.step(&inputs).interrupted);
    inputs.start = true;
    assert!(monitor.step(&inputs).runs);
}

/// S120-SBT-008, S120-SBT-010: an external brake is waited for; one that slips has failed.
#[test]
fn an_external_brake_slips() {
    let (mut monitor, mut inputs) = ready(Kind::External);
    assert!(monitor.step(&inputs).close_external);
    inputs.external_closed = true;
    assert!(monitor.step(&inputs).torque);
    inputs.position = Position(11);
    assert!(!monitor.step(&inputs).close_external);
    inputs.external_closed = false;
    let outputs = monitor.step(&inputs);
    assert!(outputs.complete && !outputs.successful);
}

/// S120-SBT-008: one that does not close within its 11 s is a fault.
#[test]
fn an_external_brake_is_late() {
    let (mut monitor, inputs) = ready(Kind::External);
    for _ in 0..10 {
        assert!(!monitor.step(&inputs).late);
    }
    assert!(monitor.step(&inputs).late);
}

/// S120-SBT-002: at most one motor holding brake.
#[test]
fn two_motor_brakes_are_refused() {
    let time = Cycles::new(1);
    let both = Config::new(brake(Kind::Motor), brake(Kind::Motor), time, time, time);
    assert_eq!(both, Err(ConfigError::ValueOutOfRange));
}
