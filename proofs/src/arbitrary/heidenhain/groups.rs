//! Stop and monitoring state of an axis group.

use stillpoint_monitors::heidenhain::types::{GroupState, Left, Phase, Stop, Unit};
use stillpoint_monitors::heidenhain::{
    axis_release, global_sto, group, judge, neighbour, report, startup, stop,
};

use super::kind;
use crate::source::Source;

/// Any times, either channel.
pub fn stop_config<S: Source>(source: &mut S) -> Option<stop::Config> {
    let t_ss1 = source.any_delay(stop::Config::LONGEST);
    let t_ss2 = source.any_delay(stop::Config::LONGEST);
    let t_brake = source.any_delay(stop::Config::LONGEST);
    stop::Config::new(source.any_bool(), t_ss1, t_ss2, t_brake).ok()
}

/// Any consistent state of the stop.
pub fn stop_state<S: Source>(source: &mut S, config: &stop::Config) -> Option<stop::State> {
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

/// Any inputs of the stop.
pub fn stop_inputs<S: Source>(source: &mut S) -> stop::Inputs {
    stop::Inputs {
        main_switch: source.any_bool(),
        demand: source.any_of(&Stop::ALL),
        wide_cause: source.any_bool(),
        still: source.any_bool(),
        listed_still: source.any_bool(),
        peer_off: source.any_bool(),
        restart: source.any_bool(),
    }
}

/// Any step of the stop.
pub fn stop<S: Source>(source: &mut S) -> Option<(stop::State, stop::Config, stop::Inputs)> {
    let config = stop_config(source)?;
    let state = stop_state(source, &config)?;
    Some((state, config, stop_inputs(source)))
}

/// Any inputs of the judgement.
pub fn judge_inputs<S: Source>(source: &mut S) -> judge::Inputs {
    judge::Inputs {
        main_switch: source.any_bool(),
        request: source.any_of(&GroupState::ALL),
        stop_request: source.any_of(&Stop::ALL),
        bad_code: source.any_bool(),
        state: source.any_of(&GroupState::ALL),
        moving: source.any_bool(),
        unit: source.any_of(&Unit::ALL),
        permissive: source.any_bool(),
        idle: source.any_bool(),
        gen_safe: source.any_bool(),
        untested: source.any_bool(),
    }
}

/// Any state of the judgement.
pub fn judge_state<S: Source>(source: &mut S) -> judge::State {
    judge::State {
        modes: source.any_of(&judge::Modes::ALL),
        place: source.any_of(&judge::Place::ALL),
    }
}

/// Any step of the judgement.
pub fn judge<S: Source>(source: &mut S) -> Option<(judge::State, judge::Config, judge::Inputs)> {
    let config = judge::Config::new(kind(source), source.any_bool()).ok()?;
    Some((judge_state(source), config, judge_inputs(source)))
}

/// Any step of the report to the other channel.
pub fn report<S: Source>(
    source: &mut S,
) -> Option<(report::State, report::Config, report::Inputs)> {
    let config = report::Config::new().ok()?;
    let inputs = report::Inputs {
        level: source.any_of(&Stop::ALL),
        phase: source.any_of(&Phase::ALL),
        found: source.any_of(&Stop::ALL),
    };
    Some((report::State::INITIAL, config, inputs))
}

/// Any stop of another group.
pub fn neighbour<S: Source>(
    source: &mut S,
) -> Option<(neighbour::State, neighbour::Config, neighbour::Inputs)> {
    let config = neighbour::Config::new(source.any_bool()).ok()?;
    let inputs = neighbour::Inputs {
        level: source.any_of(&Stop::ALL),
        phase: source.any_of(&Phase::ALL),
        wide: source.any_bool(),
    };
    Some((neighbour::State::INITIAL, config, inputs))
}

/// Any step of -STO.A.G.
pub fn global_sto<S: Source>(
    source: &mut S,
) -> Option<(global_sto::State, global_sto::Config, global_sto::Inputs)> {
    let t_off = source.any_delay(global_sto::Config::LONGEST);
    let config = global_sto::Config::new(t_off).ok()?;
    let on = source.any_bool();
    let timer = source.any_cycles(t_off);
    let state = global_sto::State { on, timer };
    let inputs = global_sto::Inputs {
        ss0: source.any_bool(),
        others_off: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any modes left in motion.
pub fn left<S: Source>(source: &mut S) -> Left {
    Left {
        sls_2: source.any_bool(),
        sls_3: source.any_bool(),
        sls_4: source.any_bool(),
    }
}

/// Any consistent monitoring state.
pub fn group_state<S: Source>(source: &mut S, config: &group::Config) -> Option<group::State> {
    let state = source.any_of(&GroupState::ALL);
    let slow = matches!(
        state,
        GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4
    );
    let left = if slow { left(source) } else { Left::NONE };
    let state = group::State { state, left };
    state.invariant(config).then_some(state)
}

/// Any inputs of the monitoring state.
pub fn group_inputs<S: Source>(source: &mut S) -> group::Inputs {
    group::Inputs {
        main_switch: source.any_bool(),
        request: source.any_of(&GroupState::ALL),
        activate: source.any_bool(),
        moving: source.any_bool(),
        gen_safe: source.any_bool(),
        demand: source.any_of(&Stop::ALL),
        phase: source.any_of(&Phase::ALL),
        soft: source.any_bool(),
        ss2_ended: source.any_bool(),
        switch_on: source.any_bool(),
        spindle_stop: source.any_bool(),
    }
}

/// Any step of the monitoring state.
pub fn group<S: Source>(source: &mut S) -> Option<(group::State, group::Config, group::Inputs)> {
    let config = group::Config::new(kind(source)).ok()?;
    let state = group_state(source, &config)?;
    Some((state, config, group_inputs(source)))
}

/// Any step of the start-up protection.
pub fn startup<S: Source>(
    source: &mut S,
) -> Option<(startup::State, startup::Config, startup::Inputs)> {
    let config = startup::Config::new(source.any_delay(startup::Config::LONGEST)).ok()?;
    let state = startup::State {
        timer: source.any_cycles(config.t_idle()),
    };
    let inputs = startup::Inputs {
        limited: source.any_bool(),
        moving: source.any_bool(),
        unit: source.any_of(&Unit::ALL),
        permissive: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any step of the release of an axis.
pub fn axis_release<S: Source>(
    source: &mut S,
) -> Option<(
    axis_release::State,
    axis_release::Config,
    axis_release::Inputs,
)> {
    use axis_release::Mode;
    let config = axis_release::Config::new(source.any_delay(stop::Config::LONGEST)).ok()?;
    let mode = source.any_of(&Mode::ALL);
    let mut state = axis_release::State {
        mode,
        ..axis_release::State::INITIAL
    };
    if mode == Mode::Ss2 {
        state.timer = source.any_cycles(config.started());
    }
    let inputs = axis_release::Inputs {
        group_released: source.any_bool(),
        feed: source.any_bool(),
        moving: source.any_bool(),
    };
    Some((state, config, inputs))
}
