//! `stillpoint export` and `stillpoint trace` as commands: what they print, write and answer.

use std::path::{Path, PathBuf};

use crate::common::{stdout, stillpoint};

/// A file that goes away with the value.
struct File(PathBuf);

impl File {
    fn new(name: &str) -> Self {
        Self(Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}-{name}", std::process::id())))
    }

    fn name(&self) -> &str {
        self.0.to_str().expect("UTF-8")
    }

    fn text(&self) -> String {
        std::fs::read_to_string(&self.0).expect("was written")
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn every_format_is_written() {
    let file = File::new("two-axis.pml");
    let output = stillpoint(&[
        "export",
        "spec/bench/two-axis.toml",
        "--to",
        "promela",
        "--output",
        file.name(),
    ]);
    assert_eq!(
        (output.status.code(), stdout(&output).as_str()),
        (Some(0), "")
    );
    assert!(
        file.text().contains("short s_axis_1_timer;"),
        "{}",
        file.text()
    );
    let printed = stillpoint(&["export", "spec/bench/two-axis.toml", "--to", "promela"]);
    assert_eq!(stdout(&printed), file.text());

    let must_fail = "tests/must-fail/lower-stop-displaces-higher.toml";
    let dot = stdout(&stillpoint(&["export", must_fail, "--to", "dot"]));
    assert!(
        dot.starts_with("// ") && dot.contains("digraph") && dot.contains("->"),
        "{dot}"
    );

    let json = stillpoint(&[
        "export",
        "spec/machines/milling-840d.toml",
        "--system",
        "stop:X",
        "--to",
        "json",
    ]);
    let value: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(value["system"], "sinumerik-840d/axis/stop");
    let mut rules = value["instances"]
        .as_array()
        .expect("a list")
        .iter()
        .flat_map(|i| i["rules"].as_array().expect("a list"));
    let rule = rules
        .find(|r| r["name"] == "stop.stop_b_goes_on")
        .expect("the rule");
    assert_eq!(rule["requirements"][0], "S840D-STOP-021");
    assert!(
        rule["when"].as_str().is_some_and(|t| t.contains("= B")),
        "{rule}"
    );
}

#[test]
fn wrong_arguments_are_named() {
    let error = |arguments: &[&str]| {
        let output = stillpoint(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let axis = "spec/families/sinumerik-840d/axis.toml";
    assert!(error(&["export", axis, "--to", "vhdl"]).contains("promela, murphi, smv, btor2"));
    assert!(error(&["export", axis, "--to", "json"]).contains("stop, stop_pair"));
    assert!(
        error(&["export", axis, "--to", "json", "--system", "stopp"]).contains("no system `stopp`")
    );
    let nowhere = [
        "export",
        axis,
        "--to",
        "json",
        "--system",
        "stop",
        "--output",
        "no/such/folder/x.json",
    ];
    assert!(error(&nowhere).contains("cannot be written"));
    assert!(error(&["trace", "--root", "spec"]).contains("has no folder spec"));
}

#[test]
fn tla_is_a_module_and_its_configuration() {
    let arguments = [
        "export",
        "spec/families/sinumerik-840d/axis.toml",
        "--system",
        "selection",
        "--to",
        "tla",
    ];
    let both = stdout(&stillpoint(&arguments));
    assert!(both.starts_with("---- MODULE selection ----\n"), "{both}");
    assert!(both.contains("====\n\nConfiguration, selection.cfg:\n\nSPECIFICATION Spec\n"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let name = format!("selection_{}", std::process::id());
    let (module, config) = (
        File(folder.join(format!("{name}.tla"))),
        File(folder.join(format!("{name}.cfg"))),
    );
    let mut to_file = arguments.to_vec();
    to_file.extend(["--output", module.name()]);
    assert!(stillpoint(&to_file).status.success());
    assert!(
        module
            .text()
            .starts_with(&format!("---- MODULE {name} ----\n"))
    );
    assert!(config.text().starts_with("SPECIFICATION Spec\n"));
    to_file.pop();
    to_file.push("840d-axis.tla");
    let refused = stillpoint(&to_file);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        message.contains("`840d-axis` cannot be the name of a TLA+ module"),
        "{message}"
    );
}

/// Exports the selection of an axis.
fn selection(format: &str) -> [&str; 6] {
    let file = "spec/families/sinumerik-840d/axis.toml";
    ["export", file, "--system", "selection", "--to", format]
}

#[test]
fn btor2_can_carry_one_property() {
    let all = selection("btor2");
    let bad = |text: &str| {
        text.lines()
            .filter(|l| l.split(' ').nth(1) == Some("bad"))
            .count()
    };
    assert!(bad(&stdout(&stillpoint(&all))) > 1);
    let mut one = all.to_vec();
    one.extend(["--property", "S840D-P-08"]);
    let text = stdout(&stillpoint(&one));
    assert_eq!(bad(&text), 1, "{text}");
    assert!(text.lines().any(|l| l.ends_with(" S840D-P-08")), "{text}");
    *one.last_mut().expect("an id") = "P-00";
    let refused = stillpoint(&one);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        message.contains("no `always` or `never` property `P-00`"),
        "{message}"
    );
    assert!(message.contains("S840D-P-08"), "{message}");
}

#[test]
fn aiger_is_text_or_binary_and_can_carry_one_property() {
    let all = selection("aiger");
    let header = |text: &str| -> Vec<String> {
        let first = text.lines().next().unwrap_or_default();
        first.split(' ').map(str::to_owned).collect()
    };
    let text = stdout(&stillpoint(&all));
    let whole = header(&text);
    assert_eq!(whole[0], "aag");
    assert!(whole[6].parse::<u32>().expect("a number") > 1, "{whole:?}");
    assert!(text.lines().any(|l| l.starts_with("l0 ")), "{text}");
    let mut one = all.to_vec();
    one.extend(["--property", "S840D-P-08"]);
    let text = stdout(&stillpoint(&one));
    assert_eq!(header(&text)[6], "1");
    assert!(text.lines().any(|l| l == "b0 S840D-P-08"), "{text}");
    let file = File::new("selection.aig");
    let mut binary = all.to_vec();
    binary.extend(["--output", file.name()]);
    let output = stillpoint(&binary);
    assert_eq!(output.status.code(), Some(0));
    let bytes = std::fs::read(file.name()).expect("it is there");
    assert!(bytes.starts_with(b"aig "));
    let end = bytes.iter().position(|b| *b == b'\n').expect("a line");
    let first = std::str::from_utf8(&bytes[..end]).expect("text");
    assert_eq!(header(first)[1..], whole[1..]);
}

#[test]
fn the_matrix_is_printed_and_written() {
    let file = File::new("matrix.html");
    let output = stillpoint(&["trace", "--json", "--html", file.name()]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let rows = value["requirements"].as_array().expect("a list");
    let html = file.text();
    assert!(rows.len() > 1000);
    for row in rows {
        assert!(html.contains(row["id"].as_str().expect("a text")), "{row}");
    }
    assert!(stdout(&stillpoint(&["trace"])).contains("sinumerik-840d"));
}
