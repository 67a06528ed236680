//! Delays and intervals.

use std::path::Path;

use stillpoint_harness::families::sinumerik::production;
use stillpoint_machine as machine;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::axis::Local;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Inputs, Outputs, Pair};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_tests::root;

use super::{Random, axis, converted, cycles, exact, pair};

/// All delays, S840D-PARAM-019 to -022: every millisecond up to a minute in six cycles, and in all 197 cycles those around
/// whole cycles and both ends: rounded up to whole cycles.
#[test]
fn delays_are_rounded_up_to_whole_cycles() {
    let check = |ms: u32, cycle_us: u32| {
        let us = ms * 1_000;
        let short = us.min(10_000_000);
        let p = Parameters {
            mode_switch_time: short,
            stop_switch_time_c: short,
            pulse_disable_delay: short,
            pulse_dis_check_time: short,
            velo_switch_delay: us,
            stop_switch_time_d: us,
            stop_switch_time_e: us,
            stop_switch_time_f: us,
            ..axis(cycle_us, false)
        };
        let c = converted(&p);
        let up = |us: u32| {
            let cycles = (exact(us) / exact(cycle_us)).ceil();
            Cycles::new(u32::try_from(cycles.to_integer()).expect("a delay"))
        };
        let channel = c.channel();
        let found = [
            (c.compare().t_chg(), short),
            (channel.stop.time(Level::B), short),
            (channel.stop.time(Level::C), short),
            (channel.stop.time(Level::D), us),
            (channel.stop.time(Level::E), us),
            (channel.selection.t_vel(), us),
            (c.words().stop_switch_time_f, us),
            (c.words().pulse_dis_check_time, short),
        ];
        for (place, (found, us)) in found.into_iter().enumerate() {
            assert_eq!(found, up(us), "{place}: {us} us in {cycle_us} us");
        }
    };
    for cycle_us in [500, 625, 4_000, 12_000, 12_125, 25_000] {
        (0..=60_000).for_each(|ms| check(ms, cycle_us));
    }
    let mut random = Random(0xFEDC_BA98_7654_3210);
    for cycle_us in cycles() {
        for ms in [0, 1, 9_999, 10_000, 59_999, 60_000] {
            check(ms, cycle_us);
        }
        for _ in 0..20 {
            let whole = random.within(1, 2_000) * cycle_us / 1_000;
            [whole - 1, whole, whole + 1]
                .into_iter()
                .for_each(|ms| check(ms, cycle_us));
        }
    }
}

/// S840D-PARAM-027, S840D-MDBUS-001: at the end of MD10089 the pulses are off, so the delay is rounded down to whole cycles, and
/// what is shorter than a cycle is none. Every millisecond, in every cycle.
#[test]
fn the_delay_after_a_bus_failure_is_never_longer_than_the_machine_datum() {
    for cycle_us in cycles() {
        for ms in 0..=800 {
            let p = Parameters {
                pulse_dis_time_busfail: ms * 1_000,
                ..axis(cycle_us, false)
            };
            let c = converted(&p);
            let down = (exact(ms * 1_000) / exact(cycle_us)).floor().to_integer();
            let expected = Cycles::new(u32::try_from(down).expect("a delay"));
            assert_eq!(c.bus_nck().delay(), expected, "{ms} ms in {cycle_us} us");
            assert_eq!(c.bus_drive().delay(), expected, "{ms} ms in {cycle_us} us");
        }
    }
}

/// S840D-SBH-003, S840D-PARAM-020, -021, the effect on the two-channel axis: the operating stop comes t_vel after its selection,
/// that of STOP C t_C after the stop, STOP A t_B after STOP B: in the first cycle in which the exact time has passed, never
/// before. Cycles and times drawn.
#[test]
fn the_exact_time_has_passed_when_a_delay_ends() {
    let mut random = Random(0x5555_1234_AAAA_9876);
    for _ in 0..150 {
        let cycle_us = 500 + 125 * random.within(0, 196);
        let [t_vel, t_c, t_b] = [0; 3].map(|_| random.within(1, 2_000));
        let p = Parameters {
            velo_switch_delay: t_vel * 1_000,
            stop_switch_time_c: t_c * 1_000,
            pulse_disable_delay: t_b * 1_000,
            velo_stop_reaction: [2; 4],
            // The braking ramp does not see the small step out of a small window.
            stop_velo_tol: 20_000_000,
            standstill_tol: 1,
            ..axis(cycle_us, false)
        };
        let (mut pair, mut local) = pair(&p);
        local.sge.sbh_sg_off = false;
        let _ = pair.step(&Inputs::both(local));
        local.sge.sbh_off = false;
        let first =
            |pair: &mut Pair, local: &mut Local, step: i32, is: &dyn Fn(&Outputs) -> bool| {
                (0..5_000_u32).find(|_| {
                    local.position.0 += step;
                    is(&pair.step(&Inputs::both(*local)))
                })
            };
        let expected = |ms: u32| {
            let cycles = (exact(ms) * exact(1_000) / exact(cycle_us)).ceil();
            u32::try_from(cycles.to_integer()).ok()
        };
        let sbh = first(&mut pair, &mut local, 0, &|o| o.nck.sga.sbh_active);
        assert_eq!(sbh, expected(t_vel), "t_vel: {p:?}");
        // Back to SG, and too fast: STOP C in the same cycle, the operating stop t_C after it.
        local.sge.sbh_off = true;
        let _ = pair.step(&Inputs::both(local));
        local.position.0 += 2_000_000;
        let outputs = pair.step(&Inputs::both(local));
        assert_eq!(outputs.nck.channel.stop.level, Level::C, "{p:?}");
        let forced = first(&mut pair, &mut local, 0, &|o| o.nck.sga.sbh_active);
        // Counted from the cycle after the one of the stop.
        assert_eq!(forced.map(|c| c + 1), expected(t_c), "t_C: {p:?}");
        // It moves out of the window: STOP B, and STOP A t_B after it; moving on, it never stands.
        local.position.0 += 2;
        let outputs = pair.step(&Inputs::both(local));
        assert_eq!(outputs.nck.channel.stop.level, Level::B, "{p:?}");
        let a = first(&mut pair, &mut local, 1, &|o| {
            o.nck.channel.stop.level == Level::A
        });
        assert_eq!(a.map(|c| c + 1), expected(t_b), "t_B: {p:?}");
    }
}

/// S840D-TEST-001: the interval of the tests is rounded down; every cycle, intervals drawn.
#[test]
fn intervals_are_rounded_down() {
    let mut random = Random(0x7777_0000_1111_2222);
    for cycle_us in cycles() {
        for _ in 0..50 {
            let ms = random.within(1_000, 28_800_000);
            let mut p = axis(cycle_us, false);
            p.installation.test_interval = u64::from(ms) * 1_000;
            let whole = exact(ms) * exact(1_000) / exact(cycle_us);
            let found = converted(&p).forced_check().interval().count();
            assert_eq!(exact(found), whole.floor(), "{ms} ms in {cycle_us} us");
        }
    }
}

/// Machine data of a machine file: each is rounded once, from its exact value, not to milliseconds first. Every permitted
/// basic clock of 0.5 to 16 ms in steps of 31.25 us that is a whole number of microseconds, as the monitoring cycle; times drawn to the microsecond.
#[test]
fn times_of_a_machine_file_are_rounded_once() {
    let mut random = Random(0x0F0F_3C3C_5A5A_9696);
    let mut finer = 0;
    // The position controller's cycle, which is the basic clock here, is no longer than 16 ms.
    for cycle_us in cycles().filter(|cycle_us| *cycle_us <= 16_000) {
        let [t_vel, t_c, t_f, t_b] = [0; 4].map(|_| random.within(1, 2_000_000));
        let interval = random.within(60_000_000, 4_000_000_000);
        let text = format!(
            "family = \"sinumerik-840d\"\nname = \"times\"\n\
             [control]\nSYSCLOCK_CYCLE_TIME = \"{cycle_us} us\"\nSAFETY_SYSCLOCK_TIME_RATIO = 1\n\
             [axis.X]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\n\
             VELO_SWITCH_DELAY = \"{t_vel} us\"\nSTOP_SWITCH_TIME_C = \"{t_c} us\"\n\
             STOP_SWITCH_TIME_F = \"{t_f} us\"\nPULSE_DISABLE_DELAY = \"{t_b} us\"\n\
             [door.front]\naxes = [\"X\"]\nopen = \"SG1\"\ntest_interval = \"{interval} us\"\n"
        );
        let machine = machine::load_bytes(
            Path::new("times.toml"),
            text.clone().into_bytes(),
            &root().join("spec/families"),
        )
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let axes = production::axes(&machine).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let c = &axes[0].configuration;
        let found = [
            (c.channel().selection.t_vel(), t_vel),
            (c.channel().stop.time(Level::C), t_c),
            (c.words().stop_switch_time_f, t_f),
            (c.channel().stop.time(Level::B), t_b),
        ];
        for (found, us) in found {
            let whole = exact(us) / exact(cycle_us);
            assert_eq!(
                exact(found.count()),
                whole.ceil(),
                "{us} us in {cycle_us} us"
            );
            let millis = (exact(us) / exact(1_000)).ceil() * exact(1_000) / exact(cycle_us);
            finer += usize::from(millis.ceil() != whole.ceil());
        }
        let whole = exact(interval) / exact(cycle_us);
        assert_eq!(exact(c.forced_check().interval().count()), whole.floor());
    }
    assert!(
        finer > 20,
        "{finer} times that milliseconds would make longer"
    );
}
