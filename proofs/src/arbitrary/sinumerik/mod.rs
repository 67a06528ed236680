//! Monitors of the SINUMERIK 840D.

mod checking;
mod composing;
mod watching;

pub use checking::*;
pub use composing::*;
pub use watching::*;

use stillpoint_monitors::kernel::Cycles;

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::{
    agreement, external, fault, gear, group, reference, selection, stop,
};

use crate::source::Source;

/// Any transition times.
pub fn stop_config<S: Source>(source: &mut S) -> Option<stop::Config> {
    let t_b = source.any_delay(Cycles::TEN_SECONDS);
    let t_c = source.any_delay(Cycles::TEN_SECONDS);
    let t_d = source.any_delay(Cycles::SIXTY_SECONDS);
    let t_e = source.any_delay(Cycles::SIXTY_SECONDS);
    stop::Config::new(t_b, t_c, t_d, t_e).ok()
}

/// Any consistent state of the arbitration.
pub fn stop_state<S: Source>(source: &mut S, config: &stop::Config) -> Option<stop::State> {
    use stop::Phase;
    let level = source.any_of(&Level::ALL);
    let (phase, timer) = match level {
        Level::F => return None,
        Level::None => (Phase::Idle, Cycles::ZERO),
        Level::Test => (Phase::Testing, Cycles::ZERO),
        Level::A => (Phase::PulsesOff, Cycles::ZERO),
        Level::B => (Phase::BBraking, source.any_cycles(config.time(Level::B))),
        Level::E | Level::D | Level::C => {
            let longest = config
                .time(Level::C)
                .max(config.time(Level::D))
                .max(config.time(Level::E));
            let timer = source.any_cycles(longest);
            (
                if timer.is_zero() {
                    Phase::SbhInt
                } else {
                    Phase::Braking
                },
                timer,
            )
        }
    };
    let internal = source.any_of(&InternalStop::ALL);
    let external = source.any_of(&ExternalStop::ALL);
    let state = stop::State {
        internal,
        external,
        level,
        phase,
        timer,
    };
    state.invariant(config).then_some(state)
}

/// Any inputs of the arbitration.
pub fn stop_inputs<S: Source>(source: &mut S) -> stop::Inputs {
    stop::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        demand: source.any_of(&InternalStop::ALL),
        f_stop_b: source.any_bool(),
        rx_internal: source.any_of(&InternalStop::ALL),
        external: source.any_of(&ExternalStop::ALL),
        rx_external: source.any_of(&ExternalStop::ALL),
        test: source.any_bool(),
        standstill: source.any_bool(),
        fault: source.any_bool(),
        external_test: source.any_bool(),
    }
}

/// Any step of the arbitration.
pub fn stop<S: Source>(source: &mut S) -> Option<(stop::State, stop::Config, stop::Inputs)> {
    let config = stop_config(source)?;
    let state = stop_state(source, &config)?;
    Some((state, config, stop_inputs(source)))
}

/// Any step of the external stops.
pub fn external<S: Source>(
    source: &mut S,
) -> Option<(external::State, external::Config, external::Inputs)> {
    let config =
        external::Config::new(source.any_bool(), source.any_bool(), source.any_bool()).ok()?;
    let state = external::State {
        started: source.any_bool(),
        spl_latched: source.any_bool(),
    };
    let inputs = external::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        spl_started: source.any_bool(),
        sge_a: source.any_bool(),
        sge_c: source.any_bool(),
        sge_d: source.any_bool(),
        sge_e: source.any_bool(),
        spl_error: source.any_bool(),
    };
    Some((state, config, inputs))
}

/// Any inputs of STOP F.
pub fn fault_inputs<S: Source>(source: &mut S) -> fault::Inputs {
    fault::Inputs {
        power_on: source.any_bool(),
        reset: source.any_bool(),
        discrepancy: source.any_bool(),
        rx_fault: source.any_bool(),
        monitoring: source.any_bool(),
        cde_before: source.any_bool(),
        ab_before: source.any_bool(),
    }
}

/// Any step of STOP F.
pub fn fault<S: Source>(source: &mut S) -> Option<(fault::State, fault::Config, fault::Inputs)> {
    use fault::FaultState;
    let t_f = source.any_delay(Cycles::SIXTY_SECONDS);
    let config = fault::Config::new(t_f).ok()?;
    let fault = source.any_of(&[
        FaultState::None,
        FaultState::Latched,
        FaultState::Delay,
        FaultState::Expired,
    ]);
    let timer = if fault == FaultState::Delay {
        source.any_cycles(t_f)
    } else {
        Cycles::ZERO
    };
    let state = fault::State { fault, timer };
    state
        .invariant(&config)
        .then(|| (state, config, fault_inputs(source)))
}

/// Any limits and delay.
pub fn selection_config<S: Source>(source: &mut S) -> Option<(selection::Config, Cycles)> {
    selection_config_with(source, true)
}

/// Any limits and delay; factors only if they are `overridable`.
pub(super) fn selection_config_with<S: Source>(
    source: &mut S,
    overridable: bool,
) -> Option<(selection::Config, Cycles)> {
    let t_vel = source.any_delay(Cycles::SIXTY_SECONDS);
    let limits = [
        source.any_speed(),
        source.any_speed(),
        source.any_speed(),
        source.any_speed(),
    ];
    let mut config = selection::Config::new(source.any_bool(), t_vel, limits).ok()?;
    if overridable && source.any_bool() {
        let first = any_factor(source);
        let mut factors = [first; 16];
        let (_, others) = factors.split_at_mut(1);
        if source.enumerates() {
            // Two factors: what is chosen at index 0 and what elsewhere.
            others.fill(any_factor(source));
        } else {
            for factor in others {
                *factor = any_factor(source);
            }
        }
        config = config.with_override(factors).ok()?;
    }
    Some((config, t_vel))
}

/// Any override factor, 1 to 100 percent; the enumeration takes the ends.
fn any_factor<S: Source>(source: &mut S) -> u8 {
    100 - source.any_u32(0, 99) as u8
}

/// Any index of an override factor; the enumeration takes the ends.
pub fn factor_index<S: Source>(source: &mut S) -> selection::FactorIndex {
    selection::FactorIndex::new(source.any_u32(0, 15) as u8).unwrap_or_default()
}

/// Any inputs of the selection.
pub fn selection_inputs<S: Source>(source: &mut S) -> selection::Inputs {
    selection::Inputs {
        power_on: source.any_bool(),
        sge_sbh_sg: source.any_bool(),
        sge_sbh: source.any_bool(),
        sg_select: source.any_of(&selection::Stage::ALL),
        over: factor_index(source),
        sbh_internal: source.any_bool(),
        position: source.any_position(),
        ended_at: source.any_position(),
        set_anew: source.any_bool(),
    }
}

/// A factor that is in force wherever one can be.
const OTHER_FACTOR: selection::FactorIndex =
    selection::FactorIndex::from_bits(true, true, true, true);

/// Any consistent state of the selection.
pub fn selection_state<S: Source>(
    source: &mut S,
    config: &selection::Config,
) -> Option<selection::State> {
    use selection::{Mode, Stage, State};
    let mode = source.any_of(&[
        Mode::Nsb,
        Mode::Sg,
        Mode::SgDown,
        Mode::SbhPend,
        Mode::Sbh,
        Mode::SbhForced,
    ]);
    let mut state = State {
        mode,
        ..State::INITIAL
    };
    if matches!(mode, Mode::Sg | Mode::SgDown | Mode::SbhPend) {
        state.stage = source.any_of(&Stage::ALL);
        // Only a factor in force is a state: choosing it freely would mostly leave the invariant.
        if config.choice(state.stage, OTHER_FACTOR).factor == OTHER_FACTOR {
            state.factor = factor_index(source);
        }
    }
    if matches!(mode, Mode::SgDown | Mode::SbhPend) {
        state.timer = source.any_cycles(config.t_vel());
    }
    if mode == Mode::SgDown {
        state.target = source.any_of(&Stage::ALL);
        if config.choice(state.target, OTHER_FACTOR).factor == OTHER_FACTOR {
            state.target_factor = factor_index(source);
        }
    }
    if matches!(mode, Mode::Sbh | Mode::SbhForced) {
        state.reference = source.any_position();
    }
    state.invariant(config).then_some(state)
}

/// Any step of the selection; Kani takes those without override.
pub fn selection<S: Source>(
    source: &mut S,
) -> Option<(selection::State, selection::Config, selection::Inputs)> {
    let (config, _) = selection_config_with(source, !source.leaves_out())?;
    let state = selection_state(source, &config)?;
    Some((state, config, selection_inputs(source)))
}

/// Any step of the selection, with and without override.
pub fn selection_overridden<S: Source>(
    source: &mut S,
) -> Option<(selection::State, selection::Config, selection::Inputs)> {
    let (config, _) = selection_config(source)?;
    let state = selection_state(source, &config)?;
    Some((state, config, selection_inputs(source)))
}

/// Any step of the referencing.
pub fn reference<S: Source>(
    source: &mut S,
) -> Option<(reference::State, reference::Config, reference::Inputs)> {
    use reference::AxisState;
    let config = reference::Config::new(source.any_bool()).ok()?;
    let axis = source.any_of(&[
        AxisState::Off,
        AxisState::NotRef,
        AxisState::Ref,
        AxisState::SafeRef,
    ]);
    let state = reference::State {
        axis,
        fresh: axis == AxisState::Ref && source.any_bool(),
    };
    let inputs = reference::Inputs {
        power_on: source.any_bool(),
        run_up: source.any_bool(),
        referenced: source.any_bool(),
        reference_lost: source.any_bool(),
        parking: source.any_bool(),
        agreed_1: source.any_bool(),
        agreed_2: source.any_bool(),
    };
    state.invariant(&config).then_some((state, config, inputs))
}

/// Any inputs of the agreement.
pub fn agreement_inputs<S: Source>(source: &mut S) -> agreement::Inputs {
    agreement::Inputs {
        power_on: source.any_bool(),
        set: source.any_bool(),
        cancel: source.any_bool(),
        key: source.any_bool(),
        axis_ref: source.any_bool(),
        compare_due: source.any_bool(),
        history_ok: source.any_bool(),
        stored: source.any_bool(),
        gear_changed: source.any_bool(),
        altered: source.any_bool(),
        other_agreed: source.any_bool(),
    }
}

/// Any step of the agreement.
pub fn agreement<S: Source>(
    source: &mut S,
) -> Option<(agreement::State, agreement::Config, agreement::Inputs)> {
    let t_differ = source.any_delay(Cycles::SIXTY_SECONDS);
    let config = agreement::Config::new(t_differ, source.any_bool()).ok()?;
    let state = agreement::State {
        agreed: source.any_bool(),
        timer: source.any_cycles(t_differ),
    };
    state
        .invariant(&config)
        .then(|| (state, config, agreement_inputs(source)))
}

/// Any step of the gear stage.
pub fn gear<S: Source>(source: &mut S) -> Option<(gear::State, gear::Config, gear::Inputs)> {
    let config = gear::Config::new(source.any_in(0, 7) as u8, source.any_bool()).ok()?;
    let state = gear::State {
        stage: gear_index(source),
        known: source.any_bool(),
    };
    let inputs = gear::Inputs {
        power_on: source.any_bool(),
        index: gear_index(source),
    };
    Some((state, config, inputs))
}

/// Any gear index.
pub fn gear_index<S: Source>(source: &mut S) -> gear::GearIndex {
    gear::GearIndex::from_bits(source.any_bool(), source.any_bool(), source.any_bool())
}

/// Any question about the effect on another axis, also with a level below the latch, which no channel shows.
pub fn group<S: Source>(source: &mut S) -> Option<(group::State, group::Config, group::Inputs)> {
    let reach = source.any_of(&[group::Reach::Channel, group::Reach::Interpolating]);
    let inputs = group::Inputs {
        level: source.any_of(&Level::ALL),
        internal: source.any_of(&InternalStop::ALL),
        interpolates: source.any_bool(),
        esr: source.any_bool(),
    };
    Some((group::State::INITIAL, group::Config::new(reach), inputs))
}
