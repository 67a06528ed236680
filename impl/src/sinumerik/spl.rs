//! The comparison of NCK-SPL and PLC-SPL of one channel: all 320 signals, the alarm and the stop.
//!
//! ```text
//! spl_protection -> spl_signal, 320 times -> spl_comparison
//! ```
//!
//! It adds no behaviour of its own: it hands the signals to their monitors and the first number that they find to the comparison.
//! A channel compares its own signals with those that the other one has sent last; it keeps these until the next exchange
//! (S840D-SPLKDV-012). Both channels do the same, each with its own clock, settings and stop.
//!
//! Bound on the work of a cycle: each of the 322 monitors steps once; the only loop is over the signals.

use crate::sinumerik::spl_comparison::{self, Number};
use crate::sinumerik::{spl_protection, spl_signal};

/// The signals that are compared: five blocks of 64 (S840D-SPL-002).
pub const SIGNALS: usize = 320;

/// A block of signals, in the order of their numbers (S840D-SPLKDV-009). Timers and the single-channel signals are in none:
/// they are not compared (S840D-SPL-002).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// External inputs.
    Inse,
    /// External outputs.
    Outse,
    /// Internal inputs.
    Insi,
    /// Internal outputs.
    Outsi,
    /// Markers.
    Markersi,
}

impl Block {
    /// All of them in the order of their numbers.
    pub const ALL: [Self; 5] = [
        Self::Inse,
        Self::Outse,
        Self::Insi,
        Self::Outsi,
        Self::Markersi,
    ];

    /// How many signals each of them has, whatever an option releases of them (S840D-SPL-002).
    pub const LEN: u16 = 64;

    /// The number of signal 1 to 64 of the block; [`Number::NONE`] for another one (S840D-SPLKDV-009).
    pub const fn number(self, signal: u16) -> Number {
        if signal == 0 || signal > Self::LEN {
            return Number::NONE;
        }
        Number::new(self as u16 * Self::LEN + signal)
    }
}

/// Byte and bit in DB18 of the signal with this number in `SPL_DATA`, and the byte in `SPL_DELTA`, which has the same bit
/// (S840D-SPLKDV-010); `None` for no signal.
pub const fn place(number: Number) -> Option<(u16, u16, u8)> {
    match number.get().checked_sub(1) {
        None => None,
        Some(place) => Some((38 + place / 8, 78 + place / 8, (place % 8) as u8)),
    }
}

/// A bit for each signal, in the order of their numbers. After run-up all are 0 (S840D-SPLSTART-013).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Data {
    words: [u32; SIGNALS / 32],
}

impl Data {
    /// The bit of a signal; 0 for no signal.
    pub fn get(&self, number: Number) -> bool {
        let place = usize::from(number.get()).wrapping_sub(1);
        self.words
            .get(place / 32)
            .is_some_and(|word| word >> (place % 32) & 1 == 1)
    }

    /// Sets the bit of a signal; nothing for no signal.
    pub fn set(&mut self, number: Number, value: bool) {
        let place = usize::from(number.get()).wrapping_sub(1);
        if let Some(word) = self.words.get_mut(place / 32) {
            *word = *word & !(1 << (place % 32)) | u32::from(value) << (place % 32);
        }
    }

    /// The signals of the NCK after run-up. With bit 0 of MD 10095 (`ones`) the internal inputs of a group of 32 are 1 where a
    /// variable of the group is an axial output (`used`): so they were in earlier versions, and the program of the PLC must
    /// set its own (S840D-SPL-011). All else is 0 (S840D-SPLSTART-013).
    pub const fn after_run_up(ones: bool, used: [bool; 2]) -> Self {
        let mut words = [0; SIGNALS / 32];
        let first = Block::Insi as usize * 2;
        let mut group = 0;
        while group < 2 {
            if ones && used[group] {
                words[first + group] = u32::MAX;
            }
            group += 1;
        }
        Self { words }
    }

    /// How many are 1.
    pub fn ones(&self) -> u16 {
        self.words
            .iter()
            .map(|word| word.count_ones() as u16)
            .fold(0, u16::saturating_add)
    }
}

/// The inputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Power-on of the control.
    pub power_on: bool,
    /// NC-RESET.
    pub reset: bool,
    /// The comparison has been started.
    pub running: bool,
    /// The signals of this channel.
    pub own: Data,
    /// Those of the other channel, in the cycles of the exchange (S840D-SPLKDV-012).
    pub received: Option<Data>,
    /// `CMDSI` of this channel.
    pub cmd: bool,
    /// See [`spl_protection::Inputs::lock`].
    pub lock: bool,
    /// See [`spl_protection::Inputs::choice`].
    pub choice: bool,
    /// The other channel is protected.
    pub protected_other: bool,
    /// The other channel stops with STOP E.
    pub stop_e_other: bool,
    /// Communication has failed.
    pub lost: bool,
}

/// The outputs of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// `SPL_DELTA`: what differs now (S840D-SPLKDV-010).
    pub delta: Data,
    /// `LEVELSI`: how many signals differ now (S840D-SPLKDV-010).
    pub level: u16,
    /// The settings of this channel, and whether alarm 27095 is raised.
    pub protection: spl_protection::Outputs,
    /// Alarm 27090.
    pub alarm: bool,
    /// `STATSI`.
    pub number: Number,
    /// The stop on all SI axes, and the settings that do not match.
    pub comparison: spl_comparison::Outputs,
}

/// The comparison of one channel: the images of the other one, and the state of every monitor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    config: spl_signal::Config,
    image: Data,
    signals: [spl_signal::State; SIGNALS],
    protection: spl_protection::State,
    comparison: spl_comparison::State,
}

impl Channel {
    /// Before the first power-on.
    pub const fn new(config: spl_signal::Config) -> Self {
        Self {
            config,
            image: Data {
                words: [0; SIGNALS / 32],
            },
            signals: [spl_signal::State::INITIAL; SIGNALS],
            protection: spl_protection::State::INITIAL,
            comparison: spl_comparison::State::INITIAL,
        }
    }

    /// The signals of the other channel as this one has them (`$A_xxxP`, S840D-SPLKDV-012).
    pub const fn image(&self) -> &Data {
        &self.image
    }

    /// Advances the comparison by one cycle.
    pub fn step(&mut self, inputs: &Inputs) -> Outputs {
        if inputs.power_on {
            self.image = Data::default();
        }
        if let Some(received) = inputs.received {
            self.image = received;
        }
        let (power_on, reset, running) = (inputs.power_on, inputs.reset, inputs.running);
        let (after, protection) = spl_protection::next(
            self.protection,
            &spl_protection::Config,
            &spl_protection::Inputs {
                power_on,
                running,
                lock: inputs.lock,
                choice: inputs.choice,
            },
        );
        self.protection = after;
        let mut delta = Data::default();
        let mut found = Number::NONE;
        for (number, state) in (1..).map(Number::new).zip(&mut self.signals) {
            let (after, signal) = spl_signal::next(
                *state,
                &self.config,
                &spl_signal::Inputs {
                    power_on,
                    reset,
                    running,
                    own: inputs.own.get(number),
                    other: self.image.get(number),
                    cmd: inputs.cmd,
                },
            );
            *state = after;
            delta.set(number, signal.unequal);
            if signal.found && !found.is_some() {
                found = number;
            }
        }
        let (after, comparison) = spl_comparison::next(
            self.comparison,
            &spl_comparison::Config,
            &spl_comparison::Inputs {
                power_on,
                reset,
                running,
                found,
                protected: protection.protected,
                protected_other: inputs.protected_other,
                stop_e: protection.stop_e,
                stop_e_other: inputs.stop_e_other,
                lost: inputs.lost,
            },
        );
        self.comparison = after;
        Outputs {
            delta,
            level: delta.ones(),
            protection,
            alarm: after.alarm,
            number: after.number,
            comparison,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Cycles;
    use crate::sinumerik::level::ExternalStop;

    const PLAIN: u32 = 2;

    fn channel() -> Channel {
        let config = spl_signal::Config::new(Cycles::new(PLAIN), Cycles::new(5)).expect("short");
        let mut channel = Channel::new(config);
        let on = Inputs {
            power_on: true,
            lock: true,
            ..calm()
        };
        channel.step(&on);
        channel
    }

    fn calm() -> Inputs {
        Inputs {
            running: true,
            received: Some(Data::default()),
            protected_other: true,
            ..Inputs::default()
        }
    }

    fn only(number: Number) -> Data {
        let mut data = Data::default();
        data.set(number, true);
        data
    }

    /// S840D-SPL-002, S840D-SPLKDV-001, S840D-SPLKDV-004, S840D-SPLKDV-009, S840D-SPLKDV-010: every one of the 320 signals by
    /// itself, in either channel. Among them a marker that stays at 1 in the NCK and is 0 in the PLC, such as the Q2 of a
    /// relay (S840D-RELAY-019).
    #[test]
    fn each_signal_is_compared_and_has_its_number() {
        let numbers = Block::ALL.map(|block| (1..=Block::LEN).map(move |k| block.number(k)));
        let numbers = numbers.into_iter().flatten();
        let mut met = 0;
        for (number, expected) in numbers.zip(1..) {
            met += 1;
            assert_eq!(number.get(), expected);
            for here in [true, false] {
                let mut channel = channel();
                let inputs = Inputs {
                    own: if here { only(number) } else { Data::default() },
                    received: Some(if here { Data::default() } else { only(number) }),
                    ..calm()
                };
                for cycle in 0..=PLAIN {
                    let outputs = channel.step(&inputs);
                    assert!(!outputs.alarm, "{expected} {cycle}");
                    assert_eq!((outputs.level, outputs.delta), (1, only(number)));
                }
                let outputs = channel.step(&inputs);
                assert!(outputs.alarm);
                assert_eq!(outputs.number, number);
                assert_eq!(outputs.comparison.request, ExternalStop::D);
            }
        }
        assert_eq!(met, SIGNALS);
        assert_eq!(Block::Inse.number(0), Number::NONE);
        assert_eq!(Block::Inse.number(65), Number::NONE);
    }

    /// S840D-SPL-001: two channels with a program each, of which each compares; the one that does not do what the other does is
    /// found by both, in the same cycle where both hear each other at once.
    #[test]
    fn both_channels_find_the_program_that_differs() {
        let mut channels = [channel(), channel()];
        let data = [only(Number::new(70)), Data::default()];
        for cycle in 0..=PLAIN + 1 {
            for (here, there) in [(0, 1), (1, 0)] {
                let inputs = Inputs {
                    own: data[here],
                    received: Some(data[there]),
                    ..calm()
                };
                let outputs = channels[here].step(&inputs);
                assert_eq!(outputs.alarm, cycle == PLAIN + 1);
                assert_eq!(
                    outputs.comparison.request != ExternalStop::None,
                    outputs.alarm
                );
            }
        }
    }

    /// S840D-SPLKDV-017: of two errors in one cycle the one with the lower number is shown, and it stays.
    #[test]
    fn the_first_number_is_shown() {
        let mut channel = channel();
        let mut own = only(Number::new(300));
        own.set(Number::new(17), true);
        let inputs = Inputs { own, ..calm() };
        for _ in 0..=PLAIN {
            assert_eq!(channel.step(&inputs).number, Number::NONE);
        }
        assert_eq!(channel.step(&inputs).number, Number::new(17));
        own.set(Number::new(3), true);
        for _ in 0..=PLAIN + 2 {
            let outputs = channel.step(&Inputs { own, ..calm() });
            assert_eq!((outputs.number, outputs.level), (Number::new(17), 3));
        }
        let reset = Inputs {
            reset: true,
            ..calm()
        };
        let outputs = channel.step(&reset);
        assert!(!outputs.alarm && !outputs.number.is_some());
    }

    /// S840D-SPLKDV-012: without an exchange a channel compares with what it has.
    #[test]
    fn images_stay_until_the_exchange() {
        let mut channel = channel();
        let sent = only(Number::new(5));
        let with = Inputs {
            own: sent,
            received: Some(sent),
            ..calm()
        };
        assert_eq!(channel.step(&with).level, 0);
        let without = Inputs {
            received: None,
            ..with
        };
        assert_eq!(channel.step(&without).level, 0);
        assert_eq!(channel.image(), &sent);
        let alone = Inputs {
            own: Data::default(),
            ..without
        };
        assert_eq!(channel.step(&alone).level, 1);
    }

    /// S840D-SPL-011, S840D-SPLSTART-013: in each group, by each bit of it.
    #[test]
    fn inputs_are_preset_in_groups() {
        for [first, second] in [[false, false], [true, false], [false, true], [true, true]] {
            assert_eq!(Data::after_run_up(false, [first, second]), Data::default());
            let data = Data::after_run_up(true, [first, second]);
            for block in Block::ALL {
                for signal in 1..=Block::LEN {
                    let group = if signal <= 32 { first } else { second };
                    let expected = block == Block::Insi && group;
                    assert_eq!(
                        data.get(block.number(signal)),
                        expected,
                        "{block:?} {signal}"
                    );
                }
            }
        }
    }

    /// S840D-SPLSTART-013.
    #[test]
    fn power_on_clears_the_images() {
        let mut channel = channel();
        channel.step(&Inputs {
            received: Some(only(Number::new(1))),
            ..calm()
        });
        channel.step(&Inputs {
            power_on: true,
            received: None,
            ..calm()
        });
        assert_eq!(channel.image(), &Data::default());
    }
}
