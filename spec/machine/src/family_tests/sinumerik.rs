//! The data of the shipped family against the tables of the manual, and every plausibility rule against examples.

use std::collections::{BTreeMap, BTreeSet};

use super::super::AxisKind;
use super::super::family::{Family, Param, Quantity};
use super::super::signal::datum;
use super::super::units::{Dimension, parse};

const FAMILY: &str = "sinumerik-840d";

fn family() -> Family {
    super::family(FAMILY)
}

fn table(file: &str) -> toml::Table {
    super::table(FAMILY, file)
}

/// The machine data of the manual by their numbers.
fn machine_data() -> BTreeMap<i64, toml::Value> {
    let data = table("machine-data.toml");
    let list = data["parameter"].as_array().expect("a list");
    list.iter()
        .map(|p| (p["number"].as_integer().expect("a number"), p.clone()))
        .collect()
}

/// A number of the manual's table in base units.
fn base(value: &toml::Value, unit: &str, param: &Param, kind: AxisKind) -> i64 {
    let number = match value {
        toml::Value::Integer(n) => n.to_string(),
        toml::Value::Float(x) => format!("{x}"),
        other => panic!("{other} is no number"),
    };
    let (linear, rotary) = unit.split_once('|').unwrap_or((unit, unit));
    let unit = match kind {
        AxisKind::Linear => linear,
        AxisKind::Rotary => rotary,
    };
    let dimension = param.quantity.dimension(kind);
    let text = match dimension {
        Dimension::Count => number,
        _ => format!("{number} {unit}"),
    };
    parse(&text, dimension).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// The number after `MD` in each part of `MD36930/MD1330 $MA_...`.
fn numbers(param: &Param) -> Vec<i64> {
    let numbers = param.manual.split(' ').next().unwrap_or("");
    numbers
        .split('/')
        .filter_map(|n| n.strip_prefix("MD")?.parse().ok())
        .collect()
}

#[test]
fn ranges_are_the_smaller_ones_of_both_channels() {
    let (family, data) = (family(), machine_data());
    let mut compared = 0;
    for (name, param) in family.control.iter().chain(&family.axis) {
        for kind in [AxisKind::Linear, AxisKind::Rotary] {
            let tighter = match kind {
                AxisKind::Linear => "max_linear",
                AxisKind::Rotary => "max_rotary",
            };
            let (mut least, mut greatest) = (i64::MIN, i64::MAX);
            for number in numbers(param) {
                let entry = data
                    .get(&number)
                    .unwrap_or_else(|| panic!("{name}: no MD{number}"));
                let unit = entry["unit"].as_str().expect("a unit");
                let get = |key| entry.get(key).map(|v| base(v, unit, param, kind));
                least = least.max(get("min").unwrap_or(i64::MIN));
                for key in ["max", tighter] {
                    greatest = greatest.min(get(key).unwrap_or(i64::MAX));
                }
                compared += 1;
            }
            if let Some(first) = numbers(param).first() {
                let limits = param.limits(kind);
                // Of the signals that the manual admits, a parameter lists those that are modelled.
                if param.quantity == Quantity::Signal {
                    let codes = [limits.min, limits.max].map(datum);
                    assert!(
                        codes.iter().all(|c| (least..=greatest).contains(c)),
                        "{name}"
                    );
                } else {
                    assert_eq!(
                        (limits.min, limits.max),
                        (least, greatest),
                        "{name} {kind:?}"
                    );
                }
                let unit = data[first]["unit"].as_str().expect("a unit");
                let default = base(&data[first]["default"], unit, param, kind);
                assert_eq!(limits.default, default, "default of {name}");
            }
        }
    }
    assert!(compared > 100, "{compared} comparisons");
}

/// Where the drive calls a value otherwise than the NCK.
const OTHERWISE: [(i64, &str); 1] = [(1380, "$MD_SAFE_PULSE_DIS_TIME_FAIL")];

#[test]
fn names_choices_and_lengths_are_those_of_the_manual() {
    let (family, data) = (family(), machine_data());
    for (name, param) in family.control.iter().chain(&family.axis) {
        for number in numbers(param) {
            let datum = &data[&number];
            let printed = datum["name"].as_str().expect("a name");
            assert!(
                printed.ends_with(name.as_str()) || OTHERWISE.contains(&(number, printed)),
                "{name}: MD{number} is {printed}"
            );
            let size = datum
                .get("array_size")
                .and_then(toml::Value::as_integer)
                .unwrap_or(1);
            assert_eq!(
                i64::try_from(param.count.max(1)),
                Ok(size),
                "values of {name}"
            );
            if param.quantity == Quantity::Choice {
                let codes: BTreeSet<i64> = param.choices.iter().map(|(_, code)| *code).collect();
                let allowed = datum["allowed"].as_array().expect("a list").iter();
                let allowed: BTreeSet<i64> = allowed.filter_map(toml::Value::as_integer).collect();
                assert_eq!(codes, allowed, "choices of {name}");
            }
        }
    }
}

#[test]
fn functions_are_the_bits_of_the_enable_word() {
    let (family, data) = (family(), machine_data());
    let bits = data[&36901]["bits"].as_array().expect("bits");
    let printed: BTreeMap<u32, &str> = bits
        .iter()
        .map(|b| {
            (
                b["bit"].as_integer().and_then(|n| u32::try_from(n).ok()),
                b["name"].as_str(),
            )
        })
        .filter_map(|(bit, name)| Some((bit?, name?)))
        .filter(|(_, name)| *name != "reserved")
        .collect();
    let ours: BTreeSet<u32> = family.functions.iter().map(|f| f.bit).collect();
    assert_eq!(ours, printed.keys().copied().collect());
    for function in family
        .functions
        .iter()
        .filter(|f| f.name.starts_with("SN") || f.bit < 2)
    {
        assert_eq!(printed[&function.bit], function.name);
    }
    let cells: BTreeSet<_> = family
        .functions
        .iter()
        .map(|f| (&f.variable, f.index))
        .collect();
    assert_eq!(
        cells.len(),
        family.functions.len(),
        "two functions share a variable"
    );
}

#[test]
fn alarms_exist() {
    let alarms = table("alarms.toml");
    let alarms = alarms["alarm"].as_array().expect("a list").iter();
    let known: BTreeSet<i64> = alarms.filter_map(|a| a["number"].as_integer()).collect();
    for rule in family().rules {
        assert!(
            rule.alarm.is_none_or(|a| known.contains(&i64::from(a))),
            "{:?}",
            rule.alarm
        );
    }
}

/// Table 4-1 of the manual: six systems are permitted, no other one (S840D-ENC-001).
#[test]
fn encoder_systems_are_those_of_the_manual() {
    let mut accepted = Vec::new();
    for motor in ["none", "incremental", "absolute"] {
        for second in ["none", "incremental", "absolute"] {
            let text = format!(
                "axis.X = {{ kind = \"linear\", MOTOR_ENCODER = \"{motor}\", LOAD_ENCODER = \"{second}\", functions = [\"SBH/SG\"] }}"
            );
            if super::load(FAMILY, &text).is_ok() {
                accepted.push((motor, second));
            }
        }
    }
    assert_eq!(
        accepted,
        [
            ("incremental", "none"),
            ("incremental", "incremental"),
            ("incremental", "absolute"),
            ("absolute", "none"),
            ("absolute", "incremental"),
            ("absolute", "absolute"),
        ]
    );
}
