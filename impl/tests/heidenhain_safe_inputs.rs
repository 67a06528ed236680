//! Inputs, outputs and general fields of the safe PLC, and the checks of its program.

use core::num::NonZeroU32;

use stillpoint_monitors::heidenhain::allowed_functions::Function;
use stillpoint_monitors::heidenhain::types::{Kind, Som, Stop};
use stillpoint_monitors::heidenhain::{
    agreement, allowed_functions, availability, button, control_voltage, f_limited, general_fields,
    group_motion, key_filter, program_check, safe_input, safe_output, safe_plc, som, switch_on,
    working_space,
};
use stillpoint_monitors::kernel::{Cycles, Speed};

fn marker(invert_a: bool, invert_b: bool, contact_a: bool, contact_b: bool) -> bool {
    let config = safe_input::Config::new(invert_a, invert_b, false).expect("plausible");
    let contacts = safe_input::Inputs {
        contact_a,
        contact_b,
    };
    safe_input::Monitor::new(config).step(&contacts).marker
}

/// HFS-IO-001, HFS-IO-002: the example of 6.2.1: terminals 0 and 1, both inverted, give 0.
#[test]
fn different_contacts_give_0() {
    assert!(!marker(true, true, false, true));
    assert!(marker(true, true, false, false));
    assert!(marker(false, false, true, true));
}

/// HFS-PB-007, HFS-HW-003: the handwheel with a normally open and a normally closed contact, B inverted; the key of the panel and
/// the HR 550 FS with two normally open ones. Either way one faulty contact gives no permissive.
#[test]
fn permissive_of_every_form() {
    for (invert_b, pressed) in [(true, (true, false)), (false, (true, true))] {
        assert!(marker(false, invert_b, pressed.0, pressed.1));
        assert!(!marker(false, invert_b, !pressed.0, pressed.1));
        assert!(!marker(false, invert_b, pressed.0, !pressed.1));
        assert!(!marker(false, invert_b, !pressed.0, !pressed.1));
    }
    let mut key = button::Monitor::new(button::Config::new(Cycles::new(10)).expect("plausible"));
    for (b_level, valid) in [(true, false), (false, true)] {
        let marker = marker(false, true, true, b_level);
        let out = key.step(&button::Inputs {
            contact_a: marker,
            contact_b: marker,
            ..Default::default()
        });
        assert_eq!(out.valid, valid);
    }
}

/// HFS-MKEY-002: a stop key with normally closed contacts: the marker is 1 while it is not pressed, and one contact stops.
#[test]
fn one_contact_of_a_stop_key_stops() {
    assert!(marker(false, false, true, true));
    for (a, b) in [(false, true), (true, false), (false, false)] {
        let inputs = key_filter::Inputs {
            stop: !marker(false, false, a, b),
            ..Default::default()
        };
        assert!(
            key_filter::Monitor::new(key_filter::Config)
                .step(&inputs)
                .stop
        );
    }
}

/// HFS-SPLC-005: with a door switch that is missing the space counts as open, with a missing permissive nothing starts.
#[test]
fn missing_inputs_are_0() {
    let config = safe_input::Config::new(true, true, true).expect("plausible");
    for (contact_a, contact_b) in [(false, false), (false, true), (true, true)] {
        let contacts = safe_input::Inputs {
            contact_a,
            contact_b,
        };
        assert!(!safe_input::Monitor::new(config).step(&contacts).marker);
    }
}

/// HFS-DOOR-001, HFS-DOOR-002, HFS-GRP-005: a space with two doors, one of them shared with another space.
#[test]
fn doors_of_two_spaces() {
    let space =
        |doors| working_space::Monitor::new(working_space::Config::new(doors).expect("plausible"));
    let (mut left, mut right) = (space(0b011), space(0b110));
    for closed in 0..8 {
        let inputs = working_space::Inputs { closed };
        assert_eq!(left.step(&inputs).open, closed & 0b011 != 0b011, "{closed}");
        assert_eq!(
            right.step(&inputs).open,
            closed & 0b110 != 0b110,
            "{closed}"
        );
    }
}

/// HFS-ACK-002, HFS-API-028, HFS-API-029, HFS-ACK-005: with the reset button the key works after it only; the latch circuit that
/// stays gives the kernel no edge for a restart.
#[test]
fn reset_before_control_voltage() {
    let config = control_voltage::Config::new(true, false).expect("plausible");
    let mut plc = control_voltage::Monitor::new(config);
    let mut kernel = switch_on::Monitor::new(switch_on::Config::STANDARD);
    let mut cycle = |inputs: control_voltage::Inputs| {
        let asked = plc.step(&inputs);
        kernel.step(&switch_on::Inputs {
            cvo: asked.voltage,
            chain: true,
            dropped: inputs.dropped,
            may_on: !inputs.dropped,
            ..Default::default()
        })
    };
    let key = control_voltage::Inputs {
        key: true,
        ..Default::default()
    };
    let latched = control_voltage::Inputs {
        latched: true,
        ..Default::default()
    };
    cycle(control_voltage::Inputs::default());
    cycle(key);
    assert!(!cycle(key).sto_a_g, "no reset yet");
    cycle(control_voltage::Inputs {
        reset: true,
        ..Default::default()
    });
    cycle(key);
    assert!(cycle(key).sto_a_g);
    assert!(cycle(latched).sto_a_g);
    let dropped = control_voltage::Inputs {
        dropped: true,
        ..latched
    };
    assert!(!cycle(dropped).sto_a_g);
    for inputs in [latched, latched, key, key] {
        assert!(!cycle(inputs).sto_a_g, "a new reset is needed");
    }
}

/// HFS-API-029: a magazine with a key of its own is switched on by that alone.
#[test]
fn magazine_with_its_own_switch_on_key() {
    let step = |t_key, inputs| {
        let config = control_voltage::Config::new(false, t_key).expect("plausible");
        control_voltage::Monitor::new(config).step(&inputs)
    };
    let common = control_voltage::Inputs {
        key: true,
        ..Default::default()
    };
    let own = control_voltage::Inputs {
        t_key: true,
        ..Default::default()
    };
    assert!(step(false, common).t_drives && !step(true, common).t_drives);
    let out = step(true, own);
    assert!(out.t_drives && !out.drives && !out.voltage);
}

/// HFS-API-027, HFS-API-028, HFS-API-030, HFS-API-016, HFS-BCT-005, HFS-FAULT-006, HFS-MODE-021: each field alone; an unknown number in any of them.
#[test]
fn general_fields_are_copies_or_void() {
    let calm = general_fields::Inputs {
        brakes: 1,
        ..Default::default()
    };
    let take = |inputs| general_fields::Monitor::new(general_fields::Config).step(&inputs);
    assert_eq!(take(calm), general_fields::Outputs::default());
    assert!(take(general_fields::Inputs { chain: 1, ..calm }).chain);
    assert!(
        take(general_fields::Inputs { brakes: 0, ..calm }).brakes,
        "active at 0"
    );
    assert!(take(general_fields::Inputs { voltage: 1, ..calm }).voltage);
    assert!(take(general_fields::Inputs { keys: 1, ..calm }).keys);
    assert!(take(general_fields::Inputs { feed: 1, ..calm }).feed);
    for (code, mode) in Som::ALL.iter().enumerate() {
        let som = u8::try_from(code).expect("small");
        assert_eq!(take(general_fields::Inputs { som, ..calm }).som, *mode);
    }
    for wrong in [
        general_fields::Inputs { som: 4, ..calm },
        general_fields::Inputs { chain: 2, ..calm },
        general_fields::Inputs {
            feed: 255,
            voltage: 1,
            ..calm
        },
    ] {
        let out = take(wrong);
        assert_eq!(out.stop, Stop::Ss1F, "{wrong:?}");
        assert!(!out.voltage && !out.chain && !out.feed && out.keys && out.som == Som::Som1);
    }
}

/// HFS-MODE-021: each channel selects from its own inputs; a difference that lasts is found by the comparison.
#[test]
fn each_channel_selects_its_mode() {
    let mut channels = [som::Monitor::new(som::Config::new(false).expect("plausible")); 2];
    let window = agreement::Config::new(Cycles::new(3)).expect("plausible");
    let mut compared = agreement::Monitor::new(window);
    let faults: Vec<bool> = [
        (true, true),
        (true, false),
        (true, false),
        (true, false),
        (true, false),
    ]
    .into_iter()
    .map(|(a, b)| {
        let [mc, cc] = &mut channels;
        let select = |plc: &mut som::Monitor, key_2| {
            plc.step(&som::Inputs {
                key_2,
                ..Default::default()
            })
            .som
        };
        let differ = select(mc, a) != select(cc, b);
        compared.step(&agreement::Inputs { differ }).fault
    })
    .collect();
    assert!(!faults[0] && !faults[1]);
    assert!(faults[4], "{faults:?}");
}

/// HFS-KSW-005: a code number or a chip instead of a keylock: whatever stands for a mode is an input like its key, and the same
/// rules of exclusion and of transition hold.
#[test]
fn mode_by_other_means() {
    let mut plc = som::Monitor::new(som::Config::new(true).expect("plausible"));
    let mut select = |keylock: Option<u8>, code: Option<u8>| {
        let wish = |mode| keylock == Some(mode) || code == Some(mode);
        plc.step(&som::Inputs {
            key_2: wish(2),
            key_3: wish(3),
            key_4: wish(4),
            ..Default::default()
        })
        .som
    };
    assert_eq!(select(Some(2), None), Som::Som2);
    assert_eq!(select(Some(2), Some(4)), Som::Som1, "two at once");
    assert_eq!(select(None, Some(4)), Som::Som1, "no direct change");
    assert_eq!(select(None, None), Som::Som1);
    assert_eq!(select(None, Some(4)), Som::Som4);
    assert_eq!(select(Some(3), None), Som::Som1);
}

/// HFS-SPLC-002, HFS-PARAM-018, HFS-PARAM-019: a changed checksum, another interface, commissioning.
#[test]
fn changed_programs_do_not_run() {
    let run = |commissioning, crc_equal, version_equal| {
        let config = program_check::Config::new(commissioning).expect("plausible");
        program_check::Monitor::new(config).step(&program_check::Inputs {
            translated: true,
            crc_equal,
            version_equal,
        })
    };
    assert!(run(false, true, true).good);
    let changed = run(false, false, true);
    assert!(!changed.good && changed.message_crc && !changed.message_version);
    assert!(run(true, false, true).good);
    for commissioning in [false, true] {
        let other = run(commissioning, true, false);
        assert!(!other.good && other.message_version);
    }
}

/// HFS-SPLC-003, HFS-API-013: 1 s of the program latch in cycles of both channels.
#[test]
fn latch_time_of_both_channels() {
    let cycles = |ms| NonZeroU32::new(ms).map(|ms| safe_plc::one_second(ms).map(Cycles::count));
    assert_eq!(cycles(safe_plc::CC_CYCLE_MS), Some(Ok(48)));
    assert_eq!(cycles(15), Some(Ok(67)));
    assert!(matches!(cycles(u32::MAX), Some(Err(_))));
}

/// HFS-API-034: no position of an axis that is not safe.
#[test]
fn unsafe_positions_are_not_used() {
    assert_eq!(safe_plc::position(true, -12_345), Some(-12_345));
    assert_eq!(safe_plc::position(false, 0), None);
}

/// HFS-API-033.
#[test]
fn one_moving_axis_moves_the_group() {
    for axes in 0..=u8::MAX {
        let out =
            group_motion::Monitor::new(group_motion::Config).step(&group_motion::Inputs { axes });
        assert_eq!(out.moving, axes.count_ones() > 0);
    }
}

/// HFS-STOP-007, HFS-IO-005: no stop switches an output of the program off, the program does by the enable; what exchanges
/// information only stays.
#[test]
fn outputs_are_switched_off_by_the_program() {
    let on = |motion, enabled| {
        let config = safe_output::Config::new(motion).expect("plausible");
        let inputs = safe_output::Inputs {
            wanted: true,
            enabled,
        };
        safe_output::Monitor::new(config).step(&inputs).on
    };
    assert!(on(true, true) && on(false, true));
    assert!(!on(true, false) && on(false, false));
}

/// HFS-MODE-012: every function in every combination.
#[test]
fn open_door_forbids_functions() {
    for function in Function::ALL {
        for (door_open, permissive) in [(false, false), (false, true), (true, false), (true, true)]
        {
            let inputs = allowed_functions::Inputs {
                door_open,
                permissive,
                function,
            };
            let out = allowed_functions::Monitor::new(allowed_functions::Config).step(&inputs);
            let conveyor = function == Function::ChipConveyor && permissive;
            assert_eq!(out.allowed, !door_open || conveyor, "{inputs:?}");
        }
    }
}

/// HFS-MODE-016: the table of 6.1.6 as printed, line by line.
#[test]
fn available_functions_as_printed() {
    use availability::Function::{Sbc, Sli, Slp, Sls, Sos, Sto, Stops};
    let lines = [
        (Sto, "xxxx xxxx xxxx"),
        (Sos, "xxxx ---- -xxx"),
        (Sls, "-xxx -xxx -xxx"),
        (Sli, "xxxx ---- xxxx"),
        (Slp, "xxxx ---- ----"),
        (Stops, "xxxx xxxx xxxx"),
        (Sbc, "xxxx ---- xxxx"),
    ];
    for (function, line) in lines {
        for (kind, modes) in Kind::ALL.into_iter().zip(line.split(' ')) {
            for (som, mark) in Som::ALL.into_iter().zip(modes.chars()) {
                let inputs = availability::Inputs {
                    kind,
                    function,
                    som,
                    ..Default::default()
                };
                let out = availability::Monitor::new(availability::Config).step(&inputs);
                assert_eq!(out.available, mark == 'x', "{inputs:?}");
            }
        }
    }
    let noted = availability::Inputs {
        kind: Kind::Spindle,
        has_brake: true,
        spindle_sos: true,
        ..Default::default()
    };
    for function in [Sos, Sbc] {
        let inputs = availability::Inputs { function, ..noted };
        assert!(
            availability::Monitor::new(availability::Config)
                .step(&inputs)
                .available
        );
    }
}

/// HFS-SLS-007, HFS-MODE-022, HFS-MODE-023: F LIMITED brings the drives within the limit of the mode, in SOM_1 to standstill.
#[test]
fn f_limited_by_mode() {
    let limits = [Speed(20), Speed(50), Speed(30)];
    let config = f_limited::Config::new(limits).expect("plausible");
    let mut nc = f_limited::Monitor::new(config);
    let mut ask = |pressed, som| {
        let wanted = Speed(100);
        nc.step(&f_limited::Inputs {
            pressed,
            som,
            wanted,
        })
        .speed
    };
    assert_eq!(ask(true, Som::Som1), Speed(0));
    assert_eq!(ask(true, Som::Som2), Speed(20));
    assert_eq!(ask(true, Som::Som4), Speed(30));
    assert_eq!(ask(false, Som::Som1), Speed(100));
}
