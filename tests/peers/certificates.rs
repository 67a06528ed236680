//! Certificates of whole checks: what `check --certificate` writes is confirmed, with the verdicts of the report.
//!
//! That nothing else is confirmed is the matter of `harness/certify/tests/forged.rs`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use stillpoint_certify::format::{Verdict, bodies, open};
use stillpoint_certify::{Confirmed, certify_bytes};
use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject;
use stillpoint_harness::certificate;
use stillpoint_tests::{files, root};

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
    let subject = subject::load(file, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads,
        ..Settings::default()
    };
    let checked = check(&subject, &settings, &mut |_| Box::new(()))
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

#[test]
fn a_limit_leaves_only_what_was_seen() {
    let subject = subject::load(&forms(), &BTreeMap::new()).expect("loads");
    let settings = Settings {
        time: Some(std::time::Duration::ZERO),
        ..Settings::default()
    };
    let checked = check(&subject, &settings, &mut |_| Box::new(())).expect("explored");
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
        check(&subject, &settings, &mut |_| Box::new(()))
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
