use stillpoint_proofs::enumeration::{Domain, enumerate};
use stillpoint_proofs::source::{Source, Verdict};

const SMALL: Domain = Domain {
    delays: &[0],
    highest_speed: 0,
};

#[test]
fn every_combination_comes_exactly_once() {
    let mut seen = Vec::new();
    let count = enumerate(SMALL, 1, |source| {
        let first = source.any_in(3, 5);
        // The second choice exists only on one branch: on demand.
        let second = if first == 4 { source.any_in(0, 1) } else { 9 };
        source.cover(0, second == 1);
        seen.push((first, second));
        Verdict::Held
    });
    assert_eq!(seen, [(3, 9), (4, 0), (4, 1), (5, 9)]);
    assert_eq!(
        (count.cases, count.discarded, count.covers.as_slice()),
        (4, 0, [1].as_slice())
    );
    assert!(count.proves());
}

#[test]
fn wide_numbers_are_the_near_ones_and_the_ends() {
    let (mut signed, mut unsigned) = (Vec::new(), Vec::new());
    enumerate(SMALL, 0, |source| {
        signed.push(source.any_i32(1));
        Verdict::Held
    });
    assert_eq!(signed, [i32::MIN, i32::MAX, -1, 0, 1]);
    for (reach, highest) in [(1, 9), (3, 2)] {
        enumerate(SMALL, 0, |source| {
            unsigned.push(source.any_u32(reach, highest));
            Verdict::Held
        });
    }
    assert_eq!(unsigned, [0, 1, 9, 0, 1, 2]);
}

#[test]
fn the_first_broken_law_is_kept_with_its_digits() {
    let count = enumerate(SMALL, 0, |source| {
        let (a, b) = (source.any_bool(), source.any_in(0, 2));
        if a && b == 1 {
            Verdict::Broken("law")
        } else {
            Verdict::Held
        }
    });
    assert_eq!(count.broken, Some(("law", vec![1, 1])));
    assert!(!count.proves());
}

#[test]
fn a_cover_never_met_proves_nothing() {
    let count = enumerate(SMALL, 1, |source| {
        source.cover(0, false);
        Verdict::Held
    });
    assert!(!count.proves());
}
