//! What a run must show.

use super::{Cycle, Table, replay};
use stillpoint_model::{Form, Judgement, Trace, Verdict};

/// That a counterexample or witness shows what it claims.
pub fn check_trace(table: &Table, form: &Form, judgement: &Judgement, trace: &Trace, atoms: usize) {
    assert_eq!(judgement.length, Some(trace.steps.len() as u64));
    let cycles = replay(table, trace, atoms);
    assert!(cycles.iter().all(|c| c.after.is_ok()));
    let Some(last) = cycles.last() else {
        assert!(matches!(form, Form::CanAlwaysReach { .. }));
        return;
    };
    let violated = judgement.verdict == Verdict::Violated;
    match form {
        Form::Always { when, then } => {
            assert!(when.is_none_or(|w| last.atoms[w]));
            assert_eq!(last.atoms[*then], !violated);
        }
        Form::Reachable { goal } => assert!(last.atoms[*goal]),
        Form::CanAlwaysReach { .. } => (),
        Form::Unless { when, .. } | Form::LeadsTo { when, .. } if !violated => {
            assert!(last.atoms[*when])
        }
        Form::Unless {
            when,
            holds,
            unless,
        } => {
            assert!(!last.atoms[*unless] && !last.atoms[*holds]);
            let duty = |c: &Cycle| !c.atoms[*unless] && c.atoms[*holds];
            let begins =
                |k: usize| cycles[k].atoms[*when] && cycles[k..cycles.len() - 1].iter().all(duty);
            assert!((0..cycles.len()).any(begins));
        }
        Form::LeadsTo {
            when,
            goal,
            within,
            fair,
            assuming,
        } => {
            let pending = |c: &Cycle| !c.atoms[*goal] && assuming.is_none_or(|a| c.atoms[a]);
            let begins = |k: usize| {
                cycles[k].atoms[*when]
                    && !cycles[k].atoms[*goal]
                    && cycles[k + 1..].iter().all(pending)
            };
            if let Some(within) = within {
                assert!(begins(cycles.len() - 1 - *within as usize));
                return;
            }
            let start = trace.loop_start.expect("a run forever");
            assert!((0..start).any(begins));
            assert_eq!(cycles[start].before, *last.after.as_ref().unwrap());
            for atom in fair {
                assert!(cycles[start..].iter().any(|c| c.atoms[*atom]));
            }
        }
    }
}
