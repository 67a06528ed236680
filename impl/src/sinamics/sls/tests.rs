//! Worked cases of SLS.

use super::*;

const LIMITS: [Speed; 4] = [Speed(2000), Speed(1000), Speed(3000), Speed(2000)];

fn config(by_telegram: bool) -> Config {
    let responses = [Stop::C, Stop::A, Stop::B, Stop::D];
    let delay = Cycles::new(3);
    let made = Config::new(
        LIMITS,
        responses,
        delay,
        true,
        by_telegram,
        false,
        Slsd::Keep,
    );
    made.expect("accepted")
}

fn inputs(level: Level, speed: u32) -> Inputs {
    Inputs {
        selected: true,
        level,
        telegram: 32_767,
        speed: Speed(speed),
        ..Inputs::default()
    }
}

/// S120-SLS-006: the bits and their parameters.
#[test]
fn levels() {
    let levels = [(false, false), (false, true), (true, false), (true, true)];
    for (index, (bit1, bit0)) in levels.into_iter().enumerate() {
        let level = Level::from_bits(bit1, bit0);
        assert_eq!(usize::from(level.index()), index);
        assert_eq!(config(false).limit(level), LIMITS[index]);
    }
}

/// S120-SLS-001, S120-SLS-003, S120-SLS-004, S120-SLS-005: selection, a lower level, a higher one.
#[test]
fn levels_take_effect() {
    let mut monitor = Monitor::new(config(false));
    let second = Level::from_bits(false, true);
    for _ in 0..3 {
        assert!(!monitor.step(&inputs(Level::FIRST, 9999)).active);
    }
    assert!(!monitor.step(&inputs(Level::FIRST, 2000)).violated);
    assert_eq!(monitor.step(&inputs(Level::FIRST, 2001)).demand, Stop::C);
    for _ in 0..3 {
        assert_eq!(monitor.step(&inputs(second, 1500)).limit, Speed(2000));
    }
    assert_eq!(monitor.step(&inputs(second, 1001)).demand, Stop::A);
    let third = Level::from_bits(true, false);
    assert_eq!(monitor.step(&inputs(third, 3000)).limit, Speed(3000));
}

/// S120-SLS-009: half of 32767 is half of the limit, rounded down; 0 and less are wrong.
#[test]
fn the_limit_of_the_telegram() {
    let mut monitor = Monitor::new(config(true));
    for _ in 0..4 {
        monitor.step(&inputs(Level::FIRST, 0));
    }
    let mut with = |telegram| {
        let inputs = Inputs {
            telegram,
            ..inputs(Level::FIRST, 0)
        };
        monitor.step(&inputs)
    };
    assert_eq!(with(32_767).limit, Speed(2000));
    for _ in 0..3 {
        assert_eq!(with(16_384).limit, Speed(2000));
    }
    assert_eq!(with(16_384).limit, Speed(1000));
    for wrong in [0, -1, i16::MIN] {
        let outputs = with(wrong);
        assert!(outputs.wrong_value && outputs.demand == Stop::C && outputs.limit == Speed(1000));
    }
}
