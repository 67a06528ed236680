//! The requirement matrix: for every requirement of the catalogues the rules, monitors, proofs and tests that name it.
//!
//! A requirement is **covered** when a rule, named expression or property of a specification table names it, and a
//! monitor does, and a proof or a test does. For a requirement that is not about the behaviour of a monitor the monitor is
//! not asked for: those of scope `support`, and of kind architecture, commissioning, constraint, diagnostic or parameter
//! (they are carried by the data of a family, by its plausibility rules and by the tools), and its acceptance tests and
//! reaction chains count as its specification. It is **excepted** when a reason
//! says why not: its scope is hardware, its content is carried by another requirement, or the family's `exceptions.toml`
//! gives one. All others are **open**. A covered requirement is never excepted, whatever the file says.
//!
//! A family may be declared complete in its `status.toml` (`family_complete = true`); then an open requirement of scope
//! `core` is an error of the project, and so is, in any family, an id that no catalogue has.

mod read;
mod show;

use std::collections::{BTreeMap, BTreeSet};

pub use read::{ReadError, find_root, read};
pub use show::{html, text, to_json};
use stillpoint_spec::catalogue::{Catalogue, Kind, Requirement, Scope};

/// For each requirement id the places that name it.
pub type Named = BTreeMap<String, BTreeSet<String>>;

/// What the matrix is made of.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// All requirements.
    pub catalogue: Catalogue,
    /// Rules, named expressions, properties and family data.
    pub rules: Named,
    /// Data that no monitor follows: acceptance tests and reaction chains.
    pub data: Named,
    /// Monitors, by their doc comments and contracts.
    pub monitors: Named,
    /// Proof harnesses, and the contracts they check.
    pub proofs: Named,
    /// Tests.
    pub tests: Named,
    /// Reasons of the families' files: (family, id, reason).
    pub exceptions: Vec<(String, String, String)>,
    /// Families declared complete.
    pub complete: BTreeSet<String>,
}

/// What is known of a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Specified, implemented and shown.
    Covered,
    /// Not, for a reason.
    Excepted,
    /// Not yet.
    Open,
}

impl Status {
    /// The name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Status::Covered => "covered",
            Status::Excepted => "excepted",
            Status::Open => "open",
        }
    }
}

/// A requirement with all that names it.
#[derive(Debug, Clone)]
pub struct Row {
    /// The requirement.
    pub requirement: Requirement,
    /// What is known.
    pub status: Status,
    /// Rules, named expressions, properties, family data.
    pub rules: Vec<String>,
    /// Monitors.
    pub monitors: Vec<String>,
    /// Proofs.
    pub proofs: Vec<String>,
    /// Tests.
    pub tests: Vec<String>,
    /// Why it is excepted.
    pub reason: Option<String>,
}

/// The matrix and what is wrong with it.
#[derive(Debug, Clone)]
pub struct Matrix {
    /// One row for each requirement, in the order of the catalogues.
    pub rows: Vec<Row>,
    /// Ids that no catalogue has: (id, the place that names it).
    pub unknown: Vec<(String, String)>,
    /// Families declared complete.
    pub complete: BTreeSet<String>,
}

impl Matrix {
    /// Puts the matrix together.
    pub fn new(sources: &Sources) -> Self {
        let exceptions: BTreeMap<&str, &str> = sources
            .exceptions
            .iter()
            .map(|(_, id, reason)| (id.as_str(), reason.as_str()))
            .collect();
        let rows: Vec<Row> = sources
            .catalogue
            .requirements
            .iter()
            .map(|r| row(sources, &exceptions, r))
            .collect();
        let known: BTreeSet<&str> = rows.iter().map(|r| r.requirement.id.as_str()).collect();
        let excepted = sources
            .exceptions
            .iter()
            .map(|(family, id, _)| (id, format!("{family}/exceptions.toml")));
        let unknown = [&sources.rules, &sources.data, &sources.monitors]
            .into_iter()
            .flatten()
            .flat_map(|(id, places)| places.iter().map(move |p| (id, p.clone())))
            .chain(excepted)
            .filter(|(id, _)| !known.contains(id.as_str()))
            .map(|(id, place)| (id.clone(), place))
            .collect();
        Self {
            rows,
            unknown,
            complete: sources.complete.clone(),
        }
    }

    /// The open requirements of scope core.
    pub fn open_core(&self) -> impl Iterator<Item = &Row> {
        self.rows
            .iter()
            .filter(|r| r.status == Status::Open && r.requirement.scope == Scope::Core)
    }

    /// Exit status: 1 if an id is unknown or a family declared complete has an open core requirement, else 0.
    pub fn exit_status(&self) -> u8 {
        let unfinished = self
            .open_core()
            .any(|r| self.complete.contains(&r.requirement.family));
        u8::from(unfinished || !self.unknown.is_empty())
    }
}

fn row(sources: &Sources, exceptions: &BTreeMap<&str, &str>, requirement: &Requirement) -> Row {
    let places = |named: &Named| -> Vec<String> {
        named
            .get(&requirement.id)
            .map(|p| p.iter().cloned().collect())
            .unwrap_or_default()
    };
    let (mut rules, data) = (places(&sources.rules), places(&sources.data));
    let (monitors, proofs) = (places(&sources.monitors), places(&sources.proofs));
    let tests = places(&sources.tests);
    let specified = !rules.is_empty() || (!data.is_empty() && !about_monitors(requirement));
    rules.extend(data);
    let covered = specified
        && (!monitors.is_empty() || !about_monitors(requirement))
        && (!proofs.is_empty() || !tests.is_empty());
    let reason = match (&requirement.merged_into, requirement.scope) {
        _ if covered => None,
        (Some(carrier), _) => Some(format!("its content is carried by {carrier}")),
        (None, Scope::Hardware) => {
            Some("a property of hardware: traced, never implemented here".to_owned())
        }
        _ => exceptions
            .get(requirement.id.as_str())
            .map(|r| (*r).to_owned()),
    };
    let status = match (covered, &reason) {
        (true, _) => Status::Covered,
        (false, Some(_)) => Status::Excepted,
        (false, None) => Status::Open,
    };
    Row {
        requirement: requirement.clone(),
        status,
        rules,
        monitors,
        proofs,
        tests,
        reason,
    }
}

/// Whether a requirement is about the behaviour of a monitor.
fn about_monitors(requirement: &Requirement) -> bool {
    let behaviour = match requirement.kind {
        Kind::Fault
        | Kind::Function
        | Kind::Interface
        | Kind::State
        | Kind::Test
        | Kind::Timing
        | Kind::Transition => true,
        Kind::Architecture
        | Kind::Commissioning
        | Kind::Constraint
        | Kind::Diagnostic
        | Kind::Parameter => false,
    };
    behaviour && requirement.scope == Scope::Core
}

/// The area of an id: `STOP` of `S840D-STOP-021`.
pub(crate) fn area(id: &str) -> &str {
    id.split('-').nth(1).unwrap_or("")
}

#[cfg(test)]
mod tests {
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

    fn named(id: &str, place: &str) -> Named {
        Named::from([(id.to_owned(), BTreeSet::from([place.to_owned()]))])
    }

    /// One core function with every evidence, so that a test can take one away.
    fn full() -> Sources {
        let mut sources = Sources {
            rules: named("F-STOP-001", "stop.rise"),
            monitors: named("F-STOP-001", "impl/src/stop.rs"),
            proofs: named("F-STOP-001", "proofs/src/stop.rs"),
            ..Sources::default()
        };
        sources
            .catalogue
            .requirements
            .push(requirement("F-STOP-001", Kind::Function, Scope::Core));
        sources
    }

    fn status(sources: &Sources) -> Status {
        Matrix::new(sources).rows[0].status
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
            tests: named("F-STOP-001", "tests/stop.rs"),
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
            data: named("F-STOP-001", "acceptance.STOP-{axis}"),
            ..full()
        };
        assert_eq!(status(&sources), Status::Open);
        sources.catalogue.requirements[0].scope = Scope::Support;
        assert_eq!(status(&sources), Status::Covered);
        assert_eq!(
            Matrix::new(&sources).rows[0].rules,
            ["acceptance.STOP-{axis}"]
        );
        sources.data = named("F-STOP-009", "acceptance.STOP-{axis}");
        assert_eq!(Matrix::new(&sources).exit_status(), 1);
    }

    #[test]
    fn exceptions_need_a_reason() {
        let mut sources = Sources {
            monitors: Named::new(),
            ..full()
        };
        sources.exceptions.push((
            "f".to_owned(),
            "F-STOP-001".to_owned(),
            "because".to_owned(),
        ));
        let matrix = Matrix::new(&sources);
        assert_eq!(
            (matrix.rows[0].status, matrix.rows[0].reason.as_deref()),
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
        sources.exceptions.push((
            "f".to_owned(),
            "F-STOP-001".to_owned(),
            "because".to_owned(),
        ));
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
                rules: named("F-STOP-009", "stop.rise"),
                ..full()
            },
            Sources {
                monitors: named("F-STOP-009", "impl/src/stop.rs"),
                ..full()
            },
            Sources {
                exceptions: vec![("f".to_owned(), "F-STOP-009".to_owned(), "x".to_owned())],
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
            (&"open".into(), &"stop.rise".into())
        );
        for key in [
            "id", "family", "scope", "status", "rules", "monitors", "proofs", "tests", "reason",
        ] {
            assert!(row.get(key).is_some(), "{key}");
        }
    }
}
