//! Requests of the safe PLC as the kernel of HEIDENHAIN Functional Safety takes them over.

use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Som, Stop};
use stillpoint_monitors::heidenhain::{both_channels, both_fields, gate, general_fields};

fn take(kind: Kind, inputs: gate::Inputs) -> gate::Outputs {
    gate::Monitor::new(gate::Config::new(kind).expect("plausible")).step(&inputs)
}

fn set_up() -> gate::Inputs {
    gate::Inputs {
        state_code: GroupState::Sls2.code(),
        som_code: 1,
        activate: true,
        permissive: true,
        ..Default::default()
    }
}

/// HFS-API-001: set-up with the door open, as the safe PLC of a milling machine asks for it.
#[test]
fn a_legal_request_is_taken_over() {
    let out = take(Kind::NcAxes, set_up());
    assert_eq!((out.request, out.stop), (GroupState::Sls2, Stop::None));
    assert_eq!(out.som, Som::Som2);
    assert!(out.starts && out.held);
}

/// HFS-FAULT-001, HFS-FAULT-006: each field in turn.
#[test]
fn an_unknown_code_is_a_fatal_fault() {
    for broken in [
        gate::Inputs {
            state_code: 8,
            ..set_up()
        },
        gate::Inputs {
            stop_code: 5,
            ..set_up()
        },
        gate::Inputs {
            som_code: 200,
            ..set_up()
        },
    ] {
        let out = take(Kind::NcAxes, broken);
        assert_eq!(out.stop, Stop::Ss1F, "{broken:?}");
        assert!(!out.starts && !out.held, "{broken:?}");
    }
}

/// HFS-FAULT-008/a: restricted spindle operation for a spindle only.
#[test]
fn restricted_operation_is_for_spindles() {
    let inputs = gate::Inputs {
        state_code: GroupState::SlsS.code(),
        ..set_up()
    };
    assert_eq!(take(Kind::Spindle, inputs).stop, Stop::None);
    for kind in [Kind::NcAxes, Kind::Auxiliary] {
        assert_eq!(take(kind, inputs).stop, Stop::Ss1F);
    }
}

/// HFS-FAULT-008, second half (4.8.24): a spindle group that asks for SLI of axes. The interface has no constant for it (8.10.4), so
/// whatever code an embedding sends for it is none of those for a spindle.
#[test]
fn increments_of_axes_are_not_for_spindles() {
    for code in 8..=u8::MAX {
        let inputs = gate::Inputs {
            state_code: code,
            ..set_up()
        };
        let out = take(Kind::Spindle, inputs);
        assert_eq!(out.stop, Stop::Ss1F, "code {code}");
        assert!(!out.starts && !out.held, "code {code}");
    }
}

/// HFS-KDV-005: the door opens, and the program of channel A sees it first.
#[test]
fn the_stricter_channel_counts_until_both_agree() {
    let mut both = both_channels::Monitor::new(both_channels::Config);
    let mut inputs = both_channels::Inputs {
        request_mc: GroupState::Sos,
        request_cc: GroupState::Auto,
        starts_mc: false,
        starts_cc: true,
        ..Default::default()
    };
    let out = both.step(&inputs);
    assert_eq!((out.request, out.stop), (GroupState::Sos, Stop::None));
    assert!(out.differ && !out.starts);
    inputs.late = true;
    assert_eq!(both.step(&inputs).stop, Stop::Ss1);
}

/// HFS-KDV-002/a, HFS-KDV-005: not only the requests for a group are compared, but every general field of 8.9.5.
#[test]
fn every_general_field_is_compared() {
    let all = general_fields::Outputs {
        stop: Stop::None,
        som: Som::Som2,
        voltage: true,
        drives: true,
        chain: true,
        keys: true,
        brakes: true,
        feed: true,
    };
    let mut both = both_fields::Monitor::new(both_fields::Config);
    let mut look = |cc| both.step(&both_fields::Inputs { mc: all, cc });
    let out = look(all);
    assert!(!out.differ && out.voltage && out.drives && out.chain && out.feed);
    assert_eq!((out.som, out.stop), (Som::Som2, Stop::None));
    let som = Som::Som3;
    assert!(look(general_fields::Outputs { som, ..all }).som == Som::Som1);
    let others: [fn(&mut general_fields::Outputs); 8] = [
        |f| f.som = Som::Som3,
        |f| f.voltage = false,
        |f| f.drives = false,
        |f| f.chain = false,
        |f| f.keys = false,
        |f| f.brakes = false,
        |f| f.feed = false,
        |f| f.stop = Stop::Ss1F,
    ];
    for (field, change) in others.into_iter().enumerate() {
        let mut cc = all;
        change(&mut cc);
        assert!(look(cc).differ, "field {field}");
    }
    let none = look(general_fields::Outputs::default());
    assert!(!none.voltage && !none.drives && !none.chain && !none.feed && none.keys);
}
