//! The buffer of safety messages: eight cases of eight messages, the current case first.
//!
//! The index of message i of case k is 8 k + i, as in r9747 and its companions. What else is kept of a message stands at the same index,
//! which the caller moves alike.

pub use self::case::{Case, Count};

/// Messages in a case.
pub const MESSAGES: usize = 8;

config! {
    /// Nothing is set.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

mod case {
    use super::MESSAGES;

    fields! {
        /// The number of messages in a case.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct Count(u8) in 0..=8;
    }

    fields! {
        /// The messages of a case, in the order of their occurrence.
        #[derive(Clone, Copy, Debug, Default, Eq, Hash)]
        #[allow(
            clippy::derived_hash_with_manual_eq,
            reason = "equal ones are the same as if that were derived"
        )]
        pub struct Case {
            /// How many there are.
            pub count: Count,
            /// Their codes; those behind the number mean nothing.
            pub codes: [u16; 8],
        }
    }

    impl Case {
        /// No message.
        pub const EMPTY: Self = Self {
            count: Count(0),
            codes: [0; MESSAGES],
        };

        /// The number of messages.
        pub const fn len(&self) -> usize {
            self.count.0 as usize
        }

        /// Whether there is none.
        pub const fn is_empty(&self) -> bool {
            self.count.0 == 0
        }

        /// The codes of the messages.
        pub fn messages(&self) -> &[u16] {
            self.codes.get(..self.len()).unwrap_or(&self.codes)
        }

        /// The code of the message at a place below [`MESSAGES`].
        pub(super) const fn code(&self, place: usize) -> u16 {
            // `place` is below the length.
            #[allow(clippy::indexing_slicing)]
            self.codes[place]
        }

        /// Whether there are the same messages; what stands behind them means nothing.
        pub(super) const fn same_messages(&self, other: &Self) -> bool {
            let mut same = self.len() == other.len();
            let mut place = 0;
            while place < MESSAGES {
                same &= place >= self.len() || self.code(place) == other.code(place);
                place += 1;
            }
            same
        }

        /// With a message behind the others, or at the place of the eighth.
        pub(super) const fn pushed(mut self, code: u16) -> Self {
            let last = if self.len() < MESSAGES {
                self.len()
            } else {
                MESSAGES - 1
            };
            // Each place is compared, none is looked up: what is written at a symbolic one is the whole list to a bit-precise checker.
            let mut place = 0;
            while place < MESSAGES {
                if place == last {
                    // `place` is below the length.
                    #[allow(clippy::indexing_slicing)]
                    {
                        self.codes[place] = code;
                    }
                }
                place += 1;
            }
            self.count = Count(last as u8 + 1);
            self
        }

        /// Those at the places of the mask, and the others.
        pub(super) const fn divided(&self, mask: u8) -> (Self, Self) {
            let (mut chosen, mut others) = (Self::EMPTY, Self::EMPTY);
            // Every place, for the same reason: the end of the messages is a symbolic one.
            let mut place = 0;
            while place < MESSAGES {
                if place < self.len() {
                    if (mask >> place) & 1 == 1 {
                        chosen = chosen.pushed(self.code(place));
                    } else {
                        others = others.pushed(self.code(place));
                    }
                }
                place += 1;
            }
            (chosen, others)
        }
    }

    impl PartialEq for Case {
        fn eq(&self, other: &Self) -> bool {
            // By places: a comparison of the bytes is many times as much for a model checker to execute.
            let mut same = self.len() == other.len();
            let mut place = 0;
            while place < MESSAGES {
                same &= self.code(place) == other.code(place);
                place += 1;
            }
            same
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// Case 0, the current one.
        pub current: Case,
        /// Cases 1 to 7, acknowledged; the latest first.
        pub acknowledged: [Case; 7],
        /// How often the buffer has changed, r9744; begins anew behind the last number.
        pub changes: u16,
    }
}

impl State {
    /// Empty.
    pub const INITIAL: Self = Self {
        current: Case::EMPTY,
        acknowledged: [Case::EMPTY; 7],
        changes: 0,
    };

    /// Every state is possible.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON, which sets p9752 to 0.
        pub power_on: bool,
        /// p9752 = 0 is written.
        pub clear: bool,
        /// The code of a message that comes; 0: none.
        pub message: u16,
        /// An effective acknowledgement.
        pub acknowledge: bool,
        /// The messages of the current case whose causes are gone, by place.
        pub rectified: u8,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A safety message is present, r2139.5.
        pub present: bool,
        /// The buffer has changed: it may be read.
        pub changed: bool,
    }
}

monitor! { sinamics::message_buffer;
    /// A message goes behind those of the current case; the ninth takes the place of the eighth.
    message_is_entered ["S120-MSG-502", "S120-MSG-501"]:
        when |s| s.inputs.message != 0 && !s.inputs.acknowledge && !s.inputs.power_on && !s.inputs.clear
            => {
                let last = s.before.current.len().min(MESSAGES - 1);
                s.after.acknowledged == s.before.acknowledged
                    && s.after.current.len() == last + 1
                    && (0..MESSAGES).all(|place| {
                        place > last
                            || s.after.current.code(place)
                                == if place < last { s.before.current.code(place) } else { s.inputs.message }
                    })
            };

    /// Acknowledged messages whose causes are gone make case 1, and the older cases go on by one.
    rectified_messages_make_a_case ["S120-MSG-505", "S120-ACK-513"]:
        when |s| s.inputs.acknowledge && !s.before.current.divided(s.inputs.rectified).0.is_empty() && !s.inputs.power_on
            && !s.inputs.clear
            => s.after.acknowledged[0] == s.before.current.divided(s.inputs.rectified).0
                && s.after.acknowledged[1..] == s.before.acknowledged[..6];

    /// The others stay in the current case.
    unrectified_messages_stay ["S120-MSG-505", "S120-ACK-513", "S120-PC-10"]:
        when |s| s.inputs.acknowledge && s.inputs.message == 0 && !s.inputs.power_on && !s.inputs.clear
            => s.after.current.same_messages(&s.before.current.divided(s.inputs.rectified).1);

    /// An acknowledgement of nothing that is rectified changes nothing.
    nothing_rectified_nothing_moves ["S120-ACK-513"]:
        when |s| s.inputs.acknowledge && s.inputs.rectified == 0 && s.inputs.message == 0 && !s.inputs.power_on && !s.inputs.clear
            => s.after == s.before && !s.outputs.changed;

    /// Without an acknowledgement nothing is acknowledged.
    cases_move_by_acknowledgement_only ["S120-MSG-501", "S120-MSG-505"]:
        when |s| !s.inputs.acknowledge && !s.inputs.power_on && !s.inputs.clear
            => s.after.acknowledged == s.before.acknowledged && s.after.current.len() >= s.before.current.len();

    /// p9752 = 0 and POWER ON clear everything; a message of the same cycle comes after.
    clearing_empties ["S120-MSG-504"]:
        when |s| s.inputs.power_on || s.inputs.clear
            => s.after.acknowledged == [Case::EMPTY; 7]
                && if s.inputs.message == 0 {
                    s.after.current.is_empty()
                } else {
                    s.after.current.len() == 1 && s.after.current.code(0) == s.inputs.message
                };

    /// Each change counts.
    changes_are_counted ["S120-MSG-502", "S120-MSG-503", "S120-PC-23"]:
        when |s| s.outputs.changed
            => s.after.changes == s.before.changes.wrapping_add(1);

    /// Without a change the buffer is the same.
    unchanged_is_the_same ["S120-MSG-503", "S120-PC-23"]:
        when |s| !s.outputs.changed
            => s.after == s.before && s.inputs.message == 0;

    /// Messages are present exactly while the current case has one.
    presence_is_shown ["S120-MSG-503", "S120-PC-23"]:
        when |s| s.outputs.present || s.after.current.is_empty()
            => s.outputs.present != s.after.current.is_empty();
}

pub(crate) fn transition(state: State, _config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let mut after = state;
    if inputs.power_on || inputs.clear {
        after.current = Case::EMPTY;
        after.acknowledged = [Case::EMPTY; 7];
    } else if inputs.acknowledge {
        let (rectified, rest) = state.current.divided(inputs.rectified);
        if !rectified.is_empty() {
            after.current = rest;
            let [first, second, third, fourth, fifth, sixth, _] = state.acknowledged;
            after.acknowledged = [rectified, first, second, third, fourth, fifth, sixth];
        }
    }
    if inputs.message != 0 {
        after.current = after.current.pushed(inputs.message);
    }
    let changed = after != state || inputs.message != 0;
    if changed {
        after.changes = after.changes.wrapping_add(1);
    }
    let outputs = Outputs {
        present: !after.current.is_empty(),
        changed,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-MSG-501, S120-MSG-502, S120-MSG-505: the ninth message, and the ninth case.
    #[test]
    fn eight_cases_of_eight_messages() {
        let mut buffer = Monitor::new(Config);
        let message = |message| Inputs {
            message,
            ..Inputs::default()
        };
        for code in 1701..=1709 {
            buffer.step(&message(code));
        }
        let codes = [1701, 1702, 1703, 1704, 1705, 1706, 1707, 1709];
        assert_eq!(buffer.state().current.codes, codes);
        let acknowledge = Inputs {
            acknowledge: true,
            rectified: 0b1010_0101,
            ..Inputs::default()
        };
        buffer.step(&acknowledge);
        assert_eq!(
            buffer.state().acknowledged[0].codes,
            [1701, 1703, 1706, 1709, 0, 0, 0, 0]
        );
        assert_eq!(buffer.state().changes, 10);
        for _ in 0..7 {
            buffer.step(&message(1711));
            buffer.step(&acknowledge);
        }
        assert!(
            buffer
                .state()
                .acknowledged
                .iter()
                .all(|case| !case.is_empty())
        );
    }
}
