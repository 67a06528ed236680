//! Which bit of an F module is which variable of the safe logic: the data of MD10386 to MD10389, MD13300 and MD13301.
//!
//! The net data of an F module are divided into sub-slots of 32 bits. A filter chooses bits of one sub-slot; the chosen ones are,
//! from the lowest to the highest, a row of external variables without gaps. From a module to `$A_INSE` the bits are packed
//! ([`Connection::take`]), from `$A_OUTSE` to a module they are spread ([`Connection::give`]). Both are pure, and work with at most
//! eight bits.
//!
//! Readings: AMB-19 FILTER_FF_IDENTITY (the default filter FFFFFFFFH is none: the variables are the first bits) and ASSIGN_MAX_8 (a
//! connection has at most eight variables, as the text of alarm 27203 says).

/// The external variables of one direction: 64 (S840D-SPLIO-001, S840D-PSPARAM-004).
pub const VARIABLES: u8 = 64;

/// The most variables of a connection (S840D-PSAFE-028).
pub const WIDEST: u8 = 8;

/// The filter that chooses nothing: its default (S840D-PSPARAM-006).
pub const NO_FILTER: u32 = u32::MAX;

/// Why a row of variables is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// The row itself, alarm 27203 (S840D-PSAFE-028): its upper end is below the lower one, one of them is 0 or above 64, or it has
    /// more than eight variables.
    Row,
    /// The filter chooses another number of bits than the row has variables, alarm 27205 (S840D-PSAFE-030).
    Number,
}

/// A row of external variables: MD10388 or MD10389, decimal 00aaabbb (S840D-PSPARAM-004, S840D-PSPARAM-005).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    lowest: u8,
    count: u8,
}

impl Row {
    /// The row that a machine datum says.
    ///
    /// # Errors
    /// [`Unfit::Row`] (S840D-PSAFE-028).
    pub const fn new(datum: u32) -> Result<Self, Unfit> {
        Self::between(datum % 1000, datum / 1000)
    }

    /// The row from the lowest to the highest variable, both included.
    ///
    /// # Errors
    /// [`Unfit::Row`] (S840D-PSAFE-028).
    pub const fn between(lowest: u32, highest: u32) -> Result<Self, Unfit> {
        let longest = WIDEST as u32;
        if lowest == 0
            || highest > VARIABLES as u32
            || highest < lowest
            || highest - lowest >= longest
        {
            return Err(Unfit::Row);
        }
        // Both are at most 64.
        Ok(Self {
            lowest: lowest as u8,
            count: (highest - lowest + 1) as u8,
        })
    }

    /// The number of its variables, 1 to 8.
    pub const fn count(self) -> u8 {
        self.count
    }

    /// Its variables as bits: variable n is bit n - 1 (S840D-SPLIO-003).
    pub const fn variables(self) -> u64 {
        first(self.count) << (self.lowest - 1)
    }
}

/// The lowest `count` bits; at most eight.
const fn first(count: u8) -> u64 {
    let whole = (1 << WIDEST) - 1;
    if count >= WIDEST {
        whole
    } else {
        whole & !(whole << count)
    }
}

/// A connection of a sub-slot with a row of variables: one index of the machine data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    row: Row,
    bits: u32,
}

impl Connection {
    /// `filter`: MD13300 or MD13301; `datum`: MD10388 or MD10389.
    ///
    /// # Errors
    /// See [`Unfit`] (S840D-PSAFE-028, S840D-PSAFE-030).
    pub const fn new(filter: u32, datum: u32) -> Result<Self, Unfit> {
        match Row::new(datum) {
            Ok(row) => Self::of(filter, row),
            Err(unfit) => Err(unfit),
        }
    }

    /// `filter`: MD13300 or MD13301.
    ///
    /// # Errors
    /// [`Unfit::Number`] (S840D-PSAFE-030).
    pub const fn of(filter: u32, row: Row) -> Result<Self, Unfit> {
        let bits = if filter == NO_FILTER {
            first(row.count) as u32
        } else {
            filter
        };
        if bits.count_ones() != row.count as u32 {
            return Err(Unfit::Number);
        }
        Ok(Self { row, bits })
    }

    /// The row of variables.
    pub const fn row(self) -> Row {
        self.row
    }

    /// The bits of the sub-slot that are used (S840D-PSPARAM-003, S840D-PSPARAM-006).
    pub const fn bits(self) -> u32 {
        self.bits
    }

    /// The highest bit that is used, 0 to 31.
    pub const fn highest(self) -> u8 {
        // At least one bit is used.
        (31 - self.bits.leading_zeros()) as u8
    }

    /// What the net data of a module say of `$A_INSE` and INSEP (S840D-PSPARAM-003, S840D-PSPARAM-004, S840D-PSAFE-001).
    pub const fn take(self, net: u32) -> u64 {
        let mut variables = 0;
        let mut place = 1 << (self.row.lowest - 1);
        let mut rest = self.bits;
        let mut done = 0;
        while done < WIDEST && rest != 0 {
            let bit = rest & rest.wrapping_neg();
            if net & bit != 0 {
                variables |= place;
            }
            rest ^= bit;
            place <<= 1;
            done += 1;
        }
        variables
    }

    /// What `$A_OUTSE` and OUTSEP together say to a module; a bit that is not used is 0 (S840D-PSPARAM-005, S840D-PSAFE-007).
    pub const fn give(self, outse: u64, outsep: u64) -> u32 {
        let both = outse & outsep;
        let mut net = 0;
        let mut place = 1 << (self.row.lowest - 1);
        let mut rest = self.bits;
        let mut done = 0;
        while done < WIDEST && rest != 0 {
            let bit = rest & rest.wrapping_neg();
            if both & place != 0 {
                net |= bit;
            }
            rest ^= bit;
            place <<= 1;
            done += 1;
        }
        net
    }

    /// The variable of a bit of the sub-slot, 1 to 64; none where it is not used.
    pub const fn variable(self, bit: u8) -> Option<u8> {
        if bit > 31 || self.bits >> bit & 1 == 0 {
            return None;
        }
        let below = self.bits & !(u32::MAX << bit);
        Some(self.row.lowest + below.count_ones() as u8)
    }
}

/// Where a channel with a fault belongs (S840D-PSAFE-021).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// An input.
    Input,
    /// An output.
    Output,
}

/// The supplement of alarm 27254: 1 to 64 for `$A_INSE`, 65 to 128 for `$A_OUTSE`, -1 without a variable (S840D-PSAFE-004,
/// S840D-PSAFE-021).
pub const fn supplement(channel: Channel, variable: Option<u8>) -> i16 {
    match (channel, variable) {
        (_, None) => -1,
        (Channel::Input, Some(variable)) => variable as i16,
        (Channel::Output, Some(variable)) => VARIABLES as i16 + variable as i16,
    }
}

/// The bytes of INSEP or OUTSEP with a variable of an F module: the marks INSEP_PROFISAFE and OUTSEP_PROFISAFE of DB18, byte n in bit
/// n - 1 (S840D-PSAFE-045).
pub const fn marked(variables: u64) -> u8 {
    let mut marks = 0;
    let mut byte = 0;
    while byte < 8 {
        if variables >> (8 * byte) & 0xFF != 0 {
            marks |= 1 << byte;
        }
        byte += 1;
    }
    marks
}

/// The variables 1 to 64 as the two double words `$A_INSED[1]` and `$A_INSED[2]`: variable n of a word is its bit n - 1
/// (S840D-SPLIO-003).
pub const fn words(variables: u64) -> [u32; 2] {
    [variables as u32, (variables >> 32) as u32]
}

/// The variables of two double words (S840D-SPLIO-003).
pub const fn of_words(words: [u32; 2]) -> u64 {
    words[0] as u64 | (words[1] as u64) << 32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-PSPARAM-003, S840D-PSPARAM-004, S840D-PSPARAM-005: every filter with one to three bits among ten, against the
    /// definition; and back.
    #[test]
    fn bits_are_packed_and_spread_in_order() {
        let mut tried = 0;
        for filter in 1_u32..1 << 10 {
            let count = filter.count_ones();
            if count > 3 {
                continue;
            }
            for low in [1_u32, 31, 62] {
                let connection =
                    Connection::new(filter, (low + count - 1) * 1000 + low).expect("fits");
                let chosen: [u8; 10] = core::array::from_fn(|bit| bit as u8);
                let mut chosen = chosen.into_iter().filter(|bit| filter >> bit & 1 == 1);
                for k in 0..count {
                    let bit = chosen.next().expect("one for each variable");
                    let variable = (low + k) as u8;
                    assert_eq!(connection.variable(bit), Some(variable));
                    assert_eq!(connection.take(1 << bit), 1 << (variable - 1));
                    assert_eq!(connection.give(1 << (variable - 1), u64::MAX), 1 << bit);
                    assert_eq!(
                        connection.give(u64::MAX, !(1 << (variable - 1))),
                        filter ^ 1 << bit
                    );
                    tried += 1;
                }
                assert_eq!(connection.take(!filter), 0);
                assert_eq!(connection.take(u32::MAX), connection.row().variables());
                assert_eq!(connection.give(u64::MAX, 0), 0);
            }
        }
        assert_eq!(tried, 3 * (10 + 2 * 45 + 3 * 120));
    }

    /// S840D-PSAFE-028, S840D-PSAFE-030, S840D-PSPARAM-006.
    #[test]
    fn unfit_rows_are_refused() {
        for datum in [0, 1, 1_000, 1_002, 65_064, 64_000, 9_001, 999] {
            assert_eq!(Row::new(datum), Err(Unfit::Row), "{datum}");
        }
        let row = Row::new(64_057).expect("the last eight");
        assert_eq!((row.count(), row.variables()), (8, 0xFF << 56));
        assert_eq!(Connection::new(0b101, 3_001), Err(Unfit::Number));
        assert_eq!(Connection::new(0, 1_001), Err(Unfit::Number));
        let first = Connection::new(NO_FILTER, 8_005).expect("no filter");
        assert_eq!((first.bits(), first.highest()), (0b1111, 3));
    }

    /// S840D-PSAFE-004, S840D-PSAFE-021.
    #[test]
    fn faults_are_told_with_their_variable() {
        assert_eq!(supplement(Channel::Input, Some(64)), 64);
        assert_eq!(supplement(Channel::Output, Some(1)), 65);
        assert_eq!(supplement(Channel::Output, Some(64)), 128);
        assert_eq!(supplement(Channel::Input, None), -1);
    }

    /// S840D-PSAFE-045.
    #[test]
    fn bytes_of_f_modules_are_marked() {
        assert_eq!(marked(0), 0);
        assert_eq!(marked(1), 1);
        assert_eq!(marked(0x0180), 0b11);
        assert_eq!(marked(1 << 63), 0x80);
    }

    /// S840D-SPLIO-003: bit by bit and word by word are the same.
    #[test]
    fn words_are_the_bits() {
        for variable in 1..=64_u64 {
            let [low, high] = words(1 << (variable - 1));
            let bit = 1 << ((variable - 1) % 32);
            assert_eq!(
                (low, high),
                if variable <= 32 { (bit, 0) } else { (0, bit) }
            );
            assert_eq!(of_words([low, high]), 1 << (variable - 1));
        }
    }
}
