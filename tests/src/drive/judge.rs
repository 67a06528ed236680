//! What the manual says of an answer.

use super::axis::{Axis, Lengths};
use super::{FUNCTIONS, Word, counted};

/// What the host has sent in a cycle, and what the drive is.
#[derive(Clone, Copy, Default)]
pub(super) struct Given {
    /// A telegram, if one came.
    pub word: Option<Word>,
    /// Its limit of SLS, in 32767ths.
    pub limit: i16,
    /// The way of the axis in this cycle, and by how much the second encoder shows more than the first.
    pub way: i64,
    pub apart: i64,
}

/// What has been seen of a run.
#[derive(Default)]
pub(super) struct Seen {
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
    /// A run that begins with this control word.
    pub(super) fn new(sent: Word) -> Self {
        let told = Word { raw: 0, ..sent };
        Self {
            sent,
            told,
            ..Self::default()
        }
    }

    /// Where the axis is.
    pub(super) const fn position(&self) -> i64 {
        self.position
    }

    /// One cycle, and the answer.
    pub(super) fn judge(&mut self, axis: &Axis, given: &Given, told: Word) {
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
        if cycle.tells("SLS active") && before.tells("SLS active") && told.level() == before.level()
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
