//! Recordings of a whole machine with HEIDENHAIN functional safety: written, read, replayed, and what is refused.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value as Json;
use stillpoint_harness::families;
use stillpoint_harness::recording::csv::{self, Columns};
use stillpoint_harness::recording::{Allowed, Kind, Recording, Role, Target, Value, ndjson};
use stillpoint_harness::simulate::{self, Scenario};
use stillpoint_machine::{self as machine, Machine};

use super::MACHINE;
use crate::common::{Folder, root, status, stderr, stdout, stillpoint};

const SCENARIOS: &str = "spec/scenarios/heidenhain-fs";

fn centre() -> Machine {
    let path = root().join(MACHINE);
    machine::load(&path, &machine::families(&path)).expect("plausible")
}

fn simulated(machine: &Machine, scenario: &str) -> Recording {
    let path = root().join(SCENARIOS).join(scenario);
    let scenario = Scenario::load(&path, machine).expect("a scenario");
    let simulation = simulate::run(machine, &scenario).expect("it runs");
    simulation.recording
}

fn written(recording: &Recording) -> String {
    let mut bytes = Vec::new();
    ndjson::write(recording, &mut bytes).expect("written");
    String::from_utf8(bytes).expect("UTF-8")
}

fn diff(arguments: &[&str]) -> (i32, String, String) {
    let output = stillpoint(&[&["diff", MACHINE], arguments].concat());
    (status(&output), stdout(&output), stderr(&output))
}

fn json(text: &str) -> Json {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Only the signals of these names, and the first cycles.
fn part(recording: &Recording, keep: &dyn Fn(&str) -> bool, rows: usize) -> Recording {
    let kept: Vec<usize> = (0..recording.signals.len())
        .filter(|k| keep(&recording.signals[*k].name))
        .collect();
    let mut part = recording.clone();
    part.signals = kept.iter().map(|k| recording.signals[*k].clone()).collect();
    let rows = recording.rows.iter().take(rows);
    part.rows = rows
        .map(|row| kept.iter().map(|k| row[*k].clone()).collect())
        .collect();
    part
}

#[test]
fn what_is_written_reads_back() {
    let machine = centre();
    let signals = simulate::signals(&machine);
    let target = Target {
        machine: &machine.name,
        cycle_us: 3_000,
        signals: &signals,
    };
    for scenario in ["emergency-stop.toml", "slow-contacts.toml"] {
        let recording = simulated(&machine, scenario);
        let text: Arc<str> = written(&recording).into();
        assert_eq!(ndjson::read("a", &text, &target).expect("read"), recording);
        let mut table = Vec::new();
        csv::write(&recording, &mut table).expect("written");
        let table: Arc<str> = String::from_utf8(table).expect("UTF-8").into();
        let back = csv::read("a", &table, &Columns::by_name(&table, &target), &target);
        let back = back.expect("read");
        // A table has the signals in the order of its map.
        assert_eq!(back.signals.len(), recording.signals.len());
        for (k, signal) in recording.signals.iter().enumerate() {
            let place = back.find(&signal.name).expect("read");
            assert!(
                back.column(place).eq(recording.column(k)),
                "{}",
                signal.name
            );
        }
    }
}

/// Each scenario that ships, as `simulate` writes it in both formats, replays to the last output of both channels.
#[test]
fn simulations_replay_on_the_monitors() {
    let folder = Folder::new("replay-centre");
    let table = folder.0.join("a.csv").display().to_string();
    let trace = folder.0.join("a.ndjson").display().to_string();
    let mut met = 0;
    for entry in std::fs::read_dir(root().join(SCENARIOS)).expect("the scenarios") {
        let name = entry.expect("an entry").path().display().to_string();
        let output = stillpoint(&[
            "simulate",
            MACHINE,
            "--scenario",
            &name,
            "--csv",
            &table,
            "--trace",
            &trace,
            "--brief",
        ]);
        assert_eq!(status(&output), 0, "{name}: {}", stderr(&output));
        for file in [&table, &trace] {
            let (status, out, err) = diff(&["--trace", file, "--json"]);
            assert_eq!(status, 0, "{name}: {out}{err}");
            let report = json(&out);
            assert_eq!(report["divergences"], 0, "{out}");
            let cycles = report["cycles"].as_u64().expect("a number");
            let outputs = 2 * (5 * 19 + 4) * cycles;
            assert_eq!(report["outputs_compared"], outputs, "{name}");
            for owner in ["X", "Y", "Z", "S", "M", "machine"] {
                let missing = &report["axes"][owner]["missing_inputs"];
                assert_eq!(missing, &Json::Array(Vec::new()), "{owner}");
            }
        }
        met += 1;
    }
    assert!(met >= 4, "{met} scenarios");
}

/// An output that is recorded otherwise is named with its cycle; an input that is recorded otherwise changes what comes of it.
#[test]
fn divergences_are_found() {
    let (machine, folder) = (centre(), Folder::new("divergence-centre"));
    let recording = simulated(&machine, "emergency-stop.toml");
    let mut wrong = recording.clone();
    let stop = wrong.find("X.cc.stop").expect("recorded");
    for row in &mut wrong.rows[334..] {
        if row[stop] == Some(Value::Text("SS1".into())) {
            row[stop] = Some(Value::Text("SS2".into()));
        }
    }
    let file = folder.write("wrong.ndjson", &written(&wrong));
    let (status, out, _) = diff(&["--trace", &file]);
    assert_eq!(status, 1, "{out}");
    assert!(out.starts_with("1 DIVERGENCES"), "{out}");
    assert!(
        out.contains("cycle 334: X.cc.stop: recorded SS2, monitor SS1"),
        "{out}"
    );
    assert!(
        out.contains("^ X.cc.stop: recorded SS2, monitor SS1"),
        "{out}"
    );

    // The button is not pressed after all: the stop that is recorded has no cause.
    let mut calm = recording.clone();
    for channel in ["mc", "cc"] {
        let button = calm
            .find(&format!("machine.{channel}.ES"))
            .expect("recorded");
        calm.rows
            .iter_mut()
            .for_each(|row| row[button] = Some(Value::Bool(true)));
    }
    let file = folder.write("calm.ndjson", &written(&calm));
    let (status, out, _) = diff(&["--trace", &file, "--json"]);
    assert_eq!(status, 1, "{out}");
    let first = &json(&out)["differences"][0];
    assert_eq!(first["cycle"], 334, "{out}");

    // A tenth of a micrometre at standstill is no difference in um; a millimetre is one to the monitor of the standstill.
    for (tenths, expected) in [(10_000, 1), (0, 0)] {
        let mut moved = recording.clone();
        for channel in ["mc", "cc"] {
            let seen = moved
                .find(&format!("Y.{channel}.NN_AxPosition"))
                .expect("recorded");
            let told = format!("Y.{channel}.Monitoring.PositionActualValue");
            let told = moved.find(&told).expect("recorded");
            for row in &mut moved.rows[100..] {
                let Some(Value::Int(at)) = row[seen] else {
                    panic!("{channel} sees no position");
                };
                row[seen] = Some(Value::Int(at + tenths));
                row[told] = Some(Value::Int((at + tenths).div_euclid(10)));
            }
        }
        let file = folder.write("moved.ndjson", &written(&moved));
        let (status, out, _) = diff(&["--trace", &file, "--json"]);
        assert_eq!(status, expected, "{tenths}: {out}");
        if expected == 1 {
            assert_eq!(json(&out)["differences"][0]["cycle"], 100, "{out}");
        }
    }

    let mut late = recording.clone();
    let torque = late.find("X.mc.STO").expect("recorded");
    let values: Vec<_> = recording.column(torque).map(|v| v.cloned()).collect();
    for (k, row) in late.rows.iter_mut().enumerate() {
        row[torque] = values[k.saturating_sub(2)].clone();
    }
    let late = folder.write("late.ndjson", &written(&late));
    for (tolerance, expected) in [("0", 1), ("1", 1), ("2", 0)] {
        let (status, out, _) = diff(&["--trace", &late, "--tolerance", tolerance]);
        assert_eq!(status, expected, "tolerance {tolerance}: {out}");
    }
}

/// Cycles in which nothing changes may be left out in both formats, and a recording need not begin with cycle 0.
#[test]
fn gaps_are_like_the_cycle_before() {
    let (machine, folder) = (centre(), Folder::new("gaps-centre"));
    let mut recording = simulated(&machine, "slow-contacts.toml");
    recording.first = 1_000;
    let text = written(&recording);
    let (head, lines) = text.split_once('\n').expect("a header");
    let told: Vec<&str> = lines
        .lines()
        .filter(|line| !line.ends_with("\"signals\":{}}"))
        .collect();
    assert!(
        told.len() * 4 < recording.rows.len(),
        "{} are told",
        told.len()
    );
    // The last cycle is told, so that the recording is as long.
    let last = lines.lines().next_back().expect("a cycle");
    let short = format!("{head}\n{}\n{last}\n", told.join("\n"));
    let file = folder.write("short.ndjson", &short);
    let (status, out, err) = diff(&["--trace", &file, "--json"]);
    assert_eq!(status, 0, "{out}{err}");
    assert_eq!(json(&out)["cycles"], recording.rows.len());

    let mut table = Vec::new();
    csv::write(&recording, &mut table).expect("written");
    let table = String::from_utf8(table).expect("UTF-8");
    let mut before: Option<&str> = None;
    let mut rows: Vec<&str> = Vec::new();
    for row in table.lines() {
        let values = row.splitn(3, ',').nth(2);
        if before != values {
            rows.push(row);
        }
        before = values;
    }
    assert!(rows.len() * 4 < recording.rows.len());
    rows.extend(table.lines().next_back());
    let file = folder.write("short.csv", &rows.join("\n"));
    let (status, out, err) = diff(&["--trace", &file, "--json"]);
    assert_eq!(status, 0, "{out}{err}");
    assert_eq!(json(&out)["cycles"], recording.rows.len());
}

/// What is recorded of one channel counts for both; what is recorded of neither is at rest, and the report says so.
#[test]
fn a_part_of_the_signals_is_enough() {
    let (machine, folder) = (centre(), Folder::new("part-centre"));
    let recording = simulated(&machine, "emergency-stop.toml");
    // Up to the acknowledgement: one channel, without what the program decides.
    let of = |name: &str| {
        let pressed = ["ES", "AXIS_KEY"].map(|bit| format!("machine.mc.{bit}"));
        pressed.iter().any(|p| p == name)
            || ["NN_AxPosition", "stop", "NN_AxGrpState", "STO"]
                .iter()
                .any(|signal| *name == format!("X.mc.{signal}"))
    };
    let short = part(&recording, &of, 600);
    assert_eq!(short.signals.len(), 6);
    let file = folder.write("part.ndjson", &written(&short));
    let (status, out, err) = diff(&["--trace", &file]);
    assert_eq!(status, 0, "{out}{err}");
    for line in [
        "600 cycles of machining-centre-heidenhain, 1 800 outputs compared",
        "X: 3 recorded outputs",
        "not recorded, taken as at rest: PP_AxFeedEnable, nominal_position",
        "without an output: Y, Z, S, M, machine",
    ] {
        assert!(out.contains(line), "{line}: {out}");
    }
    // The contact of a door that opens in one channel only is recorded of each.
    let recording = simulated(&machine, "door-contact-lost.toml");
    let both = |name: &str| !name.starts_with("machine.cc.SD");
    let file = folder.write("both.ndjson", &written(&part(&recording, &both, 1_000)));
    let (status, out, _) = diff(&["--trace", &file, "--json"]);
    assert_eq!(status, 1, "{out}");
    // Nothing of an axis: nothing to be compared.
    let none = part(&recording, &|name| name.starts_with("machine."), 10);
    let file = folder.write("none.ndjson", &written(&none));
    let (status, _, err) = diff(&["--trace", &file]);
    assert_eq!(status, 2, "{err}");
    assert!(err.contains("NN_AxPosition"), "{err}");
}

/// Each mistake in a recording is named with line, column and a fix.
#[test]
fn mistakes_are_refused() {
    let (machine, folder) = (centre(), Folder::new("mistakes-centre"));
    let recording = simulated(&machine, "emergency-stop.toml");
    let keep = |name: &str| name.starts_with("X.mc.") || name == "machine.mc.SD";
    let text = written(&part(&recording, &keep, 3));
    for (from, to, place, message) in [
        (
            "machining-centre",
            "other-centre",
            ":1:",
            "a recording of the machine \"other-centre",
        ),
        (
            "\"cycle_us\":3000",
            "\"cycle_us\":12000",
            ":1:",
            "cycles of 12000 us",
        ),
        (
            "\"X.mc.stop\"",
            "\"X.nck.stop\"",
            ":1:",
            "did you mean \"X.mc.stop\"?",
        ),
        (
            "machine.mc.SD",
            "machine.mc.DS",
            ":1:",
            "has no input \"machine.mc.DS\"",
        ),
        (
            "\"unit\":\"0.1 um\"",
            "\"unit\":\"um\"",
            ":1:",
            "it is input int in 0.1 um",
        ),
        (
            "\"X.mc.PP_AxGrpStopReq\":\"NONE\"",
            "\"X.mc.PP_AxGrpStopReq\":\"SS0\"",
            ":2:",
            "allowed: NONE, SS2, SS1D, SS1, SS1F, INVALID",
        ),
        (
            "\"X.mc.NN_AxPosition\":0",
            "\"X.mc.NN_AxPosition\":99999999999",
            ":2:",
            "allowed: -21474836470 to 21474836470",
        ),
        (
            "\"machine.mc.SD\":true",
            "\"machine.mc.SD\":1",
            ":2:",
            "needs true or false; got 1",
        ),
        (
            "\"cycle\":1,",
            "\"cycle\":0,",
            ":3:",
            "cycle 0 comes after cycle 0",
        ),
        (
            "\"time_us\":6000",
            "\"time_us\":6001",
            ":4:",
            "cycle 2 has the time 6001 us",
        ),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        let file = folder.write("wrong.ndjson", &text.replace(from, to));
        let (status, out, err) = diff(&["--trace", &file]);
        let err = err.replace("\n  │ ", " ").replace("\n        ", " ");
        assert_eq!(status, 2, "{to}: {out}{err}");
        let told = err.contains(place) && err.contains(message) && err.contains("help: ");
        assert!(told && out.is_empty(), "{to}: {err}");
    }
    // The same of a table.
    let table =
        "cycle,X.mc.NN_AxPosition,X.mc.PP_AxGrpStopReq,X.mc.stop\n0,0,NONE,NONE\n1,0,SS9,NONE\n";
    let file = folder.write("wrong.csv", table);
    let (status, _, err) = diff(&["--trace", &file]);
    assert_eq!(status, 2, "{err}");
    assert!(
        err.contains("wrong.csv:3:5") && err.contains("cannot be \"SS9\""),
        "{err}"
    );
}

/// Whatever a channel can read can be given to it, and it tells what it was given; nothing else of what it reads changes but what
/// follows from it.
#[test]
fn every_input_can_be_set_and_read() {
    let machine = centre();
    let drive = families::of(&machine).expect("monitors");
    let owners = drive.owners(&machine);
    let all: Vec<usize> = (0..owners.len()).collect();
    assert_eq!(drive.together(&machine), vec![all.clone()]);
    let mut rest: BTreeMap<(usize, usize, usize), Value> = BTreeMap::new();
    let read = |set: Option<(usize, usize, usize, &Value)>| {
        let mut values = BTreeMap::new();
        drive
            .play(&machine, &all, false, &mut |rig| {
                rig.rest(true);
                if let Some((owner, side, input, value)) = set {
                    assert!(rig.set(owner, side, input, value));
                    assert!(!rig.set(owner, side, input, &Value::Text("no such value".into())));
                }
                rig.step();
                for (k, owner) in owners.iter().enumerate() {
                    for side in 0..2 {
                        let inputs = 0..owner.inputs.len();
                        values.extend(inputs.map(|n| ((k, side, n), rig.get(k, side, n))));
                    }
                }
            })
            .expect("it runs");
        values
    };
    rest.extend(read(None));
    for (k, owner) in owners.iter().enumerate() {
        for (n, port) in owner.inputs.iter().enumerate() {
            for side in 0..2 {
                let value = match (&rest[&(k, side, n)], port.allowed) {
                    (Value::Bool(on), _) => Value::Bool(!on),
                    (Value::Int(at), _) => Value::Int(at + 7),
                    (Value::Text(_), Allowed::OneOf(names)) => Value::Text(names[3].into()),
                    (Value::Text(_), _) => panic!("{} can be any text", port.name),
                };
                let now = read(Some((k, side, n, &value)));
                assert_eq!(now[&(k, side, n)], value, "{}.{}", owner.name, port.name);
                let others = now.iter().filter(|(at, now)| rest[*at] != **now);
                let others: Vec<_> = others
                    .map(|(at, _)| *at)
                    .filter(|at| *at != (k, side, n))
                    .collect();
                // Where the control wants an axis is where it is seen, unless it is told; a stop is one of the whole group.
                let follows = |at: &(usize, usize, usize)| {
                    let name = owners[at.0].inputs[at.2].name;
                    at.1 == side
                        && match port.name {
                            "NN_AxPosition" => at.0 == k && name == "nominal_position",
                            "PP_AxGrpStopReq" => name == port.name,
                            // What the program makes of the signals of the machine.
                            _ => {
                                owner.axis.is_none()
                                    && ["PP_AxFeedEnable", "PP_AxGrpStopReq"].contains(&name)
                            }
                        }
                };
                assert!(
                    others.iter().all(follows),
                    "{}.{}: {others:?}",
                    owner.name,
                    port.name
                );
            }
        }
        let numbers = owner.inputs.iter().filter(|p| p.kind == Kind::Int);
        assert!(numbers.clone().all(|p| p.allowed != Allowed::All));
    }
    let signals = simulate::signals(&machine);
    assert!(signals.iter().any(|s| s.role == Role::Input));
}
