use stillpoint_monitors::srm::{add_dint, load_monitor};

use stillpoint_proofs::enumeration::enumerate;
use stillpoint_proofs::inventory::NARROW;
use stillpoint_proofs::source::Verdict;
use stillpoint_proofs::total::{ends, enumerated};

#[test]
fn two_numbers_are_apart() {
    let mut steps = Vec::new();
    enumerate(NARROW, 0, |source| {
        steps.push(ends::<add_dint::Monitor>(source).expect("no configuration is refused"));
        Verdict::Held
    });
    let has = |operand1, operand2| {
        let inputs = add_dint::Inputs { operand1, operand2 };
        steps.iter().any(|step| step.2 == inputs)
    };
    assert!(has(i32::MIN, i32::MAX) && has(1, 1) && has(0, i32::MIN) && has(i32::MAX, i32::MAX));
}

/// An addition that is not checked is found, and nothing in the production monitor.
#[test]
fn an_overflow_is_found() {
    let next = |state: load_monitor::State,
                config: &load_monitor::Config,
                inputs: &load_monitor::Inputs| {
        let difference = inputs.load1 - inputs.load2;
        let (after, mut outputs) = load_monitor::next(state, config, inputs);
        outputs.error |= difference > config.maxtol_load;
        (after, outputs)
    };
    let count = enumerated::<load_monitor::Monitor>(NARROW, next);
    assert_eq!(count.broken.map(|(law, _)| law), Some("no_call_panics"));
    let count = enumerated::<load_monitor::Monitor>(NARROW, load_monitor::next);
    assert!(count.proves());
}
