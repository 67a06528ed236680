//! A limit ends every enumeration, wherever its inputs are read: in a step, by an initial state, by the properties, in the
//! search as in what follows it, with each storage, in pairs of runs, in systems of parts, in several processes.

use crate::common::padding;
use std::net::TcpListener;
use std::thread;
use std::time::{Duration, Instant};
use stillpoint_model::{
    Choices, Cluster, Component, Domain, Fault, Form, Interrupt, Limits, Options, Property, Report,
    Storage, System, Twin, Verdict, explore, explore_together, reachable,
};

/// Free Booleans: to enumerate their values takes hours.
const FREE: u32 = 40;
const TIME: Duration = Duration::from_millis(300);
/// The time limit, as long again for runs, and what a busy machine takes.
const MOST: Duration = Duration::from_secs(8);

/// Where the free Booleans are read.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Read {
    /// By the step of each state; they do not matter.
    Step,
    /// By the step of each state; the states after it are all different.
    Spread,
    /// By the initial state; they do not matter.
    Initial,
    /// By the initial state; all are different.
    Initials,
    /// By every atom, in each cycle.
    Atoms,
    /// By every atom, in each cycle but those from state 0: not in the search, where the property is not about them.
    Later,
}

/// A counter from 0 to 3 that stays there, two variables that hold 20 Booleans each, and what widens the index space.
struct Wide {
    read: Read,
    domains: Vec<Domain>,
    timer: Option<usize>,
}

impl Wide {
    fn new(read: Read, widening: usize) -> Self {
        let bits = Domain {
            lo: 0,
            hi: (1 << (FREE / 2)) - 1,
        };
        // A bitmap holds what has few indices.
        let bits = match read {
            Read::Spread | Read::Initials => bits,
            _ => Domain { lo: 0, hi: 0 },
        };
        let mut domains = vec![Domain { lo: 0, hi: 3 }, bits, bits];
        domains.extend(padding(widening));
        Wide {
            read,
            domains,
            timer: None,
        }
    }
}

fn bits<C: Choices>(choices: &mut C) -> [i32; 2] {
    let half = |from: u32, choices: &mut C| {
        (from..from + FREE / 2).fold(0, |all, input| all << 1 | choices.choose(input, 2) as i32)
    };
    [half(0, choices), half(FREE / 2, choices)]
}

impl System for Wide {
    /// The state before.
    type Work = i32;

    fn work(&self) -> i32 {
        0
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        1 << FREE
    }

    fn initial<C: Choices>(&self, _: &mut i32, choices: &mut C, state: &mut [i32]) {
        state.fill(0);
        if matches!(self.read, Read::Initial | Read::Initials) {
            let read = bits(choices);
            if self.read == Read::Initials {
                state[1..3].copy_from_slice(&read);
            }
        }
    }

    fn next<C: Choices>(
        &self,
        before: &mut i32,
        state: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        *before = state[0];
        after.copy_from_slice(state);
        after[0] = (state[0] + 1).min(3);
        if matches!(self.read, Read::Step | Read::Spread) {
            let read = bits(choices);
            if self.read == Read::Spread {
                after[1..3].copy_from_slice(&read);
            }
        }
        Ok(())
    }

    /// Atom 0: the cycle from state 0. Atom 1: never. Atom 2: always.
    fn atom<C: Choices>(
        &self,
        before: &mut i32,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        if self.read == Read::Atoms || self.read == Read::Later && *before > 0 && atom > 0 {
            bits(choices);
        }
        Ok(atom == 2 || atom == 0 && *before == 0)
    }

    fn observe<C: Choices>(&self, _: &mut i32, _: usize, choices: &mut C) -> Result<i64, Fault> {
        if self.read == Read::Later {
            bits(choices);
        }
        Ok(0)
    }

    fn timer(&self) -> Option<usize> {
        self.timer
    }
}

fn options(memory: Option<u64>) -> Options {
    Options {
        limits: Limits {
            time: memory.is_none().then_some(TIME),
            memory,
            threads: 2,
        },
        ..Options::default()
    }
}

fn named(form: Form) -> Property {
    Property {
        id: "P".to_owned(),
        form,
    }
}

fn always() -> Form {
    Form::Always {
        when: None,
        then: 2,
    }
}

fn response(within: Option<u32>, fair: Vec<usize>) -> Form {
    Form::LeadsTo {
        when: 0,
        goal: 1,
        within,
        fair,
        assuming: None,
    }
}

/// What `work` says, and that it takes not much longer than the limit.
fn soon<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let took = start.elapsed();
    assert!(took < MOST, "{what}: {took:?}");
    result
}

fn partial(what: &str, report: &Report) {
    assert!(!report.complete && !report.resumable, "{what}: {report:?}");
    let verdicts: Vec<_> = report.properties.iter().map(|p| p.verdict).collect();
    assert_eq!(verdicts, [Verdict::Inconclusive], "{what}");
}

#[test]
fn time_ends_the_inputs_of_one_state_with_every_storage() {
    for read in [Read::Step, Read::Initial, Read::Atoms] {
        for (widening, storage) in [
            (0, Storage::Bitmap),
            (1, Storage::Hash64),
            (3, Storage::Hash128),
            (0, Storage::Intervals),
        ] {
            let what = format!("{read:?} {storage:?}");
            let mut system = Wide::new(read, widening);
            let mut options = options(None);
            if storage == Storage::Intervals {
                system.timer = Some(1);
                options.intervals = true;
            }
            let explored = || explore(&system, &[named(always())], &options, &mut ());
            let report = soon(&what, explored).unwrap();
            assert_eq!(report.storage, storage, "{what}");
            assert!(report.states >= 1, "{what}: {report:?}");
            partial(&what, &report);
        }
    }
}

#[test]
fn memory_ends_the_inputs_of_one_state_with_every_storage() {
    const MEMORY: u64 = 8 << 20;
    for read in [Read::Spread, Read::Initials] {
        for (widening, storage) in [
            (0, Storage::Hash64),
            (2, Storage::Hash128),
            (0, Storage::Intervals),
        ] {
            let what = format!("{read:?} {storage:?}");
            let mut system = Wide::new(read, widening);
            let mut options = options(Some(MEMORY));
            if storage == Storage::Intervals {
                system.timer = Some(1);
                options.intervals = true;
            }
            let explored = || explore(&system, &[named(always())], &options, &mut ());
            let report = soon(&what, explored).unwrap();
            assert_eq!(report.storage, storage, "{what}");
            assert!(report.states > 1000, "{what}: {report:?}");
            assert!(report.memory < MEMORY * 5 / 4, "{what}: {}", report.memory);
            partial(&what, &report);
        }
    }
}

#[test]
fn time_ends_what_follows_the_search() {
    let forms = [
        response(Some(5), Vec::new()),
        response(None, Vec::new()),
        response(None, vec![2]),
        Form::Unless {
            when: 0,
            holds: 2,
            unless: 1,
        },
        Form::CanAlwaysReach {
            goal: 1,
            using: None,
        },
    ];
    for form in forms {
        let what = format!("{form:?}");
        let system = Wide::new(Read::Later, 0);
        let report = soon(&what, || {
            explore(&system, &[named(form)], &options(None), &mut ())
        });
        partial(&what, &report.unwrap());
    }
}

#[test]
fn time_ends_pairs_of_runs_and_lists_of_states() {
    for read in [Read::Step, Read::Later] {
        let system = Wide::new(read, 0);
        let listed = (0..FREE).map(|input| (input, 2)).collect();
        let twin = Twin::new(&system, listed, None, vec![0]);
        let form = Form::Always {
            when: Some(Twin::<Wide>::BOTH),
            then: Twin::<Wide>::AGREE,
        };
        let what = format!("pairs, {read:?}");
        let report = soon(&what, || {
            explore(&twin, &[named(form)], &options(None), &mut ())
        });
        partial(&what, &report.unwrap());
    }
    for read in [Read::Step, Read::Initial] {
        let system = Wide::new(read, 0);
        let all = soon("states", || reachable(&system, &options(None), &mut |_| ()));
        assert!(!all.unwrap());
    }
    let all = reachable(
        &Wide::new(Read::Spread, 0),
        &options(Some(8 << 20)),
        &mut |_| (),
    );
    assert!(!all.unwrap());
}

#[test]
fn a_violation_found_before_the_limit_keeps_its_run() {
    // Violated in the first cycle, and the search never gets beyond the inputs of its state.
    let system = Wide::new(Read::Step, 0);
    let never = Form::Always {
        when: None,
        then: 1,
    };
    let report = soon("violated", || {
        explore(
            &system,
            &[named(never), named(always())],
            &options(None),
            &mut (),
        )
    })
    .unwrap();
    assert_eq!(report.properties[0].verdict, Verdict::Violated);
    let trace = report.properties[0].trace.as_ref().expect("a run");
    assert_eq!(trace.steps.len(), 1);
    assert_eq!(report.properties[1].verdict, Verdict::Inconclusive);
    assert!(!report.complete);
}

#[test]
fn an_interrupt_ends_all_of_it_too() {
    for read in [Read::Step, Read::Initial, Read::Atoms, Read::Later] {
        let what = format!("interrupt, {read:?}");
        let system = Wide::new(read, 0);
        let interrupt = Interrupt::default();
        let options = Options {
            interrupt: Some(interrupt.clone()),
            ..Options::default()
        };
        let report = thread::scope(|scope| {
            scope.spawn(|| {
                thread::sleep(TIME);
                interrupt.raise();
            });
            let property = match read {
                Read::Later => response(Some(5), Vec::new()),
                _ => always(),
            };
            soon(&what, || {
                explore(&system, &[named(property)], &options, &mut ())
            })
        });
        partial(&what, &report.unwrap());
    }
}

#[test]
fn limits_end_processes_that_explore_together() {
    for (read, memory) in [
        (Read::Step, None),
        (Read::Initial, None),
        (Read::Atoms, None),
        (Read::Spread, Some(8 << 20)),
        (Read::Initials, Some(8 << 20)),
    ] {
        let what = format!("together, {read:?}");
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let options = &options(memory);
        let run = |cluster: Cluster| {
            let system = Wide::new(read, 0);
            explore_together(&system, &[named(always())], options, &mut (), &cluster)
        };
        let report = soon(&what, || {
            thread::scope(|scope| {
                let other = scope
                    .spawn(|| run(Cluster::join(&address, 1, Duration::from_secs(5)).unwrap()));
                let first = run(Cluster::gather(listener, 2, 1, 1, &mut || Ok(())).unwrap());
                other.join().unwrap().unwrap();
                first.unwrap()
            })
        });
        if let Some(memory) = memory {
            assert!(report.memory < 3 * memory, "{what}: {}", report.memory);
        }
        partial(&what, &report);
    }
}

/// So many counters of their own, each of which takes steps of 0 to 3 as two inputs of its own say.
struct Counters {
    domains: Vec<Domain>,
    own: Option<usize>,
}

impl Counters {
    fn new(number: usize, own: Option<usize>) -> Self {
        let domains = vec![Domain { lo: 0, hi: 3 }; number];
        Counters { domains, own }
    }
}

impl System for Counters {
    type Work = ();

    fn work(&self) {}

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        1 << (2 * self.domains.len())
    }

    fn initial<C: Choices>(&self, _: &mut (), _: &mut C, state: &mut [i32]) {
        state.fill(0);
    }

    fn next<C: Choices>(
        &self,
        _: &mut (),
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        after.copy_from_slice(before);
        for (n, value) in after.iter_mut().enumerate() {
            if self.own.is_none_or(|own| own == n) {
                let step =
                    choices.choose(2 * n as u32, 2) + 2 * choices.choose(2 * n as u32 + 1, 2);
                *value = (*value + step as i32) % 4;
            }
        }
        Ok(())
    }

    fn atom<C: Choices>(&self, _: &mut (), _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(true)
    }

    fn components(&self) -> Vec<Component<'_>> {
        let number = self.domains.len();
        let parts = (0..number).filter(|_| self.own.is_none());
        parts
            .map(|n| Component::new(vec![n], Vec::new(), Counters::new(number, Some(n))))
            .collect()
    }
}

#[test]
fn limits_end_systems_of_parts() {
    // 4 to the power of 16 cycles from each state: too many for tables, and for memory.
    for (number, memory) in [
        (16, None),
        (16, Some(8 << 20)),
        (12, Some(8 << 20)),
        (9, Some(1 << 20)),
    ] {
        let what = format!("{number} parts, {memory:?}");
        let system = Counters::new(number, None);
        let mut options = options(memory);
        options.limits.time = Some(TIME);
        let property = Form::Always {
            when: None,
            then: 0,
        };
        let report = soon(&what, || {
            explore(&system, &[named(property)], &options, &mut ())
        })
        .unwrap();
        partial(&what, &report);
        if let Some(memory) = memory {
            assert!(report.memory < 2 * memory, "{what}: {}", report.memory);
        }
    }
}
