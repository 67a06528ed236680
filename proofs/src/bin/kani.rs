//! Runs Kani over the harnesses and writes what it answered to `proofs/kani.toml`.
//!
//! * without arguments: every harness;
//! * with names of harnesses: those only; the other rows of the file are kept;
//! * `--within SECONDS`: the harnesses that held in the last run, the quickest first, as many as fit; nothing is written;
//! * `--log FILE`: no run, the answers of `FILE`, the output of such a run.
//!
//! The harnesses are shared out among as many runs of Kani as there are processors, each with a target folder of its own, by
//! the times of the last answers.
//!
//! `cargo kani` is looked for in the folders of the variable `KANI_PATH`, in `PATH`, and in [`HOME_FOLDER`] of the home
//! folder. Exit status: 0 if every harness that was run holds, 1 if one fails, is vacuous or, with `--within`, has no answer
//! in its time; 2 if nothing was run.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

use stillpoint_proofs::inventory::{self, Entry};
use stillpoint_proofs::results::{self, FILE, HOME_FOLDER, LIMIT_SECONDS, Results, Row, Verdict};

const USAGE: &str = "usage: kani [--within SECONDS | --log FILE | HARNESS...]";

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<bool, String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut file = Results::read()?;
    let start = Instant::now();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (log, writes) = match arguments.as_slice() {
        ["--log", path] => {
            let log = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
            (log, true)
        }
        ["--within", seconds] => {
            let seconds = seconds.parse().map_err(|_| USAGE.to_owned())?;
            (kani(&quickest(&file, seconds), &file)?, false)
        }
        names => {
            let known = |name: &&str| inventory::all().any(|entry| entry.id == *name);
            if let Some(unknown) = names.iter().find(|name| !known(name)) {
                return Err(format!("{unknown}: there is no such harness\n{USAGE}"));
            }
            let chosen = |entry: &&Entry| names.is_empty() || names.contains(&entry.id);
            let entries: Vec<_> = inventory::all().filter(chosen).collect();
            (kani(&entries, &file)?, true)
        }
    };
    let answers = results::answers(&log);
    if answers.is_empty() {
        return Err("no harness was run".to_owned());
    }
    let mut holds = true;
    let count = answers.len();
    let mut seconds = 0.0;
    for (id, mut answer) in answers {
        let Some(entry) = inventory::all().find(|entry| entry.id == id) else {
            // Harnesses outside the inventory: the broken monitors.
            continue;
        };
        // A run that was stopped between the parts of a harness has shown nothing of the others.
        let parts = results::parts(entry);
        if answer.parts != parts && !matches!(answer.verdict, Verdict::Fails(_)) {
            println!("{id}: only {} of {parts} parts have ended", answer.parts);
            holds = false;
            continue;
        }
        seconds += answer.seconds;
        holds &= match answer.verdict {
            Verdict::Holds => true,
            Verdict::NoAnswer => writes,
            Verdict::Fails(_) | Verdict::Vacuous => false,
        };
        if answer.verdict != Verdict::Holds {
            println!("{id}: {}", answer.verdict);
        }
        if answer.solver.is_empty() {
            results::solver(entry).clone_into(&mut answer.solver);
        }
        let row = Row {
            answer,
            sources: results::fingerprint(entry),
        };
        file.rows.insert(id, row);
    }
    println!(
        "{count} harnesses, {seconds:.0} s of verification; {:.0} s by the clock",
        start.elapsed().as_secs_f64()
    );
    if writes {
        if let Some(version) = log
            .lines()
            .find_map(|line| line.strip_prefix("Kani Rust Verifier "))
        {
            file.kani = version.split(' ').next().unwrap_or_default().to_owned();
        }
        file.cbmc = cbmc_version(&file.kani);
        std::fs::write(FILE, file.render()).map_err(|error| format!("{FILE}: {error}"))?;
    }
    Ok(holds)
}

/// What a harness costs beside its verification: linking and instrumentation.
const BESIDE: f64 = 1.0;

/// What a harness has cost in the last run, in seconds; without an answer half of what it may cost.
fn cost(file: &Results, entry: &Entry) -> f64 {
    let answer = file.rows.get(entry.id).map(|row| &row.answer);
    let seconds = answer.map_or(f64::from(LIMIT_SECONDS) / 2.0, |answer| answer.seconds);
    seconds + BESIDE * results::parts(entry) as f64
}

/// The harnesses that held, the quickest first, as many as take `seconds` together.
fn quickest(file: &Results, seconds: f64) -> Vec<&'static Entry> {
    let held = |entry: &&Entry| {
        let row = file.rows.get(entry.id);
        row.is_some_and(|row| row.answer.verdict == Verdict::Holds)
    };
    let mut held: Vec<_> = inventory::all().filter(held).collect();
    held.sort_by(|a, b| cost(file, a).total_cmp(&cost(file, b)));
    let mut sum = 0.0;
    let fits = held.into_iter().take_while(|entry| {
        sum += cost(file, entry);
        sum <= seconds
    });
    fits.collect()
}

/// The harnesses shared out, the slowest first, each to the share that has the least to do.
fn shares(entries: &[&'static Entry], file: &Results, count: usize) -> Vec<Vec<&'static Entry>> {
    let mut entries = entries.to_vec();
    entries.sort_by(|a, b| cost(file, b).total_cmp(&cost(file, a)));
    let mut shares = vec![(0.0_f64, Vec::new()); count.clamp(1, entries.len().max(1))];
    for entry in entries {
        let least = shares.iter_mut().min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((sum, share)) = least {
            *sum += cost(file, entry);
            share.push(entry);
        }
    }
    shares.into_iter().map(|(_, share)| share).collect()
}

/// The search path: `KANI_PATH`, then `PATH`, then the folder under the home folder.
fn search_path() -> OsString {
    let paths = ["KANI_PATH", "PATH"]
        .into_iter()
        .filter_map(std::env::var_os);
    let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(HOME_FOLDER));
    let folders = paths.flat_map(|path| std::env::split_paths(&path).collect::<Vec<PathBuf>>());
    std::env::join_paths(folders.chain(home)).unwrap_or_default()
}

/// Whether a line is shown: not the list of all checks, nor what CBMC says of its own steps.
fn is_shown(line: &str) -> bool {
    [
        "Checking harness ",
        "VERIFICATION:- ",
        "Verification Time: ",
        " ** ",
        "Failed Checks: ",
        "CBMC timed out",
        "error",
        "warning",
    ]
    .iter()
    .any(|beginning| line.starts_with(beginning))
}

/// Runs Kani over these harnesses, on all processors; the outputs one after the other, the answers of which are shown as
/// well.
fn kani(entries: &[&'static Entry], file: &Results) -> Result<String, String> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let shares = shares(entries, file, processors);
    std::thread::scope(|scope| {
        let mut runs = Vec::new();
        for (place, share) in shares.iter().enumerate() {
            runs.push(scope.spawn(move || kani_alone(place, share)));
        }
        let lost = |_| Err("a run of Kani was lost".to_owned());
        let logs = runs.into_iter().map(|run| run.join().unwrap_or_else(lost));
        logs.collect()
    })
}

/// One run of Kani over these harnesses, the one at this place among those that run at the same time; its output.
fn kani_alone(place: usize, entries: &[&Entry]) -> Result<String, String> {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let names: Vec<&str> = entries.iter().map(|entry| entry.id).collect();
    let mut command = Command::new("cargo");
    command
        .args(["kani", "-Z", "unstable-options"])
        .args(["--harness-timeout", &format!("{LIMIT_SECONDS}s")])
        .current_dir(&root)
        .env("PATH", search_path())
        // The others are not even compiled.
        .env("STILLPOINT_KANI", names.join(" "))
        .stdout(Stdio::piped());
    // Kani brings a compiler of its own; what `cargo run` has set for this program would lead it to another one.
    for variable in [
        "RUSTUP_TOOLCHAIN",
        "CARGO",
        "RUSTC",
        "RUSTDOC",
        "LD_LIBRARY_PATH",
    ] {
        command.env_remove(variable);
    }
    if place > 0 {
        // Two runs in one target folder would wait for each other, and take each other's programs away.
        let target = std::env::var_os("CARGO_TARGET_DIR");
        let target = target.map_or_else(|| root.join("target"), PathBuf::from);
        command
            .arg("--target-dir")
            .arg(target.join(format!("kani-{place}")));
    }
    for name in &names {
        command.args(["--harness", &format!("kani_harnesses::{name}::")]);
    }
    let failed = |error: std::io::Error| format!("cargo kani: {error}");
    let mut child = command.spawn().map_err(failed)?;
    let mut log = String::new();
    let output = child.stdout.take().map(BufReader::new);
    for line in output.into_iter().flat_map(BufRead::lines) {
        let line = line.map_err(failed)?;
        if is_shown(&line) {
            let _ = writeln!(std::io::stdout(), "{}: {line}", place + 1);
        }
        log.push_str(&line);
        log.push('\n');
    }
    child.wait().map_err(failed)?;
    Ok(log)
}

/// The version of CBMC: of the one in the search path, or of the one that Kani has brought along.
fn cbmc_version(kani: &str) -> String {
    let home = std::env::var_os("KANI_HOME")
        .map(PathBuf::from)
        .or_else(|| std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".kani")));
    let brought = home.map(|home| home.join(format!("kani-{kani}/bin/cbmc")));
    let candidates = brought
        .into_iter()
        .filter(|path| path.exists())
        .chain([PathBuf::from("cbmc")]);
    for program in candidates {
        let output = Command::new(program)
            .arg("--version")
            .env("PATH", search_path())
            .output();
        if let Ok(output) = output {
            let text = String::from_utf8_lossy(&output.stdout);
            if let Some(version) = text.split_whitespace().next() {
                return version.to_owned();
            }
        }
    }
    "unknown".to_owned()
}
