//! Modes, permissives, control voltage and outputs of HEIDENHAIN Functional Safety as scenarios.

use stillpoint_monitors::heidenhain::types::{Som, Stop};
use stillpoint_monitors::heidenhain::{button, output_enable, som, switch_on};
use stillpoint_monitors::kernel::{ConfigError, Cycles};

/// HFS-KSW-002, HFS-KSW-006: from SOM_3 to SOM_4 only over neutral keys.
#[test]
fn som_4_needs_neutral_keys() {
    let mut selection = som::Monitor::new(som::Config::new(true).expect("plausible"));
    let key_3 = som::Inputs {
        key_3: true,
        ..Default::default()
    };
    let key_4 = som::Inputs {
        key_4: true,
        ..Default::default()
    };
    assert_eq!(selection.step(&key_3).som, Som::Som3);
    for _ in 0..3 {
        assert_eq!(selection.step(&key_4).som, Som::Som1);
    }
    selection.step(&som::Inputs::default());
    let out = selection.step(&key_4);
    assert!(out.changed && out.som == Som::Som4);
    // The soft key leaves it while the key is still turned.
    let left = som::Inputs {
        deselected: true,
        ..key_4
    };
    assert_eq!(selection.step(&left).som, Som::Som1);
    assert_eq!(selection.step(&key_4).som, Som::Som1);
}

/// HFS-KSW-001: two keys are none.
#[test]
fn two_keys_select_som_1() {
    let mut selection = som::Monitor::new(som::Config::new(true).expect("plausible"));
    let keys = som::Inputs {
        key_2: true,
        key_4: true,
        ..Default::default()
    };
    assert_eq!(selection.step(&keys).som, Som::Som1);
}

/// HFS-PB-001, HFS-PB-006: one press counts for its time, a jammed button not at all.
#[test]
fn a_permissive_counts_for_its_time() {
    let config = button::Config::new(Cycles::new(3)).expect("plausible");
    let mut permissive = button::Monitor::new(config);
    let pressed = button::Inputs {
        contact_a: true,
        contact_b: true,
        ..Default::default()
    };
    assert!(permissive.step(&pressed).jammed, "held at power-up");
    permissive.step(&button::Inputs::default());
    for _ in 0..3 {
        assert!(permissive.step(&pressed).valid);
    }
    assert!(permissive.step(&pressed).jammed);
    permissive.step(&button::Inputs {
        contact_b: false,
        ..pressed
    });
    assert!(permissive.step(&pressed).valid);
    assert!(
        permissive
            .step(&button::Inputs {
                unit_changes: true,
                ..pressed
            })
            .jammed
    );
    assert_eq!(button::Config::new(Cycles::ZERO), Err(ConfigError::NoDelay));
}

/// HFS-ACK-005, HFS-NCC-001, HFS-CVO-002: a latched relay restarts nothing; a slow chain has 200 ms.
#[test]
fn control_voltage_needs_an_edge_and_the_chain() {
    let mut voltage = switch_on::Monitor::new(switch_on::Config::STANDARD);
    let latched = switch_on::Inputs {
        cvo: true,
        chain: true,
        may_on: true,
        ..Default::default()
    };
    for _ in 0..3 {
        assert!(!voltage.step(&latched).sto_a_g);
    }
    voltage.step(&switch_on::Inputs {
        cvo: false,
        ..latched
    });
    let waits = switch_on::Inputs {
        chain: false,
        ..latched
    };
    for _ in 0..66 {
        assert_eq!(voltage.step(&waits).demand, Stop::None);
    }
    assert!(voltage.step(&latched).sto_a_g);
    let lost = switch_on::Inputs {
        cvo: false,
        ..latched
    };
    assert_eq!(voltage.step(&lost).demand, Stop::Ss1);
    let dropped = switch_on::Inputs {
        dropped: true,
        ..lost
    };
    assert!(!voltage.step(&dropped).sto_a_g);
}

/// HFS-TEST-013, HFS-STO-008: a brake that is supplied too early keeps the drives off; the signal of the spindles is off while
/// they stand behind an open door.
#[test]
fn control_voltage_needs_closed_brakes() {
    let mut voltage = switch_on::Monitor::new(switch_on::Config::STANDARD);
    let key = switch_on::Inputs {
        cvo: true,
        chain: true,
        t_brk: true,
        may_on: true,
        ..Default::default()
    };
    voltage.step(&switch_on::Inputs { cvo: false, ..key });
    for _ in 0..66 {
        assert_eq!(voltage.step(&key).demand, Stop::None);
    }
    let out = voltage.step(&key);
    assert!(out.fault && out.demand == Stop::Ss1 && !out.sto_a_g);
    let good = switch_on::Inputs {
        t_brk: false,
        ..key
    };
    voltage.step(&switch_on::Inputs { cvo: false, ..good });
    voltage.step(&good);
    let out = voltage.step(&good);
    assert!(out.sto_a_g && out.stos_a_g);
    let rests = switch_on::Inputs {
        spindle_rests: true,
        ..good
    };
    let out = voltage.step(&rests);
    assert!(out.sto_a_g && !out.stos_a_g);
    assert!(voltage.step(&good).stos_a_g);
}

/// HFS-API-032, HFS-API-039: which stop takes the outputs, and when.
#[test]
fn outputs_go_at_standstill_or_at_the_deadline() {
    let config = output_enable::Config::new(Cycles::new(2)).expect("plausible");
    let ready = output_enable::Inputs {
        ready: true,
        ..Default::default()
    };
    let stopping = |stop, emergency| output_enable::Inputs {
        stop,
        emergency,
        ..Default::default()
    };
    let mut outputs = output_enable::Monitor::new(config);
    assert!(!outputs.step(&stopping(Stop::None, false)).enabled);
    assert!(outputs.step(&ready).enabled);
    for _ in 0..5 {
        assert!(outputs.step(&stopping(Stop::Ss1, false)).enabled);
    }
    assert!(outputs.step(&stopping(Stop::Ss1, true)).enabled);
    assert!(outputs.step(&stopping(Stop::Ss1, true)).enabled);
    assert!(!outputs.step(&stopping(Stop::Ss1, true)).enabled);
    assert!(outputs.step(&ready).enabled);
    assert!(!outputs.step(&stopping(Stop::Ss0, false)).enabled);
}

/// SMP2172: 0 means 3 s.
#[test]
fn the_deadline_of_zero_is_three_seconds() {
    let time = |seconds| output_enable::Config::from_smp2172(seconds).map(|c| c.t_off());
    assert_eq!(time(0), Ok(Cycles::new(1000)));
    assert_eq!(time(1), Ok(Cycles::new(333)));
    assert_eq!(time(60), Ok(Cycles::new(20_000)));
    assert_eq!(time(61), Err(ConfigError::DelayTooLong));
}
