//! Certificates of whole checks: what `check --certificate` writes is confirmed, with the verdicts of the report.
//!
//! That nothing else is confirmed is the matter of `harness/certify/tests/forged.rs`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use stillpoint_certify::format::{Verdict, bodies, open};
use stillpoint_certify::proof::format::text as proofs_text;
use stillpoint_certify::proof::read::read;
use stillpoint_certify::proof::ways::{Rank, Step};
use stillpoint_certify::{Confirmed, certify_bytes};
use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject;
use stillpoint_harness::certificate::{self, proofs};
use stillpoint_harness::proof::{self, Choice, Engine, Every, Judged, Which, judge, judge_every};
use stillpoint_lang::ir::Form;
use stillpoint_model::Verdict as Found;
use stillpoint_model::proof::Budget;
use stillpoint_tests::{files, root};

use super::reductions::random;

fn forms() -> PathBuf {
    root().join("tests/certified/forms.toml")
}

fn certified(bytes: &[u8]) -> Confirmed {
    certify_bytes(bytes, Some(&forms()), 1).unwrap_or_else(|e| panic!("{e}"))
}

/// A file of this test process.
fn scratch(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("stillpoint-certificates-{}", std::process::id()));
    std::fs::create_dir_all(&dir).expect("a folder");
    dir.join(name)
}

/// Checks a file and certifies the report; the certificate, and the verdicts of the report by system and property.
fn produce(file: &Path, threads: usize) -> (Vec<u8>, BTreeMap<(String, String), String>) {
    let mut subject = subject::load(file, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads,
        ..Settings::default()
    };
    let checked = check(&mut subject, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(title, e)| panic!("{title}: {e}"));
    let name = file
        .file_stem()
        .expect("a name")
        .to_string_lossy()
        .into_owned();
    let path = scratch(&format!(
        "{name}-{threads}-{:?}.cert",
        std::thread::current().id()
    ));
    certificate::certify(&path, &subject, &checked, threads, &|_, _| ())
        .unwrap_or_else(|e| panic!("{e}"));
    let mut verdicts = BTreeMap::new();
    for (task, done) in subject.tasks.iter().zip(&checked) {
        for judged in &done.outcome.report.properties {
            let key = (task.title.clone(), judged.id.clone());
            verdicts.insert(key, format!("{:?}", judged.verdict));
        }
    }
    let bytes = std::fs::read(&path).expect("the certificate");
    std::fs::remove_file(path).expect("removed");
    (bytes, verdicts)
}

#[test]
fn every_form_and_verdict_is_confirmed() {
    let (bytes, verdicts) = produce(&forms(), 2);
    assert_eq!(
        bytes,
        produce(&forms(), 1).0,
        "the threads show in the certificate"
    );
    let confirmed = certified(&bytes);
    let again = certify_bytes(&bytes, Some(&forms()), 3);
    assert_eq!(
        again.as_ref(),
        Ok(&confirmed),
        "the threads show in the result"
    );
    let mut kinds = BTreeSet::new();
    for task in &confirmed.header.task {
        for p in &task.property {
            let report = &verdicts[&(task.title.clone(), p.id.clone())];
            match p.id.as_str() {
                "RECORDED" => assert_eq!(p.verdict, Verdict::Open),
                id => assert_eq!(format!("{:?}", p.verdict), *report, "{id}"),
            }
            kinds.insert(format!("{:?}", p.verdict));
        }
    }
    assert_eq!(kinds.len(), 6, "a verdict is missing: {kinds:?}");
    let bound = |id| {
        let lamp = &confirmed.header.task[0].property;
        let place = lamp.iter().position(|p| p.id == id).expect("a property");
        confirmed.bounds[0][place]
    };
    assert_eq!((bound("BOUNDED"), bound("FAIR")), (Some(3), None));
    assert_eq!(confirmed.header.task[2].faults, ["counter.add: sum"]);
}

/// The certificate that the tests of the checker alter.
#[test]
fn the_stored_certificate_is_what_is_written_today() {
    let stored = std::fs::read(root().join("tests/certified/forms.cert")).expect("stored");
    let (bytes, _) = produce(&forms(), 1);
    let ((mut new, proofs), (old, stored)) = (
        open(&bytes).expect("readable"),
        open(&stored).expect("readable"),
    );
    new.subject.clone_from(&old.subject);
    assert_eq!(new, old, "write it anew with `check --certificate`");
    assert_eq!(bodies(&new, proofs), bodies(&old, stored));
}

#[test]
fn shipped_and_seeded_systems_are_certified_with_their_verdicts() {
    let mut subjects = files("tests/must-fail", "toml");
    for name in ["axis", "reaction"] {
        subjects.push(root().join(format!("spec/families/sinumerik-840d/{name}.toml")));
    }
    let (mut compared, mut violated) = (0, 0);
    for file in subjects {
        let (bytes, verdicts) = produce(&file, 2);
        let confirmed = certify_bytes(&bytes, Some(&file), 2)
            .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        for task in &confirmed.header.task {
            for p in &task.property {
                let report = &verdicts[&(task.title.clone(), p.id.clone())];
                assert_eq!(
                    format!("{:?}", p.verdict),
                    *report,
                    "{}: {}",
                    file.display(),
                    p.id
                );
                compared += 1;
                violated += usize::from(p.verdict == Verdict::Violated);
            }
        }
    }
    println!("{compared} verdicts certified, {violated} of them violations");
    assert!(compared > 120 && violated >= 15, "{compared}, {violated}");
}

/// Judges a file by the proof engines, with `every` for all values of all parameters; the certificate, and what was found.
fn prove(file: &Path, choice: Choice, every: bool) -> (String, Vec<Vec<Judged>>) {
    let subject = subject::load(file, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = proof::Settings {
        choice,
        depth: 30,
        ..proof::Settings::default()
    };
    let bounds = subject.tasks.iter().map(|task| &task.bound);
    let free: Option<Vec<Every>> = every.then(|| {
        let free = bounds.clone().map(|bound| Every::new(bound, &Which::All));
        free.map(|every| every.expect("free parameters")).collect()
    });
    let judged: Vec<Vec<Judged>> = match &free {
        Some(all) => all
            .iter()
            .map(|every| judge_every(every, &settings))
            .collect(),
        None => bounds.map(|bound| judge(bound, &settings)).collect(),
    };
    let path = scratch(&format!(
        "{choice:?}-{:?}.cert",
        std::thread::current().id()
    ));
    let found = proofs::Found {
        subject: &subject,
        every: free.as_deref(),
        judged: &judged,
    };
    proofs::certify(&path, &found, &Budget::default(), &|_, _| ())
        .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let text = std::fs::read_to_string(&path).expect("the certificate");
    std::fs::remove_file(path).expect("removed");
    (text, judged)
}

/// Proves a file and certifies what was found: every verdict of an engine is confirmed. How many, and how many by invariants.
fn confirm(file: &Path, choice: Choice, every: bool) -> (usize, usize) {
    let (text, judged) = prove(file, choice, every);
    let confirmed = certify_bytes(text.as_bytes(), Some(file), 1)
        .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let proved = confirmed.proved.expect("proofs");
    let (mut claims, mut invariants) = (0, 0);
    let tasks = confirmed.header.task.iter().zip(&proved).zip(&judged);
    let subject = subject::load(file, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
    for (((task, proved), judged), own) in tasks.zip(&subject.tasks) {
        for (k, judged) in judged.iter().enumerate() {
            // What k-induction shows of two runs has no certificate.
            let property = own.bound.system.properties.get(k);
            let of_two = property.is_some_and(|p| matches!(p.form, Form::Independent { .. }));
            let certified = match task.property.get(k) {
                Some(property) => property.verdict,
                None => proved.range.as_ref().map_or(Verdict::Open, |(v, _)| *v),
            };
            // A recorded bound that is not the one found, and what an engine leaves open, is not certified.
            let decided = !(of_two && judged.shown.is_none())
                && judged.verdict != Found::Inconclusive
                && !matches!(judged.engine, Some(Engine::Explorer | Engine::Bdd))
                && (judged.verdict != Found::Violated || judged.trace.is_some());
            let told = match decided {
                true => format!("{:?}", judged.verdict),
                false => "Open".to_owned(),
            };
            assert_eq!(
                format!("{certified:?}"),
                told,
                "{}: {}",
                file.display(),
                judged.id
            );
            claims += usize::from(decided);
            invariants += usize::from(decided && judged.shown.is_some());
        }
    }
    (claims, invariants)
}

/// The certificates that the tests of the checker alter.
#[test]
fn the_stored_certificates_of_the_engines_are_what_is_written_today() {
    for (of, name, choice, every) in [
        ("forms", "pdr", Choice::Pdr, false),
        ("forms", "kinduction", Choice::Induction, false),
        ("forms", "every", Choice::Pdr, true),
        ("times", "every", Choice::Pdr, true),
    ] {
        let file = |name: String| root().join("tests/certified").join(name);
        let path = file(format!("{of}-{name}.cert"));
        let stored = std::fs::read_to_string(path).expect("stored");
        let (text, _) = prove(&file(format!("{of}.toml")), choice, every);
        // The path of the subject stands in it, so the checksum may differ too.
        let rest = |text: &str| -> Vec<String> {
            let lines = text.lines();
            let lines = lines.filter(|l| !l.starts_with("subject = ") && !l.starts_with("sha256 "));
            lines.map(str::to_owned).collect()
        };
        assert_eq!(rest(&text), rest(&stored), "write {of}-{name}.cert anew");
    }
}

#[test]
fn what_the_engines_find_is_confirmed() {
    let mut subjects = files("tests/must-fail", "toml");
    subjects.push(root().join("spec/families/sinumerik-840d/axis.toml"));
    let (mut claims, mut invariants) = (0, 0);
    for file in subjects {
        let (c, i) = confirm(&file, Choice::Auto, false);
        (claims, invariants) = (claims + c, invariants + i);
    }
    println!("{claims} claims confirmed, {invariants} of them by invariants");
    assert!(claims > 60 && invariants > 30, "{claims} {invariants}");
}

/// Random systems, with all their parameters, by invariants and by k-induction.
#[test]
fn what_the_engines_find_about_random_systems_is_confirmed() {
    let mut sum = [(0, 0); 3];
    for seed in 0..40 {
        let path = scratch(&format!("random-{seed}.toml"));
        std::fs::write(&path, random::text(seed)).expect("written");
        for (k, (choice, every)) in [
            (Choice::Pdr, false),
            (Choice::Induction, false),
            (Choice::Pdr, true),
        ]
        .into_iter()
        .enumerate()
        {
            let (claims, invariants) = confirm(&path, choice, every);
            sum[k] = (sum[k].0 + claims, sum[k].1 + invariants);
        }
        std::fs::remove_file(path).expect("removed");
    }
    println!("claims, and those by invariants: {sum:?}");
    assert!(
        sum.iter()
            .all(|(claims, invariants)| *claims > 100 && *invariants > 30),
        "{sum:?}"
    );
}

#[test]
fn a_limit_leaves_only_what_was_seen() {
    let mut subject = subject::load(&forms(), &BTreeMap::new()).expect("loads");
    let settings = Settings {
        time: Some(std::time::Duration::ZERO),
        ..Settings::default()
    };
    let checked = check(&mut subject, &settings, &mut |_| Box::new(())).expect("explored");
    assert!(checked.iter().all(|c| !c.outcome.report.complete));
    let path = scratch("limit.cert");
    let written = certificate::certify(&path, &subject, &checked, 1, &|_, _| ()).expect("written");
    let confirmed = certified(&std::fs::read(&path).expect("there"));
    assert!(confirmed.header.task.iter().all(|t| t.states == 0));
    let properties = confirmed.header.task.iter().flat_map(|t| &t.property);
    let open = properties.filter(|p| p.verdict == Verdict::Open).count();
    assert_eq!(open, written.open);
    assert!(open > 15, "{open}");
}

/// The least time that `work` takes in three runs.
fn least(mut work: impl FnMut()) -> std::time::Duration {
    let times = (0..3).map(|_| {
        let start = std::time::Instant::now();
        work();
        start.elapsed()
    });
    times.min().unwrap_or_default()
}

#[test]
#[ignore = "deep: a ratio of times, for a machine that does nothing else"]
fn a_certificate_costs_at_most_twice_the_check() {
    let file = root().join("spec/families/sinumerik-840d/axis.toml");
    let subject = subject::load(&file, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads: 1,
        ..Settings::default()
    };
    let explored = || {
        check(&mut subject.clone(), &settings, &mut |_| Box::new(()))
            .unwrap_or_else(|(title, e)| panic!("{title}: {e}"))
    };
    let checked = explored();
    let path = scratch("cost.cert");
    let checking = least(|| drop(explored()));
    let writing = least(|| {
        certificate::certify(&path, &subject, &checked, 1, &|_, _| ())
            .unwrap_or_else(|e| panic!("{e}"));
    });
    std::fs::remove_file(path).expect("removed");
    let ratio = writing.as_secs_f64() / checking.as_secs_f64();
    eprintln!("check {checking:?}, certificate {writing:?}: {ratio:.2} times");
    assert!(ratio <= 2.0, "{writing:?} beside {checking:?}");
}

/// A timer of any length runs down in one region, and only because it falls.
const STOP: &str = r#"
spec = "stop"
[machine.stop]
text = "a stop that a reset ends when its time is over"
order = "priority"
[machine.stop.param]
limit = { type = "INT(0..1000)", default = 300 }
[machine.stop.input]
reset = "BOOL"
[machine.stop.state]
left = { type = "INT(0..1000)", init = 0 }
on   = { type = "BOOL", init = true }
[[machine.stop.rule]]
name = "waits"
note = "n"
when = "left > 0"
then = "left := left - 1;"
[[machine.stop.rule]]
name = "ends"
note = "n"
when = "TRUE"
then = "IF NOT on THEN on := TRUE; left := limit; ELSIF reset THEN on := FALSE; END_IF;"
[system.s]
text = "s"
[system.s.instance]
stop = { machine = "stop" }
[system.s.free]
ports = ["stop.reset"]
[[system.s.property]]
id = "BACK"
text = "p"
can_always_reach = "NOT stop.on"
"#;

#[test]
fn a_way_back_of_any_length_is_certified() {
    let path = scratch("stop.toml");
    std::fs::write(&path, STOP).expect("written");
    let (text, judged) = prove(&path, Choice::Pdr, true);
    assert_eq!(judged[0][0].verdict, Found::Holds);
    let file = read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let with = |change: &dyn Fn(&mut Step)| {
        let mut file = file.clone();
        let proof = file.systems[0].claims[0].proof.as_mut().expect("a proof");
        let mut ranked = proof.ways.iter_mut().filter(|step| step.rank.is_some());
        change(ranked.next().expect("a timer runs down"));
        let text = proofs_text(&file).expect("written");
        certify_bytes(text.as_bytes(), Some(&path), 1).map_err(|e| e.to_string())
    };
    assert!(with(&|_| ()).is_ok());
    let regions = text.lines().filter(|line| line.starts_with("region"));
    assert!(regions.count() < 6, "{text}");
    let ranked = |name: &str, rises| Rank {
        name: name.to_owned(),
        rises,
    };
    for other in [
        None,
        Some(("stop.left", true)),
        Some(("stop.on", false)),
        Some(("limit", false)),
    ] {
        let why = with(&|step| step.rank = other.map(|(name, rises)| ranked(name, rises)));
        let why = why.expect_err("it does not fall");
        assert!(
            why.contains("lead out of it") || why.contains("does not follow"),
            "{why}"
        );
    }
    std::fs::remove_file(path).expect("removed");
}
