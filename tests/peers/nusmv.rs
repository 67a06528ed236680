//! Exported systems in NuSMV and TLC: the same number of states, and the same verdict on each property of single cycles, also
//! where several of them fail in the same state.
//!
//! A user without these tools sees that the tests were skipped; where the environment has `CI`, they fail then.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use stillpoint_engine::subject::Subject;
use stillpoint_harness::export::murphi::murphi;
use stillpoint_harness::export::smv::smv;
use stillpoint_harness::export::tla::tla;
use stillpoint_lang::ir::Form;
use stillpoint_model::{Report, Verdict};
use stillpoint_tests::files;
use stillpoint_tests::peer::{Folder, each, explored, fetched, load, tools};

/// Systems with more transitions than this are left out: these tools go through a state, or a value, at a time.
const TRANSITIONS: u128 = 20_000;

/// Properties that fail in the first state, in every state, and together; witnesses that one initial state has and another
/// one has not.
const HIDING: &str = r#"
spec = "hiding"
title = "properties that could hide one another"
[machine.m]
text = "counts"
otherwise = "stay"
[machine.m.input]
up = "BOOL"
[machine.m.state]
n = { type = "INT(0..3)", init = "ANY" }
[[machine.m.rule]]
name = "up"
id = ["S840D-STOP-020"]
when = "up AND n > 0 AND n < 3"
then = "n := n + 1;"
[system.m]
text = "one"
[system.m.instance]
m = { machine = "m" }
[system.m.free]
ports = ["m.up"]
"#;

const PROPERTIES: [(&str, &str, &str); 7] = [
    ("A-1", "never", "m.n >= 0"),
    ("A-2", "never", "m.n < 4"),
    ("A-3", "always", "m.n < 3"),
    ("A-4", "always", "m.n <= 3"),
    ("A-5", "reachable", "m.n = 3 AND NOT m.up"),
    ("A-6", "reachable", "m.n > 3"),
    ("A-7", "never", "m.n = 2 AND m.up"),
];

/// What is expected: of each property that is exported whether it holds, or is reached.
fn expected(subject: &Subject, number: usize) -> (Report, BTreeMap<String, bool>) {
    let task = &subject.tasks[number];
    let report = explored(subject, task);
    let mut all = BTreeMap::new();
    for (property, judged) in task.bound.system.properties.iter().zip(&report.properties) {
        let good = match property.form {
            Form::Always { .. } => judged.verdict != Verdict::Violated,
            Form::Reachable { .. } => judged.verdict == Verdict::Reached,
            _ => continue,
        };
        all.insert(judged.id.clone(), good);
    }
    (report, all)
}

/// The id at the start of a property's statement; that of the property about ranges.
fn id(statement: &str) -> String {
    match statement {
        "no value leaves its range" => "range".to_owned(),
        other => other.split(": ").next().unwrap_or_default().to_owned(),
    }
}

/// The verdicts of NuSMV, and the number of states of the system.
fn nusmv(program: &Path, name: &str, model: &str) -> (BTreeMap<String, bool>, u128) {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), &format!("nusmv-{name}"));
    folder.write("model.smv", model);
    let mut script =
        "read_model -i model.smv\nflatten_hierarchy\nencode_variables\nbuild_model\n".to_owned();
    let mut named = BTreeMap::new();
    let lines: Vec<&str> = model.lines().collect();
    for (at, line) in lines.iter().enumerate() {
        let Some((spec, _)) = line
            .strip_prefix("INVARSPEC NAME ")
            .and_then(|l| l.split_once(" := "))
        else {
            continue;
        };
        let witness = spec.starts_with("never_");
        let statement = lines[at - 1 - usize::from(witness)].trim_start_matches("-- ");
        named.insert(spec.to_owned(), (id(statement), witness));
        script.push_str(&format!("echo == {spec}\ncheck_invar -P {spec}\n"));
    }
    script.push_str("print_reachable_states\nquit\n");
    folder.write("script", &script);
    let program = program.to_str().expect("UTF-8");
    let text = folder.findings(program, &["-dcx", "-source", "script"]);
    let mut verdicts = BTreeMap::new();
    for (spec, (id, witness)) in &named {
        let own = |part: &&str| part.lines().next().is_some_and(|l| l.trim() == spec);
        let part = text.split("== ").find(own).unwrap_or_default();
        let holds = match (part.contains("  is true"), part.contains("  is false")) {
            (true, false) => true,
            (false, true) => false,
            _ => panic!("{name}, {spec}: {text}"),
        };
        verdicts.insert(id.clone(), holds != *witness);
    }
    // Inputs are variables there, with any value in every state.
    let mut inputs: u128 = 1;
    for line in lines
        .iter()
        .filter(|l| l.starts_with("  in_") && l.contains(" : "))
    {
        let kind = line.split(" : ").nth(1).and_then(|k| k.split(';').next());
        inputs *= match kind.and_then(|k| k.split_once("..")) {
            Some((lo, hi)) => {
                (hi.parse::<i128>().expect("a number") - lo.parse::<i128>().expect("a number") + 1)
                    as u128
            }
            None => 2,
        };
    }
    let states = text
        .split("reachable states: ")
        .nth(1)
        .and_then(|t| t.split(' ').next());
    let states: f64 = states
        .and_then(|n| n.parse().ok())
        .unwrap_or_else(|| panic!("{name}: {text}"));
    (verdicts, states as u128 / inputs)
}

/// How TLC is asked for the properties of a system: it ends with the first one that is violated.
#[derive(Clone, Copy, PartialEq)]
enum Asked {
    /// Each with its own configuration, as a user would.
    Alone,
    /// All at once, and once more without each violated one: a start of the virtual machine takes longer than a small system.
    Together,
}

/// The verdicts of TLC, and the number of states where it has gone through all of them.
fn tlc(
    jar: &Path,
    name: &str,
    module: &stillpoint_harness::export::tla::Tla,
    asked: Asked,
) -> (BTreeMap<String, bool>, u128) {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), &format!("tlc-{name}"));
    folder.write("model.tla", &module.module);
    // A path may hold a colon, which separates the entries of a class path.
    folder.link(jar, "tla2tools.jar");
    // TLC names a folder in that of its files by the second, and refuses one that is there already.
    let runs = std::cell::Cell::new(0);
    let run = |config: &str| {
        runs.set(runs.get() + 1);
        let files = format!("meta-{}", runs.get());
        folder.write("one.cfg", config);
        let options = [
            "-XX:+UseSerialGC",
            "-XX:-UsePerfData",
            "-XX:TieredStopAtLevel=1",
            "-XX:CompressedClassSpaceSize=64m",
            "-XX:ReservedCodeCacheSize=64m",
            "-Xmx512m",
            "-Djava.io.tmpdir=.",
            "-cp",
            "tla2tools.jar",
            "tlc2.TLC",
            "-deadlock",
            "-workers",
            "1",
            "-metadir",
            &files,
            "-config",
            "one.cfg",
            "model",
        ];
        folder.findings("java", &options)
    };
    // A claim may come down to a constant.
    let violated = |text: &str, invariant: &str| {
        text.contains(&format!("Invariant {invariant} is violated"))
            || text.contains(&format!("The invariant of {invariant} is equal to FALSE"))
    };
    let complete = |text: &str| text.contains("Model checking completed. No error has been found.");
    let mut verdicts = BTreeMap::new();
    let mut judge = |invariant: &str, holds: bool| {
        let head = format!("\n{invariant} ==");
        let before = module.module.split(&head).next().unwrap_or_default();
        let statement = before
            .lines()
            .last()
            .unwrap_or_default()
            .trim_start_matches("\\* ");
        verdicts.insert(id(statement), holds != invariant.starts_with("never_"));
    };
    let mut open: Vec<&str> = module.single.iter().map(|(i, _)| i.as_str()).collect();
    if asked == Asked::Alone {
        for (invariant, config) in &module.single {
            let text = run(config);
            let broken = violated(&text, invariant);
            assert!(broken != complete(&text), "{name}, {invariant}: {text}");
            judge(invariant, !broken);
        }
        open.clear();
    }
    let text = loop {
        let all: String = open.iter().map(|i| format!("INVARIANT {i}\n")).collect();
        let text = run(&format!("SPECIFICATION Spec\nINVARIANT Types\n{all}"));
        let Some(at) = open.iter().position(|i| violated(&text, i)) else {
            assert!(open.is_empty() || complete(&text), "{name}: {text}");
            open.iter().for_each(|invariant| judge(invariant, true));
            break text;
        };
        judge(open.remove(at), false);
    };
    let states = text
        .split(" distinct states found")
        .next()
        .and_then(|t| t.rsplit(' ').next());
    let states = states.and_then(|n| n.replace(',', "").parse().ok());
    (verdicts, states.unwrap_or_else(|| panic!("{name}: {text}")))
}

/// Compares the systems of a file with what `judge` finds on them; the answer is how many, and the properties that are broken.
fn compare(
    path: &Path,
    judge: impl Fn(&Subject, usize, &str) -> (BTreeMap<String, bool>, u128),
) -> (usize, usize) {
    let subject = load(path);
    let stem = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let (mut compared, mut broken) = (0, 0);
    for number in 0..subject.tasks.len() {
        if subject.tasks[number].bound.combinations() > TRANSITIONS {
            continue;
        }
        let (report, mut all) = expected(&subject, number);
        if report.transitions > TRANSITIONS {
            continue;
        }
        let name = format!("{stem}-{number}");
        let (mut found, states) = judge(&subject, number, &name);
        if let Some(holds) = found.remove("range") {
            all.insert("range".to_owned(), report.faults.is_empty());
            found.insert("range".to_owned(), holds);
        }
        assert_eq!(found, all, "{name}: verdicts");
        assert_eq!(states, u128::from(report.states), "{name}: states");
        compared += 1;
        broken += all.values().filter(|good| !**good).count();
    }
    (compared, broken)
}

fn in_nusmv(program: &Path, paths: &[std::path::PathBuf]) -> (usize, usize) {
    let judge = |subject: &Subject, number: usize, name: &str| {
        let task = &subject.tasks[number];
        let model = smv(&task.bound, &task.title).unwrap_or_else(|e| panic!("{name}: {e}"));
        nusmv(program, name, &model)
    };
    let all = each(paths, |path| compare(path, judge));
    all.into_iter()
        .fold((0, 0), |(a, b), (c, d)| (a + c, b + d))
}

fn in_tlc(jar: &Path, paths: &[std::path::PathBuf], asked: Asked) -> (usize, usize) {
    let judge = |subject: &Subject, number: usize, name: &str| {
        let task = &subject.tasks[number];
        let made = tla(&task.bound, &task.title, "model").unwrap_or_else(|e| panic!("{name}: {e}"));
        tlc(jar, name, &made, asked)
    };
    let all = each(paths, |path| compare(path, judge));
    all.into_iter()
        .fold((0, 0), |(a, b), (c, d)| (a + c, b + d))
}

/// The file with [`HIDING`] and its properties.
fn hiding(folder: &Folder) -> std::path::PathBuf {
    let mut text = HIDING.to_owned();
    for (id, form, what) in PROPERTIES {
        text.push_str(&format!(
            "[[system.m.property]]\nid = \"{id}\"\ntext = \"{id}\"\n{form} = \"{what}\"\n"
        ));
    }
    folder.write("hiding.toml", &text);
    folder.file("hiding.toml")
}

#[test]
fn seeded_systems_in_nusmv() {
    let Some(program) = fetched("bin/NuSMV") else {
        return;
    };
    let (compared, broken) = in_nusmv(&program, &files("tests/must-fail", "toml"));
    assert!(
        compared >= 10 && broken >= 2,
        "{compared} seeded systems, {broken} properties broken"
    );
}

/// One in six: TLC begins anew for each.
#[test]
fn seeded_systems_in_tlc() {
    let files = files("tests/must-fail", "toml");
    seeded_in_tlc(&files.into_iter().step_by(6).collect::<Vec<_>>());
}

#[test]
#[ignore = "deep: minutes"]
fn every_seeded_system_in_tlc() {
    seeded_in_tlc(&files("tests/must-fail", "toml"));
}

fn seeded_in_tlc(files: &[PathBuf]) {
    let Some(jar) = fetched("tla2tools.jar").filter(|_| tools(&["java"])) else {
        return;
    };
    let (compared, broken) = in_tlc(&jar, files, Asked::Together);
    assert!(
        compared >= files.len() / 4 && broken >= 2,
        "{compared} seeded systems, {broken} properties broken"
    );
}

#[test]
fn no_property_hides_another_one_in_any_peer() {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), "hiding");
    let path = hiding(&folder);
    let subject = load(&path);
    let (report, all) = expected(&subject, 0);
    let good: Vec<bool> = all.values().copied().collect();
    assert_eq!(good, [false, false, false, true, true, false, false]);
    assert_eq!(report.states, 4);
    let task = &subject.tasks[0];
    if tools(&["rumur", "gcc"]) {
        let model = murphi(&task.bound, &task.title).expect("exported");
        let text = folder.rumur(&model, 1_000_000);
        for (id, good) in all
            .iter()
            .filter(|(id, _)| !["A-5", "A-6"].contains(&id.as_str()))
        {
            assert_eq!(text.contains(&format!(": {id}: ")), !good, "{id}: {text}");
        }
    }
    let paths = [path];
    if let Some(program) = fetched("bin/NuSMV") {
        assert_eq!(in_nusmv(&program, &paths), (1, 5));
    }
    if let Some(jar) = fetched("tla2tools.jar").filter(|_| tools(&["java"])) {
        assert_eq!(in_tlc(&jar, &paths, Asked::Alone), (1, 5));
    }
}
