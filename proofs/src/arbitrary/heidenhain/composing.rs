//! The channel: the state of every monitor at once.
//!
//! The whole product is what Kani takes and what random tests draw from. It is too large to enumerate; the enumeration takes
//! parts of it, each free in what one group of laws is about.

use stillpoint_monitors::heidenhain::types::{GroupState, Left, Phase, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{channel, gate, judge, startup, stop};
use stillpoint_monitors::kernel::Cycles;

use super::{gate_inputs, group_state, judge_state, kind, stop_config, stop_state};
use crate::source::Source;

type Step = (channel::State, channel::Config, channel::Inputs);

/// Any step of a channel.
pub fn channel<S: Source>(source: &mut S) -> Option<Step> {
    match source.any_part(3) {
        1 => requested(source),
        2 => stopped(source),
        3 => permitted(source),
        _ => whole(source),
    }
}

/// What the other channel may have taken over: what its `gate` gives.
fn peer<S: Source>(source: &mut S, stops: &[Stop]) -> gate::Outputs {
    let stop = source.any_of(stops);
    gate::Outputs {
        request: source.any_of(&GroupState::ALL),
        stop,
        som: Som::Som1,
        starts: stop != Stop::Ss1F && source.any_bool(),
        held: stop != Stop::Ss1F && source.any_bool(),
    }
}

/// Short times for the parts that are not about them.
fn brief(cc: bool) -> Option<stop::Config> {
    let time = Cycles::new(2);
    stop::Config::new(cc, time, time, Cycles::new(1)).ok()
}

/// A cycle in which nothing is asked for: doors closed, every field legal.
fn quiet() -> channel::Inputs {
    channel::Inputs {
        peer: gate::Outputs {
            request: GroupState::Auto,
            ..gate::Outputs::default()
        },
        gen_safe: true,
        listed_still: true,
        ..channel::Inputs::default()
    }
}

/// Any requests of both channels, in every monitoring state without a stop.
fn requested<S: Source>(source: &mut S) -> Option<Step> {
    let config = channel::Config::new(
        kind(source),
        true,
        brief(source.any_bool())?,
        Cycles::new(2),
    )
    .ok()?;
    let group = group_state(source, config.group())?;
    // Which limits of other modes are left makes no difference to the channel: all of them, or none.
    let all = group.left.sls_2 && group.left.sls_3 && group.left.sls_4;
    if !(all || group.left.is_none()) {
        return None;
    }
    let state = channel::State {
        group,
        ..channel::State::INITIAL
    };
    let codes = [0, 1, 3, 4, 5, 6, 7, 8];
    let inputs = channel::Inputs {
        fields: gate::Inputs {
            state_code: source.any_of(&codes),
            stop_code: source.any_of(&[0, 1, 5]),
            som_code: 0,
            activate: source.any_bool(),
            permissive: source.any_bool(),
        },
        peer: peer(source, &[Stop::None, Stop::Ss1F]),
        late: source.any_bool(),
        moving: source.any_bool(),
        unit: source.any_of(&[Unit::Panel, Unit::Program]),
        gen_safe: source.any_bool(),
        ..quiet()
    };
    Some((state, config, inputs))
}

/// Any stop with its causes and times, in two monitoring states.
fn stopped<S: Source>(source: &mut S) -> Option<Step> {
    let stop = stop_config(source)?;
    let config = channel::Config::new(kind(source), true, stop, Cycles::new(2)).ok()?;
    let mut state = channel::State {
        stop: stop_state(source, &stop)?,
        ..channel::State::INITIAL
    };
    let off = state.stop.phase == Phase::TorqueOff;
    state.group.state = if off || source.any_bool() {
        GroupState::Sto
    } else {
        GroupState::Auto
    };
    let inputs = channel::Inputs {
        main_switch: source.any_bool(),
        monitors: source.any_of(&Stop::ALL),
        told: source.any_of(&[Stop::None, Stop::Ss2, Stop::Ss1, Stop::Ss0]),
        machine: source.any_of(&[Stop::None, Stop::Ss1, Stop::Ss1F]),
        moving: source.any_bool(),
        listed_still: source.any_bool(),
        peer_off: source.any_bool(),
        ..quiet()
    };
    Some((state, config, inputs))
}

/// Any permission to switch the drives on, without torque.
fn permitted<S: Source>(source: &mut S) -> Option<Step> {
    let config = channel::Config::new(
        kind(source),
        true,
        brief(source.any_bool())?,
        Cycles::new(2),
    )
    .ok()?;
    let mut state = channel::State::INITIAL;
    state.stop.level = source.any_of(&[Stop::None, Stop::Ss1D, Stop::Ss1, Stop::Ss1F, Stop::Ss0]);
    if state.stop.level != Stop::None {
        state.stop.phase = Phase::TorqueOff;
    }
    state.group.state = source.any_of(&[GroupState::Sto, GroupState::StoO]);
    state.permitted = source.any_bool();
    state.fresh = source.any_bool();
    let inputs = channel::Inputs {
        main_switch: source.any_bool(),
        fields: gate::Inputs {
            state_code: source.any_of(&[0, 5, 6, 7]),
            activate: source.any_bool(),
            ..gate::Inputs::default()
        },
        peer: peer(source, &[Stop::None]),
        told: source.any_of(&[Stop::None, Stop::Ss2, Stop::Ss1D, Stop::Ss1]),
        moving: source.any_bool(),
        permit: source.any_bool(),
        voltage: source.any_bool(),
        spindle_stop: source.any_bool(),
        ..quiet()
    };
    Some((state, config, inputs))
}

/// Any step at all.
fn whole<S: Source>(source: &mut S) -> Option<Step> {
    let (kind, som_4) = (kind(source), source.any_bool());
    let stop = stop_config(source)?;
    let idle = source.any_delay(startup::Config::LONGEST);
    let config = channel::Config::new(kind, som_4, stop, idle).ok()?;
    let mut state = channel::State {
        startup: startup::State {
            timer: source.any_cycles(config.startup().t_idle()),
        },
        judge: if source.any_bool() {
            judge::State::INITIAL
        } else {
            judge_state(source)
        },
        stop: stop_state(source, &stop)?,
        group: group_state(source, config.group())?,
        permitted: source.any_bool(),
        fresh: false,
    };
    if state.stop.phase == Phase::TorqueOff {
        state.group.left = Left::NONE;
        state.group.state = source.any_of(&[GroupState::Sto, GroupState::StoO]);
    }
    let off = matches!(state.group.state, GroupState::Sto | GroupState::StoO);
    state.fresh = off && source.any_bool();
    let inputs = channel::Inputs {
        main_switch: source.any_bool(),
        fields: gate_inputs(source),
        peer: peer(source, &Stop::ALL),
        late: source.any_bool(),
        moving: source.any_bool(),
        unit: source.any_of(&Unit::ALL),
        gen_safe: source.any_bool(),
        untested: source.any_bool(),
        monitors: source.any_of(&Stop::ALL),
        told: source.any_of(&Stop::ALL),
        machine: source.any_of(&Stop::ALL),
        at_rest: source.any_bool(),
        listed_still: source.any_bool(),
        peer_off: source.any_bool(),
        permit: source.any_bool(),
        voltage: source.any_bool(),
        spindle_stop: source.any_bool(),
    };
    Some((state, config, inputs))
}
