//! F_SLP_MONITOR (FB201): a range of positions with retraction at a safe velocity.
//!
//! A limit that is violated takes its enable away in the same call and locks the motion toward it. An edge at RELEASE enables the
//! way back, slowly; losing RELEASE, or the validity of the velocity, stops it at once. Only an acknowledgement inside the range
//! ends the fault.
//!
//! While POS_VALID is 0 the limits are not watched and what is latched may be acknowledged: the stop for it must be wired from
//! F_SAFE_POS itself (SRM-INTEG-008). Readings: AMB-17, AMB-18 (acknowledged bit by bit), AMB-19 ONE, AMB-24 to AMB-27, AMB-34,
//! AMB-70, AMB-71.

use crate::srm::common::{ErrReact, UNLIMITED, diag, latch, magnitude, release_velocity, rises};
pub use crate::srm::retraction::Outputs;
use crate::srm::retraction::{Given, Phase, Range};

config! {
    /// The parameters: any DInt, as the block takes them; a wrong one is reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Minimum permitted position, mm.
        pub x_negative: i32,
        /// Maximum permitted position, mm.
        pub x_positive: i32,
        /// Velocity of the retraction, mm/min; at least 1.
        pub vmax_release: i32,
        /// What a wrong parameter does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The parameter is one that the first call reports: bit 4 (SRM-SLP-003).
    pub const fn wrong_velocity(&self) -> bool {
        self.vmax_release < 1
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
        pub fast: bool,
        /// ACK in the call before.
        pub ack_held: bool,
        /// RELEASE in the call before.
        pub release_held: bool,
    }
}

impl State {
    /// Before the first call.
    pub const INITIAL: Self = Self {
        phase: Phase::Normal,
        low: false,
        high: false,
        fast: false,
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

    /// A side is latched while the axis is on it; RELEASE inside the range is nothing here; a retraction has its RELEASE.
    pub fn invariant(&self, _: &Config) -> bool {
        self.range().consistent()
            && self.phase != Phase::Inside
            && (!self.phase.released() || self.release_held)
    }
}

fields! {
    /// The inputs of one call (SRM-SLP-002).
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
        /// Retraction, from a safe source.
        pub release: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

impl Inputs {
    /// A valid position below the lower limit.
    pub const fn below(&self, config: &Config) -> bool {
        self.pos_valid && self.safe_pos < config.x_negative
    }

    /// A valid position above the upper limit.
    pub const fn above(&self, config: &Config) -> bool {
        self.pos_valid && self.safe_pos > config.x_positive
    }
}

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// The parameters let the block give enables.
fn free(config: &Config) -> bool {
    !config.wrong_velocity() || config.err_react == ErrReact::Report
}

monitor! { srm::slp_monitor;
    /// A valid position below the lower limit takes its enable away in the same call, unless a retraction goes on.
    lower_limit_acts_at_once ["SRM-SLP-005", "SRM-SLP-024", "SRM-P-20", "SRM-P-76"]:
        when |s| s.inputs.below(&s.config)
            => s.after.low && s.outputs.error && s.outputs.diag & 1 == 1
                && (!s.outputs.x_negative_ok || s.after.phase.retracts());

    /// The same above the upper limit.
    upper_limit_acts_at_once ["SRM-SLP-006", "SRM-SLP-024", "SRM-P-20", "SRM-P-76"]:
        when |s| s.inputs.above(&s.config)
            => s.after.high && s.outputs.error && s.outputs.diag & 2 == 2
                && (!s.outputs.x_positive_ok || s.after.phase.retracts());

    /// Motion toward the limit that was violated in this call is locked.
    violation_locks_its_direction ["SRM-SLP-005", "SRM-SLP-006", "SRM-SLP-015"]:
        when |s| s.inputs.below(&s.config) != s.inputs.above(&s.config)
            => if s.inputs.below(&s.config) { !s.outputs.move_negative_ok } else { !s.outputs.move_positive_ok };

    /// A retraction has RELEASE and a valid velocity, enables both limits and locks the way further out.
    retraction_is_one_way ["SRM-SLP-010", "SRM-SLP-011", "SRM-SLP-016", "SRM-P-21", "SRM-P-31"]:
        when |s| s.after.phase.retracts()
            => s.inputs.release && s.inputs.v_valid
                && s.outputs.move_negative_ok == (s.after.phase.upper() && free(&s.config))
                && s.outputs.move_positive_ok == (s.after.phase.lower() && free(&s.config))
                && s.outputs.x_negative_ok == free(&s.config) && s.outputs.x_positive_ok == free(&s.config);

    /// While RELEASE is accepted the threshold is the velocity of the retraction, 1 where the parameter is none.
    retraction_is_slow ["SRM-SLP-003", "SRM-SLP-010", "SRM-P-22"]:
        when |s| s.after.phase.released()
            => s.outputs.sls_threshold == s.config.vmax_release.max(1);

    /// Without an accepted RELEASE nothing limits the velocity.
    no_retraction_no_limit ["SRM-SLP-004", "SRM-SLP-013", "SRM-SLP-022"]:
        when |s| !s.after.phase.released() && free(&s.config)
            => s.outputs.sls_threshold == i32::MAX;

    /// A retraction begins with an edge at RELEASE beside valid signals, after a violation only.
    retraction_wants_an_edge ["SRM-SLP-010", "SRM-SLP-028", "SRM-P-30"]:
        when |s| s.after.phase.released() && !s.before.phase.released()
            => s.inputs.release && !s.before.release_held && s.inputs.pos_valid && s.inputs.v_valid
                && (s.before.low || s.before.high);

    /// An edge that finds all it needs is accepted.
    retraction_begins ["SRM-SLP-010"]:
        when |s| s.before.phase == Phase::FaultLower && s.inputs.release && !s.before.release_held
            && s.inputs.pos_valid && s.inputs.v_valid && s.inputs.below(&s.config) && !s.inputs.above(&s.config)
            => s.after.phase == Phase::RetractLower;

    /// Without RELEASE no retraction goes on, and what is latched has no enable.
    release_ends_it ["SRM-SLP-011", "SRM-SLP-029", "SRM-P-23", "SRM-P-31"]:
        when |s| !s.inputs.release
            => !s.after.phase.released()
                && (!s.after.low || !s.outputs.x_negative_ok) && (!s.after.high || !s.outputs.x_positive_ok);

    /// With an invalid velocity no retraction goes on; its enables are gone.
    invalid_velocity_suspends ["SRM-SLP-016", "SRM-SLP-026", "SRM-P-31"]:
        when |s| !s.inputs.v_valid
            => !s.after.phase.retracts()
                && (!s.after.low || !s.outputs.x_negative_ok) && (!s.after.high || !s.outputs.x_positive_ok)
                && (s.outputs.diag & 0x40 == 0x40) == s.after.phase.suspended();

    /// A suspended retraction goes on with the velocity, without a new edge.
    suspension_ends ["SRM-SLP-017", "SRM-SLP-026"]:
        when |s| s.before.phase == Phase::SuspendUpper && s.inputs.release && s.inputs.v_valid
            && !s.inputs.below(&s.config) && s.after.high
            => s.after.phase == Phase::RetractUpper && s.outputs.diag & 0x40 == 0;

    /// A latch of a limit falls only by an edge at ACK while the position keeps the limit or is invalid.
    acknowledged_inside ["SRM-SLP-008", "SRM-SLP-014", "SRM-ACK-001", "SRM-P-24", "SRM-P-75"]:
        when |s| s.before.low && !s.after.low || s.before.high && !s.after.high
            => acknowledges(&s) && (!s.before.low || s.after.low || !s.inputs.below(&s.config))
                && (!s.before.high || s.after.high || !s.inputs.above(&s.config));

    /// An edge at ACK clears what keeps its own condition, each bit for itself.
    acknowledgement_is_heard ["SRM-ACK-002", "SRM-SLP-008", "SRM-SLP-013", "SRM-SLP-027"]:
        when |s| acknowledges(&s)
            => s.after.low == s.inputs.below(&s.config) && s.after.high == s.inputs.above(&s.config);

    /// When the latches are gone the axis is as in the beginning, whatever RELEASE does.
    acknowledged_is_normal ["SRM-SLP-013", "SRM-P-28"]:
        when |s| !s.after.low && !s.after.high && free(&s.config)
            => s.after.phase == Phase::Normal && s.outputs.x_negative_ok && s.outputs.x_positive_ok
                && s.outputs.move_negative_ok && s.outputs.move_positive_ok;

    /// An enable of a limit that had gone comes back only by an acknowledgement, an accepted edge at RELEASE, or the end of a
    /// suspension with RELEASE held.
    nothing_restarts_by_itself ["SRM-ACK-008", "SRM-SLP-029", "SRM-P-30", "SRM-P-75"]:
        when |s| s.before.low && !s.before.phase.retracts() && s.outputs.x_negative_ok
            => acknowledges(&s) || s.inputs.release && (!s.before.release_held || s.before.phase.suspended());

    /// Too fast in a retraction is latched and takes the SLS enable away.
    fast_retraction_is_stopped ["SRM-SLP-012", "SRM-SLP-022"]:
        when |s| s.after.phase.retracts() && i64::from(s.inputs.safe_v).abs() > i64::from(s.outputs.sls_threshold)
            => s.after.fast && !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 4 == 4;

    /// The latch of the velocity rises in a retraction only, and falls only by an edge at ACK beside a velocity that is slow or
    /// not watched.
    velocity_is_acknowledged ["SRM-SLP-012", "SRM-SLP-018", "SRM-SLP-022", "SRM-P-75"]:
        when |s| s.before.fast != s.after.fast
            => if s.after.fast {
                s.after.phase.retracts()
            } else {
                acknowledges(&s) && (!s.inputs.v_valid
                    || i64::from(s.inputs.safe_v).abs() <= i64::from(s.outputs.sls_threshold)
                    || !free(&s.config))
            };

    /// A velocity fault can be acknowledged beside the fault of a limit.
    velocity_can_always_be_acknowledged ["SRM-SLP-012", "SRM-SLP-018"]:
        when |s| acknowledges(&s) && (!s.inputs.v_valid || i64::from(s.inputs.safe_v).abs() <= 1)
            => !s.after.fast;

    /// An invalid position is told; it raises no fault by itself and leaves the limits unwatched.
    invalid_position_is_told ["SRM-SLP-007", "SRM-SLP-009", "SRM-ACK-004", "SRM-P-25"]:
        when |s| !s.inputs.pos_valid
            => s.outputs.diag & 0x20 == 0x20 && (s.before.low || !s.after.low) && (s.before.high || !s.after.high);

    /// A valid position ends its message at once.
    valid_position_is_told ["SRM-SLP-009"]:
        when |s| s.inputs.pos_valid
            => s.outputs.diag & 0x20 == 0;

    /// One direction is always left.
    one_direction_is_left ["SRM-SLP-015", "SRM-P-28"]:
        when |s| free(&s.config)
            => s.outputs.move_negative_ok || s.outputs.move_positive_ok;

    /// A wrong parameter is told as long as the block runs; it takes every enable away (AMB-17 SAFE).
    wrong_parameter_stays ["SRM-SLP-003", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.config.vmax_release < 1
            => s.outputs.error && s.outputs.diag & 0x10 == 0x10
                && (s.config.err_react == ErrReact::Report
                    || !s.outputs.sls_ok && !s.outputs.x_negative_ok && !s.outputs.x_positive_ok
                        && !s.outputs.move_negative_ok && !s.outputs.move_positive_ok && s.outputs.sls_threshold == 1);

    /// Undisturbed inside the range everything is enabled and nothing told; an edge at ACK changes nothing.
    undisturbed ["SRM-SLP-004", "SRM-ACK-001"]:
        when |s| s.before.phase == Phase::Normal && !s.before.fast && s.inputs.pos_valid && s.config.vmax_release >= 1
            && !s.inputs.below(&s.config) && !s.inputs.above(&s.config)
            => s.outputs.all_enabled() && s.outputs.diag == 0 && !s.outputs.error && !s.outputs.ack_req
                && s.outputs.sls_threshold == i32::MAX;

    /// An acknowledgement is asked for exactly while something latched keeps its condition; ERROR is what is latched; the other bits
    /// are 0.
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-SLP-020", "SRM-SLP-023"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.ack_req
                == (s.after.low && !s.inputs.below(&s.config) || s.after.high && !s.inputs.above(&s.config)
                    || s.after.fast && (!s.inputs.v_valid || i64::from(s.inputs.safe_v).abs()
                        <= if s.after.phase.released() { i64::from(s.config.vmax_release.max(1)) } else { i64::from(i32::MAX) }))
                && s.outputs.error == (s.after.low || s.after.high || s.after.fast || s.config.vmax_release < 1)
                && s.outputs.sls_ok == (!s.after.fast && free(&s.config))
                && s.outputs.diag & !0x77 == 0;

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-SLP-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.release_held == s.inputs.release;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let given = Given {
        below: inputs.below(config),
        above: inputs.above(config),
        crossed: false,
        pos_valid: inputs.pos_valid,
        v_valid: inputs.v_valid,
        release: inputs.release,
        release_edge: rises(inputs.release, state.release_held),
        acknowledged,
        inside: false,
    };
    let range = state.range().next(&given);
    let phase = range.phase;
    let slow = release_velocity(config.vmax_release);
    let threshold = if phase.released() { slow } else { UNLIMITED };
    let exceeds = inputs.v_valid && magnitude(inputs.safe_v) > i64::from(threshold);
    let too_fast = exceeds && phase.retracts();
    let fast = latch(state.fast, too_fast, acknowledged, !exceeds);
    let wrong = config.wrong_velocity();
    let blocked = wrong && config.err_react == ErrReact::Safe;
    let after = State {
        phase,
        low: range.low,
        high: range.high,
        fast,
        ack_held: inputs.ack,
        release_held: inputs.release,
    };
    let outputs = Outputs {
        sls_threshold: if blocked { slow } else { threshold },
        sls_ok: !fast && !blocked,
        x_negative_ok: (!range.low || phase.retracts()) && !blocked,
        x_positive_ok: (!range.high || phase.retracts()) && !blocked,
        move_negative_ok: !phase.lower() && !blocked,
        move_positive_ok: !phase.upper() && !blocked,
        ack_req: range.acknowledgeable(&given) || fast && !exceeds,
        error: range.low || range.high || fast || wrong,
        diag: diag(&[
            (0, range.low),
            (1, range.high),
            (2, fast),
            (4, wrong),
            (5, !inputs.pos_valid),
            (6, phase.suspended()),
        ]),
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config {
            x_negative: 100,
            x_positive: 9_000,
            vmax_release: 600,
            err_react: ErrReact::Safe,
        }
    }

    const INSIDE: Inputs = Inputs {
        safe_pos: 5_000,
        pos_valid: true,
        safe_v: 0,
        v_valid: true,
        release: false,
        ack: false,
    };

    /// SRM-SLP-004: 2147483647 in normal operation, the limits are inside.
    #[test]
    fn the_range_includes_its_limits() {
        let mut monitor = Monitor::new(config());
        for safe_pos in [100, 9_000] {
            let outputs = monitor.step(&Inputs { safe_pos, ..INSIDE });
            assert!(outputs.all_enabled() && outputs.diag == 0);
            assert_eq!(outputs.sls_threshold, 2_147_483_647);
        }
        let outputs = monitor.step(&Inputs {
            safe_pos: 99,
            ..INSIDE
        });
        assert!(!outputs.x_negative_ok && !outputs.move_negative_ok && outputs.x_positive_ok);
        assert_eq!(outputs.diag, 1);
    }

    /// SRM-SLP-003: the range printed for VMAX_RELEASE is 1 to 2147483647, the substitute is 1.
    #[test]
    fn velocities_of_the_retraction() {
        for (vmax_release, wrong) in [(1, false), (2_147_483_647, false), (0, true), (-5, true)] {
            let mut monitor = Monitor::new(Config {
                vmax_release,
                ..config()
            });
            let outputs = monitor.step(&INSIDE);
            assert_eq!(outputs.diag, if wrong { 0x10 } else { 0 });
            assert_eq!(outputs.error, wrong);
            assert_eq!(outputs.all_enabled(), !wrong);
            if wrong {
                assert_eq!(outputs.sls_threshold, 1);
            }
        }
    }

    /// SRM-SLP-010 to SRM-SLP-013: out, back with RELEASE, acknowledged inside while RELEASE is held.
    #[test]
    fn a_retraction() {
        let mut monitor = Monitor::new(config());
        let out = Inputs {
            safe_pos: 9_001,
            ..INSIDE
        };
        assert_eq!(monitor.step(&INSIDE).diag, 0);
        assert!(!monitor.step(&out).x_positive_ok);
        let back = Inputs {
            release: true,
            ..out
        };
        let outputs = monitor.step(&back);
        assert!(outputs.x_positive_ok && outputs.error && !outputs.move_positive_ok);
        assert_eq!(outputs.sls_threshold, 600);
        assert!(
            !monitor
                .step(&Inputs {
                    safe_v: 601,
                    ..back
                })
                .sls_ok
        );
        let inside = Inputs {
            safe_pos: 9_000,
            ..back
        };
        let outputs = monitor.step(&inside);
        assert!(outputs.ack_req && outputs.sls_threshold == 600);
        let outputs = monitor.step(&Inputs {
            ack: true,
            ..inside
        });
        assert!(outputs.all_enabled() && outputs.diag == 0 && !outputs.ack_req);
    }
}
