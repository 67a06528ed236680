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
        TwoAxis {
            domains: [stop, time, stop, time],
            timer,
        }
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
    fn next<C: Choices>(
        &self,
        _: &mut (),
        before: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        after[..4].copy_from_slice(&before[..4]);
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

    /// No statements: see [`Watched`].
    fn atom<C: Choices>(&self, _: &mut (), _: usize, _: &mut C) -> Result<bool, Fault> {
        Ok(true)
    }
}

/// The yardstick with statements about its cycles.
pub struct Watched {
    pub inner: TwoAxis,
    domains: Vec<Domain>,
}

impl Watched {
    pub fn new(timer: i32, padding: Vec<Domain>) -> Self {
        let inner = TwoAxis::new(timer);
        let domains = inner.domains.iter().copied().chain(padding).collect();
        Watched { inner, domains }
    }
}

impl System for Watched {
    type Work = [[i32; 4]; 2];

    fn work(&self) -> Self::Work {
        [[0; 4]; 2]
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        self.inner.combinations()
    }

    fn initial<C: Choices>(&self, _: &mut Self::Work, _: &mut C, state: &mut [i32]) {
        state.fill(0);
    }

    fn next<C: Choices>(
        &self,
        w: &mut Self::Work,
        before: &[i32],
        c: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        after.fill(0);
        self.inner.next(&mut (), &before[..4], c, &mut after[..4])?;
        w[0].copy_from_slice(&before[..4]);
        w[1].copy_from_slice(&after[..4]);
        Ok(())
    }

    /// 0: axis 1 enters stop 5. 1: axis 1 is in stop 6 after the cycle. 2: the cycle moves axis 1. 3: both axes are in stop
    /// 6. 4: axis 1 is in stop 5. 5: axis 1 comes back to 0 from a stop. 6: axis 2 has stop 3 with its timer at 7.
    fn atom<C: Choices>(&self, w: &mut Self::Work, atom: usize, c: &mut C) -> Result<bool, Fault> {
        let [before, after] = *w;
        Ok(match atom {
            0 => before[0] != 5 && after[0] == 5,
            1 => after[0] == 6,
            2 => c.choose(0, 2) == 0,
            3 => after[0] == 6 && after[2] == 6,
            4 => after[0] == 5,
            5 => before[0] != 0 && after[0] == 0,
            _ => after[2] == 3 && after[3] == 7,
        })
    }

    fn rules(&self) -> usize {
        2
    }

    fn fired(&self, w: &Self::Work, each: &mut impl FnMut(usize)) {
        for axis in 0..2 {
            if w[0][2 * axis..2 * axis + 2] != w[1][2 * axis..2 * axis + 2] {
                each(axis);
            }
        }
    }
}
