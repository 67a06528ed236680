//! Monitors of the control part wired to each other: from the signals of a machine to its torque and back.

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::telegram::control::ControlWord2;
use stillpoint_monitors::sinamics::telegram::frame::{Received, Telegram};
use stillpoint_monitors::sinamics::{
    acknowledgement, acknowledgement_edge, communication, fail_safe_input, restart, stop_arbiter,
};

/// A drive with Extended Functions over PROFIsafe, without SS1.
struct Drive {
    link: communication::Monitor,
    edge: acknowledgement_edge::Monitor,
    acknowledgement: acknowledgement::Monitor,
    arbiter: stop_arbiter::Monitor,
    restart: restart::Monitor,
}

/// What a cycle shows.
struct Shown {
    torque: bool,
    stop: Stop,
    event: bool,
}

impl Drive {
    fn new(esr: u32) -> Self {
        let link = communication::Config::new(Cycles::new(3), Cycles::new(esr), true, false);
        let [t_b, t_c, t_d, t_e, t_f] = [5, 4, 3, 3, 2].map(Cycles::new);
        let arbiter = stop_arbiter::Config::new(t_b, t_c, t_d, t_e, t_f, false, false);
        Self {
            link: communication::Monitor::new(link.expect("a watchdog")),
            edge: acknowledgement_edge::Monitor::new(acknowledgement_edge::Config),
            acknowledgement: acknowledgement::Monitor::new(acknowledgement::Config::new(
                false, true, false,
            )),
            arbiter: stop_arbiter::Monitor::new(arbiter.expect("short times")),
            restart: restart::Monitor::new(restart::Config),
        }
    }

    /// One cycle: a telegram 31 or none, ON/OFF1, and the stop that a monitor requests.
    fn cycle(&mut self, telegram: Option<ControlWord2>, on: bool, request: Stop) -> Shown {
        let bytes = telegram.map(|word| Received::T31(word).encode());
        let received = bytes.map(|frame| Received::decode(Telegram::T31, frame.bytes()));
        // Substitute values select everything.
        let word = match received {
            Some(Ok(Received::T31(word))) => word,
            _ => ControlWord2::default(),
        };
        let edge = self.edge.step(&acknowledgement_edge::Inputs {
            power_on: false,
            valid: telegram.is_some(),
            stable: true,
            level: word.internal_event_ack,
        });
        let link = self.link.step(&communication::Inputs {
            telegram: telegram.is_some(),
            acknowledge: edge.acknowledge,
            ..communication::Inputs::default()
        });
        let requested = request.max(link.request);
        let told = self.acknowledgement.step(&acknowledgement::Inputs {
            profisafe_edge: edge.acknowledge,
            message: requested != Stop::None,
            ..acknowledgement::Inputs::default()
        });
        let sto = !word.sto;
        let arbiter = self.arbiter.step(&stop_arbiter::Inputs {
            request: requested,
            function: if sto { Function::Sto } else { Function::None },
            acknowledge: told.acknowledge,
            standstill: true,
            ..stop_arbiter::Inputs::default()
        });
        let restart = self.restart.step(&restart::Inputs {
            sto: sto || arbiter.pulses_off,
            latched: arbiter.blocks_run,
            on,
            enabled: true,
            power_on: false,
        });
        Shown {
            torque: restart.torque,
            stop: arbiter.stop,
            event: told.event,
        }
    }
}

/// Everything deselected; the acknowledgement as given.
fn word(internal_event_ack: bool) -> Option<ControlWord2> {
    Some(ControlWord2 {
        internal_event_ack,
        ..ControlWord2::decode(u32::MAX)
    })
}

fn started(esr: u32) -> Drive {
    let mut drive = Drive::new(esr);
    for on in [false, true, false, true] {
        drive.cycle(word(false), on, Stop::None);
    }
    assert!(drive.cycle(word(false), true, Stop::None).torque);
    drive
}

/// S120-COMM-500, S120-COMM-506, S120-ACK-515, S120-PSAFE-505, S120-PSAFE-526: a failure takes the torque; its end gives nothing back.
#[test]
fn a_failure_needs_acknowledgement_and_both_edges() {
    let mut drive = started(0);
    for _ in 0..4 {
        drive.cycle(None, true, Stop::None);
    }
    let failed = drive.cycle(None, true, Stop::None);
    assert!(!failed.torque && failed.stop == Stop::A && failed.event);
    // Communication is back, with the acknowledgement at 1 from before: no edge.
    for _ in 0..5 {
        assert_eq!(drive.cycle(word(true), true, Stop::None).stop, Stop::A);
    }
    assert_eq!(drive.cycle(word(false), true, Stop::None).stop, Stop::A);
    assert_eq!(drive.cycle(word(true), true, Stop::None).stop, Stop::A);
    let acknowledged = drive.cycle(word(false), true, Stop::None);
    assert!(acknowledged.stop == Stop::None && !acknowledged.event);
    for _ in 0..5 {
        assert!(!drive.cycle(word(false), true, Stop::None).torque);
    }
    drive.cycle(word(false), false, Stop::None);
    assert!(drive.cycle(word(false), true, Stop::None).torque);
}

/// S120-STOP-525, S120-ACK-504, S120-STOP-511: STO selected and deselected over a latched stop gives no torque back.
#[test]
fn selecting_sto_acknowledges_nothing() {
    let mut drive = started(0);
    let stopped = drive.cycle(word(false), true, Stop::B);
    assert!(stopped.stop == Stop::A && !stopped.torque);
    drive.cycle(Some(ControlWord2::default()), true, Stop::None);
    for on in [true, false, true, false, true] {
        let shown = drive.cycle(word(false), on, Stop::None);
        assert!(!shown.torque && shown.stop == Stop::A && shown.event);
    }
}

/// S120-ACK-514, S120-FDI-502: one broken input of the acknowledging F-DI neither acknowledges nor stays unseen.
#[test]
fn a_broken_input_does_not_acknowledge() {
    let config = fail_safe_input::Config::new(Cycles::new(3), false, false).expect("some");
    let mut input = fail_safe_input::Monitor::new(config);
    let mut edge = acknowledgement_edge::Monitor::new(acknowledgement_edge::Config);
    let mut step = |input1, input2| {
        let read = input.step(&fail_safe_input::Inputs {
            input1,
            input2,
            ..fail_safe_input::Inputs::default()
        });
        let edge = edge.step(&acknowledgement_edge::Inputs {
            power_on: false,
            valid: true,
            stable: read.stable,
            level: read.value,
        });
        (edge.acknowledge, read.fault)
    };
    assert_eq!([step(false, false), step(true, true)], [(false, false); 2]);
    let broken = [(); 4].map(|()| step(false, true));
    assert_eq!(broken.map(|(acknowledge, _)| acknowledge), [false; 4]);
    assert_eq!(broken.map(|(_, fault)| fault), [false, false, false, true]);
    let fresh = [(true, true), (true, false), (false, false)].map(|(a, b)| step(a, b).0);
    assert_eq!(fresh, [false; 3], "what is latched is no edge");
}
