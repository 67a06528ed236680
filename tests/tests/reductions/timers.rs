//! Values of a timer stored as intervals: the same exploration in less memory.

use stillpoint_model::Storage;
use stillpoint_tests::specification_files;

use super::shipped::{small, whole};
use super::{TIMERS, YARDSTICK, compare, reduced};

#[test]
fn timers_as_intervals_change_nothing_but_memory() {
    let mut stored = 0;
    for path in specification_files() {
        for bound in small(&path).0 {
            let name = &bound.system.name;
            if stillpoint_spec::timers::countdowns(&bound.system).is_empty() {
                continue;
            }
            let whole = whole(&bound);
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
            if name == YARDSTICK {
                // Timers of 501 ticks: some two thousandths of the states have an interval each.
                assert!(timers.memory < timers.states / 4, "{}", timers.memory);
            }
        }
    }
    assert!(stored >= 4, "{stored} systems have a timer");
}
