//! Random small systems: the explorer against the naive implementation, for every property form and storage.

use crate::common::naive::Naive;
use crate::common::shown::check_trace;
use crate::common::{Random, padding, random_table, replay};
use stillpoint_model::{Form, Limits, Options, Property, Report, Storage, explore};

const ATOMS: usize = 6;
const SYSTEMS: u64 = 4000;

fn forms(seed: u64) -> Vec<Property> {
    let mut random = Random(seed ^ 0xabcd_ef01);
    let mut any = || random.below(ATOMS);
    let forms = vec![
        Form::Always {
            when: None,
            then: any(),
        },
        Form::Always {
            when: Some(any()),
            then: any(),
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: Some(0),
            fair: vec![],
            assuming: None,
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: Some(2),
            fair: vec![],
            assuming: None,
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: Some(7),
            fair: vec![],
            assuming: Some(any()),
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: None,
            fair: vec![],
            assuming: None,
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: None,
            fair: vec![any()],
            assuming: None,
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: None,
            fair: vec![any(), any()],
            assuming: None,
        },
        Form::LeadsTo {
            when: any(),
            goal: any(),
            within: None,
            fair: vec![any(), any(), any()],
            assuming: Some(any()),
        },
        Form::Unless {
            when: any(),
            holds: any(),
            unless: any(),
        },
        Form::Unless {
            when: any(),
            holds: any(),
            unless: any(),
        },
        Form::CanAlwaysReach {
            goal: any(),
            using: None,
        },
        Form::CanAlwaysReach {
            goal: any(),
            using: Some(any()),
        },
        Form::Reachable { goal: any() },
    ];
    forms
        .into_iter()
        .enumerate()
        .map(|(n, form)| Property {
            id: format!("p{n}"),
            form,
        })
        .collect()
}

fn options(threads: usize) -> Options {
    Options {
        limits: Limits {
            threads,
            ..Limits::default()
        },
        ..Options::default()
    }
}

fn compare(seed: u64, padded: usize, storage: Storage) -> Report {
    let table = random_table(seed, ATOMS, padding(padded));
    let naive = Naive::new(&table);
    let properties = forms(seed);
    let report = explore(&table, &properties, &options(1), &mut ()).unwrap();
    let place = format!("seed {seed}");
    assert_eq!(report.storage, storage, "{place}");
    assert!(report.complete, "{place}");
    assert_eq!(report.states, naive.depth.len() as u64, "{place}");
    assert_eq!(report.transitions, naive.transitions, "{place}");
    assert_eq!(
        u64::from(report.depth),
        *naive.depth.values().max().unwrap(),
        "{place}"
    );
    assert_eq!(report.absorbing, naive.absorbing, "{place}");
    assert_eq!(
        report.absorbing_examples.len() as u64,
        naive.absorbing.min(8),
        "{place}"
    );
    for (state, count) in report.coverage.iter().enumerate() {
        let expected = naive.edges.iter().filter(|e| e.from == state).count() as u64;
        assert_eq!(*count, expected, "{place} coverage of {state}");
    }
    let faults: Vec<_> = report
        .faults
        .iter()
        .map(|f| (f.code, f.length.unwrap() - 1))
        .collect();
    assert_eq!(
        faults,
        naive.faults.into_iter().collect::<Vec<_>>(),
        "{place}"
    );
    for fault in &report.faults {
        let cycles = replay(&table, fault.trace.as_ref().unwrap(), 0);
        assert_eq!(
            cycles.last().unwrap().after.as_ref().unwrap_err().code,
            fault.code
        );
    }
    let naive = Naive::new(&table);
    for (property, judgement) in properties.iter().zip(&report.properties) {
        let answer = naive.judge(&property.form);
        let place = format!("seed {seed} {:?}", property.form);
        assert_eq!(judgement.verdict, answer.verdict, "{place}");
        assert_eq!(judgement.bound, answer.bound, "{place}");
        assert_eq!(judgement.fastest, answer.fastest, "{place}");
        if answer.length.is_some() {
            assert_eq!(judgement.length, answer.length, "{place}");
        }
        match &judgement.trace {
            Some(trace) => check_trace(&table, &property.form, judgement, trace, ATOMS),
            None => assert!(judgement.length.is_none(), "{place}"),
        }
    }
    report
}

#[test]
fn verdicts_agree_with_the_naive_implementation() {
    let mut seen = std::collections::BTreeMap::new();
    let mut fastest = [0; 4];
    for seed in 0..SYSTEMS {
        let report = compare(seed, 0, Storage::Bitmap);
        for (number, judgement) in report.properties.iter().enumerate() {
            *seen
                .entry((number, format!("{:?}", judgement.verdict)))
                .or_insert(0) += 1;
            if let Some(cycles) = judgement.fastest {
                fastest[cycles.min(3) as usize] += 1;
            }
        }
    }
    assert!(
        fastest.iter().all(|count| *count >= 20),
        "fastest reactions of 0, 1, 2 and more cycles: {fastest:?}"
    );
    // The sample is worth something: every form met each of its verdicts often.
    for number in 0..14 {
        let verdicts: &[&str] = match number {
            0 | 11 | 12 => &["Holds", "Violated"],
            13 => &["Reached", "Unreachable"],
            _ => &["Holds", "Violated", "Vacuous"],
        };
        for verdict in verdicts {
            let count = seen
                .get(&(number, (*verdict).to_string()))
                .copied()
                .unwrap_or(0);
            assert!(count >= 40, "form {number} {verdict}: {count} times only");
        }
    }
}

#[test]
fn hash_sets_agree_with_the_bitmap() {
    for seed in 0..400 {
        let mut reports: Vec<Report> = [
            (0, Storage::Bitmap),
            (1, Storage::Hash64),
            (3, Storage::Hash128),
        ]
        .into_iter()
        .map(|(padded, storage)| compare(seed, padded, storage))
        .collect();
        for report in &mut reports {
            report.seconds = 0.0;
            report.memory = 0;
            report.stored = 0;
            report.index_space = 0;
            report.storage = Storage::Bitmap;
            for state in &mut report.absorbing_examples {
                state.truncate(2);
            }
        }
        assert_eq!(reports[0], reports[1], "seed {seed}");
        assert_eq!(reports[0], reports[2], "seed {seed}");
    }
}
