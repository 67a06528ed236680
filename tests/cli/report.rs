//! The report of `check` as HTML and as Markdown.

use std::path::{Path, PathBuf};
use std::process::Output;

use crate::common::{root, stillpoint};

/// A folder of this test that is empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn check(arguments: &[&str]) -> Output {
    stillpoint(&[&["check"], arguments].concat())
}

/// The page and the Markdown of a check that ends with this status.
fn reports(file: &str, status: i32, more: &[&str], folder: &Path) -> (String, String) {
    let page = folder.join("report.html");
    let mut arguments = vec![file, "--markdown", "--html", page.to_str().expect("UTF-8")];
    arguments.extend(more);
    let output = check(&arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(status), "{said}");
    let html = std::fs::read_to_string(page).expect("the page");
    let markdown = String::from_utf8(output.stdout).expect("UTF-8");
    (html, markdown)
}

#[test]
fn a_violated_property_is_shown_with_its_run() {
    let file = "tests/must-fail/lower-stop-displaces-higher.toml";
    let (html, markdown) = reports(file, 1, &[], &folder("violated"));
    for part in [
        "<p class=\"result\">VIOLATED</p>",
        "1 property: 1 violated. Every reachable state was explored.",
        "<span class=\"badge bad\">violated</span>",
        "<figure class=\"timing\">",
        "cycle 2: S840D-P-03 is violated here",
        "<figure class=\"graph\">",
        "runs begin here",
        "Made by stillpoint",
        "lower-stop-displaces-higher.toml",
    ] {
        assert!(html.contains(part), "{part}\n{html}");
    }
    for part in [
        "> **VIOLATED**",
        "^ S840D-P-03 is violated here",
        "`NONE`: runs begin here, reached",
    ] {
        assert!(markdown.contains(part), "{part}\n{markdown}");
    }
}

#[test]
fn a_page_needs_nothing_from_elsewhere() {
    let file = "tests/must-fail/stop-b-without-timer.toml";
    let (html, _) = reports(file, 1, &[], &folder("alone"));
    // The name of a vocabulary is no address to be fetched.
    let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for part in [
        "http:", "https:", "//www", "url(", "@import", "<link", " src=",
    ] {
        assert!(!html.contains(part), "{part}");
    }
}

#[test]
fn equal_input_gives_equal_bytes() {
    let file = "spec/families/sinumerik-840d/reaction.toml";
    let folder = folder("equal");
    let first = reports(file, 0, &["--threads", "1"], &folder);
    assert_eq!(first, reports(file, 0, &["--threads", "1"], &folder));
    assert_eq!(first, reports(file, 0, &["--threads", "2"], &folder));
    let here = root().canonicalize().expect("the root");
    let here = here.to_str().expect("UTF-8");
    assert!(!first.0.contains(here) && !first.1.contains(here), "{here}");
}

#[test]
fn the_same_properties_in_every_format() {
    let file = "spec/families/sinumerik-840d/reaction.toml";
    let (html, markdown) = reports(file, 0, &[], &folder("formats"));
    let output = check(&[file, "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let properties = json["properties"].as_array().expect("properties");
    assert!(properties.len() > 20);
    for property in properties {
        let id = property["id"].as_str().expect("an id");
        assert!(html.contains(&format!("<code>{id}</code>")), "{id}");
        assert!(markdown.contains(&format!("`{id}`")), "{id}");
    }
    for run in json["runs"].as_array().expect("runs") {
        for (name, _) in run["parameters"].as_object().expect("parameters") {
            assert!(html.contains(&format!("<code>{name}</code>")), "{name}");
        }
        for rule in run["rules"].as_array().expect("rules") {
            let name = rule["rule"].as_str().expect("a name");
            assert!(html.contains(&format!("<code>{name}</code>")), "{name}");
        }
    }
    for reading in ["Reaction times", "Readings of the manual", "Rule coverage"] {
        assert!(markdown.contains(&format!("## {reading}")) || markdown.contains(reading));
    }
    // What must be reachable is shown by a run.
    assert!(html.contains("A run that shows S840D-ARCH-509-SHORT"));
    assert!(html.contains("S840D-ARCH-509-SHORT is reached here"));
}

#[test]
fn a_machine_is_told_with_its_units() {
    let folder = folder("machine");
    let machine = folder.join("plain.toml");
    let text = "family = \"sinumerik-840d\"\ntitle = \"One <axis>\"\n[control]\nSYSCLOCK_CYCLE_TIME = \"4 ms\"\n\
                SAFETY_SYSCLOCK_TIME_RATIO = 3\n[axis.X]\nkind = \"linear\"\nfunctions = []\n";
    std::fs::write(&machine, text).expect("written");
    // The families stand beside the folder of the machine files.
    let beside = root().join("spec").canonicalize().expect("spec");
    std::os::unix::fs::symlink(beside, folder.join("spec")).expect("a link");
    let (html, markdown) = reports(machine.to_str().expect("UTF-8"), 0, &[], &folder);
    for part in [
        "One &lt;axis&gt;",
        "one monitoring cycle is 12 ms",
        "<td data-label=\"parameter\"><code>SYSCLOCK_CYCLE_TIME</code></td><td data-label=\"value\">4 ms</td>",
        "parameters have the default of the manual",
        "harnesses, with bounds and caveats",
        "plain.toml",
        "family.toml",
    ] {
        assert!(html.contains(part), "{part}\n{html}");
    }
    assert!(markdown.contains("One &lt;axis&gt;"), "{markdown}");
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_check() {
    let file = "tests/must-fail/lower-stop-displaces-higher.toml";
    let missing = folder("refused").join("missing/report.html");
    let output = check(&[file, "--html", missing.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("in no folder that exists"), "{said}");
    let both = check(&[file, "--json", "--markdown"]);
    assert_eq!(both.status.code(), Some(2));
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    /// A report of what was explored with times of a program left open is about the file as it stands.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn what_holds_with_open_times_is_reported() {
        let file = "tests/machines/interlock-840d.toml";
        let (html, markdown) = reports(file, 0, &[], &folder("open-times"));
        for page in [html, markdown] {
            assert!(page.contains("left open in each cycle"), "{page}");
            assert!(page.contains("hold_to_run"), "{page}");
        }
    }
}
