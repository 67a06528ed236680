//! Speeds, and what is made of them.

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::pair::Inputs;
use stillpoint_monitors::sinumerik::parameters::{Encoders, Parameters};
use stillpoint_monitors::sinumerik::selection::{Choice, FactorIndex, Stage};

use super::{Exact, PASS, Random, axis, converted, cycles, exact, pair, way};

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
