//! The load supervision of F_LOAD_MONITOR (FB204): overload, slack rope, discrepancy of two channels, retraction.
//!
//! One channel beyond a limit is enough; both must keep it by the tolerance before it can be acknowledged. Overload leaves the way
//! down, slack rope the way up, slowly. The test of the measuring equipment is [`crate::srm::load_calibration`]; the block ORs both
//! `ERROR`, `ACK_REQ` and `DIAG`. The calibration steps first: its calculation fault takes the enables away too.
//!
//! Loads and their limits are hundredths of a percent: 10000 is 100.00 %. Readings: AMB-17, AMB-18, AMB-19 ONE, AMB-54 (dynamic
//! overload takes DYN_LOAD_OK away), AMB-55, AMB-56, AMB-59, AMB-61, AMB-70.

mod laws;

pub use laws::*;

use crate::srm::common::{
    ErrReact, UNLIMITED, apart, calls, diag, latch, magnitude, release_velocity, rises, within,
};

/// 100.00 %.
pub const FULL: i32 = 10_000;

config! {
    /// The parameters: any DInt, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Tolerance of the channels and of the way back from a limit.
        pub maxtol_load: i32,
        /// Limit in the dynamic mode.
        pub maxload_dyn: i32,
        /// Limit in the static mode.
        pub maxload_stat: i32,
        /// Least load: below it the rope is slack.
        pub minload: i32,
        /// Velocity of the retraction, mm/min; at least 1.
        pub vmax_release: i32,
        /// Expected load or load step of the calibration.
        pub cal_value: i32,
        /// Its tolerance.
        pub maxtol_cal: i32,
        /// Time between two calls, ms.
        pub t_sample: i32,
        /// Duration of a calibration, ms.
        pub t_test: i32,
        /// In it the time until the load has settled, ms.
        pub t_settle: i32,
        /// What a wrong parameter or a calculation fault does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The bits that the first call reports: 3, 6, 8 (SRM-LOAD-004 to SRM-LOAD-006).
    pub fn parameter_bits(&self) -> u16 {
        let ordered = self.minload < self.maxload_stat && self.maxload_stat <= self.maxload_dyn;
        let share = |number: i32| within(0, number, FULL);
        let within = share(self.maxload_dyn)
            && share(self.maxload_stat)
            && share(self.minload)
            && share(self.cal_value)
            && share(self.maxtol_load)
            && share(self.maxtol_cal);
        diag(&[
            (3, !ordered),
            (6, !times_fit(self.t_test, self.t_settle, self.t_sample)),
            (8, self.vmax_release < 1 || !within),
        ])
    }

    /// The limit of a mode.
    pub const fn limit(&self, dynamic: bool) -> i32 {
        if dynamic {
            self.maxload_dyn
        } else {
            self.maxload_stat
        }
    }
}

/// Both times of a calibration are whole calls, the settling is a part of the test (SRM-LOAD-005).
pub const fn times_fit(t_test: i32, t_settle: i32, t_sample: i32) -> bool {
    match (calls(t_test, t_sample), calls(t_settle, t_sample)) {
        (Some(test), Some(settle)) => test > settle,
        _ => false,
    }
}

fields! {
    /// The state between two calls: what is latched, by the bits of `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The channels differ: bit 0.
        pub discrepancy: bool,
        /// Overload in the static mode: bit 1.
        pub over_static: bool,
        /// Overload in the dynamic mode: bit 1.
        pub over_dynamic: bool,
        /// The rope is slack: bit 2.
        pub slack: bool,
        /// Too fast: bit 7.
        pub fast: bool,
        /// The velocity was invalid in a retraction: bit 9.
        pub blind: bool,
        /// A load is out of its range: bit 10.
        pub out_of_range: bool,
        /// A result was no DInt: bit 11.
        pub overflowed: bool,
        /// A retraction goes on.
        pub retracting: bool,
        /// RELEASE in the call before.
        pub release_held: bool,
        /// ACK in the call before.
        pub ack_held: bool,
    }
}

impl State {
    /// Before the first call.
    pub const INITIAL: Self = Self {
        discrepancy: false,
        over_static: false,
        over_dynamic: false,
        slack: false,
        fast: false,
        blind: false,
        out_of_range: false,
        overflowed: false,
        retracting: false,
        release_held: true,
        ack_held: true,
    };

    /// Overload or slack rope.
    pub const fn overloaded_or_slack(&self) -> bool {
        self.over_static || self.over_dynamic || self.slack
    }

    /// A retraction has its RELEASE, its reason, and no fault of the velocity's validity.
    pub fn invariant(&self, _: &Config) -> bool {
        !self.retracting || self.release_held && self.overloaded_or_slack() && !self.blind
    }
}

fields! {
    /// The inputs of one call: loads are hundredths of a percent, 10000 is full load (SRM-ARCH-008, SRM-LOAD-002, SRM-LOAD-003).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Load, channel 1.
        pub load1: i32,
        /// Load, channel 2.
        pub load2: i32,
        /// 1: the dynamic limit, 0: the static one.
        pub maxload_mode: bool,
        /// Safe velocity, mm/min.
        pub safe_v: i32,
        /// The velocity is valid.
        pub v_valid: bool,
        /// Bit 11 of the calibration after this call: a calculation fault of the block as a whole.
        pub calibration_overflow: bool,
        /// Retraction, from a safe source.
        pub release: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

impl Inputs {
    /// The higher load.
    pub fn most(&self) -> i32 {
        self.load1.max(self.load2)
    }

    /// The lower load.
    pub fn least(&self) -> i32 {
        self.load1.min(self.load2)
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SLS limit, mm/min.
        pub sls_threshold: i32,
        /// The velocity keeps the limit.
        pub sls_ok: bool,
        /// No dynamic overload.
        pub dyn_load_ok: bool,
        /// No static overload.
        pub stat_load_ok: bool,
        /// No slack rope.
        pub min_load_ok: bool,
        /// Motion in the negative direction, down, is permitted.
        pub move_negative_ok: bool,
        /// Motion in the positive direction, up, is permitted.
        pub move_positive_ok: bool,
        /// Something can be acknowledged.
        pub ack_req: bool,
        /// A fault is latched or a parameter is wrong.
        pub error: bool,
        /// The diagnostic word.
        pub diag: u16,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let ack = rises(inputs.ack, state.ack_held);
    let limit = config.limit(inputs.maxload_mode);
    let below = limit.checked_sub(config.maxtol_load);
    let above = config.minload.checked_add(config.maxtol_load);
    let difference = inputs.load1.checked_sub(inputs.load2);
    let overflow = below.is_none() || above.is_none() || difference.is_none();
    let overloads = inputs.most() > limit;
    let relieved = below.is_some_and(|below| inputs.most() < below);
    let slackens = inputs.least() < config.minload;
    let tight = above.is_some_and(|above| inputs.least() > above);
    let differ = apart(inputs.load1, inputs.load2) > i64::from(config.maxtol_load);
    let outside = inputs.least() < 0 || inputs.most() > FULL;
    let unseen = state.retracting && !inputs.v_valid;

    let mut after = State {
        discrepancy: latch(state.discrepancy, differ, ack, true),
        over_static: latch(
            state.over_static,
            overloads && !inputs.maxload_mode,
            ack,
            relieved,
        ),
        over_dynamic: latch(
            state.over_dynamic,
            overloads && inputs.maxload_mode,
            ack,
            relieved,
        ),
        slack: latch(state.slack, slackens, ack, tight),
        fast: false,
        blind: latch(state.blind, unseen, ack, inputs.v_valid),
        out_of_range: latch(state.out_of_range, outside, ack, true),
        overflowed: latch(state.overflowed, overflow, ack, true),
        retracting: false,
        release_held: inputs.release,
        ack_held: inputs.ack,
    };
    let new = after.over_static && !state.over_static
        || after.over_dynamic && !state.over_dynamic
        || after.slack && !state.slack;
    let possible = inputs.release && after.overloaded_or_slack() && !new && !unseen;
    let begins = rises(inputs.release, state.release_held) && inputs.v_valid && !after.blind;
    after.retracting = possible && (state.retracting || begins);

    let slow = release_velocity(config.vmax_release);
    let limited = after.overloaded_or_slack() || after.discrepancy;
    let threshold = if limited { slow } else { UNLIMITED };
    let keeps = magnitude(inputs.safe_v) <= i64::from(threshold);
    after.fast = latch(state.fast, inputs.v_valid && !keeps, ack, keeps);

    let parameters = config.parameter_bits();
    let fault = parameters != 0 || after.overflowed || inputs.calibration_overflow;
    let blocked = config.err_react == ErrReact::Safe && fault;
    let diag = parameters
        | diag(&[
            (0, after.discrepancy),
            (1, after.over_static || after.over_dynamic),
            (2, after.slack),
            (7, after.fast),
            (9, after.blind),
            (10, after.out_of_range),
            (11, after.overflowed),
        ]);
    let outputs = Outputs {
        sls_threshold: if blocked { slow } else { threshold },
        sls_ok: !after.fast && !after.blind && !blocked,
        dyn_load_ok: (!after.over_dynamic || after.retracting) && !blocked,
        stat_load_ok: (!after.over_static || after.retracting) && !blocked,
        min_load_ok: (!after.slack || after.retracting) && !blocked,
        move_negative_ok: !after.slack && !blocked,
        move_positive_ok: !after.over_static && !after.over_dynamic && !blocked,
        ack_req: after.discrepancy && !differ
            || (after.over_static || after.over_dynamic) && relieved
            || after.slack && tight
            || after.fast && keeps
            || after.blind && inputs.v_valid
            || after.out_of_range && !outside
            || after.overflowed && !overflow,
        error: diag != 0,
        diag,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config {
            maxtol_load: 500,
            maxload_dyn: 9_500,
            maxload_stat: 8_000,
            minload: 1_000,
            vmax_release: 600,
            cal_value: 5_000,
            maxtol_cal: 100,
            t_sample: 20,
            t_test: 400,
            t_settle: 100,
            err_react: ErrReact::Safe,
        }
    }

    fn load(load: i32) -> Inputs {
        Inputs {
            load1: load,
            load2: load,
            v_valid: true,
            ..Inputs::default()
        }
    }

    /// SRM-LOAD-013: the limits are inclusive, the hysteresis is not.
    #[test]
    fn overload_and_its_hysteresis() {
        let mut monitor = Monitor::new(config());
        assert_eq!(monitor.step(&load(8_000)).diag, 0);
        let outputs = monitor.step(&load(8_001));
        assert!(!outputs.stat_load_ok && outputs.dyn_load_ok && outputs.min_load_ok);
        assert!(!outputs.move_positive_ok && outputs.move_negative_ok);
        assert_eq!((outputs.diag, outputs.sls_threshold), (2, 600));
        assert!(!monitor.step(&load(7_500)).ack_req);
        assert!(monitor.step(&load(7_499)).ack_req);
        let outputs = monitor.step(&Inputs {
            ack: true,
            ..load(7_499)
        });
        assert_eq!((outputs.diag, outputs.sls_threshold), (0, 2_147_483_647));
    }

    /// SRM-LOAD-004 to SRM-LOAD-006, SRM-LOAD-020.
    #[test]
    fn parameters_have_their_bits() {
        let right = config();
        for (wrong, bits) in [
            (right, 0),
            (
                Config {
                    minload: 8_000,
                    ..right
                },
                8,
            ),
            (
                Config {
                    maxload_dyn: 7_999,
                    ..right
                },
                8,
            ),
            (
                Config {
                    t_test: 100,
                    ..right
                },
                0x40,
            ),
            (
                Config {
                    t_settle: 110,
                    ..right
                },
                0x40,
            ),
            (
                Config {
                    t_sample: 0,
                    ..right
                },
                0x40,
            ),
            (
                Config {
                    t_settle: 0,
                    ..right
                },
                0x40,
            ),
            (
                Config {
                    vmax_release: 0,
                    ..right
                },
                0x100,
            ),
            (
                Config {
                    maxload_dyn: 10_001,
                    ..right
                },
                0x100,
            ),
            (
                Config {
                    maxtol_cal: -1,
                    ..right
                },
                0x100,
            ),
        ] {
            let outputs = Monitor::new(wrong).step(&load(5_000));
            assert_eq!(outputs.diag & 0x148, bits);
            assert_eq!(outputs.error, outputs.diag != 0);
        }
    }
}
