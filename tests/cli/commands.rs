//! The binary as its user meets it: exit status, what goes to which stream, and what the messages say.

use std::path::PathBuf;
use std::process::Output;

use serde_json::Value;

use crate::common::{Folder, command, messages, root, session, status, stderr, stdout, stillpoint};
use crate::terminal::subcommands;

fn json(output: &Output) -> Value {
    let text = stdout(output);
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}{}", stderr(output)))
}

/// The `.toml` files of a folder of the workspace, as the user would name them.
fn files(folder: &str) -> Vec<String> {
    let mut found: Vec<String> = std::fs::read_dir(root().join(folder))
        .expect("the folder")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("a plain name")
        })
        .filter(|name| name.ends_with(".toml"))
        .map(|name| format!("{folder}/{name}"))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "{folder} is empty");
    found
}

/// The property and the length that `# expect: ID violated, N cycles` at the top of a file states.
fn expectation(file: &str) -> (String, u64) {
    let text = std::fs::read_to_string(root().join(file)).expect("readable");
    let lines = text.lines().take_while(|l| l.starts_with('#'));
    let found: Vec<&str> = lines.filter_map(|l| l.strip_prefix("# expect: ")).collect();
    let parsed = match found[..] {
        [one] => one.split_once(" violated, ").and_then(|(id, rest)| {
            let number = rest
                .strip_suffix(" cycles")
                .or(rest.strip_suffix(" cycle"))?;
            Some((id.to_owned(), number.parse().ok()?))
        }),
        _ => None,
    };
    parsed.unwrap_or_else(|| {
        panic!("{file}: write `# expect: ID violated, N cycles` at its top, not {found:?}")
    })
}

#[test]
fn seeded_errors_are_found_with_the_shortest_run() {
    for file in files("tests/must-fail") {
        let (id, length) = expectation(&file);
        let report = stillpoint(&["check", &file, "--json"]);
        assert_eq!(status(&report), 1, "{file}: {}", stderr(&report));
        let report = json(&report);
        assert_eq!(report["complete"], true, "{file}");
        let violated: Vec<&Value> = report["properties"]
            .as_array()
            .expect("properties")
            .iter()
            .filter(|p| p["verdict"] == "violated")
            .collect();
        assert_eq!(violated.len(), 1, "{file}: {violated:?}");
        assert_eq!(
            (&violated[0]["id"], &violated[0]["length"]),
            (&Value::from(id.as_str()), &length.into()),
            "{file}"
        );

        let text = stillpoint(&["check", &file]);
        assert_eq!(status(&text), 1, "{file}");
        let text = stdout(&text);
        assert!(
            text.starts_with("must-fail/") && text.contains(": VIOLATED\n"),
            "{file}: {text}"
        );
        assert!(
            text.contains(&format!("VIOLATED  {id}  ")),
            "{file}: {text}"
        );
        let cycles = if length == 1 { "cycle" } else { "cycles" };
        assert!(
            text.contains(&format!("shortest run, {length} {cycles}:")),
            "{file}: {text}"
        );
        // The diagram: a line of cycle numbers, the inputs, the state, and the mark under the last cycle.
        let mark = text
            .lines()
            .position(|l| l.trim_end().ends_with("^ violated here"))
            .expect("the mark");
        let head = text
            .lines()
            .position(|l| l.trim_start().starts_with("cycle "))
            .expect("the cycles");
        assert!(head < mark, "{file}");
        let cycles = text.lines().nth(head).expect("the line");
        let last = cycles
            .split_whitespace()
            .next_back()
            .expect("the last cycle");
        assert_eq!(
            last.trim_end_matches('>'),
            length.to_string(),
            "{file}: {cycles}"
        );
        let between: Vec<&str> = text
            .lines()
            .skip(head)
            .take(mark - head)
            .map(str::trim)
            .collect();
        let stateless = !std::fs::read_to_string(root().join(&file))
            .expect("the file")
            .contains(".state]");
        assert!(
            between.contains(&"inputs") && between.contains(&"state") != stateless,
            "{file}: {text}"
        );
    }
}

/// Runs a command that must refuse its input; what it says, for a snapshot.
fn refused(arguments: &[&str]) -> String {
    let output = stillpoint(arguments);
    let message = stderr(&output);
    assert_eq!(status(&output), 2, "{arguments:?}: {message}");
    assert!(
        output.stdout.is_empty(),
        "{arguments:?}: {}",
        stdout(&output)
    );
    for word in ["panicked", "RUST_BACKTRACE", "unwrap"] {
        assert!(!message.contains(word), "{arguments:?}: {message}");
    }
    assert!(!message.trim().is_empty(), "{arguments:?}");
    session(arguments, &output)
}

#[test]
fn bad_machine_files_are_refused_by_every_command() {
    let mut said = String::new();
    for file in files("tests/bad-input") {
        let message = refused(&["check", &file]);
        assert!(message.contains("help: "), "{file}: no fix: {message}");
        let (_, first) = message.split_once('\n').expect("the command");
        assert!(first.contains(&file), "{file} is not named: {message}");
        for command in [
            &["validate"][..],
            &["diff", "--exhaustive"],
            &["check", "--json"],
        ] {
            let mut arguments = command.to_vec();
            arguments.push(&file);
            let message = refused(&arguments);
            let (_, same) = message.split_once('\n').expect("the command");
            assert_eq!(same, first, "{command:?}");
        }
        said.push_str(&message);
    }
    insta::assert_snapshot!(said);
}

#[test]
fn messages_name_place_and_fix() {
    // What is no machine file at all.
    let mut said = String::new();
    for path in ["tests/bad-input", "tests/bad-input/no-such-file.toml"] {
        said.push_str(&refused(&["check", path]));
    }
    insta::assert_snapshot!(said);
    if cfg!(unix) {
        insta::assert_snapshot!("device", refused(&["check", "/dev/null"]));
    }
}

#[test]
fn bad_specification_files_are_refused_with_place_and_fix() {
    let folder = Folder::new("bad-specification");
    let base = "spec = \"t\"\n[machine.m]\ntext = \"m\"\notherwise = \"stay\"\n[machine.m.state]\nx = { type = \"BOOL\", init = false }\n";
    let rule =
        "[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"y\"\nthen = \"x := TRUE;\"\n";
    let system = "[system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\" }\n";
    let mut said = String::new();
    for (name, text) in [
        ("unknown-name.toml", format!("{base}{rule}{system}")),
        ("no-system.toml", base.to_owned()),
        ("not-toml.toml", format!("{base}x =")),
        ("unknown-key.toml", format!("{base}{system}wires = 1\n")),
    ] {
        folder.write(name, &text);
        let arguments = ["check", name];
        let output = command(&arguments).current_dir(&folder.0).output();
        let output = output.expect("it runs");
        assert_eq!(status(&output), 2, "{name}: {}", stderr(&output));
        said.push_str(&session(&arguments, &output));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn bad_options_are_refused() {
    let file = "spec/bench/two-axis.toml";
    let axis = "spec/families/sinumerik-840d/axis.toml";
    let cases: [&[&str]; 12] = [
        &["check", file, "--memory", "much"],
        &["check", file, "--memory", "0"],
        &["check", file, "--time=-5s"],
        &["check", file, "--time", "5 fortnights"],
        &["check", file, "--threads", "many"],
        &["check", file, "--readings", "A-25"],
        &["check", axis, "--readings", "FOO=BAR"],
        &["check", axis, "--readings", "A-25=NEVER"],
        &["check"],
        &["chekc", file],
        &["diff", axis, "--exhaustive", "--random", "10"],
        &["diff", axis, "--seed", "3"],
    ];
    let said: String = cases.into_iter().map(refused).collect();
    insta::assert_snapshot!(said);
    // It lists all there are, which is no text of a command.
    let mutants = refused(&["diff", axis, "--mutant", "no-such-mutant"]);
    assert!(
        mutants.contains("`no-such-mutant`: no mutant has this name"),
        "{mutants}"
    );
}

#[test]
fn help_and_version_are_no_errors() {
    let version = stillpoint(&["--version"]);
    assert_eq!(status(&version), 0);
    assert!(version.stderr.is_empty() && stdout(&version).contains("stillpoint"));
    let mut said = String::new();
    let mut commands = vec![String::new()];
    while let Some(command) = commands.pop() {
        let arguments: Vec<&str> = command.split_whitespace().chain(["--help"]).collect();
        let output = stillpoint(&arguments);
        assert_eq!(status(&output), 0, "{arguments:?}");
        assert!(output.stderr.is_empty(), "{arguments:?}");
        if command.is_empty() {
            commands.extend(subcommands(&stdout(&output)).into_iter().rev());
        }
        said.push_str(&session(&arguments, &output));
    }
    insta::assert_snapshot!(said);
}

/// A check that a limit ends: status 3, and nothing is claimed that was not shown.
fn limited(file: &str, limit: &[&str]) -> Value {
    let mut arguments = vec!["check", file, "--json"];
    arguments.extend(limit);
    let output = stillpoint(&arguments);
    assert_eq!(status(&output), 3, "{arguments:?}: {}", stderr(&output));
    let report = json(&output);
    assert_eq!(report["complete"], false, "{arguments:?}");
    let properties = report["properties"].as_array().expect("properties");
    let verdicts: Vec<&str> = properties
        .iter()
        .filter_map(|p| p["verdict"].as_str())
        .collect();
    assert!(
        verdicts.contains(&"inconclusive"),
        "{arguments:?}: {verdicts:?}"
    );
    assert!(
        !verdicts.contains(&"violated") && !verdicts.contains(&"unreachable"),
        "{arguments:?}: {verdicts:?}"
    );
    let mut text = vec!["check", file];
    text.extend(limit);
    let text = stillpoint(&text);
    assert_eq!(status(&text), 3);
    assert!(stdout(&text).contains("INCONCLUSIVE"), "{}", stdout(&text));
    report
}

/// 640 000 states (x1 and x2 go together) in an index space that no bitmap covers: more than a MiB holds.
fn sparse() -> PathBuf {
    let path = std::env::temp_dir().join(format!("stillpoint-sparse-{}.toml", std::process::id()));
    let mut text = String::from(
        "spec = \"sparse\"\n[machine.m]\ntext = \"m\"\n[machine.m.input]\nstep = \"BOOL\"\n[machine.m.state]\n",
    );
    for k in 0..3 {
        text.push_str(&format!(
            "x{k} = {{ type = \"INT(0..2000000000)\", init = 0 }}\n"
        ));
    }
    text.push_str("[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"TRUE\"\nthen = \"");
    text.push_str("IF step THEN x0 := (x0 + 1) MOD 800; ELSE x1 := (x1 + 1) MOD 800; x2 := (x2 + 7) MOD 800; END_IF;\"\n");
    text.push_str("[system.s]\ntext = \"s\"\n[system.s.instance]\nm = { machine = \"m\" }\n[system.s.free]\nports = [\"m.step\"]\n");
    text.push_str("[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"m.x0 < 800\"\n");
    std::fs::write(&path, text).expect("a file");
    path
}

#[test]
fn limits_end_a_check_honestly() {
    let path = sparse();
    let file = path.to_str().expect("UTF-8");
    let report = limited(file, &["--memory", "1MiB"]);
    let states = report["states"].as_u64().expect("states");
    assert!((1_000..640_000).contains(&states), "{states}");
    limited(file, &["--time", "1ms"]);
    // The whole of it: 800 * 800 states, and the property holds.
    let whole = stillpoint(&["check", file, "--json"]);
    assert_eq!(status(&whole), 0, "{}", stderr(&whole));
    assert_eq!(json(&whole)["states"], 640_000);
    std::fs::remove_file(&path).expect("the file goes");
}

#[test]
fn an_option_of_a_reading_changes_results() {
    // Only RESET_AFTER_END lets a STOP D end in standstill however often RESET comes.
    let file = "spec/families/sinumerik-840d/axis.toml";
    let results = |readings: &[&str]| {
        let mut arguments = vec!["check", file, "--json", "--time", "10min"];
        arguments.extend(readings);
        let output = stillpoint(&arguments);
        assert!([0, 1].contains(&status(&output)), "{}", stderr(&output));
        json(&output)["properties"].clone()
    };
    let main = results(&[]);
    assert_ne!(main, results(&["--readings", "A-25=RESET_AT_ONCE"]));
    assert_eq!(
        main,
        results(&["--readings", "A-25=RESET_AFTER_END"]),
        "the recommended option is the default"
    );
}

/// In the first call an input that is already 1 is an edge or not: the reading stands in initial values, and nowhere else.
#[test]
fn an_option_that_only_initial_values_read_is_compared() {
    let file = "spec/families/srm-fblocks/sbr.toml";
    let report = json(&stillpoint(&["check", file, "--json", "--readings", "all"]));
    let readings = report["readings"].as_array().expect("readings");
    let edge = readings.iter().find(|r| r["option"] == "EDGE_ZERO");
    let edge = edge.expect("the option of the reading");
    assert_eq!(edge["explorations"], 1, "{edge}");
    assert_eq!(edge["complete"], true, "{edge}");
}

#[test]
fn reductions_keep_verdicts_and_say_what_they_did() {
    let file = "spec/families/sinumerik-840d/reaction.toml";
    let plain = json(&stillpoint(&["check", file, "--json", "--readings", "all"]));
    let output = stillpoint(&[
        "check",
        file,
        "--json",
        "--readings",
        "all",
        "--reduce",
        "all",
    ]);
    assert_eq!(status(&output), 0);
    let reduced = json(&output);
    assert_eq!(plain["properties"], reduced["properties"]);
    let readings = plain["readings"].as_array().expect("readings");
    assert!(!readings.is_empty());
    assert_eq!(plain["readings"], reduced["readings"]);
    assert_eq!(plain["reactions"], reduced["reactions"]);
    assert!(reduced["states"].as_u64() < plain["states"].as_u64());
    let runs = reduced["runs"].as_array().expect("runs");
    let run = runs
        .iter()
        .find(|r| r["reduction"]["whole"].is_null())
        .expect("a reduced run");
    assert_eq!(run["absorbing"], Value::Null);
    let parts = run["reduction"]["explorations"]
        .as_array()
        .expect("explorations");
    assert!(
        parts
            .iter()
            .any(|p| p["variables"].as_u64() < run["reduction"]["variables"].as_u64())
    );
    assert!(plain["runs"][0]["reduction"].is_null());
    let text = stdout(&stillpoint(&["check", file, "--reduce", "slice,symmetry"]));
    assert!(text.contains("reduction (slice, symmetry): "), "{text}");
    let wrong = stillpoint(&["check", file, "--reduce", "slices"]);
    assert_eq!(status(&wrong), 2);
    assert!(messages(&wrong).contains("there is no reduction `slices`"));
}

#[test]
fn errors_quote_a_part_of_long_lines() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("long-lines");
    std::fs::create_dir_all(&folder).expect("a folder");
    let long = "x".repeat(400_000);
    let words = "a AND ".repeat(70_000);
    let accents = "\u{e9}".repeat(200_000);
    let spec = |key: &str| {
        format!(
            "spec = \"s\"\ntitle = \"t\"\n[machine.m]\ntext = \"t\"\notherwise = \"stay\"\n[machine.m.input]\na = \"BOOL\"\n\
             [machine.m.state]\nb = {{ type = \"BOOL\", init = \"FALSE\" }}\n[[machine.m.rule]]\nname = \"r\"\n\
             id = [\"S840D-STOP-020\"]\n{key}\nthen = \"b := TRUE;\"\n[system.m]\ntext = \"t\"\n\
             [system.m.instance]\nm = {{ machine = \"m\" }}\n[system.m.free]\nports = [\"m.a\"]\n"
        )
    };
    for (number, (text, place)) in [
        (spec(&format!("when = \"{words} unknown\"")), None),
        (spec(&format!("when = \"{long}\"")), Some("13:9")),
        (spec(&format!("{long} = 1")), Some("13:1")),
        (spec(&format!("when = \"a {long}")), None),
        (format!("spec = \"{accents}\" \"\n"), None),
        (format!("title = 1 # {long}\n"), None),
        (format!("{long}\n{long}\n"), None),
    ]
    .into_iter()
    .enumerate()
    {
        let file = folder.join(format!("{number}.toml"));
        std::fs::write(&file, text).expect("written");
        let output = stillpoint(&["check", file.to_str().expect("UTF-8")]);
        let errors = stderr(&output);
        assert_eq!(status(&output), 2, "{number}: {} bytes", errors.len());
        assert!(
            errors.len() < 6_000,
            "{number}: {} bytes on stderr",
            errors.len()
        );
        if let Some(place) = place {
            assert!(errors.contains(place), "{number}: {errors}");
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
}
