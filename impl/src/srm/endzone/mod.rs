//! F_ENDZONE (FB202): a range of positions with a velocity envelope before both ends, and retraction.
//!
//! The nearer the end that is approached, the slower: 17 points between which the limit is interpolated by
//! [`crate::srm::interpolation`], cut at the last velocity (SRM-ENDZONE-005). The limits may move, as between two machines. What is
//! approached is told by the last change of the position; where that is not known, the lower of both envelopes counts.
//!
//! Exactly one velocity is supervised (SRM-ENDZONE-029): none while the velocity is invalid; that of the retraction, or the envelope of
//! the end that is approached where it is lower; V_16 while the position is invalid; else the envelope. An envelope that cannot be
//! calculated is 0 and a calculation fault.
//!
//! While POS_VALID or V_VALID is 0 the stop must come from F_SAFE_POS itself (SRM-INTEG-008). Readings: AMB-17, AMB-18, AMB-19 ONE,
//! AMB-24 to AMB-27, AMB-28, AMB-30, AMB-31, AMB-32 to AMB-36, AMB-70. While RELEASE is accepted the threshold follows the position
//! also with an invalid velocity; it is held otherwise.

mod laws;

pub use laws::*;

use crate::srm::common::{ErrReact, diag, latch, magnitude, release_velocity, rises};
use crate::srm::interpolation::Curve;
pub use crate::srm::retraction::Outputs;
use crate::srm::retraction::{Given, Phase, Range};

fields! {
    /// Reading AMB-28: the enable of a violated limit while a retraction waits for a valid velocity.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum VinvRetract {
        /// It is 0, as in F_SLP_MONITOR.
        #[default]
        Stop,
        /// It stays 1.
        Hold,
    }
}

fields! {
    /// Reading AMB-31: how long a direction is known.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum EzDir {
        /// Until the velocity is 0 or a signal is invalid.
        #[default]
        Expire,
        /// For ever.
        Hold,
    }
}

config! {
    /// The parameters: any DInt, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Velocity of the retraction, mm/min; 1 to V_16.
        pub vmax_release: i32,
        /// INTERPOLATION: the envelope, from 0 mm and 0 mm/min.
        pub interpolation: Curve,
        /// What a suspended retraction enables.
        pub vinv_retract: VinvRetract,
        /// How long a direction is known.
        pub ez_dir: EzDir,
        /// What a wrong parameter or a calculation fault does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The bits that the first call reports: 3 and 4 (SRM-ENDZONE-006, SRM-ENDZONE-007).
    pub fn parameter_bits(&self) -> u16 {
        let curve = &self.interpolation;
        let from_zero = curve.x[0] == 0 && curve.v[0] == 0;
        diag(&[
            (3, !from_zero || !curve.ascends()),
            (4, self.vmax_release < 1 || self.vmax_release > curve.v_16),
        ])
    }

    /// The envelope at a remaining distance; none where it cannot be calculated.
    pub fn envelope(&self, distance: Option<i32>) -> Option<i32> {
        let limit = self.interpolation.limit(distance?)?;
        Some(limit.min(self.interpolation.v_16))
    }
}

fields! {
    /// Where the axis goes.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Direction {
        /// Nobody knows.
        #[default]
        Unknown,
        /// Toward the upper limit.
        Rising,
        /// Toward the lower limit.
        Falling,
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the axis is with its range.
        pub phase: Phase,
        /// The lower limit is latched: bit 0.
        pub low: bool,
        /// The upper limit is latched: bit 1.
        pub high: bool,
        /// The velocity of the retraction is latched: bit 2.
        pub retracts_fast: bool,
        /// The velocity of the envelope is latched: bit 9.
        pub fast: bool,
        /// A result was no DInt: bit 11.
        pub overflowed: bool,
        /// Where the axis goes.
        pub direction: Direction,
        /// Both signals were valid in the call before.
        pub seen: bool,
        /// The position then, mm; 0 where they were not.
        pub place: i32,
        /// The threshold of the call before, mm/min.
        pub threshold: i32,
        /// ACK in the call before.
        pub ack_held: bool,
        /// RELEASE in the call before.
        pub release_held: bool,
    }
}

impl State {
    /// Before the first call. A threshold that is held from the beginning is 0, as every number that no call has set.
    pub const INITIAL: Self = Self {
        phase: Phase::Normal,
        low: false,
        high: false,
        retracts_fast: false,
        fast: false,
        overflowed: false,
        direction: Direction::Unknown,
        seen: false,
        place: 0,
        threshold: 0,
        ack_held: true,
        release_held: true,
    };

    const fn range(&self) -> Range {
        Range {
            phase: self.phase,
            low: self.low,
            high: self.high,
        }
    }

    /// A side is latched while the axis is on it; a retraction has its RELEASE; a direction that expires was seen.
    pub fn invariant(&self, config: &Config) -> bool {
        self.range().consistent()
            && (!self.phase.released() || self.release_held)
            && (self.seen || self.place == 0)
            && (self.seen || self.direction == Direction::Unknown || config.ez_dir == EzDir::Hold)
    }
}

fields! {
    /// The inputs of one call; the ends of the range may move (SRM-ENDZONE-002).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Safe position, mm.
        pub safe_pos: i32,
        /// The position is valid and referenced.
        pub pos_valid: bool,
        /// Safe velocity, mm/min.
        pub safe_v: i32,
        /// The velocity is valid.
        pub v_valid: bool,
        /// Minimum permitted position, mm; may move.
        pub x_negative: i32,
        /// Maximum permitted position, mm; may move.
        pub x_positive: i32,
        /// Retraction, from a safe source.
        pub release: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

impl Inputs {
    /// The lower limit has gone beyond the upper one.
    pub const fn crossed(&self) -> bool {
        self.pos_valid && self.x_negative > self.x_positive
    }

    /// A valid position below the lower limit, or limits that are crossed.
    pub const fn below(&self) -> bool {
        self.pos_valid && self.safe_pos < self.x_negative || self.crossed()
    }

    /// A valid position above the upper limit, or limits that are crossed.
    pub const fn above(&self) -> bool {
        self.pos_valid && self.safe_pos > self.x_positive || self.crossed()
    }
}

/// Where the axis goes after a call.
fn direction(state: &State, config: &Config, inputs: &Inputs) -> Direction {
    let valid = inputs.pos_valid && inputs.v_valid;
    let expires = config.ez_dir == EzDir::Expire;
    if expires && (!valid || inputs.safe_v == 0) {
        return Direction::Unknown;
    }
    match inputs.safe_pos.cmp(&state.place) {
        core::cmp::Ordering::Greater if valid && state.seen => Direction::Rising,
        core::cmp::Ordering::Less if valid && state.seen => Direction::Falling,
        _ => state.direction,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let given = Given {
        below: inputs.below(),
        above: inputs.above(),
        crossed: inputs.crossed(),
        pos_valid: inputs.pos_valid,
        v_valid: inputs.v_valid,
        release: inputs.release,
        release_edge: rises(inputs.release, state.release_held),
        acknowledged,
        inside: true,
    };
    let range = state.range().next(&given);
    let phase = range.phase;

    let upper = config.envelope(inputs.x_positive.checked_sub(inputs.safe_pos));
    let lower = config.envelope(inputs.safe_pos.checked_sub(inputs.x_negative));
    let overflow = inputs.pos_valid && (upper.is_none() || lower.is_none());
    let (upper, lower) = (upper.unwrap_or(0), lower.unwrap_or(0));
    let direction = direction(&state, config, inputs);
    let approached = match direction {
        Direction::Rising => upper,
        Direction::Falling => lower,
        Direction::Unknown => upper.min(lower),
    };
    let slow = release_velocity(config.vmax_release);
    let highest = config.interpolation.v_16;
    let (limit, threshold) = if phase.released() {
        let end = if phase.lower() {
            upper
        } else if phase.upper() {
            lower
        } else {
            approached
        };
        let limit = if inputs.pos_valid {
            slow.min(end)
        } else {
            slow
        };
        (limit, limit)
    } else if !inputs.v_valid {
        (highest, state.threshold)
    } else if inputs.pos_valid {
        (approached, approached)
    } else if acknowledged {
        (highest, highest)
    } else {
        (highest, state.threshold)
    };
    let velocity = magnitude(inputs.safe_v);
    let exceeds = inputs.v_valid && velocity > i64::from(limit);
    let retracts_fast = latch(
        state.retracts_fast,
        exceeds && phase.released(),
        acknowledged,
        !exceeds,
    );
    let fast = latch(
        state.fast,
        exceeds && !phase.released(),
        acknowledged,
        !exceeds,
    );
    let overflowed = latch(state.overflowed, overflow, acknowledged, true);
    let parameters = config.parameter_bits();
    let blocked = config.err_react == ErrReact::Safe && (parameters != 0 || overflowed);
    let enabled = phase.retracts() || config.vinv_retract == VinvRetract::Hold && phase.suspended();
    let valid = inputs.pos_valid && inputs.v_valid;
    let after = State {
        phase,
        low: range.low,
        high: range.high,
        retracts_fast,
        fast,
        overflowed,
        direction,
        seen: valid,
        place: if valid { inputs.safe_pos } else { 0 },
        threshold,
        ack_held: inputs.ack,
        release_held: inputs.release,
    };
    let diag = parameters
        | diag(&[
            (0, range.low),
            (1, range.high),
            (2, retracts_fast),
            (5, !inputs.pos_valid),
            (6, !inputs.v_valid),
            (9, fast),
            (11, overflowed),
        ]);
    let outputs = Outputs {
        sls_threshold: if blocked { slow } else { threshold },
        sls_ok: !retracts_fast && !fast && !blocked,
        x_negative_ok: (!range.low || enabled) && !blocked,
        x_positive_ok: (!range.high || enabled) && !blocked,
        move_negative_ok: !phase.lower() && !blocked,
        move_positive_ok: !phase.upper() && !given.crossed && !blocked,
        ack_req: range.acknowledgeable(&given)
            || (retracts_fast || fast) && !exceeds
            || overflowed && !overflow,
        error: diag & !0x60 != 0,
        diag,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config {
            vmax_release: 600,
            interpolation: Curve::of(&[(0, 0), (100, 3_000), (400, 6_000), (900, 9_000)]),
            vinv_retract: VinvRetract::Stop,
            ez_dir: EzDir::Expire,
            err_react: ErrReact::Safe,
        }
    }

    fn at(safe_pos: i32, safe_v: i32) -> Inputs {
        Inputs {
            safe_pos,
            safe_v,
            pos_valid: true,
            v_valid: true,
            x_negative: 0,
            x_positive: 10_000,
            release: false,
            ack: false,
        }
    }

    /// SRM-ENDZONE-008 to SRM-ENDZONE-012, SRM-ENDZONE-031: the envelope of the end that is approached, V_16 away from it.
    #[test]
    fn the_envelope_of_the_approached_end() {
        let mut monitor = Monitor::new(config());
        assert_eq!(
            monitor.step(&at(9_800, 100)).sls_threshold,
            4_000,
            "unknown"
        );
        assert_eq!(monitor.step(&at(9_900, 100)).sls_threshold, 3_000);
        let outputs = monitor.step(&at(9_899, 5_000));
        assert_eq!((outputs.sls_threshold, outputs.diag), (9_000, 0));
        let outputs = monitor.step(&at(9_950, 1_500));
        assert!(outputs.sls_ok && outputs.sls_threshold == 1_500);
        let outputs = monitor.step(&at(9_951, 1_471));
        assert_eq!((outputs.sls_threshold, outputs.diag), (1_470, 0x200));
        assert!(!outputs.sls_ok && outputs.error && !outputs.ack_req);
        assert!(monitor.step(&at(9_951, 1_470)).ack_req);
        let outputs = monitor.step(&Inputs {
            ack: true,
            ..at(9_951, 1_470)
        });
        assert!(outputs.sls_ok && !outputs.error);
        assert!(!monitor.step(&at(9_000, 9_001)).sls_ok, "above V_16");
    }

    /// SRM-ENDZONE-006, SRM-ENDZONE-007, SRM-ENDZONE-022.
    #[test]
    fn parameters_have_their_bits() {
        let right = config();
        let curve = |points: &[(i32, i32)]| Config {
            interpolation: Curve::of(points),
            ..right
        };
        for (wrong, bits) in [
            (right, 0),
            (curve(&[(1, 0), (100, 3_000)]), 8),
            (curve(&[(0, 1), (100, 3_000)]), 8),
            (
                Config {
                    vmax_release: 0,
                    ..right
                },
                0x10,
            ),
            (
                Config {
                    vmax_release: 9_000,
                    ..right
                },
                0,
            ),
            (
                Config {
                    vmax_release: 9_001,
                    ..right
                },
                0x10,
            ),
        ] {
            assert_eq!(wrong.parameter_bits(), bits);
            assert_eq!(Monitor::new(wrong).step(&at(5_000, 0)).diag, bits);
        }
        let falling = curve(&[(0, 0), (100, 3_000), (50, 4_000)]);
        assert_eq!(Monitor::new(falling).step(&at(5_000, 0)).diag, 0x808);
    }

    /// SRM-ENDZONE-013, SRM-ENDZONE-032: the threshold is held until it is acknowledged, then it is V_16.
    #[test]
    fn an_invalid_position_holds_the_threshold() {
        let mut monitor = Monitor::new(config());
        monitor.step(&at(9_850, 100));
        monitor.step(&at(9_900, 100));
        let blind = Inputs {
            pos_valid: false,
            ..at(9_950, 8_000)
        };
        let outputs = monitor.step(&blind);
        assert_eq!(
            (outputs.sls_threshold, outputs.diag, outputs.sls_ok),
            (3_000, 0x20, true)
        );
        assert_eq!(
            monitor.step(&Inputs { ack: true, ..blind }).sls_threshold,
            9_000
        );
        assert_eq!(monitor.step(&blind).sls_threshold, 9_000);
        assert_eq!(
            monitor
                .step(&Inputs {
                    safe_v: 9_001,
                    ..blind
                })
                .diag,
            0x220
        );
    }

    /// SRM-ENDZONE-030.
    #[test]
    fn limits_that_cross_lock_everything() {
        let mut monitor = Monitor::new(config());
        monitor.step(&at(5_000, 0));
        let outputs = monitor.step(&Inputs {
            x_negative: 10_001,
            ..at(5_000, 0)
        });
        assert!(!outputs.x_negative_ok && !outputs.x_positive_ok);
        assert!(!outputs.move_negative_ok && !outputs.move_positive_ok);
        assert_eq!(outputs.diag & 3, 3);
    }
}
