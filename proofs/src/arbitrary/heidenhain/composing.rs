//! The channel: the state of every monitor at once.
//!
//! The whole product is what Kani takes and what random tests draw from. It is too large to enumerate; the enumeration takes
//! parts of it, each free in what one group of laws is about.

use stillpoint_monitors::heidenhain::types::{GroupState, Left, Phase, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{channel, gate, group, judge, startup, stop};
use stillpoint_monitors::kernel::Cycles;

use crate::draw::any;
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

/// Any times, either channel.
fn stop_config<S: Source>(source: &mut S) -> Option<stop::Config> {
    let t_ss1 = source.any_delay(stop::Config::LONGEST);
    let t_ss2 = source.any_delay(stop::Config::LONGEST);
    let t_brake = source.any_delay(stop::Config::LONGEST);
    stop::Config::new(source.any_bool(), t_ss1, t_ss2, t_brake).ok()
}

/// Any consistent state of the stop.
fn stop_state<S: Source>(source: &mut S, config: &stop::Config) -> Option<stop::State> {
    let phase = source.any_of(&Phase::ALL);
    let mut state = stop::State {
        phase,
        ..stop::State::INITIAL
    };
    match phase {
        Phase::Run => {}
        Phase::Ss2Wait | Phase::Ss2Brake => {
            state.level = Stop::Ss2;
            state.timer = source.any_cycles(stop::started(config.t_ss2()));
        }
        Phase::Ss1DWait => {
            state.level = Stop::Ss1D;
            state.timer = source.any_cycles(stop::started(config.t_ss2()));
        }
        Phase::EmergencyBrake | Phase::BrakeCloses => {
            state.level = source.any_of(&[Stop::Ss1D, Stop::Ss1, Stop::Ss1F]);
            state.timer = source.any_cycles(stop::started(config.t_ss1()));
            if phase == Phase::BrakeCloses {
                state.brake = source.any_cycles(stop::started(config.t_brake()));
            }
        }
        Phase::TorqueOff => {
            state.level = source.any_of(&[Stop::Ss1D, Stop::Ss1, Stop::Ss1F, Stop::Ss0]);
        }
    }
    let ramp = matches!(phase, Phase::EmergencyBrake | Phase::BrakeCloses);
    state.wide = ramp && state.level >= Stop::Ss1 && source.any_bool();
    state.invariant(config).then_some(state)
}

/// Any consistent monitoring state.
fn group_state<S: Source>(source: &mut S, config: &group::Config) -> Option<group::State> {
    let state = source.any_of(&GroupState::ALL);
    let slow = matches!(
        state,
        GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4
    );
    let left = if slow { any(source) } else { Left::NONE };
    let state = group::State { state, left };
    state.invariant(config).then_some(state)
}

/// Any fields of the interface: every code, and for the others one beyond them and the highest number.
fn gate_inputs<S: Source>(source: &mut S) -> gate::Inputs {
    gate::Inputs {
        state_code: source.any_u32(8, u32::from(u8::MAX)) as u8,
        stop_code: source.any_u32(5, u32::from(u8::MAX)) as u8,
        som_code: source.any_u32(4, u32::from(u8::MAX)) as u8,
        activate: source.any_bool(),
        permissive: source.any_bool(),
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
    let config =
        channel::Config::new(any(source), true, brief(source.any_bool())?, Cycles::new(2)).ok()?;
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
    let config = channel::Config::new(any(source), true, stop, Cycles::new(2)).ok()?;
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
    let config =
        channel::Config::new(any(source), true, brief(source.any_bool())?, Cycles::new(2)).ok()?;
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
    let (kind, som_4) = (any(source), source.any_bool());
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
            any(source)
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
