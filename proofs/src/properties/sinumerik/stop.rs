//! Runs of the arbitration over several cycles: what the one-step facts of the contract add up to.

use stillpoint_monitors::kernel::Cycles;

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::stop::{Config, Inputs, Phase, State};

use super::Subject;
use crate::arbitrary::sinumerik as arbitrary;
use crate::source::{Source, Verdict};

/// The longest delay in the runs below.
const LONGEST: u32 = 3;

/// From a STOP B the pulses are cancelled within t_B cycles, whatever the speed, RESET, the signals and the other monitors
/// do, as long as there is no power-on.
///
/// The run starts in any cycle in which STOP B is latched; cover 0: the whole time passes, cover 1: the axis stands still
/// before.
pub fn b_ends_with_pulses_cancelled<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let t_b = source.any_in(0, LONGEST);
    let Ok(config) = Config::new(
        Cycles::new(t_b),
        Cycles::new(1),
        Cycles::new(1),
        Cycles::new(1),
    ) else {
        return Verdict::Discarded;
    };
    let request = Inputs {
        demand: InternalStop::B,
        ..Inputs::default()
    };
    let (mut state, mut outputs) = subject.stop(State::INITIAL, &config, &request);
    let mut stood_still = false;
    let mut cycles = 0;
    while !outputs.cancel_pulses {
        if cycles == t_b {
            return Verdict::Broken("pulses_are_cancelled_within_t_b");
        }
        cycles += 1;
        let inputs = Inputs {
            reset: source.any_bool(),
            demand: source.any_of(&[InternalStop::None, InternalStop::C, InternalStop::B]),
            external: source.any_of(&[ExternalStop::None, ExternalStop::C]),
            test: source.any_bool(),
            standstill: source.any_bool(),
            ..Inputs::default()
        };
        stood_still |= inputs.standstill;
        (state, outputs) = subject.stop(state, &config, &inputs);
    }
    source.cover(0, cycles == t_b && t_b > 0 && !stood_still);
    source.cover(1, cycles < t_b && stood_still);
    if state.internal == InternalStop::A && state.level == Level::A {
        Verdict::Held
    } else {
        Verdict::Broken("stop_b_becomes_a_latched_stop_a")
    }
}

/// A STOP E, D or C is in the operating stop, or replaced by B or A, at the latest when the time of the first one is over;
/// the others coming up on the way do not prolong it.
///
/// Cover 0: the operating stop is reached at the last moment, cover 1: a higher stop with a shorter time shortens the way.
pub fn braking_ends_in_standstill<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let times = [
        source.any_in(0, LONGEST),
        source.any_in(0, LONGEST),
        source.any_in(0, LONGEST),
    ];
    let [t_c, t_d, t_e] = times.map(Cycles::new);
    let Ok(config) = Config::new(Cycles::new(2), t_c, t_d, t_e) else {
        return Verdict::Discarded;
    };
    let stops = [InternalStop::E, InternalStop::D, InternalStop::C];
    let first = source.any_of(&stops);
    let bound = config.time(first.level()).count();
    let request = Inputs {
        demand: first,
        ..Inputs::default()
    };
    let (mut state, mut outputs) = subject.stop(State::INITIAL, &config, &request);
    let mut cycles = 0;
    while outputs.phase == Phase::Braking {
        if cycles == bound {
            return Verdict::Broken("operating_stop_within_the_time_of_the_first_stop");
        }
        cycles += 1;
        let inputs = Inputs {
            reset: source.any_bool(),
            demand: source.any_of(&[InternalStop::None, InternalStop::D, InternalStop::C]),
            external: source.any_of(&[ExternalStop::None, ExternalStop::C]),
            ..Inputs::default()
        };
        (state, outputs) = subject.stop(state, &config, &inputs);
    }
    source.cover(0, cycles == bound && bound > 0);
    source.cover(1, cycles < bound);
    if outputs.sbh_internal && state.internal >= first {
        Verdict::Held
    } else {
        Verdict::Broken("braking_ends_in_the_operating_stop")
    }
}

/// A stop latched beneath an external STOP A acts when that is withdrawn, and starts its time then.
///
/// Cover 0: a queued STOP C, D or E, cover 1: a queued STOP B.
pub fn queued_stop_acts_after_withdrawal<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Some(config) = arbitrary::stop_config(source) else {
        return Verdict::Discarded;
    };
    let queued = source.any_of(&[
        InternalStop::E,
        InternalStop::D,
        InternalStop::C,
        InternalStop::B,
    ]);
    let held = Inputs {
        demand: queued,
        external: ExternalStop::A,
        ..Inputs::default()
    };
    let (state, _) = subject.stop(State::INITIAL, &config, &held);
    let idle = Inputs {
        external: ExternalStop::A,
        reset: source.any_bool(),
        ..Inputs::default()
    };
    let (state, beneath) = subject.stop(state, &config, &idle);
    let (state, outputs) = subject.stop(state, &config, &Inputs::default());
    source.cover(
        0,
        queued < InternalStop::B && outputs.phase == Phase::Braking,
    );
    source.cover(
        1,
        queued == InternalStop::B && outputs.phase == Phase::BBraking,
    );
    if !beneath.cancel_pulses || beneath.internal != queued {
        return Verdict::Broken("stop_stays_queued_under_external_stop_a");
    }
    let time = config.time(queued.level());
    let started = state.timer == time && (outputs.level == queued.level() || time.is_zero());
    if outputs.level >= queued.level() && started {
        Verdict::Held
    } else {
        Verdict::Broken("queued_stop_acts_with_its_own_time")
    }
}

/// Two channels that hand each other their stops let go of them by one RESET: no channel holds the other for ever.
///
/// The channels exchange what they latched in the cycle before; RESET is given to both at once when neither brakes.
/// Cover 0: the stop came from one channel only.
pub fn channels_do_not_hold_each_other<S: Source>(source: &mut S, subject: &Subject) -> Verdict {
    let Ok(config) = Config::new(Cycles::new(2), Cycles::new(1), Cycles::new(2), Cycles::ZERO)
    else {
        return Verdict::Discarded;
    };
    let stops = [
        InternalStop::None,
        InternalStop::E,
        InternalStop::D,
        InternalStop::C,
    ];
    let demands = [source.any_of(&stops), source.any_of(&stops)];
    let mut pair = [State::INITIAL; 2];
    // Enough cycles for the exchange and for the longest of the times, then RESET, then one more exchange.
    for cycle in 0..7 {
        let reset = cycle == 5;
        let sent = pair.map(|state| state.internal);
        for (channel, other) in [(0, 1), (1, 0)] {
            let inputs = Inputs {
                demand: if cycle == 0 {
                    demands[channel]
                } else {
                    InternalStop::None
                },
                rx_internal: sent[other],
                reset,
                ..Inputs::default()
            };
            (pair[channel], _) = subject.stop(pair[channel], &config, &inputs);
        }
        let highest = demands[0].max(demands[1]);
        if (1..5).contains(&cycle) && pair.iter().any(|state| state.internal != highest) {
            return Verdict::Broken("both_channels_take_the_higher_stop");
        }
    }
    source.cover(
        0,
        demands[0] != InternalStop::None && demands[1] == InternalStop::None,
    );
    if pair
        .iter()
        .all(|state| state.level == Level::None && state.internal == InternalStop::None)
    {
        Verdict::Held
    } else {
        Verdict::Broken("one_reset_frees_both_channels")
    }
}
