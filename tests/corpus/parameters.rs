//! The monitors' parameters are those of the manual: every range and default is compared with the machine data table, and
//! values beyond are refused.

use std::collections::BTreeMap;
use std::path::Path;

use stillpoint_monitors::sinumerik::parameters::{DATA, Datum, Parameters, Permitted, Unit};
use stillpoint_monitors::units::Axis;
use toml::Value;

/// The machine data table, by number.
fn table() -> BTreeMap<i64, Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../spec/families/sinumerik-840d/machine-data.toml");
    let text = std::fs::read_to_string(&path).expect("the table is part of the repository");
    let table: toml::Table = text.parse().expect("the table is TOML");
    table["parameter"]
        .as_array()
        .expect("a list of parameters")
        .iter()
        .map(|entry| {
            (
                entry["number"].as_integer().expect("a number"),
                entry.clone(),
            )
        })
        .collect()
}

/// A number of the table in the unit of the monitors; it must be a whole one.
fn scaled(datum: &Datum, value: &Value) -> i64 {
    let number = value
        .as_integer()
        .map(|n| n as f64)
        .or(value.as_float())
        .expect("a number");
    let scaled = number * datum.unit.per_manual_unit() as f64;
    assert!(
        (scaled - scaled.round()).abs() < 1e-6,
        "MD{}: {number} is no multiple of the unit",
        datum.number
    );
    scaled.round() as i64
}

/// Whether a unit of the monitors measures what the unit of the table measures.
fn same_quantity(unit: Unit, printed: &str) -> bool {
    match unit {
        Unit::Number => printed == "1",
        Unit::Choice => printed == "enum" || printed == "bool",
        Unit::Bits => printed == "bitmask",
        Unit::Percent => printed == "%",
        Unit::Hertz => printed == "Hz",
        Unit::Microseconds => printed == "s",
        Unit::Length => printed == "mm|deg",
        Unit::Angle => printed == "deg",
        Unit::Grid => printed == "mm",
        Unit::Pitch => printed == "mm/rev",
        Unit::Speed => printed == "mm/min|rev/min",
    }
}

/// S840D-PARAM-002, S840D-MDCHK-032/a.
#[test]
fn ranges_and_defaults_are_those_of_the_table() {
    let table = table();
    let defaults = Parameters::default();
    for datum in DATA {
        let md = datum.number;
        let entry = &table[&i64::from(md)];
        let name = entry["name"].as_str().expect("a name");
        assert_eq!(
            name.trim_start_matches("$MN_").trim_start_matches("$MA_"),
            datum.name
        );
        let unit = entry["unit"].as_str().expect("a unit");
        assert!(same_quantity(datum.unit, unit), "MD{md}: unit {unit}");
        let count = entry["array_size"].as_integer().expect("a size");
        assert_eq!(datum.count as i64, count, "MD{md}: elements");

        match (entry.get("allowed"), datum.permitted) {
            (Some(allowed), Permitted::Values(values)) => {
                let allowed: Vec<i64> = allowed
                    .as_array()
                    .expect("a list")
                    .iter()
                    .map(|v| v.as_integer().expect("an integer"))
                    .collect();
                assert_eq!(values, allowed, "MD{md}: list of values");
            }
            (None, Permitted::Range(min, max)) => {
                assert_eq!(min, scaled(datum, &entry["min"]), "MD{md}: least value");
                assert_eq!(max, scaled(datum, &entry["max"]), "MD{md}: greatest value");
            }
            (allowed, permitted) => panic!("MD{md}: {allowed:?} in the table, {permitted:?} here"),
        }
        assert_eq!(
            datum.linear_max,
            entry.get("max_linear").map(|v| scaled(datum, v)),
            "MD{md}: greatest value of a linear axis"
        );
        if let Some(rotary) = entry.get("max_rotary") {
            assert_eq!(
                datum.permitted_on(Axis::Rotary),
                Permitted::Range(scaled(datum, &entry["min"]), scaled(datum, rotary)),
                "MD{md}: rotary axis"
            );
        }
        for index in 0..datum.count {
            assert_eq!(
                (datum.value)(&defaults, index),
                scaled(datum, &entry["default"]),
                "MD{md}[{index}]: default"
            );
        }
    }
}

/// What both channels hold, the drive must be able to hold too: its range is not smaller than the one enforced.
#[test]
fn the_drive_holds_every_permitted_value() {
    let table = table();
    let mut compared = 0;
    for datum in DATA {
        let entry = &table[&i64::from(datum.number)];
        let counterpart = entry
            .get("counterpart")
            .and_then(Value::as_str)
            .and_then(|text| text.split([' ', ',']).next())
            .and_then(|number| number.parse::<i64>().ok());
        let Some(drive) = counterpart.and_then(|number| table.get(&number)) else {
            continue;
        };
        let (Some(min), Some(max)) = (drive.get("min"), drive.get("max")) else {
            continue;
        };
        let Permitted::Range(least, greatest) = datum.permitted else {
            continue;
        };
        // The unit of the drive: its own for lengths and times, that of the NCK for the others.
        let unit = drive["unit"].as_str().expect("a unit");
        let factor = match (datum.unit, unit) {
            (Unit::Length, "um|mdeg") | (Unit::Angle, "mdeg") => 1.0,
            (Unit::Microseconds, "ms") | (Unit::Grid, "um") => 1000.0,
            (Unit::Microseconds, _) | (Unit::Number, "31.25us") | (Unit::Choice, _) => continue,
            (own, _) => own.per_manual_unit() as f64,
        };
        let number = |v: &Value| {
            v.as_integer()
                .map(|n| n as f64)
                .or(v.as_float())
                .expect("a number")
        };
        let md = datum.number;
        assert!(
            number(min) * factor <= least as f64 + 1e-6,
            "MD{md}: {least} is less than the drive holds"
        );
        assert!(
            number(max) * factor >= greatest as f64 - 1e-6,
            "MD{md}: {greatest} is more than the drive holds"
        );
        compared += 1;
    }
    assert!(
        compared >= 25,
        "only {compared} machine data have a compared counterpart"
    );
}

/// The manual's defaults are valid, and every bound is tight: the value beyond is refused by name.
#[test]
fn values_beyond_the_range_are_refused() {
    assert!(Parameters::default().validate().is_ok());
    let refused =
        |parameters: Parameters| parameters.validate().expect_err("out of range").to_string();
    let message = refused(Parameters {
        standstill_tol: 0,
        ..Parameters::default()
    });
    assert_eq!(
        message,
        "MD36930 SAFE_STANDSTILL_TOL[0] = 0 um: permitted is 1 to 100000 um"
    );
    let message = refused(Parameters {
        pos_tol: 10_001,
        ..Parameters::default()
    });
    assert_eq!(
        message,
        "MD36942 SAFE_POS_TOL[0] = 10001 um: permitted is 1 to 10000 um"
    );
    let rotary = Parameters {
        is_rot_ax: true,
        pos_tol: 10_001,
        ..Parameters::default()
    };
    assert!(rotary.validate().is_ok());
    let message = refused(Parameters {
        velo_stop_reaction: [2, 2, 5, 2],
        ..Parameters::default()
    });
    assert_eq!(
        message,
        "MD36963 SAFE_VELO_STOP_REACTION[2] = 5: permitted is 0, 1, 2, 3, 4, 10, 11, 12, 13, 14"
    );
}
