//! What Kani takes in the place of calculations of the fail-safe blocks: quotients and lines of few bits, and any envelope.
//!
//! A block asks for the same quotient in each clause that reads a parameter, and a division by a variable of 32 bits takes Kani longer
//! than everything else. What is assumed here is what the caveat of the harness says.

use stillpoint_monitors::srm::interpolation::Curve;
use stillpoint_monitors::srm::safe_pos;

/// Whether a number is from 0 to this one: `RangeInclusive::contains` is a hundred steps of the symbolic execution.
const fn upto(greatest: i32, number: i32) -> bool {
    0 <= number && number <= greatest
}

/// `common::calls` for a time below 256 and a call of at most 3, of which each is divided by as a constant.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_calls(time: i32, t_sample: i32) -> Option<i32> {
    kani::assume(upto(255, time) && upto(3, t_sample));
    let time = time as u8;
    let whole = match t_sample {
        1 => Some(time),
        2 if time % 2 == 0 => Some(time / 2),
        3 if time % 3 == 0 => Some(time / 3),
        _ => None,
    };
    match whole {
        None | Some(0) => None,
        Some(count) => Some(i32::from(count)),
    }
}

/// `common::multiple` for numbers below 256.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_multiples(number: i32, of: i32) -> bool {
    kani::assume(upto(255, number) && upto(255, of));
    of != 0 && number as u8 % of as u8 == 0
}

/// `common::quotient` for numbers below 256.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_quotients(number: i32, of: i32) -> i32 {
    kani::assume(upto(255, number) && upto(255, of));
    i32::from(number as u8 / of as u8)
}

/// `common::remainder` for numbers below 256.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_remainders(number: i32, of: i32) -> i32 {
    kani::assume(upto(255, number) && upto(255, of));
    i32::from(number as u8 % of as u8)
}

/// `common::remainder` of a time below 256 and a call of 1 to 3.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_rests(time: i32, t_sample: i32) -> i32 {
    assert!(t_sample != 0);
    kani::assume(upto(255, time) && upto(3, t_sample));
    i32::from(match t_sample {
        1 => 0,
        2 => time as u8 % 2,
        _ => time as u8 % 3,
    })
}

/// `common::multiple` of a time below 256 and a call of at most 3.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_whole_times(time: i32, t_sample: i32) -> bool {
    kani::assume(upto(255, time) && upto(3, t_sample));
    t_sample != 0 && few_rests(time, t_sample) == 0
}

/// `sbr_monitor::whole_mm` for less than 2 mm.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_whole_mm(parts: i64) -> (i32, i32) {
    kani::assume(-120_000 < parts && parts < 120_000);
    let parts = parts as i32;
    let whole = i32::from(parts >= 60_000) - i32::from(parts <= -60_000);
    (whole, parts - whole * 60_000)
}

/// `safe_pos::laws::rounded_up` for the same.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_rounded_up(velocity: i32, way: i64, count: i64, cycle: i32) -> bool {
    kani::assume(way <= 255 && count <= 3 && cycle <= 3);
    if !upto(15_300, velocity) {
        return false;
    }
    let (velocity, parts) = (velocity as u32, way as u32 * 60);
    let near = |time: u32| parts <= velocity * time && velocity * time - parts < time;
    match count as u8 * cycle as u8 {
        1 => near(1),
        2 => near(2),
        3 => near(3),
        4 => near(4),
        6 => near(6),
        _ => near(9),
    }
}

/// [`safe_pos::Config::standing`] for cycles of at most 3 ms.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_standing(config: &safe_pos::Config) -> u32 {
    let (drive, own) = (config.possi_t_sample, config.t_sample);
    kani::assume(upto(3, drive) && upto(3, own));
    let cycle = match (drive, own) {
        (2, 1) | (3, 2) => 2,
        (3, 1) => 3,
        _ => 1,
    };
    let calls = config.count_margin.count().saturating_add(cycle);
    calls - u32::from(calls == u32::MAX)
}

/// `interpolation::between` for points and places of 4 bits.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_lines(below: (i32, i32), above: (i32, i32), place: i32) -> Option<i32> {
    let small = |number: i32| upto(15, number);
    kani::assume(small(below.0) && small(below.1) && small(above.0) && small(above.1));
    kani::assume(below.0 < place && place < above.0);
    let (from, to) = (below.1 as u8, above.1 as u8);
    let (step, width) = ((place - below.0) as u8, (above.0 - below.0) as u8);
    let part = i32::from(from.abs_diff(to) * step / width);
    Some(if to < from {
        below.1 - part
    } else {
        below.1 + part
    })
}

/// `interpolation::near_the_line` for the same; another limit is not near any line.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_near_lines(below: (i32, i32), above: (i32, i32), place: i32, limit: i32) -> bool {
    let small = |number: i32| upto(15, number);
    if !(small(below.0) && small(below.1) && small(above.0) && small(above.1) && small(limit)) {
        return false;
    }
    let (width, step) = ((above.0 - below.0) as i16, (place - below.0) as i16);
    let rise = (above.1 - below.1) as i16;
    let left = rise * step - (limit - below.1) as i16 * width;
    left.abs() < width && (left == 0 || (left < 0) == (rise < 0))
}

/// `interpolation::segments_fit`: where a line is calculated its points have 4 bits and fit, elsewhere it is not asked whether they
/// do.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_segments(_: &Curve) -> bool {
    true
}

/// Any envelope in the place of the one through the points: a call of F_ENDZONE asks for it at two distances. X_16 parts these; on
/// each side the limit is V_1 or V_2 or none, whether the points ascend is X_3. So for any two distances every pair of answers
/// occurs, the same one twice where the distances are the same. What the points make of a distance is the contract of F_INTERPOLATION.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn any_limit(curve: &Curve, place: i32) -> Option<i32> {
    let (there, limit) = if place < curve.x_16 {
        (curve.x[1], curve.v[1])
    } else {
        (curve.x[2], curve.v[2])
    };
    (any_ascent(curve) && there != 0).then_some(limit)
}

/// Whether the points of such an envelope ascend.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn any_ascent(curve: &Curve) -> bool {
    curve.x[3] != 0
}

/// The velocity of F_SAFE_POS where the counter has gone by at most 3 cycles of at most 3 ms, and the encoder by less than 256 um.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_velocities(way: i64, count: i64, cycle: i32) -> Option<i32> {
    if count <= 0 || cycle <= 0 {
        return None;
    }
    kani::assume(way.abs() <= 255 && count <= 3 && cycle <= 3);
    let parts = way.unsigned_abs() as u16 * 60;
    let velocity = match count as u8 * cycle as u8 {
        1 => parts,
        2 => parts.div_ceil(2),
        3 => parts.div_ceil(3),
        4 => parts.div_ceil(4),
        6 => parts.div_ceil(6),
        _ => parts.div_ceil(9),
    };
    Some(i32::from(velocity))
}

/// `common::um` for millimetres of 1024 um: a shift in the place of a product. What is compared with what does not depend on the factor.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn binary_um(mm: i64) -> i64 {
    mm << 10
}
