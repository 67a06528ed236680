//! The yardstick `two-axis`: the counts that SPIN and rumur agree on, whatever the evaluator and the number of threads.

use stillpoint_engine::Evaluator;
use stillpoint_engine::check::{Settings, check, summarise};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::report::to_json;
use stillpoint_model::{Report, Storage};
use stillpoint_tests::root;

/// The report without what differs from run to run.
fn run(threads: usize, interpret: bool) -> (Report, Evaluator) {
    let path = root().join("spec/bench/two-axis.toml");
    let mut subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads,
        interpret,
        ..Settings::default()
    };
    let mut checked = check(&mut subject, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let json = to_json(&subject, &checked, &summarise(&subject, &checked));
    assert_eq!(json["states"], 4_024_036);
    assert_eq!(json["transitions"], 193_153_728);
    assert_eq!(json["complete"], true);
    assert_eq!(json["depth"], checked[0].outcome.report.depth);
    assert_eq!(checked.len(), 1);
    let outcome = checked.remove(0).outcome;
    let mut report = outcome.report;
    println!(
        "{threads} threads, interpreter {interpret}: {:.1} s",
        report.seconds
    );
    report.seconds = 0.0;
    report.memory = 0;
    report.stored = 0;
    (report, outcome.evaluator)
}

#[test]
fn counts_do_not_depend_on_threads_or_evaluator() {
    let (one, evaluator) = run(1, false);
    assert_eq!(evaluator, Evaluator::Generated);
    assert_eq!(
        (one.states, one.transitions, one.complete),
        (4_024_036, 193_153_728, true)
    );
    assert_eq!(one.storage, Storage::Bitmap);
    assert!(
        one.faults.is_empty() && one.coverage.iter().all(|n| *n > 0),
        "{:?}",
        one.coverage
    );
    let (two, _) = run(2, false);
    assert_eq!(one, two);
    // The same states, transitions and firings of each rule: the stepwise comparison of the evaluators leaves this
    // system out for its size.
    let (interpreted, evaluator) = run(2, true);
    assert_eq!(evaluator, Evaluator::Interpreter);
    assert_eq!(one, interpreted);
}
