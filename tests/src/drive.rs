//! A drive of SINAMICS S120 at its F host, driven by telegrams of any bytes: each answer is judged by what the manual says of the bits that
//! were sent and received, with the values of the machine file. Nothing here knows the monitors.

use std::sync::LazyLock;

use stillpoint_harness::families::sinamics::on_bus::{Around, OnBus};
use stillpoint_machine::{self as machine, AxisKind, Machine, Settings, families};
use stillpoint_monitors::sinamics::telegram::frame::Telegram;

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

/// The values of an axis that its answers depend on, in cycles, micrometres and micrometres per cycle.
struct Axis {
    /// Cycles in which a telegram may be missing: `F_WD_Time`.
    watchdog: u32,
    /// Delay of SLS and SOS, p9551, and the times of SS1 and STOP F, p9556 and p9555.
    p9551: u32,
    p9556: u32,
    p9555: u32,
    /// None of a rotary axis.
    lengths: Option<Lengths>,
    /// STO or SS1 that is selected and deselected acknowledges.
    extended: bool,
}

struct Lengths {
    /// Limits of SLS, and whether the telegram brings the first one.
    limits: [u64; 4],
    by_telegram: bool,
    /// The window of SOS, the tolerance of both encoders.
    window: u64,
    apart: u64,
    /// SSM without hysteresis: its limit.
    ssm: Option<u64>,
    /// SDI: the delay in cycles, and the tolerance.
    sdi: Option<(u32, u64)>,
    /// The ranges of SLP, lower and upper end.
    slp: Option<[[i64; 2]; 2]>,
}

impl Axis {
    fn of(machine: &Machine, axis: &machine::Axis) -> Self {
        let cycle = machine.monitoring_cycle.unsigned_abs();
        let signed = |values: &Settings, name: &str, k: usize| {
            let cell = values.get(name).and_then(|value| value.cells.get(k));
            *cell.unwrap_or_else(|| panic!("{} has no {name}", axis.name))
        };
        let own = |name| signed(&axis.values, name, 0).unsigned_abs();
        let cycles = |name| own(name).div_ceil(cycle) as u32;
        // What runs a minute, in a cycle.
        let speed = |name, k| signed(&axis.values, name, k).unsigned_abs() * cycle / 60_000_000;
        let range = |k| ["p9535", "p9534"].map(|name| signed(&axis.values, name, k));
        let lengths = || Lengths {
            limits: [0, 1, 2, 3].map(|k| speed("p9531", k)),
            by_telegram: axis.has("SLS limit by telegram"),
            window: own("p9530"),
            apart: own("p9542"),
            ssm: (!axis.has("SSM hysteresis") && own("p9546") > 0).then(|| speed("p9546", 0)),
            sdi: axis.has("SDI").then(|| (cycles("p9565"), own("p9564"))),
            slp: axis.has("SLP").then(|| [range(0), range(1)]),
        };
        Self {
            watchdog: (signed(&machine.control, "F_WD_Time", 0).unsigned_abs() / cycle) as u32,
            p9551: cycles("p9551"),
            p9556: cycles("p9556"),
            p9555: cycles("p9555"),
            lengths: (axis.kind == AxisKind::Linear).then(lengths),
            extended: own("p9507_0") != 0,
        }
    }
}

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

/// What the host has sent in a cycle, and what the drive is.
#[derive(Clone, Copy, Default)]
struct Given {
    /// A telegram, if one came.
    word: Option<Word>,
    /// Its limit of SLS, in 32767ths.
    limit: i16,
    /// The way of the axis in this cycle, and by how much the second encoder shows more than the first.
    way: i64,
    apart: i64,
}

/// What has been seen of a run.
#[derive(Default)]
struct Seen {
    sent: Word,
    told: Word,
    /// Cycles since the last telegram, and whether one was missed for longer than the watchdog allows and the drive has had no torque since.
    missing: u32,
    failed: bool,
    /// Cycles for which SS1 is selected, for which SOS is; for which SLS and SDI are with nothing beside them.
    ss1: u32,
    sos: u32,
    sls: u32,
    sdi: [u32; 2],
    /// Cycles for which the encoders have been apart, and for which a function has been active meanwhile.
    differing: u32,
    monitored: u32,
    /// How far they were apart in the cycle before.
    apart: i64,
    /// Something that monitors was selected, telegrams were missed or the encoders have differed: from then on an internal event may have a cause.
    may: bool,
    /// Cycles for which telegrams have come with nothing selected and the axis has stood; whether the acknowledgement rose in them.
    quiet: u32,
    rose: bool,
    /// Where SOS has begun, and both directions of SDI.
    stands: Option<i64>,
    from: [Option<i64>; 2],
    position: i64,
}

/// A cycle as it is judged: what was sent and told in the one before, and in this one.
struct Cycle {
    before: [Word; 2],
    word: Word,
    fresh: bool,
    told: Word,
}

impl Cycle {
    fn tells(&self, name: &str) -> bool {
        self.told.tells(name)
    }

    /// One of them is told.
    fn tells_any(&self, names: &[&str]) -> bool {
        names.iter().any(|name| self.tells(name))
    }

    fn selects(&self, name: &str) -> bool {
        self.fresh && self.word.selects(name)
    }

    /// Where a rule is broken the run ends with what was sent and told.
    fn must(&self, holds: bool, rule: &str) {
        assert!(
            holds,
            "{rule}: sent {:#x} then {:#x}{}, told {:#x} then {:#x}",
            self.before[0].raw,
            self.word.raw,
            if self.fresh { "" } else { " (none)" },
            self.before[1].raw,
            self.told.raw
        );
    }

    /// With a violation comes an event in its cycle.
    fn needs_event(&self, violated: bool, rule: &str) {
        self.must(!violated || self.tells("Internal Event"), rule);
    }
}

/// What is active where nothing moves the axis any more.
const STOPPED: [&str; 3] = ["STO active", "SS1 active", "SOS active"];

/// Both directions of SDI, as selected and as told.
const DIRECTIONS: [[&str; 2]; 2] = [
    ["SDI positive", "SDI positive active"],
    ["SDI negative", "SDI negative active"],
];

impl Seen {
    /// One cycle, and the answer.
    fn judge(&mut self, axis: &Axis, given: &Given, told: Word) {
        let cycle = Cycle {
            before: [self.sent, self.told],
            word: given.word.unwrap_or(self.sent),
            fresh: given.word.is_some(),
            told,
        };
        self.missing = counted(self.missing, !cycle.fresh);
        self.failed |= self.missing >= axis.watchdog;
        self.position += given.way;
        self.stops(axis, &cycle);
        self.ends(&cycle);
        self.events(axis, &cycle, given);
        if let Some(lengths) = &axis.lengths {
            self.motion(lengths, &cycle, given);
            self.encoders(axis, lengths, &cycle, given);
        }
        self.begins(axis, &cycle);
        self.failed &= cycle.tells("STO active");
        (self.sent, self.told) = (cycle.word, told);
    }

    /// STO acts in the cycle in which it is selected, SS1 in p9556 at the latest. How late a cycle of the bus makes it is not asked here.
    fn stops(&mut self, axis: &Axis, cycle: &Cycle) {
        let sto = cycle.tells("STO active");
        cycle.must(!cycle.selects("STO") || sto, "STO is selected");
        self.ss1 = counted(self.ss1, cycle.selects("SS1"));
        cycle.must(self.ss1 <= axis.p9556 + 2 || sto, "SS1 has had its time");
        // SOS is told as selected at once, for the control has to brake (4.5.2), and is active after p9551.
        let sos = cycle.selects("SOS");
        cycle.must(!sos || cycle.tells("SOS selected"), "SOS is selected");
        self.sos = counted(self.sos, sos);
        let late = self.sos > axis.p9551 + 2 && !cycle.tells_any(&STOPPED);
        cycle.must(!late, "SOS is not active");
        // Without telegrams the drive has no torque, after the stop of p9612 at the latest.
        let without = axis.watchdog + axis.p9556 + 3;
        cycle.must(self.missing <= without || sto, "no telegram comes");
    }

    /// A function that is deselected ends at once; what is active was selected, or a stop or a failure selects it.
    fn ends(&mut self, cycle: &Cycle) {
        if self.failed {
            return;
        }
        let told = [["SLS", "SLS active"]].into_iter().chain(DIRECTIONS);
        for [name, active] in told {
            let selected = cycle.word.selects(name);
            cycle.must(!cycle.tells(active) || selected, "it is not selected");
        }
        // SS2 that is deselected brakes to its end, and is SOS for a cycle at least (reading AF-17); the SOS of a stop ends a cycle after it.
        let before = cycle.before[1];
        let ends = before.tells("SS2 active") || before.tells("Internal Event");
        let held = ["SOS", "SS2", "SS2E"]
            .map(|name| cycle.word.selects(name))
            .contains(&true);
        cycle.must(
            !cycle.tells("SOS active") || held || ends || cycle.tells("Internal Event"),
            "nothing asks for SOS",
        );
    }

    /// Where nothing has monitored yet nothing can have happened. An event ends by the falling edge of its bit, or by STO or SS1 deselected
    /// with p9507.0 = 1.
    fn events(&mut self, axis: &Axis, cycle: &Cycle, given: &Given) {
        let event = cycle.tells("Internal Event");
        let word = cycle.word;
        let monitored = FUNCTIONS[1..].iter().any(|name| word.selects(name));
        self.may |= self.missing > 0 || given.apart != 0 || monitored;
        cycle.must(self.may || !event, "an event of nothing");
        let ack = [cycle.before[0], word].map(|word| word.asks("Internal Event ACK"));
        if cycle.before[1].tells("Internal Event") && !event {
            let selected = |word: Word| word.selects("STO") || word.selects("SS1");
            let again = axis.extended && selected(cycle.before[0]) && !selected(word);
            cycle.must(ack == [true, false] || again, "nothing has acknowledged");
        }
        // At standstill with nothing selected no cause is left: the falling edge of the bit ends the event.
        let selected = FUNCTIONS.iter().any(|name| word.selects(name));
        let calm = cycle.fresh && given.way == 0 && given.apart == 0 && !selected;
        self.quiet = counted(self.quiet, calm);
        self.rose = self.quiet > 3 && (self.rose || ack == [false, true]);
        if self.rose && ack == [true, false] {
            cycle.must(!event, "what was acknowledged stays");
        }
    }

    /// A speed above the limit of the active level is an event in its cycle, and so are a position outside the window or the range, the wrong
    /// direction, and a limit that is none. SSM says what the speed is.
    fn motion(&mut self, axis: &Lengths, cycle: &Cycle, given: &Given) {
        let (before, told) = (cycle.before[1], cycle.told);
        let speed = given.way.unsigned_abs();
        if cycle.tells("SLS active")
            && before.tells("SLS active")
            && told.level() == before.level()
        {
            let above = speed > axis.limits[told.level()] + 1;
            cycle.needs_event(above, "faster than SLS allows");
        }
        let counts = axis.by_telegram && cycle.selects("SLS") && cycle.word.level() == 0;
        cycle.needs_event(counts && given.limit < 1, "a limit that is none");
        self.stands = begun(self.stands, cycle.tells("SOS active"), self.position);
        if let Some(place) = self.stands {
            let left = self.position.abs_diff(place) > axis.window;
            cycle.needs_event(left, "outside the window of SOS");
        }
        if let Some((_, tolerance)) = axis.sdi {
            for (k, [_, active]) in DIRECTIONS.iter().enumerate() {
                self.from[k] = begun(self.from[k], cycle.tells(active), self.position);
                let back = self.from[k].map_or(0, |from| from - self.position);
                let wrong = if k == 0 { back } else { -back };
                let wrong = u64::try_from(wrong).is_ok_and(|wrong| wrong > tolerance);
                cycle.needs_event(wrong, "against the direction of SDI");
            }
        }
        if let Some(ranges) = axis.slp.filter(|_| cycle.tells("SLP active")) {
            let second = !told.short && cycle.tells("SLP active position range");
            let asked = !told.short && cycle.word.asks("SLP position range");
            let chosen = self.failed || second == asked;
            cycle.must(chosen, "not the range of SLP that is selected");
            let [lower, upper] = ranges[usize::from(second)];
            let within = (lower - 1..=upper + 1).contains(&self.position);
            cycle.needs_event(!within, "outside the range of SLP");
        }
        if let Some(limit) = axis.ssm.filter(|_| given.apart == 0 && self.apart == 0) {
            let below = cycle.tells("SSM");
            cycle.must(below || speed + 1 >= limit, "below the limit of SSM");
            cycle.must(!below || speed <= limit, "not below the limit of SSM");
        }
    }

    /// Encoders that come apart are STOP F at the latest a cycle later, and no torque follows where something is monitored.
    fn encoders(&mut self, axis: &Axis, lengths: &Lengths, cycle: &Cycle, given: &Given) {
        let apart = given.apart.unsigned_abs() > 2 * lengths.apart;
        self.apart = given.apart;
        self.differing = counted(self.differing, apart);
        let found = self.differing < 3 || cycle.tells("Internal Event");
        cycle.must(found, "the encoders are apart");
        let active = cycle.tells_any(&[
            "SOS active",
            "SLS active",
            "SDI positive active",
            "SDI negative active",
        ]);
        // STOP F is STOP B after p9555, and that STOP A after p9556.
        self.monitored = counted(self.monitored, apart && active);
        let long = axis.p9555 + axis.p9556 + 5;
        let off = self.monitored <= long || cycle.tells("STO active");
        cycle.must(off, "STOP F stops nothing");
    }

    /// SLS and SDI that stay selected monitor after p9551 and p9565, SLS with its level.
    fn begins(&mut self, axis: &Axis, cycle: &Cycle) {
        let word = cycle.word;
        let stops = ["STO", "SS1", "SS2", "SOS", "SS2E"].map(|name| word.selects(name));
        let calm = cycle.fresh
            && stops == [false; 5]
            && !cycle.tells_any(&STOPPED)
            && !cycle.tells("Internal Event");
        let same = word.level() == cycle.before[0].level();
        self.sls = counted(self.sls, calm && same && word.selects("SLS"));
        if self.sls > axis.p9551 + 2 {
            let level = cycle.told.level() == word.level();
            let active = cycle.tells("SLS active") && level;
            cycle.must(active, "SLS is not monitored");
        }
        let sdi = axis.lengths.as_ref().and_then(|lengths| lengths.sdi);
        let Some((delay, _)) = sdi else { return };
        for (k, [name, active]) in DIRECTIONS.iter().enumerate() {
            self.sdi[k] = counted(self.sdi[k], calm && word.selects(name));
            let late = self.sdi[k] > delay + 2 && !cycle.tells(active);
            cycle.must(!late, "SDI is not monitored");
        }
    }
}

/// Where something has begun, while it goes on.
const fn begun(before: Option<i64>, goes_on: bool, position: i64) -> Option<i64> {
    match (goes_on, before) {
        (true, None) => Some(position),
        (true, place) => place,
        (false, _) => None,
    }
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
    let mut seen = Seen {
        sent: free,
        told: Word { short, raw: 0 },
        ..Seen::default()
    };
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
            4 if what / 16 == 0 => apart = (i32::from(fast) - 128) * 1_000,
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
            if (seen.position + speed).abs() > farthest {
                speed = -speed;
            }
            let position = (seen.position + speed) as i32;
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
