//! DB18 as the monitors know it is that of the signal table.

use std::collections::BTreeMap;

use stillpoint_monitors::sinumerik::db18::{Bit, PARTS, Part, Rights};
use stillpoint_tests::root;

/// Where a signal begins: `DB18.DBX38.0 ...`, `DB18.DBB0 bit 0..7`, `DB18.DBW4`.
fn first(address: &str) -> Bit {
    let rest = address.strip_prefix("DB18.DB").expect("in DB18");
    let (kind, rest) = rest.split_at(1);
    let digits = |text: &str| {
        text.chars()
            .take_while(char::is_ascii_digit)
            .collect::<String>()
    };
    let byte = digits(rest);
    let bit = match kind {
        "X" => digits(&rest[byte.len() + 1..]),
        _ => "0".to_owned(),
    };
    Bit {
        byte: byte.parse().expect("a byte"),
        bit: bit.parse().expect("a bit"),
    }
}

/// How many bits a type has.
fn bits(kind: &str) -> u16 {
    match kind.split_once('[') {
        Some((_, count)) => count.trim_end_matches(']').parse().expect("a number"),
        None => match kind {
            "BOOL" => 1,
            "INT" => 16,
            "DINT" => 32,
            other => panic!("{other}"),
        },
    }
}

/// S840D-SPLIO-009, S840D-SPLIO-010: every part of the table stands in the monitors with its place, its length and its rights; what is
/// several signals there is one part, given by the first.
#[test]
fn parts_of_db18_are_those_of_the_table() {
    let path = root().join("spec/families/sinumerik-840d/signals.toml");
    let text = std::fs::read_to_string(path).expect("there");
    let table: toml::Table = text.parse().expect("TOML");
    let signals = table["signal"].as_array().expect("a list");
    let mut expected: BTreeMap<String, Part> = BTreeMap::new();
    for signal in signals
        .iter()
        .filter(|s| s["kind"].as_str() == Some("DB18"))
    {
        let word = |key: &str| signal[key].as_str().expect(key);
        let rights = match word("access") {
            "r" => Rights::Read,
            "r/w" => Rights::ReadWrite,
            _ => continue,
        };
        let id = word("id");
        let (name, number) = id.rsplit_once('_').expect("a name");
        let group = match number.parse::<u8>() {
            Ok(_) => name,
            Err(_) => id,
        };
        let length = bits(word("type"));
        if let Some(part) = expected.get_mut(group) {
            assert_eq!(part.rights, rights, "{id}");
            part.bits += length;
            continue;
        }
        let known = PARTS.iter().find(|part| part.id == id);
        let known = known.unwrap_or_else(|| panic!("the monitors have no {id}"));
        let part = Part {
            id: known.id,
            first: first(word("address")),
            bits: length,
            rights,
        };
        expected.insert(group.to_owned(), part);
    }
    let mut expected: Vec<Part> = expected.into_values().collect();
    expected.sort_by_key(|part| (part.first.byte, part.first.bit));
    assert_eq!(PARTS, expected);
    // No two parts share a bit.
    for pair in PARTS.windows(2) {
        let place = |part: &Part| u16::from(part.first.byte) * 8 + u16::from(part.first.bit);
        assert!(
            place(&pair[0]) + pair[0].bits <= place(&pair[1]),
            "{pair:?}"
        );
    }
}
