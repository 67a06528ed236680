//! Addresses of the PLC: bits and bytes of inputs, outputs, markers and data blocks, and the variables of the SPL in DB18.

use std::fmt;
use std::str::FromStr;

/// Where an address lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Area {
    Input,
    Output,
    Marker,
    Data(u16),
}

/// The variables of the SPL in its data block, each with its first byte and how many there are: S840D-EXAMPLE-722.
pub(crate) const SPL: [(&str, u16, u16); 7] = [
    ("INSEP", 38, 64),
    ("OUTSEP", 46, 64),
    ("INSIP", 54, 64),
    ("OUTSIP", 62, 64),
    ("MARKERSIP", 70, 64),
    ("PLCSIOUT", 128, 32),
    ("PLCSIIN", 132, 32),
];

/// The data block of the SPL.
const SPL_BLOCK: u16 = 18;

/// No CPU has more bytes of an area.
pub(crate) const MOST_BYTES: u16 = 8_191;

/// A bit of the PLC, such as `E 76.0`, `M 211.0`, `DB31.DBX 22.1`, or the SPL's `OUTSIP[3]`, which is `DB18.DBX 62.2`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Bit {
    pub(crate) area: Area,
    pub(crate) byte: u16,
    pub(crate) bit: u8,
}

/// Some bytes that are loaded or written together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Cell {
    pub area: Area,
    pub byte: u16,
    /// 1, 2 or 4.
    pub width: u8,
}

impl Bit {
    /// A variable of the SPL by its name and number, in the data block.
    pub(crate) fn spl(name: &str, number: u16) -> Option<Self> {
        let (_, first, count) = SPL.iter().find(|(known, ..)| *known == name)?;
        let at = number.checked_sub(1).filter(|at| at < count)?;
        Some(Self {
            area: Area::Data(SPL_BLOCK),
            byte: first + at / 8,
            bit: (at % 8) as u8,
        })
    }

    /// Its name and number, if it is a variable of the SPL.
    pub(crate) fn of_spl(self) -> Option<(&'static str, u16)> {
        if self.area != Area::Data(SPL_BLOCK) {
            return None;
        }
        SPL.iter().find_map(|(name, first, count)| {
            let at = self.byte.checked_sub(*first)? * 8 + u16::from(self.bit);
            (at < *count).then_some((*name, at + 1))
        })
    }

    /// A name for tables: `outsip_3`, `m_211_0`, `input_76_0`.
    pub(crate) fn identifier(self) -> String {
        if let Some((name, number)) = self.of_spl() {
            return format!("{}_{number}", name.to_ascii_lowercase());
        }
        let Self { byte, bit, .. } = self;
        match self.area {
            Area::Input => format!("input_{byte}_{bit}"),
            Area::Output => format!("output_{byte}_{bit}"),
            Area::Marker => format!("m_{byte}_{bit}"),
            Area::Data(block) => format!("db{block}_dbx{byte}_{bit}"),
        }
    }

    /// Whether it lies in these bytes.
    pub(crate) fn lies_in(self, cell: Cell) -> bool {
        self.area == cell.area
            && self.byte >= cell.byte
            && self.byte - cell.byte < u16::from(cell.width)
    }
}

impl fmt::Display for Bit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, number)) = self.of_spl() {
            return write!(f, "{name}[{number}]");
        }
        let Self { byte, bit, .. } = self;
        match self.area {
            Area::Input => write!(f, "E{byte}.{bit}"),
            Area::Output => write!(f, "A{byte}.{bit}"),
            Area::Marker => write!(f, "M{byte}.{bit}"),
            Area::Data(block) => write!(f, "DB{block}.DBX{byte}.{bit}"),
        }
    }
}

impl fmt::Debug for Bit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Cell {
    /// A name for tables.
    pub fn identifier(self) -> String {
        let width = match self.width {
            1 => 'b',
            2 => 'w',
            _ => 'd',
        };
        let byte = self.byte;
        match self.area {
            Area::Input => format!("input_{width}{byte}"),
            Area::Output => format!("output_{width}{byte}"),
            Area::Marker => format!("m{width}_{byte}"),
            Area::Data(block) => format!("db{block}_db{width}{byte}"),
        }
    }

    /// Whether two of them share a byte.
    pub fn overlaps(self, other: Self) -> bool {
        let end = |cell: Self| cell.byte + u16::from(cell.width);
        self.area == other.area && self.byte < end(other) && other.byte < end(self)
    }

    /// The largest number in it.
    pub fn most(self) -> i64 {
        (1 << (8 * i64::from(self.width))) - 1
    }

    /// Which byte of a number stands in this byte: the highest comes first.
    pub fn bit_of(self, bit: Bit, number: i64) -> bool {
        let behind = i64::from(self.width) - 1 - i64::from(bit.byte - self.byte);
        number >> (8 * behind + i64::from(bit.bit)) & 1 != 0
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = match self.width {
            1 => 'B',
            2 => 'W',
            _ => 'D',
        };
        let byte = self.byte;
        match self.area {
            Area::Input => write!(f, "E{width}{byte}"),
            Area::Output => write!(f, "A{width}{byte}"),
            Area::Marker => write!(f, "M{width}{byte}"),
            Area::Data(block) => write!(f, "DB{block}.DB{width}{byte}"),
        }
    }
}

/// The letter of an area, German or English.
pub(crate) fn area(letter: &str) -> Option<Area> {
    match letter {
        "E" | "I" => Some(Area::Input),
        "A" | "Q" => Some(Area::Output),
        "M" => Some(Area::Marker),
        _ => None,
    }
}

impl FromStr for Bit {
    type Err = String;

    /// Of the forms `M211.0`, `E 76.0`, `DB31.DBX 22.1`, `OUTSIP[3]`; `OUTSI[3]` is the image that the PLC has of it.
    ///
    /// # Errors
    /// What is wrong with the address, and what may stand there.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is no bit of the PLC; write M211.0, E76.0, A48.2, DB31.DBX22.1 or OUTSIP[3]"
            )
        };
        let clean: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let upper = clean.to_ascii_uppercase();
        if let Some((name, rest)) = upper.split_once('[') {
            let name = name.trim_start_matches('$').trim_start_matches("A_");
            let number = rest.strip_suffix(']').and_then(|n| n.parse().ok());
            let number: u16 = number.ok_or_else(wrong)?;
            let image = format!("{name}P");
            return Bit::spl(name, number)
                .or_else(|| Bit::spl(&image, number))
                .ok_or_else(|| {
                    let names: Vec<&str> = SPL.iter().map(|(name, ..)| *name).collect();
                    format!(
                        "there is no `{text}`; the variables are {}, numbers from 1 to 64 (PLCSIOUT and PLCSIIN to 32)",
                        names.join(", ")
                    )
                });
        }
        let (area, rest) = match upper.strip_prefix("DB") {
            Some(rest) => {
                let (block, rest) = rest.split_once(".DBX").ok_or_else(wrong)?;
                (Area::Data(block.parse().map_err(|_| wrong())?), rest)
            }
            None => {
                let letter = upper.get(..1).and_then(area).ok_or_else(wrong)?;
                (letter, upper.get(1..).unwrap_or_default())
            }
        };
        let (byte, bit) = rest.split_once('.').ok_or_else(wrong)?;
        let byte: u16 = byte.parse().map_err(|_| wrong())?;
        let bit: u8 = bit.parse().map_err(|_| wrong())?;
        match byte <= MOST_BYTES && bit < 8 {
            true => Ok(Self { area, byte, bit }),
            false => Err(wrong()),
        }
    }
}
