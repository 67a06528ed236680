//! Synchronisation of the actual values of both channels (machine M11), for axes with two encoders and slip.
//!
//! Where the comparison of the positions is due, each channel moves its own position by half of the difference towards the
//! other one. The correction persists. What is found too far apart is an error (STOP F) before it is corrected, so that the
//! comparison can be acknowledged. Speeds and standstill are monitored from the uncorrected position.

use crate::kernel::{ConfigError, Distance, Position};

/// The dead band of the manual: 2 um or 2 mdeg.
pub const DEAD_BAND: Distance = Distance(2);

config! {
    /// The synchronisation as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        dead: Distance,
        tol: Distance,
    }
    accepted |config| Config::new(config.dead, config.tol, true, false).is_ok()
}

impl Config {
    /// `dead`: differences below it are not corrected ([`DEAD_BAND`]). `tol`: SAFE_SLIP_VELO_TOL as the
    /// greatest difference of one comparison that is no error. `two_encoders`: the axis has two.
    /// `se_sn_enabled`: limit switches or cams are enabled on it.
    ///
    /// # Errors
    /// [`ConfigError::SynchronisationNotAllowed`] with one encoder, limit switches or cams (S840D-SLIP-501, S840D-SLIP-506,
    /// S840D-SLIP-701; alarms 27033 and 301708).
    pub fn new(
        dead: Distance,
        tol: Distance,
        two_encoders: bool,
        se_sn_enabled: bool,
    ) -> Result<Self, ConfigError> {
        if two_encoders && !se_sn_enabled {
            Ok(Self { dead, tol })
        } else {
            Err(ConfigError::SynchronisationNotAllowed)
        }
    }

    /// Differences below it are not corrected.
    pub const fn dead(&self) -> Distance {
        self.dead
    }

    /// The greatest difference that is no error.
    pub const fn tol(&self) -> Distance {
        self.tol
    }
}

/// The greatest offset that two positions can need.
const FARTHEST: i64 = u32::MAX as i64;

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the own position is corrected by, in increments.
        pub offset: i64,
    }
}

impl State {
    /// No correction.
    pub const INITIAL: Self = Self { offset: 0 };

    /// The offset is one that two positions can need.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        -FARTHEST <= self.offset && self.offset <= FARTHEST
    }

    /// A measured position, corrected; held at the ends of the range.
    pub const fn correct(&self, own: Position) -> Position {
        let sum = self.offset.saturating_add(own.0 as i64);
        if sum > i32::MAX as i64 {
            Position(i32::MAX)
        } else if sum < i32::MIN as i64 {
            Position(i32::MIN)
        } else {
            Position(sum as i32)
        }
    }

    /// By how much the corrected position is ahead of the other one.
    pub const fn ahead(&self, own: Position, other: Position) -> i64 {
        self.correct(own).0 as i64 - other.0 as i64
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: no correction.
        pub power_on: bool,
        /// The comparison of the positions is due in this cycle, or the axis has been referenced, or left parking.
        pub due: bool,
        /// The position measured in this channel, at the instant at which the other channel measured `other`: if that comes one
        /// cycle late, the position of one cycle ago. Otherwise the feed of a cycle would count as slip.
        pub own: Position,
        /// The corrected position of the other channel after its last cycle.
        pub other: Position,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The corrected position, after this cycle's correction.
        pub position: Position,
        /// The channels have been further apart than the tolerance: STOP F, code 3.
        pub error: bool,
    }
}

/// The offset that a step starts from.
fn start(state: State, inputs: &Inputs) -> State {
    if inputs.power_on {
        State::INITIAL
    } else {
        state
    }
}

monitor! { sinumerik::slip;
    /// The correction only ever brings the channels closer, and never past each other.
    never_overshoots ["S840D-SLIP-502"]:
        when |s| s.inputs.due
            => {
                let before = start(s.before, &s.inputs).ahead(s.inputs.own, s.inputs.other);
                let after = s.after.ahead(s.inputs.own, s.inputs.other);
                if before >= 0 { 0 <= after && after <= before } else { before <= after && after <= 0 }
            };

    /// The correction is half of the difference, rounded towards none; the other channel does the other half.
    corrects_half_of_the_difference ["S840D-SLIP-502"]:
        when |s| s.inputs.due
            && start(s.before, &s.inputs).ahead(s.inputs.own, s.inputs.other).unsigned_abs() >= u64::from(s.config.dead().0)
            => {
                let before = start(s.before, &s.inputs);
                let moved = before.offset - s.after.offset;
                let ahead = before.ahead(s.inputs.own, s.inputs.other);
                moved == ahead / 2
            };

    /// Within the dead band nothing is corrected.
    dead_band_is_left_alone ["S840D-SLIP-503"]:
        when |s| s.inputs.due
            && start(s.before, &s.inputs).ahead(s.inputs.own, s.inputs.other).unsigned_abs() < u64::from(s.config.dead().0)
            => s.after == start(s.before, &s.inputs);

    /// Between the comparisons the correction persists, and nothing is an error.
    correction_persists ["S840D-SLIP-502"]:
        when |s| !s.inputs.due
            => s.after == start(s.before, &s.inputs) && !s.outputs.error;

    /// A difference beyond the tolerance is an error, one at the tolerance is none.
    error_beyond_the_tolerance ["S840D-P-33", "S840D-SLIP-504", "S840D-KDV-505/b", "S840D-KDV-516"]:
        when |s| s.inputs.due
            => s.outputs.error
                == (start(s.before, &s.inputs).ahead(s.inputs.own, s.inputs.other).unsigned_abs() > u64::from(s.config.tol().0));

    /// The position shown is the measured one with the new correction.
    corrected_position_is_shown ["S840D-SLIP-502", "S840D-SLIP-505", "S840D-SLIP-506"]:
        when |s| s.inputs.due || s.after.offset != 0
            => s.outputs.position == s.after.correct(s.inputs.own);

    /// The step keeps the invariant: the correction never wraps.
    state_stays_consistent ["S840D-SLIP-502"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = start(state, inputs);
    let ahead = before.ahead(inputs.own, inputs.other);
    let corrects = inputs.due && ahead.unsigned_abs() >= u64::from(config.dead.0);
    let after = if corrects {
        State {
            offset: before.offset.saturating_sub(ahead / 2),
        }
    } else {
        before
    };
    let outputs = Outputs {
        position: after.correct(inputs.own),
        error: inputs.due && ahead.unsigned_abs() > u64::from(config.tol.0),
    };
    (after, outputs)
}
