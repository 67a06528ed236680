//! DB18 as the monitors know it is that of the signal table.

use std::collections::BTreeMap;

use stillpoint_monitors::sinumerik::db18::{Bit, PARTS, Part, Rights, Row, supplement};
use stillpoint_monitors::sinumerik::net_data::{self, Channel};
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

/// The ranges of an index that a parameter of an alarm lists: `1-64 INSE`, `65-128 OUTSE`, each with its name.
fn ranges(alarm: i64, parameter: usize) -> Vec<(i64, i64, String)> {
    let path = root().join("spec/families/sinumerik-840d/alarms.toml");
    let text = std::fs::read_to_string(path).expect("there");
    let table: toml::Table = text.parse().expect("TOML");
    let alarms = table["alarm"].as_array().expect("a list");
    let entry = alarms
        .iter()
        .find(|a| a["number"].as_integer() == Some(alarm));
    let text = entry.expect("listed")["parameters"][parameter].as_str();
    let (_, listed) = text
        .expect("a text")
        .split_once(" = ")
        .expect("what it says");
    let listed = listed.trim_start_matches("index for extended text: ");
    let parts = listed.split([';', ',']).map(str::trim);
    let parts = parts.map(|part| {
        let (range, name) = part.split_once(' ').expect("a name");
        let (first, last) = match range.rsplit_once('-') {
            Some(("", _)) | None => (range, range),
            Some(ends) => ends,
        };
        let number = |digits: &str| digits.parse().expect("a number");
        (
            number(first),
            number(last),
            name.trim_start_matches("$A_").to_owned(),
        )
    });
    parts.collect()
}

/// S840D-DIAG-704: every index of the extended texts is the one that the alarm's table lists.
#[test]
fn extended_texts_have_the_listed_numbers() {
    let rows = [
        ("INSE", Row::Insep),
        ("OUTSE", Row::Outsep),
        ("INSI", Row::Insip),
        ("OUTSI", Row::Outsip),
        ("MARKERSI", Row::Markersip),
    ];
    let listed = ranges(27090, 3);
    assert_eq!(listed.len(), 1 + rows.len());
    assert_eq!((listed[0].0, listed[0].1), (0, 0));
    assert_eq!(supplement(None), Some(0));
    for ((name, row), (first, last, printed)) in rows.into_iter().zip(&listed[1..]) {
        assert_eq!(name, printed);
        let numbers =
            (1..=64).map(|variable| i64::from(supplement(Some((row, variable))).expect(name)));
        assert!(numbers.eq(*first..=*last), "{name}");
        assert_eq!(supplement(Some((row, 0))), None);
        assert_eq!(supplement(Some((row, 65))), None);
    }

    let listed = ranges(27254, 2);
    let channels = [("INSE", Channel::Input), ("OUTSE", Channel::Output)];
    assert_eq!(listed.len(), channels.len() + 1);
    for ((name, channel), (first, last, printed)) in channels.into_iter().zip(&listed) {
        assert_eq!(name, printed);
        let numbers =
            (1..=64).map(|variable| i64::from(net_data::supplement(channel, Some(variable))));
        assert!(numbers.eq(*first..=*last), "{name}");
        assert_eq!(i64::from(net_data::supplement(channel, None)), listed[2].0);
    }
}
