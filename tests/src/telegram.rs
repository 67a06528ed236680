//! Telegrams of SINAMICS S120 as the manual prints them (`signals.toml`), beside those of the monitors: what fuzzers drive.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;
use stillpoint_monitors::sinamics::telegram::control::{ControlWord1, ControlWord2};
use stillpoint_monitors::sinamics::telegram::frame::{Positioned, Received, Sent, Telegram};
use stillpoint_monitors::sinamics::telegram::status::{StatusWord1, StatusWord2};
use stillpoint_monitors::sinamics::telegram::values::{next_cycle, sls_limit};

use crate::random::Random;
use crate::root;

/// A word in a telegram.
#[derive(Deserialize)]
struct Place {
    words: usize,
    word: String,
}

#[derive(Deserialize)]
struct Layout {
    number: i64,
    out: Vec<Place>,
    r#in: Vec<Place>,
}

#[derive(Deserialize)]
struct Bit {
    word: String,
    bit: u32,
    name: String,
    basic: String,
}

#[derive(Deserialize)]
struct Printed {
    telegram: Vec<Layout>,
    bit: Vec<Bit>,
}

/// The bits of a word: those that are not reserved, those that Basic Functions have, and the place of each by its name.
#[derive(Default)]
struct Bits {
    used: u32,
    basic: u32,
    named: BTreeMap<String, u32>,
}

/// What is printed: the telegrams, and the words that are made of bits.
struct Manual {
    telegrams: Vec<Layout>,
    words: BTreeMap<String, Bits>,
}

static MANUAL: LazyLock<Manual> = LazyLock::new(|| {
    let path = root().join("spec/families/sinamics-s120/signals.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path:?}: {e}"));
    let printed: Printed = toml::from_str(&text).unwrap_or_else(|e| panic!("{path:?}: {e}"));
    let mut words: BTreeMap<String, Bits> = BTreeMap::new();
    for bit in printed.bit {
        let word = words.entry(bit.word).or_default();
        if bit.name != "reserved" {
            word.used |= 1 << bit.bit;
            word.basic |= u32::from(bit.basic == "used") << bit.bit;
            word.named.insert(bit.name, bit.bit);
        }
    }
    Manual {
        telegrams: printed.telegram,
        words,
    }
});

/// The place of a bit in a word.
///
/// # Panics
/// If the manual has no such bit.
pub fn place(word: &str, name: &str) -> u32 {
    let place = MANUAL.words[word].named.get(name);
    *place.unwrap_or_else(|| panic!("{word} has no bit `{name}`"))
}

/// The number of PZD words of these places.
fn words_of(places: &[Place]) -> usize {
    places.iter().map(|place| place.words).sum()
}

/// Whether the bits of a word are numbered byte by byte; else it is a number, the higher byte first.
fn bytewise(place: &Place) -> bool {
    ["S_STW1", "S_STW2", "S_ZSW1", "S_ZSW2"].contains(&place.word.as_str())
}

/// A word as it lies in its bytes.
fn raw(place: &Place, bytes: &[u8]) -> u32 {
    let joined = |word: u32, byte: &u8| word << 8 | u32::from(*byte);
    match bytewise(place) {
        true => bytes.iter().rev().fold(0, joined),
        false => bytes.iter().fold(0, joined),
    }
}

/// The same bytes with the reserved bits of its words at 0.
fn cleared(places: &[Place], bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = bytes;
    for place in places {
        let (own, others) = rest.split_at(2 * place.words);
        rest = others;
        let used = MANUAL.words.get(&place.word).map_or(u32::MAX, |w| w.used);
        let word = raw(place, own) & used;
        let mut written = word.to_be_bytes()[4 - own.len()..].to_vec();
        if bytewise(place) {
            written.reverse();
        }
        out.extend(written);
    }
    out
}

/// The value of a word.
fn word(places: &[Place], bytes: &[u8], name: &str) -> Option<u32> {
    let mut start = 0;
    for place in places {
        let end = start + 2 * place.words;
        if place.word == name {
            return Some(raw(place, &bytes[start..end]));
        }
        start = end;
    }
    None
}

/// A position of a telegram that no drive sends: beyond 32767, or 737280000.
fn beyond(places: &[Place], bytes: &[u8]) -> bool {
    let short = word(places, bytes, "S_XIST16").map(|raw| i64::from(raw as u16 as i16));
    let long = word(places, bytes, "S_XIST32").map(|raw| i64::from(raw as i32));
    short.is_some_and(|p| p.abs() > 32_767) || long.is_some_and(|p| p.abs() > 737_280_000)
}

/// Whether the bytes are a telegram: the first one says which and in which direction, the rest is the frame.
///
/// # Panics
/// If what is read is not what the manual prints of these bits, or is another frame when it is written.
pub fn telegram(data: &[u8]) -> bool {
    let Some((kind, frame)) = data.split_first() else {
        return false;
    };
    let kind = usize::from(*kind) % (2 * Telegram::ALL.len());
    let telegram = Telegram::ALL[kind / 2];
    let mut layouts = MANUAL.telegrams.iter();
    let layout = layouts.find(|layout| layout.number == telegram as i64);
    let layout = layout.unwrap_or_else(|| panic!("{telegram:?} is not printed"));
    if kind % 2 == 0 {
        received(telegram, &layout.out, frame)
    } else {
        sent(telegram, &layout.r#in, frame)
    }
}

fn received(telegram: Telegram, places: &[Place], frame: &[u8]) -> bool {
    let fits = frame.len() == 2 * words_of(places);
    let read = Received::decode(telegram, frame);
    assert_eq!(read.is_ok(), fits, "{telegram:?} {frame:?}: {read:?}");
    let Ok(read) = read else {
        return false;
    };
    let written = read.encode();
    assert_eq!(
        written.bytes(),
        cleared(places, frame),
        "{telegram:?} {frame:?}"
    );
    assert_eq!(Received::decode(telegram, written.bytes()), Ok(read));
    match read {
        Received::T30(word) => control_1(word, first(places, frame, "S_STW1")),
        Received::T31(word) => control_2(word, first(places, frame, "S_STW2")),
        Received::Limited(control, limit) => {
            control_2(control, first(places, frame, "S_STW2"));
            assert_eq!(word(places, frame, "S_SLS_LIMIT_A"), Some(limit.into()));
            // 32767 is the whole limit; 0 and what is above are none.
            let asked = (1..=32_767).contains(&limit);
            let told = sls_limit(limit, 1_000);
            assert_eq!(told, asked.then(|| u32::from(limit) * 1_000 / 32_767));
        }
        Received::Nothing | Received::T701(..) => {}
    }
    true
}

fn sent(telegram: Telegram, places: &[Place], frame: &[u8]) -> bool {
    let fits = frame.len() == 2 * words_of(places) && !beyond(places, frame);
    let read = Sent::decode(telegram, frame);
    assert_eq!(read.is_ok(), fits, "{telegram:?} {frame:?}: {read:?}");
    let Ok(read) = read else {
        return false;
    };
    let written = read.encode();
    assert_eq!(
        written.bytes(),
        cleared(places, frame),
        "{telegram:?} {frame:?}"
    );
    assert_eq!(Sent::decode(telegram, written.bytes()), Ok(read));
    let positioned = |told: &Positioned| {
        status_2(told.word, first(places, frame, "S_ZSW2"));
        assert_eq!(
            word(places, frame, "S_SLS_LIMIT_A_ACTIVE"),
            Some(told.limit.into())
        );
        assert_eq!(
            word(places, frame, "S_CYCLE_COUNT"),
            Some((told.cycle as u16).into())
        );
        let next = i32::from(next_cycle(told.cycle)) - i32::from(told.cycle);
        assert!(next == 1 || (told.cycle == 32_767 && next == -65_535));
    };
    match read {
        Sent::T30(word) => status_1(word, first(places, frame, "S_ZSW1")),
        Sent::T31(word) => status_2(word, first(places, frame, "S_ZSW2")),
        Sent::T901(told, position) => {
            positioned(&told);
            assert_eq!(
                word(places, frame, "S_XIST16"),
                Some((position as u16).into())
            );
        }
        Sent::T902(told, position) => {
            positioned(&told);
            assert_eq!(word(places, frame, "S_XIST32"), Some(position as u32));
        }
        Sent::T700(..) | Sent::T701(..) => {}
    }
    true
}

fn first(places: &[Place], frame: &[u8], name: &str) -> u32 {
    word(places, frame, name).unwrap_or_else(|| panic!("{name} is not printed there"))
}

/// Every field has the level of the bit that has its name in the manual, and none is left out.
fn same(word: &str, raw: u32, fields: &[(&str, bool)]) {
    let printed = &MANUAL.words[word].named;
    assert_eq!(fields.len(), printed.len(), "{word}");
    for (name, level) in fields {
        let bit = printed.get(*name);
        let bit = bit.unwrap_or_else(|| panic!("{word} has no bit `{name}`"));
        assert_eq!(*level, raw >> bit & 1 == 1, "{word} {raw:#x}: {name}");
    }
}

/// The level of SLS: bits 9 and 10, counted from 1.
fn level(raw: u32) -> u8 {
    1 + (raw >> 9 & 1) as u8 + 2 * (raw >> 10 & 1) as u8
}

fn control_1(word: ControlWord1, raw: u32) {
    let fields = [
        ("STO", word.sto),
        ("SS1", word.ss1),
        ("SS2", word.ss2),
        ("SOS", word.sos),
        ("SLS", word.sls),
        ("SLP", word.slp),
        ("Internal Event ACK", word.internal_event_ack),
        ("SLS level bit 0", word.sls_level_0),
        ("SLS level bit 1", word.sls_level_1),
        ("SDI positive", word.sdi_positive),
        ("SDI negative", word.sdi_negative),
    ];
    same("S_STW1", raw, &fields);
    let basic = raw & MANUAL.words["S_STW1"].basic;
    assert_eq!(u32::from(word.basic().encode()), basic);
    assert_eq!(word.sls_level(), level(raw));
}

fn control_2(word: ControlWord2, raw: u32) {
    let tolerance = "increased position tolerance (gearbox switchover)";
    let fields = [
        ("STO", word.sto),
        ("SS1", word.ss1),
        ("SS2", word.ss2),
        ("SOS", word.sos),
        ("SLS", word.sls),
        ("SLP", word.slp),
        ("Internal Event ACK", word.internal_event_ack),
        ("SLS level bit 0", word.sls_level_0),
        ("SLS level bit 1", word.sls_level_1),
        ("SDI positive", word.sdi_positive),
        ("SDI negative", word.sdi_negative),
        ("SLP position range", word.slp_area_2),
        ("gearbox stage bit 0", word.gear_0),
        ("gearbox stage bit 1", word.gear_1),
        ("gearbox stage bit 2", word.gear_2),
        (tolerance, word.gear_tolerance),
        ("SS2E", word.ss2e),
    ];
    same("S_STW2", raw, &fields);
    assert_eq!(word.basic().encode(), raw & MANUAL.words["S_STW2"].basic);
    assert_eq!(word.sls_level(), level(raw));
    assert_eq!(u32::from(word.gear_stage()), raw >> 24 & 7);
}

fn status_1(word: StatusWord1, raw: u32) {
    let fields = [
        ("STO active", word.sto_active),
        ("SS1 active", word.ss1_active),
        ("SS2 active", word.ss2_active),
        ("SOS active", word.sos_active),
        ("SLS active", word.sls_active),
        ("SLP active", word.slp_active),
        ("Internal Event", word.internal_event),
        ("active SLS level bit 0", word.sls_level_0),
        ("active SLS level bit 1", word.sls_level_1),
        ("SOS selected", word.sos_selected),
        ("SDI positive active", word.sdi_positive_active),
        ("SDI negative active", word.sdi_negative_active),
        ("SSM", word.ssm),
    ];
    same("S_ZSW1", raw, &fields);
    let basic = raw & MANUAL.words["S_ZSW1"].basic;
    assert_eq!(u32::from(word.basic().encode()), basic);
    assert_eq!(word.sls_level(), level(raw));
}

fn status_2(word: StatusWord2, raw: u32) {
    let fields = [
        ("STO active", word.sto_active),
        ("SS1 active", word.ss1_active),
        ("SS2 active", word.ss2_active),
        ("SOS active", word.sos_active),
        ("SLS active", word.sls_active),
        ("SLP active", word.slp_active),
        ("Internal Event", word.internal_event),
        ("active SLS level bit 0", word.sls_level_0),
        ("active SLS level bit 1", word.sls_level_1),
        ("SDI positive active", word.sdi_positive_active),
        ("SDI negative active", word.sdi_negative_active),
        ("SSM", word.ssm),
        ("SLP active position range", word.slp_area_2),
        ("safe position valid", word.position_valid),
        ("safely referenced", word.safely_referenced),
        ("F-DI 0 (CU310-2)", word.input_0),
        ("F-DI 1 (CU310-2)", word.input_1),
        ("F-DI 2 (CU310-2)", word.input_2),
        ("SS2E active", word.ss2e_active),
        ("SOS selected", word.sos_selected),
        ("SLP upper limit maintained", word.slp_upper_maintained),
        ("SLP lower limit maintained", word.slp_lower_maintained),
    ];
    same("S_ZSW2", raw, &fields);
    assert_eq!(word.basic().encode(), raw & MANUAL.words["S_ZSW2"].basic);
    assert_eq!(word.sls_level(), level(raw));
}

/// Any frame: each length that a telegram has or just has not, most of them the right one, with any bytes.
pub fn frame(random: &mut Random) -> Vec<u8> {
    let mut draw = |count: usize| (random.draw() % count.max(1) as u64) as usize;
    let kind = draw(2 * Telegram::ALL.len());
    let telegram = Telegram::ALL[kind / 2];
    let right = match kind % 2 {
        0 => Received::length(telegram),
        _ => Sent::length(telegram),
    };
    let length = match draw(16) {
        0 => draw(16),
        _ => right,
    };
    let mut frame = vec![kind as u8];
    // Bytes of any value, or mostly 0 or 255: words in which one bit decides.
    let manner = draw(4);
    frame.extend((0..length).map(|_| match (manner, draw(8)) {
        (0, 1..) => 0,
        (1, 1..) => 255,
        _ => draw(256) as u8,
    }));
    frame
}

/// One frame of each telegram in each direction.
pub fn seeds() -> Vec<Vec<u8>> {
    let kinds = 0..2 * Telegram::ALL.len();
    let all = kinds.map(|kind| {
        let telegram = Telegram::ALL[kind / 2];
        let length = match kind % 2 {
            0 => Received::length(telegram),
            _ => Sent::length(telegram),
        };
        let mut frame = vec![kind as u8];
        frame.extend((0..length).map(|k| 0x11 * k as u8));
        frame
    });
    all.collect()
}
