//! `stillpoint trace` on this repository: the matrix is complete, consistent and what the documents promise.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use stillpoint::matrix::{Matrix, Status, find_root, read, text, to_json};
use stillpoint_spec::catalogue::{self, Scope};
use stillpoint_tests::root;

fn matrix() -> Matrix {
    Matrix::new(&read(&root()).unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn every_requirement_has_its_row_and_every_named_id_exists() {
    let matrix = matrix();
    let catalogue = catalogue::load(&root().join("spec")).unwrap_or_else(|e| panic!("{e}"));
    let listed: Vec<&str> = matrix
        .rows
        .iter()
        .map(|r| r.requirement.id.as_str())
        .collect();
    let wanted: Vec<&str> = catalogue
        .requirements
        .iter()
        .map(|r| r.id.as_str())
        .collect();
    assert_eq!(listed, wanted);
    assert_eq!(matrix.unknown, []);
    assert_eq!(matrix.exit_status(), 0);
}

#[test]
fn known_requirements_are_traced_through_every_stage() {
    let matrix = matrix();
    let row = |id: &str| {
        matrix
            .rows
            .iter()
            .find(|r| r.requirement.id == id)
            .unwrap_or_else(|| panic!("{id}"))
    };
    // The new gear stage that withdraws the user agreement, from the manual to the test.
    let gear = row("S840D-GEAR-505");
    assert_eq!(gear.status, Status::Covered);
    assert!(
        gear.rules.iter().any(|r| r == "gear.change"),
        "{:?}",
        gear.rules
    );
    assert!(
        gear.rules.iter().any(|r| r == "referencing.S840D-P-37"),
        "{:?}",
        gear.rules
    );
    assert!(
        gear.monitors
            .iter()
            .any(|m| m == "impl/src/sinumerik/gear.rs"),
        "{:?}",
        gear.monitors
    );
    assert!(
        gear.proofs.iter().any(|p| p == "gear_contract"),
        "{:?}",
        gear.proofs
    );
    assert!(
        gear.tests
            .iter()
            .any(|t| t == "tests/must-fail/agreement-kept-after-gear-change.toml"),
        "{:?}",
        gear.tests
    );
    // A parameter is carried by the family's data.
    assert!(
        row("S840D-PARAM-501")
            .rules
            .iter()
            .any(|r| r == "family.function.SBH/SG")
    );
    for row in &matrix.rows {
        if row.requirement.scope == Scope::Hardware {
            assert_ne!(row.status, Status::Open, "{}", row.requirement.id);
        }
        assert_eq!(
            row.reason.is_some(),
            row.status == Status::Excepted,
            "{}",
            row.requirement.id
        );
    }
}

/// The axis monitoring of the SINUMERIK family is complete: each core requirement of its catalogue is covered, or excepted
/// with a reason. The other catalogues of the family are not finished, so that its `status.toml` does not say so yet.
#[test]
fn no_core_requirement_of_the_axis_functions_is_open() {
    let path = root().join("spec/sinumerik-840d/requirements-functions.toml");
    let text = std::fs::read_to_string(&path).expect("the catalogue is part of the repository");
    let catalogue: toml::Table = text.parse().expect("the catalogue is TOML");
    let ids: BTreeSet<&str> = catalogue["requirement"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|r| r["id"].as_str())
        .collect();
    assert!(ids.len() > 280, "{} requirements", ids.len());
    let matrix = matrix();
    let open: Vec<&str> = matrix
        .open_core()
        .map(|row| row.requirement.id.as_str())
        .filter(|id| ids.contains(id))
        .collect();
    assert!(open.is_empty(), "open: {open:?}");
}

#[test]
fn json_and_text_agree() {
    let matrix = matrix();
    let json = to_json(&matrix);
    let rows = json["requirements"].as_array().expect("a list");
    assert_eq!(rows.len(), matrix.rows.len());
    let keys = [
        "family", "id", "monitors", "proofs", "reason", "rules", "scope", "status", "tests",
    ];
    let mut counted: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows {
        let object = row.as_object().expect("an object");
        assert_eq!(
            object.keys().map(String::as_str).collect::<BTreeSet<_>>(),
            BTreeSet::from(keys)
        );
        *counted
            .entry(row["status"].as_str().expect("a text"))
            .or_default() += 1;
    }
    assert_eq!(counted.values().sum::<usize>(), rows.len());
    assert!(counted["covered"] > 0 && counted["excepted"] > 0);
    let listed = text(&matrix);
    for row in matrix.open_core() {
        assert!(
            listed.contains(&format!("  {} ", row.requirement.id)),
            "{}",
            row.requirement.id
        );
    }
}

#[test]
fn the_root_is_found_from_below_and_must_have_the_monitors() {
    let expected = root().canonicalize().expect("the root");
    assert_eq!(find_root(&root().join("spec/machines")), Some(expected));
    assert_eq!(find_root(Path::new("/")), None);
    let error = read(&root().join("spec"))
        .expect_err("spec is no repository")
        .to_string();
    assert!(error.contains("has no folder spec"), "{error}");
}
