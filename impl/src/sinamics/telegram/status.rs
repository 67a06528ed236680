//! Safety status words, from the drive to the F host.

use super::control::level;

word! {
    /// S_ZSW1, telegram 30 (table 5-8; S120-PSAFE-512).
    StatusWord1(u16) {
        /// STO is active.
        0 sto_active,
        /// SS1 is active.
        1 ss1_active,
        /// SS2 is active.
        2 ss2_active,
        /// SOS is active.
        3 sos_active,
        /// SLS is active.
        4 sls_active,
        /// SLP is active and the axis safely referenced.
        6 slp_active,
        /// Internal event.
        7 internal_event,
        /// Bit 0 of the active SLS level.
        9 sls_level_0,
        /// Bit 1 of the active SLS level.
        10 sls_level_1,
        /// SOS is selected.
        11 sos_selected,
        /// SDI positive is active.
        12 sdi_positive_active,
        /// SDI negative is active.
        13 sdi_negative_active,
        /// SSM: the speed is below its limit.
        15 ssm,
    }
}

word! {
    /// S_ZSW2, telegrams 31, 901 and 902 (table 5-10; S120-PSAFE-512, S120-PSAFE-513).
    StatusWord2(u32) {
        /// STO is active.
        0 sto_active,
        /// SS1 is active.
        1 ss1_active,
        /// SS2 is active.
        2 ss2_active,
        /// SOS is active.
        3 sos_active,
        /// SLS is active.
        4 sls_active,
        /// SLP is active and the axis safely referenced.
        6 slp_active,
        /// Internal event.
        7 internal_event,
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
        /// F-DI 0 of a CU310-2 is inactive, high.
        24 input_0,
        /// F-DI 1 of a CU310-2 is inactive, high.
        25 input_1,
        /// F-DI 2 of a CU310-2 is inactive, high.
        26 input_2,
        /// SS2E is active.
        28 ss2e_active,
        /// SOS is selected.
        29 sos_selected,
        /// The upper limit of SLP is maintained.
        30 slp_upper_maintained,
        /// The lower limit of SLP is maintained.
        31 slp_lower_maintained,
    }
}

impl StatusWord1 {
    /// The bits that are valid with Basic Functions (table 5-4; S120-PSAFE-509).
    pub const BASIC: u16 = 1 | 1 << 1 | 1 << 7;

    /// What is sent with Basic Functions: all other bits are 0 (S120-PSAFE-509).
    pub const fn basic(self) -> Self {
        Self::decode(self.encode() & Self::BASIC)
    }

    /// The active SLS level, 1 to 4; of no meaning unless SLS is active.
    pub const fn sls_level(self) -> u8 {
        level(self.sls_level_0, self.sls_level_1)
    }
}

impl StatusWord2 {
    /// The bits that are valid with Basic Functions (table 5-6; S120-PSAFE-509).
    pub const BASIC: u32 = 1 | 1 << 1 | 1 << 7;

    /// What is sent with Basic Functions: all other bits are 0 (S120-PSAFE-509).
    pub const fn basic(self) -> Self {
        Self::decode(self.encode() & Self::BASIC)
    }

    /// The active SLS level, 1 to 4; of no meaning unless SLS is active.
    pub const fn sls_level(self) -> u8 {
        level(self.sls_level_0, self.sls_level_1)
    }

    /// With the F-DI of a CU310-2, those only that p10050 transfers (S120-PSAFE-525). `values`: their values; `transferred`:
    /// p10050; both by bit, F-DI 0 to 2. What is not transferred is 0.
    pub const fn with_inputs(self, values: u8, transferred: u8) -> Self {
        let sent = values & transferred;
        Self {
            input_0: sent & 1 != 0,
            input_1: sent & 2 != 0,
            input_2: sent & 4 != 0,
            ..self
        }
    }

    /// Whether the host may use the position and its cycle counter; absolute positions only where the axis is safely referenced
    /// too (S120-PSAFE-518).
    pub const fn position_is_absolute(self) -> bool {
        self.position_valid && self.safely_referenced
    }
}
