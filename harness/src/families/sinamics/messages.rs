//! The safety messages of a channel.

/// The messages that the monitors have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Message {
    /// STOP A of the Basic Functions.
    BasicA,
    /// The channels of the Basic Functions differ.
    BasicF,
    /// The brake.
    Brake,
    A,
    B,
    /// SAM or SBR is violated.
    Ramp,
    Sos,
    C,
    D,
    E,
    /// The channels differ: STOP F.
    Crosscheck,
    Sls,
    Slp,
    Sdi,
    /// A test stop, a test of the switch-off paths is due.
    TestStop,
    PathTest,
    /// The brake test was interrupted.
    BrakeTestInterrupted,
}

/// Their numbers in channel 1 and their twins in channel 2; an alarm of the drive has none.
const NUMBERS: [(Message, &str, &str); 17] = [
    (Message::BasicA, "F01600", "F30600"),
    (Message::BasicF, "F01611", "F30611"),
    (Message::Brake, "F01630", "F30630"),
    (Message::A, "C01700", "C30700"),
    (Message::B, "C01701", "C30701"),
    (Message::Ramp, "C01706", "C30706"),
    (Message::Sos, "C01707", "C30707"),
    (Message::C, "C01708", "C30708"),
    (Message::D, "C01709", "C30709"),
    (Message::E, "C01710", "C30710"),
    (Message::Crosscheck, "C01711", "C30711"),
    (Message::Sls, "C01714", "C30714"),
    (Message::Slp, "C01715", "C30715"),
    (Message::Sdi, "C01716", "C30716"),
    (Message::TestStop, "A01697", ""),
    (Message::PathTest, "A01699", ""),
    (Message::BrakeTestInterrupted, "A01782", ""),
];

/// Messages of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Messages(u32);

impl Messages {
    /// These and one more, where it comes.
    pub(super) fn with(self, message: Message, comes: bool) -> Self {
        Self(self.0 | u32::from(comes) << message as u16)
    }

    /// Those of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those of the Basic Functions, or those of the Extended ones, which an acknowledgement ends.
    pub(super) fn of(self, basic: bool) -> Self {
        // The first three, and up to the directions.
        const BASIC: u32 = 0b111;
        const EXTENDED: u32 = (2 << Message::Sdi as u32) - 1 - BASIC;
        Self(self.0 & if basic { BASIC } else { EXTENDED })
    }

    /// That of the brake test.
    pub(super) fn of_brake_test(self) -> Self {
        Self(self.0 & (1 << Message::BrakeTestInterrupted as u32))
    }

    /// This one is among them.
    pub(super) fn has(self, message: Message) -> bool {
        self.0 >> message as u16 & 1 == 1
    }
}

/// Their numbers.
pub(super) fn text(messages: Messages, side: usize) -> String {
    let set = NUMBERS.iter().filter(|(m, ..)| messages.has(*m));
    let numbers: Vec<&str> = set
        .map(|(_, first, second)| if side == 0 { *first } else { *second })
        .filter(|number| !number.is_empty())
        .collect();
    numbers.join(" ")
}

/// Every number with its channel.
pub(super) fn numbers() -> Vec<(String, usize)> {
    let both = NUMBERS
        .iter()
        .flat_map(|(_, first, second)| [(first, 0), (second, 1)]);
    both.filter(|(number, _)| !number.is_empty())
        .map(|(number, side)| ((*number).to_owned(), side))
        .collect()
}
