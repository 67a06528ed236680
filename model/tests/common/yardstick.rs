//! The yardstick: two copies of a six-stop axis with a 500-cycle timer, hand-coded.

use stillpoint_model::{Choices, Domain, Fault, System};

/// Each cycle moves one axis. Input 0: the axis; 1: the request 0..5; 2: still; 3: ack.
pub struct TwoAxis {
    domains: [Domain; 4],
    timer: i32,
}

impl TwoAxis {
    pub fn new(timer: i32) -> Self {
        let (stop, time) = (Domain { lo: 0, hi: 6 }, Domain { lo: 0, hi: timer });
        TwoAxis { domains: [stop, time, stop, time], timer }
    }
}

impl System for TwoAxis {
    type Work = ();

    fn work(&self) {}

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        2 * 6 * 2 * 2
    }

    fn initial<C: Choices>(&self, _: &mut (), _: &mut C, state: &mut [i32]) {
        state.fill(0);
    }

    #[inline]
    fn next<C: Choices>(&self, _: &mut (), before: &[i32], c: &mut C, after: &mut [i32]) -> Result<(), Fault> {
        after.copy_from_slice(before);
        let axis = 2 * c.choose(0, 2) as usize;
        let (stop, timer) = (before[axis], before[axis + 1]);
        let request = if stop < 6 { c.choose(1, 6) as i32 } else { 0 };
        if request > 0 && request + 1 > stop && stop < 6 {
            after[axis] = request + 1;
            after[axis + 1] = if request + 1 == 6 { 0 } else { self.timer };
        } else if stop == 5 {
            if timer == 0 || c.choose(2, 2) == 1 {
                after[axis] = 6;
                after[axis + 1] = 0;
            } else {
                after[axis + 1] = timer - 1;
            }
        } else if (2..=4).contains(&stop) {
            if timer > 0 {
                after[axis + 1] = timer - 1;
            } else if request == 0 && c.choose(3, 2) == 1 {
                after[axis] = 0;
            }
        }
        Ok(())
    }

    /// Atom 0: both axes are at standstill with pulses off (never left again). The work area is not needed: a twin of
    /// the yardstick without properties.
    fn atom<C: Choices>(&self, _: &mut (), _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(true)
    }
}
