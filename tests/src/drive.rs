//! A drive of SINAMICS S120 at its F host, driven by telegrams of any bytes: each answer is judged by what the manual says of the bits that
//! were sent and received, with the values of the machine file. Nothing here knows the monitors.

use std::sync::LazyLock;

use stillpoint_harness::families::sinamics::on_bus::{Around, OnBus};
use stillpoint_machine::{self as machine, AxisKind, Machine, Settings, families};
use stillpoint_monitors::sinamics::telegram::frame::Telegram;

use crate::random::Random;
use crate::telegram::place;

/// A machine whose axes are controlled by PROFIsafe.
const MACHINE: &str = "spec/machines/gantry-s120.toml";

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

/// The values of an axis that its answers depend on, in cycles and micrometres.
struct Axis {
    /// Cycles in which a telegram may be missing: `F_WD_Time`.
    watchdog: u32,
    /// Delay of SLS and SOS, p9551, and the time of SS1, p9556.
    p9551: u32,
    p9556: u32,
    /// Limits of SLS in um per cycle and the window of SOS in um; none of a rotary axis.
    lengths: Option<([u64; 4], u64)>,
    /// STO or SS1 that is selected and deselected acknowledges.
    extended: bool,
}

impl Axis {
    fn of(machine: &Machine, axis: &machine::Axis) -> Self {
        let cycle = machine.monitoring_cycle.unsigned_abs();
        let cell = |values: &Settings, name: &str, k: usize| {
            let cell = values.get(name).and_then(|value| value.cells.get(k));
            let cell = cell.unwrap_or_else(|| panic!("{} has no {name}", axis.name));
            cell.unsigned_abs()
        };
        let own = |name| cell(&axis.values, name, 0);
        let cycles = |us: u64| us.div_ceil(cycle) as u32;
        // What runs a minute, in a cycle.
        let limit = |k| cell(&axis.values, "p9531", k) * cycle / 60_000_000;
        let linear = axis.kind == AxisKind::Linear;
        Self {
            watchdog: (cell(&machine.control, "F_WD_Time", 0) / cycle) as u32,
            p9551: cycles(own("p9551")),
            p9556: cycles(own("p9556")),
            lengths: linear.then(|| ([0, 1, 2, 3].map(limit), own("p9530"))),
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

/// What has been seen of a run.
#[derive(Default)]
struct Seen {
    sent: Word,
    told: Word,
    /// Cycles since the last telegram, and whether one was missed for longer than the watchdog allows and the drive has had no torque since.
    missing: u32,
    failed: bool,
    /// Cycles for which SS1 is selected, for which SOS is; for which SLS is with nothing beside it.
    ss1: u32,
    sos: u32,
    sls: u32,
    /// Something that monitors was selected, or telegrams were missed: from then on an internal event may have a cause.
    may: bool,
    /// Cycles for which telegrams have come with nothing selected and the axis has stood; whether the acknowledgement rose in them.
    quiet: u32,
    rose: bool,
    /// Where SOS has begun.
    stands: Option<i64>,
    position: i64,
}

impl Seen {
    /// One cycle: what was sent, if it was a telegram, the way of the axis, and the answer.
    fn judge(&mut self, axis: &Axis, sent: Option<Word>, way: i64, told: Word) {
        let before = (self.sent, self.told);
        let fresh = sent.is_some();
        let word = sent.unwrap_or(self.sent);
        self.missing = counted(self.missing, !fresh);
        self.failed |= self.missing >= axis.watchdog;
        let here = || {
            format!(
                "sent {:#x} then {:#x}{}, told {:#x} then {:#x}",
                before.0.raw,
                word.raw,
                if fresh { "" } else { " (none)" },
                before.1.raw,
                told.raw
            )
        };
        self.position += way;
        let tells = |name| told.tells(name);
        let stops = ["STO", "SS1", "SS2", "SOS", "SS2E"].map(|name| word.selects(name));

        // STO acts in the cycle in which it is selected, SS1 in p9556 at the latest. How late a cycle of the bus makes it is not asked here.
        assert!(
            !fresh || !word.selects("STO") || tells("STO active"),
            "STO is selected: {}",
            here()
        );
        self.ss1 = counted(self.ss1, fresh && word.selects("SS1"));
        assert!(
            self.ss1 <= axis.p9556 + 2 || tells("STO active"),
            "SS1 has had its time: {}",
            here()
        );
        // SOS is told as selected at once, for the control has to brake (4.5.2), and is active after p9551.
        let sos = fresh && word.selects("SOS");
        assert!(!sos || tells("SOS selected"), "SOS is selected: {}", here());
        self.sos = counted(self.sos, sos);
        let stopped = ["SOS active", "SS1 active", "STO active"].map(tells);
        let late = self.sos > axis.p9551 + 2 && !stopped.contains(&true);
        assert!(!late, "SOS is not active: {}", here());
        // Where nothing has monitored yet nothing can have happened.
        self.may |= self.missing > 0 || FUNCTIONS[1..].iter().any(|name| word.selects(name));
        assert!(
            self.may || !tells("Internal Event"),
            "an event of nothing: {}",
            here()
        );
        // Without telegrams the drive has no torque, after the stop of p9612 at the latest.
        let without = axis.watchdog + axis.p9556 + 3;
        assert!(
            self.missing <= without || tells("STO active"),
            "no telegram comes: {}",
            here()
        );

        // A function that is deselected ends at once; what is active was selected, or a stop or a failure selects it.
        if !self.failed {
            assert!(
                !tells("SLS active") || word.selects("SLS"),
                "SLS is not selected: {}",
                here()
            );
            for (active, name) in [
                ("SDI positive active", "SDI positive"),
                ("SDI negative active", "SDI negative"),
            ] {
                assert!(
                    !tells(active) || word.selects(name),
                    "{name} is not selected: {}",
                    here()
                );
            }
            // SS2 that is deselected brakes to its end, and is SOS for a cycle at least (reading AF-17); the SOS of a stop ends a cycle after it.
            let ends = before.1.tells("SS2 active") || before.1.tells("Internal Event");
            let held = ["SOS", "SS2", "SS2E"]
                .map(|name| word.selects(name))
                .contains(&true)
                || ends;
            assert!(
                !tells("SOS active") || held || tells("Internal Event"),
                "nothing asks for SOS: {}",
                here()
            );
        }

        // An internal event ends by the falling edge of its bit, or by STO or SS1 deselected with p9507.0 = 1.
        if before.1.tells("Internal Event") && !tells("Internal Event") {
            let fell = before.0.asks("Internal Event ACK") && !word.asks("Internal Event ACK");
            let selected = |word: Word| word.selects("STO") || word.selects("SS1");
            let again = axis.extended && selected(before.0) && !selected(word);
            assert!(fell || again, "nothing has acknowledged: {}", here());
        }

        // At standstill with nothing selected no cause is left: the falling edge of the bit ends the event.
        let ack = [before.0, word].map(|word| word.asks("Internal Event ACK"));
        let selected = FUNCTIONS.iter().any(|name| word.selects(name));
        self.quiet = counted(self.quiet, fresh && way == 0 && !selected);
        self.rose = self.quiet > 3 && (self.rose || ack == [false, true]);
        if self.rose && ack == [true, false] {
            assert!(
                !tells("Internal Event"),
                "what was acknowledged stays: {}",
                here()
            );
        }

        if let Some((limits, window)) = axis.lengths {
            // A speed above the limit of the active level is an event in its cycle, and so is a position outside the window.
            let monitors = tells("SLS active") && before.1.tells("SLS active");
            if monitors && told.level() == before.1.level() {
                let above = way.unsigned_abs() > limits[told.level()] + 1;
                assert!(
                    !above || tells("Internal Event"),
                    "faster than SLS allows: {}",
                    here()
                );
            }
            self.stands = match (tells("SOS active"), self.stands) {
                (true, None) => Some(self.position),
                (true, place) => place,
                (false, _) => None,
            };
            if let Some(place) = self.stands {
                let left = self.position.abs_diff(place) > window;
                assert!(
                    !left || tells("Internal Event"),
                    "outside the window of SOS: {}",
                    here()
                );
            }
        }

        // SLS that stays selected monitors after p9551, with its level.
        let calm = fresh
            && stops == [false; 5]
            && word.selects("SLS")
            && word.level() == before.0.level()
            && !["STO active", "SS1 active", "SOS active", "Internal Event"]
                .map(tells)
                .contains(&true);
        self.sls = counted(self.sls, calm);
        if self.sls > axis.p9551 + 2 {
            assert!(
                tells("SLS active") && told.level() == word.level(),
                "SLS is not monitored: {}",
                here()
            );
        }

        self.failed &= tells("STO active");
        (self.sent, self.told) = (word, told);
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

/// The machine, and those of its axes that have a safety telegram and Extended Functions.
static MACHINES: LazyLock<(Machine, Vec<(usize, Axis)>)> = LazyLock::new(|| {
    let path = crate::root().join(MACHINE);
    let machine = machine::load(&path, &families(&path)).unwrap_or_else(|e| panic!("{e}"));
    let known = machine.axes.iter().enumerate();
    let driven =
        known.filter(|(k, axis)| axis.has("motion monitoring") && OnBus::new(&machine, *k).is_ok());
    let axes = driven
        .map(|(k, axis)| (k, Axis::of(&machine, axis)))
        .collect();
    (machine, axes)
});

/// See [`drive`].
///
/// # Panics
/// If an answer is none that the manual allows.
pub fn run(data: &[u8]) -> Count {
    let (machine, axes) = &*MACHINES;
    let mut count = Count::default();
    let Some((first, data)) = data.split_first() else {
        return count;
    };
    let (k, axis) = &axes[usize::from(*first) % axes.len()];
    let mut drive = OnBus::new(machine, *k).unwrap_or_else(|e| panic!("{e}"));
    let short = drive.telegram() == Telegram::T30;
    let length = if short { 2 } else { 4 };
    // Every bit that selects is 1, all others 0.
    let mut free = Word { short, raw: 0 };
    for name in FUNCTIONS.iter().filter(|name| !(short && **name == "SS2E")) {
        free.raw |= 1 << place(words(short)[0], name);
    }
    let mut control = free;
    let mut seen = Seen {
        sent: free,
        told: Word { short, raw: 0 },
        ..Seen::default()
    };
    let mut speed = 0_i64;
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
        match what % 16 {
            // Nothing is selected any more, and the axis stands.
            2 => (control, speed) = (free, 0),
            3 => control.raw ^= 1 << place(words(short)[0], "Internal Event ACK"),
            _ => {}
        }
        // Nothing, too little, or a telegram.
        let comes = match what % 16 {
            0 => 0,
            1 => length - 1,
            _ => length,
        };
        for _ in 0..=times % 64 {
            let bytes = control.raw.to_le_bytes();
            let frame = (comes > 0).then(|| &bytes[..comes]);
            let whole = comes == length;
            count.telegrams += u64::from(whole);
            if (seen.position + speed).abs() > 100_000_000 {
                speed = -speed;
            }
            let position = (seen.position + speed) as i32;
            let around = Around {
                position,
                on: what / 16 != 15,
            };
            let answer = drive.step(frame, around);
            let mut raw = [0; 4];
            raw[..length].copy_from_slice(&answer.bytes()[..length]);
            let told = Word {
                short,
                raw: u32::from_le_bytes(raw),
            };
            count.told |= told.raw;
            seen.judge(axis, whole.then_some(control), speed, told);
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
