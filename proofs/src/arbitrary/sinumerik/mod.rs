//! Monitors of the SINUMERIK 840D.

mod checking;
mod composing;
mod watching;

pub use checking::*;
pub use composing::*;
pub use watching::*;

use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::{selection, stop};

use crate::source::Source;

/// Any transition times.
pub fn stop_config<S: Source>(source: &mut S) -> Option<stop::Config> {
    let t_b = source.any_delay(Cycles::TEN_SECONDS);
    let t_c = source.any_delay(Cycles::TEN_SECONDS);
    let t_d = source.any_delay(Cycles::SIXTY_SECONDS);
    let t_e = source.any_delay(Cycles::SIXTY_SECONDS);
    stop::Config::new(t_b, t_c, t_d, t_e).ok()
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

/// Any step of the selection. By hand, since Kani takes those without override, and the enumeration two factors.
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
