//! Systems with wide levels: the yardstick's counts, the same report for any number of threads and storage, limits.

use crate::common::yardstick::{TwoAxis, Watched};
use crate::common::{padding, replay};
use std::collections::{BTreeSet, VecDeque};
use std::time::{Duration, Instant};
use stillpoint_model::{
    Choices, Domain, Error, Fault, Form, Limits, Options, Progress, Property, Report, Storage,
    System, Verdict, explore, reachable,
};

fn options(threads: usize) -> Options {
    Options {
        limits: Limits {
            threads,
            ..Limits::default()
        },
        ..Options::default()
    }
}

#[test]
fn the_yardstick_has_its_counts() {
    let report = explore(&TwoAxis::new(500), &[], &options(2), &mut ()).unwrap();
    assert_eq!(
        (report.states, report.transitions),
        (4_024_036, 193_153_728)
    );
    assert!(report.complete);
    assert_eq!(report.storage, Storage::Bitmap);
    assert!(
        report.memory * 8 <= 2 * 3507 * 3507 + 8 * (1 << 18),
        "{} bytes",
        report.memory
    );
    // The only absorbing state: both axes with pulses off.
    assert_eq!(
        (report.absorbing, report.absorbing_examples),
        (1, vec![vec![6, 0, 6, 0]])
    );
}

fn properties() -> Vec<Property> {
    let response = |within, fair: &[usize]| Form::LeadsTo {
        when: 0,
        goal: 1,
        within,
        fair: fair.to_vec(),
        assuming: None,
    };
    let forms = vec![
        Form::Always {
            when: None,
            then: 6,
        },
        Form::Always {
            when: Some(0),
            then: 4,
        },
        Form::Always {
            when: Some(6),
            then: 5,
        },
        response(Some(10), &[]),
        response(None, &[]),
        response(None, &[2]),
        Form::Unless {
            when: 0,
            holds: 4,
            unless: 1,
        },
        Form::Unless {
            when: 4,
            holds: 4,
            unless: 6,
        },
        Form::CanAlwaysReach {
            goal: 3,
            using: None,
        },
        Form::CanAlwaysReach {
            goal: 3,
            using: Some(2),
        },
        Form::CanAlwaysReach {
            goal: 5,
            using: None,
        },
        Form::Reachable { goal: 5 },
    ];
    forms
        .into_iter()
        .enumerate()
        .map(|(n, form)| Property {
            id: n.to_string(),
            form,
        })
        .collect()
}

#[test]
fn the_report_does_not_depend_on_threads_or_storage() {
    let mut reports = Vec::new();
    for (padded, storage) in [
        (0, Storage::Bitmap),
        (1, Storage::Hash64),
        (3, Storage::Hash128),
    ] {
        let system = Watched::new(60, padding(padded));
        for threads in [1, 2, 5] {
            let report = explore(&system, &properties(), &options(threads), &mut ()).unwrap();
            assert_eq!(report.storage, storage);
            let example: Vec<i32> = report.absorbing_examples[0][..4].to_vec();
            assert_eq!((report.absorbing, example), (1, vec![6, 0, 6, 0]));
            reports.push(Report {
                seconds: 0.0,
                memory: 0,
                stored: 0,
                index_space: 0,
                storage: Storage::Bitmap,
                absorbing_examples: vec![],
                ..report
            });
        }
    }
    for report in &reports[1..] {
        assert_eq!(&reports[0], report);
    }
    let verdicts: Vec<_> = reports[0].properties.iter().map(|p| p.verdict).collect();
    use Verdict::{Holds, Reached, Violated};
    assert_eq!(
        verdicts,
        [
            Violated, Holds, Violated, Violated, Violated, Holds, Holds, Violated, Holds, Violated,
            Violated, Reached
        ]
    );
    // A stop 2 to 4 lasts its timer: demand, 60 cycles of it, and the cycle that leaves.
    assert_eq!(reports[0].properties[11].length, Some(62));
}

#[test]
fn lengths_of_the_yardstick_properties_replay() {
    let system = Watched::new(20, vec![]);
    let report = explore(&system, &properties(), &options(2), &mut ()).unwrap();
    let length = |n: usize| report.properties[n].length;
    let last = |n: usize| {
        replay(&system, report.properties[n].trace.as_ref().unwrap(), 7)
            .pop()
            .unwrap()
    };
    assert_eq!(length(0), Some(1));
    // Axis 2 in stop 3 with 7 of 20 cycles left: entered with 20, then 13 cycles.
    assert_eq!(length(2), Some(14));
    assert!(last(2).atoms[6] && !last(2).atoms[5]);
    assert_eq!(length(3), Some(11));
    assert!(
        replay(&system, report.properties[3].trace.as_ref().unwrap(), 7)
            .iter()
            .all(|c| !c.atoms[1])
    );
}

/// From 0 anywhere, then three ways round: one level is far wider than the others.
struct Jump {
    domains: Vec<Domain>,
}

const SIZE: u32 = 200_003;
const FAN: u32 = 60_000;

impl Jump {
    fn new(padding: Vec<Domain>) -> Self {
        Jump {
            domains: [Domain {
                lo: 5,
                hi: 5 + SIZE as i32 - 1,
            }]
            .into_iter()
            .chain(padding)
            .collect(),
        }
    }

    fn to(x: u32, choice: u32) -> u32 {
        if x == 0 {
            3 * choice
        } else {
            (x * 2 + choice % 3 * 12_000 + 1) % SIZE
        }
    }
}

impl System for Jump {
    type Work = u32;
    fn work(&self) -> u32 {
        0
    }
    fn domains(&self) -> &[Domain] {
        &self.domains
    }
    fn combinations(&self) -> u128 {
        u128::from(FAN) * 3
    }
    fn initial<C: Choices>(&self, _: &mut u32, _: &mut C, state: &mut [i32]) {
        state.fill(5);
    }
    fn next<C: Choices>(
        &self,
        w: &mut u32,
        before: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let x = (before[0] - 5) as u32;
        let choice = if x == 0 {
            c.choose(0, FAN)
        } else {
            c.choose(1, 3)
        };
        after.fill(5);
        *w = Self::to(x, choice);
        after[0] = 5 + *w as i32;
        Ok(())
    }
    /// Atom n: the cycle leads to the state 1000 n + 17.
    fn atom<C: Choices>(&self, w: &mut u32, atom: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(*w == 1000 * atom as u32 + 17)
    }
}

#[derive(Default)]
struct Levels(Vec<u64>);

impl Progress for Levels {
    fn on_level(&mut self, depth: u32, _: u64, _: u128, frontier: u64) {
        assert_eq!(self.0.len(), depth as usize);
        self.0.push(frontier);
    }
}

#[test]
fn wide_levels_spill_into_the_second_bitmap_and_lose_nothing() {
    let mut depth = vec![None; SIZE as usize];
    depth[0] = Some(0usize);
    let mut queue = VecDeque::from([0u32]);
    let mut sizes: Vec<u64> = Vec::new();
    while let Some(x) = queue.pop_front() {
        let level = depth[x as usize].unwrap();
        sizes.resize(level + 1, 0);
        sizes[level] += 1;
        for choice in 0..if x == 0 { FAN } else { 3 } {
            let to = Jump::to(x, choice);
            if depth[to as usize].is_none() {
                depth[to as usize] = Some(level + 1);
                queue.push_back(to);
            }
        }
    }
    assert!(sizes[1] > 50_000 && sizes.len() > 3, "{sizes:?}");
    for (padded, threads) in [(0, 1), (0, 2), (0, 5), (1, 2), (3, 2)] {
        let mut levels = Levels::default();
        let report = explore(
            &Jump::new(padding(padded)),
            &[],
            &options(threads),
            &mut levels,
        )
        .unwrap();
        assert_eq!(levels.0, sizes);
        assert_eq!(report.states, sizes.iter().sum::<u64>());
        assert_eq!(
            report.transitions,
            u128::from(report.states) * u128::from(FAN) * 3
        );
    }
    let mut met = BTreeSet::new();
    assert!(
        reachable(&Jump::new(vec![]), &options(2), &mut |s| assert!(
            met.insert(s[0])
        ))
        .unwrap()
    );
    assert_eq!(met.len() as u64, sizes.iter().sum::<u64>());
}

#[test]
fn the_predecessors_of_traces_do_not_depend_on_threads() {
    let form = |goal| Form::Reachable { goal };
    let goals: Vec<_> = (0..200)
        .map(|n| Property {
            id: n.to_string(),
            form: form(n),
        })
        .collect();
    let run = |padded, threads| {
        explore(
            &Jump::new(padding(padded)),
            &goals,
            &options(threads),
            &mut (),
        )
        .unwrap()
        .properties
    };
    let one = run(0, 1);
    let long = |length: u64| one.iter().filter(|p| p.length == Some(length)).count();
    assert!(long(1) > 20 && long(2) > 20 && long(3) > 20);
    for (padded, threads) in [(0, 2), (0, 8), (0, 8), (1, 4)] {
        assert!(run(padded, threads) == one, "{padded} {threads}");
    }
}

#[test]
fn limits_end_early_and_keep_what_was_found() {
    let system = Watched::new(500, vec![]);
    let long = Instant::now();
    let limits = Limits {
        time: Some(Duration::from_millis(40)),
        memory: None,
        threads: 2,
    };
    let report = explore(
        &system,
        &properties(),
        &Options {
            limits,
            ..Options::default()
        },
        &mut (),
    )
    .unwrap();
    assert!(!report.complete && report.states > 0 && report.states < 4_024_036);
    assert!(long.elapsed() < Duration::from_secs(20));
    let verdicts: Vec<_> = report.properties.iter().map(|p| p.verdict).collect();
    assert_eq!(verdicts[0], Verdict::Violated);
    assert_eq!(report.properties[0].trace.as_ref().unwrap().steps.len(), 1);
    assert!(verdicts[1..].contains(&Verdict::Inconclusive));
    assert!(!verdicts.contains(&Verdict::Holds) && !verdicts.contains(&Verdict::Vacuous));

    // 1 MB does not hold the bitmap, nor the hash set for all states.
    let limits = Limits {
        time: None,
        memory: Some(1_000_000),
        threads: 2,
    };
    let report = explore(
        &system,
        &properties(),
        &Options {
            limits,
            ..Options::default()
        },
        &mut (),
    )
    .unwrap();
    assert!(!report.complete && report.storage == Storage::Hash64);
    assert_eq!(report.properties[0].verdict, Verdict::Violated);
    assert_eq!(report.properties[1].verdict, Verdict::Inconclusive);
    assert!(report.memory < 1_100_000, "{}", report.memory);

    // Enough for the search, too little for the graph of the recoverability properties: these alone stay open.
    let system = Watched::new(150, vec![]);
    let limits = Limits {
        time: None,
        memory: Some(16_000_000),
        threads: 2,
    };
    let report = explore(
        &system,
        &properties(),
        &Options {
            limits,
            ..Options::default()
        },
        &mut (),
    )
    .unwrap();
    assert_eq!((report.states, report.storage), (367_236, Storage::Bitmap));
    assert!(
        !report.complete && report.memory < 17_600_000,
        "{}",
        report.memory
    );
    assert_eq!(report.properties[1].verdict, Verdict::Holds);
    assert_eq!(report.properties[8].verdict, Verdict::Inconclusive);
}

#[test]
fn stopping_when_decided() {
    let system = Watched::new(500, vec![]);
    let property = [Property {
        id: "p".into(),
        form: Form::Reachable { goal: 6 },
    }];
    let options = Options {
        until: stillpoint_model::Until::Decided,
        ..options(2)
    };
    let report = explore(&system, &property, &options, &mut ()).unwrap();
    assert_eq!(report.properties[0].verdict, Verdict::Reached);
    assert_eq!(report.properties[0].length, Some(494));
    assert!(!report.complete && report.states < 4_024_036);
}

#[test]
fn every_reachable_state_is_visited_once() {
    let mut seen = std::collections::BTreeSet::new();
    let mut visits = 0_u64;
    let complete = reachable(&TwoAxis::new(9), &options(2), &mut |state| {
        visits += 1;
        seen.insert(state.to_vec());
    });
    assert!(complete.unwrap());
    let report = explore(&TwoAxis::new(9), &[], &options(1), &mut ()).unwrap();
    assert_eq!((visits, seen.len() as u64), (report.states, report.states));
}

/// Declares three combinations but reads a binary input.
struct Wrong(u128, Domain);

impl System for Wrong {
    type Work = ();
    fn work(&self) {}
    fn domains(&self) -> &[Domain] {
        std::slice::from_ref(&self.1)
    }
    fn combinations(&self) -> u128 {
        self.0
    }
    fn initial<C: Choices>(&self, _: &mut (), _: &mut C, state: &mut [i32]) {
        state[0] = 0;
    }
    fn next<C: Choices>(
        &self,
        _: &mut (),
        _: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        after[0] = c.choose(0, 2) as i32;
        Ok(())
    }
    fn atom<C: Choices>(&self, _: &mut (), _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(true)
    }
}

#[test]
fn contradictions_of_a_system_are_told() {
    let run = |system: &Wrong| explore(system, &[], &options(1), &mut ());
    assert_eq!(
        run(&Wrong(3, Domain { lo: 0, hi: 1 })),
        Err(Error::Combinations { declared: 3 })
    );
    assert_eq!(
        run(&Wrong(2, Domain { lo: 1, hi: 1 })),
        Err(Error::InitialOutOfDomain)
    );
    assert_eq!(
        run(&Wrong(2, Domain { lo: 1, hi: 0 })),
        Err(Error::EmptyDomain { variable: 0 })
    );
    // A step that leaves the domain is a fault, not another state.
    let report = run(&Wrong(2, Domain { lo: 0, hi: 0 })).unwrap();
    assert_eq!(
        (report.states, report.faults[0].code),
        (1, Fault::OUT_OF_DOMAIN.code)
    );
    assert_eq!(
        report.faults[0].trace.as_ref().unwrap().steps,
        [vec![(0, 1)]]
    );
}
