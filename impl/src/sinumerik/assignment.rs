//! Where a signal of an axis, or a byte of the external variables, comes from or goes to: the hexadecimal coding i s mm xx nn of
//! MD36970 to MD36990, MD10390 and MD10392.
//!
//! An entry that is none of those below is refused (alarm 27033 at run-up). The manual names drives up to 1FH, its highest entry is
//! 811E0810H: the smaller limit is taken.

/// Which way a signal goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// An SGE: it is read.
    In,
    /// An SGA: it is written.
    Out,
}

/// The place of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// None: the input has a fixed level, 0 or with inversion 1.
    None,
    /// A terminal on the drive bus: slot 1 to 30, sub-module 1 to 8, bit 1 to 16 (S840D-SPLIO-012).
    Terminal {
        /// The logical slot.
        slot: u8,
        /// The sub-module in it.
        module: u8,
        /// The bit.
        bit: u8,
    },
    /// A local signal of the NCU, 1 to 4 (S840D-SPLIO-011).
    Local(u8),
    /// A variable of the safe logic: `$A_OUTSI` for an SGE, `$A_INSI` for an SGA, 1 to 64 (S840D-SPLIO-012).
    Internal(u8),
    /// `$A_INSE`, 1 to 64: for an SGE only (S840D-SPLIO-012).
    External(u8),
}

/// The assignment of a signal of an axis (S840D-SPLIO-012).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// i = 8: the signal is inverted.
    pub inverted: bool,
    /// Where it is.
    pub place: Place,
}

/// No coding: alarm 27033.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoCoding;

impl core::fmt::Display for NoCoding {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the machine datum is no coding i s mm xx nn of a signal")
    }
}

impl core::error::Error for NoCoding {}

/// i, s, mm, xx, nn.
const fn fields(datum: u32) -> [u8; 5] {
    [
        (datum >> 28) as u8,
        (datum >> 24 & 0xF) as u8,
        (datum >> 16) as u8,
        (datum >> 8) as u8,
        datum as u8,
    ]
}

/// xx and nn of a variable.
const fn word(variable: u8) -> u32 {
    let place = variable.saturating_sub(1) as u32;
    (place / 32 + 1) << 8 | (place % 32 + 1)
}

impl Assignment {
    /// What a machine datum of an axis says (S840D-SPLIO-011, S840D-SPLIO-012).
    ///
    /// # Errors
    /// [`NoCoding`].
    pub const fn decode(datum: u32, way: Way) -> Result<Self, NoCoding> {
        let (inverted, place) = match fields(datum) {
            [i @ (0 | 8), 0, 0, 0, 0] => (i, Place::None),
            [i @ (0 | 8), 0, 0, 0, nn @ 1..=4] => (i, Place::Local(nn)),
            [
                i @ (0 | 8),
                1,
                slot @ 1..=0x1E,
                module @ 1..=8,
                bit @ 1..=0x10,
            ] => (i, Place::Terminal { slot, module, bit }),
            [i @ (0 | 8), 4, 1, xx @ (1 | 2), nn @ 1..=0x20] => {
                (i, Place::Internal(32 * (xx - 1) + nn))
            }
            [i @ (0 | 8), 4, 2, xx @ (1 | 2), nn @ 1..=0x20] if matches!(way, Way::In) => {
                (i, Place::External(32 * (xx - 1) + nn))
            }
            _ => return Err(NoCoding),
        };
        Ok(Self {
            inverted: inverted == 8,
            place,
        })
    }

    /// The machine datum of an assignment whose numbers are in their ranges.
    pub const fn encode(self) -> u32 {
        let rest = match self.place {
            Place::None => 0,
            Place::Local(signal) => signal as u32,
            Place::Terminal { slot, module, bit } => {
                0x0100_0000 | (slot as u32) << 16 | (module as u32) << 8 | bit as u32
            }
            Place::Internal(variable) => 0x0401_0000 | word(variable),
            Place::External(variable) => 0x0402_0000 | word(variable),
        };
        rest | (self.inverted as u32) << 31
    }
}

/// The assignment of eight external variables: MD10390 and MD10392 (S840D-SPLIO-001, S840D-SPLIO-002).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Byte {
    /// None.
    None,
    /// A byte of a terminal block: slot 1 to 30, sub-module 1 to 8, byte 1 or 2.
    Terminal {
        /// The logical slot.
        slot: u8,
        /// The sub-module in it.
        module: u8,
        /// The byte.
        byte: u8,
    },
    /// Those of the four local signals of the NCU whose bit is set, 1 to FH.
    Local(u8),
}

impl Byte {
    /// What a machine datum says.
    ///
    /// # Errors
    /// [`NoCoding`] (S840D-SPLIO-001, S840D-SPLIO-002).
    pub const fn decode(datum: u32) -> Result<Self, NoCoding> {
        match fields(datum) {
            [0, 0, 0, 0, 0] => Ok(Self::None),
            [0, 0, 0, 0, mask @ 1..=0xF] => Ok(Self::Local(mask)),
            [0, 1, slot @ 1..=0x1E, module @ 1..=8, byte @ (1 | 2)] => {
                Ok(Self::Terminal { slot, module, byte })
            }
            _ => Err(NoCoding),
        }
    }

    /// The variables of byte `index`, 0 to 7, variable n as bit n - 1: all eight of a terminal, of the local signals those of the mask,
    /// signal k as variable k of the byte (S840D-SPLIO-001, S840D-SPLIO-002).
    pub const fn variables(self, index: u8) -> u64 {
        let bits = match self {
            Self::None => 0,
            Self::Terminal { .. } => 0xFF,
            Self::Local(mask) => (mask & 0xF) as u64,
        };
        bits << (8 * (index & 7))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-SPLIO-012: what is decoded is encoded again to the same datum, and nothing else is decoded.
    #[test]
    fn codings_read_back() {
        let mut known = 0;
        for i in 0..16_u32 {
            for s in [0, 1, 2, 4, 5] {
                for mm in [0, 1, 2, 3, 0x1E, 0x1F] {
                    for xx in [0, 1, 2, 3, 8, 9] {
                        for nn in [0, 1, 4, 5, 0x10, 0x11, 0x20, 0x21] {
                            let datum = i << 28 | s << 24 | mm << 16 | xx << 8 | nn;
                            for way in [Way::In, Way::Out] {
                                if let Ok(found) = Assignment::decode(datum, way) {
                                    assert_eq!(found.encode(), datum);
                                    known += 1;
                                }
                            }
                        }
                    }
                }
            }
        }
        // None, two local ones; 4 slots, 4 sub-modules, 4 bits; two words with 6 bits: internal both ways, external one.
        let one = 2 * 3 + 2 * 4 * 4 * 4 + 3 * 2 * 6;
        assert_eq!(known, 2 * one);
    }

    /// S840D-SPLIO-011, S840D-SPLIO-012: the ends of the ranges.
    #[test]
    fn ends_of_the_ranges() {
        let place = |datum, way| Assignment::decode(datum, way).map(|a| (a.inverted, a.place));
        let last = Place::Terminal {
            slot: 30,
            module: 8,
            bit: 16,
        };
        assert_eq!(place(0x811E_0810, Way::In), Ok((true, last)));
        assert_eq!(place(0x011F_0810, Way::In), Err(NoCoding));
        assert_eq!(place(0x8402_0220, Way::In), Ok((true, Place::External(64))));
        assert_eq!(place(0x8402_0220, Way::Out), Err(NoCoding));
        assert_eq!(
            place(0x8401_0220, Way::Out),
            Ok((true, Place::Internal(64)))
        );
        assert_eq!(place(0x0401_0101, Way::In), Ok((false, Place::Internal(1))));
        assert_eq!(place(0x8000_0000, Way::In), Ok((true, Place::None)));
        assert_eq!(place(4, Way::Out), Ok((false, Place::Local(4))));
        assert_eq!(place(5, Way::Out), Err(NoCoding));
        assert_eq!(place(0x4000_0000, Way::In), Err(NoCoding));
    }

    /// S840D-SPLIO-001, S840D-SPLIO-002.
    #[test]
    fn bytes_of_variables() {
        assert_eq!(Byte::decode(0).map(|b| b.variables(3)), Ok(0));
        let last = Byte::decode(0x011E_0802).expect("the highest entry");
        assert_eq!(last.variables(7), 0xFF << 56);
        let local = Byte::decode(5).expect("signals 1 and 3");
        assert_eq!((local, local.variables(1)), (Byte::Local(5), 0b101 << 8));
        for datum in [0x10, 0x8000_0001, 0x0101_0103, 0x0401_0101, 0x0101_0001] {
            assert_eq!(Byte::decode(datum), Err(NoCoding), "{datum:X}");
        }
    }
}
