//! Sampling times of the safety functions, and the formulas that depend on them. No step.
//!
//! Times are microseconds.

/// p9500, the monitoring cycle of the Extended Functions: 0.5 to 25 ms (S120-TIMING-001).
pub const MONITORING_CYCLE_US: core::ops::RangeInclusive<u32> = 500..=25_000;

/// p9511 as it acts: 0 is the cycle of an isochronous bus, else 1 ms (S120-TIMING-001, S120-SAM-004).
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

/// The recommended p9548 in thousandths of mm/min of a linear axis: the speed that an acceleration of `mm_per_s2` adds in a monitoring
/// cycle, and a fifth more.
pub const fn sam_tolerance_linear(mm_per_s2: u32, p9500: u32) -> u64 {
    // mm/s2 times us is 1e-6 mm/s; in 1e-3 mm/min that is times 60 * 1e3 / 1e6.
    mm_per_s2 as u64 * p9500 as u64 * 60 * 12 / 10_000
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The setup rule of SAM: 1 m/s2 for 12 ms are 720 mm/min, 864 with the margin.
    #[test]
    fn tolerance_of_sam() {
        assert_eq!(sam_tolerance_linear(1000, 12_000), 864_000);
    }
}
