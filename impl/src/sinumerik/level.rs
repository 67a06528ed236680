//! The stops of the family in their priority: the level of a channel, internal and external requests.

fields! {
    /// The effective stop level of a channel, in rising priority (S840D-STOP-003).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Level {
        /// No stop.
        #[default]
        None,
        /// Cross comparison found a discrepancy; no motion reaction by itself.
        F,
        /// Extended stop and retract, then operating stop.
        E,
        /// Braking along the path, then operating stop.
        D,
        /// Braking at the current limit, then operating stop.
        C,
        /// Test of the shutdown path.
        Test,
        /// Braking at the current limit, then pulse cancellation.
        B,
        /// Pulse cancellation.
        A,
    }
}

impl Level {
    /// The number of the level in the cross comparison: 0 (none) to 7 (A).
    pub const fn rank(self) -> u8 {
        match self {
            Self::None => 0,
            Self::F => 1,
            Self::E => 2,
            Self::D => 3,
            Self::C => 4,
            Self::Test => 5,
            Self::B => 6,
            Self::A => 7,
        }
    }

    /// The higher of the two levels.
    pub const fn max(self, other: Self) -> Self {
        if self.rank() >= other.rank() {
            self
        } else {
            other
        }
    }

    /// The stop category of EN 60204-1 (S840D-STOP-008): 0 without braking, 1 braked and then without power, 2 braked and
    /// then held with power. STOP F has none of its own: it is of category 1 where it triggers STOP B. A test stop is no
    /// stop of the machine.
    pub const fn category(self) -> Option<u8> {
        match self {
            Self::A => Some(0),
            Self::B => Some(1),
            Self::C | Self::D | Self::E => Some(2),
            Self::None | Self::F | Self::Test => None,
        }
    }

    /// Whether the stop ends in the operating stop: E, D or C.
    pub const fn ends_in_standstill(self) -> bool {
        matches!(self, Self::E | Self::D | Self::C)
    }
}

fields! {
    /// A stop raised inside a channel: latched until it is acknowledged (S840D-STOP-001). There is no internal test stop,
    /// and STOP F is a machine of its own ([`crate::sinumerik::fault`]).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum InternalStop {
        /// No stop.
        #[default]
        None = 0,
        /// STOP E.
        E = 2,
        /// STOP D.
        D = 3,
        /// STOP C.
        C = 4,
        /// STOP B.
        B = 6,
        /// STOP A.
        A = 7,
    }
}

impl InternalStop {
    /// The place of the stop in the common order.
    pub const fn level(self) -> Level {
        match self {
            Self::None => Level::None,
            Self::E => Level::E,
            Self::D => Level::D,
            Self::C => Level::C,
            Self::B => Level::B,
            Self::A => Level::A,
        }
    }

    /// The internal stop of a level; `None` for the levels F and TEST, which are no internal stops.
    pub const fn from_level(level: Level) -> Option<Self> {
        match level {
            Level::None => Some(Self::None),
            Level::E => Some(Self::E),
            Level::D => Some(Self::D),
            Level::C => Some(Self::C),
            Level::B => Some(Self::B),
            Level::A => Some(Self::A),
            Level::F | Level::Test => None,
        }
    }

    /// The higher of the two stops.
    pub const fn max(self, other: Self) -> Self {
        if self.level().rank() >= other.level().rank() {
            self
        } else {
            other
        }
    }
}

fields! {
    /// A stop requested by signals: lasts as long as its request. There is no external STOP B (S840D-STOP-088).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum ExternalStop {
        /// No stop.
        #[default]
        None = 0,
        /// STOP E.
        E = 2,
        /// STOP D.
        D = 3,
        /// STOP C.
        C = 4,
        /// STOP A.
        A = 7,
    }
}

impl ExternalStop {
    /// The place of the stop in the common order.
    pub const fn level(self) -> Level {
        match self {
            Self::None => Level::None,
            Self::E => Level::E,
            Self::D => Level::D,
            Self::C => Level::C,
            Self::A => Level::A,
        }
    }

    /// The external stop of a level; `None` for the levels F, TEST and B, which cannot be requested by signals.
    pub const fn from_level(level: Level) -> Option<Self> {
        match level {
            Level::None => Some(Self::None),
            Level::E => Some(Self::E),
            Level::D => Some(Self::D),
            Level::C => Some(Self::C),
            Level::A => Some(Self::A),
            Level::F | Level::Test | Level::B => None,
        }
    }

    /// The higher of the two stops.
    pub const fn max(self, other: Self) -> Self {
        if self.level().rank() >= other.level().rank() {
            self
        } else {
            other
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_orders_agree() {
        for pair in Level::ALL.windows(2) {
            assert!(pair[0] < pair[1] && pair[0].rank() < pair[1].rank());
        }
        for a in InternalStop::ALL {
            assert_eq!(InternalStop::from_level(a.level()), Some(a));
            for b in InternalStop::ALL {
                assert_eq!(a <= b, a.level() <= b.level());
                assert_eq!(a.max(b).level(), a.level().max(b.level()));
            }
        }
        for a in ExternalStop::ALL {
            assert_eq!(ExternalStop::from_level(a.level()), Some(a));
            for b in ExternalStop::ALL {
                assert_eq!(a <= b, a.level() <= b.level());
                assert_eq!(a.max(b).level(), a.level().max(b.level()));
            }
        }
    }
}
