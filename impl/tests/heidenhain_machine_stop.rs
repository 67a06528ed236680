//! The groups of a machine in both channels, wired as an embedding wires them: what one stop makes of the rest.

use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Phase, Stop};
use stillpoint_monitors::heidenhain::{
    agreement, both_status, channel, gate, global_sto, group, neighbour, output_enable, stop,
    switch_on,
};
use stillpoint_monitors::kernel::Cycles;

const AXES: usize = 0;
const SPINDLE: usize = 1;
const MAGAZINE: usize = 2;

const MC: usize = 0;
const CC: usize = 1;

const GROUPS: [Kind; 3] = [Kind::NcAxes, Kind::Spindle, Kind::Auxiliary];

/// NC axes, a spindle that waits for them (SMP610), a magazine; each in both channels.
struct Machine {
    monitors: [[channel::Monitor; 2]; 3],
    seen: [[channel::Outputs; 2]; 3],
    request: [GroupState; 3],
    moving: [bool; 3],
    switch_on: bool,
}

impl Machine {
    /// Every group moves in the state that is requested for it.
    fn running(request: [GroupState; 3]) -> Self {
        let monitor = |g: usize, cc: bool| {
            let [t_ss1, t_ss2, t_brake] = [6, 4, 1].map(Cycles::new);
            let times = stop::Config::new(cc, t_ss1, t_ss2, t_brake).expect("plausible");
            let config =
                channel::Config::new(GROUPS[g], true, times, Cycles::new(9)).expect("plausible");
            let state = channel::State {
                group: group::State {
                    state: request[g],
                    ..group::State::INITIAL
                },
                ..channel::State::INITIAL
            };
            channel::Monitor::resume(config, state).expect("consistent")
        };
        let seen = |g: usize| channel::Outputs {
            taken: gate::Outputs {
                request: request[g],
                ..gate::Outputs::default()
            },
            ..channel::Outputs::default()
        };
        Self {
            monitors: [0, 1, 2].map(|g| [monitor(g, false), monitor(g, true)]),
            seen: [0, 1, 2].map(|g| [seen(g); 2]),
            request,
            moving: [true; 3],
            switch_on: false,
        }
    }

    /// What the other groups of a channel make of one.
    fn of_the_others(&self, own: usize, channel: usize) -> Stop {
        (0..3)
            .filter(|g| *g != own)
            .map(|g| {
                let stop = self.seen[g][channel].stop;
                let listed = g == SPINDLE && own == AXES;
                let config = neighbour::Config::new(listed).expect("plausible");
                let inputs = neighbour::Inputs {
                    level: stop.level,
                    phase: stop.phase,
                    wide: stop.wide,
                };
                neighbour::Monitor::new(config).step(&inputs).demand
            })
            .fold(Stop::None, Stop::max)
    }

    /// One cycle; `found` is what the monitors of one channel find for one group, `asked` what both safe PLCs ask of it.
    fn step(&mut self, group: usize, channel: usize, found: Stop, asked: u8) {
        let before = self.seen;
        let mut after = before;
        for g in 0..3 {
            for c in [MC, CC] {
                let other = &before[g][1 - c];
                let here = g == group;
                let inputs = channel::Inputs {
                    fields: gate::Inputs {
                        state_code: self.request[g].code(),
                        stop_code: if here { asked } else { 0 },
                        ..gate::Inputs::default()
                    },
                    peer: other.taken,
                    moving: self.moving[g],
                    gen_safe: true,
                    monitors: if here && c == channel {
                        found
                    } else {
                        Stop::None
                    },
                    told: other.tells,
                    machine: self.of_the_others(g, c),
                    listed_still: g != SPINDLE || !self.moving[AXES],
                    peer_off: other.stop.torque_off,
                    permit: self.switch_on,
                    voltage: self.switch_on,
                    ..channel::Inputs::default()
                };
                after[g][c] = self.monitors[g][c].step(&inputs);
            }
        }
        self.seen = after;
    }

    fn quiet(&mut self) {
        self.step(AXES, MC, Stop::None, 0);
    }

    fn level(&self, group: usize) -> [Stop; 2] {
        self.seen[group].map(|out| out.stop.level)
    }
}

/// HFS-SS0-004, HFS-SS1F-001, HFS-SS1F-002: an axis that creeps in its operating stop loses its torque, found by the MC alone.
/// Two cycles later every drive of the machine is on the emergency ramp of SS1F or has no torque.
#[test]
fn an_ss0_of_one_group_is_ss1f_of_all_others() {
    let mut machine = Machine::running([GroupState::Auto; 3]);
    machine.step(AXES, MC, Stop::Ss0, 0);
    assert_eq!(machine.level(AXES)[MC], Stop::Ss0);
    assert!(machine.seen[AXES][MC].torque_off);
    machine.quiet();
    assert_eq!(machine.level(SPINDLE)[MC], Stop::Ss1F);
    assert!(machine.seen[SPINDLE][MC].stop.emergency_ramp);
    machine.quiet();
    assert_eq!(machine.level(AXES), [Stop::Ss0; 2]);
    for group in [SPINDLE, MAGAZINE] {
        assert_eq!(machine.level(group), [Stop::Ss1F; 2]);
        assert!(!machine.seen[group][CC].torque_off, "it needs it to brake");
    }
}

/// HFS-SS0-006, HFS-SBC-002: -STO.A.G stays on while the others brake, and takes torque and brakes of all when they have ended.
#[test]
fn sto_for_all_waits_for_the_others() {
    let mut machine = Machine::running([GroupState::Auto; 3]);
    let config = global_sto::Config::new(Cycles::new(1000)).expect("plausible");
    let mut signal = global_sto::Monitor::new(config);
    let mut on_for = 0;
    for cycle in 0..20 {
        let found = if cycle == 0 { Stop::Ss0 } else { Stop::None };
        machine.step(AXES, MC, found, 0);
        machine.moving = [true, cycle < 4, cycle < 4];
        let off = |g: usize| machine.seen[g].iter().all(|out| out.stop.torque_off);
        let inputs = global_sto::Inputs {
            ss0: machine.level(AXES)[MC] == Stop::Ss0,
            others_off: off(SPINDLE) && off(MAGAZINE),
        };
        let on = signal.step(&inputs).on;
        assert_eq!(on, !inputs.others_off, "cycle {cycle}");
        on_for += usize::from(on);
    }
    assert!((5..15).contains(&on_for), "{on_for}");
}

/// HFS-SS0-003/a, HFS-SS0-003/b, HFS-SS0-003/c: the signals of an SS0, whichever channel finds it: its own torque and brakes at once, those of the other channel a
/// cycle later, the permission for outputs at the beginning, and -STO.A.G with -STOS.A.G when the others have no torque either.
#[test]
fn an_ss0_sets_every_signal_of_its_pattern() {
    for finder in [MC, CC] {
        let mut machine = Machine::running([GroupState::Auto; 3]);
        let times = global_sto::Config::new(Cycles::new(1000)).expect("plausible");
        let mut all = global_sto::Monitor::new(times);
        let running = switch_on::State {
            voltage: switch_on::Voltage::On,
            ..switch_on::State::INITIAL
        };
        let mut voltage =
            switch_on::Monitor::resume(switch_on::Config::STANDARD, running).expect("consistent");
        let latest = output_enable::Config::new(Cycles::new(1000)).expect("plausible");
        let mut outputs = output_enable::Monitor::new(latest);
        let ready = output_enable::Inputs {
            ready: true,
            ..Default::default()
        };
        assert!(outputs.step(&ready).enabled);
        for cycle in 0..20 {
            let found = if cycle == 0 { Stop::Ss0 } else { Stop::None };
            machine.step(AXES, finder, found, 0);
            machine.moving = [true, cycle < 4, cycle < 4];
            for channel in [MC, CC] {
                let out = &machine.seen[AXES][channel];
                let off = cycle > 0 || channel == finder;
                assert_eq!((out.stop.torque_off, out.stop.brake_closed), (off, off));
            }
            let ss0 = machine.level(AXES)[MC] == Stop::Ss0;
            let enabled = outputs.step(&output_enable::Inputs {
                stop: machine.level(AXES)[MC],
                ..Default::default()
            });
            assert_eq!(enabled.enabled, !ss0, "at the beginning");
            let off = |g: usize| machine.seen[g].iter().all(|out| out.stop.torque_off);
            let others_off = off(SPINDLE) && off(MAGAZINE);
            let on = all.step(&global_sto::Inputs { ss0, others_off }).on;
            let signals = voltage.step(&switch_on::Inputs {
                cvo: true,
                chain: true,
                dropped: !on,
                ..Default::default()
            });
            assert_eq!(
                (signals.sto_a_g, signals.stos_a_g),
                (!others_off, !others_off)
            );
        }
        assert!(!all.state().on, "the others have ended");
    }
}

/// HFS-SS0-006, HFS-PARAM-021: and SMP2172 after the SS0 at the latest, also where a drive never ends.
#[test]
fn sto_for_all_falls_after_smp2172() {
    let config = global_sto::Config::new(Cycles::new(3)).expect("plausible");
    let mut signal = global_sto::Monitor::new(config);
    let ss0 = global_sto::Inputs {
        ss0: true,
        others_off: false,
    };
    let on: Vec<bool> = (0..5).map(|_| signal.step(&ss0).on).collect();
    assert_eq!(on, [true, true, true, false, false]);
}

/// HFS-AXG-016: what is asked of the axes, SS2 or SS1, leaves spindle and magazine running.
#[test]
fn a_requested_stop_stays_with_its_group() {
    for (code, level) in [(1, Stop::Ss2), (3, Stop::Ss1)] {
        let mut machine = Machine::running([GroupState::Auto; 3]);
        machine.step(AXES, MC, Stop::None, code);
        assert_eq!(machine.level(AXES), [level; 2]);
        machine.quiet();
        machine.quiet();
        for group in [SPINDLE, MAGAZINE] {
            assert_eq!(machine.level(group), [Stop::None; 2], "{level:?}");
        }
    }
}

/// HFS-SS1-001: an SS1 that the kernel finds is one of the whole machine.
#[test]
fn an_ss1_that_is_found_is_one_of_the_machine() {
    let mut machine = Machine::running([GroupState::Auto; 3]);
    machine.step(MAGAZINE, CC, Stop::Ss1, 0);
    machine.quiet();
    machine.quiet();
    for group in [AXES, SPINDLE, MAGAZINE] {
        assert_eq!(machine.level(group), [Stop::Ss1; 2]);
    }
}

/// HFS-KDV-001, HFS-KDV-002/d: the program of the CC is no longer executed, while its last requests stand. The kernel of either
/// channel finds it when the window of 22 cycles has passed, and every group stops by SS1 in both channels.
#[test]
fn a_program_executed_in_one_channel_only_stops_the_machine() {
    for finder in [MC, CC] {
        let mut machine = Machine::running([GroupState::Auto; 3]);
        let mut compared = both_status::Monitor::new(both_status::Config);
        let mut window = agreement::Monitor::new(agreement::Config::PUBLISHED);
        let mc = both_status::Status {
            executed: true,
            ..both_status::Status::default()
        };
        for cycle in 1..=26 {
            let cc = both_status::Status {
                executed: cycle <= 2,
                ..mc
            };
            let status = compared.step(&both_status::Inputs { mc, cc });
            assert_eq!(status.stop, Stop::None);
            let late = window.step(&agreement::Inputs {
                differ: status.differ,
            });
            machine.step(AXES, finder, late.demand, 0);
            if cycle < 24 {
                assert_eq!(machine.level(AXES), [Stop::None; 2], "cycle {cycle}");
            }
        }
        for group in [AXES, SPINDLE, MAGAZINE] {
            assert_eq!(machine.level(group), [Stop::Ss1; 2]);
        }
    }
}

/// HFS-KDV-002/c, HFS-KDV-002/e, HFS-FAULT-019: an output that reads back in one channel only is a difference, whichever it is; an
/// SS1F that one run-time system asks for does not wait for the window.
#[test]
fn outputs_and_run_time_systems_are_compared() {
    let mut compared = both_status::Monitor::new(both_status::Config);
    let mc = both_status::Status {
        executed: true,
        outputs: 0x8001,
        ..both_status::Status::default()
    };
    let mut look = |cc| compared.step(&both_status::Inputs { mc, cc });
    assert!(!look(mc).differ);
    for bit in 0..16 {
        let outputs = mc.outputs ^ 1 << bit;
        let out = look(both_status::Status { outputs, ..mc });
        assert!(out.differ && out.stop == Stop::None, "output {bit}");
    }
    let out = look(both_status::Status {
        runtime: true,
        ..mc
    });
    assert!(out.differ && out.stop == Stop::Ss1F);
}

/// HFS-SS2-010: the spindle turns without its permissive behind an open door. The axes get SS2, and the spindle its SS1 after
/// they stand.
#[test]
fn a_running_spindle_is_stopped_after_its_axes() {
    let state = [GroupState::Sls2, GroupState::Sls2, GroupState::Auto];
    let mut machine = Machine::running(state);
    machine.quiet();
    assert_eq!(machine.level(SPINDLE), [Stop::Ss1D; 2]);
    assert!(machine.seen[SPINDLE][MC].stops_axes);
    machine.quiet();
    assert_eq!(machine.level(AXES), [Stop::Ss2; 2]);
    for out in machine.seen[SPINDLE] {
        assert_eq!(out.stop.phase, Phase::Ss1DWait);
    }
    machine.moving[AXES] = false;
    machine.quiet();
    for out in machine.seen[SPINDLE] {
        assert_eq!(out.stop.phase, Phase::EmergencyBrake);
    }
    assert_eq!(machine.level(MAGAZINE), [Stop::None; 2]);
}

/// HFS-STOP-012: the MC is without torque after an SS1, the CC has been switched on again. What the MC finds then stops the CC.
#[test]
fn a_channel_without_torque_tells_of_a_further_cause() {
    let mut machine = Machine::running([GroupState::Auto; 3]);
    machine.step(AXES, MC, Stop::None, 3);
    machine.moving = [false; 3];
    for _ in 0..6 {
        machine.quiet();
    }
    assert!(machine.seen[AXES].iter().all(|out| out.stop.torque_off));
    assert_eq!(machine.seen[AXES].map(|out| out.tells), [Stop::None; 2]);
    // The MC finds the cause in the cycle in which both are switched on: it stays off itself.
    machine.switch_on = true;
    machine.step(AXES, MC, Stop::Ss1, 0);
    assert!(machine.seen[AXES][MC].stop.torque_off);
    assert!(machine.seen[AXES][CC].stop.restarted);
    assert_eq!(machine.seen[AXES][MC].tells, Stop::Ss1);
    machine.quiet();
    assert_eq!(machine.level(AXES)[CC], Stop::Ss1);
    assert!(!machine.seen[AXES][CC].group.may_move);
}
