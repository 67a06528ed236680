//! Small systems whose answers are known by thought: cycles, joins, unfair loops, nested conditions.

use crate::common::{Table, replay};
use stillpoint_model::{Form, Judgement, Options, Property, Verdict, explore};

const WHEN: usize = 0;
const GOAL: usize = 1;
const FAIR: usize = 2;
const OTHER: usize = 3;

fn judge(system: &Table, form: Form) -> Judgement {
    let property = Property {
        id: "p".into(),
        form,
    };
    let report = explore(system, &[property], &Options::default(), &mut ()).unwrap();
    assert!(report.complete);
    report.properties[0].clone()
}

fn response(fair: &[usize], assuming: Option<usize>) -> Form {
    Form::LeadsTo {
        when: WHEN,
        goal: GOAL,
        within: None,
        fair: fair.to_vec(),
        assuming,
    }
}

fn within(bound: u32) -> Form {
    Form::LeadsTo {
        when: WHEN,
        goal: GOAL,
        within: Some(bound),
        fair: vec![],
        assuming: None,
    }
}

#[test]
fn a_loop_beside_the_goal_violates_until_fairness_forbids_it() {
    // 0 -when-> 1; 1 waits in 1, or reaches the goal to 0. Waiting is never fair.
    let system = Table::graph(&[&[(1, &[WHEN, FAIR])], &[(1, &[]), (0, &[GOAL, FAIR])]], 4);
    let unfair = judge(&system, response(&[], None));
    assert_eq!(
        (unfair.verdict, unfair.length),
        (Verdict::Violated, Some(2))
    );
    assert_eq!(unfair.trace.unwrap().loop_start, Some(1));
    assert_eq!(
        judge(&system, response(&[FAIR], None)).verdict,
        Verdict::Holds
    );
    let bounded = judge(&system, within(5));
    assert_eq!(
        (bounded.verdict, bounded.length, bounded.bound),
        (Verdict::Violated, Some(6), None)
    );
}

#[test]
fn fairness_needs_all_conditions_in_one_component() {
    // Two waiting loops, each fair to one condition; from the first to the second there is no way back.
    let system = Table::graph(
        &[&[(1, &[WHEN])], &[(1, &[FAIR]), (2, &[])], &[(2, &[OTHER])]],
        4,
    );
    assert_eq!(
        judge(&system, response(&[FAIR, OTHER], None)).verdict,
        Verdict::Holds
    );
    assert_eq!(
        judge(&system, response(&[FAIR], None)).verdict,
        Verdict::Violated
    );
    assert_eq!(
        judge(&system, response(&[OTHER], None)).verdict,
        Verdict::Violated
    );
    // With a way back one run goes round through both.
    let system = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(1, &[FAIR]), (2, &[])],
            &[(2, &[OTHER]), (1, &[])],
        ],
        4,
    );
    let both = judge(&system, response(&[FAIR, OTHER], None));
    assert_eq!(both.verdict, Verdict::Violated);
    let trace = both.trace.unwrap();
    let cycles = replay(&system, &trace, 4);
    let start = trace.loop_start.unwrap();
    assert!(
        cycles[start..].iter().any(|c| c.atoms[FAIR])
            && cycles[start..].iter().any(|c| c.atoms[OTHER])
    );
}

#[test]
fn cycles_of_one_pair_of_states_differ_by_their_statements() {
    // From 1 to 1 there are two cycles: a waiting one, and one that is fair but reaches the goal.
    let system = Table::graph(&[&[(1, &[WHEN])], &[(1, &[]), (1, &[FAIR, GOAL])]], 4);
    assert_eq!(
        judge(&system, response(&[FAIR], None)).verdict,
        Verdict::Holds
    );
    assert_eq!(
        judge(&system, response(&[], None)).verdict,
        Verdict::Violated
    );
    // Two waiting cycles, each with one of the conditions: together they are fair.
    let system = Table::graph(&[&[(1, &[WHEN])], &[(1, &[FAIR]), (1, &[OTHER])]], 4);
    assert_eq!(
        judge(&system, response(&[FAIR, OTHER], None)).verdict,
        Verdict::Violated
    );
}

#[test]
fn assumptions_cut_runs_only_after_the_start() {
    // The start itself does not satisfy the assumption; the waiting loop does, or not.
    let kept = Table::graph(&[&[(1, &[WHEN])], &[(1, &[OTHER]), (0, &[GOAL])]], 4);
    assert_eq!(
        judge(&kept, response(&[], Some(OTHER))).verdict,
        Verdict::Violated
    );
    let cut = Table::graph(
        &[&[(1, &[WHEN, OTHER])], &[(1, &[]), (0, &[GOAL, OTHER])]],
        4,
    );
    assert_eq!(
        judge(&cut, response(&[], Some(OTHER))).verdict,
        Verdict::Holds
    );
}

#[test]
fn a_join_of_a_short_and_a_long_way_has_the_long_bound() {
    // 0 -when-> 1 or 2; 1 -> 4 -goal-> 0; 2 -> 3 -> 4.
    let system = Table::graph(
        &[
            &[(1, &[WHEN]), (2, &[WHEN])],
            &[(4, &[])],
            &[(3, &[])],
            &[(4, &[])],
            &[(0, &[GOAL])],
        ],
        4,
    );
    let holds = judge(&system, within(3));
    assert_eq!(
        (holds.verdict, holds.bound, holds.length),
        (Verdict::Holds, Some(3), Some(1))
    );
    assert_eq!(holds.fastest, Some(2));
    let short = judge(&system, within(2));
    assert_eq!(
        (short.verdict, short.bound, short.length),
        (Verdict::Violated, Some(3), Some(3))
    );
    assert_eq!(judge(&system, response(&[], None)).verdict, Verdict::Holds);
}

#[test]
fn a_goal_in_the_cycle_of_the_condition_counts() {
    let system = Table::graph(&[&[(0, &[WHEN, GOAL])]], 4);
    let bounded = judge(&system, within(0));
    assert_eq!((bounded.verdict, bounded.bound), (Verdict::Holds, Some(0)));
    assert_eq!(bounded.fastest, Some(0));
    assert_eq!(judge(&system, response(&[], None)).verdict, Verdict::Holds);
}

#[test]
fn a_condition_repeated_under_a_pending_duty_does_not_postpone_it() {
    // `when` holds in each cycle of the chain 0 -> 1 -> 2 -> 3 -goal-> 0: the first one counts.
    let system = Table::graph(
        &[
            &[(1, &[WHEN])],
            &[(2, &[WHEN])],
            &[(3, &[WHEN])],
            &[(0, &[GOAL])],
        ],
        4,
    );
    assert_eq!(judge(&system, within(3)).bound, Some(3));
    assert_eq!(judge(&system, within(2)).verdict, Verdict::Violated);
}

#[test]
fn the_fastest_reaction_is_known_where_no_bound_holds() {
    // 0 -when-> 1; 1 waits forever, or goes 1 -> 2 -goal-> 0.
    let waits = Table::graph(
        &[&[(1, &[WHEN])], &[(1, &[]), (2, &[])], &[(0, &[GOAL])]],
        4,
    );
    let judged = judge(&waits, within(9));
    assert_eq!(
        (judged.verdict, judged.bound, judged.fastest),
        (Verdict::Violated, None, Some(2))
    );
    // A goal that no run reaches.
    let never = Table::graph(&[&[(1, &[WHEN])], &[(1, &[])]], 4);
    assert_eq!(judge(&never, within(9)).fastest, None);
    // The fastest and the slowest reaction start in different places.
    let two = Table::graph(
        &[
            &[(1, &[WHEN]), (3, &[WHEN])],
            &[(2, &[])],
            &[(0, &[GOAL])],
            &[(0, &[GOAL])],
        ],
        4,
    );
    let judged = judge(&two, within(2));
    assert_eq!((judged.bound, judged.fastest), (Some(2), Some(1)));
}

#[test]
fn recoverability_is_right_on_cycles() {
    // 1 and 2 form a cycle without exit; 0 reaches the goal.
    let trapped = Table::graph(&[&[(0, &[GOAL]), (1, &[])], &[(2, &[])], &[(1, &[])]], 4);
    let lost = judge(
        &trapped,
        Form::CanAlwaysReach {
            goal: GOAL,
            using: None,
        },
    );
    assert_eq!((lost.verdict, lost.length), (Verdict::Violated, Some(1)));
    // The same cycle with an exit.
    let free = Table::graph(
        &[
            &[(0, &[GOAL]), (1, &[])],
            &[(2, &[])],
            &[(1, &[]), (0, &[OTHER])],
        ],
        4,
    );
    assert_eq!(
        judge(
            &free,
            Form::CanAlwaysReach {
                goal: GOAL,
                using: None
            }
        )
        .verdict,
        Verdict::Holds
    );
    // Where only cycles with `OTHER` may be used, the way through 1 -> 2 is closed, and so is the goal itself.
    let using = judge(
        &free,
        Form::CanAlwaysReach {
            goal: GOAL,
            using: Some(OTHER),
        },
    );
    assert_eq!((using.verdict, using.length), (Verdict::Violated, Some(0)));
}

#[test]
fn weak_until() {
    let form = || Form::Unless {
        when: WHEN,
        holds: OTHER,
        unless: GOAL,
    };
    // Held forever, never released: weak until holds.
    let forever = Table::graph(&[&[(1, &[WHEN, OTHER])], &[(1, &[OTHER])]], 4);
    assert_eq!(judge(&forever, form()).verdict, Verdict::Holds);
    // Released at once by `unless` in the cycle of `when`.
    let released = Table::graph(&[&[(1, &[WHEN, GOAL])], &[(1, &[])]], 4);
    assert_eq!(judge(&released, form()).verdict, Verdict::Holds);
    // Dropped after two cycles.
    let dropped = Table::graph(&[&[(1, &[WHEN, OTHER])], &[(2, &[OTHER])], &[(2, &[])]], 4);
    let dropped = judge(&dropped, form());
    assert_eq!(
        (dropped.verdict, dropped.length),
        (Verdict::Violated, Some(3))
    );
    // The shortest violation starts at the later of two conditions: 0 -when-> 1 is long, 0 -> 5 -when-> 6 is short.
    let two = Table::graph(
        &[
            &[(1, &[WHEN, OTHER]), (5, &[])],
            &[(2, &[OTHER])],
            &[(3, &[OTHER])],
            &[(4, &[OTHER])],
            &[(4, &[])],
            &[(6, &[WHEN, OTHER])],
            &[(6, &[])],
        ],
        4,
    );
    let two = judge(&two, form());
    assert_eq!((two.verdict, two.length), (Verdict::Violated, Some(3)));
}

#[test]
fn vacuous_and_unreachable() {
    let system = Table::graph(&[&[(0, &[])], &[(0, &[WHEN, GOAL])]], 4);
    for form in [
        within(3),
        response(&[], None),
        Form::Always {
            when: Some(WHEN),
            then: GOAL,
        },
    ] {
        let judgement = judge(&system, form);
        assert_eq!(
            (judgement.verdict, judgement.trace),
            (Verdict::Vacuous, None)
        );
    }
    let unless = Form::Unless {
        when: WHEN,
        holds: OTHER,
        unless: GOAL,
    };
    assert_eq!(judge(&system, unless).verdict, Verdict::Vacuous);
    assert_eq!(
        judge(&system, Form::Reachable { goal: GOAL }).verdict,
        Verdict::Unreachable
    );
}

#[test]
fn properties_that_make_no_sense_are_refused() {
    let system = Table::graph(&[&[(0, &[])]], 40);
    let check = |form| {
        let property = Property {
            id: "P-1".into(),
            form,
        };
        explore(&system, &[property], &Options::default(), &mut ())
            .unwrap_err()
            .to_string()
    };
    let both = Form::LeadsTo {
        when: 0,
        goal: 1,
        within: Some(1),
        fair: vec![2],
        assuming: None,
    };
    assert!(check(both).contains("P-1"));
    assert!(check(response(&(0..32).collect::<Vec<_>>(), None)).contains("31"));
}
