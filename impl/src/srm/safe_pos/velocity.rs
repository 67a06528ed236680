//! The velocity from the counter of the telegram, and the drift of POS1 and POSSI.

use super::{Config, CountWatch, Inputs, State};
use crate::srm::common::um;

/// The counter of an input: signed, 16 bits.
pub(super) const fn counter(inputs: &Inputs) -> i32 {
    inputs.possi_count as i16 as i32
}

/// How far the counter has gone since another one, modulo 2^16.
const fn gone(from: i32, to: i32) -> i64 {
    // Of a negative number too the lower bits are what is left of it, counted up from a multiple.
    (to as i64 - from as i64) & 0xFFFF
}

/// The velocity, um and ms to mm/min, rounded up; none where it is no DInt or there is no time base.
pub(super) fn velocity(way: i64, count: i64, cycle: i32) -> Option<i32> {
    if count <= 0 || cycle <= 0 {
        return None;
    }
    let time = count * i64::from(cycle);
    let parts = way.abs() * 60;
    i32::try_from(parts / time + i64::from(parts % time != 0)).ok()
}

/// SAFE_V and the samples that it comes from.
pub(super) fn next(
    state: &State,
    after: &mut State,
    config: &Config,
    inputs: &Inputs,
    overflow: &mut bool,
) {
    after.seen_si = inputs.possi_valid;
    if !inputs.possi_valid {
        (after.sample, after.count, after.still) = (0, 0, 0);
        return;
    }
    let now = counter(inputs);
    let count = gone(state.count, now);
    if state.seen_si && count == 0 {
        let limit = config.standing().saturating_add(1);
        after.still = state.still.saturating_add(1).min(limit);
        return;
    }
    if state.seen_si {
        let way = i64::from(inputs.possi) - i64::from(state.sample);
        match velocity(way, count, config.possi_t_sample) {
            Some(velocity) => after.safe_v = velocity,
            None => *overflow = true,
        }
    }
    (after.sample, after.count, after.still) = (inputs.possi, now, 0);
}

/// Whether the ways of POS1 and POSSI differ too much in the window, or the counter stands too long; moves the window on.
pub(super) fn drifts(state: &State, after: &mut State, config: &Config, inputs: &Inputs) -> bool {
    let stands = config.count_watch == CountWatch::Watch && after.still > config.standing();
    if !after.phase.formed() {
        (after.window1, after.window_si, after.window_calls) = (0, 0, 0);
        return stands;
    }
    let entered = !state.phase.formed();
    let way1 = i64::from(inputs.pos1) - i64::from(state.window1);
    let way_si = i64::from(inputs.possi) - i64::from(state.window_si);
    let drift = um(way1) - way_si;
    let differ = !entered && drift.abs() > um(i64::from(config.v_disc_window));
    let calls = state.window_calls.saturating_add(1);
    if entered || calls >= config.window() {
        (after.window1, after.window_si, after.window_calls) = (inputs.pos1, inputs.possi, 0);
    } else {
        after.window_calls = calls;
    }
    differ || stands
}
