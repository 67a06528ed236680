//! A check that is killed again and again and continued gives the report of an undisturbed one; nothing that happens to
//! its checkpoints goes unnoticed.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, SystemTime};

use serde_json::Value;

use crate::common::root;

const BINARY: &str = env!("CARGO_BIN_EXE_stillpoint");
const SUBJECT: &str = "spec/families/sinumerik-840d/faults.toml";

/// A folder that goes away with the value.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("survival-{name}-{}", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        Folder(path)
    }

    /// The checkpoints in it.
    fn files(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&self.0).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|e| e.path()).collect();
        files.retain(|p| p.extension().is_some_and(|e| e == "checkpoint"));
        files.sort();
        files
    }

    /// What is in it: names, lengths, times.
    fn contents(&self) -> Vec<(PathBuf, u64, Option<SystemTime>)> {
        let entries = std::fs::read_dir(&self.0).into_iter().flatten().flatten();
        let shown = |entry: std::fs::DirEntry| {
            let data = entry.metadata().ok()?;
            Some((entry.path(), data.len(), data.modified().ok()))
        };
        let mut contents: Vec<_> = entries.filter_map(shown).collect();
        contents.sort();
        contents
    }

    /// The option that starts or continues.
    fn option(&self) -> [&str; 2] {
        let option = match self.files().is_empty() {
            true => "--checkpoint",
            false => "--resume",
        };
        [option, self.0.to_str().expect("a path in UTF-8")]
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn check(subject: &str, options: &[&str]) -> Command {
    let mut command = Command::new(BINARY);
    command
        .current_dir(root())
        .args(["check", subject, "--json"]);
    command.args(options);
    command
}

fn run(subject: &str, options: &[&str]) -> Output {
    check(subject, options).output().expect("runs")
}

/// A report without what differs from run to run.
fn plain(output: &Output) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for key in ["seconds", "memory", "bytes_per_state", "resumable"] {
                    map.remove(key);
                }
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => (),
        }
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    let mut report = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}{errors}"));
    strip(&mut report);
    report
}

#[test]
fn ten_kills_in_a_row_change_nothing() {
    let folder = Folder::new("kill");
    let whole = run(SUBJECT, &[]);
    let mut killed = 0;
    for n in 1..=10u64 {
        let before = folder.contents();
        let mut command = check(SUBJECT, &folder.option());
        command.args(["--checkpoint-every", "10ms"]);
        let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        let mut child = child.expect("starts");
        // Some moment after it has got further than the one before.
        let mut ended = None;
        while ended.is_none() && folder.contents() == before {
            std::thread::sleep(Duration::from_millis(1));
            ended = child.try_wait().expect("waits");
        }
        std::thread::sleep(Duration::from_millis(3 * n));
        if child.try_wait().expect("waits").is_none() {
            // SIGKILL: nothing can be tidied up.
            child.kill().expect("kills");
            killed += 1;
        }
        child.wait().expect("ends");
    }
    assert!(killed >= 8, "only {killed} of 10 checks could be killed");
    assert!(!folder.files().is_empty());
    let last = run(SUBJECT, &folder.option());
    assert_eq!(last.status.code(), whole.status.code());
    assert_eq!(plain(&last), plain(&whole));
}

#[test]
fn too_little_memory_or_time_leaves_something_to_continue_from() {
    let folder = Folder::new("limits");
    let whole = run(SUBJECT, &[]);
    let option = folder.option().map(str::to_owned);
    let small = run(SUBJECT, &[&option[0], &option[1], "--memory", "1MiB"]);
    assert_eq!(small.status.code(), Some(3));
    let report: Value = serde_json::from_slice(&small.stdout).expect("JSON");
    let runs = report["runs"].as_array().expect("runs");
    assert!(runs.iter().any(|r| r["complete"] == false));
    assert!(runs.iter().all(|r| r["resumable"] == true));
    // Within a tenth of what was allowed, plus the least that each worker takes: what it remembers of 128-bit indices.
    let workers = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let allowed = (1 << 20) * 11 / 10 + workers * (128 << 10);
    let most = runs.iter().filter_map(|r| r["memory"].as_u64()).max();
    assert!(most.is_some_and(|m| m < allowed), "{most:?}");
    let option = folder.option().map(str::to_owned);
    let last = run(SUBJECT, &[&option[0], &option[1]]);
    assert_eq!(plain(&last), plain(&whole));
}

#[test]
fn checkpoints_of_something_else_are_refused() {
    let folder = Folder::new("refused");
    let subject = "spec/families/sinumerik-840d/comparison.toml";
    let option = folder.option().map(str::to_owned);
    assert_eq!(
        run(subject, &[&option[0], &option[1]]).status.code(),
        Some(0)
    );
    let refused = |options: &[&str], reason: &str| {
        let output = run(subject, options);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(reason), "{errors}");
    };
    let path = folder.0.to_str().expect("a path in UTF-8");
    refused(&["--checkpoint", path], "already holds checkpoints");
    refused(&["--resume", "no/such/folder"], "cannot be read");
    let output = run("spec/bench/two-axis.toml", &["--resume", path]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{errors}");
    assert!(errors.contains("another specification"), "{errors}");
    let first = &folder.files()[0];
    let good = std::fs::read(first).expect("readable");
    let name = first.to_str().expect("a path in UTF-8");
    for (bytes, reason) in [
        (good[..good.len() / 2].to_vec(), "damaged"),
        (
            [&good[..40], &[good[40] ^ 1], &good[41..]].concat(),
            "damaged",
        ),
        (
            std::fs::read(&folder.files()[1]).expect("readable"),
            "another specification",
        ),
    ] {
        std::fs::write(first, bytes).expect("written");
        refused(&["--resume", path], reason);
        refused(&["--resume", path], name);
    }
}

#[test]
fn a_full_disk_loses_a_checkpoint_but_not_the_check() {
    let folder = Folder::new("full");
    let whole = run(SUBJECT, &[]);
    // Files of more than 8 KiB cannot be written, as on a disk that is full.
    let command = format!(
        "trap '' XFSZ; ulimit -f 8; exec \"$0\" check {SUBJECT} --json --checkpoint \"$1\" --checkpoint-every 1ms"
    );
    let output = Command::new("bash")
        .args(["-c", &command])
        .args([Path::new(BINARY), &folder.0])
        .current_dir(root())
        .output()
        .expect("runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(errors.contains("cannot be written"), "{errors}");
    assert_eq!(output.status.code(), whole.status.code());
    assert_eq!(plain(&output), plain(&whole));
    let left = std::fs::read_dir(&folder.0).expect("readable").flatten();
    assert!(
        left.map(|e| e.path())
            .all(|p| p.extension().is_some_and(|e| e == "checkpoint"))
    );
}

/// A specification whose only state reads so many free Booleans that their values cannot be gone through; and a folder for it.
fn endless(name: &str) -> (Folder, String) {
    const FREE: usize = 30;
    let folder = Folder::new(name);
    std::fs::create_dir_all(&folder.0).expect("made");
    let list = |form: &dyn Fn(usize) -> String, between: &str| {
        (0..FREE).map(form).collect::<Vec<_>>().join(between)
    };
    let text = format!(
        r#"
spec = "survival/endless"
title = "thirty free Booleans"
[machine.m]
text = "reads all of them"
otherwise = "stay"
[machine.m.input]
{}
[machine.m.state]
seen = {{ type = "BOOL", init = "FALSE" }}
[[machine.m.rule]]
name = "odd"
id = ["S840D-STOP-020"]
when = "{}"
then = "seen := TRUE;"
[system.m]
text = "one"
[system.m.instance]
m = {{ machine = "m" }}
[system.m.free]
ports = [{}]
[[system.m.property]]
id = "P-01"
text = "nothing is wrong with it"
always = "m.seen OR NOT m.seen"
"#,
        list(&|n| format!("a{n} = \"BOOL\""), "\n"),
        list(&|n| format!("a{n}"), " XOR "),
        list(&|n| format!("\"m.a{n}\""), ", "),
    );
    let file = folder.0.join("endless.toml");
    std::fs::write(&file, text).expect("written");
    (folder, file.to_str().expect("a path in UTF-8").to_owned())
}

/// Whether an output is the report of a check that has not ended.
fn is_partial(output: &Output) {
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["complete"], false);
    assert!(report["states"].as_u64().is_some_and(|n| n > 0), "{report}");
    let properties = report["properties"].as_array().expect("properties");
    let open = |p: &Value| p["verdict"] == "inconclusive";
    assert!(properties.iter().any(open), "{report}");
}

#[test]
fn a_time_limit_ends_the_inputs_of_one_state() {
    let (_folder, file) = endless("endless-time");
    for more in [
        &[][..],
        &["--interpret"],
        &["--reduce", "all"],
        &["--processes", "2"],
    ] {
        let start = std::time::Instant::now();
        let output = run(&file, &[&["--time", "1s"], more].concat());
        let took = start.elapsed();
        assert!(took < Duration::from_secs(8), "{more:?}: {took:?}");
        is_partial(&output);
    }
}

/// Sends a signal to a process.
fn signal(child: &std::process::Child, name: &str) {
    let sent = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
}

#[test]
fn signals_end_a_check_with_its_report() {
    let (_folder, file) = endless("endless-signal");
    for name in ["TERM", "INT"] {
        let mut command = check(&file, &[]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("starts");
        // As long as it takes to begin.
        std::thread::sleep(Duration::from_millis(1500));
        signal(&child, name);
        is_partial(&child.wait_with_output().expect("ends"));
    }
    // In words too.
    let mut command = Command::new(BINARY);
    command.args(["check", &file]).stdout(Stdio::piped());
    let child = command.spawn().expect("starts");
    std::thread::sleep(Duration::from_millis(1500));
    signal(&child, "TERM");
    let output = child.wait_with_output().expect("ends");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(
        text.contains("An interrupt ended 1 of 1 explorations"),
        "{text}"
    );
}

#[test]
fn a_signal_leaves_something_to_continue_from() {
    let folder = Folder::new("signal");
    let whole = run(SUBJECT, &[]);
    let mut ended = 0;
    for n in 1..=6u64 {
        let before = folder.contents();
        let mut command = check(SUBJECT, &folder.option());
        command.args(["--checkpoint-every", "10ms"]);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut child = child.expect("starts");
        // Not before it has begun.
        while child.try_wait().expect("waits").is_none() && folder.contents() == before {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(3 * n));
        if child.try_wait().expect("waits").is_none() {
            signal(&child, "TERM");
        }
        let output = child.wait_with_output().expect("ends");
        if output.status.code() == Some(3) {
            is_partial(&output);
            let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
            let runs = report["runs"].as_array().expect("runs");
            assert!(runs.iter().all(|r| r["resumable"] == true), "{report}");
            ended += 1;
        }
    }
    assert!(ended > 0, "no signal came during a check");
    let last = run(SUBJECT, &folder.option());
    assert_eq!(last.status.code(), whole.status.code());
    assert_eq!(plain(&last), plain(&whole));
}
