//! Several processes explore together: here each one is a thread with its own cluster, and all talk over loopback.

use crate::common::large::large_table;
use crate::common::{Table, padding, random_table};
use std::net::TcpListener;
use std::thread;
use std::time::{Duration, Instant};
use stillpoint_model::{
    Choices, Cluster, Domain, Error, Fault, Form, Limits, Options, Property, Report, Storage,
    System, explore, explore_together,
};

const ATOMS: usize = 6;

fn properties() -> Vec<Property> {
    let response = |within, fair: &[usize], assuming| Form::LeadsTo {
        when: 0,
        goal: 1,
        within,
        fair: fair.to_vec(),
        assuming,
    };
    let forms = [
        Form::Always {
            when: Some(0),
            then: 2,
        },
        Form::Always {
            when: None,
            then: 5,
        },
        Form::Unless {
            when: 0,
            holds: 5,
            unless: 1,
        },
        response(Some(4), &[], None),
        response(None, &[], None),
        response(None, &[2, 3], Some(5)),
        Form::CanAlwaysReach {
            goal: 1,
            using: None,
        },
        Form::Reachable { goal: 4 },
    ];
    let named = |(number, form)| Property {
        id: format!("p{number}"),
        form,
    };
    forms.into_iter().enumerate().map(named).collect()
}

/// The cluster of each process.
fn clusters(processes: usize, threads: usize, subject: u64) -> Vec<Cluster> {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let joining: Vec<_> = (1..processes)
        .map(|_| {
            let address = address.clone();
            thread::spawn(move || Cluster::join(&address, subject, Duration::from_secs(5)))
        })
        .collect();
    let gathered = Cluster::gather(listener, processes, threads, subject, &mut || Ok(())).unwrap();
    let mut all = vec![gathered];
    all.extend(joining.into_iter().map(|j| j.join().unwrap().unwrap()));
    all.sort_by_key(Cluster::process);
    all
}

/// The reports of process 0 for some systems, explored one after the other by all processes.
fn together<S: System>(
    systems: &[S],
    options: &Options,
    clusters: Vec<Cluster>,
) -> Vec<Result<Report, Error>> {
    let mut answers: Vec<Vec<_>> = thread::scope(|scope| {
        let running: Vec<_> = clusters
            .into_iter()
            .map(|cluster| {
                scope.spawn(move || {
                    systems
                        .iter()
                        .map(|s| explore_together(s, &properties(), options, &mut (), &cluster))
                        .collect()
                })
            })
            .collect();
        running.into_iter().map(|r| r.join().unwrap()).collect()
    });
    answers.swap_remove(0)
}

fn plain(mut report: Report) -> Report {
    report.seconds = 0.0;
    report.memory = 0;
    report.stored = 0;
    report.storage = Storage::Bitmap;
    report
}

fn compare(tables: &[Table], options: &Options) {
    let alone: Vec<Report> = tables
        .iter()
        .map(|table| plain(explore(table, &properties(), options, &mut ()).unwrap()))
        .collect();
    for (processes, threads) in [(1, 1), (2, 1), (4, 1), (2, 2)] {
        let reports = together(tables, options, clusters(processes, threads, 7));
        for (number, (report, alone)) in reports.into_iter().zip(&alone).enumerate() {
            let report = report.unwrap();
            assert!(report.stored >= 8 * report.states, "{}", report.stored);
            let report = plain(report);
            let place = format!("system {number}, {processes} processes with {threads} threads");
            assert_eq!(&report, alone, "{place}");
        }
    }
}

#[test]
fn the_report_does_not_depend_on_the_number_of_processes() {
    let mut tables: Vec<Table> = (0..8).map(|seed| large_table(seed, ATOMS)).collect();
    for (seed, wide) in (100..109).zip([0, 1, 3].into_iter().cycle()) {
        tables.push(random_table(seed, ATOMS, padding(wide)));
    }
    compare(&tables, &Options::default());
    let decided = Options {
        until: stillpoint_model::Until::Decided,
        witnesses: false,
        examples: 2,
        ..Options::default()
    };
    compare(&tables[5..11], &decided);
}

/// Counts up for ever, slowly.
struct Slow(Vec<Domain>);

impl System for Slow {
    type Work = ();

    fn work(&self) {}

    fn domains(&self) -> &[Domain] {
        &self.0
    }

    fn combinations(&self) -> u128 {
        1
    }

    fn initial<C: Choices>(&self, _: &mut (), _: &mut C, state: &mut [i32]) {
        state[0] = 0;
    }

    fn next<C: Choices>(
        &self,
        _: &mut (),
        before: &[i32],
        _: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        thread::sleep(Duration::from_millis(1));
        after[0] = before[0] + 1;
        Ok(())
    }

    fn atom<C: Choices>(&self, _: &mut (), _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(false)
    }
}

fn slow() -> Slow {
    Slow(vec![Domain { lo: 0, hi: 1 << 30 }])
}

#[test]
fn the_time_limit_of_process_0_holds_for_all() {
    let options = Options {
        limits: Limits {
            time: Some(Duration::from_millis(700)),
            ..Limits::default()
        },
        ..Options::default()
    };
    let start = Instant::now();
    let report = together(&[slow()], &options, clusters(2, 1, 1))
        .remove(0)
        .unwrap();
    assert!(!report.complete && report.states > 10, "{report:?}");
    assert!(start.elapsed() < Duration::from_secs(20));
}

#[test]
fn a_process_that_leaves_ends_the_exploration_of_the_others() {
    let mut all = clusters(3, 1, 1);
    let leaver = all.pop().unwrap();
    let start = Instant::now();
    let errors: Vec<_> = thread::scope(|scope| {
        let running: Vec<_> = all
            .iter()
            .map(|cluster| {
                scope.spawn(move || {
                    explore_together(
                        &slow(),
                        &properties(),
                        &Options::default(),
                        &mut (),
                        cluster,
                    )
                })
            })
            .collect();
        thread::sleep(Duration::from_millis(300));
        drop(leaver);
        running.into_iter().map(|r| r.join().unwrap()).collect()
    });
    assert!(start.elapsed() < Duration::from_secs(20));
    let text = errors[0].as_ref().unwrap_err().to_string();
    assert!(text.contains("ended its work"), "{text}");
    assert!(errors[1].is_err());
}

#[test]
fn who_explores_something_else_is_refused() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let waiting = thread::spawn(move || {
        let mut patience = 400;
        Cluster::gather(listener, 2, 1, 1, &mut || {
            patience -= 1;
            if patience > 0 {
                Ok(())
            } else {
                Err("nobody came".to_owned())
            }
        })
    });
    let error = Cluster::join(&address, 2, Duration::from_secs(5)).unwrap_err();
    assert!(error.to_string().contains("other systems"), "{error}");
    assert_eq!(
        waiting.join().unwrap().unwrap_err().to_string(),
        "nobody came"
    );
    let error = Cluster::join(&address, 2, Duration::ZERO).unwrap_err();
    assert!(error.to_string().contains("cannot reach"), "{error}");
    let error = Cluster::join("nowhere", 2, Duration::ZERO).unwrap_err();
    assert!(error.to_string().contains("HOST:PORT"), "{error}");
}

#[test]
fn processes_whose_systems_differ_do_not_go_on() {
    let all = clusters(2, 1, 1);
    let tables = [large_table(1, ATOMS), large_table(2, ATOMS)];
    let answers: Vec<_> = thread::scope(|scope| {
        let running: Vec<_> = all
            .iter()
            .zip(&tables)
            .map(|(cluster, table)| {
                let options = Options::default();
                scope.spawn(move || {
                    explore_together(table, &properties(), &options, &mut (), cluster)
                })
            })
            .collect();
        running.into_iter().map(|r| r.join().unwrap()).collect()
    });
    let text = answers[1].as_ref().unwrap_err().to_string();
    assert!(text.contains("another system"), "{text}");
}
