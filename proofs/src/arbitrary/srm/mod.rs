//! Quotients of the fail-safe blocks in the place of themselves, for Kani: where the harness draws few times, of as few bits.
//!
//! A block asks for the same quotient in each clause that reads a parameter, and a division by a variable of 32 bits takes Kani longer
//! than everything else. What is assumed here is what the harness says of its draw.

use stillpoint_monitors::srm::sbr_monitor;

/// `common::calls` for a time below 256 and a call of at most 3, of which each is divided by as a constant.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_calls(time: i32, t_sample: i32) -> Option<i32> {
    kani::assume((0..=255).contains(&time) && (0..=3).contains(&t_sample));
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
    kani::assume((0..=255).contains(&number) && (0..=255).contains(&of));
    of != 0 && number as u8 % of as u8 == 0
}

/// [`sbr_monitor::Config::step`] with both.
#[allow(dead_code, reason = "named by an attribute of Kani only")]
pub(crate) fn few_steps(config: &sbr_monitor::Config) -> Option<i32> {
    let count = few_calls(config.t_ramp, config.t_sample)?;
    let step = config.v_max as u8 / count as u8;
    few_multiples(config.v_max, count).then_some(i32::from(step))
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
