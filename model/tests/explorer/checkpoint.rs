//! Explorations that are broken off and continued: the same report as undisturbed ones, for every storage.

use crate::common::large::large_table;
use crate::common::{padding, random_table};
use std::path::PathBuf;
use std::time::Duration;
use stillpoint_model::{
    Checkpoint, Error, Form, Limits, Options, Progress, Property, Report, Storage, explore,
};

/// A file of its own that goes away with the value.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let name = format!("checkpoint-{name}-{}", std::process::id());
        Place(PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn properties() -> Vec<Property> {
    let response = |within, fair| Form::LeadsTo {
        when: 0,
        goal: 1,
        within,
        fair,
        assuming: None,
    };
    let forms = [
        Form::Always {
            when: Some(0),
            then: 1,
        },
        response(Some(2), vec![]),
        response(None, vec![2]),
        Form::Unless {
            when: 3,
            holds: 4,
            unless: 5,
        },
        Form::CanAlwaysReach {
            goal: 2,
            using: None,
        },
        Form::Reachable { goal: 5 },
    ];
    let named = forms.into_iter().enumerate();
    named
        .map(|(n, form)| Property {
            id: n.to_string(),
            form,
        })
        .collect()
}

fn options(place: &Place, identity: &str, time: Option<Duration>, resume: bool) -> Options {
    Options {
        limits: Limits {
            time,
            threads: 2,
            ..Limits::default()
        },
        checkpoint: Some(Checkpoint {
            file: place.0.clone(),
            identity: identity.to_owned(),
            every: Duration::ZERO,
            resume,
        }),
        ..Options::default()
    }
}

/// The report without what differs from run to run.
fn plain(mut report: Report) -> Report {
    report.seconds = 0.0;
    report.memory = 0;
    report.stored = 0;
    report.resumable = false;
    report
}

#[test]
fn a_run_broken_off_again_and_again_gives_the_same_report() {
    let mut broken = 0;
    for (padded, storage) in [
        (0, Storage::Bitmap),
        (0, Storage::Intervals),
        (1, Storage::Hash64),
        (3, Storage::Hash128),
    ] {
        for seed in 0..12 {
            let mut table = large_table(seed, 6);
            table.domains.extend(padding(padded));
            table.timer = Some((seed % 2) as usize);
            let intervals = storage == Storage::Intervals;
            let place = Place::new(&format!("{padded}-{seed}"));
            let undisturbed = Options {
                intervals,
                ..Options::default()
            };
            let whole = explore(&table, &properties(), &undisturbed, &mut ()).unwrap();
            assert_eq!(whole.storage, storage);
            // No time at all ends the first run before its first level, more and more time later ones.
            let mut time = Duration::ZERO;
            let mut resume = false;
            let last = loop {
                let options = Options {
                    intervals,
                    ..options(&place, "it", Some(time), resume)
                };
                let report = explore(&table, &properties(), &options, &mut ()).unwrap();
                assert!(report.resumable && report.states <= whole.states);
                if report.complete {
                    break report;
                }
                broken += 1;
                time += Duration::from_micros(20);
                resume = true;
            };
            let ended = Options {
                intervals,
                ..options(&place, "it", None, true)
            };
            let again = explore(&table, &properties(), &ended, &mut ()).unwrap();
            assert!(again.stored > 0 && again.stored == last.stored);
            assert_eq!(plain(last), plain(whole), "{padded} {seed}");
        }
    }
    assert!(broken > 48, "{broken}");
}

#[test]
fn a_checkpoint_of_something_else_or_damaged_is_refused() {
    let table = random_table(3, 6, padding(1));
    let place = Place::new("damaged");
    let run = |identity: &str, resume| {
        let options = options(&place, identity, None, resume);
        explore(&table, &properties(), &options, &mut ())
    };
    let reason = |result: Result<Report, Error>| match result {
        Err(Error::Checkpoint { reason, .. }) => reason,
        other => panic!("{other:?}"),
    };
    run("it", false).unwrap();
    assert!(reason(run("other", true)).contains("another specification"));
    let good = std::fs::read(&place.0).unwrap();
    for bit in [0, 300, good.len() * 4, good.len() * 8 - 1] {
        let mut bad = good.clone();
        bad[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&place.0, &bad).unwrap();
        assert!(reason(run("it", true)).contains("damaged"), "bit {bit}");
        // It is not touched.
        assert_eq!(std::fs::read(&place.0).unwrap(), bad);
    }
    for length in [0, 10, good.len() / 2, good.len() - 1] {
        std::fs::write(&place.0, &good[..length]).unwrap();
        assert!(reason(run("it", true)).contains("damaged"), "{length}");
    }
    std::fs::write(&place.0, &good).unwrap();
    assert!(run("it", true).unwrap().complete);
}

#[test]
fn a_checkpoint_that_cannot_be_written_does_not_end_the_search() {
    struct Lost(usize);
    impl Progress for Lost {
        fn on_lost_checkpoint(&mut self, error: &Error) {
            assert!(error.to_string().contains("cannot be written"), "{error}");
            self.0 += 1;
        }
    }
    let table = random_table(5, 6, padding(0));
    let mut place = Place::new("nowhere");
    place.0.push("no-such-folder");
    let mut lost = Lost(0);
    let options = options(&place, "it", None, false);
    let report = explore(&table, &properties(), &options, &mut lost).unwrap();
    assert!(report.complete && !report.resumable && lost.0 > 0);
}
