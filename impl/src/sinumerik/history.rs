//! The standstill position kept through power-off, and its comparison with the reference position (part of machine M5).
//!
//! The position is stored whenever the operating stop is selected, and cyclically while limit switches or cams act. After
//! power-on the stored position, extended by the distance travelled since then, is compared with the reference position; the
//! result decides in [`crate::sinumerik::agreement`] whether a stored agreement is kept.
//!
//! Readings: A-23 SAVE_EVERY_SBH (also the operating stop forced by a stop stores; the caller forms `save`).

use crate::kernel::{ConfigError, Distance, Position};

config! {
    /// The comparison as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        tol: Distance,
    }
}

impl Config {
    /// `tol`: SAFE_REFP_POS_TOL, the greatest difference that keeps the agreement.
    ///
    /// # Errors
    /// None today: every tolerance is accepted.
    pub fn new(tol: Distance) -> Result<Self, ConfigError> {
        Ok(Self { tol })
    }

    /// The greatest difference that keeps the agreement.
    pub const fn tol(&self) -> Distance {
        self.tol
    }
}

fields! {
    /// The state between two cycles, non-volatile.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// A position has been stored.
        pub stored: bool,
        /// The stored position; 0 where none is.
        pub standstill: Position,
    }
}

impl State {
    /// Nothing stored, as delivered.
    pub const INITIAL: Self = Self {
        stored: false,
        standstill: Position(0),
    };

    /// The state read from the non-volatile memory; `None` where nothing is stored.
    pub const fn restored(standstill: Option<Position>) -> Self {
        match standstill {
            Some(standstill) => Self {
                stored: true,
                standstill,
            },
            None => Self::INITIAL,
        }
    }

    /// Without stored position there is none.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        self.stored || self.standstill.0 == 0
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: everything is kept, and nothing stored, since nothing has been measured yet.
        pub power_on: bool,
        /// Store the position: the operating stop holds, or limit switches or cams act.
        pub save: bool,
        /// The safe position. Before the axis is referenced: the stored one extended by the distance travelled.
        pub position: Position,
        /// The axis has been referenced in this cycle: nothing is stored, since the comparison, due in the next cycle, would
        /// compare the reference position with itself.
        pub reached: bool,
        /// The reference position: of the reference point, or of the absolute encoder at power-on.
        pub refpos: Position,
        /// The signed distance travelled since power-on or since the position was stored, whichever was later, to the reference
        /// point; 0 with an absolute encoder.
        pub travelled: i32,
    }
}

impl Inputs {
    /// The position is stored in this cycle.
    const fn stores(&self) -> bool {
        self.save && !self.power_on && !self.reached
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A position was stored before this cycle.
        pub stored: bool,
        /// The reference position is the one stored before this cycle, within the tolerance.
        pub history_ok: bool,
    }
}

/// How far the reference position is from the stored one extended by the distance travelled.
fn distance(state: State, inputs: &Inputs) -> u64 {
    let expected = i64::from(state.standstill.0) + i64::from(inputs.travelled);
    i64::from(inputs.refpos.0).abs_diff(expected)
}

monitor! { sinumerik::history;
    /// The comparison succeeds exactly up to the tolerance, itself included.
    succeeds_up_to_the_tolerance ["S840D-REF-004", "S840D-REF-007", "S840D-REF-008", "S840D-KDV-516"]:
        when |s| s.before.stored
            => s.outputs.history_ok == (distance(s.before, &s.inputs) <= u64::from(s.config.tol().0));

    /// Without a stored position the comparison fails.
    nothing_stored_fails ["S840D-REF-004", "S840D-REF-010"]:
        when |s| !s.before.stored
            => !s.outputs.history_ok && !s.outputs.stored;

    /// What is stored in a cycle does not count in its comparison.
    compares_with_the_state_before ["S840D-REF-007", "S840D-REF-010"]:
        when |s| s.inputs.save
            => s.outputs.stored == s.before.stored
                && (!s.outputs.history_ok || distance(s.before, &s.inputs) <= u64::from(s.config.tol().0));

    /// Storing takes the position of the cycle.
    stores_the_position ["S840D-REF-009", "S840D-PARAM-031"]:
        when |s| s.inputs.save && !s.inputs.power_on && !s.inputs.reached
            => s.after.stored && s.after.standstill == s.inputs.position;

    /// Otherwise the stored position is kept, through power-on too.
    kept_otherwise ["S840D-REF-009", "S840D-REF-010", "S840D-UA-007"]:
        when |s| !s.inputs.save
            => s.after == s.before;

    /// Power-on, and the cycle in which the axis is referenced, store nothing: the position from before is compared.
    comparison_is_not_overtaken ["S840D-REF-009", "S840D-REF-010", "S840D-PWR-001"]:
        when |s| s.inputs.power_on || s.inputs.reached
            => s.after == s.before;

    /// The step keeps the invariant and shows what was stored.
    state_stays_consistent ["S840D-REF-009"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.stored == s.before.stored;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let outputs = Outputs {
        stored: state.stored,
        history_ok: state.stored && distance(state, inputs) <= u64::from(config.tol.0),
    };
    let after = if inputs.stores() {
        State {
            stored: true,
            standstill: inputs.position,
        }
    } else {
        state
    };
    (after, outputs)
}
