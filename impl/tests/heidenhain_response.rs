//! Response times of HEIDENHAIN Functional Safety: the monitors between signals that arrive on a grid of 200 us, at every phase of
//! the kernel's cycle of 3 ms.

use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Left, Som, Stop};
use stillpoint_monitors::heidenhain::{
    agreement, both_channels, button, cc_link, gate, group, som, speed, status_bits, stop,
};
use stillpoint_monitors::kernel::{Cycles, Position, Speed};

/// Steps of the grid in a cycle of the kernel.
const CYCLE: u32 = 15;

const fn ms(tenths: u32) -> u32 {
    tenths / 2
}

/// The kernel of one channel between an emergency stop and the drives of one group.
struct Kernel {
    cc: bool,
    stop: stop::Monitor,
    bits: status_bits::Monitor,
}

impl Kernel {
    /// SMP525 of 420 ms and MP2308 of 200 ms, rounded up to cycles.
    fn new(cc: bool) -> Self {
        let [t_ss1, t_ss2, t_brake] = [140, 1, 67].map(Cycles::new);
        let config = stop::Config::new(cc, t_ss1, t_ss2, t_brake).expect("plausible");
        Self {
            cc,
            stop: stop::Monitor::new(config),
            bits: status_bits::Monitor::new(status_bits::Config),
        }
    }

    fn step(&mut self, pressed: bool, still: bool, peer_off: bool) -> stop::Outputs {
        let bits = self.bits.step(&status_bits::Inputs {
            es_a: pressed && !self.cc,
            es_b: pressed && self.cc,
            ..Default::default()
        });
        self.stop.step(&stop::Inputs {
            demand: if self.cc { bits.cc } else { bits.mc },
            wide_cause: true,
            still,
            listed_still: true,
            peer_off,
            ..Default::default()
        })
    }
}

/// The moments, in steps of the grid after the button, at which something happened first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Moments {
    ss1_mc: u32,
    ss1_cc: u32,
    brake_cc: u32,
    off_cc: u32,
    off_mc: u32,
    ss0: u32,
}

/// Presses the button at step 0. The kernels step at `phase` and then every cycle. The status bits reach the MC after 0.2 ms, the
/// telegram reaches the CC after 6.6 ms; the drive stands `braking` steps after the CC has started its ramp, if ever.
fn emergency_stop(phase: u32, braking: Option<u32>) -> Moments {
    let (mut mc, mut cc) = (Kernel::new(false), Kernel::new(true));
    let mut seen = Moments::default();
    let note = |moment: &mut u32, happens: bool, now: u32| {
        if happens && *moment == 0 {
            *moment = now;
        }
    };
    let mut now = phase;
    while now < ms(6_000) {
        let stands = |start: u32| start > 0 && braking.is_some_and(|t| now >= start + t);
        let still = stands(seen.ss1_cc);
        let reported = seen.off_cc > 0;
        let b = cc.step(now >= ms(66), still, false);
        let a = mc.step(now >= ms(2), still, reported);
        note(&mut seen.ss1_mc, a.level >= Stop::Ss1, now);
        note(&mut seen.ss1_cc, b.level >= Stop::Ss1, now);
        note(&mut seen.brake_cc, b.brake_closed, now);
        note(&mut seen.off_cc, b.torque_off, now);
        note(&mut seen.off_mc, a.torque_off && a.brake_closed, now);
        note(
            &mut seen.ss0,
            a.level == Stop::Ss0 || b.level == Stop::Ss0,
            now,
        );
        now += CYCLE;
    }
    seen
}

/// The latest of each moment over all phases.
fn worst(braking: Option<u32>) -> Moments {
    (1..=CYCLE)
        .map(|phase| emergency_stop(phase, braking))
        .fold(Moments::default(), |worst, seen| Moments {
            ss1_mc: worst.ss1_mc.max(seen.ss1_mc),
            ss1_cc: worst.ss1_cc.max(seen.ss1_cc),
            brake_cc: worst.brake_cc.max(seen.brake_cc),
            off_cc: worst.off_cc.max(seen.off_cc),
            off_mc: worst.off_mc.max(seen.off_mc),
            ss0: worst.ss0.max(seen.ss0),
        })
}

/// HFS-TIMING-005/a, HFS-TIMING-006/a, HFS-TIMING-006/b: the SS1 begins in the cycle in which the signal arrives: at most 3.2 ms (MC) and 9.6 ms (CC)
/// after the button, and no more than a step of the grid earlier in the worst case.
#[test]
fn emergency_stop_starts_the_ss1_in_time() {
    let worst = worst(Some(ms(1_000)));
    assert_eq!(worst.ss1_mc, ms(32) - 1);
    assert_eq!(worst.ss1_cc, ms(96) - 1);
}

/// HFS-TIMING-005/b, HFS-TIMING-006/c, HFS-TIMING-006/d, HFS-TIMING-010, HFS-TIMING-011: 100 ms later the drive stands; the CC closes the brake in its next cycle, takes the torque
/// MP2308 later, and the MC one cycle after that. No SS0 comes before.
#[test]
fn brake_and_torque_follow_the_standstill() {
    for phase in 1..=CYCLE {
        let seen = emergency_stop(phase, Some(ms(1_000)));
        let stands = seen.ss1_cc + ms(1_000);
        assert!(
            (stands..stands + CYCLE).contains(&seen.brake_cc),
            "{seen:?}"
        );
        assert_eq!(seen.off_cc, seen.brake_cc + 67 * CYCLE);
        assert_eq!(seen.off_mc, seen.off_cc + CYCLE);
        assert_eq!(seen.ss0, 0);
    }
    // Printed: 309.6 ms; with the cycle that sees the standstill and MP2308 in whole cycles 313.6 ms.
    assert!(worst(Some(ms(1_000))).off_cc <= ms(3_136));
}

/// HFS-TIMING-005/c, HFS-TIMING-006/e: a drive that never stands loses its torque with SMP525 after the SS1 of each channel.
#[test]
fn the_timer_takes_the_torque_at_the_latest() {
    for phase in 1..=CYCLE {
        let seen = emergency_stop(phase, None);
        assert_eq!(seen.off_cc, seen.ss1_cc + 140 * CYCLE);
        // The MC follows its own timer, which began earlier: the CC has not reported anything.
        assert_eq!(seen.off_mc, seen.ss1_mc + 140 * CYCLE);
        assert_eq!(seen.ss0, seen.off_mc);
    }
}

/// HFS-TIMING-007, HFS-TIMING-008: the cycle after the group has taken the state SLS, the speed is judged by it and the SS1 begins.
#[test]
fn an_open_door_stops_in_the_next_cycle() {
    let config = group::Config::new(Kind::NcAxes).expect("plausible");
    let automatic = group::State {
        state: GroupState::Auto,
        left: Left::NONE,
    };
    let mut group = group::Monitor::resume(config, automatic).expect("consistent");
    let limits = speed::Limits {
        som_2: Speed(1_000),
        ..Default::default()
    };
    let mut speed = speed::Monitor::new(speed::Config::new(limits, true).expect("plausible"));
    let mut cc = Kernel::new(true);
    let mut begun = Vec::new();
    let mut state = GroupState::Auto;
    for cycle in 0..4 {
        let seen = speed.step(&speed::Inputs {
            state,
            left: Left::NONE,
            speed: Speed(2_500),
        });
        let stop = cc.stop.step(&stop::Inputs {
            demand: seen.demand,
            listed_still: true,
            ..Default::default()
        });
        if stop.level == Stop::Ss1 {
            begun.push(cycle);
        }
        // The request of the safe PLC comes with the second cycle.
        let request = if cycle >= 1 {
            GroupState::Sls2
        } else {
            GroupState::Auto
        };
        state = group
            .step(&group::Inputs {
                request,
                moving: true,
                gen_safe: true,
                demand: seen.demand,
                phase: stop.phase,
                ..Default::default()
            })
            .state;
    }
    assert_eq!(begun, [2, 3]);
}

/// One safe PLC: it reads a signal at the beginning of a cycle of its own, and what it says counts from the next one on.
struct SafePlc {
    period: u32,
    phase: u32,
    read: bool,
    says: bool,
}

impl SafePlc {
    fn step(&mut self, signal: bool) -> bool {
        if self.phase == 0 {
            self.says = self.read;
            self.read = signal;
        }
        self.phase = (self.phase + 1) % self.period;
        self.says
    }
}

/// HFS-SPLC-003, HFS-TIMING-002: the safe PLC of the MC in the cycle of MP7602, that of the CC in 21 ms, at every phase to each
/// other: what they say differs for less than the window, and both have said it within two cycles and one of the kernel. One
/// that does not run is found.
#[test]
fn two_safe_plcs_in_their_own_cycles_are_no_fault() {
    for (period, phase_mc, phase_cc) in
        (1..=10).flat_map(|p| (0..p).flat_map(move |a| (0..7).map(move |b| (p, a, b))))
    {
        let plc = |period, phase| SafePlc {
            period,
            phase,
            read: false,
            says: false,
        };
        let (mut mc, mut cc) = (plc(period, phase_mc), plc(7, phase_cc));
        let mut watch = agreement::Monitor::new(agreement::Config::PUBLISHED);
        for cycle in 0..30 {
            let (a, b) = (mc.step(true), cc.step(true));
            let out = watch.step(&agreement::Inputs { differ: a != b });
            assert!(!out.fault, "MP7602 of {period} cycles, cycle {cycle}");
            assert!(cycle < 2 * period || a);
            assert!(cycle < 2 * 7 || b);
        }
    }
    let mut watch = agreement::Monitor::new(agreement::Config::PUBLISHED);
    let found = (0..30).position(|_| watch.step(&agreement::Inputs { differ: true }).fault);
    assert_eq!(found, Some(21));
}

/// HFS-ARCH-007: with every input marker at 0 nothing is permitted: SOM_1, no permissive, no release; and each marker alone takes
/// away what it gave.
#[test]
fn a_missing_signal_is_the_safe_one() {
    let mut selection = som::Monitor::new(som::Config::new(true).expect("plausible"));
    assert_eq!(selection.step(&som::Inputs::default()).som, Som::Som1);
    let key_2 = som::Inputs {
        key_2: true,
        ..Default::default()
    };
    assert_eq!(selection.step(&key_2).som, Som::Som2);
    assert_eq!(selection.step(&som::Inputs::default()).som, Som::Som1);
    let config = button::Config::new(Cycles::new(100)).expect("plausible");
    let mut permissive = button::Monitor::new(config);
    let none = button::Inputs::default();
    let both = button::Inputs {
        contact_a: true,
        contact_b: true,
        ..none
    };
    for lost in [
        button::Inputs {
            contact_a: false,
            ..both
        },
        button::Inputs {
            contact_b: false,
            ..both
        },
    ] {
        permissive.step(&none);
        assert!(permissive.step(&both).valid);
        assert!(!permissive.step(&lost).valid);
    }
    let config = gate::Config::new(Kind::NcAxes).expect("plausible");
    let taken = gate::Monitor::new(config).step(&gate::Inputs::default());
    assert!(!taken.starts && !taken.held && taken.som == Som::Som1);
    let mut channels = both_channels::Monitor::new(both_channels::Config);
    let one = channels.step(&both_channels::Inputs {
        starts_mc: true,
        held_mc: true,
        ..Default::default()
    });
    assert!(!one.starts && !one.held);
}

/// HFS-TIMING-003/b: the reaction comes with the fourth faulty telegram in a row, 12 ms after the first one began; a sound one in
/// between begins anew. Until then the drive is taken to move (HFS-ARCH-003).
#[test]
fn four_faulty_telegrams_of_another_cc_are_fatal() {
    let config = cc_link::Config::new(cc_link::Config::MOST).expect("allowed");
    let mut link = cc_link::Monitor::new(config);
    let drive = cc_link::Drive {
        group: Some(2),
        position: Position(1_234),
        brake_open: true,
        torque: true,
        ..Default::default()
    };
    let sound = cc_link::Inputs {
        sound: true,
        drive,
        ..Default::default()
    };
    let faulty = cc_link::Inputs::default();
    assert_eq!(link.step(&sound).drive, drive);
    for _ in 0..3 {
        let out = link.step(&faulty);
        assert!(out.drive.moving && out.drive.position == drive.position);
        assert_eq!(out.demand, Stop::None);
    }
    assert_eq!(link.step(&sound).demand, Stop::None);
    let demands: Vec<Stop> = (0..5).map(|_| link.step(&faulty).demand).collect();
    let none = Stop::None;
    assert_eq!(demands, [none, none, none, Stop::Ss1F, Stop::Ss1F]);
    assert_eq!(link.step(&sound).demand, Stop::Ss1F, "it stays lost");
    let fatal = cc_link::Inputs {
        fatal: true,
        ..sound
    };
    let mut link = cc_link::Monitor::new(config);
    assert_eq!(link.step(&fatal).demand, Stop::Ss1F);
    assert!(
        cc_link::Config::new(4).is_err(),
        "more than the manual's 12 ms"
    );
}

/// HFS-STAT-006, HFS-STAT-008 (4.8.22, c): the outputs of one participant, by its own fault; no status bit, -PF.BOARD of another
/// participant included, switches any off.
#[test]
fn outputs_are_switched_off_where_the_fault_is() {
    let take = |inputs| {
        let out = status_bits::Monitor::new(status_bits::Config).step(&inputs);
        (out.spl_off, out.smop_off)
    };
    let told = status_bits::Inputs {
        pf_board: true,
        spl_wd: true,
        smop_wd: true,
        ..Default::default()
    };
    assert_eq!(take(told), (false, false), "told by telegrams alone");
    let at_spl = status_bits::Inputs {
        pf_board: true,
        spl_fault: true,
        ..Default::default()
    };
    assert_eq!(take(at_spl), (true, false));
    let at_smop = status_bits::Inputs {
        pf_board: true,
        smop_fault: true,
        ..Default::default()
    };
    assert_eq!(take(at_smop), (false, true));
}
