//! What functions have in common: stop responses, the choice of encoder and braking monitor. No step.

fields! {
    /// A stop response, by rising priority (Table 9-3). STOP F is none of them: it is a time that runs beside.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stop {
        /// No stop.
        #[default]
        None,
        /// SOS after p9554, with extended stop and retract.
        E,
        /// SOS after p9553; the control brakes.
        D,
        /// Braking along OFF3, then SOS after p9552: as SS2.
        C,
        /// Braking along OFF3, then STOP A: as SS1.
        B,
        /// Pulses off: as STO.
        A,
    }
}

impl Stop {
    /// The response of a parameter p9562, p9563 or p9566: 0 is STOP A, 1 is STOP B, 2 to 4 are C to E; 10 more delays the
    /// cancellation of the pulses on a failure of the bus and is the same stop here (S120-SLS-003, S120-SLP-004).
    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 | 10 => Some(Self::A),
            1 | 11 => Some(Self::B),
            2 | 12 => Some(Self::C),
            3 | 13 => Some(Self::D),
            4 | 14 => Some(Self::E),
            _ => None,
        }
    }

    /// Whether a function may be configured to raise it: one without encoder raises STOP A or B only (S120-SLS-014).
    pub const fn allowed(self, encoder: bool) -> bool {
        match self {
            Self::None => false,
            Self::A | Self::B => true,
            Self::C | Self::D | Self::E => encoder,
        }
    }
}

fields! {
    /// p9506: whether there is an encoder that is fit for safety, and what monitors braking (S120-ENC-002).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Braking {
        /// With encoder, the acceleration is monitored (SAM).
        #[default]
        EncoderSam,
        /// Without encoder, the ramp is monitored (SBR).
        BareSbr,
        /// With encoder, the ramp is monitored (SBR).
        EncoderSbr,
        /// Without encoder, the acceleration is monitored (SAM).
        BareSam,
    }
}

impl Braking {
    /// There is an encoder: SOS, SS2, SLP, referencing, brake test and gear stages are possible (S120-ARCH-005, S120-SOS-001,
    /// S120-SS2-005).
    pub const fn encoder(self) -> bool {
        matches!(self, Self::EncoderSam | Self::EncoderSbr)
    }

    /// The ramp monitors braking, not the acceleration (S120-SAM-002, S120-SBR-001).
    pub const fn ramp(self) -> bool {
        matches!(self, Self::BareSbr | Self::EncoderSbr)
    }
}

/// Whether an input has become 1 since the cycle before.
pub const fn rises(now: bool, before: bool) -> bool {
    now && !before
}

/// Whether an input has become 0 since the cycle before.
pub const fn falls(now: bool, before: bool) -> bool {
    !now && before
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SLS-003, S120-SLS-014, S120-SLP-004: codes, and which are left without an encoder.
    #[test]
    fn codes_of_responses() {
        let stops = [Stop::A, Stop::B, Stop::C, Stop::D, Stop::E];
        for (code, stop) in (0..5).zip(stops) {
            assert_eq!(Stop::from_code(code), Some(stop));
            assert_eq!(Stop::from_code(code + 10), Some(stop));
            assert!(stop.allowed(true));
            assert_eq!(stop.allowed(false), code < 2);
        }
        for code in [5, 9, 15, u8::MAX] {
            assert_eq!(Stop::from_code(code), None);
        }
        assert!(!Stop::None.allowed(true));
        assert!(Stop::E < Stop::D && Stop::D < Stop::C && Stop::C < Stop::B && Stop::B < Stop::A);
    }

    /// S120-ENC-002: the four values of p9506.
    #[test]
    fn encoder_and_braking_monitor() {
        let both = |braking: Braking| (braking.encoder(), braking.ramp());
        let expected = [(true, false), (false, true), (true, true), (false, false)];
        assert_eq!(Braking::ALL.map(both), expected);
    }
}
