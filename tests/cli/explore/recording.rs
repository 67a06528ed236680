//! A walk saved as a recording, and replayed.

use serde_json::{Value, json};

use super::api::FILE;
use super::served::{Answer, Served};
use crate::common::{Folder, status, stderr, stdout, stillpoint};

const CENTRE: &str = "spec/machines/machining-centre-heidenhain.toml";
const MILLING: &str = "spec/machines/milling-840d.toml";

fn named<'a>(systems: &'a [Value], name: &str) -> &'a Value {
    let mut found = systems.iter().filter(|s| s["name"] == name);
    found.next().unwrap_or_else(|| panic!("no system {name}"))
}

/// A walk through the system that always takes the outcome with the most changes.
fn walk(served: &Served, system: &Value, cycles: usize) -> String {
    let mut path = "0".to_owned();
    for _ in 0..cycles {
        let body = json!({ "system": system["name"], "hash": system["hash"], "path": path });
        let view = served.json(&served.post("/api/view", &body.to_string()));
        let classes = view["next"]["classes"].as_array().expect("classes");
        let most = classes
            .iter()
            .max_by_key(|c| c["changes"].as_array().map_or(0, Vec::len));
        let choice = most.expect("an outcome")["choice"].as_str().expect("text");
        path = format!("{path}.{choice}");
    }
    path
}

/// The recording of a walk through a system; the same each time.
fn saved(served: &Served, system: &Value, cycles: usize) -> Answer {
    let name = &system["name"];
    assert_eq!(system["recordable"], true, "{name}");
    let path = walk(served, system, cycles);
    let body = json!({ "system": name, "hash": system["hash"], "path": path }).to_string();
    let answer = served.post("/api/recording", &body);
    assert_eq!(answer.status, 200, "{name}");
    let again = served.post("/api/recording", &body);
    assert_eq!(answer.body, again.body, "{name}");
    answer
}

/// The replay on this machine agrees with the whole recording, and refutes what it says with `from` as `to`.
fn replayed(folder: &Folder, machine: &str, recording: &str, cycles: usize, [from, to]: [&str; 2]) {
    let file = folder.write("walk.ndjson", recording);
    let diff = stillpoint(&["diff", machine, "--trace", &file, "--json"]);
    let said = || format!("{}{}", stdout(&diff), stderr(&diff));
    assert_eq!(status(&diff), 0, "{}", said());
    let told: Value = serde_json::from_str(&stdout(&diff)).expect("JSON");
    assert_eq!(
        (&told["cycles"], &told["divergences"]),
        (&json!(cycles), &json!(0))
    );
    let wrong = recording.replace(from, to);
    assert_ne!(wrong, recording);
    let file = folder.write("wrong.ndjson", &wrong);
    let diff = stillpoint(&["diff", machine, "--trace", &file]);
    assert_eq!(status(&diff), 1, "{}", stdout(&diff));
}

#[test]
fn a_walk_is_a_recording_that_the_replay_accepts() {
    let folder = Folder::new("explore-recording");
    let served = Served::start(&[MILLING]);
    let systems = served.systems();
    let all = systems["systems"].as_array().expect("systems");
    for wanted in ["selection", "stop", "stop_pair", "axis_core"] {
        let system = named(all, &format!("{wanted}:X"));
        let answer = saved(&served, system, 6);
        assert!(answer.head.contains("application/x-ndjson"));
        // The header, then one line a cycle.
        assert_eq!(answer.body.lines().count(), 7, "{wanted}");
        let other = ["\"X.nck.stop\":\"", "\"X.nck.stop\":\"_"];
        replayed(&folder, MILLING, &answer.body, 6, other);
    }
}

/// A machine that runs as a whole: the keys of a walk through its safe PLC program are signals of the machine.
#[test]
fn a_walk_through_a_program_is_a_recording_of_the_whole_machine() {
    let folder = Folder::new("explore-recording-centre");
    let served = Served::start(&[CENTRE]);
    let systems = served.systems();
    let all = systems["systems"].as_array().expect("systems");
    let starts =
        |name: &str, wanted: &str| name == wanted || name.starts_with(&format!("{wanted}:"));
    for wanted in ["logic", "axes_events", "machine_axes"] {
        let mut found = all.iter();
        let system = found.find(|s| s["name"].as_str().is_some_and(|name| starts(name, wanted)));
        let system = system.unwrap_or_else(|| panic!("no system {wanted}"));
        let answer = saved(&served, system, 6);
        // The cycle of the program is seven of the kernel.
        let cycles = if wanted == "machine_axes" { 6 } else { 42 };
        assert_eq!(answer.body.lines().count(), 1 + cycles, "{wanted}");
        // The walk presses something, and the doors are those of the walk: closed where the signal is on.
        let pressed = ["SD", "PB", "AXIS_KEY", "NC_START", "KEY_SOM_2", "KEY_SOM_3"];
        let pressed = pressed.map(|name| format!("\"machine.mc.{name}\":"));
        let mut later = answer.body.lines().skip(2);
        assert!(
            later.any(|l| pressed.iter().any(|p| l.contains(p))),
            "{wanted}"
        );
        let mut told = serde_json::Map::new();
        for line in answer
            .body
            .lines()
            .skip(1)
            .filter(|_| wanted != "axes_events")
        {
            let line: Value = serde_json::from_str(line).expect("JSON");
            told.extend(line["signals"].as_object().expect("signals").clone());
            let open = told["walk.before.door"] == "TRUE";
            assert_eq!(told["machine.cc.SD"], !open, "{wanted}: {}", line["cycle"]);
        }
        let other = ["_AxGrpState\":\"S", "_AxGrpState\":\"_S"];
        replayed(&folder, CENTRE, &answer.body, cycles, other);
    }
    // What a walk gives to no signal is not recorded.
    let status = all.iter().find(|s| s["name"] == "status");
    assert_eq!(status.expect("a system")["recordable"], false);
}

/// The signals of the walk arrive at the monitors: SBH and SG de-selected, then a stage selected.
#[test]
fn the_walk_decides_what_the_monitors_see() {
    let served = Served::start(&[MILLING]);
    let systems = served.systems();
    let all = systems["systems"].as_array().expect("systems");
    let system = named(all, "selection:X");
    let inputs = system["inputs"].as_array().expect("inputs");
    let number = |name: &str| {
        let found = inputs.iter().position(|i| i["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    let (off, sbh) = (number("selection.sge_sbh_sg"), number("selection.sge_sbh"));
    let (power, internal) = (number("power_on"), number("selection.sbh_internal"));
    let mut path = "0".to_owned();
    for (off_is, sbh_is) in [(1, 0), (0, 0), (0, 1)] {
        let held = format!("{power}=0!{internal}=0!{off}={off_is}!{sbh}={sbh_is}");
        let body =
            json!({ "system": system["name"], "hash": system["hash"], "path": path, "held": held });
        let view = served.json(&served.post("/api/view", &body.to_string()));
        let choice = view["next"]["classes"][0]["choice"].as_str().expect("text");
        path = format!("{path}.{choice}");
    }
    let body = json!({ "system": system["name"], "hash": system["hash"], "path": path });
    let answer = served.post("/api/recording", &body.to_string());
    let lines: Vec<Value> = answer
        .body
        .lines()
        .skip(1)
        .map(|l| serde_json::from_str(l).expect("JSON"))
        .collect();
    let modes: Vec<&Value> = lines.iter().map(|l| &l["signals"]["X.nck.mode"]).collect();
    assert_eq!(modes, ["NSB", "SBH", "SG"]);
    let walked: Vec<&Value> = lines
        .iter()
        .map(|l| &l["signals"]["walk.selection.mode"])
        .collect();
    assert_eq!(walked, ["NSB", "SBH", "SG"]);
}

#[test]
fn a_system_without_signals_of_an_axis_is_not_recorded() {
    let served = Served::start(&[FILE]);
    assert_eq!(served.systems()["systems"][0]["recordable"], false);
    let answer = served.post("/api/recording", &served.about(json!({ "path": "0.1" })));
    assert_eq!(answer.status, 400);
    assert!(
        answer.body.contains("there is nothing to be recorded"),
        "{}",
        answer.body
    );
}
