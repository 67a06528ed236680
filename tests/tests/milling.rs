//! The shipped machine file, checked as a user does: everything holds, and what never happens is explained.

use stillpoint::check::{Settings, Unfired, check, exit_status, summarise};
use stillpoint::subject::{self, Readings};
use stillpoint_model::Verdict;
use stillpoint_tests::root;

#[test]
fn the_milling_machine_keeps_every_property() {
    let path = root().join("spec/machines/milling-840d.toml");
    let subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let axes: Vec<&str> = subject
        .machine
        .iter()
        .flat_map(|m| m.axes.iter().map(|a| a.name.as_str()))
        .collect();
    assert_eq!(axes, ["X", "Y", "Z", "S"]);
    let checked = check(&subject, &Settings::default(), &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    assert!(checked.len() >= 10);
    for (task, done) in subject.tasks.iter().zip(&checked) {
        let report = &done.outcome.report;
        assert!(
            report.complete && report.faults.is_empty(),
            "{}: {:?}",
            task.title,
            report.faults
        );
        let unexplained: Vec<&str> = done
            .unfired
            .iter()
            .filter(|(_, why)| matches!(why, Unfired::Unexplained | Unfired::Unknown))
            .map(|(rule, _)| rule.as_str())
            .collect();
        assert!(
            unexplained.is_empty(),
            "{}: rules that never fire: {unexplained:?}",
            task.title
        );
    }
    let summaries = summarise(&subject, &checked);
    assert!(summaries.len() >= 30, "{}", summaries.len());
    for one in &summaries {
        assert!(
            matches!(one.verdict, Verdict::Holds | Verdict::Reached),
            "{}: {:?}",
            one.id,
            one.verdict
        );
        // What holds because of a premise was seen to have its premise fulfilled.
        assert!(
            one.length.is_some() || one.verdict == Verdict::Holds,
            "{}",
            one.id
        );
    }
    assert_eq!(exit_status(&summaries, &checked), 0);
}
