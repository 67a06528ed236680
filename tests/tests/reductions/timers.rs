//! Values of a timer stored as intervals: the same exploration in less memory.

use stillpoint_model::Storage;
use stillpoint_spec::Spec;
use stillpoint_tests::specification_files;

use super::{TIMERS, compare, full, of, reduced};

/// Systems with more work than this are left out: their check takes seconds, twice.
const MOST: u128 = 200_000_000;

#[test]
fn timers_as_intervals_change_nothing_but_memory() {
    let mut stored = 0;
    for path in specification_files() {
        let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
        for bound in of(&spec) {
            let name = &bound.system.name;
            if stillpoint_spec::timers::countdowns(&bound.system).is_empty() {
                continue;
            }
            let whole = full(&bound, false);
            if whole.report.transitions > MOST {
                continue;
            }
            let part = reduced(&bound, false, TIMERS);
            compare(&bound, &whole, &part, name);
            let (plain, timers) = (&whole.report, &part.report);
            assert_eq!(plain.states, timers.states, "{name}");
            assert_eq!(plain.transitions, timers.transitions, "{name}");
            assert_eq!(plain.coverage, timers.coverage, "{name}");
            if timers.storage != Storage::Intervals {
                continue;
            }
            stored += 1;
            println!(
                "{name}: {} states, {} bytes in place of {}",
                timers.states, timers.memory, plain.memory
            );
            if name == "bench/two-axis/two_axis" {
                // Timers of 501 ticks: some two thousandths of the states have an interval each.
                assert!(timers.memory < timers.states / 4, "{}", timers.memory);
            }
        }
    }
    assert!(stored >= 4, "{stored} systems have a timer");
}
