//! `stillpoint new`, and `check --sweep`: how a machine file begins, and for which values its guarantees hold.

use serde_json::Value;

use crate::common::{Folder, command, messages, session, status, stderr, stdout, stillpoint};

const MILLING: &str = "spec/machines/milling-840d.toml";

/// A machine of each family from nothing to a clean verdict, as its user goes: what `new` writes, then what is the user's `own`.
fn to_a_clean_verdict(
    family: &str,
    options: &[&str],
    guarantee: &str,
    own: impl Fn(&Folder, &str, &str) -> String,
) {
    let folder = Folder::new(&format!("new-{family}"));
    let file = folder.file("machine.toml");
    let mut arguments = vec!["new", family, "--output", file.as_str()];
    arguments.extend(options);
    let written = stillpoint(&arguments);
    assert_eq!(status(&written), 0, "{}", stderr(&written));
    let text = std::fs::read_to_string(&file).expect("the file");
    std::fs::write(&file, own(&folder, &file, &text)).expect("written");
    let valid = stillpoint(&["validate", &file, "--deny-warnings"]);
    assert_eq!(status(&valid), 0, "{}{}", stdout(&valid), stderr(&valid));
    let output = stillpoint(&["check", &file, "--json"]);
    let said = format!("{}{}", stdout(&output), stderr(&output));
    assert_eq!(status(&output), 0, "{said}");
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let guarantees = report["guarantees"].as_array().expect("guarantees");
    assert!(guarantees.len() >= 4);
    assert!(guarantees.iter().all(|g| g["verdict"] == "holds"), "{said}");
    // Another value, and the verdict is another one.
    let (before, after) = text.split_once("within  = \"").expect("a time");
    let (_, after) = after.split_once('"').expect("its end");
    let worse = format!("{before}within  = \"1 ms\"{after}");
    assert_ne!(text, worse);
    std::fs::write(&file, worse).expect("written");
    let place = format!("guarantee.{guarantee}.way");
    let output = stillpoint(&["check", &file, "--sweep", &place]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stdout(&output).contains(&format!("{guarantee} (violated)")));
}

/// The program of the lathe: behind the open door its axes stand, and nothing moves before its key is pressed anew.
const LATHE: &str = "\
%_N_SAFE_SPF
DEFINE DOOR_SHUT AS $A_INSE[1]
DEFINE ESTOP_FREE AS $A_INSE[2]
DEFINE KEY AS $A_INSE[3]
DEFINE STOP_A_OFF AS $A_OUTSI[1]
DEFINE STOP_C_OFF AS $A_OUTSI[2]
DEFINE SBH_OFF AS $A_OUTSI[3]
DEFINE SG_BITS AS $A_OUTSI[4]
DEFINE PULSE AS $A_MARKERSI[1]
DEFINE WAS_UP AS $A_MARKERSI[2]
DEFINE RELEASED AS $A_MARKERSI[3]
DEFINE CONFIRMED AS $A_MARKERSI[4]
IDS=10 DO PULSE = KEY AND WAS_UP
IDS=11 DO WAS_UP = NOT KEY
IDS=12 DO RELEASED = ESTOP_FREE AND (RELEASED OR PULSE)
IDS=13 DO CONFIRMED = RELEASED AND DOOR_SHUT AND (CONFIRMED OR PULSE)
IDS=14 DO STOP_A_OFF = 1
IDS=15 DO STOP_C_OFF = RELEASED
IDS=16 DO SBH_OFF = CONFIRMED
IDS=17 DO SG_BITS = CONFIRMED
M17
";

/// Its half in the PLC, which holds the axes when the NCK stands still.
const LATHE_PLC: &str = "\
ORGANIZATION_BLOCK OB 1
U INSEP[3];
U MARKERSIP[2];
= MARKERSIP[1];
UN INSEP[3];
= MARKERSIP[2];
U INSEP[2];
U(;
O MARKERSIP[3];
O MARKERSIP[1];
);
= MARKERSIP[3];
= OUTSIP[2];
SET;
= OUTSIP[1];
U MARKERSIP[3];
U INSEP[1];
U(;
O MARKERSIP[4];
O MARKERSIP[1];
);
= MARKERSIP[4];
= OUTSIP[3];
= OUTSIP[4];
END_ORGANIZATION_BLOCK
";

/// A program beside the file, with its guarantees, and the contacts that it reads.
fn programmed(text: &str) -> String {
    let text = text.replace(
        "open          =",
        "contact       = \"INSE[1]\"\nopen          =",
    );
    let text = text.replace("stop    =", "contact = \"INSE[2]\"\nstop    =");
    let more = "
[logic.spl]
source = \"lathe.spf\"
plc    = \"lathe.stl\"

[guarantee.no_start]
pattern = \"no_start\"
door    = \"front\"
axes    = [\"X\", \"Z\"]
key     = \"INSE[3]\"
after   = \"any single fault of a channel or contact\"

[guarantee.key]
pattern  = \"reset\"
axes     = [\"X\", \"Z\"]
contact  = \"INSE[2]\"
contacts = 2
key      = \"INSE[3]\"
after    = \"any single fault of a channel or contact\"
";
    text + more
}

#[test]
fn a_lathe_from_nothing_to_a_clean_verdict() {
    let options = ["--name", "lathe", "--linear", "X,Z"];
    to_a_clean_verdict(
        "sinumerik-840d",
        &options,
        "front_axes",
        |folder, file, text| {
            folder.write("lathe.spf", LATHE);
            folder.write("lathe.stl", LATHE_PLC);
            let text = programmed(text);
            // An axis that the program does not serve never moves: each guarantee about it would hold.
            std::fs::write(file, &text).expect("written");
            let valid = stillpoint(&["validate", file, "--deny-warnings"]);
            let said = stdout(&valid);
            assert_eq!(status(&valid), 1, "{said}");
            assert!(
                said.contains("axis-not-served") && said.contains("axis-always-held"),
                "{said}"
            );
            let told = stderr(&valid);
            assert!(
                told.starts_with("error: 4 warnings about the values"),
                "{told}"
            );
            let served = "SS_DISABLE_INPUT    = \"OUTSI[3]\"
VELO_SELECT_INPUT   = [\"OUTSI[4]\", \"OUTSI[4]\"]
EXT_STOP_INPUT      = [\"OUTSI[1]\", \"OUTSI[2]\", \"1\", \"1\"]
functions =";
            text.replace("functions =", served)
        },
    );
}

/// The brake of its vertical axis.
#[test]
fn a_gantry_from_nothing_to_a_clean_verdict() {
    let options = [
        "--name",
        "gantry",
        "--linear",
        "Z",
        "--rotary",
        "C",
        "--doors",
        "front,rear",
    ];
    to_a_clean_verdict(
        "sinamics-s120",
        &options,
        "front_axes",
        |folder, _, text| {
            let text = text.replacen(
            "functions = [\"motion monitoring\"]",
            "functions = [\"motion monitoring\", \"SBC\", \"SBT\"]\np1215 = true\np10202 = [\"motor holding brake\", \"none\"]\np10203 = \"test stop\"",
            1,
        );
            // With the closing time of the brake the times of SS1 are too short for it.
            let closing = text.replacen("p1215 = true", "p1215 = true\np1217 = \"120 ms\"", 1);
            let short = folder.write("short.toml", &closing);
            let valid = stillpoint(&["validate", &short, "--deny-warnings"]);
            let said = stdout(&valid);
            assert_eq!(status(&valid), 1, "{said}");
            assert!(
                said.contains("basic-ss1-time-short") && said.contains("stop-b-time-short"),
                "{said}"
            );
            text.replacen("p1215 = true", "p1215 = true\np1217 = \"60 ms\"", 1)
        },
    );
}

/// A crane: what is written holds as it is.
#[test]
fn a_crane_from_nothing_to_a_clean_verdict() {
    let folder = Folder::new("new-crane");
    let file = folder.file("crane.toml");
    let written = stillpoint(&["new", "srm-fblocks", "--linear", "X,Y", "--output", &file]);
    assert_eq!(status(&written), 0, "{}", stderr(&written));
    let valid = stillpoint(&["validate", &file, "--deny-warnings"]);
    assert_eq!(status(&valid), 0, "{}{}", stdout(&valid), stderr(&valid));
    // The guarantees alone: the properties of the blocks are those of every crane.
    let output = stillpoint(&["check", &file, "--sweep", "guarantee.X_stops.beyond"]);
    assert_eq!(status(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let said = stdout(&output);
    assert!(
        said.contains("holds") && said.contains("violated"),
        "{said}"
    );
    let file = folder.file("rotary.toml");
    let refused = stillpoint(&["new", "srm-fblocks", "--rotary", "C", "--output", &file]);
    assert_eq!(status(&refused), 2);
    let said = messages(&refused);
    assert!(
        said.contains("has no rotary axes") && said.contains("leave --rotary out"),
        "{said}"
    );
}

/// What it writes is plausible for every kind of machine, without warnings but those that only the builder can answer.
#[test]
fn every_machine_that_begins_is_plausible() {
    let folder = Folder::new("new-kinds");
    for family in ["sinumerik-840d", "heidenhain-fs", "sinamics-s120"] {
        for (n, options) in [
            &["--linear", "X,Y,Z", "--rotary", "B,C", "--spindles", "S"][..],
            &["--linear", "X", "--doors", "front,rear"],
            &["--linear", "", "--rotary", "C"],
            &["--linear", "X,Z", "--spindles", "S1,S2", "--doors", ""],
        ]
        .into_iter()
        .enumerate()
        {
            let file = folder.file(&format!("{family}-{n}.toml"));
            let mut arguments = vec!["new", family, "--output", file.as_str()];
            arguments.extend(options);
            let written = stillpoint(&arguments);
            assert_eq!(status(&written), 0, "{options:?}: {}", stderr(&written));
            let valid = stillpoint(&["validate", &file]);
            assert_eq!(status(&valid), 0, "{options:?}: {}", stderr(&valid));
            let warnings: Vec<String> = stdout(&valid)
                .lines()
                .filter(|line| line.trim_start().starts_with("warning: "))
                .map(str::to_owned)
                .collect();
            let builders = ["is ever tested", "no door of this file reaches"];
            let known = |line: &&String| !builders.iter().any(|w| line.contains(w));
            assert_eq!(
                warnings.iter().find(known),
                None,
                "{family} {options:?}: {}",
                stdout(&valid)
            );
        }
    }
}

#[test]
fn what_cannot_begin_is_refused_and_nothing_is_overwritten() {
    let folder = Folder::new("new-refused");
    let file = folder.write("kept.toml", "mine");
    for (arguments, says) in [
        (&["new", "sinumerik"][..], "there is no family 'sinumerik'"),
        (
            &["new", "sinumerik-840d", "--output", &file],
            "nothing of it is overwritten",
        ),
        (
            &["new", "sinumerik-840d", "--linear", "X,X"],
            "two are named 'X'",
        ),
        (
            &["new", "sinumerik-840d", "--linear", "an axis"],
            "'an axis' cannot be the name",
        ),
    ] {
        let output = stillpoint(arguments);
        assert_eq!(status(&output), 2, "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        let said = messages(&output);
        assert!(said.contains(says), "{arguments:?}: {said}");
    }
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), "mine");
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn a_sweep_tells_where_guarantees_begin_to_hold() {
        let mut said = String::new();
        for (place, expected) in [
            ("axis.X.STANDSTILL_TOL", 0),
            ("axis.X.VELO_LIMIT[0]", 0),
            ("door.front.open", 0),
            ("guarantee.tool.speed", 0),
            ("axis.X.STANDSTIL_TOL", 2),
            ("axis.X.colour", 2),
            ("table", 2),
        ] {
            let arguments = ["check", MILLING, "--sweep", place];
            let output = stillpoint(&arguments);
            assert_eq!(status(&output), expected, "{place}: {}", stderr(&output));
            said.push_str(&session(&arguments, &output));
        }
        insta::assert_snapshot!(said);
    }

    /// The reset button of the press in its safe PLC program, and the contactors of its drive.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn a_press_from_nothing_to_a_clean_verdict() {
        let options = ["--name", "press", "--linear", "Y"];
        to_a_clean_verdict(
            "heidenhain-fs",
            &options,
            "front_axes_som_1",
            |folder, _, text| {
                let button = crate::common::root().join("tests/machines/reset-button.st");
                let button = std::fs::read_to_string(button).expect("the program");
                folder.write("reset.st", &button);
                let text = text.replace(
                    "[guarantee.reset]",
                    "[guarantee.reset]\nbutton_contacts = 2",
                );
                let more = "
[logic.reset_logic]
source = \"reset.st\"

[guarantee.drive]
pattern    = \"contactor\"
axes       = [\"Y\"]
contactors = 2
switching  = \"60 ms\"
within     = \"66 ms\"

[[accepted]]
warning = \"brake-test-none\"
reason  = \"The ram lies level: nothing sags when the drive is off.\"
";
                text + more
            },
        );
    }

    /// The place where a sweep finds the change is that of a check with the values beside it.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn a_sweep_agrees_with_checks() {
        let folder = Folder::new("sweep");
        let text =
            std::fs::read_to_string(crate::common::root().join(MILLING)).expect("the machine");
        let sweep = |within: &str| {
            let text = text.replacen("within  = \"1.3 s\"", &format!("within  = \"{within}\""), 1);
            let file = folder.write("machine.toml", &text);
            let arguments = ["check", &file, "--sweep", "guarantee.table.way"];
            let output = command(&arguments).output().expect("it runs");
            (status(&output), stdout(&output))
        };
        // 1.248 s is the tightest bound of a check.
        assert_eq!(sweep("1248 ms").0, 0);
        let (status, said) = sweep("1247 ms");
        assert_eq!(status, 1, "{said}");
    }
}
