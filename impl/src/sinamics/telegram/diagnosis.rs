//! Words of the diagnosis, with the bits of the telegrams where they mean the same.

use super::control::ControlWord2;
use super::status::StatusWord2;
use crate::sinamics::level::Stop;

word! {
    /// r9721, status signals (S120-DIAG-502).
    StopSignals(u16) {
        /// The pulses are cancelled.
        2 pulses_cancelled,
        /// The axis is safely referenced.
        7 safely_referenced,
        /// STOP A or B is active.
        12 stop_a_or_b,
        /// STOP C is active.
        13 stop_c,
        /// STOP D is active.
        14 stop_d,
        /// STOP E is active.
        15 stop_e,
    }
}

impl StopSignals {
    /// The signals of a stop (S120-DIAG-502).
    pub const fn of(stop: Stop, pulses_cancelled: bool, safely_referenced: bool) -> Self {
        Self {
            pulses_cancelled,
            safely_referenced,
            stop_a_or_b: stop.cancels_pulses() || matches!(stop, Stop::B),
            stop_c: matches!(stop, Stop::C),
            stop_d: matches!(stop, Stop::D),
            stop_e: matches!(stop, Stop::E),
        }
    }
}

word! {
    /// r9722, status signals of the drive (S120-DIAG-501, S120-PSAFE-515).
    StatusSignals(u32) {
        /// STO is active.
        0 sto_active,
        /// SS1 is active, also STOP B.
        1 ss1_active,
        /// SS2 is active, also STOP C.
        2 ss2_active,
        /// SOS is active.
        3 sos_active,
        /// SLS is active.
        4 sls_active,
        /// SLP is selected; whether it is watched depends on the reference too.
        6 slp_active,
        /// There is no internal event.
        7 no_internal_event,
        /// Bit 0 of the active SLS level.
        9 sls_level_0,
        /// Bit 1 of the active SLS level.
        10 sls_level_1,
        /// SDI positive is active.
        12 sdi_positive_active,
        /// SDI negative is active.
        13 sdi_negative_active,
        /// SSM: the speed is below its limit.
        15 ssm,
        /// SLP area 2 is active, else area 1.
        19 slp_area_2,
        /// The safe position is valid.
        22 position_valid,
        /// The axis is safely referenced.
        23 safely_referenced,
        /// SS2E is active, also STOP D.
        28 ss2e_active,
        /// The upper limit of SLP is maintained.
        30 slp_upper_maintained,
        /// The lower limit of SLP is maintained.
        31 slp_lower_maintained,
    }
}

impl StatusSignals {
    /// The status word that goes to the F host: SLP is active only where the axis is safely referenced, and the internal event
    /// has the other polarity (S120-PSAFE-515, S120-PSAFE-512). F-DI are added by [`StatusWord2::with_inputs`].
    pub const fn status_word(self, sos_selected: bool) -> StatusWord2 {
        StatusWord2 {
            sto_active: self.sto_active,
            ss1_active: self.ss1_active,
            ss2_active: self.ss2_active,
            sos_active: self.sos_active,
            sls_active: self.sls_active,
            slp_active: self.slp_active && self.safely_referenced,
            internal_event: !self.no_internal_event,
            sls_level_0: self.sls_level_0,
            sls_level_1: self.sls_level_1,
            sdi_positive_active: self.sdi_positive_active,
            sdi_negative_active: self.sdi_negative_active,
            ssm: self.ssm,
            slp_area_2: self.slp_area_2,
            position_valid: self.position_valid,
            safely_referenced: self.safely_referenced,
            input_0: false,
            input_1: false,
            input_2: false,
            ss2e_active: self.ss2e_active,
            sos_selected,
            slp_upper_maintained: self.slp_upper_maintained,
            slp_lower_maintained: self.slp_lower_maintained,
        }
    }
}

/// r9720, the control signals as the drive sees them: the bits of S_STW2, with 1 for deselected, but the acknowledgement
/// (S120-DIAG-500).
pub const fn control_signals(word: ControlWord2) -> u32 {
    word.encode() & !(1 << 7)
}

word! {
    /// r9772, how Basic Functions are selected (S120-DIAG-503).
    BasicSelection(u32) {
        /// STO over the terminals.
        17 sto_terminals,
        /// STO over PROFIsafe.
        20 sto_profisafe,
        /// SS1 over the terminals.
        22 ss1_terminals,
        /// SS1 over PROFIsafe.
        23 ss1_profisafe,
    }
}

word! {
    /// r9773 of the drive, r9774 of its group: both channels together (S120-DIAG-503).
    BasicStatus(u32) {
        /// STO is selected.
        0 sto_selected,
        /// STO is active.
        1 sto_active,
        /// SBC is requested.
        4 sbc_requested,
        /// SS1 is selected.
        5 ss1_selected,
        /// SS1 is active.
        6 ss1_active,
        /// The test of the shutdown paths is required.
        31 test_required,
    }
}

impl BasicStatus {
    /// What both channels show: a signal that one of them lacks is 0 (S120-DIAG-503).
    pub const fn of_both(first: Self, second: Self) -> Self {
        Self::decode(first.encode() & second.encode())
    }
}
