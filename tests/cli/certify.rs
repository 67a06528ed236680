//! `check --certificate` and `certify` as their user meets them: exit status, streams, messages.

use std::path::Path;

use serde_json::Value;

use crate::common::{Folder, root, stillpoint};

/// The specification with every form of property.
const FORMS: &str = "tests/certified/forms.toml";

/// Exit status, and what was written to both streams.
fn told(arguments: &[&str]) -> (i32, String) {
    let output = stillpoint(arguments);
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8(text).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    (output.status.code().expect("no signal ended it"), text)
}

#[test]
fn a_certificate_is_written_and_confirmed() {
    let folder = Folder::new("certify-written");
    let file = folder.file("forms.cert");
    // The example has violations: the report says so, and the certificate is right about them.
    assert_eq!(told(&["check", FORMS, "--certificate", &file]).0, 1);
    let (status, text) = told(&["certify", &file]);
    assert_eq!(status, 0, "{text}");
    let head = "tests/certified/forms.toml: CONFIRMED, 25 claims, 9 of them violations, \
                1 of them missing witnesses, 1 properties not certified\n";
    assert!(text.starts_with(head), "{text}");
    for line in [
        "  burn = 3\n",
        "  holds          BOUNDED: it goes out in time [in at most 3 cycles]\n",
        "  violated       range: counter.add: sum\n",
        "  not certified  RECORDED: a recorded bound that is not the one found (the recorded bounds differ",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let (status, json) = told(&["certify", &file, "--json", "--threads", "2"]);
    assert_eq!(status, 0);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["result"], "confirmed");
    assert_eq!(
        (&json["confirmed"], &json["not_certified"]),
        (&24.into(), &1.into())
    );
    assert_eq!(json["tasks"][0]["properties"][4]["bound"], 3);
    let kept = std::fs::read_dir(&folder.0).expect("a folder").count();
    assert_eq!(kept, 1, "something is left beside the certificate");
}

#[test]
fn what_is_not_confirmed_has_a_status_and_one_line() {
    let folder = Folder::new("certify-refused");
    let (spec, file) = (folder.file("own.toml"), folder.file("own.cert"));
    let root = root();
    let text = std::fs::read_to_string(root.join(FORMS)).expect("the example");
    std::fs::write(&spec, &text).expect("written");
    assert_eq!(told(&["check", &spec, "--certificate", &file]).0, 1);
    assert_eq!(told(&["certify", &file]).0, 0);
    let refused = |status: i32, words: &str, arguments: &[&str]| {
        let output = stillpoint(arguments);
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(status), "{message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(
            message.contains(words),
            "`{message}` does not say `{words}`"
        );
    };
    // A comment is enough: the text is another one.
    std::fs::write(&spec, format!("{text}# changed\n")).expect("written");
    refused(
        1,
        "is not the file that the certificate was made for",
        &["certify", &file],
    );
    std::fs::remove_file(&spec).expect("removed");
    refused(2, "no such file", &["certify", &file]);
    // A file of another name has the right text, but is not the one named.
    refused(1, "is not the file", &["certify", &file, "--spec", FORMS]);
    std::fs::write(&spec, &text).expect("written");

    let bytes = std::fs::read(&file).expect("the certificate");
    let other = folder.file("other.cert");
    let mut altered = bytes.clone();
    let middle = altered.len() / 2;
    altered[middle] ^= 4;
    for (bytes, status, words) in [
        (&altered[..], 1, "truncated or was altered"),
        (&bytes[..bytes.len() - 1], 1, "truncated or was altered"),
        (&bytes[..10], 2, "no certificate"),
        (b"", 2, "no certificate"),
    ] {
        std::fs::write(&other, bytes).expect("written");
        refused(status, words, &["certify", &other]);
    }
    std::fs::write(&other, &altered).expect("written");
    let output = stillpoint(&["certify", &other, "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(
        (output.status.code(), &json["result"]),
        (Some(1), &"rejected".into())
    );
    refused(2, "no/such.cert", &["certify", "no/such.cert"]);
    refused(2, "no regular file", &["certify", "tests"]);
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let (status, text) = told(&["check", FORMS, "--certificate", "no/such/folder/x.cert"]);
    assert_eq!(status, 2);
    assert!(
        text.contains("no/such/folder/x.cert cannot be written"),
        "{text}"
    );
    if Path::new("/dev/full").exists() {
        let (status, text) = told(&["check", FORMS, "--certificate", "/dev/full"]);
        assert_eq!(status, 2);
        assert!(
            text.contains("/dev/full cannot be written: No space left"),
            "{text}"
        );
        assert!(
            Path::new("/dev/full")
                .metadata()
                .is_ok_and(|m| !m.is_file())
        );
    }
}

/// The same for what the proof engines find: text, which is altered line by line.
#[test]
fn a_proof_is_written_confirmed_and_refused_when_altered() {
    let folder = Folder::new("certify-proofs");
    let file = folder.file("forms.cert");
    let prove = [
        "check",
        FORMS,
        "--engine",
        "pdr",
        "--every",
        "all",
        "--certificate",
        &file,
    ];
    assert_eq!(told(&prove).0, 1);
    let (status, text) = told(&["certify", &file]);
    assert_eq!(status, 0, "{text}");
    for line in [
        "tests/certified/forms.toml: CONFIRMED, 19 claims",
        "  burn = 1 .. 4, every value\n",
        "  holds          ALWAYS: never longer than the burning time [invariant of ",
        "  violated       NEVER: the last two values are not used [run of 1 cycles]\n",
        "  holds          RECOVER: it goes out, also unknocked [5 regions, invariant of ",
        "  violated       range: no assignment leaves the range of its variable [run of 3 cycles]\n",
        "  holds          FAIR: switched on again and again it burns or is broken [measure of 2 rounds, invariant of ",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    let (status, json) = told(&["certify", &file, "--json"]);
    assert_eq!(status, 0);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        json["tasks"][0]["every"][0],
        serde_json::json!(["burn", [1, 4]])
    );
    assert_eq!(json["tasks"][2]["range"], "violated");
    let written = std::fs::read_to_string(&file).expect("there");
    let cut: String = written
        .lines()
        .take(60)
        .map(|line| format!("{line}\n"))
        .collect();
    std::fs::write(&file, cut).expect("written");
    let (status, text) = told(&["certify", &file]);
    assert_eq!(status, 1, "{text}");
    assert!(
        text.contains("line 60: the file is truncated or was altered"),
        "{text}"
    );
    let (status, text) = told(&[
        "check",
        FORMS,
        "--engine",
        "explorer",
        "--certificate",
        &file,
    ]);
    assert_eq!(status, 2, "{text}");
    assert!(text.contains("leave out --engine"), "{text}");
}
