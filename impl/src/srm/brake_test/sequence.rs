//! The rows of the brake test: where it goes in a call.

use super::{Config, Inputs, Phase, SbtFresh, State};
use crate::kernel::Cycles;
use crate::srm::common::{apart, rises};

/// The bit of the brake that is tested: its times.
const fn time_bit(second: bool) -> u16 {
    1 << second as u16
}

const MOVED: u16 = 1 << 3;
const IMPLAUSIBLE: u16 = 1 << 6;
const NO_ENABLE: u16 = 1 << 7;
const NO_POSITION: u16 = 1 << 8;
const NOT_SELECTED: u16 = 1 << 9;
const NOT_ASKED: u16 = 1 << 10;

/// What a call makes of the test.
enum Row {
    Stays,
    Fails(u16),
    To(Phase, Cycles),
    Begins,
    First,
    PassesOne,
    Acknowledged,
}

/// The bits of the fault that cancels a running test, if there is one; 0 where the fault has its bit elsewhere.
fn fault(state: &State, config: &Config, inputs: &Inputs, keeps: bool) -> Option<u16> {
    let sbt = &inputs.sbt;
    let external = config.external(state.second);
    if !state.phase.busy() {
        return None;
    }
    if !inputs.pos_valid {
        return Some(NO_POSITION);
    }
    if !keeps {
        return Some(0);
    }
    if !state.phase.tests() {
        return None;
    }
    if external && !inputs.fdback_drive {
        return Some(NO_ENABLE);
    }
    if apart(inputs.safe_pos, state.start) > i64::from(config.pos_tolerance) {
        return Some(MOVED);
    }
    let told = sbt.active && !sbt.finished;
    let asked = external && sbt.close_br && matches!(state.phase, Phase::Start | Phase::Close);
    let contradicts = sbt.active_br != state.second && (told || asked);
    let negative = sbt.finished && !sbt.result && state.phase != Phase::Start;
    if !sbt.selected || contradicts || negative {
        return Some(IMPLAUSIBLE);
    }
    None
}

/// The row of a call without a fault. Torque and result have no time limit (SRM-BRAKETEST-053).
fn row(state: &State, config: &Config, inputs: &Inputs) -> Row {
    let sbt = &inputs.sbt;
    let second = state.second;
    let external = config.external(second);
    let fresh = config.sbt_fresh == SbtFresh::Fresh;
    let ready = !sbt.finished || !fresh;
    let passes = sbt.finished && sbt.result && (state.ran || !fresh);
    let over = state.timer.tick().is_zero();
    let closed = if second {
        inputs.fdback_br_2
    } else {
        inputs.fdback_br_1
    };
    match state.phase {
        Phase::Unproven | Phase::Passed => {
            let possible = inputs.pos_valid
                && inputs.v_valid
                && config.parameter_bits() == 0
                && !state.fast
                && !state.overflowed
                && (config.tests(false) || config.tests(true));
            if possible && rises(inputs.execute, state.execute_held) {
                Row::Begins
            } else {
                Row::Stays
            }
        }
        Phase::Select if sbt.selected => Row::First,
        Phase::Select if over => Row::Fails(NOT_SELECTED),
        Phase::Start if external && sbt.close_br && ready => {
            Row::To(Phase::Close, config.travel(second, true))
        }
        Phase::Start if !external && sbt.active && ready => Row::To(Phase::Torque, Cycles::ZERO),
        Phase::Start if over && external => Row::Fails(NOT_ASKED),
        Phase::Start if over => Row::Fails(IMPLAUSIBLE),
        Phase::Close if over && closed => Row::To(Phase::Torque, Cycles::ZERO),
        Phase::Open if over && !closed => Row::To(Phase::Result, Cycles::ZERO),
        Phase::Close | Phase::Open if over => Row::Fails(time_bit(second)),
        Phase::Torque if external && !sbt.close_br => {
            Row::To(Phase::Open, config.travel(second, false))
        }
        Phase::Torque if !external && passes => Row::PassesOne,
        Phase::Result if passes => Row::PassesOne,
        Phase::Failed if rises(inputs.ack, state.ack_held) => Row::Acknowledged,
        _ => Row::Stays,
    }
}

/// The first sequence of a brake, or of the next one, from this one on.
const fn from(config: &Config, second: bool, sequence: u8) -> Option<(bool, u8)> {
    let first = sequence.saturating_add(if second { 4 } else { 0 });
    let mut place = 0;
    while place < 8 {
        let (of_second, here) = (place >= 4, place % 4);
        if place >= first && config.has(of_second, here) {
            return Some((of_second, here));
        }
        place += 1;
    }
    None
}

/// The state with no test in it.
fn ended(state: &State, phase: Phase) -> State {
    State {
        phase,
        second: false,
        sequence: 0,
        timer: Cycles::ZERO,
        ran: false,
        start: 0,
        ..*state
    }
}

/// A sequence is started.
fn started(state: &State, config: &Config, (second, sequence): (bool, u8)) -> State {
    State {
        phase: Phase::Start,
        second,
        sequence,
        timer: config.t_mon_req,
        ran: false,
        first_ok: second && config.tests(false),
        ..*state
    }
}

/// The test after a call; commands, latches of the velocity and the interval are the caller's business.
pub(super) fn next(state: &State, config: &Config, inputs: &Inputs, keeps: bool) -> State {
    let failed = |bits: u16| State {
        faults: state.faults | bits,
        ..ended(state, Phase::Failed)
    };
    if let Some(bits) = fault(state, config, inputs, keeps) {
        return failed(bits);
    }
    match row(state, config, inputs) {
        Row::Stays => State {
            timer: state.timer.tick(),
            ran: state.ran || state.phase.tests() && inputs.sbt.active && !inputs.sbt.finished,
            ..*state
        },
        Row::Fails(bits) => failed(bits),
        Row::To(phase, timer) => State {
            phase,
            timer,
            ran: state.ran || inputs.sbt.active && !inputs.sbt.finished,
            ..*state
        },
        // A test that begins too fast has failed at once.
        Row::Begins => State {
            first_ok: false,
            tried: true,
            ..if keeps {
                State {
                    phase: Phase::Select,
                    timer: config.t_mon_sel,
                    start: inputs.safe_pos,
                    ..*state
                }
            } else {
                ended(state, Phase::Failed)
            }
        },
        Row::First => match from(config, false, 0) {
            Some(place) => started(state, config, place),
            None => failed(IMPLAUSIBLE),
        },
        Row::PassesOne => {
            let following = match state.sequence {
                0..=2 => from(config, state.second, state.sequence + 1),
                _ if state.second => None,
                _ => from(config, true, 0),
            };
            match following {
                Some(place) => started(state, config, place),
                None => State {
                    first_ok: config.tests(false),
                    faults: 0,
                    ..ended(state, Phase::Passed)
                },
            }
        }
        Row::Acknowledged => ended(state, Phase::Unproven),
    }
}
