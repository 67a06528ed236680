//! `heidenhain-fs`: what becomes of the values of a machine, in whole cycles and in the tables.

use std::collections::BTreeMap;

use super::super::family::{Param, Quantity, Rounding};
use super::heidenhain::{machine, refused_machine};

const FAMILY: &str = "heidenhain-fs";

/// Each time, in microseconds, becomes the most cycles that end in it, or the least that are over after it.
#[test]
fn times_become_cycles_by_one_rule() {
    const CYCLE: i64 = 3_000;
    for time in (0..=60_000_000).step_by(1_000) {
        let (down, up) = (
            Rounding::Down.cycles(time, CYCLE),
            Rounding::Up.cycles(time, CYCLE),
        );
        assert!(down * CYCLE <= time && time < (down + 1) * CYCLE, "{time}");
        assert!((up - 1) * CYCLE < time && time <= up * CYCLE, "{time}");
    }
}

/// The times that are rounded down: those in which something has to happen.
#[test]
fn times_that_must_not_come_later() {
    let family = super::family(FAMILY);
    let all = family.control.iter().chain(&family.axis);
    let times = all.filter(|(_, p)| p.quantity == Quantity::Time);
    let (down, up): (Vec<_>, Vec<_>) = times.partition(|(_, p)| p.cycles == Rounding::Down);
    let names = |list: Vec<(&String, &Param)>| -> Vec<String> {
        list.into_iter().map(|(name, _)| name.clone()).collect()
    };
    let watched = [
        "SMP2172", "SMP525", "SMP526", "SMP527", "SMP528", "SMP530", "SMP632", "SMP633",
    ];
    assert_eq!(names(down), watched);
    assert_eq!(names(up), ["MP7602", "SMP511", "MP2308"]);
}

/// What a control does not take is refused, not rounded.
#[test]
fn values_finer_than_the_control_takes_are_refused() {
    for (control, axis) in [
        ("", ", SMP590 = \"1999.5 mm/min\""),
        ("", ", SMP525 = \"1000.5 ms\""),
        ("SMP511 = \"61 s\"", ""),
        ("SMP591 = \"10.5 rev/min\"", ""),
    ] {
        let errors = refused_machine(&machine(control, axis, ""));
        assert!(
            errors.len() == 1 && errors[0].contains("is finer than the control takes"),
            "{control}{axis}: {errors:#?}"
        );
    }
}

/// Systems whose values are their own, as their `note` in `family.toml` or the reason here says: small numbers that show every
/// branch, or each of the possible wirings.
const OWN_VALUES: [(&str, &str); 25] = [
    ("operation.toml", "ss0_signals"),
    ("mode.toml", "permissive"),
    ("monitors.toml", "standstill"),
    ("monitors.toml", "braking_path"),
    ("monitors.toml", "end_position"),
    ("monitors.toml", "axis_values"),
    ("monitors.toml", "spindle_values"),
    ("monitors.toml", "axis_braking"),
    ("monitors.toml", "spindle_braking"),
    ("selftest.toml", "test"),
    ("selftest.toml", "no_brake_control"),
    ("cutout.toml", "feedback"),
    ("channels.toml", "channels"),
    ("faults-two-channels.toml", "fault_requests"),
    ("faults-two-channels.toml", "fault_kernel"),
    ("faults-two-channels.toml", "fault_feedback"),
    ("faults-two-channels.toml", "fault_encoder"),
    ("operation.toml", "f_limited"),
    ("operation.toml", "two_keys"),
    ("operation.toml", "restart"),
    ("response.toml", "cut_out_time"),
    // SMP610 decides whether it is explored at all.
    ("stop.toml", "groups"),
    // `when` decides between them: the option is in the name.
    ("mode.toml", "keylock"),
    ("mode.toml", "keylock_3"),
    ("cutout.toml", "no_brake"),
];

/// SMP585 to SMP587, SMP600 and SMP601 are no values of a machine file; SMP690 other than 0 is refused.
const NO_VALUES: [&str; 6] = ["SMP585", "SMP586", "SMP587", "SMP600", "SMP601", "SMP690"];

/// A parameter of a table that the table says to be a machine parameter has the value of the machine, or its system says that it
/// has values of its own: a constant in its place would be explored whatever the machine says.
#[test]
fn parameters_of_the_tables_are_those_of_the_machine() {
    let family = super::table(FAMILY, "family.toml");
    let mut unbound = Vec::new();
    let mut own = Vec::new();
    for explore in family["explore"].as_array().expect("a list") {
        let text = |key: &str| explore[key].as_str().expect("a text");
        let (file, name) = (text("file"), text("system"));
        let machines = machines_of(file);
        let table = super::table(FAMILY, file);
        let system = &table["system"][name];
        let keys = |key: &str| -> Vec<String> {
            let table = explore.get(key).and_then(toml::Value::as_table);
            table.map_or_else(Vec::new, |t| t.keys().cloned().collect())
        };
        let bound = [keys("time"), keys("param")].concat();
        let mut named = false;
        for instance in system["instance"].as_table().expect("instances").values() {
            let machine = &machines[instance["machine"].as_str().expect("a name")];
            let Some(params) = machine.get("param").and_then(toml::Value::as_table) else {
                continue;
            };
            for (param, declared) in params {
                let told = |of: Option<&toml::Value>| -> bool {
                    let text = of.and_then(|p| p.get("text")).and_then(toml::Value::as_str);
                    text.is_some_and(|t| {
                        t.split(|c: char| !c.is_ascii_alphanumeric())
                            .any(|w| is_datum(w) && !NO_VALUES.contains(&w))
                    })
                };
                let of_system = system.get("param").and_then(|p| p.get(param));
                if (told(Some(declared)) || told(of_system)) && !bound.contains(param) {
                    named = true;
                    if !OWN_VALUES.contains(&(file, name)) {
                        unbound.push(format!("{file} {name}: {param}"));
                    }
                }
            }
        }
        if named && OWN_VALUES.contains(&(file, name)) {
            own.push((file.to_owned(), name.to_owned()));
        }
    }
    assert!(unbound.is_empty(), "{unbound:#?}");
    for (file, name) in OWN_VALUES {
        let entry = (file.to_owned(), name.to_owned());
        assert!(
            own.contains(&entry),
            "{file} {name} has no value of its own"
        );
    }
}

/// `SMP525`, `MP7602`.
fn is_datum(word: &str) -> bool {
    let digits = word.strip_prefix("SMP").or_else(|| word.strip_prefix("MP"));
    digits.is_some_and(|d| d.len() >= 3 && d.chars().all(|c| c.is_ascii_digit()))
}

/// The machines that a file of the tables declares or uses.
fn machines_of(file: &str) -> BTreeMap<String, toml::Value> {
    let mut machines = BTreeMap::new();
    let mut files = vec![file.to_owned()];
    let mut k = 0;
    while let Some(file) = files.get(k).cloned() {
        k += 1;
        let table = super::table(FAMILY, &file);
        let uses = table.get("use").and_then(toml::Value::as_array);
        for used in uses.into_iter().flatten().filter_map(toml::Value::as_str) {
            if !files.iter().any(|f| f == used) {
                files.push(used.to_owned());
            }
        }
        let declared = table.get("machine").and_then(toml::Value::as_table);
        for (name, machine) in declared.into_iter().flatten() {
            machines
                .entry(name.clone())
                .or_insert_with(|| machine.clone());
        }
    }
    machines
}
