//! Recordings: written, read, replayed, and what is refused.

use std::sync::Arc;

use serde_json::Value as Json;
use stillpoint_harness::families::sinumerik::vocabulary;
use stillpoint_harness::recording::csv::{self, Columns};
use stillpoint_harness::recording::{Recording, Role, Target, ndjson};
use stillpoint_harness::simulate::{self, Scenario};
use stillpoint_machine::{self as machine, Machine};

use crate::common::{Folder, root, status, stderr, stdout, stillpoint};

const MACHINE: &str = "spec/machines/milling-840d.toml";

fn machine() -> Machine {
    let path = root().join(MACHINE);
    machine::load(&path, &machine::families(&path)).expect("plausible")
}

fn simulated(machine: &Machine, scenario: &str) -> Recording {
    let path = root().join("spec/scenarios").join(scenario);
    let scenario = Scenario::load(&path, machine).expect("a scenario");
    simulate::run(machine, &scenario)
        .expect("it runs")
        .recording
}

fn written(
    recording: &Recording,
    write: fn(&Recording, &mut dyn std::io::Write) -> std::io::Result<()>,
) -> Arc<str> {
    let mut bytes = Vec::new();
    write(recording, &mut bytes).expect("written");
    String::from_utf8(bytes).expect("UTF-8").into()
}

fn target<'a>(
    machine: &'a Machine,
    signals: &'a [stillpoint_harness::recording::Signal],
) -> Target<'a> {
    Target {
        machine: &machine.name,
        cycle_us: 12_000,
        signals,
    }
}

#[test]
fn what_is_written_reads_back() {
    let machine = machine();
    let signals = simulate::signals(&machine);
    let target = target(&machine, &signals);
    for scenario in ["door-while-moving.toml", "power-up.toml"] {
        let recording = simulated(&machine, scenario);
        let text = written(&recording, ndjson::write);
        assert_eq!(ndjson::read("a", &text, &target).expect("read"), recording);
        let table = written(&recording, csv::write);
        let columns = Columns::by_name(&table, &target);
        let mut back = csv::read("a", &table, &columns, &target).expect("read");
        // A table has the signals in the order of its map.
        back.rows = back
            .rows
            .iter()
            .map(|row| {
                let place = |name: &str| {
                    back.signals
                        .iter()
                        .position(|s| s.name == name)
                        .expect("read")
                };
                recording
                    .signals
                    .iter()
                    .map(|s| row[place(&s.name)].clone())
                    .collect()
            })
            .collect();
        back.signals = recording.signals.clone();
        assert_eq!(back, recording);
    }
}

#[test]
fn every_input_can_be_set_and_read() {
    use stillpoint_harness::recording::{Kind, Value};
    use stillpoint_monitors::sinumerik::axis::Local;
    for input in vocabulary::inputs() {
        let mut local = Local::default();
        let before = input.get(&local);
        let value = match input.kind {
            Kind::Bool => Value::Bool(true),
            _ => Value::Int(77),
        };
        assert_ne!(before, value, "{}", input.name);
        assert!(input.set(&mut local, &value), "{}", input.name);
        assert_eq!(input.get(&local), value, "{}", input.name);
        // Nothing else has changed.
        let others = vocabulary::inputs()
            .into_iter()
            .filter(|o| o.name != input.name);
        for other in others {
            assert_eq!(
                other.get(&local),
                other.get(&Local::default()),
                "{} by {}",
                other.name,
                input.name
            );
        }
        assert!(!input.set(&mut local, &Value::Text("x".into())));
    }
}

/// The enable bits by which a machine file's functions reach the monitors are those of the family's data.
#[test]
fn the_functions_have_the_bits_of_the_family() {
    let text = std::fs::read_to_string(root().join("spec/families/sinumerik-840d/family.toml"))
        .expect("readable");
    let table: toml::Table = text.parse().expect("TOML");
    let functions = table["function"].as_array().expect("a list");
    for function in functions {
        let (name, bit) = (
            function["name"].as_str().expect("a name"),
            function["bit"].as_integer(),
        );
        let found = stillpoint_harness::families::sinumerik::production::FUNCTIONS
            .iter()
            .find(|(n, _)| *n == name);
        assert_eq!(found.map(|(_, bit)| i64::from(*bit)), bit, "{name}");
    }
    assert_eq!(
        functions.len(),
        stillpoint_harness::families::sinumerik::production::FUNCTIONS.len()
    );
}

fn diff(arguments: &[&str]) -> (i32, String, String) {
    let output = stillpoint(&[&["diff", MACHINE], arguments].concat());
    (status(&output), stdout(&output), stderr(&output))
}

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Every example replays without a divergence, on the monitors and on the tables.
#[test]
fn simulations_replay_on_monitors_and_tables() {
    let (machine, folder) = (machine(), Folder::new("replay"));
    for scenario in [
        "door-while-moving",
        "encoder-freeze",
        "power-up",
        "vertical-sag",
    ] {
        let recording = simulated(&machine, &format!("{scenario}.toml"));
        let file = folder.write("a.ndjson", &written(&recording, ndjson::write));
        let (status, out, err) = diff(&["--trace", &file, "--json"]);
        assert_eq!(status, 0, "{scenario}: {out}{err}");
        let report = json(&out);
        let cycles = recording.rows.len() as u64;
        assert_eq!(report["divergences"], 0, "{out}");
        assert_eq!(report["cycles"], cycles);
        for axis in ["X", "Y", "Z", "S"] {
            // Before run-up the tables do not step.
            let stepped = report["axes"][axis]["table_cycles"]
                .as_u64()
                .expect("a number");
            let least = if scenario == "power-up" {
                2 * cycles - 80
            } else {
                2 * cycles
            };
            assert!(
                stepped >= least,
                "{scenario}: {axis}: {stepped} of {}",
                2 * cycles
            );
        }
    }
}

/// A wrong letter is found in its cycle and on both sides; one that comes two cycles late within that tolerance only.
#[test]
fn divergences_are_found() {
    let (machine, folder) = (machine(), Folder::new("divergence"));
    let recording = simulated(&machine, "door-while-moving.toml");
    let text = written(&recording, ndjson::write);
    let wrong = folder.write(
        "wrong.ndjson",
        &text.replace("\"X.drive.stop\":\"C\"", "\"X.drive.stop\":\"D\""),
    );
    let (status, out, _) = diff(&["--trace", &wrong]);
    assert_eq!(status, 1, "{out}");
    for line in [
        "cycle 51: X.drive.stop: recorded D, specification C",
        "cycle 51: X.drive.stop: recorded D, monitor C",
        "^ X.drive.stop: recorded D, monitor C",
    ] {
        assert!(out.contains(line), "{line}: {out}");
    }

    let picture = folder.0.join("divergence.svg");
    let svg = picture.to_str().expect("a name");
    let (status, _, _) = diff(&["--trace", &wrong, "--svg", svg]);
    assert_eq!(status, 1);
    let drawn = std::fs::read_to_string(&picture).expect("a picture");
    assert!(drawn.contains("recorded D, specification C"), "{drawn}");
    std::fs::remove_file(&picture).expect("removable");
    let right = folder.write("right.ndjson", &text);
    let (status, _, _) = diff(&["--trace", &right, "--svg", svg]);
    assert!(status == 0 && !picture.exists());

    let mut late = recording.clone();
    let stop = late.find("X.nck.SGA_STOP_C").expect("recorded");
    let values: Vec<_> = recording.rows.iter().map(|row| row[stop].clone()).collect();
    for (k, row) in late.rows.iter_mut().enumerate() {
        row[stop] = values[k.saturating_sub(2)].clone();
    }
    let late = folder.write("late.ndjson", &written(&late, ndjson::write));
    for (tolerance, expected) in [("0", 1), ("1", 1), ("2", 0)] {
        let (status, out, _) = diff(&["--trace", &late, "--tolerance", tolerance]);
        assert_eq!(status, expected, "tolerance {tolerance}: {out}");
    }

    // An input that the recording has changed changes what comes of it.
    let mut other = recording.clone();
    let position = other
        .find("X.nck.Monitoring.PositionActualValue")
        .expect("recorded");
    for row in &mut other.rows[60..] {
        row[position] = Some(stillpoint_harness::recording::Value::Int(5_000_000));
    }
    let file = folder.write("other.ndjson", &written(&other, ndjson::write));
    let (status, out, _) = diff(&["--trace", &file, "--json"]);
    assert_eq!(status, 1, "{out}");
    assert!(
        json(&out)["differences"][0]["cycle"].as_u64() >= Some(60),
        "{out}"
    );
}

/// A table of another tool with headings, a clock and a separator of its own.
#[test]
fn a_table_is_read_by_its_map() {
    let (machine, folder) = (machine(), Folder::new("csv"));
    let recording = simulated(&machine, "door-while-moving.toml");
    let signals = [
        ("X.nck.Monitoring.PositionActualValue", "Position (um)"),
        ("X.nck.SGE_SVSS_DISABLE", "SBH/SG off"),
        ("X.nck.SGE_SS_DISABLE", "SBH off"),
        ("X.nck.SGE_VELO_SELECT_0", "SG bit 0"),
        ("X.nck.SGE_VELO_SELECT_1", "SG bit 1"),
        ("X.drive.SGA_STOP_C", "\"Stop C; active\""),
    ];
    let mut table = format!("t;unused;{}\n", signals.map(|(_, h)| h).join(";"));
    let mut map = "time_ms = \"t\"\n[signals]\n".to_owned();
    for (signal, heading) in signals {
        map.push_str(&format!("{signal:?} = {:?}\n", heading.trim_matches('"')));
    }
    for (n, row) in recording.rows.iter().enumerate() {
        let cells: Vec<String> = signals
            .iter()
            .map(|(name, _)| {
                row[recording.find(name).expect("recorded")]
                    .as_ref()
                    .expect("told")
                    .to_string()
            })
            .collect();
        table.push_str(&format!("{};x;{}\n", n * 12, cells.join(";")));
    }
    let (table, map) = (
        folder.write("table.csv", &table),
        folder.write("map.toml", &map),
    );
    let (status, out, err) = diff(&["--trace", &table, "--columns", &map]);
    assert_eq!(status, 0, "{out}{err}");
    assert!(
        out.contains("without an output: Y, Z, S")
            && out.contains("125 cycles")
            && out.contains("not recorded, taken as at rest"),
        "{out}"
    );
    let wrong = "t=t,X.nck.stop=\"nothing\"";
    let (status, _, err) = diff(&["--trace", &table, "--columns", wrong]);
    assert_eq!(status, 2, "{err}");
    assert!(err.contains("help: "), "{err}");
}

/// Each mistake in a recording is named with line, column and a fix.
#[test]
fn mistakes_are_refused() {
    let (machine, folder) = (machine(), Folder::new("mistakes"));
    let mut recording = simulated(&machine, "door-while-moving.toml");
    recording.rows.truncate(3);
    let keep =
        |name: &str| name.starts_with("X.nck.SG") || name == "X.nck.Monitoring.PositionActualValue";
    let kept: Vec<usize> = (0..recording.signals.len())
        .filter(|k| keep(&recording.signals[*k].name))
        .collect();
    recording.signals = kept.iter().map(|k| recording.signals[*k].clone()).collect();
    recording.rows = recording
        .rows
        .iter()
        .map(|row| kept.iter().map(|k| row[*k].clone()).collect())
        .collect();
    assert!(recording.signals.iter().any(|s| s.role == Role::Output));
    let text = written(&recording, ndjson::write).to_string();
    for (from, to, place, message) in [
        (
            "stillpoint-trace",
            "other",
            ":1:",
            "the format is \"other\"",
        ),
        (
            "\"version\":1",
            "\"version\":2",
            ":1:",
            "the version of the format is 2",
        ),
        (
            "milling-840d",
            "lathe",
            ":1:",
            "a recording of the machine \"lathe\"",
        ),
        (
            "\"cycle_us\":12000",
            "\"cycle_us\":8000",
            ":1:",
            "cycles of 8000 us",
        ),
        (
            "X.nck.SGE_SS_DISABLE",
            "X.nck.SGE_SS_DISABEL",
            ":1:",
            "did you mean \"X.nck.SGE_SS_DISABLE\"?",
        ),
        (
            "\"kind\":\"int\",\"unit\":\"um\"",
            "\"kind\":\"int\",\"unit\":\"mm\"",
            ":1:",
            "it is input int in um",
        ),
        (
            "\"cycle\":1,",
            "\"cycle\":0,",
            ":3:",
            "cycle 0 comes after cycle 0",
        ),
        (
            "\"time_us\":24000",
            "\"time_us\":24001",
            ":4:",
            "cycle 2 has the time 24001 us",
        ),
        (
            "\"X.nck.SGE_SS_DISABLE\":true",
            "\"X.nck.SGE_SS_DISABLE\":7",
            ":2:",
            "needs true or false; got 7",
        ),
        (
            "\"X.nck.Monitoring.PositionActualValue\":-150000",
            "\"X.nck.Monitoring.PositionActualValue\":-2147483649",
            ":2:",
            "allowed: -2147483648 to 2147483647",
        ),
        (
            "\"X.nck.SGE_SS_DISABLE\":true",
            "\"X.nck.SGE_OTHER\":true",
            ":2:",
            "does not declare the signal",
        ),
        (
            "{\"cycle\":2,",
            "{\"cycle\":2 ",
            ":4:",
            "not a cycle of a recording",
        ),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        let file = folder.write("wrong.ndjson", &text.replace(from, to));
        let (status, out, err) = diff(&["--trace", &file]);
        let err = err.replace("\n  │ ", " ").replace("\n        ", " ");
        assert_eq!(status, 2, "{to}: {out}{err}");
        assert!(
            err.contains(place) && err.contains(message) && err.contains("help: "),
            "{to}: {err}"
        );
        assert!(out.is_empty());
    }
}
