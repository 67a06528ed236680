//! Sampling times of the safety functions, and the formulas that depend on them. No step.
//!
//! Times are microseconds.

/// p9500, the monitoring cycle of the Extended Functions: 0.5 to 25 ms (S120-TIMING-001).
pub const MONITORING_CYCLE_US: core::ops::RangeInclusive<u32> = 500..=25_000;

/// p9511 as it acts, which is t_ACT of the response times: 0 is the cycle of an isochronous bus, else 1 ms (S120-TIMING-001,
/// S120-TIMING-505, S120-SAM-004).
pub const fn acquisition(p9511: u32, isochronous: Option<u32>) -> u32 {
    match (p9511, isochronous) {
        (0, Some(bus)) => bus,
        (0, None) => 1000,
        (own, _) => own,
    }
}

/// Whether monitoring cycle and acquisition of actual values fit each other and the current controller: p9500 in its range and a whole
/// multiple of the acquisition, which is at least four cycles of the current controller with an encoder, and one without
/// (S120-TIMING-001).
pub fn fit(p9500: u32, acquisition: u32, current_controller: u32, encoder: bool) -> bool {
    let whole = acquisition > 0 && p9500 % acquisition == 0;
    let slow = if encoder {
        acquisition >= current_controller.saturating_mul(4)
    } else {
        acquisition == current_controller
    };
    MONITORING_CYCLE_US.contains(&p9500) && whole && slow
}

/// The scan cycle of PROFIsafe: two monitoring cycles (S120-TIMING-001).
pub const fn profisafe_scan(p9500: u32) -> u32 {
    p9500.saturating_mul(2)
}

/// r9780, the monitoring cycle of the Basic Functions, in microseconds, from the sampling time p0115\[0\] in nanoseconds; none for a
/// time that is not printed. A rough value: the drive shows the exact one (S120-TIMING-500).
pub const fn basic_cycle(p0115: u32) -> Option<u32> {
    match p0115 {
        31_250 | 62_500 | 125_000 => Some(4000),
        250_000 => Some(8000),
        400_000 | 500_000 => Some(16_000),
        _ => None,
    }
}

/// t_E, the delay of the input of a terminal, or of an F-DI of a CU310-2: `debounce` is p9651, or p10017 (S120-TIMING-502,
/// S120-TIMING-503).
pub const fn input_delay(debounce: u32, p0799: u32) -> u32 {
    if debounce == 0 {
        p0799.saturating_mul(2)
    } else {
        debounce.saturating_add(p0799).saturating_add(1000)
    }
}

/// t_E of the terminals of the Basic Functions: 2 ms at least (S120-TIMING-502).
pub fn terminal_delay(p9651: u32, p0799: u32) -> u32 {
    input_delay(p9651, p0799).max(2000)
}

/// t_K, the internal communication: `to` of an isochronous bus (r2064\[4\]), else `processing`, which is p2048 or p8848 where the
/// module has it, else 4 ms (S120-TIMING-504).
pub const fn internal_communication(to: Option<u32>, processing: Option<u32>) -> u32 {
    match (to, processing) {
        (Some(time), _) | (None, Some(time)) => time,
        (None, None) => 4000,
    }
}

/// r10015, the sampling time of a TM54F: the shortest of the clocks p10000 of its drives; none without a drive (S120-TM54F-504).
pub fn tm54f_sampling(clocks: &[u32]) -> Option<u32> {
    clocks.iter().copied().min()
}

/// Whether the clocks p10000 of a TM54F fit its drives: each is the monitoring cycle of its drive, which is p9500 with Extended
/// Functions and r9780 without, and all are the same (S120-TM54F-504). `drives`: the clock of each with its monitoring cycle.
pub fn tm54f_fits(drives: &[(u32, u32)]) -> bool {
    let mut clocks = drives.iter().map(|(clock, _)| clock);
    let first = clocks.next();
    drives.iter().all(|(clock, cycle)| clock == cycle) && clocks.all(|clock| Some(clock) == first)
}

/// The recommended p9548 in thousandths of mm/min of a linear axis: the speed that an acceleration of `mm_per_s2` adds in a monitoring
/// cycle, and a fifth more.
pub const fn sam_tolerance_linear(mm_per_s2: u32, p9500: u32) -> u64 {
    // mm/s2 times us is 1e-6 mm/s; in 1e-3 mm/min that is times 60 * 1e3 / 1e6.
    mm_per_s2 as u64 * p9500 as u64 * 60 * 12 / 10_000
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-TIMING-500, S120-TIMING-502, S120-TIMING-503, S120-TIMING-504, S120-TIMING-505: the times of which the response times are made
    /// up, as they are printed.
    #[test]
    fn parts_of_the_response_times() {
        let cycles = [31_250, 62_500, 125_000, 250_000, 400_000, 500_000, 300_000].map(basic_cycle);
        let printed = [4000, 4000, 4000, 8000, 16_000, 16_000].map(Some);
        assert_eq!(cycles[..6], printed);
        assert_eq!(cycles[6], None);
        assert_eq!(
            (input_delay(0, 4000), input_delay(3000, 4000)),
            (8000, 8000)
        );
        assert_eq!((input_delay(0, 500), terminal_delay(0, 500)), (1000, 2000));
        assert_eq!(terminal_delay(5000, 4000), 10_000);
        assert_eq!(internal_communication(Some(250), Some(2000)), 250);
        assert_eq!(internal_communication(None, Some(2000)), 2000);
        assert_eq!(internal_communication(None, None), 4000);
        assert_eq!(
            [(0, None), (0, Some(2000)), (500, Some(2000))].map(|(p, bus)| acquisition(p, bus)),
            [1000, 2000, 500]
        );
    }

    /// S120-TIMING-001: the example of SAM, 12 ms with 1 ms; without encoder the acquisition is the current controller's cycle.
    #[test]
    fn cycles_that_fit() {
        assert!(fit(12_000, 1000, 250, true));
        assert!(!fit(12_000, 1000, 251, true), "less than four cycles");
        assert!(!fit(12_500, 1000, 250, true), "no multiple");
        assert!(
            !fit(25_500, 500, 125, true) && !fit(250, 250, 62, true),
            "range"
        );
        assert!(fit(500, 250, 250, false) && !fit(500, 250, 125, false));
        assert!(!fit(500, 0, 0, false));
        assert_eq!(acquisition(0, None), 1000);
        assert_eq!(acquisition(0, Some(2000)), 2000);
        assert_eq!(acquisition(500, Some(2000)), 500);
        assert_eq!(profisafe_scan(12_000), 24_000);
    }

    /// S120-TM54F-504: a clock that is not the cycle of its drive, and drives with different cycles, do not fit.
    #[test]
    fn clocks_of_a_tm54f() {
        assert_eq!(tm54f_sampling(&[12_000, 8000, 16_000]), Some(8000));
        assert_eq!(tm54f_sampling(&[]), None);
        assert!(tm54f_fits(&[(8000, 8000); 6]));
        assert!(!tm54f_fits(&[(8000, 8000), (8000, 12_000)]));
        assert!(!tm54f_fits(&[(8000, 8000), (12_000, 12_000)]));
    }

    /// The setup rule of SAM: 1 m/s2 for 12 ms are 720 mm/min, 864 with the margin.
    #[test]
    fn tolerance_of_sam() {
        assert_eq!(sam_tolerance_linear(1000, 12_000), 864_000);
    }
}
