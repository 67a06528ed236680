//! How the functions of a drive are controlled: p9601, PROFIsafe telegram and address.

use crate::kernel::ConfigError;

/// The control path of a drive, from p9601 (S120-CTRL-502).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlPath {
    /// p9601.
    code: u8,
}

impl ControlPath {
    /// All admissible values of p9601.
    pub const CODES: [u8; 12] = [
        0x00, 0x01, 0x04, 0x05, 0x08, 0x09, 0x0c, 0x0d, 0x24, 0x25, 0x40, 0x41,
    ];

    /// The path with this p9601 (S120-CTRL-500, S120-CTRL-502).
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] for a value that is not admissible.
    pub const fn new(code: u32) -> Result<Self, ConfigError> {
        match code {
            0x00 | 0x01 | 0x04 | 0x05 | 0x08 | 0x09 | 0x0c | 0x0d | 0x24 | 0x25 | 0x40 | 0x41 => {
                Ok(Self { code: code as u8 })
            }
            _ => Err(ConfigError::ValueOutOfRange),
        }
    }

    /// Basic Functions over the terminals of Control Unit and Motor Module: EP is evaluated (S120-CTRL-505, S120-CTRL-506).
    pub const fn terminals(self) -> bool {
        self.code & 0x01 != 0
    }

    /// Extended Functions are enabled.
    pub const fn extended(self) -> bool {
        self.code & 0x04 != 0
    }

    /// Control over PROFIsafe.
    pub const fn profisafe(self) -> bool {
        self.code & 0x08 != 0
    }

    /// Motion monitoring without selection: SLS and SDI only (S120-CTRL-518).
    pub const fn without_selection(self) -> bool {
        self.code & 0x20 != 0
    }

    /// Control over the F-DI of a TM54F: Basic Functions by bit 6, Extended ones where neither PROFIsafe nor no selection is set. Of
    /// a CU310-2 these are its own F-DI.
    pub const fn inputs(self) -> bool {
        self.code & 0x40 != 0 || (self.extended() && !self.profisafe() && !self.without_selection())
    }

    /// Whether STO can be selected from outside.
    pub const fn selects_sto(self) -> bool {
        !matches!(self.code, 0x00 | 0x24)
    }

    /// Whether both drives can be on the same Control Unit: PROFIsafe and TM54F exclude each other (S120-CTRL-501).
    pub const fn shares_unit_with(self, other: Self) -> bool {
        !((self.profisafe() && other.inputs()) || (self.inputs() && other.profisafe()))
    }
}

/// Where the selection of one function comes from, with control over F-DI (S120-CTRL-519).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Statically inactive: never selected.
    Inactive,
    /// Statically selected.
    Selected,
    /// The F-DI of this number, 0 to 9.
    Input(u8),
}

impl Source {
    /// Whether the function is selected. `values`: those of the F-DI, by bit; 0 selects, and so does an F-DI that does not exist
    /// (S120-CTRL-519).
    pub const fn selects(self, values: u16) -> bool {
        match self {
            Self::Inactive => false,
            Self::Selected => true,
            Self::Input(number) => number > 9 || (values >> number) & 1 == 0,
        }
    }
}

/// What motion monitoring without selection selects for ever: SLS, SDI positive, SDI negative (S120-CTRL-518). `functions`: p9512;
/// `enabled`: p9501, of which bit 0 is needed for all and bit 17 for SDI.
pub const fn without_selection(functions: u32, enabled: u32) -> (bool, bool, bool) {
    let any = enabled & 1 != 0;
    let direction = any && enabled & (1 << 17) != 0;
    (
        any && functions & (1 << 4) != 0,
        direction && functions & (1 << 12) != 0,
        direction && functions & (1 << 13) != 0,
    )
}

/// Whether telegram p60022 and its safe copy p9611 are the same: equal, or 0 and 998, which is telegram 30 (S120-PSAFE-503).
pub const fn same_telegram(selected: u32, copy: u32) -> bool {
    (selected == copy && matches!(selected, 30 | 31 | 901 | 902)) || (selected == 0 && copy == 998)
}

/// The PROFIsafe address F_Dest_Add of p9610 and p9810 (S120-PSAFE-504).
///
/// # Errors
/// [`ConfigError::ValueOutOfRange`] when the channels differ, or outside 1 to 65534.
pub const fn address(channel_1: u32, channel_2: u32) -> Result<u16, ConfigError> {
    if channel_1 == channel_2 && 1 <= channel_1 && channel_1 <= 65_534 {
        Ok(channel_1 as u16)
    } else {
        Err(ConfigError::ValueOutOfRange)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-CTRL-500, S120-CTRL-501, S120-CTRL-502: the printed values and no others.
    #[test]
    fn the_printed_values_of_p9601() {
        for code in 0..=0x1ff {
            let path = ControlPath::new(code);
            let listed = ControlPath::CODES.iter().any(|c| u32::from(*c) == code);
            assert_eq!(path.is_ok(), listed, "{code:#x}");
        }
        let path = |code| ControlPath::new(code).expect("printed");
        assert!(path(0x0d).terminals() && path(0x0d).profisafe() && path(0x0d).extended());
        assert!(path(0x41).inputs() && !path(0x41).extended() && path(0x05).inputs());
        assert!(
            path(0x24).without_selection() && !path(0x24).inputs() && !path(0x24).selects_sto()
        );
        assert!(
            !path(0x0c).shares_unit_with(path(0x04)) && path(0x0c).shares_unit_with(path(0x01))
        );
    }

    /// S120-CTRL-519, S120-FDI-504: two frozen level inputs select level 00, SLS1; one input may serve several functions.
    #[test]
    fn sources_of_the_selection() {
        let input = Source::Input(3);
        assert!(input.selects(0) && !input.selects(1 << 3) && Source::Input(10).selects(u16::MAX));
        assert!(Source::Selected.selects(u16::MAX) && !Source::Inactive.selects(0));
    }

    /// S120-CTRL-518.
    #[test]
    fn functions_without_selection() {
        let all = 1 << 4 | 1 << 12 | 1 << 13;
        assert_eq!(without_selection(all, 1 | 1 << 17), (true, true, true));
        assert_eq!(without_selection(all, 1), (true, false, false));
        assert_eq!(without_selection(all, 1 << 17), (false, false, false));
        assert_eq!(
            without_selection(1 << 12, 1 | 1 << 17),
            (false, true, false)
        );
    }

    /// S120-PSAFE-503, S120-PSAFE-504.
    #[test]
    fn telegram_and_address_are_the_same_in_both_places() {
        assert!(same_telegram(31, 31) && same_telegram(0, 998));
        assert!(!same_telegram(31, 30) && !same_telegram(32, 32) && !same_telegram(30, 998));
        assert_eq!(address(200, 200), Ok(200));
        assert_eq!(
            (address(0, 0).is_err(), address(65_535, 65_535).is_err()),
            (true, true)
        );
        assert!(address(1, 2).is_err());
    }
}
