//! A machine file lies anywhere: the data of its family are in the binary, or where the user says.

use std::path::Path;

use super::{SMALLEST, away, elsewhere};
use crate::common::{copied, messages, root, status, stderr, stdout, stillpoint};

#[test]
fn every_command_takes_a_file_away_from_the_sources() {
    let folder = elsewhere("anywhere");
    folder.write("smallest.toml", SMALLEST);
    // Few systems: a certificate is confirmed with the interpreter.
    folder.write("ends.toml", &SMALLEST.replace(", \"SE\"", ""));
    let text = std::fs::read_to_string(root().join("spec/machines/milling-840d.toml"));
    folder.write("milling.toml", &text.expect("readable"));
    let scenario = root().join("spec/scenarios/door-while-moving.toml");
    let scenario = scenario.to_str().expect("UTF-8");
    for arguments in [
        &["validate", "smallest.toml"][..],
        // The check of the smallest machine: see `answers`.
        &["check", "ends.toml", "--certificate", "a.cert"],
        &["certify", "a.cert"],
        &["reaction", "smallest.toml"],
        &["acceptance", "smallest.toml"],
        &["simulate", "milling.toml", "--scenario", scenario],
        &["diff", "smallest.toml", "--random", "1000", "--seed", "1"],
        &["export", "smallest.toml", "--system", "stop", "--to", "dot"],
    ] {
        let output = away(&folder, arguments);
        assert_eq!(
            status(&output),
            0,
            "{arguments:?}: {}{}",
            stdout(&output),
            stderr(&output)
        );
    }
}

#[test]
fn an_unknown_family_lists_those_of_the_binary() {
    let folder = elsewhere("unknown-family");
    let file = folder.write("m.toml", "family = \"quite-another\"\n");
    let output = away(&folder, &["validate", &file]);
    assert_eq!(status(&output), 2);
    assert!(
        messages(&output).contains("known families: heidenhain-fs, sinamics-s120, sinumerik-840d")
            && messages(&output).contains("(folders in "),
        "{}",
        stderr(&output)
    );
}

/// Other data than the binary's are taken where the user says so, and told where they lie above the file.
#[test]
fn other_family_data_are_named_or_told() {
    let machine = "spec/machines/milling-840d.toml";
    let change = [(
        "spec/families/sinumerik-840d/family.toml",
        "linear   = { range = [\"0.001 mm\", \"100 mm\"], default = \"1 mm\" }",
        "linear   = { range = [\"0.001 mm\", \"0.002 mm\"], default = \"0.002 mm\" }",
    )];
    let copy = copied(
        "other-family",
        machine,
        "spec/families/sinumerik-840d",
        &change,
    );
    let data = Path::new(&copy)
        .ancestors()
        .nth(2)
        .expect("the folder of the specification")
        .join("families");
    let folder = elsewhere("other-family");
    let file = folder.write("m.toml", &format!("{SMALLEST}STANDSTILL_TOL = \"1 mm\"\n"));
    assert_eq!(status(&away(&folder, &["validate", &file])), 0);
    let named = away(
        &folder,
        &[
            "validate",
            &file,
            "--family-data",
            data.to_str().expect("UTF-8"),
        ],
    );
    assert_eq!(status(&named), 2, "{}", stdout(&named));
    assert!(
        messages(&named).contains("STANDSTILL_TOL"),
        "{}",
        stderr(&named)
    );

    std::fs::write(&copy, SMALLEST).expect("written");
    let above = stillpoint(&["validate", &copy]);
    assert_eq!(status(&above), 0, "{}", stderr(&above));
    assert!(
        messages(&above).contains("note: family data of "),
        "{}",
        stderr(&above)
    );
    let same = stillpoint(&["validate", machine]);
    assert_eq!(stderr(&same), "");

    let nothing = away(&folder, &["validate", &file, "--family-data", "."]);
    assert_eq!(status(&nothing), 2);
    assert!(
        messages(&nothing).contains("family.toml"),
        "{}",
        stderr(&nothing)
    );
}

/// What guarantees have in common has a name, which must be one, and which something must take.
#[test]
fn what_guarantees_share_is_there_and_taken() {
    let says = |name: &str, from: &'static str, to: &'static str| {
        let change = [("spec/families/sinumerik-840d/guarantees.toml", from, to)];
        let machine = "spec/machines/milling-840d.toml";
        let copy = copied(name, machine, "spec/families/sinumerik-840d", &change);
        let output = stillpoint(&["validate", &copy]);
        assert_eq!(status(&output), 2, "{}", stdout(&output));
        messages(&output)
    };
    let missing = says("share-missing", "[share.claim]", "[share.claims]");
    assert!(
        missing.contains("nothing is shared as 'claim'")
            && missing.contains("nothing takes what is shared as 'claims'"),
        "{missing}"
    );
}
