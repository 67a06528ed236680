//! The properties as random tests over the full width. A pass is a test, not a proof.

use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};
use rayon::prelude::*;
use stillpoint_proofs::inventory;
use stillpoint_proofs::properties::Subject;
use stillpoint_proofs::sampling::Tape;
use stillpoint_proofs::source::Verdict;

/// Runs for each property.
const CASES: u32 = 4_000;

/// Choices of one run; few make more, since a step that is none is drawn again.
const TAPE: usize = 512;

/// Fixed, so that a failure comes again.
const SEED: [u8; 32] = *b"stillpoint: any seed will do. 01";

#[test]
fn every_property_holds_on_random_choices_of_full_width() {
    let entries: Vec<_> = inventory::all().collect();
    entries.into_par_iter().for_each(|entry| {
        let config = Config {
            cases: CASES,
            failure_persistence: None,
            ..Config::default()
        };
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &SEED);
        let mut runner = TestRunner::new_with_rng(config, rng);
        let held = std::cell::Cell::new(0_u32);
        let tape = proptest::collection::vec(proptest::num::u32::ANY, TAPE);
        let outcome = runner.run(&tape, |words| {
            match (entry.sample)(&mut Tape::new(&words, &mut []), &Subject::PRODUCTION) {
                Verdict::Held => {
                    held.set(held.get() + 1);
                    Ok(())
                }
                // Not a rejection for proptest: the count below says whether enough runs were left.
                Verdict::Discarded => Ok(()),
                Verdict::Broken(law) => Err(TestCaseError::fail(law)),
            }
        });
        match outcome {
            Ok(()) => {}
            Err(TestError::Fail(law, words)) => {
                panic!("{}: {law}; seed {SEED:?}; tape {words:?}", entry.id)
            }
            Err(TestError::Abort(reason)) => panic!("{}: {reason}", entry.id),
        }
        assert!(
            held.get() > CASES / 10,
            "{}: only {} of {CASES} runs were in the domain",
            entry.id,
            held.get()
        );
    });
}
