//! Response times of the F master: from the input area of an F module to the safe logic, and back to the output area of one.
//!
//! All times in microseconds. They are those of the F master alone; the time of the logic comes between both ways. A PROFIsafe cycle
//! that the PLC may delay is entered with its longest time, 50 ms: above it the axes are stopped ([`f_master`](super::f_master)).

/// The longest cycle of the PLC's user program, as its monitoring is set by default (S840D-PSTIME-001).
pub const LONGEST_PLC_CYCLE_US: u32 = 150_000;

/// What the times depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// The PROFIsafe cycle as it is when the PLC does not keep pace: at most 50 ms (S840D-PSTIME-001, S840D-PSTIME-005).
    pub delayed_cycle_us: u32,
    /// The PROFIsafe cycle as parameterised: n interpolator cycles.
    pub cycle_us: u32,
    /// The interpolator cycle.
    pub interpolator_us: u32,
    /// The cycle of the PLC's user program, OB1 (S840D-PSTIME-001).
    pub plc_us: u32,
    /// From the start of OB40 to its ready signal (S840D-PSTIME-001).
    pub ob40_us: u32,
    /// How long OB40 cannot be started, in repeated attempts: 0 where the PLC is not late, at most 50 ms (S840D-PSTIME-005).
    pub late_us: u32,
}

impl Times {
    /// From an input, or to an output, in the channel of the PLC: two PROFIsafe cycles and one of OB1 (S840D-PSTIME-002).
    pub const fn plc_one_way(&self) -> u64 {
        2 * self.delayed_cycle_us as u64 + self.plc_us as u64
    }

    /// From an input to an output in the channel of the PLC, without its logic (S840D-PSTIME-002).
    pub const fn plc_both_ways(&self) -> u64 {
        2 * self.plc_one_way()
    }

    /// From an input to `$A_INSE` (S840D-PSTIME-003, S840D-PSTIME-004).
    pub const fn nck_in(&self) -> u64 {
        2 * self.delayed_cycle_us as u64 + self.interpolator_us as u64
    }

    /// Whether the PROFIsafe cycle is longer than two interpolator cycles: then an output waits for it (S840D-PSTIME-004).
    const fn waits(&self) -> bool {
        self.cycle_us as u64 > 2 * self.interpolator_us as u64
    }

    /// From `$A_OUTSE` to an output: an interpolator cycle, n - 2 more of a long PROFIsafe cycle, OB40 and what it is late
    /// (S840D-PSTIME-003, S840D-PSTIME-004).
    pub const fn nck_out(&self) -> u64 {
        let way = if self.waits() {
            self.cycle_us as u64 - self.interpolator_us as u64
        } else {
            self.interpolator_us as u64
        };
        way + self.late_us as u64 + self.ob40_us as u64
    }

    /// From an input to an output in the channel of the NCK, without its logic: less than the sum of both ways where the PROFIsafe cycle
    /// is long (S840D-PSTIME-003, S840D-PSTIME-004).
    pub const fn nck_both_ways(&self) -> u64 {
        let way = if self.waits() {
            self.cycle_us as u64
        } else {
            2 * self.interpolator_us as u64
        };
        2 * self.delayed_cycle_us as u64 + way + self.late_us as u64 + self.ob40_us as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-PSTIME-001: without any delay of the PLC nothing is longer than with its longest ones; S840D-PSTIME-005: a delay adds
    /// itself once.
    #[test]
    fn delays_add_themselves() {
        let times = Times {
            delayed_cycle_us: 16_000,
            cycle_us: 16_000,
            interpolator_us: 8_000,
            plc_us: 30_000,
            ob40_us: 2_000,
            late_us: 0,
        };
        let late = Times {
            late_us: 50_000,
            ..times
        };
        assert_eq!(late.nck_out(), times.nck_out() + 50_000);
        assert_eq!(late.nck_both_ways(), times.nck_both_ways() + 50_000);
        assert_eq!(late.nck_in(), times.nck_in());
        let longest = Times {
            delayed_cycle_us: super::super::f_master::TOLERATED_US,
            plc_us: LONGEST_PLC_CYCLE_US,
            ..late
        };
        assert_eq!(longest.plc_one_way(), 250_000);
    }
}
