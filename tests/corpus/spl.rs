//! The places of the safe logic in DB18, as the monitors have them and as the table of the signals has them.

use std::collections::BTreeMap;

use stillpoint_monitors::sinumerik::spl::{Block, place};
use stillpoint_monitors::sinumerik::spl_comparison::Number;
use stillpoint_monitors::sinumerik::spl_start::{Call, Config, Inputs, Program, State, next};
use stillpoint_tests::root;
use toml::{Table, Value};

/// The addresses of the signals that have one, by their ids.
fn addresses() -> BTreeMap<String, String> {
    let path = root().join("spec/families/sinumerik-840d/signals.toml");
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    let table: Table = text.parse().expect("the table is TOML");
    let signals = table["signal"].as_array().expect("a list").clone();
    let of = |s: &Value| {
        Some((
            s["id"].as_str()?.to_owned(),
            s.get("address")?.as_str()?.to_owned(),
        ))
    };
    signals.iter().filter_map(of).collect()
}

/// Byte and bit of an address in DB18.
fn bit(address: &str) -> (u16, u8) {
    let address = address
        .trim_start_matches("DB18.")
        .trim_start_matches("DBX");
    let (byte, bit) = address.split_once('.').expect("byte and bit");
    (byte.parse().expect("a byte"), bit.parse().expect("a bit"))
}

/// First and last bit of a block in DB18: `DB18.DBX38.0 .. DBX45.7`.
fn ends(address: &str) -> [(u16, u8); 2] {
    let (first, rest) = address.split_once(" .. ").expect("a range");
    [first, rest.split(' ').next().expect("a bit")].map(bit)
}

/// S840D-SPL-002, S840D-SPLKDV-009, S840D-SPLKDV-010.
#[test]
fn compared_signals_lie_where_the_table_says() {
    let addresses = addresses();
    let names = ["INSEP", "OUTSEP", "INSIP", "OUTSIP", "MARKERSIP"];
    for (block, name) in Block::ALL.into_iter().zip(names) {
        let numbers = [block.number(1), block.number(Block::LEN)];
        let places = numbers.map(|number| place(number).expect("a signal"));
        let data = places.map(|(byte, _, bit)| (byte, bit));
        let delta = places.map(|(_, byte, bit)| (byte, bit));
        assert_eq!(data, ends(&addresses[&format!("DB18_{name}")]), "{name}");
        assert_eq!(
            delta,
            ends(&addresses[&format!("DB18_DELTA_{name}")]),
            "{name}"
        );
    }
    assert_eq!(place(Number::NONE), None);
}

/// S840D-SPLSTART-015, S840D-SPLSTART-002, S840D-SPLSTART-004, S840D-SPLSTART-006: the bits of the status word that each step of
/// the start adds, at the addresses of the table.
#[test]
fn status_bits_lie_where_the_table_says() {
    let addresses = addresses();
    for k in 0..14 {
        let expected = (136 + k / 8, (k % 8) as u8);
        let id = format!("DB18_SPL_STATUS_{}", k + 1);
        assert_eq!(bit(&addresses[&id]), expected, "{id}");
    }
    let on = Inputs {
        parameters: true,
        file: true,
        axes: stillpoint_monitors::sinumerik::spl_start::Axes::Fit,
        protected_n: true,
        protected_p: true,
        plc_up: true,
        upper: true,
        mask: true,
        level: true,
        ..Inputs::default()
    };
    let calls = |inputs: [Inputs; 7]| {
        let mut state = State::INITIAL;
        inputs.map(|inputs| {
            let (after, outputs) = next(state, &Config, &inputs);
            state = after;
            outputs.status
        })
    };
    let call = |call| Inputs { call, ..on };
    let begin = Inputs {
        power_on: true,
        ..on
    };
    let end = Inputs {
        program: Program::Ends,
        ..on
    };
    let by_plc = calls([
        begin,
        on,
        call(Call::Assign),
        call(Call::Assigned),
        call(Call::Start),
        end,
        call(Call::Started),
    ]);
    assert_eq!(
        by_plc,
        [
            0b111,
            0b1111,
            0b1_1111,
            0b11_1111,
            0b1_1110_0111_1111,
            0b11_1110_0111_1111,
            0b11_1110_1111_1111
        ]
    );
    let event = Inputs { event: true, ..on };
    let by_event = calls([begin, on, event, on, end, on, on]);
    let running = 0b1_1111_0000_1111;
    let ended = 0b11_1111_0000_1111;
    assert_eq!(
        by_event,
        [0b111, 0b1111, running, running, ended, ended, ended]
    );
}
