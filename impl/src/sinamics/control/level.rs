//! The levels of the stop responses, and what of the safety functions counts against them.

fields! {
    /// A stop response, in rising priority (S120-STOP-509, table 9-2). STOP F is none of them: it is a timer beside the level
    /// (S120-STOP-523).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Stop {
        /// None.
        #[default]
        None,
        /// Extended stop and retract, then standstill (S120-STOP-504).
        E,
        /// The controller brakes, then standstill (S120-STOP-503).
        D,
        /// Braking along the OFF3 ramp, then standstill (S120-STOP-502).
        C,
        /// Braking along the OFF3 ramp, then STOP A (S120-STOP-501).
        B,
        /// Pulses off at once (S120-STOP-500).
        A,
        /// A STOP A that POWER ON alone acknowledges (S120-ACK-506).
        Locked,
    }
}

impl Stop {
    /// The stop of a configured response (p9562, p9563, p9566), and whether it delays the pulse cancellation when the bus fails: 0 to 4
    /// are STOP A to E, 10 to 14 the same with the delay (S120-STOP-518; the manual prints 0 and 1, and that codes from 10 on
    /// delay). `None` for any other code.
    pub const fn of_code(code: u32) -> Option<(Self, bool)> {
        let stop = match code % 10 {
            0 => Self::A,
            1 => Self::B,
            2 => Self::C,
            3 => Self::D,
            4 => Self::E,
            _ => return None,
        };
        if code < 20 {
            Some((stop, code >= 10))
        } else {
            None
        }
    }

    /// Whether it ends in standstill with pulses.
    pub const fn ends_in_standstill(self) -> bool {
        matches!(self, Self::E | Self::D | Self::C)
    }

    /// The one that corresponds to no function below it and no pulses: STOP A, acknowledgeable or not.
    pub const fn cancels_pulses(self) -> bool {
        matches!(self, Self::A | Self::Locked)
    }
}

fields! {
    /// The safety function that decides: the topmost row of table 9-3 that is active.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Function {
        /// None.
        #[default]
        None,
        /// SLS, SDI or SLP (S120-STOP-515, S120-STOP-526).
        Watching,
        /// SOS (S120-STOP-514), also that in which SS2 and SS2E have ended.
        Sos,
        /// SS2E before it has ended in SOS (S120-STOP-526).
        Ss2e,
        /// SS2 that brakes (S120-STOP-513).
        Ss2,
        /// SS1 (S120-STOP-512).
        Ss1,
        /// STO (S120-STOP-511).
        Sto,
    }
}

impl Function {
    /// Whether the function goes on unchanged when this stop is requested: its cell of table 9-3 shows the function.
    pub const fn covers(self, stop: Stop) -> bool {
        let highest = match self {
            Self::None | Self::Watching => return false,
            // SOS is the end of STOP C too, so it stays.
            Self::Sos | Self::Ss2 => Stop::C,
            Self::Ss2e => Stop::D,
            Self::Ss1 => Stop::B,
            Self::Sto => Stop::A,
        };
        stop as u8 <= highest as u8
    }

    /// Whether the function, when it is selected, takes the place of this running stop: it is of a higher class
    /// (S120-STOP-517). One of the same class leaves the stop's ramp and timer alone (S120-STOP-524).
    pub const fn displaces(self, stop: Stop) -> bool {
        let class = match self {
            Self::None | Self::Watching | Self::Sos | Self::Ss2e => return false,
            Self::Ss2 => Stop::C,
            Self::Ss1 => Stop::B,
            Self::Sto => Stop::A,
        };
        (stop as u8) < class as u8
    }

    /// Whether STOP F is followed by STOP B while it is active (S120-STOP-506; reading AC-04 GUARD_ANY_MONITOR).
    pub const fn follows_up(self) -> bool {
        matches!(self, Self::Watching | Self::Sos | Self::Ss2e | Self::Ss2)
    }

    /// Whether it brakes by itself to pulses off, so that STOP F has no follow-up (S120-STOP-512, S120-STOP-511).
    pub const fn ends_without_pulses(self) -> bool {
        matches!(self, Self::Ss1 | Self::Sto)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-STOP-518: the printed codes 0 and 1, those of the examples, and from 10 on.
    #[test]
    fn the_codes_of_the_responses() {
        let codes = [0, 1, 2, 10, 14].map(Stop::of_code);
        let stops = [Stop::A, Stop::B, Stop::C, Stop::A, Stop::E].map(Some);
        assert_eq!(codes.map(|code| code.map(|(stop, _)| stop)), stops);
        assert_eq!(
            codes.map(|code| code.is_some_and(|(_, delayed)| delayed)),
            [false, false, false, true, true]
        );
        assert_eq!([5, 9, 15, 20, u32::MAX].map(Stop::of_code), [None; 5]);
    }

    /// S120-STOP-509, S120-STOP-510, S120-STOP-511, S120-STOP-512, S120-STOP-513, S120-STOP-514, S120-STOP-515: table 9-3 as it
    /// is printed; the cells in which the function goes on are those with its name.
    #[test]
    fn the_printed_table_of_priorities() {
        let stops = [Stop::A, Stop::B, Stop::C, Stop::D, Stop::E];
        let rows = [
            (Function::Sto, "STO STO STO STO STO"),
            (Function::Ss1, "A SS1 SS1 SS1 SS1"),
            (Function::Ss2, "A B SS2 SS2 SS2"),
            (Function::Sos, "A B SOS SOS SOS"),
            (Function::Watching, "A B C D E"),
        ];
        for (function, cells) in rows {
            for (stop, cell) in stops.into_iter().zip(cells.split(' ')) {
                assert_eq!(
                    function.covers(stop),
                    cell.len() > 1,
                    "{function:?} {stop:?}"
                );
            }
        }
        assert!(stops.is_sorted_by(|high, low| high > low));
    }
}
