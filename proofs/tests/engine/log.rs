use stillpoint_proofs::results::Verdict;
use stillpoint_proofs::results::log::answers;

#[test]
fn every_kind_of_answer_is_read() {
    let log = "\
Kani Rust Verifier 0.57.0 (cargo plugin)
Checking harness inventory::a::kani_harnesses::good::first...
Runtime Convert SSA: 0.5s
Solving with MiniSAT 2.2.1 with simplifier
Solving with MiniSAT 2.2.1 with simplifier

RESULTS:
Check 1: f.assertion.1
\t - Status: SUCCESS

SUMMARY:
 ** 0 of 100 failed

 ** 1 of 3 cover properties satisfied


VERIFICATION:- SUCCESSFUL
Verification Time: 1.25s

Checking harness inventory::a::kani_harnesses::good::second...

VERIFICATION RESULT:
 ** 0 of 222 failed (3 unreachable)

 ** 2 of 3 cover properties satisfied


VERIFICATION:- SUCCESSFUL
Verification Time: 2.25s

Checking harness inventory::a::kani_harnesses::late::whole...
Solving with External SAT solver

CBMC failed
VERIFICATION:- FAILED
CBMC timed out. You may want to rerun your proof with a larger timeout or use stubbing to reduce the size of the code the verifier reasons about.

Checking harness inventory::a::kani_harnesses::bad::whole...

VERIFICATION RESULT:
 ** 1 of 40 failed

 ** 0 of 3 cover properties satisfied

Failed Checks: stop_b_ends_in_time
 File: \"stop.rs\", line 1, in f

VERIFICATION:- FAILED
Verification Time: 0.5s

Checking harness inventory::a::kani_harnesses::empty::whole...

VERIFICATION RESULT:
 ** 0 of 7 failed

 ** 1 of 2 cover properties satisfied

VERIFICATION:- SUCCESSFUL
Verification Time: 0.5s

Checking harness inventory::a::kani_harnesses::unknown::whole...
warning: ignoring >=

VERIFICATION RESULT:
 ** 0 of 7 failed

 ** 2 of 2 cover properties satisfied

VERIFICATION:- SUCCESSFUL
Verification Time: 0.5s

Checking harness inventory::a::kani_harnesses::broken_off...
";
    let answers = answers(log);
    let seen = |name: &str| {
        answers
            .get(name)
            .map(|a| (&a.verdict, a.checks, a.met, a.covers))
    };
    assert_eq!(answers.len(), 5);
    assert_eq!(seen("good"), Some((&Verdict::Holds, 322, 3, 3)));
    assert_eq!(seen("late"), Some((&Verdict::NoAnswer, 0, 0, 0)));
    assert_eq!(answers["good"].solver, "minisat");
    assert_eq!(answers["late"].solver, "");
    let law = Verdict::Fails("stop_b_ends_in_time".to_owned());
    assert_eq!(seen("bad"), Some((&law, 40, 0, 3)));
    let ignored = Verdict::Fails("CBMC ignores >=".to_owned());
    assert_eq!(seen("unknown"), Some((&ignored, 7, 2, 2)));
    assert_eq!(seen("empty"), Some((&Verdict::Vacuous, 7, 1, 2)));
}
