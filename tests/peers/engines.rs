//! The proof engines beside the explorer and ABC on the same systems in one run, as lines of a table.
//!
//! `cargo test --workspace --test peers -- --ignored --nocapture engines::table`. ABC (`berkeley-abc` of Debian) is given each `always`
//! property by itself, as AIGER; without it its column is empty. Wall seconds with one thread; each contestant ends after [`LIMIT`] for
//! each system.

use std::process::Command;
use std::time::{Duration, Instant};

use stillpoint_engine as engine;
use stillpoint_harness::export::aiger::aiger;
use stillpoint_harness::proof::{Choice, Every, Proof, Settings, Which, judge, judge_every};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_model::{Limits, Options, Verdict};
use stillpoint_tests::peer::{Folder, TRUE_TIMES, Values, system};

/// What a contestant may take for a system.
const LIMIT: Duration = Duration::from_secs(15);

/// File, system, what it stands for, values.
const SYSTEMS: [(&str, &str, &str, Values); 4] = [
    ("sinumerik-840d/axis", "stop", "default times", &[]),
    ("sinumerik-840d/axis", "stop", "true times", TRUE_TIMES),
    ("sinumerik-840d/axis", "stop_pair", "default times", &[]),
    ("sinumerik-840d/axis", "stop_pair", "true times", TRUE_TIMES),
];

#[test]
#[ignore = "deep: a table of times, for the book"]
fn table() {
    println!(
        "| system | latches / inputs / ANDs | explorer, states | engines | sets of states | ABC pdr | every configuration |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (file, name, what, values) in SYSTEMS {
        let whole = format!("{file}/{name}");
        let bound = system(&format!("spec/families/{file}.toml"), &whole, values);
        println!(
            "| {whole}, {what} | {} | {} | {} | {} | {} | {} |",
            size(&bound),
            explorer(&bound),
            engines(&bound),
            sets(&bound),
            abc(&bound),
            every(&bound)
        );
    }
}

fn size(bound: &Bound) -> String {
    let text = aiger(bound, "size", None, false).unwrap_or_else(|e| panic!("{e}"));
    let text = String::from_utf8_lossy(&text);
    let head: Vec<&str> = text.lines().next().unwrap_or_default().split(' ').collect();
    format!("{} / {} / {}", head[3], head[2], head[5])
}

fn seconds(begin: Instant) -> String {
    format!("{:.2} s", begin.elapsed().as_secs_f64())
}

fn explorer(bound: &Bound) -> String {
    let options = Options {
        limits: Limits {
            threads: 1,
            time: Some(LIMIT),
            ..Limits::default()
        },
        ..Options::default()
    };
    let begin = Instant::now();
    let report = match engine::run(bound, &options, false, &mut ()) {
        Ok(outcome) => outcome.report,
        Err(error) => return error.to_string(),
    };
    let end = if report.complete { "" } else { ", stopped" };
    format!("{}{end}, {}", seconds(begin), report.states)
}

fn settings() -> Settings {
    Settings {
        choice: Choice::Pdr,
        depth: 0,
        time: Some(LIMIT),
        each: None,
        memory: None,
        ..Settings::default()
    }
}

fn engines(bound: &Bound) -> String {
    let begin = Instant::now();
    told(begin, &judge(bound, &settings()))
}

/// What is decided by sets of states, and their number.
fn sets(bound: &Bound) -> String {
    let settings = Settings {
        choice: Choice::Bdd,
        ..settings()
    };
    let begin = Instant::now();
    let judged = judge(bound, &settings);
    let answer = told(begin, &judged);
    let counted = judged.iter().find(|one| one.id == "states");
    match counted.and_then(|one| one.proof.as_ref()) {
        Some(Proof::Reached {
            states: Some(states),
            ..
        }) => format!("{answer}, {states}"),
        _ => answer,
    }
}

fn every(bound: &Bound) -> String {
    match Every::new(bound, &Which::All) {
        Ok(every) => {
            let begin = Instant::now();
            told(begin, &judge_every(&every, &settings()))
        }
        Err(why) => why,
    }
}

fn told(begin: Instant, judged: &[stillpoint_harness::proof::Judged]) -> String {
    let open = judged.iter().filter(|j| j.verdict == Verdict::Inconclusive);
    let open = open.count();
    let decided = judged.len() - open;
    match open {
        0 => format!("{decided} in {}", seconds(begin)),
        _ => format!("{decided} in {}, {open} open", seconds(begin)),
    }
}

fn abc(bound: &Bound) -> String {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), "engines");
    let path = folder.file("model.aig");
    let begin = Instant::now();
    let (mut proved, mut asked) = (0, 0);
    for property in &bound.system.properties {
        if !matches!(property.form, Form::Always { .. }) {
            continue;
        }
        let id = engine::label(property);
        let Ok(model) = aiger(bound, "abc", Some(&id), true) else {
            continue;
        };
        if std::fs::write(&path, model).is_err() {
            return "-".to_owned();
        }
        let script = format!("read {}; fold; pdr -T 10", path.display());
        let Ok(output) = Command::new("berkeley-abc").args(["-c", &script]).output() else {
            return "-".to_owned();
        };
        asked += 1;
        proved += usize::from(String::from_utf8_lossy(&output.stdout).contains("Property proved"));
    }
    format!("{proved} of {asked} in {}", seconds(begin))
}
