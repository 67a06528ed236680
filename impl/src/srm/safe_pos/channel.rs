//! The rows of the position: faults, validation, commands.

use super::{Config, Inputs, Phase, State, SyncPos2};
use crate::srm::common::{rises, um};

/// The positions with their offsets, exact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Positions {
    /// POS1, mm.
    pub one: i64,
    /// POSSI, um.
    pub motor: i64,
    /// POS2, which counts the other way, mm.
    pub two: i64,
}

impl Positions {
    pub(super) fn of(state: &State, inputs: &Inputs) -> Self {
        Self {
            one: i64::from(inputs.pos1) + i64::from(state.off1),
            motor: i64::from(inputs.possi) + i64::from(state.off_si),
            two: i64::from(state.off2) - i64::from(inputs.pos2),
        }
    }

    /// POS1 and POSSI are in a window.
    pub(super) fn motor_near(&self, window: i32) -> bool {
        (um(self.one) - self.motor).abs() <= um(i64::from(window))
    }

    /// POS1 and POS2 are in a window.
    pub(super) fn two_near(&self, window: i32) -> bool {
        (self.one - self.two).abs() <= i64::from(window)
    }
}

/// POS1 has changed by more than twice V_MAX between two calls with a valid one (AMB-11); nothing else is a step (SRM-POS-005,
/// SRM-POS-025).
pub(super) fn steps(state: &State, config: &Config, inputs: &Inputs) -> bool {
    let change = (i64::from(inputs.pos1) - i64::from(state.last1)).abs();
    // The narrow factor first: a model checker adds once for each of its bits.
    let permitted = i64::from(config.t_sample) * i64::from(config.v_max);
    inputs.pos1_valid && state.seen1 && 30 * um(change) > permitted
}

/// The reference has survived, as far as the encoders tell.
fn confirmed(state: &State, config: &Config, positions: &Positions) -> bool {
    if config.pos_config {
        positions.two_near(config.pos_disc_window) && positions.two_near(config.pos2_disc_window)
    } else if state.si_failed {
        (positions.one - i64::from(state.saved)).abs() <= i64::from(config.pos_startup_tol)
    } else {
        positions.motor_near(config.pos_disc_window)
            && positions.motor_near(config.possi_disc_window)
    }
}

/// The position in use has gone from what makes it plausible.
fn discrepant(config: &Config, positions: &Positions) -> bool {
    !positions.motor_near(config.possi_disc_window)
        || config.pos_config && !positions.two_near(config.pos2_disc_window)
}

/// No bit of an encoder fault or a discrepancy is left.
fn cleared(state: State) -> State {
    State {
        was_ref: false,
        si_failed: false,
        apart: false,
        strayed: false,
        unconfirmed: false,
        unconfirmed2: false,
        ..state
    }
}

/// POSSI, and where it is asked for POS2, moved to POS1; none where an offset is no DInt.
fn aligned(state: State, inputs: &Inputs, both: bool) -> Option<State> {
    let one = Positions::of(&state, inputs).one;
    let off_si = i32::try_from(um(one) - i64::from(inputs.possi)).ok()?;
    let off2 = if both {
        i32::try_from(one + i64::from(inputs.pos2)).ok()?
    } else {
        state.off2
    };
    Some(State {
        off_si,
        off2,
        ..state
    })
}

/// All positions at the reference point.
fn referenced(state: State, config: &Config, inputs: &Inputs) -> Option<State> {
    let off1 = config.pos_reference.checked_sub(inputs.pos1)?;
    let there = aligned(State { off1, ..state }, inputs, config.pos_config)?;
    Some(State {
        phase: Phase::Referenced,
        ever: true,
        saved: config.pos_reference,
        ..cleared(there)
    })
}

/// A fault of an encoder, or a discrepancy that is treated as one.
fn faulty(state: &State) -> State {
    let fresh = !state.phase.faulty();
    State {
        phase: Phase::EncoderFault,
        was_ref: state.was_ref || state.phase == Phase::Referenced,
        si_failed: state.si_failed && !fresh,
        saved: if state.phase.formed() || !fresh {
            state.saved
        } else {
            0
        },
        ..*state
    }
}

/// After a fault, with all encoders back: valid or not, with the bit that says why not.
fn validated(state: &State, config: &Config, positions: &Positions) -> State {
    if state.was_ref && confirmed(state, config, positions) {
        return State {
            phase: Phase::Valid,
            ..*state
        };
    }
    let lost = state.was_ref;
    State {
        phase: Phase::Invalid,
        strayed: state.strayed || lost && !config.pos_config && state.si_failed,
        unconfirmed: state.unconfirmed || lost && !config.pos_config && !state.si_failed,
        unconfirmed2: state.unconfirmed2 || lost && config.pos_config,
        ..*state
    }
}

/// The state after a call, as far as positions go.
pub(super) fn next(state: &State, config: &Config, inputs: &Inputs, overflow: &mut bool) -> State {
    if !inputs.valid(config) || steps(state, config, inputs) {
        let after = faulty(state);
        return State {
            si_failed: after.si_failed || !inputs.possi_valid,
            ..after
        };
    }
    let positions = Positions::of(state, inputs);
    if state.phase == Phase::EncoderFault {
        return validated(state, config, &positions);
    }
    if state.phase.formed() && discrepant(config, &positions) {
        if config.pos_config {
            return faulty(state);
        }
        return State {
            phase: Phase::Discrepant,
            apart: true,
            saved: 0,
            ..*state
        };
    }
    // A command whose offsets are no DInt is not executed.
    let mut executed = |made: Option<State>| {
        *overflow |= made.is_none();
        made.unwrap_or(*state)
    };
    if rises(inputs.reference, state.reference_held) {
        return executed(referenced(*state, config, inputs));
    }
    if rises(inputs.sync, state.sync_held) {
        let keeps = state.phase == Phase::Referenced;
        let both = config.pos_config && (!keeps || config.sync_pos2 == SyncPos2::Align);
        let made = aligned(*state, inputs, both);
        return executed(made.map(|made| {
            if made.phase.formed() {
                made
            } else {
                State {
                    phase: Phase::Synced,
                    ..cleared(made)
                }
            }
        }));
    }
    if state.phase.faulty() {
        let valid = state.was_ref && confirmed(state, config, &positions);
        if valid && rises(inputs.ack, state.ack_held) {
            let made = if config.pos_config || state.si_failed {
                aligned(*state, inputs, false)
            } else {
                Some(*state)
            };
            return executed(made.map(|made| State {
                phase: Phase::Referenced,
                ..cleared(made)
            }));
        }
        return validated(state, config, &positions);
    }
    *state
}
