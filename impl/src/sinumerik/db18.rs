//! The interface of the safe logic in the PLC, data block DB18, and who may write the variables of the logic.
//!
//! The data are five rows of 64 variables, one after the other; the differences that the comparison found lie behind them in the same
//! order. A byte of the external variables is supplied by the basic program from the inputs of the PLC, by F modules, or by the
//! user's program ([`Supply`]).

/// A row of 64 variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// External inputs INSEP.
    Insep,
    /// External outputs OUTSEP.
    Outsep,
    /// Internal inputs INSIP.
    Insip,
    /// Internal outputs OUTSIP.
    Outsip,
    /// Markers MARKERSIP.
    Markersip,
}

/// The signals: five rows of 64 (S840D-SPLIO-009).
pub const SIGNALS: u16 = 320;

/// The first byte of SPL_DATA (S840D-SPLIO-009).
const DATA: u8 = 38;

/// The first byte of SPL_DELTA (S840D-SPLIO-009).
const DELTA: u8 = 78;

/// A bit of the data block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bit {
    /// The byte.
    pub byte: u8,
    /// The bit in it, 0 to 7.
    pub bit: u8,
}

/// The number of variable 1 to 64 of a row: 1 to 320, as STATSI tells it; none beyond (S840D-SPLIO-009).
pub const fn signal(row: Row, variable: u8) -> Option<u16> {
    if variable == 0 || variable > 64 {
        return None;
    }
    Some(64 * row as u16 + variable as u16)
}

/// The supplement of alarm 27090, which selects its extended text: 0 where NCK and PLC are set differently, else the number of the
/// variable that differs; none beyond the variables (S840D-DIAG-704). That of 27254 is
/// [`net_data::supplement`](super::net_data::supplement).
pub const fn supplement(differs: Option<(Row, u8)>) -> Option<u16> {
    match differs {
        None => Some(0),
        Some((row, variable)) => signal(row, variable),
    }
}

/// Where signal 1 to 320 lies behind a byte.
const fn behind(first: u8, signal: u16) -> Option<Bit> {
    if signal == 0 || signal > SIGNALS {
        return None;
    }
    let place = signal - 1;
    Some(Bit {
        byte: first + (place / 8) as u8,
        bit: (place % 8) as u8,
    })
}

/// Where a signal lies in SPL_DATA, bytes 38 to 77 (S840D-SPLIO-009).
pub const fn data(signal: u16) -> Option<Bit> {
    behind(DATA, signal)
}

/// Where the difference of a signal lies in SPL_DELTA, bytes 78 to 117 (S840D-SPLIO-009).
pub const fn delta(signal: u16) -> Option<Bit> {
    behind(DELTA, signal)
}

/// What the user's program may do with a part of the data block (S840D-SPLIO-010).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rights {
    /// Read it.
    Read,
    /// Read and write it.
    ReadWrite,
}

/// A part of the data block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// As the signals of the specification call it.
    pub id: &'static str,
    /// Where it begins.
    pub first: Bit,
    /// How many bits it has.
    pub bits: u16,
    /// What the user's program may do with it.
    pub rights: Rights,
}

macro_rules! parts {
    ($($id:literal $byte:literal . $bit:literal, $bits:literal $rights:ident;)+) => {
        /// The data block by its parts; words with several elements are given by their first one (S840D-SPLIO-009, S840D-SPLIO-010).
        pub const PARTS: &[Part] = &[$(Part {
            id: $id,
            first: Bit { byte: $byte, bit: $bit },
            bits: $bits,
            rights: Rights::$rights,
        }),+];
    };
}

parts! {
    "DB18_INSEP_VALID" 0 . 0, 8 ReadWrite;
    "DB18_OUTSEP_VALID" 2 . 0, 8 ReadWrite;
    "DB18_INSEP_ADDR_1" 4 . 0, 128 ReadWrite;
    "DB18_OUTSEP_ADDR_1" 20 . 0, 128 ReadWrite;
    "DB18_SPL_READY" 36 . 0, 1 ReadWrite;
    "DB18_STOP_E" 36 . 1, 1 ReadWrite;
    "DB18_INSEP" 38 . 0, 64 Read;
    "DB18_OUTSEP" 46 . 0, 64 ReadWrite;
    "DB18_INSIP" 54 . 0, 64 Read;
    "DB18_OUTSIP" 62 . 0, 64 ReadWrite;
    "DB18_MARKERSIP" 70 . 0, 64 ReadWrite;
    "DB18_DELTA_INSEP" 78 . 0, 64 Read;
    "DB18_DELTA_OUTSEP" 86 . 0, 64 Read;
    "DB18_DELTA_INSIP" 94 . 0, 64 Read;
    "DB18_DELTA_OUTSIP" 102 . 0, 64 Read;
    "DB18_DELTA_MARKERSIP" 110 . 0, 64 Read;
    "DB18_CMDSI" 118 . 0, 1 ReadWrite;
    "DB18_COMM_TIMEOUT" 119 . 5, 1 Read;
    "DB18_STATSI" 120 . 0, 32 Read;
    "DB18_LEVELSI" 124 . 0, 32 Read;
    "DB18_PLCSIOUT" 128 . 0, 32 Read;
    "DB18_PLCSIIN" 132 . 0, 32 ReadWrite;
    "DB18_SPL_STATUS_1" 136 . 0, 16 Read;
    "DB18_INSEP_PROFISAFE" 138 . 0, 8 Read;
    "DB18_OUTSEP_PROFISAFE" 140 . 0, 8 Read;
}

/// Who supplies a byte of INSEP, or takes one of OUTSEP (S840D-SPLIO-007, S840D-PSAFE-008).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Supply {
    /// The user's program: neither valid bit nor F module.
    User,
    /// The basic program, from or to the byte of the PLC's image with this address.
    Image(u16),
    /// The basic program, from or to F modules.
    Profisafe,
}

impl Supply {
    /// From the valid bit, the address and the mark of a byte. An F module comes first: its bytes are transferred by the system and
    /// cannot be connected by the user (S840D-SPLIO-007, S840D-PSAFE-008, S840D-PSAFE-045).
    pub const fn of(valid: bool, address: u16, profisafe: bool) -> Self {
        match (profisafe, valid) {
            (true, _) => Self::Profisafe,
            (false, true) => Self::Image(address),
            (false, false) => Self::User,
        }
    }

    /// A byte of INSEP after the transfer, which was `own`: `net` is what the F modules say. A byte that the image does not have is 0, the
    /// safe level (S840D-SPLIO-007).
    pub fn input(self, own: u8, image: &[u8], net: u8) -> u8 {
        match self {
            Self::User => own,
            Self::Image(address) => image.get(usize::from(address)).copied().unwrap_or(0),
            Self::Profisafe => net,
        }
    }

    /// Writes a byte of OUTSEP to the image; nothing where it is not the image's (S840D-SPLIO-007).
    pub fn output(self, own: u8, image: &mut [u8]) {
        if let Self::Image(address) = self {
            if let Some(byte) = image.get_mut(usize::from(address)) {
                *byte = own;
            }
        }
    }
}

/// A kind of variable of the NCK's logic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// `$A_INSE`, `$A_INSI` and their words.
    Input,
    /// `$A_OUTSE`, `$A_OUTSI`, `$A_MARKERSI`, their words, and `$A_TIMERSI`.
    Output,
    /// `$A_PLCSIOUT`: from the NCK to the PLC.
    ToPlc,
    /// `$A_PLCSIIN`: from the PLC to the NCK.
    FromPlc,
}

impl Variable {
    /// Whether SAFE.SPF may write it; inputs are read only (S840D-SPLIO-004, S840D-SPLIO-008).
    pub const fn logic_writes(self) -> bool {
        matches!(self, Self::Output | Self::ToPlc)
    }

    /// Whether other programs may read it: not what goes directly between NCK and PLC (S840D-SPLIO-004, S840D-SPLIO-008).
    pub const fn others_read(self) -> bool {
        matches!(self, Self::Input | Self::Output)
    }

    /// Whether NCK and PLC compare it; single-channel signals are not compared (S840D-SPLIO-008).
    pub const fn is_compared(self) -> bool {
        self.others_read()
    }
}

/// The external variables of each direction that the option SI-Basic has (S840D-SPLIO-005); SI-Comfort has all 64.
pub const BASIC_VARIABLES: u8 = 4;

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-SPLIO-009: every signal has a bit of its own, in order, and its difference forty bytes behind it.
    #[test]
    fn signals_lie_one_after_the_other() {
        let rows = [
            (Row::Insep, 38),
            (Row::Outsep, 46),
            (Row::Insip, 54),
            (Row::Outsip, 62),
            (Row::Markersip, 70),
        ];
        let mut before = 0;
        for (row, first) in rows {
            for variable in 1..=64 {
                let number = signal(row, variable).expect("it exists");
                assert_eq!(number, before + 1);
                before = number;
                let place = data(number).expect("it lies somewhere");
                let (byte, bit) = (first + (variable - 1) / 8, (variable - 1) % 8);
                assert_eq!((place.byte, place.bit), (byte, bit));
                let delta = delta(number).expect("it lies somewhere");
                assert_eq!((delta.byte, delta.bit), (byte + 40, bit));
            }
            assert_eq!((signal(row, 0), signal(row, 65)), (None, None));
        }
        assert_eq!((data(0), data(321), delta(321)), (None, None, None));
    }

    /// S840D-SPLIO-007, S840D-PSAFE-008.
    #[test]
    fn each_byte_has_one_supplier() {
        let mut image = [0, 0x11, 0x22, 0x33];
        let supply = Supply::of(true, 2, false);
        assert_eq!(supply.input(0x77, &image, 0x55), 0x22);
        assert_eq!(Supply::of(false, 2, false).input(0x77, &image, 0x55), 0x77);
        assert_eq!(Supply::of(true, 2, true).input(0x77, &image, 0x55), 0x55);
        assert_eq!(Supply::of(true, 9, false).input(0x77, &image, 0x55), 0);
        Supply::of(false, 1, false).output(0x77, &mut image);
        Supply::of(true, 1, true).output(0x77, &mut image);
        Supply::of(true, 9, false).output(0x77, &mut image);
        assert_eq!(image, [0, 0x11, 0x22, 0x33]);
        supply.output(0x77, &mut image);
        assert_eq!(image, [0, 0x11, 0x77, 0x33]);
    }

    /// S840D-SPLIO-004, S840D-SPLIO-008.
    #[test]
    fn inputs_are_read_only() {
        assert!(!Variable::Input.logic_writes() && Variable::Input.others_read());
        assert!(Variable::Output.logic_writes() && Variable::Output.is_compared());
        assert!(Variable::ToPlc.logic_writes() && !Variable::ToPlc.others_read());
        assert!(!Variable::FromPlc.logic_writes() && !Variable::FromPlc.is_compared());
    }
}
