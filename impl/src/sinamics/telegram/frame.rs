//! Whole telegrams as bytes, without the trailer of the PROFIsafe protocol.
//!
//! The bytes of S_STW and S_ZSW come in the order of their numbers. Numbers, and the words of the Safety Info and Control Channel, are
//! words of PROFIdrive, the higher byte first; the manual does not print either order.

use super::channel::{InfoWord1, InfoWord2, InfoWord3, RequestWord1, RequestWord3};
use super::control::{ControlWord1, ControlWord2};
use super::status::{StatusWord1, StatusWord2};
use super::values::{LARGEST_XIST16, LARGEST_XIST32};

/// The bytes of the longest telegram.
pub const LONGEST: usize = 12;

fields! {
    /// The number of a telegram (S120-PSAFE-500, S120-SIC-500, S120-SIC-501).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Telegram {
        /// S_STW1 and S_ZSW1.
        T30 = 30,
        /// S_STW2 and S_ZSW2.
        T31 = 31,
        /// Safety Info Channel.
        T700 = 700,
        /// Safety Info and Control Channel.
        T701 = 701,
        /// With SLS limit and a position of 16 bits.
        T901 = 901,
        /// With SLS limit and a position of 32 bits.
        T902 = 902,
    }
}

/// Why bytes are no telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// Another number of bytes was expected.
    Length {
        /// The bytes of the telegram.
        expected: usize,
        /// Those that came.
        found: usize,
    },
    /// The position is outside its range (S120-SP-004, S120-SP-005).
    Position(i32),
}

impl core::fmt::Display for FrameError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Length { expected, found } => {
                write!(f, "the telegram has {expected} bytes, not {found}")
            }
            Self::Position(position) => write!(f, "the position {position} is outside its range"),
        }
    }
}

impl core::error::Error for FrameError {}

/// Bytes of a telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Frame {
    const fn empty() -> Self {
        Self {
            bytes: [0; LONGEST],
            length: 0,
        }
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&self.bytes)
    }

    /// With these bytes at the end; what is longer than a telegram is left out.
    fn with<const N: usize>(mut self, more: [u8; N]) -> Self {
        for byte in more {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
                self.length += 1;
            }
        }
        self
    }
}

/// Reads one part after the other.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    /// The next bytes; zeros behind the end, which the check of the length excludes.
    fn take<const N: usize>(&mut self) -> [u8; N] {
        match self.0.split_first_chunk::<N>() {
            Some((bytes, rest)) => {
                self.0 = rest;
                *bytes
            }
            None => [0; N],
        }
    }
}

/// What the drive receives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Received {
    /// Telegram 30.
    T30(ControlWord1),
    /// Telegram 31.
    T31(ControlWord2),
    /// Telegrams 901 and 902, which are the same in this direction: S_STW2 and S_SLS_LIMIT_A, of which
    /// [`super::values::sls_limit`] tells what it asks for.
    Limited(ControlWord2, u16),
    /// Telegram 700: nothing.
    Nothing,
    /// Telegram 701.
    T701(RequestWord1, RequestWord3),
}

impl Received {
    /// The number of bytes of a telegram in this direction (S120-PSAFE-501, S120-SIC-500, S120-SIC-501).
    pub const fn length(telegram: Telegram) -> usize {
        match telegram {
            Telegram::T30 => 2,
            Telegram::T31 => 4,
            Telegram::T901 | Telegram::T902 => 6,
            Telegram::T700 => 0,
            Telegram::T701 => 4,
        }
    }

    /// The bytes (S120-PSAFE-501, S120-SIC-501).
    pub fn encode(&self) -> Frame {
        let frame = Frame::empty();
        match self {
            Self::T30(word) => frame.with(word.encode().to_le_bytes()),
            Self::T31(word) => frame.with(word.encode().to_le_bytes()),
            Self::Limited(word, limit) => frame
                .with(word.encode().to_le_bytes())
                .with(limit.to_be_bytes()),
            Self::Nothing => frame,
            Self::T701(word1, word3) => frame
                .with(word1.encode().to_be_bytes())
                .with(word3.encode().to_be_bytes()),
        }
    }

    /// What the bytes say (S120-PSAFE-501, S120-SIC-501).
    ///
    /// # Errors
    /// [`FrameError::Length`] for another number of bytes.
    pub fn decode(telegram: Telegram, bytes: &[u8]) -> Result<Self, FrameError> {
        let mut reader = checked(Self::length(telegram), bytes)?;
        Ok(match telegram {
            Telegram::T30 => Self::T30(ControlWord1::decode(u16::from_le_bytes(reader.take()))),
            Telegram::T31 => Self::T31(ControlWord2::decode(u32::from_le_bytes(reader.take()))),
            Telegram::T901 | Telegram::T902 => {
                let word = ControlWord2::decode(u32::from_le_bytes(reader.take()));
                Self::Limited(word, u16::from_be_bytes(reader.take()))
            }
            Telegram::T700 => Self::Nothing,
            Telegram::T701 => {
                let word1 = RequestWord1::decode(u16::from_be_bytes(reader.take()));
                let word3 = RequestWord3::decode(u16::from_be_bytes(reader.take()));
                Self::T701(word1, word3)
            }
        })
    }
}

/// What telegrams 901 and 902 tell besides the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Positioned {
    /// S_ZSW2.
    pub word: StatusWord2,
    /// S_SLS_LIMIT_A_ACTIVE: of no meaning unless SLS level 1 is active and set by telegram (S120-PSAFE-517).
    pub limit: u16,
    /// S_CYCLE_COUNT.
    pub cycle: i16,
}

/// What the drive sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sent {
    /// Telegram 30.
    T30(StatusWord1),
    /// Telegram 31.
    T31(StatusWord2),
    /// Telegram 901, with S_XIST16.
    T901(Positioned, i16),
    /// Telegram 902, with S_XIST32.
    T902(Positioned, i32),
    /// Telegram 700, with S_V_LIMIT_B.
    T700(InfoWord1, i32),
    /// Telegram 701, with S_V_LIMIT_B.
    T701(InfoWord1, InfoWord2, i32, InfoWord3),
}

impl Sent {
    /// The number of bytes of a telegram in this direction (S120-PSAFE-501, S120-SIC-500, S120-SIC-501).
    pub const fn length(telegram: Telegram) -> usize {
        match telegram {
            Telegram::T30 => 2,
            Telegram::T31 => 4,
            Telegram::T901 => 10,
            Telegram::T902 => 12,
            Telegram::T700 => 6,
            Telegram::T701 => 10,
        }
    }

    /// The bytes (S120-PSAFE-501, S120-SIC-500, S120-SIC-501).
    pub fn encode(&self) -> Frame {
        let frame = Frame::empty();
        let positioned = |told: &Positioned| {
            frame
                .with(told.word.encode().to_le_bytes())
                .with(told.limit.to_be_bytes())
                .with(told.cycle.to_be_bytes())
        };
        match self {
            Self::T30(word) => frame.with(word.encode().to_le_bytes()),
            Self::T31(word) => frame.with(word.encode().to_le_bytes()),
            Self::T901(told, position) => positioned(told).with(position.to_be_bytes()),
            Self::T902(told, position) => positioned(told).with(position.to_be_bytes()),
            Self::T700(word, limit) => frame
                .with(word.encode().to_be_bytes())
                .with(limit.to_be_bytes()),
            Self::T701(word1, word2, limit, word3) => frame
                .with(word1.encode().to_be_bytes())
                .with(word2.encode().to_be_bytes())
                .with(limit.to_be_bytes())
                .with(word3.encode().to_be_bytes()),
        }
    }

    /// What the bytes say (S120-PSAFE-501, S120-SIC-500, S120-SIC-501).
    ///
    /// # Errors
    /// [`FrameError::Length`] for another number of bytes, [`FrameError::Position`] for a position that no drive sends.
    pub fn decode(telegram: Telegram, bytes: &[u8]) -> Result<Self, FrameError> {
        let mut reader = checked(Self::length(telegram), bytes)?;
        Ok(match telegram {
            Telegram::T30 => Self::T30(StatusWord1::decode(u16::from_le_bytes(reader.take()))),
            Telegram::T31 => Self::T31(StatusWord2::decode(u32::from_le_bytes(reader.take()))),
            Telegram::T901 => {
                let told = positioned(&mut reader);
                let position = i16::from_be_bytes(reader.take());
                if position.unsigned_abs() > LARGEST_XIST16.unsigned_abs() {
                    return Err(FrameError::Position(position.into()));
                }
                Self::T901(told, position)
            }
            Telegram::T902 => {
                let told = positioned(&mut reader);
                let position = i32::from_be_bytes(reader.take());
                if position.unsigned_abs() > LARGEST_XIST32.unsigned_abs() {
                    return Err(FrameError::Position(position));
                }
                Self::T902(told, position)
            }
            Telegram::T700 => {
                let word = InfoWord1::decode(u16::from_be_bytes(reader.take()));
                Self::T700(word, i32::from_be_bytes(reader.take()))
            }
            Telegram::T701 => {
                let word1 = InfoWord1::decode(u16::from_be_bytes(reader.take()));
                let word2 = InfoWord2::decode(u16::from_be_bytes(reader.take()));
                let limit = i32::from_be_bytes(reader.take());
                let word3 = InfoWord3::decode(u16::from_be_bytes(reader.take()));
                Self::T701(word1, word2, limit, word3)
            }
        })
    }
}

fn positioned(reader: &mut Reader<'_>) -> Positioned {
    Positioned {
        word: StatusWord2::decode(u32::from_le_bytes(reader.take())),
        limit: u16::from_be_bytes(reader.take()),
        cycle: i16::from_be_bytes(reader.take()),
    }
}

fn checked(expected: usize, bytes: &[u8]) -> Result<Reader<'_>, FrameError> {
    if bytes.len() == expected {
        Ok(Reader(bytes))
    } else {
        Err(FrameError::Length {
            expected,
            found: bytes.len(),
        })
    }
}
