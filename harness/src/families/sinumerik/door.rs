//! The safe logic of a guard door, as a machine builder would write it: who asks for a door gets it when no axis behind it is
//! monitored by more than the open door allows, and only after a forced check where one is due.
//!
//! The sequence of the machine `door` in the family's `application.toml`, for several axes and any monitoring.

use crate::plant::Door;

/// The channels by their place in the vocabulary.
const NCK: usize = 0;
const DRIVE: usize = 1;

/// How far the logic is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// Nobody asks for the door.
    #[default]
    Locked,
    /// Asked for: it waits for the monitoring and, where a forced check is due, for standstill.
    Waits,
    /// The path of a channel is tested.
    Tests(usize),
    /// The pulses were cancelled through that path; the test ends.
    Ends(usize),
    /// Released.
    Free,
}

/// The logic of a guard door.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Logic {
    phase: Phase,
}

/// What the logic sees of an axis behind the door.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Both channels monitor what the open door asks for, or less.
    pub monitored: bool,
    /// The axis stands, in both channels.
    pub stands: bool,
    /// A forced check is due.
    pub due: bool,
    /// Feedback: the pulses are cancelled.
    pub cancelled: bool,
    /// A test of the path runs, by channel.
    pub testing: [bool; 2],
}

impl Logic {
    /// Whether the logic selects what the open door asks for.
    pub fn selects(&self, door: &Door) -> bool {
        door.open || self.phase != Phase::Locked
    }

    /// The channel whose test stop is selected.
    pub fn tests(&self) -> Option<usize> {
        match self.phase {
            Phase::Tests(side) => Some(side),
            _ => None,
        }
    }

    /// Whether the door can be opened.
    pub fn released(&self) -> bool {
        self.phase == Phase::Free
    }

    /// The door falls locked without power.
    pub fn power_on(&mut self) {
        self.phase = Phase::Locked;
    }

    /// The end of a cycle.
    pub fn step(&mut self, door: &Door, axes: &[Seen]) {
        let all = |test: &dyn Fn(&Seen) -> bool| axes.iter().all(test);
        self.phase = match self.phase {
            Phase::Locked if door.asked => Phase::Waits,
            Phase::Waits if !door.asked => Phase::Locked,
            Phase::Waits if !all(&|a| a.monitored) => Phase::Waits,
            Phase::Waits if all(&|a| !a.due) => Phase::Free,
            Phase::Waits if all(&|a| a.stands && !a.cancelled) => Phase::Tests(DRIVE),
            Phase::Tests(side) if all(&|a| a.testing[side] && a.cancelled) => Phase::Ends(side),
            // Refused, failed, or ended by a STOP A or B.
            Phase::Tests(side) if !all(&|a| a.testing[side]) => Phase::Locked,
            Phase::Ends(DRIVE) if all(&|a| !a.testing[DRIVE] && !a.cancelled) => Phase::Tests(NCK),
            Phase::Ends(NCK) if all(&|a| !a.testing[NCK] && !a.cancelled) => Phase::Waits,
            Phase::Free if !door.open && !door.asked => Phase::Locked,
            same => same,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: Seen = Seen {
        monitored: true,
        stands: true,
        due: false,
        cancelled: false,
        testing: [false; 2],
    };

    const ASKED: Door = Door {
        open: false,
        asked: true,
    };

    fn asked() -> Logic {
        let mut logic = Logic::default();
        logic.step(&ASKED, &[REST]);
        logic
    }

    #[test]
    fn released_when_every_axis_is_monitored_and_no_check_is_due() {
        let mut logic = asked();
        assert!(logic.selects(&ASKED) && !logic.released());
        let unmonitored = Seen {
            monitored: false,
            ..REST
        };
        logic.step(&ASKED, &[REST, unmonitored]);
        assert!(!logic.released());
        logic.step(&ASKED, &[REST, REST]);
        assert!(logic.released());
        // Open, nobody asks any more: it stays free until it is closed.
        let mut door = Door {
            open: true,
            asked: false,
        };
        logic.step(&door, &[REST]);
        assert!(logic.released());
        door.open = false;
        logic.step(&door, &[REST]);
        assert!(!logic.released() && !logic.selects(&door));
    }

    #[test]
    fn a_check_that_is_due_tests_one_path_after_the_other() {
        let due = Seen { due: true, ..REST };
        let mut logic = asked();
        logic.step(
            &ASKED,
            &[
                due,
                Seen {
                    stands: false,
                    ..due
                },
            ],
        );
        assert_eq!(logic.tests(), None, "an axis moves");
        for side in [DRIVE, NCK] {
            logic.step(&ASKED, &[due]);
            assert_eq!(logic.tests(), Some(side));
            let mut testing = Seen {
                cancelled: true,
                ..due
            };
            testing.testing[side] = true;
            logic.step(&ASKED, &[testing]);
            assert_eq!(logic.tests(), None, "the selection is taken back");
            logic.step(&ASKED, &[testing]);
            if side == DRIVE {
                continue;
            }
            logic.step(&ASKED, &[due]);
        }
        logic.step(&ASKED, &[REST]);
        assert!(logic.released());
    }

    #[test]
    fn a_failed_test_leaves_it_locked() {
        let due = Seen { due: true, ..REST };
        let mut logic = asked();
        logic.step(&ASKED, &[due]);
        assert_eq!(logic.tests(), Some(DRIVE));
        // STOP A: no test runs any more, the pulses stay cancelled.
        for _ in 0..10 {
            logic.step(
                &ASKED,
                &[Seen {
                    cancelled: true,
                    ..due
                }],
            );
            assert!(!logic.released() && logic.tests().is_none());
        }
    }
}
