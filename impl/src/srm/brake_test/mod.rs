//! F_BRAKE_TEST (FB203): the safe brake test (SBT) of the drive for two brakes, sequence by sequence, and what holds until it is passed.
//!
//! An edge at EXECUTE selects the test in the drive. For every configured sequence, brake 1 first, the block starts it; the drive builds
//! up its torque against the closed brake and reports the result. An external brake is closed and opened by the block, and read back
//! when its time is over; a motor holding brake is the drive's own business. The first fault cancels all.
//!
//! Until a test is passed the axis may only move slowly and not in the direction of RELEASE_DIR; an acknowledgement changes nothing
//! about that. The block measures no time of the torque phase: a drive that never finishes leaves it busy until an enable, the selection
//! or the position goes (SRM-BRAKETEST-053).
//!
//! The monitoring times of bits 9 and 10 are not in the manual (AMB-46): parameters of this implementation, as the interval (TIME,
//! measured by F_TP) in calls. Readings: AMB-17 (a wrong parameter also closes both brakes), AMB-18, AMB-19 ONE, AMB-43 to AMB-45,
//! AMB-47 to AMB-51, AMB-53, AMB-72.

mod laws;
mod sequence;
mod word;

pub use laws::*;
pub use word::*;

use crate::kernel::Cycles;
use crate::srm::common::{
    ErrReact, UNLIMITED, apart, bit, calls, diag, latch, magnitude, multiple, release_velocity,
    rises,
};

fields! {
    /// Reading AMB-49: what holds before the first test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Unproven {
        /// What holds after a failed one.
        #[default]
        Restricted,
        /// No restriction.
        Free,
    }
}

fields! {
    /// Reading AMB-72: which result of the drive counts.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SbtFresh {
        /// One that the drive has run for after the start of the sequence.
        #[default]
        Fresh,
        /// Any that it shows.
        Level,
    }
}

config! {
    /// The parameters: any value, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// T_INTERVAL, in calls: after it a test is asked for.
        pub t_interval: Cycles,
        /// Time between two calls, ms.
        pub t_sample: i32,
        /// SEQUENCE_BR_1: bits 0 to 3 the sequences, bit 4 a motor holding brake.
        pub sequence_br_1: u16,
        /// Opening time of brake 1, ms.
        pub t_open_br_1: i32,
        /// Closing time of brake 1, ms.
        pub t_close_br_1: i32,
        /// SEQUENCE_BR_2.
        pub sequence_br_2: u16,
        /// Opening time of brake 2, ms.
        pub t_open_br_2: i32,
        /// Closing time of brake 2, ms.
        pub t_close_br_2: i32,
        /// By so much the axis may move in a test, mm.
        pub pos_tolerance: i32,
        /// Velocity without a passed test, mm/min.
        pub vmax_release: i32,
        /// How long the drive may take to report its selection, calls.
        pub t_mon_sel: Cycles,
        /// How long it may take to ask for the brake, calls.
        pub t_mon_req: Cycles,
        /// What holds before the first test.
        pub unproven: Unproven,
        /// Which result counts.
        pub sbt_fresh: SbtFresh,
        /// What a wrong parameter or a calculation fault does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The bits that the first call reports: 4 and 5 (SRM-BRAKETEST-005, SRM-BRAKETEST-006).
    pub fn parameter_bits(&self) -> u16 {
        let range = self.t_sample < 1
            || self.t_open_br_1 < 1
            || self.t_close_br_1 < 1
            || self.t_open_br_2 < 1
            || self.t_close_br_2 < 1
            || self.pos_tolerance < 0
            || self.vmax_release < 1;
        let whole = multiple(self.t_open_br_1, self.t_sample)
            && multiple(self.t_close_br_1, self.t_sample)
            && multiple(self.t_open_br_2, self.t_sample)
            && multiple(self.t_close_br_2, self.t_sample);
        diag(&[(4, range), (5, !whole)])
    }

    const fn word(&self, second: bool) -> u16 {
        if second {
            self.sequence_br_2
        } else {
            self.sequence_br_1
        }
    }

    /// A brake has the sequence, 0 to 3.
    pub const fn has(&self, second: bool, sequence: u8) -> bool {
        sequence < 4 && bit(self.word(second), sequence as u32)
    }

    /// A brake has some sequence.
    pub const fn tests(&self, second: bool) -> bool {
        self.word(second) & 0xF != 0
    }

    /// A brake is an external one.
    pub const fn external(&self, second: bool) -> bool {
        !bit(self.word(second), 4)
    }

    /// How many calls a brake has to close, or to open.
    pub const fn travel(&self, second: bool, close: bool) -> Cycles {
        let time = match (second, close) {
            (false, true) => self.t_close_br_1,
            (false, false) => self.t_open_br_1,
            (true, true) => self.t_close_br_2,
            (true, false) => self.t_open_br_2,
        };
        match calls(time, self.t_sample) {
            Some(count) => Cycles::new(count as u32),
            None => Cycles::ZERO,
        }
    }
}

fields! {
    /// Where the test is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing is proven since the restart or the last failure.
        #[default]
        Unproven,
        /// The last test was passed.
        Passed,
        /// The drive is to report that the test is selected.
        Select,
        /// A sequence is started; the drive asks for the brake, or runs.
        Start,
        /// The external brake closes.
        Close,
        /// The drive builds up its torque.
        Torque,
        /// The external brake opens.
        Open,
        /// The external brake is open; the drive is to report the result.
        Result,
        /// Failed, to be acknowledged.
        Failed,
    }
}

impl Phase {
    /// A sequence runs.
    pub const fn tests(self) -> bool {
        matches!(
            self,
            Self::Start | Self::Close | Self::Torque | Self::Open | Self::Result
        )
    }

    /// A test runs.
    pub const fn busy(self) -> bool {
        self.tests() || matches!(self, Self::Select)
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the test is.
        pub phase: Phase,
        /// Brake 2 is tested.
        pub second: bool,
        /// The sequence, 0 to 3.
        pub sequence: u8,
        /// What is left of the time of the phase.
        pub timer: Cycles,
        /// The drive has run since the start of the sequence.
        pub ran: bool,
        /// The position at EXECUTE, mm.
        pub start: i32,
        /// BR_1_OK.
        pub first_ok: bool,
        /// A test has been started since the restart.
        pub tried: bool,
        /// Bits 0, 1, 3, 6 to 10 of `DIAG`: they stay until the next passed test.
        pub faults: u16,
        /// Too fast, or the velocity invalid, without a passed test: bit 2.
        pub fast: bool,
        /// A result was no DInt: bit 11.
        pub overflowed: bool,
        /// A test is asked for.
        pub due: bool,
        /// What is left of the interval.
        pub left: Cycles,
        /// EXECUTE in the call before.
        pub execute_held: bool,
        /// ACK in the call before.
        pub ack_held: bool,
    }
}

/// The bits of `DIAG` that a test can set.
pub const TEST_BITS: u16 = 0b111_1100_1011;

impl State {
    /// Before the first call.
    pub const INITIAL: Self = Self {
        phase: Phase::Unproven,
        second: false,
        sequence: 0,
        timer: Cycles::ZERO,
        ran: false,
        start: 0,
        first_ok: false,
        tried: false,
        faults: 0,
        fast: false,
        overflowed: false,
        due: true,
        left: Cycles::ZERO,
        execute_held: true,
        ack_held: true,
    };

    /// A test runs with right parameters through configured sequences, and with nothing to acknowledge; no time is longer than its
    /// parameter; what is passed is proven and has no fault.
    pub fn invariant(&self, config: &Config) -> bool {
        let busy = self.phase.busy();
        let limit = match self.phase {
            Phase::Select => config.t_mon_sel,
            Phase::Start => config.t_mon_req,
            Phase::Close => config.travel(self.second, true),
            Phase::Open => config.travel(self.second, false),
            _ => Cycles::ZERO,
        };
        let of_external = matches!(self.phase, Phase::Close | Phase::Open | Phase::Result);
        let place = if self.phase.tests() {
            config.has(self.second, self.sequence)
                && (!of_external || config.external(self.second))
                && self.first_ok == (self.second && config.tests(false))
        } else {
            !self.second && self.sequence == 0 && !self.ran
        };
        let clean = !self.fast && !self.overflowed;
        let proven = self.phase != Phase::Passed
            || clean && self.faults == 0 && self.first_ok == config.tests(false);
        let idle = busy || self.start == 0;
        place
            && proven
            && idle
            && self.timer <= limit
            && (!busy || clean && config.parameter_bits() == 0)
            && (self.phase != Phase::Select || !self.first_ok)
            && (self.phase == Phase::Unproven || self.tried)
            && (self.tried || !self.first_ok && self.faults == 0)
            && self.left <= config.t_interval
            && self.faults & !TEST_BITS == 0
            && (config.tests(false) || !self.first_ok)
            && (config.tests(false) || config.tests(true) || !self.tried)
            && (config.parameter_bits() == 0 || !self.tried)
    }
}

fields! {
    /// The inputs of one call (SRM-BRAKETEST-004).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Safe velocity, mm/min.
        pub safe_v: i32,
        /// Safe position, mm.
        pub safe_pos: i32,
        /// The velocity is valid.
        pub v_valid: bool,
        /// The position is valid.
        pub pos_valid: bool,
        /// The brakes in normal operation: 1 opens.
        pub fdback_drive: bool,
        /// Brake 1 is closed.
        pub fdback_br_1: bool,
        /// Brake 2 is closed.
        pub fdback_br_2: bool,
        /// What S_ZSW3B says.
        pub sbt: Status,
        /// Starts a test.
        pub execute: bool,
        /// Acknowledgement.
        pub ack: bool,
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
        /// A test is asked for.
        pub test_req: bool,
        /// A test runs.
        pub busy: bool,
        /// Brake 1 is to be open.
        pub open_br_1: bool,
        /// Brake 2 is to be open.
        pub open_br_2: bool,
        /// What S_STW3B says.
        pub stw: Control,
        /// The last test was passed.
        pub test_ok: bool,
        /// Brake 1 was passed in it.
        pub br_1_ok: bool,
        /// Brake 2 was passed in it.
        pub br_2_ok: bool,
        /// Both directions are permitted.
        pub release_dir: bool,
        /// Something can be acknowledged.
        pub ack_req: bool,
        /// A fault is latched or a parameter is wrong.
        pub error: bool,
        /// The diagnostic word.
        pub diag: u16,
    }
}

/// The axis may only move slowly.
const fn restricted(state: &State, config: &Config) -> bool {
    !matches!(state.phase, Phase::Passed)
        && (matches!(config.unproven, Unproven::Restricted) || state.tried)
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let slow = release_velocity(config.vmax_release);
    let keeps = inputs.v_valid && magnitude(inputs.safe_v) <= i64::from(slow);
    let parameters = config.parameter_bits();
    let overflow = state.phase.tests() && apart(inputs.safe_pos, state.start) > i64::from(i32::MAX);

    let mut after = sequence::next(&state, config, inputs, keeps);
    let chained = state.phase.tests() && state.phase != Phase::Start && after.phase == Phase::Start;
    after.left = if after.phase == Phase::Passed && state.phase != Phase::Passed {
        after.due = false;
        config.t_interval
    } else {
        let left = state.left.tick();
        after.due |= left.is_zero();
        left
    };
    let restricts = restricted(&after, config);
    let too_fast = restricts && !keeps;
    after.fast = latch(state.fast, too_fast, acknowledged, keeps);
    after.overflowed = latch(state.overflowed, overflow, acknowledged, true);
    after.execute_held = inputs.execute;
    after.ack_held = inputs.ack;

    let wrong = parameters != 0 && config.err_react == ErrReact::Safe;
    let blocked = wrong || after.overflowed && config.err_react == ErrReact::Safe;
    let phase = after.phase;
    let (busy, tests) = (phase.busy(), phase.tests());
    let closes = |second: bool| {
        config.external(second)
            && after.second == second
            && matches!(phase, Phase::Close | Phase::Torque)
    };
    let open = |second: bool| inputs.fdback_drive && !closes(second) && !wrong;
    let diag = parameters
        | after.faults
        | diag(&[
            (2, after.fast),
            (11, after.overflowed),
            (14, !inputs.pos_valid),
            (15, !inputs.v_valid),
        ]);
    let failed = phase == Phase::Failed;
    let outputs = Outputs {
        sls_threshold: if restricts || blocked {
            slow
        } else {
            UNLIMITED
        },
        sls_ok: !after.fast && !blocked,
        test_req: after.due,
        busy,
        open_br_1: open(false),
        open_br_2: open(true),
        stw: Control {
            select: busy,
            start: tests && !chained,
            br_select: tests && after.second,
            torque_dir: tests && after.sequence % 2 == 1,
            sequence: tests && after.sequence >= 2,
            fdback_br: config.external(after.second)
                && matches!(phase, Phase::Torque | Phase::Open),
        },
        test_ok: phase == Phase::Passed,
        br_1_ok: after.first_ok,
        br_2_ok: phase == Phase::Passed && config.tests(true),
        release_dir: !restricts && !blocked,
        ack_req: failed || after.fast && keeps || after.overflowed && !overflow,
        error: failed || after.fast || after.overflowed || parameters != 0,
        diag,
    };
    (after, outputs)
}
