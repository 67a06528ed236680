//! The conversion of machine data, compared with exact rational arithmetic, and its effect on the monitors.
//!
//! The formulas are the manual's, the rule of rounding is that of the monitors: limits, thresholds and tolerances of speed
//! down, delays up, intervals of repetition down, the slip tolerated up. What is enumerated and what is drawn stands at each
//! test. The drawn values are those around every kind of boundary (the exact whole increment or cycle, one step below and
//! above it, both ends of the range) and random ones, from a fixed seed.

use std::num::NonZeroU32;

use num_rational::Ratio;
use stillpoint_monitors::kernel::{Cycles, Position, Speed};
use stillpoint_monitors::sinumerik::axis::Local;
use stillpoint_monitors::sinumerik::encoder::{Encoder, LimitFrequency, Mounting, REVOLUTION};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair};
use stillpoint_monitors::sinumerik::parameters::{Configuration, Encoders, Parameters};
use stillpoint_monitors::sinumerik::selection::{Choice, FactorIndex, Stage};
use stillpoint_monitors::units::ModuloRange;

type Exact = Ratio<i128>;

fn exact(value: impl Into<i128>) -> Exact {
    Exact::from_integer(value.into())
}

/// The monitoring cycles that the drive holds (multiples of 31.25 us that are whole microseconds, 0.5 ms to 25 ms): all of them.
fn cycles() -> impl Iterator<Item = u32> {
    (500..=25_000).step_by(125)
}

/// The codes of the items of the comparison (lines 10514 to 11400): 1 to 3, 5 to 42, 44 to 85, 89; one is compared in a cycle.
const PASS: i128 = 3 + 38 + 42 + 1;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % bound
    }

    fn within(&mut self, min: u32, max: u32) -> u32 {
        min + u32::try_from(self.below(u64::from(max - min) + 1)).expect("within")
    }
}

fn axis(cycle_us: u32, rotary: bool) -> Parameters {
    Parameters {
        sysclock_cycle_time: cycle_us,
        safety_sysclock_time_ratio: 1,
        is_rot_ax: rotary,
        function_enable: 1,
        ..Parameters::default()
    }
}

fn converted(parameters: &Parameters) -> Configuration {
    parameters
        .validate()
        .unwrap_or_else(|e| panic!("{e}: {parameters:?}"))
}

/// The way of one cycle in increments at a speed in um/min or 0.001 rev/min: v * T, in mm and degrees.
fn way(thousandths: u32, cycle_us: u32, rotary: bool) -> Exact {
    let per_minute = Exact::new(thousandths.into(), 1_000);
    let minutes = Exact::new(cycle_us.into(), 60_000_000);
    let unit = if rotary { exact(360) } else { exact(1) };
    per_minute * minutes * unit * exact(1_000)
}

/// Speeds to look at: the ends, random ones, and those whose way is just a whole increment, with their neighbours.
fn speeds(random: &mut Random, cycle_us: u32, rotary: bool, max: u32) -> Vec<u32> {
    let mut speeds = vec![0, 1, 2, max - 1, max];
    let one = way(1, cycle_us, rotary);
    for _ in 0..6 {
        speeds.push(random.within(0, max));
        let whole = (one * exact(random.within(0, max))).floor();
        let at = (whole / one).to_integer();
        for near in [at - 1, at, at + 1] {
            if let Ok(near) = u32::try_from(near) {
                speeds.push(near.min(max));
            }
        }
    }
    speeds
}

/// The pair of channels after power-on, with both signals "not selected".
fn pair(parameters: &Parameters) -> (Pair, Local) {
    let local = Local {
        run_up: true,
        spl_started: true,
        sge: Sge {
            sbh_sg_off: true,
            sbh_off: true,
            ..Sge::UNUSED
        },
        ..Local::default()
    };
    let mut pair = Pair::new(Config::new(converted(parameters)));
    let on = Local {
        power_on: true,
        ..local
    };
    let _ = pair.step(&Inputs::both(on));
    (pair, local)
}

fn position(exact: Exact) -> Position {
    Position(i32::try_from(exact.floor().to_integer()).expect("a short run"))
}

/// S840D-TIMING-512, S840D-KDV-711, S840D-PARAM-010, -017, -018, -024: every speed of every permitted cycle, linear and
/// rotary; the speeds drawn.
#[test]
fn speeds_are_the_exact_way_of_a_cycle_rounded_down() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut compared = 0;
    for cycle_us in cycles() {
        for rotary in [false, true] {
            let floor =
                |value| i128::from(u32::MAX).min(way(value, cycle_us, rotary).floor().to_integer());
            for (limit, other) in speeds(&mut random, cycle_us, rotary, 1_000_000_000)
                .into_iter()
                .zip(speeds(&mut random, cycle_us, rotary, 1_000_000))
            {
                let ramp = random.within(0, 20_000_000);
                let percent = u8::try_from(random.within(1, 100)).expect("percent");
                let p = Parameters {
                    velo_limit: [limit, other, limit / 2, limit],
                    velo_ovr_factor: [percent; 16],
                    velo_x: other,
                    standstill_velo_tol: other,
                    stop_velo_tol: ramp,
                    function_enable: 1 | 1 << 5,
                    ..axis(cycle_us, rotary)
                };
                let c = converted(&p);
                let context = format!("{p:?}");
                let channel = c.channel();
                let stages = [Stage::Sg1, Stage::Sg2, Stage::Sg3, Stage::Sg4];
                for (stage, value) in stages.into_iter().zip(p.velo_limit) {
                    let found = channel.selection.limit(stage);
                    assert_eq!(i128::from(found.0), floor(value), "{stage:?} {context}");
                    // The override: never more than the exact part, and less by no more than an increment each time.
                    let choice = Choice {
                        stage,
                        factor: FactorIndex::NONE,
                    };
                    let effective = exact(channel.selection.effective(choice).0);
                    let part = match stage {
                        Stage::Sg2 | Stage::Sg4 => Exact::new(percent.into(), 100),
                        _ => exact(1),
                    };
                    let whole = way(value, cycle_us, rotary) * part;
                    assert!(
                        effective <= whole && whole < effective + exact(2),
                        "{stage:?} {context}"
                    );
                }
                assert_eq!(
                    i128::from(channel.standstill_speed.0),
                    floor(other),
                    "{context}"
                );
                let lowest = floor(other) + floor(ramp);
                assert_eq!(
                    i128::from(channel.ramp.lowest_limit().0),
                    lowest,
                    "{context}"
                );
                let words = c.words();
                assert_eq!(
                    words.velo_limit,
                    stages.map(|stage| channel.selection.limit(stage))
                );
                assert_eq!(i128::from(words.velo_x.0), floor(other), "{context}");
                assert_eq!(i128::from(words.stop_velo_tol.0), floor(ramp), "{context}");
                assert_eq!(
                    i128::from(words.standstill_velo_tol.0),
                    floor(other),
                    "{context}"
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 5_000, "{compared}");
}

/// S840D-SLIP-504, S840D-KDV-505: the slip tolerated is the way of a whole pass of the comparison; every cycle, linear and
/// rotary, the speeds drawn. The whole dead band is on top of it, and nothing more.
#[test]
fn slip_is_the_exact_way_of_a_pass_rounded_up() {
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    for cycle_us in cycles() {
        for rotary in [false, true] {
            for tolerated in speeds(&mut random, cycle_us, rotary, 1_000_000) {
                let c = converted(&slipping(cycle_us, rotary, tolerated));
                let whole = way(tolerated, cycle_us, rotary) * exact(PASS);
                let found = c.slip().as_ref().expect("enabled").tol();
                let context = format!("{tolerated} in {cycle_us} us, rotary {rotary}");
                assert_eq!(exact(found.0), whole.ceil() + exact(2), "{context}");
                assert_eq!(c.words().slip_velo_tol, found, "{context}");
            }
        }
    }
}

fn slipping(cycle_us: u32, rotary: bool, tolerated: u32) -> Parameters {
    let mut p = Parameters {
        function_enable: 0b1001,
        slip_velo_tol: tolerated,
        ..axis(cycle_us, rotary)
    };
    p.installation.encoders = Encoders::Two;
    p
}

/// The effect, on the two-channel axis: encoders that go apart at the exact speed tolerated, from any phase of their
/// increments, on an axis that stands or moves, never give STOP F; faster by less than seven increments of a pass they do.
/// Cycles and speeds drawn.
#[test]
fn the_exact_slip_is_tolerated_and_a_little_more_is_found() {
    let mut random = Random(0xDEAD_BEEF_0BAD_CAFE);
    for round in 0..400 {
        let cycle_us = 500 + 125 * random.within(0, 196);
        let rotary = round % 2 == 1;
        let tolerated = match round % 4 {
            0 | 1 => random.within(0, 1_000_000),
            _ => random.within(0, 2_000),
        };
        let feed = way(random.within(0, 3_000_000), cycle_us, rotary);
        let phases = [0, 1].map(|_| Exact::new(random.within(0, 999).into(), 1_000));
        let slip = way(tolerated, cycle_us, rotary);
        let sign = if random.below(2) == 0 {
            exact(1)
        } else {
            exact(-1)
        };
        let p = slipping(cycle_us, rotary, tolerated);
        let (mut pair, local) = pair(&p);
        let more = Exact::new(7, PASS);
        let mut apart = exact(0);
        let mut found = None;
        for cycle in 0..13 * PASS {
            apart += sign * if cycle < 10 * PASS { slip } else { slip + more };
            let at = feed * exact(cycle);
            let mut inputs = Inputs::both(local);
            inputs.nck.position = position(at + phases[0]);
            inputs.drive.position = position(at + apart + phases[1]);
            let outputs = pair.step(&inputs);
            if outputs.nck.code.number() != 0 || outputs.drive.code.number() != 0 {
                found = Some((cycle, outputs.nck.code.number()));
                break;
            }
        }
        let (cycle, code) = found.unwrap_or_else(|| panic!("a faster slip is not found: {p:?}"));
        assert!(
            cycle >= 10 * PASS,
            "the tolerated slip gives code {code} in cycle {cycle}: {p:?}"
        );
    }
}

/// S840D-SG-001, the effect: an axis faster than the exact limit is stopped, whatever the phase of its increments; one slower
/// by an increment in a cycle never. Cycles and limits drawn.
#[test]
fn the_exact_limit_of_a_stage_is_what_stops() {
    let mut random = Random(0x0123_4567_89AB_CDEF);
    for round in 0..400 {
        let cycle_us = 500 + 125 * random.within(0, 196);
        let rotary = round % 2 == 1;
        let value = random.within(1, 20_000_000);
        let limit = way(value, cycle_us, rotary);
        let phase = Exact::new(random.within(0, 999).into(), 1_000);
        let p = Parameters {
            velo_limit: [value; 4],
            ..axis(cycle_us, rotary)
        };
        let run = |speed: Exact| {
            let (mut pair, mut local) = pair(&p);
            local.sge.sbh_sg_off = false;
            (0..400).any(|cycle| {
                local.position = position(speed * exact(cycle) + phase);
                pair.step(&Inputs::both(local)).nck.channel.speed.violated
            })
        };
        assert!(run(limit + Exact::new(1, 100)), "too fast by little: {p:?}");
        if limit > exact(1) {
            assert!(!run(limit - exact(1)), "slower than the limit: {p:?}");
        }
    }
}

/// All delays, S840D-PARAM-019 to -022: every millisecond up to a minute in six cycles, and in all 197 cycles those around
/// whole cycles and both ends: rounded up to whole cycles.
#[test]
fn delays_are_rounded_up_to_whole_cycles() {
    let check = |ms: u32, cycle_us: u32| {
        let short = ms.min(10_000);
        let p = Parameters {
            mode_switch_time: short,
            stop_switch_time_c: short,
            pulse_disable_delay: short,
            pulse_dis_check_time: short,
            velo_switch_delay: ms,
            stop_switch_time_d: ms,
            stop_switch_time_e: ms,
            stop_switch_time_f: ms,
            ..axis(cycle_us, false)
        };
        let c = converted(&p);
        let up = |ms: u32| {
            let cycles = (exact(ms) * exact(1_000) / exact(cycle_us)).ceil();
            Cycles::new(u32::try_from(cycles.to_integer()).expect("a delay"))
        };
        let channel = c.channel();
        let found = [
            (c.compare().t_chg(), short),
            (channel.stop.time(Level::B), short),
            (channel.stop.time(Level::C), short),
            (channel.stop.time(Level::D), ms),
            (channel.stop.time(Level::E), ms),
            (channel.selection.t_vel(), ms),
            (c.words().stop_switch_time_f, ms),
            (c.words().pulse_dis_check_time, short),
        ];
        for (place, (found, ms)) in found.into_iter().enumerate() {
            assert_eq!(found, up(ms), "{place}: {ms} ms in {cycle_us} us");
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
            velo_switch_delay: t_vel,
            stop_switch_time_c: t_c,
            pulse_disable_delay: t_b,
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
            p.installation.test_interval = ms;
            let whole = exact(ms) * exact(1_000) / exact(cycle_us);
            let found = converted(&p).forced_check().interval().count();
            assert_eq!(exact(found), whole.floor(), "{ms} ms in {cycle_us} us");
        }
    }
}

/// S840D-PARAM-009, -013 to -016: positions and tolerances are what the machine data say, to the increment; values drawn.
#[test]
fn positions_and_tolerances_are_exact() {
    let mut random = Random(0x3141_5926_5358_9793);
    let at = |random: &mut Random| {
        i32::try_from(i64::from(random.within(0, 4_294_000_000)) - 2_147_000_000)
            .expect("a position")
    };
    for _ in 0..20_000 {
        let (one, two) = (at(&mut random), at(&mut random));
        if one == two {
            continue;
        }
        let p = Parameters {
            pos_limit_plus: [one.max(two), i32::MAX / 2],
            pos_limit_minus: [one.min(two), i32::MIN / 2],
            cam_pos_plus: [at(&mut random); 4],
            cam_pos_minus: [at(&mut random); 4],
            standstill_tol: random.within(1, 100_000),
            pos_tol: random.within(1, 10_000),
            refp_pos_tol: random.within(0, 1_000),
            cam_tol: random.within(1, 10_000),
            ..axis(12_000, false)
        };
        let c = converted(&p);
        let (channel, words) = (c.channel(), c.words());
        for second in [false, true] {
            let k = usize::from(second);
            assert_eq!(channel.limit_switch.plus(second).0, p.pos_limit_plus[k]);
            assert_eq!(channel.limit_switch.minus(second).0, p.pos_limit_minus[k]);
            assert_eq!(words.pos_limit_plus[k].0, p.pos_limit_plus[k]);
            assert_eq!(words.pos_limit_minus[k].0, p.pos_limit_minus[k]);
        }
        assert_eq!(channel.standstill.tolerance().0, p.standstill_tol);
        assert_eq!(c.history().tol().0, p.refp_pos_tol);
        assert_eq!((words.pos_tol.0, words.cam_tol.0), (p.pos_tol, p.cam_tol));
        for (pair, k) in words.cams.iter().zip(0..) {
            assert_eq!(
                (pair.plus.0, pair.minus.0),
                (p.cam_pos_plus[k], p.cam_pos_minus[k])
            );
        }
    }
}

/// S840D-SN-011, lines 7968 and 7972: all 2049 modulo ranges, positions around every kind of boundary and random ones.
#[test]
fn modulo_ranges_fold_exactly() {
    let mut random = Random(0x2718_2818_2845_9045);
    for turns in 0..=2_048_i64 {
        let degrees = u32::try_from(360 * turns).expect("degrees");
        let range = ModuloRange::from_degrees(degrees).expect("a multiple");
        let (lower, width) = match turns {
            0 => (-737_280_000_i64, 2 * 737_280_000),
            _ => (0, 360_000 * turns),
        };
        let mut positions = vec![i32::MIN, i32::MAX, -1, 0, 1];
        for near in [-width, lower, lower + width, lower + 2 * width] {
            positions.extend(
                [-1, 0, 1]
                    .iter()
                    .filter_map(|d| i32::try_from(near + d).ok()),
            );
        }
        positions.extend((0..20).map(|_| random.within(0, u32::MAX) as i32));
        for at in positions {
            let turns = Exact::new((i64::from(at) - lower).into(), width.into());
            let rest = (turns - turns.floor()) * exact(width) + exact(lower);
            assert_eq!(
                exact(range.folded(Position(at)).0),
                rest,
                "{at} in {degrees} degrees"
            );
        }
    }
}

fn nonzero(value: u32) -> NonZeroU32 {
    NonZeroU32::new(value).expect("not zero")
}

/// S840D-ENC-006, S840D-PARAM-006, -007: position of the load from the count, over the ranges of encoder, gear, pitch and grid;
/// values drawn. A ratio too fine for the monitor is refused, never rounded.
#[test]
fn encoders_and_gears_are_exact() {
    let mut random = Random(0x1618_0339_8874_9894);
    let (mut compared, mut refused) = (0, 0);
    for round in 0..200_000 {
        let largest = if round % 2 == 0 { 8_388_607 } else { 500 };
        let [resol, pitch, grid] = [(1, 100_000), (100, 8_388_000), (10, 8_000_000)]
            .map(|(min, max)| random.within(min, max));
        let [denom, numera] = [0; 2].map(|_| random.within(1, largest));
        let subdivision = [1, 4, 128, 2_048][round % 4];
        let (mounting, per_pulse) = match random.below(3) {
            0 => (
                Mounting::Linear {
                    grid_nm: nonzero(grid),
                },
                Exact::new(grid.into(), 1_000),
            ),
            kind => {
                let load = if kind == 1 { REVOLUTION.get() } else { pitch };
                let gear = Exact::new(denom.into(), numera.into());
                (
                    Mounting::Rotary {
                        pulses: nonzero(resol),
                        denom: nonzero(denom),
                        numera: nonzero(numera),
                        load: nonzero(load),
                    },
                    exact(load) * gear / exact(resol),
                )
            }
        };
        let per_count = per_pulse / exact(subdivision);
        let reversed = random.below(2) == 1;
        let limit = i128::from(u32::MAX);
        let Ok(encoder) = Encoder::new(mounting, nonzero(subdivision), reversed) else {
            assert!(
                *per_count.numer() > limit || *per_count.denom() > limit,
                "{mounting:?}"
            );
            refused += 1;
            continue;
        };
        let (numerator, denominator) = encoder.ratio();
        assert_eq!(
            Exact::new(numerator.into(), denominator.get().into()),
            per_count
        );
        for count in [
            0,
            1,
            -1,
            i32::MIN,
            i32::MAX,
            random.within(0, u32::MAX) as i32,
        ] {
            let sign = if reversed { -1 } else { 1 };
            let whole = (exact(sign * i128::from(count)) * per_count)
                .floor()
                .to_integer();
            let expected = i32::try_from(whole).ok().map(Position);
            assert_eq!(encoder.position(count), expected, "{mounting:?} at {count}");
        }
        let cycle = 500 + 125 * random.within(0, 196);
        let hz = random.within(300_000, 420_000);
        let frequency = LimitFrequency::new(hz, true).expect("in range");
        let most = (exact(hz) * exact(cycle) / exact(1_000_000) * per_pulse)
            .floor()
            .to_integer();
        let expected = u32::try_from(most).ok().map(Speed);
        assert_eq!(
            encoder.highest_speed(frequency, nonzero(cycle)).ok(),
            expected
        );
        compared += 1;
    }
    assert!(compared > 50_000 && refused > 100, "{compared} {refused}");
}

/// S840D-FREQ-002, table 5-21: n = f * 60 / pulses and f * T, every frequency from 300 to 420 kHz, with every number of pulses of the table
/// and every cycle.
#[test]
fn limit_frequencies_are_exact() {
    for hz in 300_000..=420_000_u32 {
        let frequency = LimitFrequency::new(hz, true).expect("in range");
        for pulses in [512, 1_024, 2_048] {
            let exact_speed = Exact::new(i128::from(hz) * 60, pulses.into());
            let found = frequency.revolutions_per_minute(nonzero(pulses));
            assert_eq!(exact(found), exact_speed.floor());
        }
        let cycle = 500 + 125 * (hz % 197);
        let found = frequency.pulses_per_cycle(nonzero(cycle)).expect("fits");
        assert_eq!(
            exact(found.0),
            Exact::new(i128::from(hz) * i128::from(cycle), 1_000_000).floor()
        );
    }
}
