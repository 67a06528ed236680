//! The arbitration along the traces of the manual.

use super::*;

fn arbiter(hysteresis: bool) -> Monitor {
    let [t_b, t_c, t_d, t_e, t_f] = [3, 4, 2, 2, 2].map(Cycles::new);
    Monitor::new(Config::new(t_b, t_c, t_d, t_e, t_f, false, hysteresis).expect("short times"))
}

fn request(request: Stop) -> Inputs {
    Inputs {
        request,
        ..Inputs::default()
    }
}

/// S120-STOP-502, S120-STOP-514, S120-STOP-501: the traces of SLS with STOP C, and of a violated SOS after it.
#[test]
fn stop_c_ends_in_sos_and_a_violated_sos_in_stop_a() {
    let mut arbiter = arbiter(false);
    let watched = Inputs {
        function: Function::Watching,
        ..request(Stop::C)
    };
    assert!(arbiter.step(&watched).off3);
    for _ in 0..3 {
        assert!(
            arbiter.step(&watched).off3,
            "repeated requests restart nothing"
        );
    }
    let held = arbiter.step(&request(Stop::None));
    assert!(held.sos && held.setpoint_zero && !held.off3);
    let violated = arbiter.step(&request(Stop::B));
    assert!(violated.off3 && violated.initiated == Stop::B);
    arbiter.step(&request(Stop::None));
    assert!(arbiter.step(&request(Stop::None)).off3);
    let ended = arbiter.step(&request(Stop::None));
    assert!(ended.pulses_off && ended.initiated == Stop::A);
}

/// S120-STOP-506, S120-STOP-523: a function selected later triggers the follow-up (9403); STO prevents it.
#[test]
fn stop_f_waits_for_a_monitored_function() {
    let mut arbiter = arbiter(false);
    let difference = Inputs {
        difference: true,
        ..Inputs::default()
    };
    assert!(arbiter.step(&difference).fault);
    for _ in 0..5 {
        assert_eq!(arbiter.step(&Inputs::default()).stop, Stop::None);
    }
    let function = |function| Inputs {
        function,
        ..Inputs::default()
    };
    assert_eq!(arbiter.step(&function(Function::Sto)).stop, Stop::None);
    assert_eq!(arbiter.step(&function(Function::Ss1)).stop, Stop::None);
    assert_eq!(arbiter.step(&function(Function::Watching)).stop, Stop::B);
}

/// S120-STOP-501, S120-ACK-506: as SS1, which cannot be interrupted (2377): the braking comes to its end, and only then is it
/// acknowledged.
#[test]
fn an_acknowledgement_does_not_end_the_braking() {
    let acknowledge = Inputs {
        acknowledge: true,
        ..Inputs::default()
    };
    for (stop, cycles) in [(Stop::B, 3), (Stop::C, 4), (Stop::D, 2), (Stop::E, 2)] {
        let mut arbiter = arbiter(false);
        arbiter.step(&request(stop));
        for _ in 1..cycles {
            assert_eq!(arbiter.step(&acknowledge).stop, stop);
        }
        let ended = arbiter.step(&acknowledge);
        assert!(
            ended.sos || (stop == Stop::B && ended.pulses_off),
            "{stop:?}"
        );
        assert_eq!(arbiter.step(&acknowledge).stop, Stop::None);
    }
}
