//! `heidenhain-fs`: parameters, axis groups, and a logic of its own.

use std::collections::BTreeMap;

use super::super::AxisKind;
use super::super::family::{Param, Quantity};
use super::super::units::{Dimension, parse};
use super::{exceptions, load};

const FAMILY: &str = "heidenhain-fs";

/// A printed number in base units; digits below a base unit are cut off.
fn base(printed: &str, unit: &str, param: &Param, kind: AxisKind) -> Option<i64> {
    let number = printed.split(' ').next()?;
    number.parse::<f64>().ok()?;
    let number = match number.split_once('.') {
        Some((whole, decimals)) if decimals.len() > 3 => format!("{whole}.{}", &decimals[..3]),
        _ => number.to_owned(),
    };
    let (linear, rotary) = unit.split_once(" or ").unwrap_or((unit, unit));
    let unit = match (unit, kind) {
        ("mm/min", AxisKind::Rotary) => "deg/min",
        ("rpm", _) => "rev/min",
        (_, AxisKind::Linear) => linear,
        (_, AxisKind::Rotary) => rotary,
    };
    let text = match (param.quantity.dimension(kind), unit) {
        (Dimension::Count, _) => number,
        // A multiple in percent.
        (Dimension::Percent, "x stall current") => {
            return Some((number.parse::<f64>().ok()? * 100.0) as i64);
        }
        _ => format!("{number} {unit}"),
    };
    Some(parse(&text, param.quantity.dimension(kind)).unwrap_or_else(|e| panic!("{text}: {e:?}")))
}

#[test]
fn parameters_are_those_of_the_manual() {
    let family = super::family(FAMILY);
    let table = super::table(FAMILY, "machine-parameters.toml");
    let printed = table["parameter"].as_array().expect("a list").iter();
    let printed: BTreeMap<&str, &toml::Value> = printed
        .map(|p| (p["name"].as_str().expect("a name"), p))
        .collect();
    let params = [&family.control, &family.axis];
    let params = params.into_iter().chain(&family.group).flatten();
    let mut named: Vec<&str> = Vec::new();
    let mut compared = 0;
    for (key, param) in params {
        let datum = printed.get(param.manual.as_str());
        let datum = datum.unwrap_or_else(|| panic!("{key}: no '{}' is printed", param.manual));
        named.push(&param.manual);
        let short = param.manual.trim_end_matches(".x").replace(" bit ", "_");
        assert_eq!(*key, short, "the key is the name");
        let get = |key: &str| datum[key].as_str().expect("a text");
        for kind in [AxisKind::Linear, AxisKind::Rotary] {
            let limits = param.limits(kind);
            let ours = [
                ("min", limits.min),
                ("max", limits.max),
                ("default", limits.default),
            ];
            for (what, value) in ours {
                // Bits and lists of groups have no range of their own; 0 stands beside the range of SMP2230.
                let other = matches!(param.quantity, Quantity::Bool | Quantity::Groups);
                if other || (param.manual == "SMP2230.x" && what == "min") {
                    continue;
                }
                // A parameter of other kinds of axes has no value here.
                let word = match kind {
                    AxisKind::Linear => "linear",
                    AxisKind::Rotary => "rotary",
                };
                if !param.is_of(word) && !param.is_of("spindle") {
                    continue;
                }
                if let Some(printed) = base(get(what), get("unit"), param, kind) {
                    assert_eq!(value, printed, "{key}, {what}, {kind:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100, "{compared} numbers compared");
    let exceptions = exceptions("parameters of heidenhain-fs");
    named.extend(exceptions.iter().map(String::as_str));
    named.sort_unstable();
    let all: Vec<&str> = printed.keys().copied().collect();
    assert_eq!(
        named, all,
        "each printed parameter is here or left out, and once"
    );
}

/// A machine of one group of one axis, with more in each of its tables.
pub(super) fn machine(control: &str, axis: &str, more: &str) -> String {
    format!(
        "control = {{ {control} }}\naxis.X = {{ kind = \"linear\", SMP650 = \"9 mm\"{axis} }}\ngroup.NC.axes = [\"X\"]\n{more}"
    )
}

fn spindle(control: &str, axis: &str) -> String {
    format!(
        "control = {{ {control} }}\naxis.S = {{ kind = \"spindle\"{axis} }}\ngroup.S.axes = [\"S\"]"
    )
}

pub(super) fn examples() -> Vec<(&'static str, String, String)> {
    let of_axis = |text, bad: &str, good: &str| (text, machine("", bad, ""), machine("", good, ""));
    let of_control =
        |text, bad: &str, good: &str| (text, machine(bad, "", ""), machine(good, "", ""));
    let mut list = vec![
        of_control("bit 2 of SMP560", "SMP560_2 = true", "SMP560_2 = false"),
        of_control("bit 4 of SMP560", "SMP560_4 = true", "SMP560_3 = true"),
        of_control("bit 5 of SMP560", "SMP560_5 = true", "SMP560_6 = true"),
        of_control("bit 7 of SMP560", "SMP560_7 = true", "SMP560_8 = true"),
        of_control("bit 9 of SMP560", "SMP560_9 = true", "SMP560_0 = true"),
        of_control("bit 10 of SMP560", "SMP560_10 = true", "SMP560_12 = true"),
        of_control(
            "the dv/dt monitoring",
            "SMP560_11 = true",
            "SMP560_11 = false",
        ),
        of_control(
            "the checksum of the SPLC",
            "SMP690 = \"inactive\"",
            "SMP690 = \"active\"",
        ),
        of_control(
            "the delay is no whole",
            "SMP2172 = \"1.5 s\"",
            "SMP2172 = \"2 s\"",
        ),
        of_axis(
            "the test torque is below",
            ", SMP2230 = \"9 %\"",
            ", SMP2230 = \"135 %\"",
        ),
        of_axis(
            "the speed may rise",
            ", SMP530 = \"1 s\"",
            ", SMP530 = \"999 ms\"",
        ),
        of_axis(
            "the positive limit",
            ", SMP670 = \"9 mm\"",
            ", SMP670 = \"-9 mm\"",
        ),
        of_axis(
            "the mark for the axis check",
            ", SMP646 = \"10 mm\"",
            ", SMP646 = \"9 mm\"",
        ),
        of_axis(
            "an SS1 has no time",
            ", SMP525 = \"320 ms\"",
            ", SMP525 = \"321 ms\"",
        ),
        of_axis(
            "the way of a revolution",
            ", SMP1054 = \"0 mm\"",
            ", SMP1054 = \"1 mm\"",
        ),
        of_axis(
            "a limit of 0 in SOM_2",
            ", SMP590 = \"0 mm/min\"",
            ", SMP590 = \"1 mm/min\"",
        ),
        of_axis(
            "a limit of 0 in SOM_3",
            ", SMP540 = \"0 mm/min\"",
            ", SMP552 = \"0 mm/min\"",
        ),
    ];
    list.push((
        "a limit of 0 in SOM_4",
        machine("SMP560_0 = true", ", SMP552 = \"0 mm/min\"", ""),
        machine("SMP560_0 = true", ", SMP552 = \"1 mm/min\"", ""),
    ));
    list.push((
        "the rated speed is 0",
        spindle("", ", MP3510 = \"0 rev/min\""),
        spindle("", ", MP3510 = \"1 rev/min\""),
    ));
    list.push((
        "an SS1 has no time",
        spindle("", ", SMP526 = \"320 ms\""),
        spindle("", ", SMP526 = \"321 ms\""),
    ));
    for (text, limit) in [
        ("a limit of 0 in SOM_2", "SMP591"),
        ("a limit of 0 in SOM_3", "SMP541"),
    ] {
        let with = |value: &str| spindle(&format!("{limit} = \"{value} rev/min\""), "");
        list.push((text, with("0"), with("1")));
    }
    list.push((
        "a limit of 0 in SOM_4",
        spindle("SMP560_0 = true", ", SMP551 = \"0 rev/min\""),
        spindle("", ", SMP551 = \"0 rev/min\""),
    ));
    let two = |first: &str, second: &str, more: &str| {
        let axis = "kind = \"linear\", SMP650 = \"9 mm\"";
        format!("axis.X = {{ {axis}{first} }}\naxis.Y = {{ {axis}{second} }}\n{more}")
    };
    let auxiliary = ", MP100 = \"auxiliary axis\"";
    let one_group = "group.G.axes = [\"X\", \"Y\"]";
    list.push((
        "the axes are of different types",
        two("", auxiliary, one_group),
        two("", "", one_group),
    ));
    let doors = |space: &str| {
        format!(
            "{one_group}\ndoor.a = {{ groups = [\"G\"], space = \"magazine\" }}\ndoor.b = {{ groups = [\"G\"], space = \"{space}\" }}"
        )
    };
    list.push((
        "the group is behind doors of the working space and of the magazine",
        two(auxiliary, auxiliary, &doors("working space")),
        two(auxiliary, auxiliary, &doors("magazine")),
    ));
    let door = |space: &str| format!("door.a = {{ groups = [\"NC\"], space = \"{space}\" }}");
    list.push((
        "an axis behind the magazine door",
        machine("", "", &door("magazine")),
        machine("", "", &door("working space")),
    ));
    let asked = |guarantee: &str| {
        let guarantee = format!(
            "guarantee.asked = {{ {guarantee}, within = \"2 s\", after = \"any single fault of a channel or contact\" }}"
        );
        machine("", "", &format!("{}\n{guarantee}", door("working space")))
    };
    let stop = "pattern = \"emergency_stop\", axes = [\"X\"], contacts = 2";
    list.push((
        "one of the two contacts may be stuck",
        asked(stop),
        asked(&format!("{stop}, discrepancy = \"1 ms\"")),
    ));
    let promised = |way: &str| {
        asked(&format!(
            "{stop}, discrepancy = \"1 ms\", fastest = \"600 mm/min\", travel = \"{way}\""
        ))
    };
    list.push((
        "in that time the axis goes on further than is promised",
        promised("19.999 mm"),
        promised("20 mm"),
    ));
    let relays = |after: &str| {
        let relays = "pattern = \"contactor\", axes = [\"X\"], within = \"2 s\"";
        machine("", "", &format!("guarantee.asked = {{ {relays}{after} }}"))
    };
    list.push((
        "-STO.A.G is one signal of one channel",
        relays(", after = \"any single fault of a channel or contact\""),
        relays(""),
    ));
    let device = "pattern = \"enabling\", door = \"a\", mode = \"SOM_2\", way = \"10 mm\", device_contacts = 2";
    list.push((
        "one of the two contacts of the device may be stuck",
        asked(device),
        asked(&format!("{device}, device_discrepancy = \"1 ms\"")),
    ));
    let limits = |axis: &str, way: &str, speed: &str| {
        let guarantee = format!(
            "pattern = \"travel_limits\", axes = [\"X\"], from = \"-99 {way}\", to = \"99 {way}\", reaches = \"1 {speed}\", within = \"2 s\""
        );
        format!(
            "axis.X = {{ {axis}, SMP650 = \"9 {way}\" }}\ngroup.G.axes = [\"X\"]\nguarantee.asked = {{ {guarantee} }}"
        )
    };
    let linear = "kind = \"linear\"";
    list.push((
        "only an NC axis has a safely limited position",
        limits(&format!("{linear}{auxiliary}"), "mm", "mm/min"),
        limits(linear, "mm", "mm/min"),
    ));
    let rotary = "kind = \"rotary\"";
    list.push((
        "the position of the axis begins anew after SMP555",
        limits(&format!("{rotary}, SMP555 = \"360 deg\""), "deg", "rev/min"),
        limits(rotary, "deg", "rev/min"),
    ));
    list
}

/// What is wrong with the machine of [`machine`] and these tables.
fn refused(more: &str) -> Vec<String> {
    refused_machine(&machine("", "", more))
}

pub(super) fn refused_machine(text: &str) -> Vec<String> {
    let errors = load(FAMILY, text).expect_err(text).0;
    assert!(errors.iter().all(|e| !e.help.is_empty()), "{errors:?}");
    errors.iter().map(ToString::to_string).collect()
}

#[test]
fn groups_that_cannot_be_are_refused() {
    let axes = "axis.Y = { kind = \"linear\", SMP650 = \"9 mm\" }\naxis.S.kind = \"spindle\"\n";
    for (more, message) in [
        ("group.B.axes = []", "group B has no axes"),
        ("group.B.axes = [\"Q\"]", "there is no axis 'Q'"),
        (
            "group.B.axes = [\"X\"]",
            "axis X belongs to group NC already",
        ),
        (
            "group.B.axes = [\"Y\", \"Y\"]",
            "axis Y belongs to group B already",
        ),
        (
            "group.B = { axes = [\"Y\"], SMP610 = [\"C\"] }",
            "there is no group 'C'",
        ),
        (
            "group.B = { axes = [\"Y\"], SMP610 = [\"NC\", \"B\"] }",
            "group B: SMP610 names the group itself",
        ),
        (
            "group.B = { axes = [\"Y\"], SMP611 = [] }",
            "unknown key 'SMP611' in group B",
        ),
        ("door.a.groups = [\"B\"]", "there is no group 'B'"),
        ("door.a = {}", "door a names no groups"),
        (
            "axis.Z = { kind = \"linear\", SMP650 = \"9 mm\", functions = [] }",
            "unknown key 'functions' in axis Z",
        ),
        (
            "axis.Z = { kind = \"linear\", SMP650 = \"9 mm\", SMP526 = \"1 s\" }",
            "axis Z: SMP526 is for an axis with kind spindle",
        ),
    ] {
        let errors = refused(&format!("{axes}{more}"));
        assert!(
            errors.len() == 1 && errors[0].contains(message),
            "{more}: {errors:#?}"
        );
    }
}

#[test]
fn a_circle_of_groups_is_told_once() {
    let axes = "axis.Y = { kind = \"linear\", SMP650 = \"9 mm\" }\naxis.Z = { kind = \"linear\", SMP650 = \"9 mm\" }\n";
    let groups = |b: &str, c: &str| {
        format!(
            "{axes}group.B = {{ axes = [\"Y\"], SMP610 = [{b}] }}\ngroup.C = {{ axes = [\"Z\"], SMP610 = [{c}] }}"
        )
    };
    let errors = refused(&groups("\"NC\", \"C\"", "\"B\""));
    assert_eq!(errors.len(), 1, "{errors:#?}");
    assert!(
        errors[0].contains("SMP610: groups B, C wait for one another"),
        "{errors:#?}"
    );
    let fine = machine("", "", &groups("\"NC\", \"C\"", "\"NC\""));
    let fine = load(FAMILY, &fine).unwrap_or_else(|e| panic!("{e}"));
    let waits: Vec<&[i64]> = fine
        .axis_groups
        .iter()
        .map(|g| &g.values["SMP610"].cells[..])
        .collect();
    assert_eq!(waits, [[0b000], [0b101], [0b001]]);
    assert_eq!(fine.axis_groups[1].values["SMP610"].shown, ["NC, C"]);
}

#[test]
fn a_group_has_the_times_of_its_slowest_axis() {
    let more = "axis.Y = { kind = \"linear\", SMP650 = \"9 mm\", SMP525 = \"3 s\" }\naxis.S = { kind = \"spindle\", SMP526 = \"4 s\" }";
    let text = machine("", ", SMP525 = \"2 s\"", more)
        .replace("[\"X\"]", "[\"X\", \"Y\"]\ngroup.S.axes = [\"S\"]");
    let machine = load(FAMILY, &text).unwrap_or_else(|e| panic!("{e}"));
    let run = |group: &str| {
        let title = format!("stop reaction of a group in the MC, group {group}");
        let run = machine
            .runs
            .iter()
            .find(|r| r.title == title)
            .expect("a run");
        (run.axes.join(" "), run.params["t_ss1"][0])
    };
    assert_eq!(run("NC"), ("X Y".to_owned(), 1000));
    // 4 s are 1333.3 cycles: the time that is watched is not longer than the one entered.
    assert_eq!(run("S"), ("S".to_owned(), 1333));
}
