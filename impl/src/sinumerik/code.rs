//! The codes of STOP F: what the cross comparison or a test has found.
//!
//! They are the parameter of the alarms 27001 and 300911, with the numbers of the manual (`stop-f-codes.toml`). Only codes
//! that a monitor of this crate raises or compares have a value here.

use crate::fields::{Fields, Visitor};
use crate::sinumerik::agreement;

/// A code of STOP F.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u16);

impl Code {
    /// 0: this channel has found nothing; as the parameter of an alarm: the other channel has
    /// (S840D-KDV-703).
    pub const NONE: Self = Self(0);
    /// 1: SBH, SG or SE are in different states (result list 1).
    pub const RESULTS_1: Self = Self(1);
    /// 2: cams or the speed threshold are in different states (result list 2).
    pub const RESULTS_2: Self = Self(2);
    /// 3: the safe actual values differ.
    pub const POSITION: Self = Self(3);
    /// 5: the enable words differ.
    pub const FUNCTION_ENABLE: Self = Self(5);
    /// 10: the standstill tolerances differ.
    pub const STANDSTILL_TOLERANCE: Self = Self(10);
    /// 44: the first of the codes 44 to 57, the limits made anew in every cycle; this one is the upper limit of SG1.
    pub const LIMITS: Self = Self(44);
    /// 58: the external stop requests differ.
    pub const EXTERNAL_STOP: Self = Self(58);
    /// 82: the selected correction factors differ.
    pub const OVERRIDE: Self = Self(82);
    /// 84: the delays from STOP F to STOP B differ.
    pub const FAULT_DELAY: Self = Self(84);
    /// 1000: signals change too often.
    pub const TOO_MANY_CHANGES: Self = Self(1000);
    /// 1002: the user agreements differ too long (S840D-KDV-718).
    pub const AGREEMENT_DIFFERS: Self = Self(1002);
    /// 1003: the reference position is not the stored one (S840D-KDV-719).
    pub const AGREEMENT_POSITION: Self = Self(1003);
    /// 1004: the user agreement is implausible (S840D-KDV-720).
    pub const AGREEMENT_PLAUSIBILITY: Self = Self(1004);
    /// 1005: the pulses are already cancelled where the test of the shutdown path is selected (S840D-KDV-721).
    pub const ALREADY_CANCELLED: Self = Self(1005);
    /// 1009: the pulses are not cancelled in time by the test of the shutdown path (S840D-KDV-723).
    pub const TEST_FAILED: Self = Self(1009);
    /// 1010: the pulses are not cancelled in time by the test of the external shutdown (S840D-KDV-723).
    pub const EXTERNAL_TEST_FAILED: Self = Self(1010);

    /// The code of a number, where this crate knows it: 0 to 3, 5 to 42, 44 to 85 and 89 of the comparison, 1000, 1002 to
    /// 1005, 1009 and 1010 of its timers and of the tests. 4 and 86 to 88 are not assigned (S840D-KDV-708).
    pub const fn of(number: u16) -> Option<Self> {
        match number {
            0..=3 | 5..=42 | 44..=85 | 89 | 1000 | 1002..=1005 | 1009 | 1010 => Some(Self(number)),
            _ => None,
        }
    }

    /// The printed number.
    pub const fn number(self) -> u16 {
        self.0
    }

    /// No finding.
    pub const fn is_none(self) -> bool {
        self.0 == 0
    }

    /// Whether the code is an error of the actual value, 3 or 44 to 57: bit 0 of the system variable of STOP F
    /// (S840D-KDV-730).
    pub const fn is_actual_value(self) -> bool {
        matches!(self.0, 3 | 44..=57)
    }
}

/// Its printed number; one that is no code counts as none.
impl Fields for Code {
    const ANY: Self = Self::NONE;

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        let mut number = self.0;
        number.visit(name, visitor);
        *self = Self::of(number).unwrap_or(Self::NONE);
    }
}

impl From<agreement::Code> for Code {
    fn from(code: agreement::Code) -> Self {
        match code {
            agreement::Code::None => Self::NONE,
            agreement::Code::Differs => Self::AGREEMENT_DIFFERS,
            agreement::Code::Position => Self::AGREEMENT_POSITION,
            agreement::Code::Plausibility => Self::AGREEMENT_PLAUSIBILITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_codes_of_the_agreement_keep_their_numbers() {
        for code in [
            agreement::Code::None,
            agreement::Code::Differs,
            agreement::Code::Position,
            agreement::Code::Plausibility,
        ] {
            assert_eq!(Code::from(code).number(), code.number());
            assert_eq!(Code::of(code.number()), Some(Code::from(code)));
        }
    }

    #[test]
    fn unknown_numbers_are_refused() {
        for number in [4, 43, 86, 88, 90, 999, 1001, 1006, 1020, u16::MAX] {
            assert_eq!(Code::of(number), None);
        }
    }
}
