//! The status of a requirement by its evidence.

use super::*;

fn requirement(id: &str, kind: Kind, scope: Scope) -> Requirement {
    Requirement {
        id: id.to_owned(),
        family: "f".to_owned(),
        title: "<title>".to_owned(),
        text: String::new(),
        params: Vec::new(),
        source: String::new(),
        kind,
        scope,
        merged_into: None,
    }
}

fn named(id: &str, kind: EvidenceKind, place: &str) -> Named {
    let mut named = Named::new();
    read::add(&mut named, id, kind, place);
    named
}

fn exception(id: &str, reason: &str, test: Option<&str>) -> Exception {
    Exception {
        family: "f".to_owned(),
        id: id.to_owned(),
        reason: reason.to_owned(),
        test: test.map(str::to_owned),
    }
}

/// One core function with every evidence, so that a test can take one away.
fn full() -> Sources {
    let mut sources = Sources {
        rules: named("F-STOP-001", EvidenceKind::Rule, "stop.rise"),
        monitors: named("F-STOP-001", EvidenceKind::Item, "impl/src/stop.rs:1 next"),
        proofs: named("F-STOP-001", EvidenceKind::Clause, "stop_contract rises"),
        ..Sources::default()
    };
    sources
        .catalogue
        .requirements
        .push(requirement("F-STOP-001", Kind::Function, Scope::Core));
    sources
}

fn status(sources: &Sources) -> Status {
    Matrix::new(sources).rows[0].status()
}

/// A program that a manual prints is run by a test, not by a monitor; its lines alone are no evidence.
#[test]
fn printed_programs_need_a_test_and_no_monitor() {
    let program = named("F-STOP-001", EvidenceKind::Program, "tests/stop.stl:7");
    let tried = named("F-STOP-001", EvidenceKind::Test, "tests/stop.rs:1 stops");
    let read = || Sources {
        monitors: Named::new(),
        proofs: Named::new(),
        programs: program.clone(),
        tests: tried.clone(),
        ..full()
    };
    assert_eq!(status(&read()), Status::Covered);
    let untried = Sources {
        tests: Named::new(),
        ..read()
    };
    assert_eq!(status(&untried), Status::Open);
    let unprinted = Sources {
        programs: Named::new(),
        ..read()
    };
    assert_eq!(status(&unprinted), Status::Open);
}

/// What a program may say is settled where it is read: no monitor is asked for, but a test is. A rule of a table makes it a
/// matter of the monitors again.
#[test]
fn languages_need_no_monitor() {
    let language = named(
        "F-STOP-001",
        EvidenceKind::Language,
        "spec/logic/src/spf.rs:1 parse",
    );
    let read = || Sources {
        rules: Named::new(),
        monitors: Named::new(),
        languages: language.clone(),
        ..full()
    };
    assert_eq!(status(&read()), Status::Covered);
    assert_eq!(
        status(&Sources {
            proofs: Named::new(),
            ..read()
        }),
        Status::Open
    );
    assert_eq!(
        status(&Sources {
            rules: full().rules,
            ..read()
        }),
        Status::Open
    );
}

#[test]
fn every_kind_of_evidence_is_needed() {
    assert_eq!(status(&full()), Status::Covered);
    assert_eq!(
        status(&Sources {
            rules: Named::new(),
            ..full()
        }),
        Status::Open
    );
    assert_eq!(
        status(&Sources {
            monitors: Named::new(),
            ..full()
        }),
        Status::Open
    );
    assert_eq!(
        status(&Sources {
            proofs: Named::new(),
            ..full()
        }),
        Status::Open
    );
    let tested = Sources {
        proofs: Named::new(),
        tests: named("F-STOP-001", EvidenceKind::Test, "tests/stop.rs:1 rises"),
        ..full()
    };
    assert_eq!(status(&tested), Status::Covered);
}

#[test]
fn parameters_and_support_need_no_monitor() {
    let mut sources = Sources {
        monitors: Named::new(),
        ..full()
    };
    sources.catalogue.requirements[0].kind = Kind::Parameter;
    assert_eq!(status(&sources), Status::Covered);
    sources.catalogue.requirements[0].kind = Kind::Function;
    assert_eq!(status(&sources), Status::Open);
    sources.catalogue.requirements[0].scope = Scope::Support;
    assert_eq!(status(&sources), Status::Covered);
    sources.rules.clear();
    assert_eq!(status(&sources), Status::Open);
}

/// What a monitor does is specified by a table; an acceptance test that names it is not enough.
#[test]
fn acceptance_tests_specify_what_no_monitor_does() {
    let mut sources = Sources {
        rules: Named::new(),
        data: named("F-STOP-001", EvidenceKind::Acceptance, "STOP-{axis}"),
        ..full()
    };
    assert_eq!(status(&sources), Status::Open);
    sources.catalogue.requirements[0].scope = Scope::Support;
    assert_eq!(status(&sources), Status::Covered);
    assert_eq!(
        Matrix::new(&sources).rows[0].shown.rules,
        ["acceptance STOP-{axis}"]
    );
    sources.data = named("F-STOP-009", EvidenceKind::Acceptance, "STOP-{axis}");
    assert_eq!(Matrix::new(&sources).exit_status(), 1);
}

#[test]
fn exceptions_need_a_reason() {
    let mut sources = Sources {
        monitors: Named::new(),
        ..full()
    };
    sources
        .exceptions
        .push(exception("F-STOP-001", "because", None));
    let matrix = Matrix::new(&sources);
    assert_eq!(
        (
            matrix.rows[0].status(),
            matrix.rows[0].shown.reason.as_deref()
        ),
        (Status::Excepted, Some("because"))
    );
    sources.exceptions.clear();
    sources.catalogue.requirements[0].scope = Scope::Hardware;
    sources.rules.clear();
    assert_eq!(status(&sources), Status::Excepted);
    sources.catalogue.requirements[0].scope = Scope::Core;
    sources.catalogue.requirements[0].merged_into = Some("F-STOP-002".to_owned());
    assert_eq!(status(&sources), Status::Excepted);
    // Evidence counts more than an excuse.
    let mut sources = full();
    sources
        .exceptions
        .push(exception("F-STOP-001", "because", None));
    assert_eq!(status(&sources), Status::Covered);
}

#[test]
fn exit_status_tells_open_complete_families_and_unknown_ids() {
    assert_eq!(Matrix::new(&full()).exit_status(), 0);
    let mut open = Sources {
        monitors: Named::new(),
        ..full()
    };
    assert_eq!(Matrix::new(&open).exit_status(), 0, "not declared complete");
    open.complete.insert("f".to_owned());
    assert_eq!(Matrix::new(&open).exit_status(), 1);
    open.catalogue.requirements[0].scope = Scope::Support;
    assert_eq!(Matrix::new(&open).exit_status(), 0);
    for sources in [
        Sources {
            rules: named("F-STOP-009", EvidenceKind::Rule, "stop.rise"),
            ..full()
        },
        Sources {
            monitors: named("F-STOP-009", EvidenceKind::Item, "impl/src/stop.rs:1 next"),
            ..full()
        },
        Sources {
            exceptions: vec![exception("F-STOP-009", "x", None)],
            ..full()
        },
    ] {
        let matrix = Matrix::new(&sources);
        assert_eq!(
            (matrix.unknown[0].0.as_str(), matrix.exit_status()),
            ("F-STOP-009", 1)
        );
    }
}

#[test]
fn shown_in_all_formats() {
    let matrix = Matrix::new(&Sources {
        monitors: Named::new(),
        ..full()
    });
    assert!(text(&matrix).contains("F-STOP-001"));
    assert!(html(&matrix).contains("&lt;title&gt;"));
    let json = to_json(&matrix);
    let row = &json["requirements"][0];
    assert_eq!(
        (&row["status"], &row["rules"][0]),
        (&"open".into(), &"rule stop.rise".into())
    );
    for key in [
        "id",
        "family",
        "scope",
        "status",
        "rules",
        "monitors",
        "proofs",
        "tests",
        "reason",
        "sentences",
    ] {
        assert!(row.get(key).is_some(), "{key}");
    }
}

/// The evidence of [`full`] for one sentence in place of the requirement.
fn full_for(sources: &mut Sources, named: &str) {
    for part in [
        &mut sources.rules,
        &mut sources.monitors,
        &mut sources.proofs,
    ] {
        let evidence = part["F-STOP-001"].clone();
        part.insert(named.to_owned(), evidence);
    }
}

#[test]
fn a_requirement_with_sentences_is_covered_when_each_is() {
    let mut sources = full();
    let texts = [("a", "it rises"), ("b", "it ends")];
    sources.sentences.insert(
        "F-STOP-001".to_owned(),
        texts.map(|(k, t)| (k.to_owned(), t.to_owned())).into(),
    );
    // All the evidence names the id alone.
    assert_eq!(status(&sources), Status::Open);
    let matrix = Matrix::new(&sources);
    assert_eq!(matrix.rows[0].vague.len(), 3);
    assert!(text(&matrix).contains("a: rule, monitor, proof or test; b: rule"));
    full_for(&mut sources, "F-STOP-001/a");
    assert_eq!(status(&sources), Status::Open, "one sentence of two");
    let mut both = sources.clone();
    full_for(&mut both, "F-STOP-001/b");
    assert_eq!(status(&both), Status::Covered);
    // A reason for the other sentence is one for the requirement; evidence for a third leads nowhere.
    sources
        .exceptions
        .push(exception("F-STOP-001/b", "because", None));
    let matrix = Matrix::new(&sources);
    assert_eq!(
        (
            matrix.rows[0].status(),
            matrix.rows[0].shown.reason.as_deref()
        ),
        (Status::Excepted, Some("b: because"))
    );
    assert_eq!(matrix.exit_status(), 0);
    full_for(&mut sources, "F-STOP-001/c");
    assert_eq!(Matrix::new(&sources).exit_status(), 1);
    assert!(html(&Matrix::new(&both)).contains("F-STOP-001/b"));
    assert_eq!(
        to_json(&Matrix::new(&both))["requirements"][0]["sentences"][1]["text"],
        "it ends"
    );
}

#[test]
fn a_delegation_names_an_acceptance_test_that_asks_for_it() {
    let mut sources = Sources {
        monitors: Named::new(),
        exceptions: vec![exception("F-STOP-001", "only seen", Some("LOOK"))],
        ..full()
    };
    let nowhere = Matrix::new(&sources);
    assert_eq!(nowhere.rows[0].status(), Status::Delegated);
    assert_eq!(nowhere.exit_status(), 1, "no such test");
    assert!(text(&nowhere).contains("NOWHERE  F-STOP-001 is delegated to LOOK"));
    let key = ("f".to_owned(), "LOOK".to_owned());
    sources.acceptance.insert(key.clone(), BTreeSet::new());
    assert_eq!(Matrix::new(&sources).exit_status(), 1, "it names others");
    let named = BTreeSet::from(["F-STOP-001".to_owned()]);
    sources.acceptance.insert(key, named);
    let matrix = Matrix::new(&sources);
    assert_eq!(matrix.exit_status(), 0);
    assert_eq!(to_json(&matrix)["requirements"][0]["status"], "delegated");
}
