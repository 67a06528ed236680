//! The reaction times that the tables record: as found, guarded against change, and on finer grids of the monitoring cycle.

use std::collections::BTreeMap;

use stillpoint_engine as engine;
use stillpoint_engine::check::{Settings, check, exit_status, summarise, violations};
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Options, Verdict};
use stillpoint_tests::root;

const FILE: &str = "spec/families/sinumerik-840d/reaction.toml";

fn report(subject: &mut Subject) -> serde_json::Value {
    let settings = Settings {
        interpret: true,
        ..Settings::default()
    };
    let checked = check(subject, &settings, &mut |_| Box::new(())).expect("explored");
    let summaries = summarise(subject, &checked);
    stillpoint_harness::report::to_json(subject, &checked, &summaries)
}

#[test]
fn every_reaction_is_within_what_is_allowed() {
    let mut subject = subject::load(&root().join(FILE), &Readings::new()).expect("loads");
    let report = report(&mut subject);
    let rows = report["reactions"].as_array().expect("the table");
    assert!(rows.len() >= 20, "{rows:?}");
    for row in rows {
        let cycles = |key: &str| {
            row[key]
                .as_u64()
                .unwrap_or_else(|| panic!("{key} of {row}"))
        };
        assert_eq!(row["verdict"], "holds", "{row}");
        assert!(cycles("fastest") <= cycles("slowest"), "{row}");
        assert!(cycles("slowest") <= cycles("allowed"), "{row}");
        let requirements = row["requirements"].as_array().expect("a list");
        assert!(!requirements.is_empty(), "{row}");
    }
    let time = |id: &str| {
        let row = rows.iter().find(|r| r["id"] == id);
        let row = row.unwrap_or_else(|| panic!("no {id}"));
        row["slowest_us"].as_u64().expect("a time")
    };
    // In halves of a monitoring cycle of 12 ms: what the manual says of SBH, SE, SG.
    assert_eq!(time("S840D-TIMING-505-DETECTED"), 2 * 6000);
    assert_eq!(time("S840D-TIMING-505"), 4 * 6000);
    assert_eq!(time("S840D-TIMING-507"), 4 * 6000);
    assert_eq!(time("S840D-TIMING-506-DETECTED"), 3 * 6000);
    assert_eq!(time("S840D-TIMING-506"), 5 * 6000);
    // And what it does not say: a jump of the speed.
    assert!(time("S840D-TIMING-506-STEP-DETECTED") > 3 * 6000);
}

#[test]
fn the_times_hold_on_every_grid() {
    let spec = Spec::load(&root().join(FILE)).expect("loads");
    for system in ["position_phases", "speed_steady", "speed_step"] {
        for steps in 1..=8 {
            let given = BTreeMap::from([("steps".to_owned(), vec![steps])]);
            let resolved = spec.system(system, None).expect("resolves");
            let bound = Bound::new(resolved, &given, &BTreeMap::new()).expect("binds");
            let outcome = engine::run(&bound, &Options::default(), true, &mut ()).expect("runs");
            assert!(outcome.report.complete);
            for judged in &outcome.report.properties {
                assert_eq!(
                    judged.verdict,
                    Verdict::Holds,
                    "{} with {steps} steps: {:?}",
                    judged.id,
                    outcome.refuted
                );
            }
        }
    }
}

#[test]
fn a_bound_that_is_not_as_recorded_fails_the_check() {
    let text = std::fs::read_to_string(root().join(FILE)).expect("readable");
    let changes = [
        (
            "exactly  = \"t_d\"",
            "exactly  = \"t_d + 1\"",
            "the least bound recorded is 7 cycles, the one found is 6",
        ),
        (
            "fastest  = \"t_d\"",
            "fastest  = \"t_d + 1\"",
            "the fastest reaction recorded is 7 cycles, the one found is 6",
        ),
    ];
    for (was, is, message) in changes {
        let path = std::env::temp_dir().join(format!("reaction-{}.toml", std::process::id()));
        assert!(text.contains(was), "{was}");
        let mut changed = text.replacen(was, is, 1);
        for used in [
            "common",
            "external",
            "stop",
            "selection",
            "monitors",
            "ramp",
        ] {
            let place = root().join(format!("spec/families/sinumerik-840d/{used}.toml"));
            let place = place.canonicalize().expect("the file");
            changed = changed.replacen(
                &format!("\"{used}.toml\""),
                &format!("'{}'", place.display()),
                1,
            );
        }
        std::fs::write(&path, changed).expect("written");
        let subject = subject::load(&path, &Readings::new());
        std::fs::remove_file(&path).expect("removed");
        let mut subject = subject.expect("loads");
        let settings = Settings::default();
        let checked = check(&mut subject, &settings, &mut |_| Box::new(())).expect("explored");
        let summaries = summarise(&subject, &checked);
        assert_eq!(exit_status(&summaries, &checked), 1);
        let violations = violations(&subject, &checked);
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].id, "S840D-STOP-040-TIME");
        assert_eq!(violations[0].refuted, Some(message));
        let shown = stillpoint_harness::report::text(&subject, &checked, &summaries, true);
        assert!(shown.contains(message), "{shown}");
    }
}
