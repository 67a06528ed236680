//! The words between the block and the drive: S_ZSW3B (r10234) and S_STW3B (r10235).

use crate::srm::common::{bit, word};

fields! {
    /// The bits of S_ZSW3B that the block reads (SRM-BRAKETEST-008); it does not read bits 1, 7, 14 and 15 (AMB-52).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Status {
        /// Bit 0, SBT_SELECTED: the test is selected.
        pub selected: bool,
        /// Bit 2, SBT_ACTIVE_BR: brake 2 is tested.
        pub active_br: bool,
        /// Bit 3, SBT_ACTIVE: the drive builds up torque.
        pub active: bool,
        /// Bit 4, SBT_RESULT: the brake holds.
        pub result: bool,
        /// Bit 5, SBT_FINISHED: the sequence is over.
        pub finished: bool,
        /// Bit 6, SBT_CLOSE_BR: the external brake is to be closed.
        pub close_br: bool,
    }
}

impl Status {
    /// What a word says.
    pub const fn from_word(word: u16) -> Self {
        Self {
            selected: bit(word, 0),
            active_br: bit(word, 2),
            active: bit(word, 3),
            result: bit(word, 4),
            finished: bit(word, 5),
            close_br: bit(word, 6),
        }
    }
}

fields! {
    /// The bits of S_STW3B (SRM-BRAKETEST-007); the others are 0.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Control {
        /// Bit 0, SBT_SELECT: as BUSY.
        pub select: bool,
        /// Bit 1, SBT_START.
        pub start: bool,
        /// Bit 2, SBT_BR_SELECT: brake 2.
        pub br_select: bool,
        /// Bit 3, SBT_TORQUE_DIR: negative.
        pub torque_dir: bool,
        /// Bit 4, SBT_SEQUENCE: sequence 2.
        pub sequence: bool,
        /// Bit 5, SBT_FDBACK_BR: the external brake is closed.
        pub fdback_br: bool,
    }
}

impl Control {
    /// The word.
    pub const fn word(&self) -> u16 {
        let mut bits = [false; 16];
        bits[0] = self.select;
        bits[1] = self.start;
        bits[2] = self.br_select;
        bits[3] = self.torque_dir;
        bits[4] = self.sequence;
        bits[5] = self.fdback_br;
        word(bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SRM-BRAKETEST-007, SRM-BRAKETEST-008: the printed bits.
    #[test]
    fn bits_of_the_words() {
        let status = Status::from_word(0b0111_1101);
        assert!(status.selected && status.active_br && status.active);
        assert!(status.result && status.finished && status.close_br);
        assert_eq!(Status::from_word(0b1000_0010), Status::default());
        let control = Control {
            select: true,
            torque_dir: true,
            fdback_br: true,
            ..Control::default()
        };
        assert_eq!(control.word(), 0b10_1001);
    }
}
