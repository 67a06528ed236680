//! Positions, the modulo range, encoders and gears.

use std::num::NonZeroU32;

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::encoder::{Encoder, LimitFrequency, Mounting, REVOLUTION};
use stillpoint_monitors::sinumerik::parameters::Parameters;
use stillpoint_monitors::units::ModuloRange;

use super::{Exact, Random, axis, converted, exact};

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
