//! F_SAFE_POS (FB200): a safe position and a safe velocity from two or three encoders.
//!
//! POS1 defines the position, in mm. POSSI, the motor encoder of the drive in um, makes it plausible with two encoders; with three that
//! is POS2, which counts the other way, and POSSI may slip. The velocity is that of POSSI, in the time base of the telegram's counter;
//! the way that POS1 and POSSI go in a window of time makes it plausible.
//!
//! Each raw position has an offset. REFERENCE sets them so that all are at POS_REFERENCE, SYNC moves the others to POS1. An encoder fault
//! hides the comparison and keeps the reference: when the signals are back it is validated anew and may be acknowledged.
//!
//! Offsets, SAFE_POS and SAFE_V are DInt; one that is none is a calculation fault, and a command that would need one is not executed
//! (SRM-POS-033). All comparisons are exact. SAFE_POS is POS1 with its offset and is held while POS1 is invalid. The sample that a
//! velocity counts from is the last one with a new counter.
//!
//! With one encoder (POS1 = POSSI / 1000) only SAFE_V, V_VALID, STANDSTILL and the directions may be used (SRM-ARCH-010).
//! Readings: AMB-01 to AMB-18, AMB-19 ONE, AMB-20 to AMB-23.

mod channel;
mod laws;
#[cfg(test)]
mod tests;
mod velocity;

pub use laws::*;

use crate::kernel::Cycles;
use crate::srm::common::{ErrReact, calls, diag, latch, multiple, rises, within};
use channel::Positions;

fields! {
    /// Reading AMB-14: what SYNC does with the second direct encoder of a referenced axis.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum SyncPos2 {
        /// Nothing.
        #[default]
        Keep,
        /// It is moved to POS1.
        Align,
    }
}

fields! {
    /// Reading AMB-20: what a counter that does not move does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum CountWatch {
        /// After a time it is a velocity fault.
        #[default]
        Watch,
        /// The velocity is held.
        Hold,
    }
}

config! {
    /// The parameters: any DInt, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// Time between two calls, ms.
        pub t_sample: i32,
        /// Three encoders.
        pub pos_config: bool,
        /// Monitoring cycle of the drive, ms: 1 to 1023.
        pub possi_t_sample: i32,
        /// Least permitted position, mm.
        pub pos_min: i32,
        /// Greatest permitted position, mm.
        pub pos_max: i32,
        /// Window of a validation after an encoder fault, mm.
        pub pos_disc_window: i32,
        /// Window of POS1 and POS2 in operation, mm.
        pub pos2_disc_window: i32,
        /// Window of POS1 and POSSI in operation, mm.
        pub possi_disc_window: i32,
        /// By so much POS1 may have moved in a fault of POSSI, mm.
        pub pos_startup_tol: i32,
        /// Below this velocity the axis stands, mm/min.
        pub v_standstill: i32,
        /// Greatest permitted velocity, mm/min.
        pub v_max: i32,
        /// By so much the ways of POS1 and POSSI may differ in a window, mm.
        pub v_disc_window: i32,
        /// Length of the window, ms: a multiple of T_SAMPLE.
        pub v_sync_intervall: i32,
        /// Position of the reference point, mm.
        pub pos_reference: i32,
        /// For so many calls more than it needs the counter may stand: a parameter of this implementation.
        pub count_margin: Cycles,
        /// What SYNC does with POS2.
        pub sync_pos2: SyncPos2,
        /// What a standing counter does.
        pub count_watch: CountWatch,
        /// What a wrong parameter or a calculation fault does.
        pub err_react: ErrReact,
    }
    accepted |_config| true
}

impl Config {
    /// The bits that the first call reports: 0, 1, 2 (SRM-POSPARAM-013 to SRM-POSPARAM-015).
    pub fn parameter_bits(&self) -> u16 {
        let twice = 2 * i64::from(self.possi_t_sample);
        let range = within(1, self.possi_t_sample, 1_023)
            && self.v_sync_intervall > 0
            && self.t_sample > 0
            && i64::from(self.t_sample) <= twice
            && self.v_disc_window >= 0
            && self.pos_disc_window >= 0
            && self.pos_startup_tol >= 0;
        let uneven = !multiple(self.v_sync_intervall, self.t_sample);
        let order = self.v_max >= self.v_standstill && self.pos_max >= self.pos_min;
        diag(&[(0, !range), (1, uneven), (2, !order)])
    }

    /// Calls of a window of the drift.
    pub const fn window(&self) -> i32 {
        match calls(self.v_sync_intervall, self.t_sample) {
            Some(count) => count,
            None => 1,
        }
    }

    /// For so many calls the counter may stand: less than a number of calls can be, so that one more is told from it.
    pub const fn standing(&self) -> u32 {
        let (drive, own) = (self.possi_t_sample, self.t_sample);
        let cycle = if drive > 0 && own > 0 {
            (drive as u32).div_ceil(own as u32)
        } else {
            1
        };
        let calls = cycle.saturating_add(self.count_margin.count());
        if calls == u32::MAX {
            u32::MAX - 1
        } else {
            calls
        }
    }
}

fields! {
    /// Where the position is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Neither synchronised nor referenced.
        #[default]
        Unsync,
        /// Synchronised: for relative use.
        Synced,
        /// Referenced.
        Referenced,
        /// An encoder is faulty.
        EncoderFault,
        /// All are back and the reference is valid: to be acknowledged.
        Valid,
        /// All are back and the reference is not valid.
        Invalid,
        /// Two encoders have gone apart.
        Discrepant,
    }
}

impl Phase {
    /// The position is formed safely.
    pub const fn formed(self) -> bool {
        matches!(self, Self::Synced | Self::Referenced)
    }

    /// An encoder was faulty and nothing has been done about it.
    pub const fn faulty(self) -> bool {
        matches!(self, Self::EncoderFault | Self::Valid | Self::Invalid)
    }
}

fields! {
    /// The sign of the last change of SAFE_POS.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Direction {
        /// There was none.
        #[default]
        None,
        /// It rose.
        Positive,
        /// It fell.
        Negative,
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the position is.
        pub phase: Phase,
        /// Offset of POS1, mm.
        pub off1: i32,
        /// Offset of POSSI, um.
        pub off_si: i32,
        /// Offset of POS2, mm.
        pub off2: i32,
        /// The position of the last call in which it was formed safely, mm: kept in a fault.
        pub saved: i32,
        /// There was a reference before the fault.
        pub was_ref: bool,
        /// POSSI has failed since.
        pub si_failed: bool,
        /// A reference has been set since the restart.
        pub ever: bool,
        /// POS1 and POSSI have gone apart: bit 8.
        pub apart: bool,
        /// POS1 has moved too far in a fault of POSSI: bit 10.
        pub strayed: bool,
        /// POSSI does not confirm POS1 after a fault: bit 11.
        pub unconfirmed: bool,
        /// POS2 does not confirm POS1 after a fault: bit 12.
        pub unconfirmed2: bool,
        /// Above POS_MAX: bit 3.
        pub above: bool,
        /// Below POS_MIN: bit 4.
        pub below: bool,
        /// Above V_MAX: bit 5.
        pub fast: bool,
        /// The ways differ, or the counter stands: bit 6.
        pub drifted: bool,
        /// A result was no DInt: bit 13.
        pub overflowed: bool,
        /// SAFE_POS, mm.
        pub safe_pos: i32,
        /// SAFE_V, mm/min.
        pub safe_v: i32,
        /// The sign of the last change of SAFE_POS.
        pub direction: Direction,
        /// POS1 was valid in the call before.
        pub seen1: bool,
        /// POS1 then, mm.
        pub last1: i32,
        /// POSSI was valid in the call before.
        pub seen_si: bool,
        /// POSSI of the last new counter, um.
        pub sample: i32,
        /// That counter.
        pub count: i32,
        /// For so many calls the counter has stood.
        pub still: u32,
        /// POS1 at the begin of the window, mm.
        pub window1: i32,
        /// POSSI at the begin of the window, um.
        pub window_si: i32,
        /// Calls since then.
        pub window_calls: i32,
        /// REFERENCE in the call before.
        pub reference_held: bool,
        /// SYNC in the call before.
        pub sync_held: bool,
        /// ACK in the call before.
        pub ack_held: bool,
    }
}

impl State {
    /// After a restart.
    pub const INITIAL: Self = Self {
        phase: Phase::Unsync,
        off1: 0,
        off_si: 0,
        off2: 0,
        saved: 0,
        was_ref: false,
        si_failed: false,
        ever: false,
        apart: false,
        strayed: false,
        unconfirmed: false,
        unconfirmed2: false,
        above: false,
        below: false,
        fast: false,
        drifted: false,
        overflowed: false,
        safe_pos: 0,
        safe_v: 0,
        direction: Direction::None,
        seen1: false,
        last1: 0,
        seen_si: false,
        sample: 0,
        count: 0,
        still: 0,
        window1: 0,
        window_si: 0,
        window_calls: 0,
        reference_held: true,
        sync_held: true,
        ack_held: true,
    };

    /// What each phase can have behind it.
    pub fn invariant(&self, config: &Config) -> bool {
        let phase = self.phase;
        let validation = self.strayed || self.unconfirmed || self.unconfirmed2;
        let fault = phase.faulty() || !self.was_ref && !self.si_failed && !validation;
        let reference = (phase != Phase::Referenced && !self.was_ref || self.ever)
            && (phase != Phase::Valid || self.was_ref)
            && (!validation || self.was_ref);
        let two = !config.pos_config || !self.strayed && !self.unconfirmed && !self.apart;
        let three = config.pos_config || !self.unconfirmed2 && self.off2 == 0;
        let discrepancy = (phase != Phase::Discrepant || self.apart)
            && (!self.apart || phase == Phase::Discrepant || phase.faulty() && !self.was_ref);
        let window = if phase.formed() {
            within(0, self.window_calls, config.window().saturating_sub(1))
        } else {
            self.window1 == 0 && self.window_si == 0 && self.window_calls == 0
        };
        let samples = (self.seen1 || self.last1 == 0)
            && (self.seen_si || self.sample == 0 && self.count == 0 && self.still == 0);
        fault
            && reference
            && two
            && three
            && discrepancy
            && window
            && samples
            && self.safe_v >= 0
            && within(i16::MIN as i32, self.count, i16::MAX as i32)
            && u64::from(self.still) <= u64::from(config.standing()) + 1
            && (phase.formed() || phase.faulty() || self.saved == 0)
    }
}

fields! {
    /// The inputs of one call, of which POS1 and POS2 are mm, POSSI um; an encoder that is not valid has failed (SRM-ARCH-008,
    /// SRM-POSPARAM-004, SRM-POSPARAM-005).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// First direct encoder, mm.
        pub pos1: i32,
        /// It is valid.
        pub pos1_valid: bool,
        /// Second direct encoder, mm; counts the other way.
        pub pos2: i32,
        /// It is valid.
        pub pos2_valid: bool,
        /// Motor encoder, um.
        pub possi: i32,
        /// It is valid.
        pub possi_valid: bool,
        /// Cycle counter of the telegram; its lower 16 bits count.
        pub possi_count: i32,
        /// Sets the reference.
        pub reference: bool,
        /// Moves the other encoders to POS1.
        pub sync: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

impl Inputs {
    /// Every encoder that the configuration needs is valid.
    pub const fn valid(&self, config: &Config) -> bool {
        self.pos1_valid && self.possi_valid && (self.pos2_valid || !config.pos_config)
    }
}

fields! {
    /// The outputs of one call: a safe position and a safe velocity, for all other blocks (SRM-POSPARAM-001).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Safe position, mm.
        pub safe_pos: i32,
        /// It is formed safely.
        pub pos_valid: bool,
        /// It may be used as an absolute one.
        pub referenced: bool,
        /// Safe velocity, mm/min: a magnitude.
        pub safe_v: i32,
        /// It is formed safely.
        pub v_valid: bool,
        /// The axis stands.
        pub standstill: bool,
        /// The position rises.
        pub moves_positive: bool,
        /// The position falls.
        pub moves_negative: bool,
        /// Something can be acknowledged.
        pub ack_req: bool,
        /// A fault is latched or a parameter is wrong.
        pub error: bool,
        /// The diagnostic word.
        pub diag: u16,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let mut overflow = false;
    let mut after = channel::next(&state, config, inputs, &mut overflow);
    velocity::next(&state, &mut after, config, inputs, &mut overflow);
    let drifts = velocity::drifts(&state, &mut after, config, inputs);

    if inputs.pos1_valid {
        match i32::try_from(Positions::of(&after, inputs).one) {
            Ok(place) => after.safe_pos = place,
            Err(_) => overflow = true,
        }
        if state.seen1 && after.safe_pos != state.safe_pos {
            after.direction = if after.safe_pos > state.safe_pos {
                Direction::Positive
            } else {
                Direction::Negative
            };
        }
    }
    if after.phase.formed() {
        after.saved = after.safe_pos;
    }
    after.seen1 = inputs.pos1_valid;
    after.last1 = if inputs.pos1_valid { inputs.pos1 } else { 0 };
    after.reference_held = inputs.reference;
    after.sync_held = inputs.sync;
    after.ack_held = inputs.ack;

    let formed = after.phase.formed();
    let high = after.safe_pos > config.pos_max;
    let low = after.safe_pos < config.pos_min;
    let fast = after.safe_v > config.v_max;
    // What is supervised is the position that is formed: without one nothing is found and nothing acknowledged.
    let supervised = |held: bool, condition: bool| {
        latch(
            held,
            formed && condition,
            acknowledged && formed,
            !condition,
        )
    };
    after.above = supervised(state.above, high);
    after.below = supervised(state.below, low);
    after.fast = supervised(state.fast, fast);
    after.drifted = supervised(state.drifted, drifts);
    after.overflowed = latch(state.overflowed, overflow, acknowledged, true);

    let parameters = config.parameter_bits();
    let blocked = config.err_react == ErrReact::Safe && (parameters != 0 || after.overflowed);
    let diag = parameters
        | diag(&[
            (3, after.above),
            (4, after.below),
            (5, after.fast),
            (6, after.drifted),
            (7, !after.ever),
            (8, after.apart),
            (9, after.phase.faulty()),
            (10, after.strayed),
            (11, after.unconfirmed),
            (12, after.unconfirmed2),
            (13, after.overflowed),
        ]);
    let moves = after.safe_v >= config.v_standstill;
    let outputs = Outputs {
        safe_pos: after.safe_pos,
        pos_valid: formed && !after.above && !after.below && !blocked,
        referenced: after.phase == Phase::Referenced && !blocked,
        safe_v: after.safe_v,
        v_valid: formed && !after.fast && !after.drifted && !blocked,
        standstill: !moves,
        moves_positive: moves && after.direction == Direction::Positive,
        moves_negative: moves && after.direction == Direction::Negative,
        ack_req: after.phase == Phase::Valid
            || formed
                && (after.above && !high
                    || after.below && !low
                    || after.fast && !fast
                    || after.drifted && !drifts)
            || after.overflowed && !overflow,
        error: diag & !0x80 != 0,
        diag,
    };
    (after, outputs)
}
