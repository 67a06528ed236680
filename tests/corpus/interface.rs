//! The signals of the monitors lie where the signal table says, and terminals act as its truth tables say.

use std::collections::BTreeSet;

use stillpoint_monitors::sinumerik::interface::{
    BLOCK, Contribution, Input, Place, SGA, SGE, Sga, Sge, and,
};
use stillpoint_tests::root;
use toml::{Table, Value};

fn table() -> Table {
    let path = root().join("spec/families/sinumerik-840d/signals.toml");
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    text.parse().expect("the table is TOML")
}

/// Signals of a kind that lie in the axis data block: (id, byte, bit).
fn placed(kind: &str) -> BTreeSet<(String, i64, i64)> {
    let table = table();
    let signals = table["signal"].as_array().expect("a list").clone();
    let of = |s: &Value| {
        let number = |key: &str| s.get(key).and_then(Value::as_integer);
        Some((
            s["id"].as_str()?.to_owned(),
            number("byte")?,
            number("bit")?,
        ))
    };
    let kind = |s: &&Value| s["kind"].as_str() == Some(kind);
    signals.iter().filter(kind).filter_map(of).collect()
}

fn ours(places: &[Place]) -> BTreeSet<(String, i64, i64)> {
    let of = |p: &Place| (p.id.to_owned(), i64::from(p.byte), i64::from(p.bit));
    places.iter().map(of).collect()
}

/// S840D-RETRACT-701, S840D-SIGNAL-001, S840D-SIGNAL-002, S840D-CAM-703, S840D-IO-007, S840D-IO-001, S840D-TEST-021, S840D-SPL-004: the signals of an axis in the drive channel have their places in its block, each a bit of its own.
#[test]
fn every_signal_lies_where_the_table_says() {
    assert_eq!(ours(SGE), placed("SGE"));
    assert_eq!(ours(SGA), placed("SGA"));
    let cells: BTreeSet<_> = SGE.iter().chain(SGA).map(|p| (p.byte, p.bit)).collect();
    assert_eq!(cells.len(), SGE.len() + SGA.len(), "two signals in one bit");
    // None of them tells which limit position was passed.
    assert!(SGA.iter().all(|p| !p.id.contains("POS")));
}

fn block_with(place: &Place) -> [u8; BLOCK] {
    let mut block = [0; BLOCK];
    block[usize::from(place.byte)] = 1 << place.bit;
    block
}

#[test]
fn each_bit_is_read_and_written_alone() {
    for place in SGE {
        let block = block_with(place);
        let read = Sge::read(&block);
        assert_ne!(read, Sge::default(), "{}", place.id);
        let mut written = [0; BLOCK];
        read.write(&mut written);
        assert_eq!(written, block, "{}", place.id);
    }
    for place in SGA {
        let block = block_with(place);
        let mut written = [0; BLOCK];
        Sga::read(&block).write(&mut written);
        assert_eq!(written, block, "{}", place.id);
    }
}

#[test]
fn writing_keeps_the_bits_of_others_and_clears_its_own() {
    let mut block = [0xFF; BLOCK];
    Sga::default().write(&mut block);
    let mut expected = [0xFF; BLOCK];
    for place in SGA {
        expected[usize::from(place.byte)] &= !(1 << place.bit);
    }
    assert_eq!(block, expected);
}

#[test]
fn the_fields_are_in_the_order_of_the_places() {
    let debug = |text: String| -> Vec<bool> {
        text.match_indices(": ")
            .map(|(at, _)| text[at + 2..].starts_with("true"))
            .collect()
    };
    for (k, place) in SGE.iter().enumerate() {
        let read = debug(format!("{:?}", Sge::read(&block_with(place))));
        assert_eq!(read.iter().position(|b| *b), Some(k), "{}", place.id);
    }
    for (k, place) in SGA.iter().enumerate() {
        let read = debug(format!("{:?}", Sga::read(&block_with(place))));
        assert_eq!(read.iter().position(|b| *b), Some(k), "{}", place.id);
    }
}

/// S840D-SN-012: the cams of the drive channel are bits of the block, in either order of the manual.
#[test]
fn cams_can_be_exchanged() {
    for (k, place) in SGA.iter().enumerate() {
        let moved = Sga::read(&block_with(place)).with_cams_exchanged();
        let partner = match place.byte {
            109 => SGA[if place.bit % 2 == 0 { k + 1 } else { k - 1 }],
            _ => *place,
        };
        assert_eq!(moved, Sga::read(&block_with(&partner)), "{}", place.id);
        assert_eq!(moved.with_cams_exchanged(), Sga::read(&block_with(place)));
    }
}

/// S840D-SIGNAL-023, S840D-SIGNAL-027/a, S840D-IO-002, S840D-EXT-004: an unused signal is 0, of an external stop 1.
#[test]
fn unused_signals_are_zero_but_external_stops_are_not_requested() {
    for place in SGE {
        let unused = Sge::UNUSED;
        let mut block = [0; BLOCK];
        unused.write(&mut block);
        let level = block[usize::from(place.byte)] >> place.bit & 1 == 1;
        assert_eq!(level, place.id.starts_with("SGE_EXT_STOP"), "{}", place.id);
    }
    assert!(!Input::ZERO.signal(true) && !Input::ZERO.signal(false));
    assert!(Input::ONE.signal(true) && Input::ONE.signal(false));
}

/// Every row of a truth table with its free columns in both values: (inputs, output).
fn truth(id: &str) -> Vec<(Vec<bool>, bool)> {
    let table = table();
    let tables = table["truth_table"].as_array().expect("a list");
    let one = tables.iter().find(|t| t["id"].as_str() == Some(id));
    let rows = one.expect("the truth table")["rows"]
        .as_array()
        .expect("rows");
    let mut out = Vec::new();
    for row in rows {
        let mut inputs = vec![Vec::new()];
        for cell in row["in"].as_str().expect("a text").split(',') {
            let values: &[bool] = match cell {
                "0" => &[false],
                "1" => &[true],
                _ => &[false, true],
            };
            inputs = inputs
                .iter()
                .flat_map(|i: &Vec<bool>| values.iter().map(|v| [i.as_slice(), &[*v]].concat()))
                .collect();
        }
        let output = row["out"].as_str() == Some("1");
        out.extend(inputs.into_iter().map(|i| (i, output)));
    }
    out
}

/// S840D-SIGNAL-027/a, S840D-IO-005, S840D-IO-001, S840D-SPL-003: a signal of the NCK channel comes from its own terminal, inverted by bit 31 of its assignment.
#[test]
fn inputs_follow_their_truth_table() {
    let rows = truth("INPUT_ASSIGNMENT");
    let cases: BTreeSet<_> = rows.iter().map(|(i, _)| i.clone()).collect();
    assert_eq!(cases.len(), 8, "every combination stands in the table");
    for (inputs, expected) in rows {
        // Terminal 2 of the first module, as an example of an assignment.
        let datum =
            (if inputs[0] { 0x8000_0000 } else { 0 }) | (if inputs[1] { 0x0109_0102 } else { 0 });
        assert_eq!(Input::new(datum).signal(inputs[2]), expected, "{inputs:?}");
    }
}

/// S840D-IO-004, S840D-SPL-003: the signals of several axes on one output are ANDed, each inverted before if so assigned.
#[test]
fn outputs_follow_their_truth_table() {
    let rows = truth("OUTPUT_AND");
    let cases: BTreeSet<_> = rows.iter().map(|(i, _)| i.clone()).collect();
    assert_eq!(cases.len(), 16, "every combination stands in the table");
    for (inputs, expected) in rows {
        let of = |k: usize| Contribution {
            signal: inputs[k],
            inverted: inputs[k + 1],
        };
        assert_eq!(and(&[of(0), of(2)]), expected, "{inputs:?}");
        let third = Contribution {
            signal: true,
            inverted: false,
        };
        assert_eq!(and(&[of(0), third, of(2)]), expected, "{inputs:?}");
    }
    assert!(!and(&[]), "an output without signals is 0");
}

/// S840D-CAM-701, S840D-CAM-702, lines 20176 to 20275: the cams of the manual's spindle. The signal at 90 degrees is 1 between 89.5
/// and 90.5, as an output makes it of the inverted plus cam and the minus cam; the one at 0 between 359.5 and 0.5, where the AND
/// would be 0 everywhere. Every position of two turns, in steps of 0.1 degrees.
#[test]
fn a_pair_of_cams_tells_a_position() {
    use stillpoint_monitors::kernel::{Distance, Position};
    use stillpoint_monitors::sinumerik::cam;
    use stillpoint_monitors::units::ModuloRange;

    let range = ModuloRange::from_degrees(360).expect("a turn");
    let beyond = |at: i32, position: i32| {
        let config = cam::Config::new(
            true,
            Position(at),
            Distance(100),
            false,
            range,
            Distance(100),
        );
        let inputs = cam::Inputs {
            power_on: false,
            position: Position(position),
            other: true,
        };
        let mut cam = cam::Monitor::new(config.expect("plausible"));
        cam.step(&inputs).sga
    };
    for step in 0..7_200 {
        let position = step * 100;
        let angle = position % 360_000;
        let pair = |plus, minus| (beyond(plus, position), beyond(minus, position));
        let ninety = pair(90_500, 89_500);
        let inside = angle > 89_500 && angle <= 90_500;
        assert_eq!(cam::pulse(ninety.0, ninety.1, false), inside, "{angle}");
        let zero = pair(500, 359_500);
        let inside = angle > 359_500 || angle <= 500;
        assert_eq!(cam::pulse(zero.0, zero.1, true), inside, "{angle}");
        for (signals, across) in [(ninety, false), (zero, true)] {
            let output = and(&[
                Contribution {
                    signal: signals.0,
                    inverted: true,
                },
                Contribution {
                    signal: signals.1,
                    inverted: false,
                },
            ]);
            let expected = !across && cam::pulse(signals.0, signals.1, false);
            assert_eq!(output, expected, "{angle}");
        }
    }
}

/// S840D-RETRACT-704, lines 20466 to 20473, with the cams at the limits (AX-07 CAM_AT): no position is beyond a limit whose cam has
/// not been passed.
#[test]
fn each_passed_limit_position_has_its_cam_passed() {
    use stillpoint_monitors::kernel::{Distance, Position};
    use stillpoint_monitors::sinumerik::{cam, limit_switch};
    use stillpoint_monitors::units::ModuloRange;

    let (plus, minus) = (5_000, -5_000);
    let ends = limit_switch::Config::new(true, [Position(plus); 2], [Position(minus); 2], 2);
    let ends = ends.expect("plausible");
    // A cam is 1 to its right only, so that of the lower end lies on the last position beyond it.
    let beyond = |at: i32, position: i32| {
        let (tol, none) = (Distance(100), ModuloRange::LINEAR);
        let config = cam::Config::new(true, Position(at), tol, false, none, tol);
        let inputs = cam::Inputs {
            power_on: false,
            position: Position(position),
            other: true,
        };
        let mut cam = cam::Monitor::new(config.expect("plausible"));
        cam.step(&inputs).sga
    };
    for position in -10_000..10_000 {
        let inputs = limit_switch::Inputs {
            active: true,
            select: false,
            position: Position(position),
        };
        let passed = limit_switch::Monitor::new(ends).step(&inputs);
        assert_eq!(passed.upper, beyond(plus, position));
        assert_eq!(passed.lower, !beyond(minus - 1, position));
    }
}
