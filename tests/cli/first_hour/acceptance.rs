//! `acceptance --run` on machines that a builder could have.

use serde_json::Value;

use crate::common::{root, status, stderr, stdout, stillpoint};

fn protocol(file: &str) -> Value {
    let output = stillpoint(&["acceptance", file, "--run", "--json"]);
    assert_eq!(status(&output), 0, "{file}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

fn list<'a>(value: &'a Value, key: &str) -> &'a Vec<Value> {
    value[key]
        .as_array()
        .unwrap_or_else(|| panic!("{key} of {value}"))
}

/// On every such machine each simulated test gives what is expected, every window that is not fixed names its formula, and what
/// is not simulated has a reason that speaks about the machine, not about a scenario that nobody wrote.
#[test]
fn plausible_machines_pass_or_are_told_why() {
    let entries = std::fs::read_dir(root().join("tests/plausible")).expect("the folder");
    let mut files: Vec<String> = entries
        .map(|e| {
            e.expect("an entry")
                .file_name()
                .into_string()
                .expect("plain")
        })
        .collect();
    files.sort();
    assert!(files.len() >= 7, "{files:?}");
    let mut formulas = 0;
    for file in files {
        let protocol = protocol(&format!("tests/plausible/{file}"));
        let ran = list(&protocol, "simulated");
        assert!(ran.len() > 10, "{file}: {} tests were run", ran.len());
        for test in ran {
            assert_eq!(test["holds"], true, "{file}: {test}");
            for expectation in list(test, "expectations") {
                let text = expectation["text"].as_str().expect("a text");
                formulas += usize::from(text.contains("monitoring_cycle)"));
            }
        }
        let text = protocol.to_string();
        for wrong in [
            "does not fit these values",
            "it would take",
            "no cycle lies",
        ] {
            assert!(!text.contains(wrong), "{file}: {wrong}");
        }
    }
    assert!(formulas > 50, "{formulas}");
}

/// The formula stands in the protocol itself, beside the time that it gave.
#[test]
fn the_protocol_states_the_formula_of_each_time() {
    let page = stdout(&stillpoint(&["acceptance", "tests/plausible/slow.toml"]));
    assert!(
        page.contains("`CYCLES(PULSE_DIS_CHECK_TIME) * monitoring_cycle`"),
        "{page}"
    );
    assert!(
        page.contains("`(differ + 84) * monitoring_cycle`"),
        "{page}"
    );
}

/// A spindle whose STOP C ends in SBH at once cannot show that it brakes before: the protocol says so in place of failing.
#[test]
fn a_test_that_the_values_exclude_says_why() {
    let page = stdout(&stillpoint(&[
        "acceptance",
        "tests/plausible/spindle-at-once.toml",
        "--run",
    ]));
    let words = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains(
            "ends in SBH after 0 s, which is 0 monitoring cycles: no moving axis stands by then"
        ),
        "{words}"
    );
}
