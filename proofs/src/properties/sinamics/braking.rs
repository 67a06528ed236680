//! Runs of monitored braking: what the one-step facts of SS1 and of its monitor add up to.

use stillpoint_monitors::kernel::{Cycles, Speed};
use stillpoint_monitors::sinamics::sbr::{self, SbrFloor, SbrStart};
use stillpoint_monitors::sinamics::ss1::{self, StopbTimer};
use stillpoint_monitors::sinamics::types::Braking;

use super::Subject;
use crate::source::{Source, Verdict};

/// The greatest speed of a run.
const FASTEST: u32 = 6;

/// Without encoder SS1 has no time (p9506 = 1). The ramp bounds it all the same: STO follows within t_d + (n0 - p9560) * p9583 / p9581
/// and one cycle more, whatever the speed does.
///
/// Cover 0: a slow axis ends it, cover 1: the ramp is violated, cover 2: the whole bound passes.
pub fn ss1_by_ramp_ends<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let start = Speed(source.any_in(0, FASTEST));
    let shutdown = Speed(source.any_in(1, 2));
    let (reference, time) = (source.any_in(1, 3), source.any_in(1, 2));
    let ramp = sbr::Config::new(
        Speed(reference),
        Cycles::new(time),
        Cycles::new(2),
        Speed(0),
        SbrStart::Trigger,
        SbrFloor::Resolution,
    );
    let stop = ss1::Config::new(
        Cycles::new(1),
        shutdown,
        Braking::BareSbr,
        false,
        StopbTimer::Timer,
    );
    let (Ok(ramp), Ok(stop)) = (ramp, stop) else {
        return Verdict::Discarded;
    };
    let Some(bound) = ramp.longest(start, shutdown) else {
        return Verdict::Discarded;
    };
    if bound > 9 {
        return Verdict::Discarded;
    }
    let (mut watch, mut state) = (sbr::State::INITIAL, ss1::State::INITIAL);
    let mut speed = start;
    for cycle in 0..=bound + 1 {
        let braking = sbr::Inputs {
            braking: true,
            speed,
        };
        let (watched, seen) = subject.sbr(watch, &ramp, &braking);
        let inputs = ss1::Inputs {
            selected: true,
            drive_on: true,
            ramp_violated: seen.violated,
            speed,
            ..ss1::Inputs::default()
        };
        let (after, outputs) = subject.ss1(state, &stop, &inputs);
        if outputs.sto {
            source.cover(0, !outputs.violated);
            source.cover(1, outputs.violated);
            source.cover(2, cycle == bound + 1);
            return Verdict::Held;
        }
        (watch, state) = (watched, after);
        speed = Speed(source.any_in(0, FASTEST));
    }
    Verdict::Broken("sto_follows_within_the_bound_of_the_ramp")
}
