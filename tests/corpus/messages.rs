//! Acknowledgement, twins and priorities of every alarm are those of the manual's tables.

use std::collections::{BTreeMap, BTreeSet};

use stillpoint_monitors::sinumerik::alarm::{Alarm, Class};
use stillpoint_monitors::sinumerik::alarm_display::SuppressLevel;
use stillpoint_monitors::sinumerik::message::{
    NUMBERS, acknowledgement, comes_twice, hides, is_tested, partner,
};
use stillpoint_tests::root;
use toml::{Table, Value};

fn alarms() -> BTreeMap<u32, Table> {
    let path = root().join("spec/families/sinumerik-840d/alarms.toml");
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    let parsed: Table = text.parse().expect("the table is TOML");
    let entries = parsed["alarm"].as_array().expect("a list").iter();
    let entries = entries.map(|entry| {
        let entry = entry.as_table().expect("a table").clone();
        let number = entry["number"].as_integer().expect("a number");
        (u32::try_from(number).expect("small"), entry)
    });
    entries.collect()
}

fn text<'a>(entry: &'a Table, key: &str) -> &'a str {
    entry.get(key).and_then(Value::as_str).unwrap_or("")
}

/// S840D-ALARM-711.
#[test]
fn every_alarm_is_acknowledged_as_listed() {
    let listed = alarms();
    assert!(listed.keys().copied().eq(NUMBERS), "95 alarms");
    for (number, entry) in &listed {
        let own = acknowledgement(*number).expect("known");
        let printed = text(entry, "acknowledgement");
        // The line of 27299 is lost: reading AX-03.
        if printed == "not stated" {
            assert_eq!((*number, own.class), (27299, Class::PowerOn));
            continue;
        }
        let class = printed.split(';').next();
        assert_eq!(class, Some(own.class.keyword()), "{number}");
        assert_eq!(own.escalates, printed.contains("power-on if"), "{number}");
    }
    // What the monitors raise is acknowledged alike in both places.
    for alarm in Alarm::ALL {
        let nck = alarm.nck();
        assert_eq!(acknowledgement(nck.number), Some(nck.acknowledgement));
        if let Some(drive) = alarm.drive() {
            assert_eq!(acknowledgement(drive.number), Some(drive.acknowledgement));
        }
    }
}

/// S840D-ALARM-702.
#[test]
fn alarms_are_suppressed_as_listed() {
    for (number, entry) in alarms() {
        let printed = text(&entry, "suppression");
        let pair = NUMBERS
            .into_iter()
            .any(|nck| nck == number && partner(nck).is_some() || partner(nck) == Some(number));
        assert_eq!(
            pair,
            printed.starts_with("duplicate of the other channel"),
            "{number}"
        );
        if let Some(drive) = partner(number) {
            assert_eq!(text(&entry, "counterpart"), drive.to_string());
        }
        assert_eq!(
            comes_twice(number),
            printed.starts_with("second, PLC-requested initiation"),
            "{number}"
        );
    }
    assert_eq!(SuppressLevel::new(2), Some(SuppressLevel::default()));
}

/// The lists of 8.5.2 (lines 14776 to 14812), number by number. S840D-ALARM-704, S840D-ALARM-705, S840D-ALARM-706,
/// S840D-ALARM-707.
#[test]
fn follow_on_alarms_are_the_printed_ones() {
    let compared = [27001, 27101, 27102, 27103, 27104, 27105, 27106, 27107];
    let of_27090: BTreeSet<u32> = [
        27001, 27004, 27020, 27021, 27022, 27023, 27024, 27091, 27101, 27102, 27103, 27104, 27105,
        27106, 27107,
    ]
    .into();
    let of_27004: BTreeSet<u32> = [
        27001, 27023, 27024, 27101, 27102, 27103, 27104, 27105, 27106, 27107,
    ]
    .into();
    let of_compared: BTreeSet<u32> = [27023, 27024].into();
    let mut pairs = 0;
    for first in NUMBERS {
        let printed = match first {
            27090 => of_27090.clone(),
            27004 => of_27004.clone(),
            _ if compared.contains(&first) => of_compared.clone(),
            _ => BTreeSet::new(),
        };
        let hidden = |of_inputs| {
            NUMBERS
                .into_iter()
                .filter(move |f| hides(first, of_inputs, *f))
        };
        assert!(hidden(true).eq(printed.iter().copied()), "{first}");
        pairs += printed.len();
        // A 27090 about another variable than $A_INSE hides nothing; the others need no such condition.
        let other: Vec<u32> = hidden(false).collect();
        assert_eq!(
            other.is_empty(),
            first == 27090 || printed.is_empty(),
            "{first}"
        );
    }
    assert_eq!(pairs, 15 + 10 + 8 * 2);
}

/// 7.4.2, lines 9900 to 9905: the three pairs that RESET acknowledges in the acceptance test mode, and no others.
/// S840D-ACCEPT-742.
#[test]
fn reset_acknowledges_three_pairs_in_the_acceptance_test() {
    let tested: Vec<u32> = NUMBERS.into_iter().filter(|n| is_tested(*n)).collect();
    assert_eq!(tested, [27010, 27023, 27024, 300900, 300901, 300907]);
    for number in tested {
        let class = acknowledgement(number).map(|own| own.class);
        assert_eq!(class, Some(Class::PowerOn));
    }
}
