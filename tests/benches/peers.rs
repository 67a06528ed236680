//! The explorer beside SPIN: wall times of both on the same systems in one run, and their ratios.
//!
//! `cargo bench -p stillpoint-tests --bench peers [-- ROUNDS [NAME]]`, 3 rounds by default; NAME is a part of the name of
//! the only systems that are timed. Each round runs every contestant once,
//! so that noise of the machine meets all of them. SPIN explores the exported model without judging anything (`-A`);
//! the explorer judges all properties. Without spin or gcc only the explorer is timed. Where SPIN has not ended after
//! a minute, and 40 times what the explorer takes, it is stopped.

use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use stillpoint_engine as engine;
use stillpoint_harness::export::promela::promela;
use stillpoint_harness::report::grouped;
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Limits, Options, Storage};
use stillpoint_tests::peer::{Folder, TRUE_TIMES, Values, load, system, tools};
use stillpoint_tests::root;

/// A system to time: its file, its name, what it stands for, and values.
const YARDSTICKS: [(&str, &str, &str, Values); 4] = [
    (
        "spec/bench/two-axis.toml",
        "bench/two-axis/two_axis",
        "dense",
        &[],
    ),
    (
        "spec/families/sinumerik-840d/faults.toml",
        "sinumerik-840d/faults/fault_selection",
        "sparse",
        &[],
    ),
    (
        "spec/families/sinumerik-840d/axis.toml",
        "sinumerik-840d/axis/stop_group",
        "coupled axes",
        &[],
    ),
    (
        "spec/families/sinumerik-840d/axis.toml",
        "sinumerik-840d/axis/stop_pair",
        "coupled channels, true times",
        TRUE_TIMES,
    ),
];

/// SPIN is stopped after so many times what the explorer takes, and this time.
const PATIENCE: u32 = 40;
const LEAST: Duration = Duration::from_secs(60);

/// A system whose exploration takes long enough to tell what a second thread gives.
const LONG: (&str, &str, usize) = (
    "spec/machines/milling-840d.toml",
    "sinumerik-840d/axis/stop",
    2,
);

/// The times of one contestant.
struct Times {
    name: String,
    seconds: Vec<f64>,
}

impl Times {
    fn sorted(&self) -> Vec<f64> {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    fn median(&self) -> f64 {
        let sorted = self.sorted();
        sorted[sorted.len() / 2]
    }
}

/// Runs each contestant once a round.
fn compete(rounds: usize, contestants: &[(&str, &dyn Fn())]) -> Vec<Times> {
    let mut times: Vec<Times> = contestants
        .iter()
        .map(|(name, _)| Times {
            name: (*name).to_owned(),
            seconds: Vec::new(),
        })
        .collect();
    for _ in 0..rounds {
        for ((_, run), times) in contestants.iter().zip(&mut times) {
            let start = Instant::now();
            run();
            times.seconds.push(start.elapsed().as_secs_f64());
        }
    }
    times
}

/// Prints times, and how many times faster each one is than the first one.
fn print(times: &[Times]) {
    for one in times {
        let sorted = one.sorted();
        println!(
            "  {:<34} {:>8.3} s   ({:.3} to {:.3})   ratio {:.2}",
            one.name,
            one.median(),
            sorted[0],
            sorted[sorted.len() - 1],
            times[0].median() / one.median()
        );
    }
}

fn options(threads: usize) -> Options {
    Options {
        limits: Limits {
            threads,
            ..Limits::default()
        },
        witnesses: false,
        ..Options::default()
    }
}

fn explore(bound: &Bound, threads: usize, interpret: bool) {
    let outcome = engine::run(bound, &options(threads), interpret, &mut ());
    assert!(outcome.is_ok_and(|o| o.report.complete));
}

/// Runs SPIN's verifier in a folder; false if it had to be stopped.
fn pan(folder: &Folder, most: Duration) -> bool {
    let mut child = Command::new(folder.file("pan"))
        .args(["-A", "-m1000000"])
        .current_dir(folder.file("."))
        .stdout(Stdio::null())
        .spawn()
        .expect("it runs");
    let end = Instant::now() + most;
    while Instant::now() < end {
        if let Some(status) = child.try_wait().expect("it runs") {
            assert!(status.success(), "{status}");
            return true;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let _ = child.kill();
    let _ = child.wait();
    false
}

fn main() {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let rounds = given.iter().find_map(|a| a.parse().ok()).unwrap_or(3);
    let named = |a: &&String| !a.starts_with('-') && a.parse::<usize>().is_err();
    let only = given.iter().find(named).map_or("", String::as_str);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    println!(
        "{rounds} rounds, {cores} processors; median (least to most); ratio: how many times faster than the first line"
    );
    let peers = tools(&["spin", "gcc"]);
    let timed = |(_, name, ..): &(&str, &str, &str, Values)| name.contains(only);
    for (file, name, kind, values) in YARDSTICKS.into_iter().filter(timed) {
        let bound = &system(file, name, values);
        let found = engine::run(bound, &options(0), false, &mut ());
        let report = found.unwrap_or_else(|e| panic!("{name}: {e}")).report;
        let most = LEAST.max(Duration::from_secs_f64(report.seconds) * PATIENCE);
        let bits = report.memory as f64 * 8.0 / report.index_space as f64;
        println!(
            "\n{name} ({kind}): {} states, {} transitions; {:.1} bytes a state{}",
            grouped(u128::from(report.states)),
            grouped(report.transitions),
            report.bytes_per_state(),
            match report.storage {
                Storage::Bitmap => format!(", {bits:.2} bits an index"),
                _ => String::new(),
            }
        );
        let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), kind);
        if peers {
            let model = promela(bound, name).unwrap_or_else(|e| panic!("{name}: {e}"));
            folder.write("model.pml", &model.text);
            folder.run("spin", &["-a", "model.pml"]);
            let gcc = "-O3 -w -DSAFETY -DNOREDUCE -DMEMLIM=8000 -o pan pan.c";
            folder.run("gcc", &gcc.split(' ').collect::<Vec<_>>());
        }
        let stopped = AtomicBool::new(false);
        let spin = || stopped.store(!pan(&folder, most), Ordering::Relaxed);
        let ours: [(&str, &dyn Fn()); 3] = [
            ("generated step, 2 threads", &|| explore(bound, 2, false)),
            ("generated step, 1 thread", &|| explore(bound, 1, false)),
            ("interpreter, 2 threads", &|| explore(bound, 2, true)),
        ];
        let mut all: Vec<(&str, &dyn Fn())> = Vec::new();
        if peers {
            all.push(("SPIN (-O3 -DSAFETY -DNOREDUCE)", &spin));
        }
        all.extend(ours);
        print(&compete(rounds, &all));
        if stopped.into_inner() {
            println!("  SPIN did not end: the ratios are the least that they can be");
        }
    }
    if LONG.1.contains(only) {
        threads(rounds);
    }
}

/// Times a longer exploration with one thread, with two, and twice at the same time.
fn threads(rounds: usize) {
    let (file, name, number) = LONG;
    let subject = load(&root().join(file));
    let mut tasks = subject.tasks.iter().filter(|t| t.bound.system.name == name);
    let task = tasks.nth(number);
    let task = task.unwrap_or_else(|| panic!("{file} has no such run of {name}"));
    println!("\n{name}, run {} of {file}: threads", number + 1);
    let twice = || {
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| explore(&task.bound, 1, false));
            }
        });
    };
    let times = compete(
        rounds,
        &[
            ("1 thread", &|| explore(&task.bound, 1, false)),
            ("2 threads", &|| explore(&task.bound, 2, false)),
            ("twice with 1 thread, side by side", &twice),
        ],
    );
    print(&times);
    println!(
        "  two explorations side by side, which share nothing, get {:.2} times as much done as one: what a second thread can give at most on this machine",
        2.0 * times[0].median() / times[2].median()
    );
}
