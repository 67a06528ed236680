//! Machine data of an axis: what is refused and why, and what the monitors get.

use stillpoint_monitors::kernel::{ConfigError, Cycles, Distance, Position, Speed};
use stillpoint_monitors::sinumerik::axis::{self, Side};
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::compare::{self, list};
use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_monitors::sinumerik::parameters::{
    Configuration, ControlModule, Encoders, Function, Installation, ParameterError, Parameters,
    Rule,
};
use stillpoint_monitors::sinumerik::selection::{self, Stage};
use stillpoint_monitors::sinumerik::{
    agreement, bus_failure, cam, channel, external, fault, forced_check, gear, group, history,
    limit_switch, pulses, ramp, reference, results, setpoint, shutdown_test, speed, standstill,
    stop, test_stop, threshold,
};
use stillpoint_monitors::units::ModuloRange;

fn refused(parameters: Parameters) -> (u32, usize, i64, Rule) {
    match parameters.validate() {
        Err(ParameterError::Implausible {
            number,
            index,
            value,
            rule,
        }) => (number, index, value, rule),
        other => panic!("{other:?}"),
    }
}

fn enabled(function_enable: u32) -> Parameters {
    Parameters {
        function_enable,
        ..Parameters::default()
    }
}

/// S840D-TIMING-501, S840D-TIMING-502, S840D-TIMING-511, S840D-PARAM-003.
#[test]
fn monitoring_cycle_is_checked() {
    let clock = |sysclock, posctrl, safety| Parameters {
        sysclock_cycle_time: sysclock,
        posctrl_sysclock_time_ratio: posctrl,
        safety_sysclock_time_ratio: safety,
        ..Parameters::default()
    };
    assert!(clock(1_000, 5, 25).validate().is_ok());
    assert_eq!(
        refused(clock(1_000, 1, 26)),
        (10090, 0, 26, Rule::CycleTooLong)
    );
    assert_eq!(
        refused(clock(1_000, 5, 24)),
        (10090, 0, 24, Rule::CycleNoMultiple)
    );
    assert_eq!(
        refused(clock(1_001, 1, 3)),
        (10090, 0, 3, Rule::CycleNotInDrive)
    );
    assert_eq!(
        refused(clock(125, 1, 3)),
        (10090, 0, 3, Rule::CycleNotInDrive)
    );
    assert!(clock(125, 1, 4).validate().is_ok());
}

/// S840D-MDCHK-029/a, S840D-PARAM-501, S840D-PARAM-502, S840D-PARAM-505, S840D-PARAM-721, S840D-PARAM-736, S840D-EXT-003, S840D-SLIP-501.
#[test]
fn enable_word_is_checked() {
    assert!(enabled(0xFFF3).validate().is_ok());
    let word = |function_enable| {
        let (number, index, value, rule) = refused(enabled(function_enable));
        assert_eq!(
            (number, index, value),
            (36901, 0, i64::from(function_enable))
        );
        rule
    };
    assert_eq!(word(0b10), Rule::WithoutSbhSg);
    assert_eq!(word(0x100), Rule::WithoutSbhSg);
    assert_eq!(word(0b1_0001), Rule::StopEWithoutExternalStops);
    assert_eq!(word(0b1000_0001), Rule::CamSyncWithoutCam);
    assert_eq!(word(0b1001), Rule::SlipWithOneEncoder);
    assert_eq!(word(0b1011), Rule::SlipWithPosition);
    assert_eq!(word(0x8009), Rule::SlipWithPosition);
    assert!(matches!(
        enabled(0x1_0000).validate(),
        Err(ParameterError::NotPermitted { datum, .. }) if datum.number == 36901
    ));
    assert_eq!(word(0b101), Rule::ReservedBit);
    let spl = |function_enable| Parameters {
        spl_stop_mode: 4,
        ..enabled(function_enable)
    };
    assert_eq!(refused(spl(0b100_0001)).3, Rule::SplStopENotEnabled);
    assert!(spl(0b101_0001).validate().is_ok());
    // An axis without functions takes no part.
    assert!(spl(0).validate().is_ok());
}

/// S840D-PARAM-506, S840D-PARAM-702: the upper limit must lie above the lower one, in both pairs.
#[test]
fn limits_must_not_be_interchanged() {
    let limits = |plus, minus| Parameters {
        pos_limit_plus: [10, plus],
        pos_limit_minus: [9, minus],
        ..Parameters::default()
    };
    assert!(limits(-4, -5).validate().is_ok());
    assert_eq!(
        refused(limits(-5, -5)),
        (36934, 1, -5, Rule::LimitsInterchanged)
    );
}

/// S840D-CAM-704, S840D-SN-010, S840D-PARAM-718, S840D-PARAM-719, S840D-PARAM-746: cams keep their distance from the ends of the modulo
/// range.
#[test]
fn cams_lie_inside_the_modulo_range() {
    let cams = |plus, minus, function_enable| Parameters {
        is_rot_ax: true,
        modulo_range: 360_000,
        cam_pos_plus: [plus; 4],
        cam_pos_minus: [minus; 4],
        function_enable,
        ..Parameters::default()
    };
    let (without, with) = (0x0301, 0x0381);
    assert!(cams(359_899, 100, without).validate().is_ok());
    assert_eq!(
        refused(cams(359_900, 100, without)),
        (36936, 0, 359_900, Rule::CamOutsideModulo)
    );
    assert_eq!(
        refused(cams(359_899, 98, without)),
        (36937, 0, 98, Rule::CamOutsideModulo)
    );
    // The worked example (S840D-CAM-704): with both tolerances of 0.1 degrees SN1+ may be 0.099 degrees and SN1- less than 359.8.
    assert!(cams(99, 359_799, with).validate().is_ok());
    assert_eq!(
        refused(cams(98, 359_799, with)),
        (36936, 0, 98, Rule::CamOutsideModulo)
    );
    assert_eq!(
        refused(cams(99, 359_800, with)),
        (36937, 0, 359_800, Rule::CamOutsideModulo)
    );
    assert!(cams(359_799, 100, with).validate().is_ok());
    assert_eq!(refused(cams(359_800, 100, with)).3, Rule::CamOutsideModulo);
    // A cam that is not enabled may lie anywhere; a linear axis has no modulo range.
    assert!(cams(359_900, 100, 1).validate().is_ok());
    let linear = Parameters {
        is_rot_ax: false,
        ..cams(-359_900, 999_999, with)
    };
    assert!(linear.validate().is_ok());
    let uneven = Parameters {
        modulo_range: 360_001,
        ..cams(0, 0, 1)
    };
    assert_eq!(refused(uneven), (36905, 0, 360_001, Rule::ModuloNoMultiple));
}

/// S840D-FREQ-003, S840D-PARAM-507, S840D-PARAM-731, S840D-PARAM-732.
#[test]
fn hardware_limits_are_checked() {
    let fast = |module| Parameters {
        enc_freq_limit: 300_001,
        installation: Installation {
            module,
            ..Installation::default()
        },
        ..Parameters::default()
    };
    assert!(fast(ControlModule::High).validate().is_ok());
    assert_eq!(
        refused(fast(ControlModule::Basic)),
        (36926, 0, 300_001, Rule::FrequencyTooHigh)
    );
    let internal = |module, external_path| Parameters {
        installation: Installation {
            module,
            internal_cancellation: true,
            external_path,
            ..Installation::default()
        },
        ..Parameters::default()
    };
    assert!(internal(ControlModule::High, true).validate().is_ok());
    assert_eq!(
        refused(internal(ControlModule::Basic, true)).3,
        Rule::InternalNotAvailable
    );
    assert_eq!(
        refused(internal(ControlModule::High, false)).3,
        Rule::InternalWithoutExternal
    );
}

/// A refusal names the datum, the value and what is permitted; the contexts are those of the text of alarm 27033.
#[test]
fn refusals_are_readable() {
    let message = enabled(0b10).validate().expect_err("no SBH/SG").to_string();
    assert_eq!(message, "MD36901[0] = 2: bits 1 to 15 need bit 0 (SBH/SG)");
    assert_eq!(Rule::WithoutSbhSg.context(), Some(5));
    assert_eq!(Rule::CycleTooLong.context(), None);
    let gears = Parameters {
        installation: Installation {
            gear_max: 8,
            ..Installation::default()
        },
        ..Parameters::default()
    };
    let message = gears.validate().expect_err("eight stages only").to_string();
    assert_eq!(
        message,
        "refused by a monitor: the highest gear index is above 7"
    );
}

/// S840D-TIMING-512, S840D-KDV-711: delays are rounded up, speeds down; the example of 2000 mm/min in 12 ms.
#[test]
fn values_are_converted_to_the_safe_side() {
    let parameters = Parameters {
        velo_limit: [2_000_000, 2_004_999, 2_005_000, 4_999],
        velo_ovr_factor: [33; 16],
        velo_stop_mode: 11,
        function_enable: 0b10_0001,
        ..Parameters::default()
    };
    let configuration = parameters.validate().expect("plausible");
    assert_eq!(configuration.cycle_us().get(), 12_000);
    let channel = configuration.channel();
    let limit = |stage| channel.selection.limit(stage);
    assert_eq!(
        Stage::ALL.map(limit),
        [Speed(400), Speed(400), Speed(401), Speed(0)]
    );
    assert!(channel.selection.enabled());
    let choice = channel.selection.choice(Stage::Sg2, Default::default());
    assert_eq!(channel.selection.effective(choice), Speed(132));
    assert_eq!(channel.stop.time(Level::B), Cycles::new(9));
    assert_eq!(channel.standstill.tolerance(), Distance(1_000));
    assert_eq!(channel.speed.stop(Stage::Sg3), InternalStop::B);
    assert_eq!(configuration.compare().t_chg(), Cycles::new(42));
    // Eight hours are 2.4 million cycles of 12 ms; a test must come before, so this one rounds down.
    assert_eq!(
        configuration.forced_check().interval(),
        Cycles::new(2_400_000)
    );

    let rotary = Parameters {
        is_rot_ax: true,
        ..parameters
    };
    let channel = *rotary.validate().expect("plausible").channel();
    assert_eq!(channel.selection.limit(Stage::Sg1), Speed(144_000));
}

/// S840D-PARAM-501: the bits of the enable word reach their monitors, and only theirs.
#[test]
fn enabled_functions_reach_their_monitors() {
    let off = Parameters::default();
    assert!(!off.enabled(Function::SbhSg) && !off.se_sn_enabled());
    for cam in 0..8 {
        let parameters = enabled(1 | 0x100 << cam);
        assert!(parameters.se_sn_enabled() && parameters.cam_enabled(cam));
        assert!((0..=8).all(|other| other == cam || !parameters.cam_enabled(other)));
        assert!(
            parameters
                .validate()
                .expect("plausible")
                .channel()
                .se_sn_enabled
        );
    }
    // There is no ninth cam, whatever an enable word that is not valid has there.
    let beyond = Parameters {
        function_enable: 1 << 16,
        ..Parameters::default()
    };
    assert!(!beyond.cam_enabled(8));
    let mut slip = enabled(0b1001);
    slip.installation.encoders = Encoders::Two;
    let slip = slip.validate().expect("plausible");
    assert!(slip.slip().is_some() && !slip.channel().se_sn_enabled);
    assert!(off.validate().expect("plausible").slip().is_none());
    assert_eq!(slip.words().function_enable, 0b1001);
    assert_eq!(axis::Config::new(Side::Drive, slip).side(), Side::Drive);
}

/// Every datum with a value of its own, so that none can take the place of another.
fn distinct() -> Parameters {
    Parameters {
        function_enable: 0x0173,
        spl_stop_mode: 4,
        velo_limit: [1_000_000, 2_000_000, 3_000_000, 4_000_000],
        velo_ovr_factor: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16],
        des_velo_limit: 50,
        standstill_tol: 7,
        pos_limit_plus: [11, 12],
        pos_limit_minus: [-13, -14],
        cam_pos_plus: [21, 22, 23, 24],
        cam_pos_minus: [31, 32, 33, 34],
        cam_tol: 41,
        pos_tol: 42,
        refp_pos_tol: 43,
        velo_x: 20_000,
        stop_velo_tol: 300_000,
        slip_velo_tol: 50_000,
        standstill_velo_tol: 10_000,
        stop_switch_time_c: 120_000,
        stop_switch_time_d: 240_000,
        stop_switch_time_e: 360_000,
        stop_switch_time_f: 480_000,
        pulse_disable_delay: 600_000,
        pulse_dis_check_time: 720_000,
        velo_switch_delay: 840_000,
        mode_switch_time: 960_000,
        velo_stop_reaction: [0, 11, 2, 13],
        pulse_dis_time_busfail: 251_000,
        pos_stop_mode: 4,
        ipo_stop_group: 1,
        installation: Installation {
            module: ControlModule::High,
            internal_cancellation: true,
            external_path: true,
            gear_max: 5,
            test_interval: 1_200_000,
            ..Installation::default()
        },
        ..Parameters::default()
    }
}

/// S840D-PARAM-009 to S840D-PARAM-026: every datum reaches the monitor it is meant for; 1000 mm/min are 200 um and 12 ms one cycle.
#[test]
fn every_value_reaches_its_monitor() -> Result<(), ConfigError> {
    let parameters = distinct();
    let configuration = parameters.validate().expect("plausible");
    let cycles = Cycles::new;
    let expected = channel::Config {
        external: external::Config::new(true, true, true)?,
        test: test_stop::Config::new(cycles(60))?,
        selection: selection::Config::new(true, cycles(70), [200, 400, 600, 800].map(Speed))?
            .with_override(parameters.velo_ovr_factor)?,
        standstill: standstill::Config::new(Distance(7))?,
        // 300 kHz in 12 ms.
        speed: speed::Config::new(5, [0, 11, 2, 13], Some(Speed(3_600)))?,
        limit_switch: limit_switch::Config::new(
            true,
            [11, 12].map(Position),
            [-13, -14].map(Position),
            4,
        )?,
        ramp: ramp::Config::new(Speed(4), Speed(60))?,
        threshold: threshold::Config::new(Speed(4))?,
        fault: fault::Config::new(cycles(40))?,
        stop: stop::Config::new(cycles(50), cycles(10), cycles(20), cycles(30))?,
        pulses: pulses::Config::new(true, true, cycles(60))?,
        standstill_speed: Speed(2),
        se_sn_enabled: true,
    };
    assert_eq!(*configuration.channel(), expected);
    for (place, position) in [21, 31, 22, 32, 23, 33, 24, 34].into_iter().enumerate() {
        let cam = cam::Config::new(
            place == 0,
            Position(position),
            Distance(41),
            false,
            ModuloRange::LINEAR,
            Distance(42),
        )?;
        assert_eq!(configuration.cams()[place], cam, "cam {place}");
    }
    let mut cams = [false; 8];
    cams[0] = true;
    assert_eq!(
        *configuration.results(),
        results::Config::new(cams, true, false)?
    );
    assert_eq!(*configuration.gear(), gear::Config::new(5, true)?);
    // 2 s are 166.7 cycles.
    assert_eq!(
        *configuration.agreement(),
        agreement::Config::new(cycles(167), true)?
    );
    assert_eq!(*configuration.reference(), reference::Config::new(true)?);
    assert_eq!(
        *configuration.history(),
        history::Config::new(Distance(43))?
    );
    assert_eq!(
        *configuration.compare(),
        compare::Config::new(cycles(80), &list::ITEMS)?
    );
    assert_eq!(
        *configuration.shutdown_test(),
        shutdown_test::Config::new(cycles(60))?
    );
    assert_eq!(
        *configuration.forced_check(),
        forced_check::Config::new(cycles(100))?
    );
    assert_eq!(
        *configuration.group(),
        group::Config::new(group::Reach::Interpolating)
    );
    assert_eq!(*configuration.setpoint(), setpoint::Config::new(50)?);
    for (nck, bus) in [
        (true, configuration.bus_nck()),
        (false, configuration.bus_drive()),
    ] {
        let delay = cycles(20);
        let p = &parameters;
        let mode = (p.velo_stop_mode, p.velo_stop_reaction);
        assert_eq!(
            *bus,
            bus_failure::Config::new(nck, true, delay, mode.0, mode.1)?
        );
    }

    // And the other side of each switch.
    let off = Parameters {
        function_enable: 1,
        spl_stop_mode: 3,
        velo_x: 0,
        ipo_stop_group: 0,
        ..parameters
    };
    let configuration = off.validate().expect("plausible");
    let channel = configuration.channel();
    assert_eq!(
        channel.external,
        external::Config::new(false, false, false)?
    );
    assert_ne!(channel.limit_switch, expected.limit_switch);
    assert_ne!(channel.selection, expected.selection);
    assert_eq!(
        *configuration.results(),
        results::Config::new([false; 8], false, false)?
    );
    assert_eq!(
        *configuration.group(),
        group::Config::new(group::Reach::Channel)
    );
    let stops_only = Parameters {
        function_enable: 0b100_0001,
        ..off
    };
    let configuration = stops_only.validate().expect("plausible");
    assert_eq!(
        configuration.channel().external,
        external::Config::new(true, false, false)?
    );
    Ok(())
}

/// S840D-PARAM-004, lines 6888 to 6895, 7721 to 7727: one item in each cycle of 12 ms, and of several axes the longest.
#[test]
fn a_pass_of_the_comparison_takes_a_cycle_for_each_item() {
    let of = |ratio| {
        let p = Parameters {
            safety_sysclock_time_ratio: ratio,
            ..Parameters::default()
        };
        p.validate().expect("plausible")
    };
    let items = list::ITEMS.len() as u64;
    assert_eq!(of(3).comparison_us(), items * 12_000);
    let axes = [of(2), of(3), of(1)];
    assert_eq!(Configuration::longest_comparison_us(&axes), items * 12_000);
    assert_eq!(Configuration::longest_comparison_us(&[]), 0);
}

/// S840D-KDV-508: what is compared with the other channel are these values, each under its code.
#[test]
fn every_value_is_compared_under_its_code() {
    let configuration = distinct().validate().expect("plausible");
    let word = |code| configuration.words().words(Code::of(code).expect("a code"));
    let expected: [(u16, i64); 24] = [
        (5, 0x0173),
        (6, 200),
        (9, 800),
        (10, 7),
        (11, 11),
        (12, -13),
        (13, 12),
        (14, -14),
        (16, 21),
        (18, 31),
        (20, 22),
        (30, 34),
        (32, 43),
        (33, 70),
        (34, 80),
        (35, 50),
        (36, 60),
        (37, 10),
        (38, 20),
        (39, 30),
        (42, 2),
        (59, 1),
        (81, 60),
        (84, 40),
    ];
    for (code, value) in expected {
        assert_eq!(word(code), Some([value, 0]), "code {code}");
    }
    assert_eq!(word(31), Some([42, 842]));
    assert_eq!(word(74), Some([16, 0]));
    assert_eq!(word(75), Some([4, 0]));
    assert_eq!(word(79), Some([13, 0]));
    assert_eq!((word(40), word(41)), (Some([5, 0]), Some([4, 0])));
    assert_eq!(word(89), Some([300_000, 0]));
}
