//! Larger random systems with many strongly connected components: responses under up to four fairness conditions, against
//! Emerson and Lei's fixpoint on the explicit graph.

use crate::common::large::large_table;
use crate::common::naive::Naive;
use crate::common::shown::check_trace;
use stillpoint_model::{Form, Options, Property, Verdict, explore};

const ATOMS: usize = 7;
const SYSTEMS: u64 = 600;
/// The atom that is assumed.
const STAYS: usize = ATOMS - 1;

fn forms() -> Vec<Form> {
    let mut forms = Vec::new();
    let sets: [&[usize]; 8] = [
        &[],
        &[2],
        &[3],
        &[4],
        &[2, 3],
        &[3, 4],
        &[2, 3, 4],
        &[2, 3, 4, 5],
    ];
    for fair in sets {
        for assuming in [None, Some(STAYS)] {
            forms.push(Form::LeadsTo {
                when: 0,
                goal: 1,
                within: None,
                fair: fair.to_vec(),
                assuming,
            });
        }
    }
    for using in [None, Some(STAYS), Some(5)] {
        forms.push(Form::CanAlwaysReach { goal: 1, using });
    }
    forms
}

#[test]
fn larger_graphs_agree_with_the_fixpoint() {
    let properties: Vec<Property> = forms()
        .into_iter()
        .enumerate()
        .map(|(n, form)| Property {
            id: format!("p{n}"),
            form,
        })
        .collect();
    let (mut saved, mut joint, mut cut, mut states) = (0, 0, 0, 0);
    for seed in 0..SYSTEMS {
        let table = large_table(seed, ATOMS);
        let naive = Naive::new(&table);
        let report = explore(&table, &properties, &Options::default(), &mut ()).unwrap();
        assert_eq!(report.states, naive.depth.len() as u64, "seed {seed}");
        states = states.max(report.states);
        for (property, judgement) in properties.iter().zip(&report.properties) {
            let place = format!("seed {seed} {:?}", property.form);
            let answer = naive.judge(&property.form);
            assert_eq!(judgement.verdict, answer.verdict, "{place}");
            if answer.length.is_some() {
                assert_eq!(judgement.length, answer.length, "{place}");
            }
            if let Some(trace) = &judgement.trace {
                check_trace(&table, &property.form, judgement, trace, ATOMS);
            }
        }
        let violated = |n: usize| report.properties[n].verdict == Verdict::Violated;
        let holds = |n: usize| report.properties[n].verdict == Verdict::Holds;
        saved += u32::from(violated(0) && holds(2));
        // Each condition alone leaves a violation, both together leave none.
        joint += u32::from(violated(2) && violated(4) && holds(8));
        cut += u32::from(violated(8) && holds(9));
    }
    // The sample is worth something.
    assert!(states > 50, "the largest system has {states} states only");
    assert!(saved >= 20, "one condition decides {saved} times only");
    assert!(
        joint >= 20,
        "two conditions decide together {joint} times only"
    );
    assert!(cut >= 20, "the assumption decides {cut} times only");
}
