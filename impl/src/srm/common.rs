//! What all blocks have in common: words and bits, edges, latched faults, times in calls, reactions to wrong parameters. No step.

/// The greatest DInt: an SLS threshold that limits nothing.
pub const UNLIMITED: i32 = i32::MAX;

fields! {
    /// Reading AMB-17: what a parameter or calculation fault does besides its report.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum ErrReact {
        /// All enables of the block are 0 while it is latched.
        #[default]
        Safe,
        /// `ERROR` and `DIAG` tell it; nothing else.
        Report,
    }
}

/// Whether an input has become 1 since the call before. The memories start at 1 (AMB-19 ONE): a signal that is at 1 in the first
/// call is no edge (SRM-ACK-006).
pub const fn rises(now: bool, before: bool) -> bool {
    now && !before
}

/// What a latched fault is after a call: its condition sets it in the call that reads it, without any filter (SRM-TIMING-007), whoever
/// acknowledges (SRM-ACK-007); an edge at ACK ends it where its own reset condition holds (SRM-ACK-001, SRM-ACK-002).
pub(crate) const fn latch(held: bool, condition: bool, acknowledged: bool, ready: bool) -> bool {
    condition || held && !(acknowledged && ready)
}

/// The word of 16 bits, the first one lowest: F_BO_W (FC176).
pub const fn word(bits: [bool; 16]) -> u16 {
    let mut word = 0;
    let mut place = 0;
    while place < 16 {
        // `place` is below the length.
        #[allow(clippy::indexing_slicing)]
        let bit = bits[place] as u16;
        word |= bit << place;
        place += 1;
    }
    word
}

/// Whether a bit of a word is set: F_W_BO (FC177). No bit is above 15.
pub const fn bit(word: u16, place: u32) -> bool {
    place < 16 && (word >> place) & 1 == 1
}

/// The word with some of its bits: numbers and whether they are set.
pub(crate) const fn diag<const N: usize>(bits: &[(u32, bool); N]) -> u16 {
    let mut word = 0;
    let mut entry = 0;
    while entry < N {
        // `entry` is below the length.
        #[allow(clippy::indexing_slicing)]
        let (place, set) = bits[entry];
        if set && place < 16 {
            word |= 1 << place;
        }
        entry += 1;
    }
    word
}

/// The magnitude of a velocity or difference: blocks that read a velocity take it without its sign (SRM-POSV-002).
pub(crate) const fn magnitude(value: i32) -> i64 {
    (value as i64).abs()
}

/// The magnitude of the difference of two DInt, exact.
pub(crate) const fn apart(a: i32, b: i32) -> i64 {
    (a as i64 - b as i64).abs()
}

/// Millimetres in micrometres, exact for all that two DInt can differ by.
pub(crate) const fn um(mm: i64) -> i64 {
    // The constant first: a model checker adds once for each bit of the first factor that is no constant.
    1_000 * mm
}

/// Whether a number is in a range, both ends included.
#[allow(
    clippy::manual_range_contains,
    reason = "what it stands for is many times as much for a model checker to execute"
)]
pub(crate) const fn within(low: i32, number: i32, high: i32) -> bool {
    low <= number && number <= high
}

/// Whether the quotient of two numbers is whole. There is none by 0 (SRM-TIMING-005).
pub(crate) const fn multiple(number: i32, of: i32) -> bool {
    of != 0 && number.wrapping_rem(of) == 0
}

/// What a quotient toward zero leaves; `of` is not 0.
pub(crate) const fn remainder(number: i32, of: i32) -> i32 {
    number % of
}

/// A quotient toward zero; `of` is not 0.
pub(crate) const fn quotient(number: i32, of: i32) -> i32 {
    number / of
}

/// How many calls a time lasts: the quotient, where it is whole and positive in both (SRM-TIMING-005).
pub(crate) const fn calls(time: i32, t_sample: i32) -> Option<i32> {
    if time > 0 && t_sample > 0 && time % t_sample == 0 {
        Some(time / t_sample)
    } else {
        None
    }
}

/// The velocity of a retraction: a substitute of 1 mm/min where the parameter is none (SRM-SLP-003, SRM-BRAKETEST-005,
/// SRM-LOAD-006).
pub(crate) const fn release_velocity(parameter: i32) -> i32 {
    if parameter < 1 { 1 } else { parameter }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SRM-DIAG-001: bit n is condition n.
    #[test]
    fn words_and_bits() {
        let mut bits = [false; 16];
        bits[0] = true;
        bits[9] = true;
        bits[15] = true;
        assert_eq!(word(bits), 0x8201);
        assert!((0..16).all(|place| bit(word(bits), place) == bits[place as usize]));
        assert!(!bit(u16::MAX, 16));
        assert_eq!(
            diag(&[(0, true), (9, true), (3, false), (15, true)]),
            0x8201
        );
    }

    #[test]
    fn set_wins_over_reset_and_a_static_one_acknowledges_nothing() {
        assert!(latch(true, true, true, true));
        assert!(!latch(true, false, rises(true, false), true));
        assert!(latch(true, false, rises(true, true), true));
        assert!(latch(true, false, rises(true, false), false));
    }

    #[test]
    fn times_are_whole_calls() {
        assert_eq!(calls(100, 20), Some(5));
        assert!(multiple(-20, 10) && multiple(20, -10) && multiple(0, 1) && multiple(i32::MIN, -1));
        assert!(!multiple(15, 10) && !multiple(0, 0) && !multiple(5, 0));
        for (time, t_sample) in [(100, 30), (0, 20), (-20, 20), (20, 0), (20, -20), (5, 10)] {
            assert_eq!(calls(time, t_sample), None);
        }
    }
}
