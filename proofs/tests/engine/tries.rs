use stillpoint_monitors::heidenhain::deceleration;
use stillpoint_monitors::sinumerik::speed;

use stillpoint_monitors::contract::Contract;
use stillpoint_proofs::draw::Case;
use stillpoint_proofs::enumeration::{Domain, Odometer, enumerate};
use stillpoint_proofs::source::Verdict;
use stillpoint_proofs::tries::{Tries, in_words};

const GOOD: &str = "wait: 0 1 3; timer: 0..3; last: 0..2 max; inputs.speed: 0..3 max";

fn of(text: &str) -> Result<Tries, String> {
    Tries::of::<deceleration::Monitor>(text)
}

fn steps<M: Contract>(text: &str) -> Vec<Case<M>> {
    let tries = Tries::of::<M>(text).expect("lists that fit");
    let mut steps = Vec::new();
    let domain = Domain {
        delays: &[],
        highest_speed: 0,
    };
    enumerate(domain, 0, |source: &mut Odometer| {
        steps.extend(tries.step::<M, _>(source));
        Verdict::Held
    });
    steps
}

#[test]
fn words_are_values_and_narrow_numbers_are_whole() {
    let tries = of(GOOD).expect("lists that fit");
    let max = i64::from(u32::MAX);
    let truth = vec![0, 1];
    assert_eq!(tries.config, [truth.clone(), vec![0, 1, 3], truth.clone()]);
    assert_eq!(
        tries.state,
        [truth.clone(), (0..=3).collect(), vec![0, 1, 2, max]]
    );
    assert_eq!(tries.inputs, [truth, vec![0, 1, 2, 3, max]]);
    let ends = of("wait: 5 ends 4..5 -1; timer: max min 9; last speed: min").expect("lists");
    assert_eq!(ends.config[1], [0, 4, 5, max]);
    assert_eq!(ends.state[1], [0, 9, max]);
    assert_eq!((&ends.state[2], &ends.inputs[1]), (&vec![0], &vec![0]));
}

#[test]
fn the_first_list_with_the_name_counts_and_a_name_stands_for_what_is_below() {
    let tries = of("config.wait: 7; config: 1; state: 0..1; inputs: 1").expect("lists");
    assert_eq!(tries.config, [vec![1], vec![7], vec![1]]);
    assert_eq!(tries.state, [vec![0, 1], vec![0, 1], vec![0, 1]]);
    assert_eq!(tries.inputs, [vec![1], vec![1]]);
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let refused = |text: &str, lines: &str| assert_eq!(of(text), Err(lines.to_owned()));
    refused(
        "wait: 0; timer: 0",
        "state.last: no list says what is tried\ninputs.speed: no list says what is tried",
    );
    refused(
        &format!("{GOOD}; colour tim.er: 1"),
        "no number is called colour, tim.er",
    );
    refused(
        &GOOD.replace("0 1 3", "0 soon"),
        "config.wait: `soon` is no number, range, `min`, `max` or `ends`",
    );
    refused(&GOOD.replace("0 1 3", "-1"), "config.wait: no value");
    refused(
        &GOOD.replace("wait: 0 1 3", "wait"),
        "config.wait: no value",
    );
    // A list that stands behind one with the same name is never used.
    refused(&format!("{GOOD}; wait: 9"), "no number is called wait");
}

#[test]
fn every_step_of_the_values_comes_once() {
    let steps = steps::<deceleration::Monitor>(GOOD);
    for (place, step) in steps.iter().enumerate() {
        assert!(step.0.invariant(&step.1), "{step:?}");
        assert!(!steps.iter().take(place).any(|other| other == step));
    }
    // Ten configurations times inputs; states: those with `on` and a timer that fits, and the initial one.
    let fits = |wait: usize| 4 * (wait + 1) + 1;
    assert_eq!(steps.len(), 4 * 10 * (fits(0) + fits(1) + fits(3)));
}

#[test]
fn the_numbers_of_a_missing_value_are_not_chosen() {
    let one = "stops: 1; monitored stage: 0; speed limit encoder_speed: 0";
    let steps = steps::<speed::Monitor>(&format!("{one}; encoder_max.value: 0 5"));
    assert_eq!(steps.len(), 3, "none, 0 and 5");
}

#[test]
fn lists_are_said_in_words() {
    assert_eq!(in_words(""), "complete");
    assert_eq!(
        in_words("path still: 0..2 max; begin: -1 min ends"),
        "path, still 0 to 2, the greatest; begin -1, the least, the ends of its type; all else whole"
    );
}
