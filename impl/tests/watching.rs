//! The examples of the manual for the monitors of position and speed, and what their configurations refuse.

use core::num::NonZeroU32;

use stillpoint_monitors::kernel::{ConfigError, Cycles, Distance, Position, Speed};

use stillpoint_monitors::sinumerik::level::InternalStop;
use stillpoint_monitors::sinumerik::selection::{FactorIndex, Monitored, Stage};
use stillpoint_monitors::sinumerik::{
    cam, limit_switch, motion, ramp, results, selection, setpoint, speed, standstill,
};
use stillpoint_monitors::units::{Axis, ModuloRange, Scale};

/// Millimetres per minute in a monitoring cycle of 12 ms.
fn mm_per_min(value: u32) -> Speed {
    let cycle = NonZeroU32::new(12_000).expect("not zero");
    Scale::new(Axis::Linear, cycle)
        .and_then(|scale| scale.speed(value))
        .expect("small")
}

/// Section 5.5.5: limits of 1000, 2000, 4000, 5000 mm/min and factors of 100, 80, 50, 30 % by two override signals.
#[test]
fn override_of_the_speed_limits() {
    let mut factors = [100; 16];
    factors[1] = 80;
    factors[2] = 50;
    factors[3] = 30;
    let limits = [1000, 2000, 4000, 5000].map(mm_per_min);
    let config = selection::Config::new(true, Cycles::new(2), limits)
        .and_then(|config| config.with_override(factors))
        .expect("plausible");
    let mut monitor = selection::Monitor::new(config);
    let select = |stage, bit1, bit0| selection::Inputs {
        sge_sbh: true,
        sg_select: stage,
        over: FactorIndex::from_bits(false, false, bit1, bit0),
        ..Default::default()
    };
    // S840D-SG-005: from no selection at once; 2000 mm/min is 0.4 mm per cycle, 80 % of it 0.32 mm.
    assert_eq!(
        monitor.step(&select(Stage::Sg2, false, true)).limit,
        Speed(320)
    );
    // S840D-OVR-003: down after the delay, up at once.
    let half = select(Stage::Sg2, true, false);
    assert_eq!(monitor.step(&half).limit, Speed(320));
    assert_eq!(monitor.step(&half).limit, Speed(320));
    assert_eq!(monitor.step(&half).limit, Speed(200));
    assert_eq!(
        monitor.step(&select(Stage::Sg2, false, false)).limit,
        Speed(400)
    );
    // SG1 is as low as half of SG2, whatever the override signals say: equal limits change at once.
    assert_eq!(monitor.step(&half).mode, selection::Mode::SgDown);
    assert_eq!(monitor.step(&half).mode, selection::Mode::SgDown);
    assert_eq!(monitor.step(&half).limit, Speed(200));
    let lowest = monitor.step(&select(Stage::Sg1, true, true));
    assert_eq!((lowest.limit, lowest.sga_sg), (Speed(200), Stage::Sg1));
    assert_eq!(
        monitor.step(&select(Stage::Sg4, true, true)).limit,
        Speed(300)
    );
}

/// Section 5.7.2: the cams at 300 and 600 mm select the limits 1000, 2000, 4000 mm/min of three ranges.
#[test]
fn ranges_by_cams() {
    let [mut first, mut second] = [300_000, 600_000].map(|at| {
        cam::Monitor::new(
            cam::Config::new(
                true,
                Position(at),
                Distance(100),
                true,
                ModuloRange::LINEAR,
                Distance(100),
            )
            .expect("plausible"),
        )
    });
    let mut stage_at = |millimetres: i32| {
        let inputs = cam::Inputs {
            position: Position(millimetres * 1000),
            other: true,
            ..Default::default()
        };
        let (minus, plus) = (first.step(&inputs).sga, second.step(&inputs).sga);
        Stage::from_bits(minus, plus)
    };
    assert_eq!(stage_at(0), Stage::Sg1);
    assert_eq!(stage_at(300), Stage::Sg1);
    assert_eq!(stage_at(301), Stage::Sg3);
    assert_eq!(stage_at(600), Stage::Sg3);
    assert_eq!(stage_at(601), Stage::Sg4);
    assert_eq!(stage_at(600), Stage::Sg3);
    assert_eq!(stage_at(-1), Stage::Sg1);
}

/// Section 5.8: the limit follows a braking axis down, and an axis that starts again is caught.
#[test]
fn braking_ramp_catches_an_axis_that_starts_again() {
    let config = ramp::Config::new(mm_per_min(20), mm_per_min(300)).expect("small");
    let mut monitor = ramp::Monitor::new(config);
    let mut step = |on, speed| {
        let outputs = monitor.step(&ramp::Inputs {
            on,
            speed: Speed(speed),
            ..Default::default()
        });
        (outputs.limit.0, outputs.frozen, outputs.demand)
    };
    // 300 mm/min are 60 um per cycle, 20 mm/min 4 um.
    assert_eq!(step(false, 400), (460, false, InternalStop::None));
    assert_eq!(step(true, 450), (460, false, InternalStop::None));
    assert_eq!(step(true, 300), (360, false, InternalStop::None));
    assert_eq!(step(true, 360), (360, false, InternalStop::None));
    assert_eq!(step(true, 3), (64, true, InternalStop::None));
    assert_eq!(step(true, 64), (64, true, InternalStop::None));
    assert_eq!(step(true, 65), (64, true, InternalStop::A));
    assert_eq!(step(false, 65), (125, false, InternalStop::None));
}

/// S840D-SE-005, -009: an axis beyond an end stays stopped until the other pair is selected or the agreement withdrawn.
#[test]
fn the_way_out_of_a_limit_switch() {
    let config = limit_switch::Config::new(
        true,
        [Position(100), Position(200)],
        [Position(-100), Position(-200)],
        3,
    )
    .expect("plausible");
    let mut monitor = limit_switch::Monitor::new(config);
    let mut demand = |active, select, position| {
        let inputs = limit_switch::Inputs {
            active,
            select,
            position: Position(position),
        };
        monitor.step(&inputs).demand
    };
    assert_eq!(demand(true, false, 100), InternalStop::None);
    assert_eq!(demand(true, false, 101), InternalStop::D);
    assert_eq!(demand(true, false, 101), InternalStop::D);
    assert_eq!(demand(true, true, 101), InternalStop::None);
    assert_eq!(demand(true, true, -201), InternalStop::D);
    assert_eq!(demand(false, true, -201), InternalStop::None);
}

/// S840D-TIMING-512 with the example of the manual: 0.4 mm per cycle are permitted, no more, in either direction.
#[test]
fn speed_as_movement_in_a_cycle() {
    let config = speed::Config::new(5, [0, 1, 2, 14], None).expect("plausible");
    let mut actual = motion::Monitor::new(motion::Config);
    let mut limit = speed::Monitor::new(config);
    let mut step = |position, stage| {
        let actual = actual.step(&motion::Inputs {
            position: Position(position),
            ..Default::default()
        });
        let outputs = limit.step(&speed::Inputs {
            monitored: Monitored::Speed,
            speed: actual.speed,
            limit: mm_per_min(2000),
            stage,
            encoder_speed: Speed(0),
        });
        outputs.demand
    };
    // The first position has no predecessor.
    assert_eq!(step(5_000_000, Stage::Sg1), InternalStop::None);
    assert_eq!(step(5_000_400, Stage::Sg1), InternalStop::None);
    assert_eq!(step(5_000_801, Stage::Sg1), InternalStop::A);
    assert_eq!(step(5_000_400, Stage::Sg2), InternalStop::B);
    assert_eq!(step(5_000_801, Stage::Sg3), InternalStop::C);
    assert_eq!(step(5_000_400, Stage::Sg4), InternalStop::E);
    assert_eq!(step(5_000_000, Stage::Sg4), InternalStop::None);
}

/// S840D-KDV-515: the lists have the bits of the machine data 1391 to 1394.
#[test]
fn result_lists_have_the_bits_of_the_machine_data() {
    let mut cams = [false; 8];
    cams[0] = true;
    cams[7] = true;
    let mut monitor =
        results::Monitor::new(results::Config::new(cams, true, true).expect("always"));
    let outputs = monitor.step(&results::Inputs {
        monitored: Monitored::Speed,
        stage: Stage::Sg3,
        speed_violated: true,
        se_watched: true,
        se_select: true,
        se_lower: true,
        cams,
        below: true,
        ..Default::default()
    });
    assert_eq!(outputs.list_1.bits(), 0b00_11_00_00_10_00_00);
    assert_eq!(outputs.list_2.bits(), 0b01_01_01_11_00_00_00_00_00_00_11);
    let outputs = monitor.step(&results::Inputs {
        monitored: Monitored::Standstill,
        standstill_upper: true,
        ..Default::default()
    });
    assert_eq!(outputs.list_1.bits(), 0b11);
    assert_eq!(outputs.list_2.bits(), 0b01_10_11_01_00_00_00_00_00_00_01);
}

/// What the manual calls a parameter error is refused: S840D-STOP-087, S840D-PARAM-735 among them.
#[test]
fn implausible_configurations_are_refused() {
    let refused = |result: Result<cam::Config, ConfigError>| result.err();
    let turn = ModuloRange::from_degrees(360).expect("a multiple");
    let at = |cam, sync, enabled| {
        refused(cam::Config::new(
            enabled,
            Position(cam),
            Distance(100),
            sync,
            turn,
            Distance(10),
        ))
    };
    // S840D-SN-010: lower + POS_TOL <= cam, upper - POS_TOL (- CAM_TOL) > cam, with 359.999 as lower modulo value.
    assert_eq!(at(9, false, true), None);
    assert_eq!(at(8, false, true), Some(ConfigError::CamNearModuloLimit));
    assert_eq!(at(8, false, false), None);
    assert_eq!(at(359_989, false, true), None);
    assert_eq!(
        at(359_990, false, true),
        Some(ConfigError::CamNearModuloLimit)
    );
    assert_eq!(at(359_889, true, true), None);
    assert_eq!(
        at(359_890, true, true),
        Some(ConfigError::CamNearModuloLimit)
    );
    // S840D-PARAM-506, S840D-STOP-087.
    let ends = |plus, mode| {
        limit_switch::Config::new(false, [Position(1), plus], [Position(0); 2], mode).err()
    };
    assert_eq!(ends(Position(1), 4), None);
    assert_eq!(ends(Position(0), 4), Some(ConfigError::LimitsCrossed));
    for mode in [0, 1, 5, 12] {
        assert_eq!(ends(Position(1), mode), Some(ConfigError::StopNotAllowed));
    }
    // S840D-PARAM-735, also a reaction that is not used.
    let reaction = |mode, first| speed::Config::new(mode, [first, 0, 0, 0], None).err();
    for mode in [0, 4, 5, 10, 14] {
        assert_eq!(reaction(mode, 14), None);
    }
    for (mode, first) in [(6, 0), (9, 0), (15, 0), (0, 5), (5, 9)] {
        assert_eq!(reaction(mode, first), Some(ConfigError::StopNotAllowed));
    }
    assert_eq!(
        setpoint::Config::new(101).err(),
        Some(ConfigError::FactorOutOfRange)
    );
    let plain = selection::Config::new(true, Cycles::ZERO, [Speed(0); 4]).expect("plausible");
    for factor in [0, 101] {
        assert_eq!(
            plain.with_override([factor; 16]).err(),
            Some(ConfigError::FactorOutOfRange)
        );
    }
    assert_eq!(
        standstill::Config::new(Distance(100_001)).err(),
        Some(ConfigError::ToleranceTooLarge)
    );
    assert_eq!(
        ramp::Config::new(Speed(u32::MAX), Speed(1)).err(),
        Some(ConfigError::ValueTooLarge)
    );
    assert_eq!(
        ModuloRange::new(Position(1), Position(0)).err(),
        Some(ConfigError::LimitsCrossed)
    );
}
