//! `check --processes N`: the same report as one process, and an end when a process is lost.

use std::io::{BufRead, BufReader};
use std::process::{Child, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::command;

fn run(arguments: &[&str]) -> Output {
    command(arguments).output().expect("stillpoint runs")
}

/// Leaves out what differs from run to run.
fn without_effort(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            fields.retain(|name, _| {
                !matches!(
                    name.as_str(),
                    "seconds" | "memory" | "storage" | "bytes_per_state" | "states_per_second"
                )
            });
            fields.values_mut().for_each(without_effort);
        }
        Value::Array(items) => items.iter_mut().for_each(without_effort),
        _ => (),
    }
}

fn report(file: &str, more: &[&str]) -> (Option<i32>, Value) {
    let mut arguments = vec!["check", file, "--json"];
    arguments.extend(more);
    let output = run(&arguments);
    let text = String::from_utf8_lossy(&output.stdout);
    let mut json: Value = serde_json::from_str(&text).unwrap_or_else(|e| {
        let errors = String::from_utf8_lossy(&output.stderr);
        panic!("{arguments:?}: {e}\n{text}\n{errors}")
    });
    without_effort(&mut json);
    (output.status.code(), json)
}

fn same(file: &str, processes: &[&str]) -> Value {
    let alone = report(file, &[]);
    for number in processes {
        let shared = report(file, &["--processes", number]);
        assert_eq!(shared, alone, "{file} with {number} processes");
    }
    alone.1
}

#[test]
fn the_report_is_the_same_with_1_2_and_4_processes() {
    // Several systems in one file, all forms of properties with every verdict, pairs of runs, a fault.
    same("tests/certified/forms.toml", &["2", "4"]);
    // Its levels are wide, and there are a thousand of them.
    let yardstick = same("spec/bench/two-axis.toml", &["2"]);
    assert_eq!(yardstick["states"], 4_024_036);
    // Violated: the counterexamples are the same runs.
    let failing = same(
        "tests/must-fail/stop-b-without-timer.toml",
        &["1", "2", "4"],
    );
    assert!(failing.to_string().contains("violated"), "{failing}");
}

#[test]
#[ignore = "deep: a minute"]
fn the_report_of_an_axis_is_the_same_with_2_and_4_processes() {
    same("spec/families/sinumerik-840d/axis.toml", &["2", "4"]);
}

/// A process that is killed when the test ends.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits for the end, but not for ever.
fn end_of(child: &mut Child) -> Option<i32> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a status") {
            return status.code();
        }
        assert!(start.elapsed() < Duration::from_secs(60), "it hangs");
        thread::sleep(Duration::from_millis(20));
    }
}

/// A process that waits for others, and its address.
fn listening(
    file: &str,
    processes: &str,
) -> (Killed, BufReader<std::process::ChildStderr>, String) {
    let listen = ["--listen", "127.0.0.1:0", "--threads", "1", "--json"];
    let mut child = command(&["check", file, "--processes", processes])
        .args(listen)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("stillpoint runs");
    let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut line = String::new();
    errors.read_line(&mut line).expect("a line");
    let address = line.split_whitespace().nth(2).expect("an address");
    let address = address.to_owned();
    (Killed(child), errors, address)
}

fn joining(file: &str, address: &str) -> Killed {
    let child = command(&["check", file, "--join", address])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("stillpoint runs");
    Killed(child)
}

#[test]
fn a_killed_process_ends_the_others_with_an_error() {
    // Large enough that nobody is done when the process is killed.
    let file = "spec/bench/two-axis.toml";
    let (mut first, mut errors, address) = listening(file, "3");
    let mut victim = joining(file, &address);
    let mut third = joining(file, &address);
    errors.read_line(&mut String::new()).expect("all are there");
    thread::sleep(Duration::from_millis(300));
    assert!(
        first.0.try_wait().expect("a status").is_none(),
        "done already"
    );
    victim.0.kill().expect("killed");
    assert_eq!(end_of(&mut first.0), Some(2));
    assert_eq!(end_of(&mut third.0), Some(2));
    let said: Vec<String> = errors.lines().map_while(Result::ok).collect();
    let said = said.join("\n");
    assert!(
        said.contains("process") && said.contains("ended or cannot be reached"),
        "{said}"
    );
}

#[test]
fn process_0_killed_leaves_nobody_behind() {
    let file = "spec/bench/two-axis.toml";
    let (mut first, mut errors, address) = listening(file, "2");
    let mut second = joining(file, &address);
    errors.read_line(&mut String::new()).expect("all are there");
    thread::sleep(Duration::from_millis(300));
    first.0.kill().expect("killed");
    assert_eq!(end_of(&mut second.0), Some(2));
}

#[test]
fn mistakes_are_told() {
    let file = "tests/must-fail/ramp-limit-rises.toml";
    let (mut first, _errors, address) = listening(file, "2");
    let other = run(&[
        "check",
        "spec/families/sinumerik-840d/comparison.toml",
        "--join",
        &address,
    ]);
    assert_eq!(other.status.code(), Some(2));
    let said = String::from_utf8_lossy(&other.stderr);
    assert!(said.contains("give the same file"), "{said}");
    // The right one is still welcome.
    let mut second = joining(file, &address);
    assert_eq!(end_of(&mut second.0), Some(0));
    // Its property is violated, as it must be.
    assert_eq!(end_of(&mut first.0), Some(1));
    for wrong in [
        vec!["--processes", "0"],
        vec!["--listen", "127.0.0.1:0"],
        vec!["--processes", "2", "--listen", "nowhere"],
        vec!["--join", "nowhere"],
    ] {
        let mut arguments = vec!["check", file];
        arguments.extend(&wrong);
        assert_eq!(run(&arguments).status.code(), Some(2), "{wrong:?}");
    }
}
