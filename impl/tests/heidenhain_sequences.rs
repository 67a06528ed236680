//! The sample sequences of the manual (8.11), step by step: the program of a safe PLC and the kernel of one channel for the three
//! groups of a milling machine, in the order of a cycle.

use stillpoint_monitors::heidenhain::key_filter::{self, Keys};
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Phase, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{axis_release, channel, gate, safe_plc, stop};
use stillpoint_monitors::kernel::Cycles;

const A: usize = 0;
const S: usize = 1;
const T: usize = 2;

/// Safe PLC and kernel; the test sets keys and motion.
struct Machine {
    plc: safe_plc::State,
    config: safe_plc::Config,
    inputs: safe_plc::Inputs,
    /// What the program asked for in the last cycle.
    asked: safe_plc::Outputs,
    groups: [channel::Monitor; 3],
    axes: [axis_release::Monitor; 2],
    /// Which axes of the first group move; the others have one drive each.
    axis_moves: [bool; 2],
    moves: [bool; 3],
    permit: bool,
}

impl Machine {
    /// Doors as given, SOM_2, drives switched on and standing.
    fn new(door_open: bool, t_open: bool, hold: bool) -> Self {
        Self::in_mode(Som::Som2, door_open, t_open, hold)
    }

    fn in_mode(som: Som, door_open: bool, t_open: bool, hold: bool) -> Self {
        let group = |kind| {
            let t = Cycles::new(50);
            let stop = stop::Config::new(true, t, t, Cycles::new(1)).expect("plausible");
            let config = channel::Config::new(kind, true, stop, Cycles::new(1000));
            channel::Monitor::new(config.expect("plausible"))
        };
        let axis = axis_release::Config::new(Cycles::new(50)).expect("plausible");
        let mut machine = Self {
            plc: safe_plc::State::INITIAL,
            config: safe_plc::Config::new(Cycles::new(4), hold, false).expect("plausible"),
            inputs: safe_plc::Inputs {
                keys: key_filter::Inputs {
                    door_open,
                    t_open,
                    ..Default::default()
                },
                som,
                gen_safe: true,
                ..Default::default()
            },
            asked: safe_plc::Outputs::default(),
            groups: [
                group(Kind::NcAxes),
                group(Kind::Spindle),
                group(Kind::Auxiliary),
            ],
            axes: [axis_release::Monitor::new(axis); 2],
            axis_moves: [false; 2],
            moves: [false; 3],
            permit: false,
        };
        machine.cycle();
        machine.permit = true;
        machine.cycle();
        machine.cycle();
        machine
    }

    fn cycle(&mut self) {
        self.moves[A] = self.axis_moves.contains(&true);
        self.inputs.axes_state = self.state(A);
        self.inputs.magazine_moving = self.moves[T];
        (self.plc, self.asked) = safe_plc::next(self.plc, &self.config, &self.inputs);
        let at_rest = self.step_axes();
        let asked = self.asked;
        let requests = [
            (
                asked.axes.request,
                asked.axes.stop,
                asked.axes.activate,
                asked.axes.permissive,
            ),
            (
                asked.spindle.request,
                asked.spindle.stop,
                asked.spindle.activate,
                asked.spindle.permissive,
            ),
            (
                asked.magazine.request,
                asked.magazine.stop,
                asked.magazine.activate,
                asked.magazine.permissive,
            ),
        ];
        for (k, (request, stop, activate, permissive)) in requests.into_iter().enumerate() {
            let fields = gate::Inputs {
                state_code: request.code(),
                stop_code: stop as u8,
                som_code: self.inputs.som as u8,
                activate,
                permissive,
            };
            let group = &mut self.groups[k];
            let kind = gate::Config::new(group.config().kind()).expect("plausible");
            let (_, peer) = gate::next(gate::State::INITIAL, &kind, &fields);
            group.step(&channel::Inputs {
                fields,
                peer,
                moving: self.moves[k],
                unit: self.inputs.keys.unit,
                gen_safe: true,
                at_rest: k == A && at_rest,
                // The spindle waits for the axes (SMP610).
                listed_still: k != S || !self.moves[A],
                permit: self.permit,
                voltage: true,
                ..Default::default()
            });
        }
    }

    /// The axes of the first group with their feed enables: whether the last one has come to rest.
    fn step_axes(&mut self) -> bool {
        let released = self.state(A).is_released();
        let mut rests = false;
        for (k, axis) in self.axes.iter_mut().enumerate() {
            let out = axis.step(&axis_release::Inputs {
                group_released: released,
                feed: self.asked.axes.feed >> k & 1 == 1,
                moving: self.axis_moves[k],
            });
            assert!(!out.asks_ss1, "axis {k} was not braked in time");
            rests |= out.stands;
        }
        let sos = |axis: &axis_release::Monitor| axis.state().mode == axis_release::Mode::Sos;
        rests && self.axes.iter().all(sos)
    }

    fn cycles(&mut self, count: usize) {
        (0..count).for_each(|_| self.cycle());
    }

    fn state(&self, group: usize) -> GroupState {
        self.groups[group].state().group.state
    }

    fn stop(&self, group: usize) -> (Stop, Phase) {
        let stop = self.groups[group].state().stop;
        (stop.level, stop.phase)
    }

    fn panel(&mut self) -> &mut Keys {
        &mut self.inputs.keys.panel
    }
}

const NO_STOP: (Stop, Phase) = (Stop::None, Phase::Run);
const SS2: (Stop, Phase) = (Stop::Ss2, Phase::Ss2Brake);

/// HFS-SEQ-001, HFS-API-019: jog with the permissive turns the spindle in SLS_2; its release asks for SS2 in one cycle of the
/// safe PLC, which the kernel keeps up until the spindle stands.
#[test]
fn spindle_jog() {
    let mut m = Machine::new(true, false, true);
    assert_eq!(m.state(S), GroupState::StoO);
    m.panel().jog = true;
    m.cycle();
    assert!(!m.asked.spindle.activate, "no permissive");
    m.panel().permissive = true;
    m.cycle();
    assert!(m.asked.spindle.activate);
    assert_eq!(m.state(S), GroupState::Sls2);
    m.moves[S] = true;
    m.cycles(3);
    assert_eq!((m.state(S), m.stop(S)), (GroupState::Sls2, NO_STOP));
    m.panel().jog = false;
    m.cycle();
    assert!(!m.asked.spindle.activate);
    assert_eq!(m.asked.spindle.stop, Stop::Ss2);
    m.cycle();
    assert_eq!(m.asked.spindle.stop, Stop::None, "one cycle");
    assert_eq!((m.state(S), m.stop(S)), (GroupState::Sls2, SS2));
    m.moves[S] = false;
    m.cycle();
    assert_eq!((m.state(S), m.stop(S)), (GroupState::StoO, NO_STOP));
}

/// HFS-SEQ-002: restricted operation goes on without permissive until the stop key; the start counts from its edge, while both
/// keys are held.
#[test]
fn spindle_start() {
    let mut m = Machine::new(true, false, true);
    m.inputs.restricted = true;
    m.panel().spindle_start = true;
    m.cycle();
    m.panel().permissive = true;
    m.cycle();
    assert!(!m.asked.spindle.activate, "the edge came before");
    m.panel().spindle_start = false;
    m.cycle();
    m.panel().spindle_start = true;
    m.cycles(2);
    assert!(m.asked.spindle.activate, "both are held");
    assert_eq!(m.state(S), GroupState::SlsS);
    m.moves[S] = true;
    m.panel().spindle_start = false;
    m.cycle();
    assert!(!m.asked.spindle.activate);
    m.panel().permissive = false;
    m.cycles(3);
    assert_eq!((m.state(S), m.stop(S)), (GroupState::SlsS, NO_STOP));
    m.inputs.keys.stop = true;
    m.cycle();
    assert_eq!(m.asked.spindle.stop, Stop::Ss2);
    m.inputs.keys.stop = false;
    m.cycle();
    assert_eq!((m.asked.spindle.stop, m.stop(S)), (Stop::None, SS2));
    m.moves[S] = false;
    m.cycle();
    assert_eq!(m.state(S), GroupState::StoO);
}

/// HFS-SEQ-002, HFS-API-026, HFS-PB-005: without restricted operation the kernel stops the spindle that loses its permissive in
/// SOM_2, which it knows by the field of the safe PLC; in SOM_4 at the panel it runs on.
#[test]
fn spindle_without_permissive() {
    for (som, runs) in [(Som::Som2, false), (Som::Som4, true)] {
        let mut m = Machine::in_mode(som, true, false, true);
        *m.panel() = Keys {
            permissive: true,
            spindle_start: true,
            ..Keys::NONE
        };
        m.cycle();
        m.moves[S] = true;
        m.panel().spindle_start = false;
        m.cycle();
        assert_eq!(m.stop(S), NO_STOP);
        m.panel().permissive = false;
        m.cycle();
        assert_eq!(m.stop(S) == NO_STOP, runs, "{som:?}");
    }
}

/// HFS-SEQ-003: a direction key moves its axis without permissive, and its release brakes that axis.
#[test]
fn nc_axis_by_its_key() {
    let mut m = Machine::new(true, false, true);
    assert_eq!(m.state(A), GroupState::Sos);
    m.panel().axes = 1;
    m.cycle();
    assert!(m.asked.axes.activate && m.asked.axes.feed == 1);
    assert_eq!(m.state(A), GroupState::Sls2);
    m.axis_moves[0] = true;
    m.cycles(2);
    m.panel().axes = 0;
    m.cycle();
    assert!(!m.asked.axes.activate && m.asked.axes.feed == 0);
    assert_eq!(m.asked.axes.stop, Stop::None, "the axis brakes by itself");
    assert_eq!(m.axes[0].state().mode, axis_release::Mode::Ss2);
    assert_eq!(m.state(A), GroupState::Sls2);
    m.axis_moves[0] = false;
    m.cycles(2);
    assert_eq!(m.state(A), GroupState::Sos);
}

/// HFS-SEQ-004: of two axes the one whose key is released stops alone; the group stays in SLS_3 until both stand.
#[test]
fn two_axes_released_one_after_the_other() {
    let mut m = Machine::new(true, false, true);
    m.inputs.som = Som::Som3;
    m.panel().axes = 0b11;
    m.cycle();
    m.axis_moves = [true; 2];
    m.cycles(2);
    m.panel().axes = 0b10;
    m.cycle();
    assert!(m.asked.axes.activate && m.asked.axes.feed == 0b10);
    m.axis_moves[0] = false;
    m.cycles(2);
    assert_eq!(m.axes[0].state().mode, axis_release::Mode::Sos);
    assert_eq!(m.axes[1].state().mode, axis_release::Mode::Released);
    assert_eq!(m.state(A), GroupState::Sls3);
    m.panel().axes = 0;
    m.cycle();
    m.axis_moves[1] = false;
    m.cycles(2);
    assert_eq!(m.state(A), GroupState::Sos);
}

/// HFS-SEQ-006, HFS-AXG-020, HFS-MODE-009: NC start in the design of HEIDENHAIN. The activation falls with the permissive, the
/// program goes on until NC stop.
#[test]
fn nc_start() {
    let mut m = Machine::new(true, false, false);
    *m.panel() = Keys {
        permissive: true,
        nc_start: true,
        ..Keys::NONE
    };
    m.cycle();
    assert!(m.asked.axes.activate && m.asked.axes.feed == u8::MAX);
    assert_eq!(m.state(A), GroupState::Sls2);
    m.axis_moves[0] = true;
    *m.panel() = Keys::NONE;
    m.cycles(8);
    assert!(!m.asked.axes.activate);
    assert_eq!(m.asked.axes.feed, u8::MAX);
    assert_eq!((m.state(A), m.stop(A)), (GroupState::Sls2, NO_STOP));
    m.inputs.keys.stop = true;
    m.cycle();
    assert_eq!(m.asked.axes.stop, Stop::Ss2);
    m.inputs.keys.stop = false;
    m.cycle();
    assert_eq!((m.asked.axes.stop, m.stop(A)), (Stop::None, SS2));
    m.axis_moves[0] = false;
    m.cycle();
    assert_eq!(m.state(A), GroupState::Sos);
    m.cycles(5);
    assert_eq!(m.asked.axes.feed, 0, "the program latch has fallen");
}

/// HFS-API-014, HFS-MODE-009, HFS-API-019: under EN 12417 the permissive that is released ends the program by one SS2 request.
#[test]
fn program_without_permissive_under_en_12417() {
    let mut m = Machine::new(true, false, true);
    *m.panel() = Keys {
        permissive: true,
        nc_start: true,
        ..Keys::NONE
    };
    m.cycle();
    m.axis_moves[0] = true;
    m.panel().nc_start = false;
    m.cycles(3);
    assert_eq!(m.stop(A), NO_STOP);
    m.panel().permissive = false;
    m.cycle();
    assert_eq!((m.asked.axes.stop, m.asked.axes.feed), (Stop::Ss2, 0));
    m.cycle();
    assert_eq!((m.asked.axes.stop, m.stop(A)), (Stop::None, SS2));
}

/// HFS-SEQ-006, HFS-API-040, HFS-MODE-008: a program started at the handwheel stops with the handwheel's permissive, which is
/// needed all the time in SOM_4 too.
#[test]
fn program_at_the_handwheel() {
    let mut m = Machine::in_mode(Som::Som4, true, false, true);
    m.inputs.keys.unit = Unit::Handwheel;
    m.cycle();
    m.inputs.keys.wheel = Keys {
        permissive: true,
        nc_start: true,
        ..Keys::NONE
    };
    m.cycle();
    assert!(m.asked.axes.activate && m.asked.axes.feed == u8::MAX);
    m.axis_moves[0] = true;
    m.inputs.keys.wheel.nc_start = false;
    m.cycles(3);
    assert_eq!(m.state(A), GroupState::Sls4);
    m.inputs.keys.wheel.permissive = false;
    m.cycle();
    assert_eq!(m.asked.axes.feed, 0);
    assert_ne!(
        (m.axes[0].state().mode, m.stop(A)),
        (axis_release::Mode::Released, NO_STOP)
    );
}

/// HFS-SEQ-007, HFS-API-022: the magazine door opens while axes and spindle move behind their open door. The axes
/// stop along the contour, then the spindle by SS1; the states end in SOS and STO_O.
#[test]
fn magazine_door_opens() {
    let mut m = Machine::new(true, false, true);
    *m.panel() = Keys {
        permissive: true,
        nc_start: true,
        spindle_start: true,
        ..Keys::NONE
    };
    m.cycle();
    (m.axis_moves[0], m.moves[S]) = (true, true);
    m.cycles(2);
    m.inputs.keys.t_open = true;
    m.cycle();
    assert!(!m.asked.axes.activate && !m.asked.spindle.activate);
    assert_eq!(
        (m.asked.axes.stop, m.asked.spindle.stop),
        (Stop::Ss2, Stop::Ss1D)
    );
    assert_eq!((m.state(A), m.stop(A)), (GroupState::Sls2, SS2));
    assert_eq!(m.stop(S), (Stop::Ss1D, Phase::Ss1DWait));
    assert_eq!(m.state(S), GroupState::Sls2);
    m.axis_moves[0] = false;
    m.cycles(2);
    assert_eq!(m.state(A), GroupState::Sos);
    assert_eq!(m.stop(S).1, Phase::EmergencyBrake);
    m.moves[S] = false;
    m.cycles(4);
    assert_eq!(m.state(S), GroupState::StoO);
    assert!(m.groups[S].state().stop.phase == Phase::TorqueOff || m.stop(S) == NO_STOP);
}

/// HFS-SEQ-008, HFS-MAG-003, HFS-API-023, HFS-MAG-005: the magazine by one key and its permissive, with its door open.
#[test]
fn magazine_by_hand() {
    let mut m = Machine::new(false, false, true);
    m.inputs.keys.confirm = true;
    m.cycle();
    m.inputs.keys.confirm = false;
    m.cycle();
    assert_eq!(m.state(T), GroupState::Auto);
    m.inputs.keys.t_open = true;
    m.cycles(2);
    assert_eq!(m.asked.magazine.request, GroupState::Sls2);
    assert_eq!(m.asked.magazine.stop, Stop::Ss2);
    assert_eq!(m.state(T), GroupState::Sos);
    m.panel().permissive = true;
    m.inputs.keys.t_keys = 1;
    m.cycle();
    assert_eq!(
        m.state(T),
        GroupState::Sos,
        "the permissive of the panel has no part in it"
    );
    m.inputs.keys.t_permissive = true;
    m.cycle();
    assert!(m.asked.magazine.activate && m.asked.magazine.stop == Stop::None);
    assert_eq!(m.state(T), GroupState::Sls2);
    m.moves[T] = true;
    m.cycle();
    m.inputs.keys.t_permissive = false;
    m.cycle();
    assert_eq!((m.asked.magazine.stop, m.stop(T)), (Stop::Ss2, SS2));
    m.moves[T] = false;
    m.cycles(2);
    assert_eq!(m.state(T), GroupState::Sos);
}

/// HFS-SEQ-008, HFS-MAG-002, HFS-API-019: its door opens while it moves: SS1, then torque off.
#[test]
fn magazine_door_opens_in_motion() {
    let mut m = Machine::new(false, false, true);
    m.inputs.keys.confirm = true;
    m.cycle();
    m.moves[T] = true;
    m.inputs.keys.t_open = true;
    m.cycle();
    assert_eq!(m.asked.magazine.stop, Stop::Ss1);
    m.cycle();
    assert_eq!(m.asked.magazine.stop, Stop::Ss2, "the kernel keeps the SS1");
    assert_eq!(m.stop(T), (Stop::Ss1, Phase::EmergencyBrake));
    m.moves[T] = false;
    m.cycles(4);
    assert_eq!(m.stop(T).1, Phase::TorqueOff);
    assert_eq!(m.state(T), GroupState::Sto);
}

/// HFS-API-006, HFS-API-010, HFS-API-013, HFS-SPLC-004: a key that is held while the door closes is a status that lasts, and
/// starts nothing; pressed anew it does, once.
#[test]
fn closing_the_door_starts_nothing() {
    let mut m = Machine::new(true, false, true);
    m.panel().nc_start = true;
    m.cycles(2);
    m.inputs.keys.door_open = false;
    m.cycles(5);
    assert!(!m.asked.axes.activate && !m.asked.spindle.activate);
    assert_eq!(m.state(A), GroupState::Sos);
    m.panel().nc_start = false;
    m.cycle();
    m.panel().nc_start = true;
    m.cycle();
    assert!(m.asked.axes.activate && m.asked.spindle.activate);
    m.panel().nc_start = false;
    m.cycles(5);
    assert_eq!(
        (m.state(A), m.state(S)),
        (GroupState::Auto, GroupState::Auto)
    );
}

/// HFS-AXG-016: what ends in SS2 concerns its group alone: the magazine runs on behind its closed door, while the axes behind
/// their open one are stopped by a key; and an SS1 of the magazine does not become one of the axes.
#[test]
fn stops_of_one_group_leave_the_others() {
    let mut m = Machine::new(false, false, true);
    m.inputs.keys.confirm = true;
    m.cycle();
    m.moves[T] = true;
    m.inputs.keys.door_open = true;
    m.cycle();
    m.panel().axes = 1;
    m.cycle();
    m.axis_moves[0] = true;
    m.inputs.keys.stop = true;
    m.cycle();
    assert_eq!(m.stop(A), SS2);
    assert_eq!((m.state(T), m.stop(T)), (GroupState::Auto, NO_STOP));
    m.axis_moves[0] = false;
    (m.panel().axes, m.inputs.keys.stop) = (0, false);
    m.cycles(3);
    assert_eq!(
        (m.state(A), m.state(T)),
        (GroupState::Sos, GroupState::Auto)
    );
    m.inputs.keys.t_open = true;
    m.cycle();
    assert_eq!(m.stop(T).0, Stop::Ss1, "its own door");
    assert!(m.stop(A).0 < Stop::Ss1);
}
