//! Safety control words, from the F host to the drive.
//!
//! The bits that select a function are low-active: 1 deselects. A word of zeros selects everything, so a substitute value does.

word! {
    /// S_STW1, telegram 30 (table 5-7; S120-PSAFE-508, S120-PSAFE-510, S120-PSAFE-526).
    ControlWord1(u16) {
        /// 1 deselects STO.
        0 sto,
        /// 1 deselects SS1.
        1 ss1,
        /// 1 deselects SS2.
        2 ss2,
        /// 1 deselects SOS.
        3 sos,
        /// 1 deselects SLS.
        4 sls,
        /// 1 deselects SLP.
        6 slp,
        /// Internal Event ACK: the falling edge acknowledges.
        7 internal_event_ack,
        /// Bit 0 of the SLS level.
        9 sls_level_0,
        /// Bit 1 of the SLS level.
        10 sls_level_1,
        /// 1 deselects SDI positive.
        12 sdi_positive,
        /// 1 deselects SDI negative.
        13 sdi_negative,
    }
}

word! {
    /// S_STW2, telegrams 31, 901 and 902 (tables 5-5 and 5-9; S120-PSAFE-508, S120-PSAFE-510, S120-PSAFE-526).
    ///
    /// Table 5-9 is mutilated in the manual: bits 24 to 27 are those of the section on gearbox switchover (AC-14).
    ControlWord2(u32) {
        /// 1 deselects STO.
        0 sto,
        /// 1 deselects SS1.
        1 ss1,
        /// 1 deselects SS2.
        2 ss2,
        /// 1 deselects SOS.
        3 sos,
        /// 1 deselects SLS.
        4 sls,
        /// 1 deselects SLP.
        6 slp,
        /// Internal Event ACK: the falling edge acknowledges.
        7 internal_event_ack,
        /// Bit 0 of the SLS level.
        9 sls_level_0,
        /// Bit 1 of the SLS level.
        10 sls_level_1,
        /// 1 deselects SDI positive.
        12 sdi_positive,
        /// 1 deselects SDI negative.
        13 sdi_negative,
        /// 1 selects SLP area 2, 0 area 1.
        19 slp_area_2,
        /// Bit 0 of the gearbox stage.
        24 gear_0,
        /// Bit 1 of the gearbox stage.
        25 gear_1,
        /// Bit 2 of the gearbox stage.
        26 gear_2,
        /// 1: increased position tolerance for gearbox switchover.
        27 gear_tolerance,
        /// 1 deselects SS2E.
        28 ss2e,
    }
}

impl ControlWord1 {
    /// The bits that Basic Functions evaluate (table 5-3; S120-PSAFE-509).
    pub const BASIC: u16 = 1 | 1 << 1 | 1 << 7;

    /// What Basic Functions see of the word: all else has no effect, since those functions do not exist (S120-PSAFE-509).
    pub const fn basic(self) -> Self {
        Self::decode(self.encode() & Self::BASIC)
    }

    /// The SLS level, 1 to 4 (S120-PSAFE-510).
    pub const fn sls_level(self) -> u8 {
        level(self.sls_level_0, self.sls_level_1)
    }
}

impl ControlWord2 {
    /// The bits that Basic Functions evaluate (table 5-5; S120-PSAFE-509).
    pub const BASIC: u32 = 1 | 1 << 1 | 1 << 7;

    /// What Basic Functions see of the word: see [`ControlWord1::basic`] (S120-PSAFE-509).
    pub const fn basic(self) -> Self {
        Self::decode(self.encode() & Self::BASIC)
    }

    /// The SLS level, 1 to 4 (S120-PSAFE-510).
    pub const fn sls_level(self) -> u8 {
        level(self.sls_level_0, self.sls_level_1)
    }

    /// The gearbox stage, 0 to 7 (S120-PSAFE-510).
    pub const fn gear_stage(self) -> u8 {
        self.gear_0 as u8 + 2 * self.gear_1 as u8 + 4 * self.gear_2 as u8
    }
}

/// The level of two bits: 00 is SLS1.
pub(super) const fn level(bit_0: bool, bit_1: bool) -> u8 {
    1 + bit_0 as u8 + 2 * bit_1 as u8
}
