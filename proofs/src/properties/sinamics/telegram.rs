//! Words and frames of the telegrams: encoding and decoding are inverse.

use stillpoint_monitors::sinamics::telegram::channel::{
    InfoWord1, InfoWord2, InfoWord3, RequestWord1, RequestWord3,
};
use stillpoint_monitors::sinamics::telegram::control::{ControlWord1, ControlWord2};
use stillpoint_monitors::sinamics::telegram::diagnosis::{
    BasicSelection, BasicStatus, StatusSignals, StopSignals,
};
use stillpoint_monitors::sinamics::telegram::frame::{
    FrameError, LONGEST, Received, Sent, Telegram,
};
use stillpoint_monitors::sinamics::telegram::status::{StatusWord1, StatusWord2};

use super::Subject;
use crate::source::{Source, Verdict};

/// What one word does with its bits.
struct Coded {
    /// The bits that are not reserved.
    used: u32,
    /// The word, decoded and encoded again.
    again: u32,
    /// What was decoded is the same when it is encoded and decoded.
    same: bool,
}

macro_rules! coded {
    ($word:ident $raw:ident $value:ident) => {{
        let value = $value as $raw;
        let decoded = $word::decode(value);
        let again = decoded.encode();
        Coded {
            used: u32::from($word::USED),
            again: u32::from(again),
            same: $word::decode(again) == decoded,
        }
    }};
}

fn concluded<S: Source>(source: &mut S, value: u32, coded: &Coded) -> Verdict {
    source.cover(0, value & !coded.used != 0);
    source.cover(1, value & !coded.used == 0);
    if coded.again != value & coded.used {
        Verdict::Broken("reserved_bits_are_neither_read_nor_sent")
    } else if !coded.same {
        Verdict::Broken("decoding_inverts_encoding")
    } else {
        Verdict::Held
    }
}

/// Decoding and encoding a word of 16 bits are inverse.
///
/// Cover 0: reserved bits are set, cover 1: none is.
pub fn narrow_word_is_its_bits<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let value = source.any_in(0, u16::MAX.into());
    let coded = match source.any_in(0, 7) {
        0 => coded!(ControlWord1 u16 value),
        1 => coded!(StatusWord1 u16 value),
        2 => coded!(InfoWord1 u16 value),
        3 => coded!(InfoWord2 u16 value),
        4 => coded!(InfoWord3 u16 value),
        5 => coded!(RequestWord1 u16 value),
        6 => coded!(RequestWord3 u16 value),
        _ => coded!(StopSignals u16 value),
    };
    concluded(source, value, &coded)
}

/// Any word of 32 bits; the enumeration takes every value of one half, with few of the other.
fn any_word<S: Source>(source: &mut S) -> u32 {
    const FEW: [u32; 5] = [0, 1, 0x5555, 0xaaaa, 0xffff];
    if source.enumerates() {
        let half = source.any_in(0, 0xffff);
        let other = FEW[source.any_in(0, 4) as usize];
        if source.any_bool() {
            half << 16 | other
        } else {
            other << 16 | half
        }
    } else {
        source.any_in(0, 0xffff) << 16 | source.any_in(0, 0xffff)
    }
}

/// Decoding and encoding a word of 32 bits are inverse.
///
/// Cover 0: reserved bits are set, cover 1: none is.
pub fn wide_word_is_its_bits<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let value = any_word(source);
    let coded = match source.any_in(0, 4) {
        0 => coded!(ControlWord2 u32 value),
        1 => coded!(StatusWord2 u32 value),
        2 => coded!(StatusSignals u32 value),
        3 => coded!(BasicSelection u32 value),
        _ => coded!(BasicStatus u32 value),
    };
    concluded(source, value, &coded)
}

/// Of the words Basic Functions evaluate and send three bits.
///
/// Cover 0: other bits are set, cover 1: the word is 0, which selects STO.
pub fn basic_functions_see_three_bits<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let value = any_word(source);
    let narrow = value as u16;
    let seen = [
        u32::from(ControlWord1::decode(narrow).basic().encode()),
        ControlWord2::decode(value).basic().encode(),
        u32::from(StatusWord1::decode(narrow).basic().encode()),
        StatusWord2::decode(value).basic().encode(),
    ];
    source.cover(0, value & !0x83 != 0);
    source.cover(1, value == 0);
    let word = ControlWord2::decode(value).basic();
    if seen != [value & 0x83; 4] {
        Verdict::Broken("three_bits_are_seen")
    } else if value & 1 == 0 && word.sto {
        Verdict::Broken("zero_selects_sto")
    } else {
        Verdict::Held
    }
}

/// Any bytes; the enumeration takes the same ones throughout with one that differs.
fn any_bytes<S: Source>(source: &mut S) -> ([u8; LONGEST + 1], usize) {
    const FEW: [u8; 5] = [0, 1, 127, 128, 255];
    let length = source.any_in(0, LONGEST as u32 + 1) as usize;
    let mut bytes = [0; LONGEST + 1];
    if source.enumerates() {
        bytes = [FEW[source.any_in(0, 4) as usize]; LONGEST + 1];
        let place = source.any_in(0, LONGEST as u32) as usize;
        bytes[place] = FEW[source.any_in(0, 4) as usize];
    } else {
        for byte in &mut bytes {
            *byte = source.any_in(0, 255) as u8;
        }
    }
    (bytes, length)
}

/// One direction of the telegrams: whether bytes are encoded the same once they were decoded, but for reserved bits. The number of
/// bytes is one that the compiler knows, as is the telegram: a symbolic checker then follows no slice of unknown length.
macro_rules! again {
    ($again:ident $direction:ident) => {
        fn $again<const LENGTH: usize>(
            telegram: Telegram,
            bytes: &[u8; LONGEST + 1],
            length: usize,
        ) -> Result<bool, FrameError> {
            match bytes.first_chunk::<LENGTH>() {
                Some(bytes) if length == LENGTH => {
                    let decoded = $direction::decode(telegram, bytes)?;
                    let frame = decoded.encode();
                    let Some(again) = frame.bytes().first_chunk::<LENGTH>() else {
                        return Ok(false);
                    };
                    Ok(frame.bytes().len() == LENGTH
                        && $direction::decode(telegram, again) == Ok(decoded)
                        && only_less(again, bytes))
                }
                _ => $direction::decode(telegram, bytes.get(..length).unwrap_or_default())
                    .map(|_| false),
            }
        }
    };
}

again! { received_again Received }
again! { sent_again Sent }

/// Every telegram with its own length.
macro_rules! of_each {
    ($direction:ident $again:ident $telegram:ident $bytes:expr, $length:ident: $($number:ident)+) => {
        match $telegram {
            $(Telegram::$number => {
                $again::<{ $direction::length(Telegram::$number) }>(Telegram::$number, $bytes, $length)
            })+
        }
    };
    ($direction:ident $again:ident $telegram:ident $bytes:expr, $length:ident) => {
        of_each!($direction $again $telegram $bytes, $length: T30 T31 T700 T701 T901 T902)
    };
}

/// A telegram in one of the directions.
const FRAMES: u32 = 2 * Telegram::ALL.len() as u32;

/// Every third of the frames is a part of its own.
const PARTS: u32 = 3;

/// Any frame of a part, one after the other, so that a symbolic checker knows in each case which telegram it is.
fn any_frame<S: Source>(
    source: &mut S,
    part: u32,
    bytes: &[u8; LONGEST + 1],
    length: usize,
) -> Case {
    let chosen = source.any_in(0, FRAMES / PARTS - 1) * PARTS + part - 1;
    for frame in 0..FRAMES {
        // The first condition is known to the compiler of a part.
        if frame % PARTS == part - 1 && frame == chosen {
            let telegram = Telegram::ALL[frame as usize / 2];
            return case(telegram, frame % 2 == 1, bytes, length);
        }
    }
    unreachable!("the frame chosen is one of the part");
}

/// Bytes that were read as a telegram.
struct Case {
    telegram: Telegram,
    sent: bool,
    /// Whether they are encoded the same, or why they are none.
    outcome: Result<bool, FrameError>,
}

fn case(telegram: Telegram, sent: bool, bytes: &[u8; LONGEST + 1], length: usize) -> Case {
    let outcome = if sent {
        of_each!(Sent sent_again telegram bytes, length)
    } else {
        of_each!(Received received_again telegram bytes, length)
    };
    Case {
        telegram,
        sent,
        outcome,
    }
}

/// What is encoded is decoded, and bytes that are decoded are encoded the same, but for reserved bits.
///
/// Cover 0: a received telegram, cover 1: a sent one, cover 2: another length, cover 3: a position outside its range.
pub fn frames_are_their_bytes<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let (bytes, length) = any_bytes(source);
    let Case {
        telegram,
        sent,
        outcome,
    } = match source.any_part(PARTS) {
        // Kani shows here only that each cover is met; the parts are the whole.
        0 if source.leaves_out() => {
            if source.any_bool() {
                case(Telegram::T30, false, &bytes, length)
            } else {
                case(Telegram::T901, true, &bytes, length)
            }
        }
        0 => case(source.any_of_all(), source.any_bool(), &bytes, length),
        part => any_frame(source, part, &bytes, length),
    };
    let expected = if sent {
        Sent::length(telegram)
    } else {
        Received::length(telegram)
    };
    source.cover(0, !sent && outcome.is_ok());
    source.cover(1, sent && outcome.is_ok());
    source.cover(2, length != expected);
    source.cover(3, matches!(outcome, Err(FrameError::Position(_))));
    match outcome {
        Ok(again) if length == expected => {
            if again {
                Verdict::Held
            } else {
                Verdict::Broken("encoding_inverts_decoding")
            }
        }
        Err(FrameError::Length {
            expected: told,
            found,
        }) if length != expected => {
            if (told, found) == (expected, length) {
                Verdict::Held
            } else {
                Verdict::Broken("length_is_told")
            }
        }
        Err(FrameError::Position(position)) if length == expected && sent => {
            let outside = match telegram {
                Telegram::T901 => position == -32_768,
                Telegram::T902 => position.unsigned_abs() > 737_280_000,
                _ => false,
            };
            if outside {
                Verdict::Held
            } else {
                Verdict::Broken("position_is_refused_outside_its_range_only")
            }
        }
        _ => Verdict::Broken("length_decides"),
    }
}

/// Whether each byte has no bit that the other has not. By places: a symbolic checker does not see where two zipped lists end.
fn only_less<const LENGTH: usize>(fewer: &[u8; LENGTH], bytes: &[u8; LENGTH]) -> bool {
    (0..LENGTH).all(|place| fewer[place] & bytes[place] == fewer[place])
}

trait AnyTelegram: Source {
    /// Any telegram.
    fn any_of_all(&mut self) -> Telegram {
        let place = self.any_in(0, Telegram::ALL.len() as u32 - 1);
        Telegram::ALL[place as usize]
    }
}

impl<S: Source> AnyTelegram for S {}

/// The status word is made of the status signals.
///
/// Cover 0: an internal event, cover 1: SLP without a reference.
pub fn status_word_qualifies<S: Source>(source: &mut S, _subject: &Subject) -> Verdict {
    let signals = any_word(source);
    let selected = source.any_bool();
    // The enumeration takes them from the word, or there would be too many cases.
    let [inputs, transferred] = if source.enumerates() {
        [signals & 7, signals >> 16 & 7]
    } else {
        [source.any_in(0, 7), source.any_in(0, 7)]
    };
    let word = StatusSignals::decode(signals)
        .status_word(selected)
        .with_inputs(inputs as u8, transferred as u8)
        .encode();
    let referenced = signals >> 23 & 1 == 1;
    source.cover(0, signals >> 7 & 1 == 0);
    source.cover(1, signals >> 6 & 1 == 1 && !referenced);
    let alike = StatusSignals::USED & !(1 << 6 | 1 << 7);
    let slp = u32::from(signals >> 6 & 1 == 1 && referenced) << 6;
    let event = (!signals >> 7 & 1) << 7;
    let expected =
        signals & alike | slp | event | u32::from(selected) << 29 | (inputs & transferred) << 24;
    if word == expected {
        Verdict::Held
    } else {
        Verdict::Broken("status_word_is_the_signals")
    }
}
