//! A drive without encoder: its actual value is known while current flows, and after a suppression of the pulses it keeps itself off.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinamics::{encoderless, start_phase};

use super::signals::{Flag, Read};

/// The monitors.
pub(super) struct Bare {
    start: start_phase::Monitor,
    restart: encoderless::Monitor,
    /// What the channel makes of the currents: the way since it is known, and the position read in the cycle before.
    known: Position,
    before: Position,
    knows: bool,
    unselected: bool,
}

/// What they read beside the bits.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub position: Position,
    /// STO is selected.
    pub sto: bool,
    pub pulses: bool,
    /// ON/OFF1, and the drive is not inhibited from switching on.
    pub on: bool,
    /// p9560.
    pub shutdown: Speed,
}

/// What they tell.
#[derive(Clone, Copy, Default)]
pub(super) struct Told {
    /// Internal STO.
    pub internal: bool,
    /// The drive may be switched on.
    pub window: bool,
    /// There is an actual value.
    pub known: bool,
    /// It is not plausible: STOP F.
    pub wrong: bool,
    /// The minimum current has not come: C01711 with 1041.
    pub no_current: bool,
}

impl Bare {
    /// At POWER ON, or running.
    pub(super) fn new(
        (start, restart, unselected): (start_phase::Config, encoderless::Config, bool),
        running: bool,
        position: Position,
    ) -> Self {
        let on = start_phase::State {
            enabled: true,
            ..start_phase::State::INITIAL
        };
        let runs = encoderless::State {
            phase: encoderless::Phase::Run,
            came: true,
            ..encoderless::State::INITIAL
        };
        let (first, second) = match running {
            true => (on, runs),
            false => (start_phase::State::INITIAL, encoderless::State::INITIAL),
        };
        Self {
            start: resumed!(start_phase, start, first),
            restart: resumed!(encoderless, restart, second),
            known: position,
            before: position,
            knows: running,
            unselected,
        }
    }

    /// A function without selection is monitored: ON itself ends the suppression.
    pub(super) const fn unselected(&self) -> bool {
        self.unselected
    }

    /// One cycle: what they tell, and the position and the speed that the functions see.
    pub(super) fn step(&mut self, bits: &Read, seen: &Seen) -> (Told, Position, Speed) {
        let said = self.start.step(&start_phase::Inputs {
            pulses: seen.pulses,
            plausible: bits.is(Flag::Plausible),
        });
        let Position(moved) = Position(seen.position.0.wrapping_sub(self.before.0));
        self.before = seen.position;
        // The first value that is known is none of a speed.
        let evaluated = said.known && self.knows;
        self.knows = said.known;
        let speed = Speed(if evaluated { moved.unsigned_abs() } else { 0 });
        if evaluated {
            self.known = Position(self.known.0.wrapping_add(moved));
        }
        let selected = |flag| !bits.is(flag);
        let restart = self.restart.step(&encoderless::Inputs {
            sto: seen.sto,
            sls: selected(Flag::Sls),
            sdi: selected(Flag::SdiPositive) || selected(Flag::SdiNegative),
            // The machine knows it, a drive that coasts does not.
            still: moved.unsigned_abs() <= seen.shutdown.0,
            on: seen.on,
            pulses: seen.pulses,
            current: bits.is(Flag::Current),
        });
        let told = Told {
            internal: restart.sto,
            window: restart.window,
            known: said.known,
            wrong: said.stop_f,
            no_current: restart.no_current,
        };
        (told, self.known, speed)
    }
}
