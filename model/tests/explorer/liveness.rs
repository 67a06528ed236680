//! Responses without a bound on systems whose answer is known by thought: nested conditions, several fairness conditions,
//! assumptions, runs that end, self loops, several initial states.

use crate::common::shown::check_trace;
use crate::common::{Table, replay};
use stillpoint_model::{Form, Judgement, Options, Property, Verdict, explore};

const ATOMS: usize = 6;
const WHEN: usize = 0;
const GOAL: usize = 1;
const A: usize = 2;
const B: usize = 3;
const C: usize = 4;
/// What is assumed.
const S: usize = 5;

fn response(fair: &[usize], assuming: Option<usize>) -> Form {
    Form::LeadsTo {
        when: WHEN,
        goal: GOAL,
        within: None,
        fair: fair.to_vec(),
        assuming,
    }
}

fn judge(system: &Table, form: Form) -> Judgement {
    let property = Property {
        id: "p".into(),
        form,
    };
    let options = Options::default();
    let report = explore(system, std::slice::from_ref(&property), &options, &mut ()).unwrap();
    assert!(report.complete);
    let judgement = report.properties[0].clone();
    if let Some(trace) = &judgement.trace {
        check_trace(system, &property.form, &judgement, trace, ATOMS);
    }
    judgement
}

/// The verdict, and for a violation the cycles before its loop and in it.
fn verdict(
    system: &Table,
    fair: &[usize],
    assuming: Option<usize>,
) -> (Verdict, Option<[usize; 2]>) {
    let judgement = judge(system, response(fair, assuming));
    let lasso = judgement
        .trace
        .filter(|_| judgement.verdict == Verdict::Violated);
    let shape = lasso.map(|t| {
        let start = t.loop_start.expect("a run forever");
        [start, t.steps.len() - start]
    });
    (judgement.verdict, shape)
}

const HOLDS: (Verdict, Option<[usize; 2]>) = (Verdict::Holds, None);

fn violated(before: usize, around: usize) -> (Verdict, Option<[usize; 2]>) {
    (Verdict::Violated, Some([before, around]))
}

#[test]
fn a_condition_inside_a_pending_duty_adds_no_duty_that_the_goal_does_not_end() {
    // Each cycle of the chain has the condition; the goal at its end ends all duties at once.
    let chain = Table::graph(&[&[(1, &[WHEN])], &[(2, &[WHEN])], &[(0, &[GOAL])]], ATOMS);
    assert_eq!(verdict(&chain, &[], None), HOLDS);
    // The condition again in every cycle of a loop: the first duty is never ended, and the shortest run has one cycle.
    let again = Table::graph(&[&[(0, &[WHEN]), (0, &[GOAL])]], ATOMS);
    assert_eq!(verdict(&again, &[], None), violated(1, 1));
    // A goal and a condition in one cycle: the cycle ends the old duty, and its own.
    let both = Table::graph(&[&[(1, &[WHEN])], &[(1, &[WHEN, GOAL])]], ATOMS);
    assert_eq!(verdict(&both, &[], None), HOLDS);
    // The goal ends the duty once; the loop after it has a condition of its own that nothing ends.
    let second = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(2, &[GOAL])],
            &[(3, &[WHEN])],
            &[(3, &[])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&second, &[], None), violated(3, 1));
}

#[test]
fn a_goal_in_the_cycle_of_the_condition_starts_no_duty() {
    // After the goal the system waits forever; without a pending duty that is no violation, fair or not.
    let system = Table::graph(&[&[(1, &[WHEN, GOAL])], &[(1, &[A])]], ATOMS);
    assert_eq!(verdict(&system, &[], None), HOLDS);
    assert_eq!(verdict(&system, &[A], None), HOLDS);
    // The same states with a second way into them that is not accompanied by the goal.
    let system = Table::graph(&[&[(1, &[WHEN, GOAL]), (1, &[WHEN])], &[(1, &[A])]], ATOMS);
    assert_eq!(verdict(&system, &[A], None), violated(1, 1));
    assert_eq!(verdict(&system, &[B], None), HOLDS);
}

#[test]
fn three_conditions_must_meet_in_one_component() {
    // A loop of three states has A, B and C on different cycles of it: one round meets all.
    let round = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(2, &[A])],
            &[(3, &[B])],
            &[(1, &[C]), (0, &[GOAL])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&round, &[A, B, C], None), violated(1, 3));
    // Any two of them meet in some component, all three nowhere.
    let pairs = Table::graph(
        &[
            &[(1, &[WHEN]), (2, &[WHEN]), (3, &[WHEN])],
            &[(1, &[A]), (1, &[B]), (2, &[C])],
            &[(2, &[B]), (2, &[C]), (3, &[A])],
            &[(3, &[A]), (3, &[C])],
        ],
        ATOMS,
    );
    for two in [[A, B], [B, C], [A, C]] {
        assert_eq!(verdict(&pairs, &two, None).0, Verdict::Violated, "{two:?}");
    }
    assert_eq!(verdict(&pairs, &[A, B, C], None), HOLDS);
    // The same components, but the last one leads back to the first: now they are one.
    let joined = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(1, &[A]), (2, &[])],
            &[(2, &[B]), (3, &[])],
            &[(3, &[C]), (1, &[])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&joined, &[A, B, C], None).0, Verdict::Violated);
}

#[test]
fn a_condition_met_only_on_the_way_or_only_with_the_goal_does_not_count() {
    // A on the way into the loop, and on the way from one loop to the next: finitely often.
    let way = Table::graph(
        &[&[(1, &[WHEN, A])], &[(1, &[]), (2, &[A])], &[(2, &[B])]],
        ATOMS,
    );
    assert_eq!(verdict(&way, &[A], None), HOLDS);
    assert_eq!(verdict(&way, &[B], None), violated(2, 1));
    // A in the goal's cycle alone: a run with A infinitely often has the goal.
    let with_goal = Table::graph(&[&[(1, &[WHEN])], &[(1, &[]), (0, &[GOAL, A])]], ATOMS);
    assert_eq!(verdict(&with_goal, &[A], None), HOLDS);
    assert_eq!(verdict(&with_goal, &[], None), violated(1, 1));
    // The fair loop lies behind a goal on every way to it.
    let behind = Table::graph(&[&[(1, &[WHEN])], &[(2, &[GOAL])], &[(2, &[A])]], ATOMS);
    assert_eq!(verdict(&behind, &[A], None), HOLDS);
}

#[test]
fn an_inner_loop_without_the_condition_does_not_hide_the_outer_one() {
    // 1 <-> 2 is an inner loop; the outer one goes round 1 -> 2 -> 3 -> 1 and has A on its last cycle.
    let nested = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(2, &[])],
            &[(1, &[]), (3, &[])],
            &[(1, &[A]), (0, &[GOAL])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&nested, &[A], None), violated(1, 3));
    assert_eq!(verdict(&nested, &[A, B], None), HOLDS);
    // The first component reached is cyclic but not fair, the one behind it is fair.
    let behind = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(2, &[])],
            &[(1, &[]), (3, &[])],
            &[(3, &[]), (4, &[])],
            &[(3, &[A])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&behind, &[A], None), violated(3, 2));
    // A diamond: both ways join before the fair loop, one of them through the goal.
    let diamond = Table::graph(
        &[
            &[(1, &[WHEN]), (2, &[WHEN])],
            &[(3, &[GOAL])],
            &[(3, &[])],
            &[(3, &[A])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&diamond, &[A], None), violated(2, 1));
}

#[test]
fn an_assumption_cuts_runs_apart() {
    // The loop 1 -> 2 -> 1 keeps the assumption on one of its cycles only: no run stays in it.
    let half = Table::graph(&[&[(1, &[WHEN])], &[(2, &[S])], &[(1, &[])]], ATOMS);
    assert_eq!(verdict(&half, &[], None), violated(1, 2));
    assert_eq!(verdict(&half, &[], Some(S)), HOLDS);
    // One component with A and B becomes two without the cycle that breaks the assumption.
    let split = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(1, &[A, S]), (2, &[S])],
            &[(2, &[B, S]), (1, &[])],
        ],
        ATOMS,
    );
    assert_eq!(verdict(&split, &[A, B], None).0, Verdict::Violated);
    assert_eq!(verdict(&split, &[A, B], Some(S)), HOLDS);
    assert_eq!(verdict(&split, &[A], Some(S)), violated(1, 1));
    assert_eq!(verdict(&split, &[B], Some(S)), violated(2, 1));
    // Also the way to the loop must keep it, but not the cycle of the condition.
    let gate = Table::graph(&[&[(1, &[WHEN])], &[(2, &[])], &[(2, &[S])]], ATOMS);
    assert_eq!(verdict(&gate, &[], Some(S)), HOLDS);
}

#[test]
fn runs_that_end_in_a_fault_are_no_infinite_runs() {
    // After the condition every cycle faults: no run goes on forever.
    let mut dead = Table::graph(&[&[(1, &[WHEN])], &[(2, &[])], &[(2, &[A])]], ATOMS);
    for choice in 0..dead.sizes[0] {
        let index = dead.index(1, [choice, 0, 0]);
        dead.next[index] = Err(4);
    }
    assert_eq!(verdict(&dead, &[], None), HOLDS);
    // One of two cycles faults: the other one waits forever.
    let mut waits = Table::graph(
        &[&[(1, &[WHEN])], &[(2, &[]), (1, &[A])], &[(0, &[])]],
        ATOMS,
    );
    let index = waits.index(1, [0, 0, 0]);
    waits.next[index] = Err(4);
    assert_eq!(verdict(&waits, &[A], None), violated(1, 1));
    assert_eq!(verdict(&waits, &[B], None), HOLDS);
    // A state without any successor is not recoverable, whatever its cycle would say.
    let recover = Form::CanAlwaysReach {
        goal: A,
        using: None,
    };
    let judged = judge(&dead, recover);
    assert_eq!(
        (judged.verdict, judged.length),
        (Verdict::Violated, Some(0))
    );
}

#[test]
fn self_loops() {
    // The only state: its loop is the condition, and the run.
    let one = Table::graph(&[&[(0, &[WHEN, A])]], ATOMS);
    assert_eq!(verdict(&one, &[A], None), violated(1, 1));
    assert_eq!(verdict(&one, &[B], None), HOLDS);
    // A state without a loop is a component, but no run stays in it.
    let pass = Table::graph(&[&[(1, &[WHEN])], &[(2, &[A])], &[(2, &[GOAL])]], ATOMS);
    assert_eq!(verdict(&pass, &[A], None), HOLDS);
    // Two self loops on one state under different inputs: each alone is unfair, taking turns is fair.
    let turns = Table::graph(
        &[&[(1, &[WHEN])], &[(1, &[A]), (1, &[B]), (1, &[GOAL, C])]],
        ATOMS,
    );
    assert_eq!(verdict(&turns, &[A, B], None), violated(1, 2));
    assert_eq!(verdict(&turns, &[A, C], None), HOLDS);
}

#[test]
fn two_initial_states() {
    let edges: &[&[(usize, &[usize])]] = &[
        &[(1, &[WHEN])],
        &[(1, &[GOAL])],
        &[(3, &[])],
        &[(4, &[WHEN])],
        &[(4, &[A])],
    ];
    // From the first one all is well, and nothing of the second one is reachable.
    let mut system = Table::graph(edges, ATOMS);
    assert_eq!(verdict(&system, &[A], None), HOLDS);
    // The violation starts in the second one, whichever is named first.
    for initial in [[0, 2], [2, 0]] {
        system.initial = initial.to_vec();
        assert_eq!(verdict(&system, &[A], None), violated(2, 1));
        let trace = judge(&system, response(&[A], None)).trace.unwrap();
        assert_eq!(Table::number(&replay(&system, &trace, 0)[0].before), 2);
    }
}
