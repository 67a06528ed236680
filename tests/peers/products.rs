//! Whole machines as one product each, which no explorer can enumerate, by the proof engines.

use std::path::{Path, PathBuf};
use std::time::Duration;

use stillpoint_harness::proof::{Choice, Every, Judged, Settings, Which, judge, judge_every};
use stillpoint_model::Verdict;
use stillpoint_tests::peer::load;
use stillpoint_tests::{files, root};

/// Changes of the machining centre between its parts, each with the property that finds it.
const BROKEN: [(&str, &str, &str); 7] = [
    // The spindle does not wait for the axes.
    (
        "\"i <> 2 OR NOT drive[1].moving\"",
        "\"TRUE\"",
        "HFS-SS1D-001",
    ),
    // The axes are not stopped with it.
    (
        "SEL(i = 1 AND judge[2].stops_axes, NONE, SS2), ",
        "",
        "HFS-MODE-011",
    ),
    // An SS1F stays in its group.
    (
        "SEL(EXISTS(j IN stop, j <> i AND PREV(stop[j].level) >= SS1F), NONE, SS1F), ",
        "",
        "HFS-SS1-001[1]",
    ),
    // It becomes an SS1 there, which needs no main switch.
    (
        ">= SS1F), NONE, SS1F), ",
        ">= SS1F), NONE, SS1), ",
        "HFS-SS1-001[1]",
    ),
    // The kernel reads the permissive of the magazine for the spindle.
    (
        "\"MUX(i - 1, splc.pb_a, splc.pb_s, splc.pb_t)\"",
        "\"MUX(i - 1, splc.pb_a, splc.pb_t, splc.pb_s)\"",
        "HFS-MODE-011",
    ),
    // The logic looks at the wrong door.
    (
        "\"splc.t_open\"          = \"t_open\"",
        "\"splc.t_open\"          = \"door_open\"",
        "HFS-P-09-START[3]",
    ),
    // What is activated is the group beside.
    (
        "\"MUX(i - 1, splc.activate_a, splc.activate_s, splc.activate_t)\"",
        "\"MUX(i - 1, splc.activate_s, splc.activate_a, splc.activate_t)\"",
        "HFS-P-09-START[2]",
    ),
];

fn settings() -> Settings {
    Settings {
        choice: Choice::Pdr,
        depth: 0,
        time: None,
        each: Some(Duration::from_secs(120)),
        memory: None,
        ..Settings::default()
    }
}

fn products() -> Vec<PathBuf> {
    files("spec/families/heidenhain-fs/products", "toml")
}

fn all_hold(judged: &[Judged], file: &Path) {
    assert!(judged.len() > 20, "{}", file.display());
    for one in judged {
        let reason = one.reason.as_deref().unwrap_or_default();
        assert_eq!(
            one.verdict,
            Verdict::Holds,
            "{}: {}: {reason}",
            file.display(),
            one.id
        );
    }
}

#[test]
fn a_whole_machine_keeps_what_its_parts_keep() {
    for file in products() {
        for task in &load(&file).tasks {
            all_hold(&judge(&task.bound, &settings()), &file);
        }
    }
}

#[test]
fn an_error_between_its_parts_is_found() {
    let text =
        std::fs::read_to_string(root().join("spec/families/heidenhain-fs/products/machine.toml"));
    let text = text.expect("the machine");
    let family = root().join("spec/families/heidenhain-fs/");
    let family = family.display().to_string();
    let folder = std::env::temp_dir().join(format!("stillpoint-products-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for (from, to, breaks) in BROKEN {
        assert!(text.contains(from), "{from}");
        let file = folder.join("broken.toml");
        let broken = text
            .replace(from, to)
            .replace("\"../", &format!("\"{family}"));
        std::fs::write(&file, broken).expect("written");
        let judged = judge(&load(&file).tasks[0].bound, &settings());
        let broken: Vec<&str> = (judged.iter())
            .filter(|one| one.verdict == Verdict::Violated)
            .map(|one| one.id.as_str())
            .collect();
        assert!(broken.contains(&breaks), "{from}: {broken:?}");
    }
    std::fs::remove_dir_all(folder).expect("removed");
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn it_keeps_it_in_every_configuration() {
        for file in products() {
            for task in &load(&file).tasks {
                let every = Every::new(&task.bound, &Which::All).expect("free parameters");
                all_hold(&judge_every(&every, &settings()), &file);
            }
        }
    }
}
