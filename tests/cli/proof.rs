//! `check --engine`: what it prints and its exit status.

use crate::common::{Folder, copied, messages, status, stderr, stdout, stillpoint};

const BROKEN: &str = "tests/must-fail/stop-b-without-timer.toml";
const GOOD: &str = "spec/families/sinumerik-840d/axis.toml";

fn lines_with(text: &str, what: &str) -> usize {
    text.lines().filter(|line| line.contains(what)).count()
}

#[test]
fn a_broken_property_is_shown_by_a_shortest_run() {
    for engine in ["auto", "pdr", "bdd", "bmc", "kinduction", "explorer"] {
        let output = stillpoint(&["check", BROKEN, "--engine", engine]);
        let text = stdout(&output);
        assert_eq!(status(&output), 1, "{engine}: {text}{}", stderr(&output));
        assert!(text.contains("VIOLATED  S840D-P-05"), "{engine}: {text}");
        assert!(text.contains("broken after 4 cycles"), "{engine}: {text}");
        assert!(
            text.contains("a shortest run, 4 cycles:"),
            "{engine}: {text}"
        );
    }
}

#[test]
fn each_property_tells_its_engine() {
    let output = stillpoint(&["check", GOOD, "--engine", "auto"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    assert!(lines_with(&text, "holds        pdr ") > 10, "{text}");
    assert!(lines_with(&text, "reached      bmc ") > 0, "{text}");
    assert!(text.contains("measure of at most "), "{text}");
    assert!(text.contains("clauses, checked"), "{text}");
    assert!(!text.contains("inconclusive"), "{text}");
}

#[test]
fn what_an_engine_cannot_decide_is_open_with_its_reason() {
    let output = stillpoint(&["check", GOOD, "--engine", "bmc", "--depth", "4"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 3, "{text}");
    assert!(text.contains("no run of up to 4 cycles"), "{text}");
    assert!(
        text.contains("what can always be reached needs pdr or bdd"),
        "{text}"
    );
}

#[test]
fn the_same_is_told_twice() {
    let once = || stdout(&stillpoint(&["check", GOOD, "--engine", "pdr"]));
    assert_eq!(once(), once());
}

#[test]
fn options_of_the_report_are_refused() {
    let output = stillpoint(&["check", GOOD, "--engine", "pdr", "--html", "page.html"]);
    assert_eq!(status(&output), 2);
    assert!(messages(&output).contains("cannot be used with"));
    let output = stillpoint(&["check", GOOD, "--depth", "4"]);
    assert_eq!(status(&output), 2);
}

#[test]
fn json_has_verdict_engine_and_proof() {
    let output = stillpoint(&["check", BROKEN, "--engine", "pdr", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let all = json["runs"][0]["properties"].as_array().expect("a list");
    let broken = all
        .iter()
        .find(|p| p["id"] == "S840D-P-05")
        .expect("the property");
    assert_eq!(broken["verdict"], "violated");
    assert_eq!(broken["length"], 4);
    assert_eq!(broken["engine"], "bmc");
}

#[test]
fn sets_of_states_are_counted_and_have_no_certificate() {
    let output = stillpoint(&[
        "check",
        "spec/families/heidenhain-fs/reference.toml",
        "--engine",
        "bdd",
    ]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    assert!(text.contains("holds        bdd        states"), "{text}");
    let output = stillpoint(&["check", GOOD, "--engine", "bdd", "--certificate", "x.cert"]);
    assert_eq!(status(&output), 2);
    assert!(messages(&output).contains("a set of states has none"));
}

/// For all values a property fails, for those that satisfy a condition it holds; and so says its certificate.
#[test]
fn a_condition_leaves_some_configurations() {
    const FORMS: &str = "tests/certified/forms.toml";
    let folder = Folder::new("conditions");
    let file = folder.file("forms.cert");
    let every = ["check", FORMS, "--engine", "pdr", "--every", "all"];
    let text = stdout(&stillpoint(&every));
    assert_eq!(
        lines_with(&text, "VIOLATED  NEVER  the last two values"),
        1,
        "{text}"
    );
    let such = [
        "--where",
        "burn < 4",
        "--where",
        "burn <> 2",
        "--certificate",
        &file,
    ];
    let text = stdout(&stillpoint(&[&every[..], &such].concat()));
    assert!(
        text.contains(
            "  for every burn = 1 .. 4: 4 configurations\n  where burn < 4\n  where burn <> 2\n"
        ),
        "{text}"
    );
    assert_eq!(
        lines_with(&text, "holds        pdr        NEVER "),
        1,
        "{text}"
    );

    let output = stillpoint(&["certify", &file]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}");
    assert!(
        text.contains("  burn = 1 .. 4, every value\n  where burn < 4\n  where burn <> 2\n"),
        "{text}"
    );

    for (condition, why) in [
        ("burn<4", "space around its operator"),
        ("bern < 4", "`bern` in `bern < 4` is no parameter of"),
        ("burn < long", "neither a parameter of"),
        (
            "burn > 4",
            "no values of the parameters of certified/forms satisfy",
        ),
    ] {
        let output = stillpoint(&[&every[..], &["--where", condition]].concat());
        let told = messages(&output);
        assert!(told.contains(why), "{condition}: {told}");
        assert_eq!(status(&output), 2, "{condition}: {told}");
    }
}

/// A check of the machine asks its product as well: an error of the kernel between the groups, which no part of it has.
#[test]
fn a_check_asks_the_whole_machine_too() {
    let from = "\"i <> 2 OR NOT drive[1].moving\"";
    let spindle = (
        "spec/families/heidenhain-fs/products/machine.toml",
        from,
        "\"TRUE\"",
    );
    let machine = copied(
        "checked-whole",
        "spec/machines/machining-centre-heidenhain.toml",
        "spec/families/heidenhain-fs",
        &[spindle],
    );
    let folder = Folder::new("checked-whole-page");
    let page = folder.file("page.html");
    let output = stillpoint(&["check", &machine, "--html", &page]);
    let text = stdout(&output);
    assert_eq!(status(&output), 1, "{text}{}", stderr(&output));
    assert_eq!(lines_with(&text, "VIOLATED  HFS-SS1D-001"), 1, "{text}");
    assert!(text.contains("  in: the whole machine: program"), "{text}");
    assert!(
        text.contains("  not explored: 26 properties asked of "),
        "{text}"
    );
    let page = std::fs::read_to_string(page).expect("written");
    assert!(page.contains("since its states were not enumerated"));
}

/// A machine of three groups as one product, with its own program: an error in it is found there too.
#[test]
fn a_whole_machine_is_one_product() {
    const MACHINE: &str = "spec/machines/machining-centre-heidenhain.toml";
    let output = stillpoint(&["check", MACHINE, "--engine", "pdr", "--whole"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    assert!(lines_with(&text, "holds        pdr ") > 20, "{text}");
    assert!(text.contains("HFS-P-09-START[3]"), "{text}");

    let file = std::fs::read_to_string(crate::common::root().join(MACHINE)).expect("the machine");
    let from = "gen_safe AND pb AND (jog OR turned)";
    assert!(file.contains(from));
    let folder = Folder::new("whole");
    let to = "gen_safe AND (pb OR unit = PROGRAM) AND (jog OR turned)";
    let path = folder.write("machine.toml", &file.replace(from, to));
    let output = stillpoint(&["check", &path, "--engine", "pdr", "--whole"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 1, "{text}{}", stderr(&output));
    assert!(text.contains("VIOLATED  HFS-P-09-START[2]"), "{text}");

    let output = stillpoint(&[
        "check",
        "spec/machines/storage-crane.toml",
        "--engine",
        "pdr",
        "--whole",
    ]);
    assert_eq!(status(&output), 2);
    assert!(messages(&output).contains("is described by its parts alone"));
}

/// The axes of a group of any number are judged together, beside the exploration of each, as far as that is no theorem.
#[test]
fn a_group_of_five_axes_is_judged_together() {
    let axes = ["X", "Y", "Z", "A", "C"];
    let axes =
        axes.map(|name| format!("[axis.{name}]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\n"));
    let text = format!("family = \"sinumerik-840d\"\n{}", axes.concat());
    let folder = Folder::new("five-axes");
    let path = folder.write("five.toml", &text);
    let output = stillpoint(&["check", &path, "-v"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    for told in [
        "\nCoupled, judged together: X, Y, Z, A, C.\n",
        "effect of a stop on all axes of the group, axes X, Y, Z, A, C\n",
        "not explored: 4 of its 6 properties are theorems of the family, 2 properties asked of",
        "times rounded up to cycles of 12 ms: t_b[1..5] = 9 cycles",
        "  with axes = 5, t_b[1..12] = 9, ",
    ] {
        assert!(text.contains(told), "{told}: {text}");
    }
    assert!(!text.contains("one by one"), "{text}");
    let output = stillpoint(&["check", &path, "--engine", "pdr", "--whole"]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    assert_eq!(lines_with(&text, "holds        pdr "), 5, "{text}");
}
