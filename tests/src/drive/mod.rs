//! A drive of SINAMICS S120 at its F host, driven by telegrams of any bytes: each answer is judged by what the manual says of the bits that
//! were sent and received, with the values of the machine file. Nothing here knows the monitors.

mod axis;
mod judge;

use std::sync::LazyLock;

use stillpoint_harness::families::sinamics::on_bus::{Around, OnBus};
use stillpoint_machine::{self as machine, Machine, families};
use stillpoint_monitors::sinamics::telegram::frame::Telegram;

use self::axis::Axis;
use self::judge::{Given, Seen};
use crate::random::Random;
use crate::telegram::place;

/// Machines whose axes are controlled by PROFIsafe, with telegrams 30 and 31, and 901.
const MACHINES: [&str; 2] = [
    "spec/machines/gantry-s120.toml",
    "spec/machines/feeder-s120.toml",
];

/// The functions that a bit of 0 selects.
const FUNCTIONS: [&str; 9] = [
    "STO",
    "SS1",
    "SS2",
    "SOS",
    "SLS",
    "SLP",
    "SDI positive",
    "SDI negative",
    "SS2E",
];

/// Control and status word of a telegram.
const fn words(short: bool) -> [&'static str; 2] {
    match short {
        true => ["S_STW1", "S_ZSW1"],
        false => ["S_STW2", "S_ZSW2"],
    }
}

/// A word with the name of the manual for each of its bits.
#[derive(Clone, Copy, Default)]
struct Word {
    short: bool,
    raw: u32,
}

impl Word {
    fn is(self, word: &str, name: &str) -> bool {
        self.raw >> place(word, name) & 1 == 1
    }

    fn asks(self, name: &str) -> bool {
        self.is(words(self.short)[0], name)
    }

    /// The bit of a function is 0. A word that has no such bit does not select it.
    fn selects(self, name: &str) -> bool {
        let missing = self.short && name == "SS2E";
        !(missing || self.asks(name))
    }

    fn tells(self, name: &str) -> bool {
        self.is(words(self.short)[1], name)
    }

    fn level(self) -> usize {
        (self.raw >> 9 & 3) as usize
    }
}

/// For how many cycles something has gone on.
const fn counted(before: u32, goes_on: bool) -> u32 {
    if goes_on { before + 1 } else { 0 }
}

/// What was driven.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    /// Cycles with a telegram.
    pub telegrams: u64,
    /// Answers in which something is active or has happened, by the bits of S_ZSW2.
    pub told: u32,
}

/// Drives a drive by these bytes: which axis, then what changes and for how many cycles. Whether any telegram was one.
///
/// # Panics
/// If an answer is none that the manual allows.
pub fn drive(data: &[u8]) -> bool {
    run(data).telegrams > 0
}

/// The machines, and those of their axes that have a safety telegram and Extended Functions.
static DRIVEN: LazyLock<Vec<(Machine, usize, Axis)>> = LazyLock::new(|| {
    let load = |file| {
        let path = crate::root().join(file);
        let machine = machine::load(&path, &families(&path)).unwrap_or_else(|e| panic!("{e}"));
        let driven: Vec<(usize, Axis)> = (machine.axes.iter().enumerate())
            .filter(|(k, axis)| axis.has("motion monitoring") && OnBus::new(&machine, *k).is_ok())
            .map(|(k, axis)| (k, Axis::of(&machine, axis)))
            .collect();
        driven
            .into_iter()
            .map(move |(k, axis)| (machine.clone(), k, axis))
    };
    MACHINES.into_iter().flat_map(load).collect()
});

/// See [`drive`].
///
/// # Panics
/// If an answer is none that the manual allows.
pub fn run(data: &[u8]) -> Count {
    let mut count = Count::default();
    let Some((first, data)) = data.split_first() else {
        return count;
    };
    let (machine, k, axis) = &DRIVEN[usize::from(*first) % DRIVEN.len()];
    let mut drive = OnBus::new(machine, *k).unwrap_or_else(|e| panic!("{e}"));
    let short = drive.telegram() == Telegram::T30;
    let limited = drive.telegram() == Telegram::T901;
    let bits = if short { 2 } else { 4 };
    let length = if limited { 6 } else { bits };
    // A position that does not fit 16 bits is a STOP F that stays (S120-SP-005).
    let farthest = if limited { 3_200_000 } else { 100_000_000 };
    // Every bit that selects is 1, all others 0.
    let mut free = Word { short, raw: 0 };
    for name in FUNCTIONS.iter().filter(|name| !(short && **name == "SS2E")) {
        free.raw |= 1 << place(words(short)[0], name);
    }
    let mut control = free;
    let mut limit = i16::MAX;
    let mut seen = Seen::new(free);
    let mut speed = 0_i64;
    let frame = |control: Word, limit: i16| {
        let mut bytes = [0; 6];
        bytes[..bits].copy_from_slice(&control.raw.to_le_bytes()[..bits]);
        if limited {
            bytes[4..].copy_from_slice(&limit.to_be_bytes());
        }
        bytes
    };
    // The first position is one of no speed.
    let still = Around {
        positions: [0; 2],
        on: true,
    };
    drive.step(Some(&frame(free, limit)[..length]), still);
    for record in data.chunks_exact(4) {
        let [what, bit, fast, times] = [record[0], record[1], record[2], record[3]];
        if bit < 32 {
            control.raw ^= 1 << (bit % if short { 16 } else { 32 });
        }
        if fast < 96 {
            // Up to 16 mm in a cycle: faster than any limit. Mostly slow.
            let size = i64::from(fast % 48);
            speed = size * size * size / 8 * if fast < 48 { 1 } else { -1 };
        }
        let mut apart = 0;
        match what % 16 {
            // Nothing is selected any more, and the axis stands.
            2 => (control, speed, limit) = (free, 0, i16::MAX),
            3 => control.raw ^= 1 << place(words(short)[0], "Internal Event ACK"),
            // One of the encoders jumps, for these cycles.
            // Not where a gear stage may change meanwhile: the channels would be aligned as they are then (S120-GEAR-002).
            4 if what / 16 == 0 && !limited => apart = (i32::from(fast) - 128) * 1_000,
            5 => limit = i16::from_be_bytes([bit, fast]),
            _ => {}
        }
        // Nothing, too little, or a telegram.
        let comes = match what % 16 {
            0 => 0,
            1 => length - 1,
            _ => length,
        };
        for _ in 0..=times % 64 {
            let bytes = frame(control, limit);
            let whole = comes == length;
            count.telegrams += u64::from(whole);
            if (seen.position() + speed).abs() > farthest {
                speed = -speed;
            }
            let position = (seen.position() + speed) as i32;
            let around = Around {
                positions: [position, position + apart],
                on: what / 16 != 15,
            };
            let answer = drive.step((comes > 0).then(|| &bytes[..comes]), around);
            let mut raw = [0; 4];
            raw[..bits].copy_from_slice(&answer.bytes()[..bits]);
            let told = Word {
                short,
                raw: u32::from_le_bytes(raw),
            };
            count.told |= told.raw;
            let given = Given {
                word: whole.then_some(control),
                limit,
                way: speed,
                apart: apart.into(),
            };
            seen.judge(axis, &given, told);
        }
    }
    count
}

/// Records of any bytes: what changes is a bit, a speed, or nothing, for some cycles.
pub fn records(random: &mut Random, count: usize) -> Vec<u8> {
    let mut data = vec![random.draw() as u8];
    for _ in 0..count {
        let [what, bit, fast, times, ..] = random.draw().to_le_bytes();
        data.extend([what, bit % 48, fast, times]);
    }
    data
}

/// Inputs to begin with.
pub fn seeds() -> Vec<Vec<u8>> {
    let mut random = Random::new(30);
    (0..8).map(|_| records(&mut random, 20)).collect()
}
