//! Every alarm of Safety Integrated by its number: acknowledgement, what is beside it, what it hides (S840D-ALARM-711).
//!
//! [`crate::sinumerik::alarm`] has the alarms that the monitors of an axis raise, with their reactions; here are all, also
//! those of the safe logic, of PROFIsafe and of the parameters. A test compares them with the manual's table.
//!
//! Readings: AX-02 ACK27004_RESET, AX-03 ACK27299_PON.

use crate::sinumerik::alarm::{Acknowledgement, Class};

/// The numbers of all alarms, ascending (S840D-ALARM-733).
pub const NUMBERS: [u32; 95] = [
    20095, 20096, 20097, 27000, 27001, 27002, 27003, 27004, 27005, 27006, 27007, 27008, 27010,
    27011, 27012, 27013, 27020, 27021, 27022, 27023, 27024, 27030, 27031, 27032, 27033, 27034,
    27090, 27091, 27092, 27093, 27094, 27095, 27096, 27100, 27101, 27102, 27103, 27104, 27105,
    27106, 27107, 27124, 27200, 27201, 27202, 27203, 27204, 27205, 27206, 27207, 27220, 27221,
    27222, 27223, 27224, 27225, 27240, 27241, 27242, 27250, 27251, 27252, 27253, 27254, 27255,
    27256, 27299, 300500, 300743, 300744, 300745, 300746, 300747, 300748, 300749, 300776, 300900,
    300901, 300906, 300907, 300908, 300909, 300910, 300911, 300914, 300915, 300950, 300951, 300952,
    301701, 301706, 301707, 301708, 400253, 411101,
];

/// How the alarm of this number is acknowledged; `None` for one that is not of Safety Integrated (S840D-ALARM-711,
/// S840D-ALARM-721, S840D-ALARM-725/b).
pub const fn acknowledgement(number: u32) -> Option<Acknowledgement> {
    let (class, escalates) = match number {
        20095..=20097 => (Class::Cancel, false),
        27095 => (Class::NckKey, false),
        27000 | 27002 | 27005..=27008 | 27100 | 300950 | 300952 => (Class::SelfClearing, false),
        300951 => (Class::SelfClearing, true),
        27001 | 27011 | 27101..=27107 | 300911 | 300914 => (Class::Reset, true),
        27004 | 27012 | 27020..=27022 | 27090 | 27091 | 27094 | 27251..=27256 => {
            (Class::Reset, false)
        }
        300908..=300910 | 300915 => (Class::Reset, false),
        27003 | 27010 | 27013 | 27023 | 27024 | 27030..=27034 => (Class::PowerOn, false),
        27092 | 27093 | 27096 | 27124 | 27200..=27207 | 27220..=27225 => (Class::PowerOn, false),
        27240..=27242 | 27250 | 27299 | 300500 | 300743..=300749 | 300776 => {
            (Class::PowerOn, false)
        }
        300900 | 300901 | 300906 | 300907 | 301701 | 301706..=301708 => (Class::PowerOn, false),
        400253 | 411101 => (Class::PowerOn, false),
        _ => return None,
    };
    Some(Acknowledgement { class, escalates })
}

/// Whether RESET acknowledges the alarm in the acceptance test mode of group 1 though it needs power-on (S840D-ACCEPT-742).
pub const fn is_tested(number: u32) -> bool {
    matches!(number, 27010 | 27023 | 27024 | 300907 | 300901 | 300900)
}

/// The alarm of the drive that means the same as this one of the NCK, where one of them is suppressed (S840D-ALARM-702, table
/// 8-1 of the manual; 27000 and 300950, which 27100 replaces, are no pair here).
pub const fn partner(number: u32) -> Option<u32> {
    Some(match number {
        27010 => 300907,
        27011 => 300914,
        27012 => 300915,
        27013 => 300906,
        27020 => 300910,
        27021 => 300909,
        27022 => 300908,
        27023 => 300901,
        27024 => 300900,
        _ => return None,
    })
}

/// Whether the PLC may have this alarm initiated a second time, which is suppressed from level 2 on (S840D-ALARM-702, table 8-2).
pub const fn comes_twice(number: u32) -> bool {
    matches!(number, 27090..=27092 | 27095 | 27250..=27256)
}

/// Whether `follow_on` is hidden while `first` is active, with priorities. `of_inputs`: a 27090 is about `$A_INSE`; that of
/// another variable hides nothing (S840D-ALARM-704, S840D-ALARM-705, S840D-ALARM-706, S840D-ALARM-707).
pub const fn hides(first: u32, of_inputs: bool, follow_on: u32) -> bool {
    let rank = match first {
        27090 if of_inputs => 3,
        27004 => 2,
        27001 | 27101..=27107 => 1,
        _ => 0,
    };
    let hidden_from = match follow_on {
        27023 | 27024 => 1,
        27001 | 27101..=27107 => 2,
        27004 | 27020..=27022 | 27091 => 3,
        _ => return false,
    };
    rank >= hidden_from
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_that_are_acknowledged() {
        assert!(NUMBERS.is_sorted());
        for number in 20000..450_000 {
            let known = NUMBERS.binary_search(&number).is_ok();
            assert_eq!(acknowledgement(number).is_some(), known, "{number}");
        }
    }
}
