//! F_SBR_MONITOR (FB207): whether a drive brakes along its ramp after, for instance, an SS1.
//!
//! An edge at EXECUTE loads the ramp with V_MAX and keeps the position; already this call is judged. From the next call on the ramp
//! falls by V_MAX / N each call, N = T_RAMP / T_SAMPLE, and the permitted way grows by what an axis on the ramp goes in a call, in
//! whole mm with the remainder kept. The monitoring ends when EXECUTE is 0 and the ramp has ended.
//!
//! The block has no inputs for validity: POS_VALID and V_VALID of F_SAFE_POS belong in the path of the stop itself (AMB-42,
//! SRM-INTEG-008). V_STOP_MONITORING below 1 makes a violation unacknowledgeable; the block does not check it (SRM-SBR-022).
//! Readings: AMB-17 (also for `SBR_OK`, beside a parameter fault), AMB-19 ONE, AMB-37, AMB-38, AMB-39, AMB-40, AMB-41.

mod laws;

pub use laws::*;

use crate::srm::common::{
    ErrReact, apart, calls, diag, latch, magnitude, multiple, quotient, remainder, rises,
};

fields! {
    /// Reading AMB-38: what is compared with the permitted way.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbrPos {
        /// The way since EXECUTE, with the way of the ramp.
        #[default]
        Cum,
        /// The way since the call before, with the way of the ramp in it.
        Cycle,
    }
}

fields! {
    /// Reading AMB-41: what an edge at EXECUTE does while the ramp falls.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbrRetrig {
        /// Nothing.
        #[default]
        Ignore,
        /// The ramp begins anew.
        Reload,
    }
}

config! {
    /// The parameters: any DInt, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Time between two calls, ms; above 0.
        pub t_sample: i32,
        /// Time of the ramp from V_MAX to standstill, ms; a multiple of T_SAMPLE.
        pub t_ramp: i32,
        /// Where the ramp begins, mm/min; a multiple of T_RAMP / T_SAMPLE.
        pub v_max: i32,
        /// Below this velocity a violation can be acknowledged, mm/min.
        pub v_stop_monitoring: i32,
        /// By so much the velocity may be above the ramp, mm/min; at most V_MAX.
        pub maxtol_v: i32,
        /// By so much the way may be above that of the ramp, mm.
        pub maxtol_pos: i32,
        /// What is compared with the way.
        pub sbr_pos: SbrPos,
        /// What a second edge at EXECUTE does.
        pub sbr_retrig: SbrRetrig,
        /// What a wrong parameter or a calculation fault does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The bits that the first call reports (SRM-SBR-004 to SRM-SBR-006): 1, 3, 4, 5, 6. Where there is no quotient it is not whole, and
    /// a ramp has at least one call.
    pub fn parameter_bits(&self) -> u16 {
        let call = self.t_sample.saturating_abs();
        let count = (call > 0).then(|| quotient(self.t_ramp, call));
        let whole = count.is_some_and(|count| count > 0 && multiple(self.v_max, count));
        diag(&[
            (1, !multiple(self.t_ramp, self.t_sample)),
            (3, !whole),
            (4, self.t_sample <= 0),
            (5, self.maxtol_v > self.v_max),
            (6, self.t_ramp < 0),
        ])
    }

    /// What the ramp falls by in a call; none where it is no whole number.
    pub const fn step(&self) -> Option<i32> {
        match calls(self.t_ramp, self.t_sample) {
            Some(count) if remainder(self.v_max, count) == 0 => Some(quotient(self.v_max, count)),
            _ => None,
        }
    }
}

fields! {
    /// What the monitoring does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// The ramp falls.
        Ramp,
        /// The ramp has ended, EXECUTE is still 1.
        Hold,
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the monitoring does.
        pub phase: Phase,
        /// The ramp, mm/min.
        pub ramp: i32,
        /// The position at its begin, mm.
        pub start: i32,
        /// The way of the ramp, whole mm.
        pub way: i32,
        /// What the way has left, in 60000ths of a mm.
        pub rest: i32,
        /// The ramp was violated: bit 0.
        pub violated: bool,
        /// A result was no DInt: bit 11.
        pub overflowed: bool,
        /// EXECUTE in the call before.
        pub execute_held: bool,
        /// ACK in the call before.
        pub ack_held: bool,
    }
}

/// Parts of a mm that the way is counted in: mm/min times ms.
const PARTS: i32 = 60_000;

impl State {
    /// Before the first call.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        ramp: 0,
        start: 0,
        way: 0,
        rest: 0,
        violated: false,
        overflowed: false,
        // A CPU that starts while the axis is to brake: its ramp is monitored (SRM-SBR-007).
        execute_held: false,
        ack_held: true,
    };

    /// Nothing runs beside wrong parameters; an idle monitor keeps nothing; the ramp is not above its begin and no more than 0 while
    /// it is held.
    pub fn invariant(&self, config: &Config) -> bool {
        let held = match self.phase {
            Phase::Idle => self.ramp == 0 && self.start == 0 && self.way == 0 && self.rest == 0,
            Phase::Ramp => {
                self.ramp <= config.v_max && (self.ramp > 0 || self.ramp == config.v_max)
            }
            Phase::Hold => self.ramp == 0 && self.execute_held,
        };
        held && -PARTS < self.rest
            && self.rest < PARTS
            && (self.phase == Phase::Idle || config.parameter_bits() == 0)
    }
}

fields! {
    /// The inputs of one call; whether position and velocity are valid is not among them (SRM-SBR-002).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Safe position, mm.
        pub safe_pos: i32,
        /// Safe velocity, mm/min.
        pub safe_v: i32,
        /// Starts the monitoring by an edge and keeps it.
        pub execute: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The ramp is kept, or nothing is monitored.
        pub sbr_ok: bool,
        /// The ramp falls.
        pub ramping: bool,
        /// Velocity and position are monitored.
        pub busy: bool,
        /// Limit of the way with its tolerance, mm; 0 while nothing is monitored.
        pub pos_threshold: i32,
        /// Limit of the velocity with its tolerance, mm/min; 0 while nothing is monitored.
        pub v_threshold: i32,
        /// A violation can be acknowledged.
        pub ack_req: bool,
        /// A fault is latched or a parameter is wrong.
        pub error: bool,
        /// The diagnostic word.
        pub diag: u16,
    }
}

/// A result, or 0 and a note that there is none.
fn noted(result: Option<i32>, overflow: &mut bool) -> i32 {
    *overflow |= result.is_none();
    result.unwrap_or(0)
}

/// The whole mm in a number of parts, which is less than 2^33, and what is left of them.
const fn whole_mm(parts: i64) -> (i32, i32) {
    ((parts / PARTS as i64) as i32, (parts % PARTS as i64) as i32)
}

/// Ramp, way and phase after a call.
fn ramp(state: &State, config: &Config, inputs: &Inputs, overflow: &mut bool) -> State {
    let edge = rises(inputs.execute, state.execute_held);
    let Some(step) = config.step().filter(|_| config.parameter_bits() == 0) else {
        return *state;
    };
    let loads = match state.phase {
        Phase::Idle => edge,
        Phase::Ramp => edge && config.sbr_retrig == SbrRetrig::Reload,
        Phase::Hold => false,
    };
    if loads {
        return State {
            phase: Phase::Ramp,
            ramp: config.v_max,
            start: inputs.safe_pos,
            way: 0,
            rest: 0,
            ..*state
        };
    }
    let mut after = *state;
    match state.phase {
        Phase::Idle => return after,
        Phase::Hold => {}
        Phase::Ramp => {
            let parts = noted(state.ramp.checked_mul(config.t_sample), overflow);
            // A rest is less than a mm.
            let parts = i64::from(parts) + i64::from(state.rest);
            let (whole, rest) = whole_mm(parts);
            after.rest = rest;
            after.way = match state.way.checked_add(whole) {
                Some(way) => way,
                None => {
                    *overflow = true;
                    state.way
                }
            };
            after.ramp = state.ramp.saturating_sub(step).max(0);
        }
    }
    after.phase = match (after.ramp > 0, inputs.execute) {
        (true, _) => Phase::Ramp,
        (false, true) => Phase::Hold,
        (false, false) => {
            // Nobody asks for the way any more.
            *overflow = false;
            return State {
                phase: Phase::Idle,
                ramp: 0,
                start: 0,
                way: 0,
                rest: 0,
                ..*state
            };
        }
    };
    after
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let mut overflow = false;
    let mut after = ramp(&state, config, inputs, &mut overflow);
    let busy = after.phase != Phase::Idle;
    let (mut v_threshold, mut pos_threshold, mut exceeds) = (0, 0, false);
    if busy {
        let sum = after.ramp.checked_add(config.maxtol_v);
        v_threshold = noted(sum, &mut overflow);
        let sum = after.way.checked_add(config.maxtol_pos);
        pos_threshold = noted(sum, &mut overflow);
        let way = apart(inputs.safe_pos, after.start);
        overflow |= way > i64::from(i32::MAX);
        exceeds =
            magnitude(inputs.safe_v) > i64::from(v_threshold) || way > i64::from(pos_threshold);
        if config.sbr_pos == SbrPos::Cycle {
            (after.start, after.way, after.rest) = (inputs.safe_pos, 0, 0);
        }
    }
    let slow = magnitude(inputs.safe_v) < i64::from(config.v_stop_monitoring);
    after.violated = latch(state.violated, exceeds, acknowledged, slow);
    after.overflowed = latch(state.overflowed, overflow, acknowledged, true);
    after.execute_held = inputs.execute;
    after.ack_held = inputs.ack;
    let parameters = config.parameter_bits();
    let blocked = config.err_react == ErrReact::Safe && (after.overflowed || parameters != 0);
    let diag = parameters | diag(&[(0, after.violated), (11, after.overflowed)]);
    let outputs = Outputs {
        sbr_ok: !after.violated && !blocked,
        ramping: after.phase == Phase::Ramp,
        busy,
        pos_threshold,
        v_threshold,
        ack_req: after.violated && slow && !exceeds || after.overflowed && !overflow,
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
            t_sample: 20,
            t_ramp: 100,
            v_max: 12_000,
            v_stop_monitoring: 100,
            maxtol_v: 500,
            maxtol_pos: 2,
            sbr_pos: SbrPos::Cum,
            sbr_retrig: SbrRetrig::Ignore,
            err_react: ErrReact::Safe,
        }
    }

    fn inputs(safe_pos: i32, safe_v: i32, execute: bool) -> Inputs {
        Inputs {
            safe_pos,
            safe_v,
            execute,
            ack: false,
        }
    }

    /// SRM-SBR-003, SRM-SBR-010, SRM-SBR-019, SRM-SBR-021: five calls of 2400 mm/min each; the way is that of the sum.
    #[test]
    fn a_ramp_of_five_calls() {
        let mut monitor = Monitor::new(config());
        assert!(monitor.step(&inputs(0, 0, false)).sbr_ok);
        // v(k) * 20 / 60000 mm: 4, 3.2, 2.4, 1.6, 0.8.
        let expected = [
            (12_500, 2),
            (10_100, 6),
            (7_700, 9),
            (5_300, 11),
            (2_900, 13),
        ];
        for (v, pos) in expected {
            let outputs = monitor.step(&inputs(0, 0, true));
            assert!(outputs.busy && outputs.ramping);
            assert_eq!((outputs.v_threshold, outputs.pos_threshold), (v, pos));
        }
        let outputs = monitor.step(&inputs(0, 0, true));
        assert!(outputs.busy && !outputs.ramping);
        // 12 mm: V_MAX * T_RAMP / 120000 = 10 mm and half a step more.
        assert_eq!((outputs.v_threshold, outputs.pos_threshold), (500, 14));
        assert!(!monitor.step(&inputs(0, 0, false)).busy);
    }

    /// SRM-SBR-008, SRM-SBR-009: above is a violation, equal is not.
    #[test]
    fn limits_are_inclusive() {
        for (safe_pos, safe_v, kept) in [
            (0, 12_500, true),
            (0, 12_501, false),
            (2, 0, true),
            (-2, 0, true),
            (3, 0, false),
            (-3, 0, false),
        ] {
            let mut monitor = Monitor::new(config());
            monitor.step(&inputs(0, 0, false));
            // The way counts from the call of the edge.
            let first = monitor.step(&inputs(0, safe_v, true));
            assert_eq!(first.sbr_ok, kept || safe_v == 0);
            let mut monitor = Monitor::new(Config {
                v_max: 0,
                maxtol_v: 0,
                ..config()
            });
            monitor.step(&inputs(0, 0, false));
            monitor.step(&inputs(0, 0, true));
            assert_eq!(
                monitor.step(&inputs(safe_pos, 0, true)).sbr_ok,
                kept || safe_v != 0
            );
        }
    }

    /// SRM-SBR-004 to SRM-SBR-006, SRM-SBR-016.
    #[test]
    fn parameters_have_their_bits() {
        let right = config();
        assert_eq!(right.parameter_bits(), 0);
        for (wrong, bits) in [
            (
                Config {
                    t_ramp: 110,
                    ..right
                },
                1 << 1,
            ),
            (
                Config {
                    v_max: 12_001,
                    ..right
                },
                1 << 3,
            ),
            (Config { t_ramp: 0, ..right }, 1 << 3),
            (
                Config {
                    t_sample: 0,
                    ..right
                },
                1 << 4 | 1 << 3 | 1 << 1,
            ),
            (
                Config {
                    maxtol_v: 12_001,
                    ..right
                },
                1 << 5,
            ),
            (
                Config {
                    t_ramp: -100,
                    ..right
                },
                1 << 6 | 1 << 3,
            ),
            (
                Config {
                    t_ramp: -110,
                    ..right
                },
                1 << 6 | 1 << 3 | 1 << 1,
            ),
        ] {
            assert_eq!(wrong.parameter_bits(), bits);
            let mut monitor = Monitor::new(wrong);
            monitor.step(&inputs(0, 0, false));
            let outputs = monitor.step(&inputs(0, 0, true));
            assert!(outputs.error && !outputs.busy && !outputs.sbr_ok);
            assert_eq!(outputs.diag, bits);
        }
    }
}
