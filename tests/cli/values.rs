//! Warnings about values in `validate` and `check`, what a machine file accepts of them, and `params`.

use serde_json::Value;

use crate::common::{Folder, session, status, stderr, stdout, stillpoint};

/// Legal values that no property is broken by: the open door selects the fastest stage.
const FAST: &str = "tests/machines/door-too-fast.toml";

fn json(arguments: &[&str]) -> Value {
    let output = stillpoint(arguments);
    serde_json::from_str(&stdout(&output))
        .unwrap_or_else(|e| panic!("{arguments:?}: {e}: {}", stderr(&output)))
}

#[test]
fn unusual_values_are_told_with_place_reason_and_what_is_better() {
    let mut said = String::new();
    for (file, options, expected) in [
        (FAST, &[][..], 0),
        (FAST, &["--deny-warnings"], 1),
        ("tests/plausible/defaults.toml", &[], 0),
        ("spec/machines/milling-840d.toml", &["--deny-warnings"], 0),
        (
            "spec/machines/machining-centre-heidenhain.toml",
            &["--deny-warnings"],
            0,
        ),
        ("spec/machines/gantry-s120.toml", &["--deny-warnings"], 0),
        ("spec/bench/two-axis.toml", &["--deny-warnings"], 0),
    ] {
        let mut arguments = vec!["validate", file];
        arguments.extend(options);
        let output = stillpoint(&arguments);
        assert_eq!(status(&output), expected, "{arguments:?}");
        // How many explorations there are is not asked here.
        let told = session(&arguments, &output);
        let plausible = |line: &str| match line.split_once("; `check` makes ") {
            Some((before, _)) => format!("{before}; ...\n"),
            None => format!("{line}\n"),
        };
        said.extend(told.lines().map(plausible));
    }
    insta::assert_snapshot!(said);
}

/// The same as text and as Markdown, of a machine that is checked in a second.
#[test]
fn warnings_stand_before_the_properties_and_can_be_denied() {
    let folder = Folder::new("values-text");
    let read = |name: &str| {
        let path = crate::common::root().join("spec/machines").join(name);
        std::fs::read_to_string(path).expect("readable")
    };
    folder.write("gantry-s120.st", &read("gantry-s120.st"));
    let accepted = "
[[accepted]]
warning = \"shutdown-speed-high\"
axis    = \"Y\"
reason  = \"Nobody reaches the cross axis.\"
";
    let text = read("gantry-s120.toml") + accepted;
    let changed = text.replace("p9560  = \"50 mm/min\"", "p9560  = \"3000 mm/min\"");
    assert_ne!(changed, text);
    let file = folder.write("gantry.toml", &changed);
    let allowed = stillpoint(&["check", &file]);
    assert_eq!(status(&allowed), 0, "{}", stderr(&allowed));
    let denied = stillpoint(&["check", &file, "--deny-warnings"]);
    assert_eq!(status(&denied), 1);
    assert!(
        stderr(&denied).starts_with("error: 2 warnings about the values"),
        "{}",
        stderr(&denied)
    );
    for text in [stdout(&allowed), stdout(&denied)] {
        let part = text
            .find("These values: 3 warnings, 1 of them accepted with reasons")
            .expect("told");
        assert!(
            text.starts_with("gantry-s120: ALL GUARANTEES HOLD"),
            "{text}"
        );
        assert!(part < text.find("  holds        S120-").expect("a property"));
    }
    let markdown = stdout(&stillpoint(&["check", &file, "--markdown"]));
    assert!(markdown.contains("These values") && markdown.contains("shutdown-speed-high"));
}

/// What is accepted must exist and have a reason, and what nothing needs is told.
#[test]
fn an_acceptance_is_checked_itself() {
    let folder = Folder::new("accepted");
    let base = std::fs::read_to_string(crate::common::root().join(FAST)).expect("the machine");
    let entry = |text: &str| format!("{base}\n[[accepted]]\n{text}\n");
    let reason = "reason = \"r\"";
    let mut said = String::new();
    for (name, text, expected) in [
        (
            "unknown-warning",
            format!("warning = \"door-stage-fats\"\n{reason}"),
            2,
        ),
        (
            "unknown-axis",
            format!("warning = \"door-stage-fast\"\naxis = \"Y\"\n{reason}"),
            2,
        ),
        (
            "group",
            format!("warning = \"door-stage-fast\"\ngroup = \"NC\"\n{reason}"),
            2,
        ),
        ("no-reason", "warning = \"door-stage-fast\"".to_owned(), 2),
        (
            "empty-reason",
            "warning = \"door-stage-fast\"\nreason = \" \"".to_owned(),
            2,
        ),
        (
            "unknown-key",
            format!("warning = \"door-stage-fast\"\nwhy = \"r\"\n{reason}"),
            2,
        ),
        (
            "accepted",
            format!("warning = \"door-stage-fast\"\ndoor = \"front\"\n{reason}"),
            1,
        ),
        (
            "without-effect",
            format!("warning = \"stop-d-long\"\naxis = \"X\"\n{reason}"),
            1,
        ),
    ] {
        let file = format!("{name}.toml");
        folder.write(&file, &entry(&text));
        let arguments = ["validate", &file, "--deny-warnings"];
        let output = crate::common::command(&arguments)
            .current_dir(&folder.0)
            .output();
        let output = output.expect("it runs");
        assert_eq!(status(&output), expected, "{name}: {}", stderr(&output));
        said.push_str(&session(&arguments, &output));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn a_parameter_is_told_whole_however_it_is_called() {
    let mut said = String::new();
    let cases: [(&[&str], i32); 12] = [
        (&["params", "sinumerik-840d"], 0),
        (&["params", "sinumerik-840d", "STANDSTILL_TOL"], 0),
        (&["params", "heidenhain-fs", "525"], 0),
        (&["params", "heidenhain-fs", "SMP610"], 0),
        (&["params", "sinumerik-840d", "contactor"], 0),
        (&["params", "heidenhain-fs", "device_contacts"], 0),
        (&["params", "sinumerik-840d", "STANDSTIL_TOL"], 2),
        (&["params", "sinumerik-840d", "36931x"], 2),
        (&["params", "sinumerik-840d", "SWITCH_TIME"], 2),
        (&["params", "sinumerik-840d", "colour"], 2),
        (&["params", "sinumerik-840"], 2),
        (&["params", "milling"], 2),
    ];
    for (arguments, expected) in cases {
        let output = stillpoint(arguments);
        assert_eq!(status(&output), expected, "{arguments:?}");
        said.push_str(&session(arguments, &output));
    }
    insta::assert_snapshot!(said);
    let usual = stdout(&stillpoint(&["params", "sinumerik-840d", "STANDSTILL_TOL"]));
    for word in ["MD36930", "1330", "$MA_SAFE_STANDSTILL_TOL"] {
        let same = stdout(&stillpoint(&["params", "sinumerik-840d", word]));
        assert_eq!(same, usual, "{word}");
    }
}

#[test]
fn parameters_in_json_have_what_the_text_has() {
    let all = json(&["params", "heidenhain-fs", "--json"]);
    let all = all.as_array().expect("a list");
    assert!(all.len() > 50 && all.iter().all(|p| p.get("warnings").is_none()));
    let bits = json(&["params", "heidenhain-fs", "SMP560", "--json"]);
    assert_eq!(bits.as_array().map(Vec::len), Some(13));
    let one = &json(&["params", "sinumerik-840d", "md36951", "--json"])[0];
    assert_eq!(one["name"], "VELO_SWITCH_DELAY");
    assert_eq!(one["linear"]["range"], "0 s to 60 s");
    assert_eq!(one["linear"]["default"], "100 ms");
    assert_eq!(one["linear"]["unit"], "ms, s, us, min or h");
    let has = |key: &str, name: &str, value: &str| {
        let list = one[key].as_array().expect("a list");
        assert!(list.iter().any(|e| e[name] == value), "{key}: {list:?}");
    };
    has("warnings", "id", "door-delay-long");
    has("systems", "system", "selection (axis.toml)");
    has("sources", "id", "S840D-PARAM-020");
    assert_eq!(one["functions"][0], "Safe operating stop (SBH)");
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    /// A warning and a verdict never mix: everything holds, and the warning is beside it.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn a_check_tells_warnings_apart_from_verdicts() {
        let folder = Folder::new("values");
        let page = folder.file("report.html");
        let output = stillpoint(&["check", FAST, "--json", "--html", &page, "--deny-warnings"]);
        assert_eq!(status(&output), 1, "{}", stderr(&output));
        assert!(
            stderr(&output).starts_with("error: 2 warnings about the values"),
            "{}",
            stderr(&output)
        );
        let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let verdicts = report["properties"].as_array().expect("properties").iter();
        let verdicts: Vec<&str> = verdicts.filter_map(|p| p["verdict"].as_str()).collect();
        assert!(verdicts.len() > 20);
        assert!(
            verdicts
                .iter()
                .all(|v| ["holds", "reached", "unreachable"].contains(v))
        );
        let warnings = report["warnings"].as_array().expect("warnings");
        let ids: Vec<&str> = warnings.iter().filter_map(|w| w["id"].as_str()).collect();
        assert_eq!(
            ids,
            [
                "door-stage-fast",
                "stage-without-effect",
                "door-stage-not-slowest"
            ]
        );
        let door = &warnings[2];
        assert_eq!((&door["line"], &door["column"]), (&23.into(), &8.into()));
        assert_eq!(door["of"], "door front, axis X");
        assert_eq!(door["file"], FAST);
        assert_eq!(door["values"][0]["name"], "open");
        assert_eq!(door["values"][1]["name"], "VELO_LIMIT[3]");
        assert_eq!(door["values"][1]["value"], "10000 mm/min");
        assert_eq!(door["accepted"], Value::Null);
        let accepted = warnings[1]["accepted"].as_str().expect("a reason");
        let html = std::fs::read_to_string(&page).expect("the page");
        for text in [
            accepted,
            "door-stage-not-slowest",
            "These values",
            "NO GUARANTEE IS ASKED",
        ] {
            assert!(html.contains(text), "{text}");
        }
    }
}
