//! Faults in atoms: reported with a run to them, and FALSE for the verdict.

use crate::common::{Frame, Table};
use stillpoint_model::{
    Choices, Domain, Fault, Form, Options, Property, Replay, Report, System, Verdict, explore,
};

/// A table whose atom 1 meets fault 5 in the cycle from state 2.
struct Faulty(Table);

const FROM: usize = 2;

impl System for Faulty {
    type Work = (Frame, bool);

    fn work(&self) -> Self::Work {
        (self.0.work(), false)
    }

    fn domains(&self) -> &[Domain] {
        self.0.domains()
    }

    fn combinations(&self) -> u128 {
        self.0.combinations()
    }

    fn initial<C: Choices>(&self, w: &mut Self::Work, c: &mut C, state: &mut [i32]) {
        self.0.initial(&mut w.0, c, state);
    }

    fn next<C: Choices>(
        &self,
        w: &mut Self::Work,
        before: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        w.1 = Table::number(before) == FROM;
        self.0.next(&mut w.0, before, c, after)
    }

    fn atom<C: Choices>(&self, w: &mut Self::Work, atom: usize, c: &mut C) -> Result<bool, Fault> {
        if atom == 1 && w.1 {
            return Err(Fault { code: 5 });
        }
        self.0.atom(&mut w.0, atom, c)
    }
}

fn run(form: Form, witnesses: bool) -> Report {
    // 0 -> 1 -> 2 -> 0; atom 0 marks the first cycle, atom 1 the one that never gets so far.
    let table = Table::graph(&[&[(1, &[0])], &[(2, &[])], &[(0, &[1])]], 2);
    let property = Property {
        id: "p".into(),
        form,
    };
    let options = Options {
        witnesses,
        ..Options::default()
    };
    explore(&Faulty(table), &[property], &options, &mut ()).unwrap()
}

fn check_fault(report: &Report) {
    let [fault] = &report.faults[..] else {
        panic!("{:?}", report.faults)
    };
    assert_eq!((fault.code, fault.length), (5, Some(3)));
    let system = Faulty(Table::graph(&[&[(1, &[0])], &[(2, &[])], &[(0, &[1])]], 2));
    let trace = fault.trace.as_ref().unwrap();
    let (mut work, mut state) = (system.work(), vec![0; 2]);
    system.initial(&mut work, &mut Replay::new(&trace.initial), &mut state);
    for step in &trace.steps {
        let before = state.clone();
        system
            .next(&mut work, &before, &mut Replay::new(step), &mut state)
            .unwrap();
    }
    let last = system.atom(&mut work, 1, &mut Replay::new(&trace.steps[2]));
    assert_eq!(last, Err(Fault { code: 5 }));
}

#[test]
fn a_fault_met_by_the_search() {
    let report = run(Form::Reachable { goal: 1 }, true);
    assert_eq!(report.properties[0].verdict, Verdict::Unreachable);
    check_fault(&report);
}

#[test]
fn a_fault_met_only_under_a_pending_duty() {
    let response = Form::LeadsTo {
        when: 0,
        goal: 1,
        within: None,
        fair: vec![],
        assuming: None,
    };
    let report = run(response, true);
    assert_eq!(report.properties[0].verdict, Verdict::Violated);
    check_fault(&report);
    let unless = run(
        Form::Unless {
            when: 0,
            holds: 0,
            unless: 1,
        },
        true,
    );
    assert_eq!(unless.properties[0].verdict, Verdict::Violated);
    assert_eq!(unless.properties[0].length, Some(2));
    assert!(unless.faults.is_empty());
}

#[test]
fn what_nothing_evaluates_meets_no_fault() {
    let report = run(
        Form::Always {
            when: Some(0),
            then: 0,
        },
        true,
    );
    assert_eq!(report.properties[0].verdict, Verdict::Holds);
    assert_eq!(report.properties[0].trace.as_ref().unwrap().steps.len(), 1);
    assert!(report.faults.is_empty());
}

#[test]
fn without_witnesses_their_length_is_told() {
    let report = run(
        Form::Always {
            when: Some(0),
            then: 0,
        },
        false,
    );
    assert_eq!(report.properties[0].verdict, Verdict::Holds);
    assert_eq!(
        (report.properties[0].length, &report.properties[0].trace),
        (Some(1), &None)
    );
}
