//! The checks of the F master at run-up: each alarm has a set-up that raises it, and a neighbour that does not.

use stillpoint_monitors::sinumerik::f_setup::{
    Address, Datum, Direction, Link, Module, Refusal, Setup, Slot,
};

/// A connection of sub-slot 0.
const fn slot(station: u16, filter: u32, assign: u32) -> Slot {
    Slot {
        address: 0x0500_0000 | station as u32,
        filter,
        assign,
    }
}

/// One input module and one output module, as in chapter 10.6 of the manual: a cycle of 6 ms times 3.
fn setup() -> Setup {
    let mut setup = Setup {
        interpolator_us: 6_000,
        ratio: 3,
        master: 0x0500_07D2,
        ..Setup::EMPTY
    };
    setup.inputs[0] = slot(0x3FE, u32::MAX, 4_001);
    setup.outputs[0] = slot(0x3FD, u32::MAX, 4_001);
    setup
}

const fn module(address: u16, direction: Direction) -> Module {
    Module {
        master: 0x7D2,
        address,
        direction,
        bits: 8,
        monitoring_us: 18_000,
        parameters_readable: true,
        crc_right: true,
        lengths_right: true,
    }
}

fn modules() -> [Module; 2] {
    [
        module(0x3FE, Direction::Input),
        module(0x3FD, Direction::Output),
    ]
}

const LINK: Link = Link {
    running: true,
    nck_version: 1,
    plc_version: 1,
};

/// A set-up changed in one place.
fn with(change: impl FnOnce(&mut Setup)) -> Setup {
    let mut setup = setup();
    change(&mut setup);
    setup
}

/// What is told of the machine data.
fn check(setup: &Setup) -> Vec<Refusal> {
    let mut told = Vec::new();
    setup.check(&mut |refusal| told.push(refusal));
    told
}

/// What is told of the comparison with the PLC.
fn compare(setup: &Setup, link: &Link, modules: &[Module]) -> Vec<Refusal> {
    let mut told = Vec::new();
    setup.compare(link, modules, &mut |refusal| told.push(refusal));
    told
}

/// What is told of modules changed in one place.
fn compared(change: impl FnOnce(&mut [Module; 2])) -> Vec<Refusal> {
    let mut modules = modules();
    change(&mut modules);
    compare(&setup(), &LINK, &modules)
}

#[test]
fn the_example_is_accepted() {
    assert_eq!(check(&setup()), []);
    assert_eq!(compare(&setup(), &LINK, &modules()), []);
    assert_eq!(check(&Setup::EMPTY), []);
    let nothing = Link {
        running: false,
        ..LINK
    };
    assert_eq!(compare(&Setup::EMPTY, &nothing, &[]), []);
    assert!(setup().is_accepted(&LINK, &modules()));
    assert!(!setup().is_accepted(&nothing, &modules()));
}

/// Alarm 27200: S840D-PSAFE-011, S840D-PSAFE-025.
#[test]
fn a_cycle_has_25_ms_at_most() {
    assert_eq!(check(&with(|s| s.interpolator_us = 8_333)), []);
    let long = with(|s| s.interpolator_us = 8_334);
    assert_eq!(check(&long), vec![Refusal::CycleTooLong]);
}

/// Alarm 27201: S840D-PSAFE-026, S840D-PSAFE-701.
#[test]
fn the_segment_is_5() {
    for (datum, wrong) in [
        (Datum::Master, with(|s| s.master = 0x0400_07D2)),
        (Datum::Input(0), with(|s| s.inputs[0].address = 0x03FE)),
        (
            Datum::Output(0),
            with(|s| s.outputs[0].address = 0x0600_03FD),
        ),
    ] {
        assert_eq!(check(&wrong), vec![Refusal::Segment(datum)]);
    }
}

/// Alarm 27202: S840D-PSAFE-027, S840D-PSAFE-009, S840D-PSPARAM-001.
#[test]
fn an_address_is_not_0() {
    let wrong = with(|s| s.inputs[0].address = 0x0500_0000);
    assert_eq!(check(&wrong), vec![Refusal::Address(Datum::Input(0))]);
    let missing = with(|s| s.outputs[0].address = 0);
    assert_eq!(check(&missing), vec![Refusal::Address(Datum::Output(0))]);
    assert_eq!(
        check(&with(|s| s.master = 0)),
        vec![Refusal::Address(Datum::Master)]
    );
    assert_eq!(check(&with(|s| s.master = 0x0500_FA7D)), []);
    let high = with(|s| s.master = 0x0500_FA7E);
    assert_eq!(check(&high), vec![Refusal::Address(Datum::Master)]);
    assert_eq!(check(&with(|s| s.inputs[0].address = 0x0500_FFFF)), []);
}

/// Alarm 27203: S840D-PSAFE-028, S840D-PSPARAM-004. AMB-19: a row has at most eight variables.
#[test]
fn a_row_lies_in_the_interface() {
    for assign in [0, 1_004, 4_000, 1, 65_060, 9_001] {
        let wrong = with(|s| s.inputs[0].assign = assign);
        let refused = vec![Refusal::Assignment(Datum::Input(0))];
        assert_eq!(check(&wrong), refused, "{assign}");
    }
    for assign in [1_001, 64_064, 8_001, 64_057] {
        assert_eq!(check(&with(|s| s.inputs[0].assign = assign)), []);
    }
}

/// Alarm 27204: S840D-PSAFE-010, S840D-PSAFE-029, S840D-P-21.
#[test]
fn a_variable_has_one_place() {
    let second = |assign| with(|s| s.inputs[7] = slot(0x3FE, 0b1111_0000, assign));
    assert_eq!(check(&second(8_005)), []);
    let refused = vec![Refusal::Double(Datum::Input(7))];
    assert_eq!(check(&second(7_004)), refused);
    let output = with(|s| s.outputs[1] = slot(0x3FC, 1, 4_004));
    assert_eq!(check(&output), vec![Refusal::Double(Datum::Output(1))]);
    // Terminals supply whole bytes, local inputs those of their mask.
    let terminal = with(|s| s.input_bytes[0] = 0x0102_0101);
    assert_eq!(check(&terminal), vec![Refusal::Double(Datum::Input(0))]);
    let next = with(|s| s.input_bytes[1] = 0x0102_0101);
    assert_eq!(check(&next), []);
    let moved = |mask| {
        with(|s| {
            s.inputs[0].assign = 5_002;
            s.input_bytes[0] = mask;
        })
    };
    assert_eq!(check(&moved(0x1)), []);
    assert_eq!(check(&moved(0x2)), vec![Refusal::Double(Datum::Input(0))]);
}

/// S840D-PSAFE-010, S840D-PSAFE-029, S840D-P-21: of any two rows those that share a variable are refused, and no others.
#[test]
fn shared_variables_are_found_exactly() {
    let ends = (1..=64_u32).flat_map(|low| (low..low + 8).map(move |high| (low, high)));
    let rows: Vec<(u32, u32)> = ends.filter(|(_, high)| *high <= 64).collect();
    let filter = |(low, high): (u32, u32)| (1_u32 << (high - low + 1)) - 1;
    let mut shared = 0;
    for &first in &rows {
        let mut setup = setup();
        setup.inputs[0] = slot(0x3FE, filter(first), first.1 * 1000 + first.0);
        for &second in &rows {
            setup.inputs[9] = slot(0x3FE, filter(second), second.1 * 1000 + second.0);
            let meets = first.0 <= second.1 && second.0 <= first.1;
            let mut told = 0;
            setup.check(&mut |refusal| {
                assert_eq!(refusal, Refusal::Double(Datum::Input(9)));
                told += 1;
            });
            assert_eq!(told, i32::from(meets), "{first:?} {second:?}");
            shared += told;
        }
    }
    assert!(shared > 1000, "{shared}");
}

/// Alarm 27205: S840D-PSAFE-030, S840D-PSPARAM-003, S840D-PSPARAM-006.
#[test]
fn filter_and_row_have_one_number() {
    assert_eq!(check(&with(|s| s.inputs[0].filter = 0xF0)), []);
    for filter in [0, 0x7, 0x1F, 0x7FFF_FFFF] {
        let wrong = with(|s| s.inputs[0].filter = filter);
        assert_eq!(check(&wrong), vec![Refusal::Number(Datum::Input(0))]);
    }
}

/// Alarm 27206: S840D-PSAFE-031, S840D-P-22.
#[test]
fn chosen_bits_are_net_data() {
    let filter = |filter| compare(&with(|s| s.inputs[0].filter = filter), &LINK, &modules());
    assert_eq!(filter(0b1111_0000), []);
    let beyond = vec![Refusal::Bit(Datum::Input(0))];
    assert_eq!(filter(0b1_1110_0000), beyond);
    assert_eq!(compared(|m| m[0].bits = 3), beyond);
    assert_eq!(compared(|m| m[0].bits = 4), []);
}

/// Alarm 27207: S840D-PSAFE-032, S840D-PSPARAM-002. AMB-18: sub-slot 1 for outputs only.
#[test]
fn a_sub_slot_exists() {
    let input = with(|s| s.inputs[0].address = 0x0501_03FE);
    assert_eq!(check(&input), vec![Refusal::SubSlot(Datum::Input(0))]);
    let output = |sub_slot: u32| with(|s| s.outputs[0].address = 0x0500_03FD | sub_slot << 16);
    assert_eq!(check(&output(1)), []);
    assert_eq!(check(&output(2)), vec![Refusal::SubSlot(Datum::Output(0))]);
    let wide = |bits| {
        let mut modules = modules();
        modules[1].bits = bits;
        compare(&output(1), &LINK, &modules)
    };
    assert_eq!(wide(32), vec![Refusal::SubSlot(Datum::Output(0))]);
    assert_eq!(wide(35), vec![Refusal::Bit(Datum::Output(0))]);
    assert_eq!(wide(36), []);
}

/// Alarm 27220: S840D-PSAFE-033, S840D-PSAFE-702, S840D-PSPARAM-001.
#[test]
fn as_many_modules_in_the_plc() {
    let fewer = compare(&setup(), &LINK, &modules()[..1]);
    let lacks = [
        Refusal::UnknownToPlc(Datum::Output(0)),
        Refusal::Count { nck: 2, plc: 1 },
    ];
    assert_eq!(fewer, lacks);
    // A wrong address of the master: none of the modules is its own.
    let other = compare(&with(|s| s.master = 0x0500_07D3), &LINK, &modules());
    assert!(other.contains(&Refusal::Count { nck: 2, plc: 0 }));
    // Two connections with one module.
    let twice = with(|s| s.inputs[1] = slot(0x3FE, 0xF0, 8_005));
    assert_eq!(compare(&twice, &LINK, &modules()), []);
}

/// Alarms 27221, 27222: S840D-PSAFE-034, S840D-PSAFE-035.
#[test]
fn both_sides_know_each_module() {
    let unknown = compare(
        &with(|s| s.inputs[0].address = 0x0500_03F0),
        &LINK,
        &modules(),
    );
    let both = [
        Refusal::UnknownToPlc(Datum::Input(0)),
        Refusal::UnknownToNck(0x3FE),
    ];
    assert_eq!(unknown, both);
    let third = with(|s| s.inputs[1] = slot(0x3FD, 0xF0, 8_005));
    let more = [modules()[0], module(0x3FD, Direction::Both)];
    assert_eq!(compare(&third, &LINK, &more), []);
}

/// Alarm 27223: S840D-PSAFE-036, S840D-PSAFE-044.
#[test]
fn a_module_has_the_direction_of_its_tables() {
    let other = compared(|m| m[0].direction = Direction::Both);
    assert_eq!(other, vec![Refusal::OtherDirection(0x3FE)]);
    let both = with(|s| s.outputs[1] = slot(0x3FE, u32::MAX, 8_005));
    assert_eq!(both.direction(0x3FE), Some(Direction::Both));
    assert_eq!(both.direction(0x3FD), Some(Direction::Output));
    assert_eq!(setup().direction(0x3FE), Some(Direction::Input));
    assert_eq!(setup().direction(1), None);
}

/// Alarm 27224: S840D-PSAFE-037.
#[test]
fn an_address_is_one_module() {
    let shared = compared(|m| m[1].address = 0x3FE);
    assert!(shared.contains(&Refusal::SharedAddress(0x3FE)));
    // A module of another master does not count.
    let foreign = Module {
        master: 1,
        ..modules()[0]
    };
    let all = [modules()[0], modules()[1], foreign];
    assert_eq!(compare(&setup(), &LINK, &all), []);
}

/// Alarms 27225, 27240, 27241: S840D-PSAFE-038, S840D-PSAFE-039, S840D-PSAFE-040.
#[test]
fn the_plc_must_be_readable() {
    let slave = compared(|m| m[1].parameters_readable = false);
    assert_eq!(slave, vec![Refusal::Slave(0x3FD)]);
    let link = |link: Link| compare(&setup(), &link, &modules());
    let off = link(Link {
        running: false,
        ..LINK
    });
    assert_eq!(off, vec![Refusal::MasterNotRunning]);
    let old = link(Link {
        plc_version: 2,
        ..LINK
    });
    assert_eq!(old, vec![Refusal::Version]);
}

/// Alarm 27242: S840D-PSAFE-041, S840D-PSAFE-042.
#[test]
fn f_parameters_are_right() {
    let wrong = vec![Refusal::Parameter(0x3FE)];
    assert_eq!(compared(|m| m[0].monitoring_us = 17_999), wrong);
    assert_eq!(compared(|m| m[0].crc_right = false), wrong);
    assert_eq!(compared(|m| m[0].lengths_right = false), wrong);
    assert_eq!(compared(|m| m[0].bits = 65), wrong);
}

/// S840D-PSPARAM-001, S840D-PSPARAM-002: the fields of an address, and back.
#[test]
fn addresses_are_decoded() {
    for segment in [0, 4, 5, 15] {
        for sub_slot in [0, 1, 15] {
            for station in [0, 1, 0x90, 0x3FE, 0xFFFF] {
                let address = Address {
                    segment,
                    sub_slot,
                    station,
                };
                assert_eq!(Address::decode(address.encode()), address);
            }
        }
    }
    assert_eq!(Address::decode(0x0501_0100).sub_slot, 1);
    assert_eq!(Address::decode(0x0501_0100).station, 256);
}

/// Each refusal is told under its alarm: S840D-PSAFE-025 to S840D-PSAFE-041.
#[test]
fn refusals_have_their_alarms() {
    let datum = Datum::Master;
    let all = [
        (Refusal::CycleTooLong, 27200),
        (Refusal::Segment(datum), 27201),
        (Refusal::Address(datum), 27202),
        (Refusal::Assignment(datum), 27203),
        (Refusal::Double(datum), 27204),
        (Refusal::Number(datum), 27205),
        (Refusal::Bit(datum), 27206),
        (Refusal::SubSlot(datum), 27207),
        (Refusal::Count { nck: 0, plc: 1 }, 27220),
        (Refusal::UnknownToPlc(datum), 27221),
        (Refusal::UnknownToNck(1), 27222),
        (Refusal::OtherDirection(1), 27223),
        (Refusal::SharedAddress(1), 27224),
        (Refusal::Slave(1), 27225),
        (Refusal::MasterNotRunning, 27240),
        (Refusal::Version, 27241),
        (Refusal::Parameter(1), 27242),
    ];
    for (refusal, alarm) in all {
        assert_eq!(refusal.alarm(), alarm);
        assert!(refusal.to_string().contains(&alarm.to_string()));
    }
}
