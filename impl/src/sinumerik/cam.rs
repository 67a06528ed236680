//! One safe software cam (SN) of one channel: whether the axis is beyond a position.
//!
//! Eight of these make the cams SN1+ to SN4- of a channel. A cam raises no stop; the user's logic reacts. Its signal is safe
//! only with the signal "axis safely referenced". With cam synchronisation the signal has a hysteresis, and it is 1 only if
//! the other channel agrees, so that both channels show the same at standstill.
//!
//! Recommended readings of the manual implemented here: A-03 CAM_GT, beyond gives 1 for plus and minus cams alike; A-40
//! HYST_UP, on above cam + tolerance and off at the cam.

use crate::kernel::{ConfigError, Distance, Position};
use crate::units::ModuloRange;

config! {
    /// The cam.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        enabled: bool,
        cam: Position,
        tol: Distance,
        sync: bool,
        range: ModuloRange,
    }
    accepted |config| {
        let range = config.range;
        ModuloRange::new(range.lower(), range.upper()).is_ok()
            && Config::new(config.enabled, config.cam, config.tol, config.sync, range, Distance(0)).is_ok()
    }
}

impl Config {
    /// `enabled`: the bit of the cam in the enable word (8 to 15). `cam`: its position, rounded down. `tol`: the width of
    /// the hysteresis (`SAFE_CAM_TOL`, 36940 / 1340), rounded down. `sync`: cam synchronisation (bit 7). `range`: where
    /// positions are folded to. `pos_tol`: the tolerance of the position comparison (`SAFE_POS_TOL`, 36942 / 1342), only
    /// for the check that an enabled cam keeps its distance from the limits of `range`.
    ///
    /// # Errors
    /// [`ConfigError::CamNearModuloLimit`] when an enabled cam is closer to a limit of `range` than the tolerances.
    pub fn new(
        enabled: bool,
        cam: Position,
        tol: Distance,
        sync: bool,
        range: ModuloRange,
        pos_tol: Distance,
    ) -> Result<Self, ConfigError> {
        let config = Self {
            enabled,
            cam,
            tol,
            sync,
            range,
        };
        // The lower modulo value of the manual's worked example is the last position before the range, 359.999 degrees: a
        // channel that is just beyond such a cam sees the other one, nearer to the end by the tolerance, not yet folded.
        let lowest = i64::from(range.lower().0) - 1 + i64::from(pos_tol.0);
        let end = i64::from(range.upper().0) - i64::from(pos_tol.0);
        let fits = i64::from(cam.0) >= lowest && end > config.on_above();
        if enabled && range.folds() && !fits {
            Err(ConfigError::CamNearModuloLimit)
        } else {
            Ok(config)
        }
    }

    /// Whether the channels may see the cam differently at this position: within its tolerance (S840D-SN-005,
    /// S840D-PARAM-014).
    pub const fn tolerates(&self, position: Position) -> bool {
        self.range.folded(position).distance(self.cam).0 <= self.tol.0
    }

    /// Beyond this position the signal is 1 in any case.
    fn on_above(&self) -> i64 {
        let width = if self.sync { i64::from(self.tol.0) } else { 0 };
        i64::from(self.cam.0) + width
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The result of this channel.
        pub own: bool,
    }
}

impl State {
    /// Not beyond the cam.
    pub const INITIAL: Self = Self { own: false };

    /// A cam that is not enabled is never passed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        config.enabled || !self.own
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// The actual position.
        pub position: Position,
        /// The result of the other channel, one cycle old; used with cam synchronisation only.
        pub other: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The result of this channel: for the other channel and for the comparison of the results.
        pub own: bool,
        /// SGA of the cam.
        pub sga: bool,
    }
}

monitor! { sinumerik::cam;
    /// Beyond the cam, and beyond the hysteresis if there is one, the result is 1.
    beyond_is_one ["S840D-SN-001", "S840D-SN-002", "S840D-SN-008", "S840D-SN-013", "S840D-TIMING-508/a", "S840D-CAM-705/a",
        "S840D-SN-003"]:
        when |s| s.config.enabled && i64::from(s.config.range.folded(s.inputs.position).0) > s.config.on_above()
            => s.after.own;

    /// At the cam and before it the result is 0.
    before_is_zero ["S840D-SN-002", "S840D-SN-008", "S840D-PARAM-014"]:
        when |s| s.config.range.folded(s.inputs.position) <= s.config.cam
            => !s.after.own;

    /// Inside the hysteresis the result stays as it is.
    hysteresis_keeps ["S840D-SN-006", "S840D-SN-008", "S840D-CAM-705/a"]:
        when |s| !s.inputs.power_on && s.config.range.folded(s.inputs.position) > s.config.cam
            && i64::from(s.config.range.folded(s.inputs.position).0) <= s.config.on_above()
            => s.after.own == s.before.own;

    /// Without synchronisation each channel shows its own result.
    alone_without_synchronisation ["S840D-SN-001", "S840D-SN-005"]:
        when |s| !s.config.sync
            => s.outputs.sga == s.after.own;

    /// With synchronisation a channel shows 1 only if both have passed the cam.
    both_with_synchronisation ["S840D-P-32", "S840D-SN-007", "S840D-SN-015"]:
        when |s| s.config.sync
            => s.outputs.sga == (s.after.own && s.inputs.other);

    /// A cam that is not enabled shows 0.
    disabled_is_off ["S840D-SN-001"]:
        when |s| !s.config.enabled
            => !s.after.own && !s.outputs.sga;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SN-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.own == s.after.own;
}

/// The position that a pair of cams tells: between the minus cam and the plus cam to its right. `plus`, `minus`: their
/// signals. `across`: the end of the modulo range lies between them, so that the plus cam has the smaller position.
///
/// The inverted plus cam and the minus cam are ANDed, as an output does with the signals assigned to it (S840D-CAM-701); across
/// the end of the range that would never be 1, and the logic of the user ORs them (S840D-CAM-702).
pub const fn pulse(plus: bool, minus: bool, across: bool) -> bool {
    if across {
        !plus || minus
    } else {
        !plus && minus
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let position = config.range.folded(inputs.position);
    let beyond = i64::from(position.0) > config.on_above() || (before.own && position > config.cam);
    let own = config.enabled && beyond;
    let outputs = Outputs {
        own,
        sga: own && (!config.sync || inputs.other),
    };
    (State { own }, outputs)
}
