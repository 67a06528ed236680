//! Values of a timer stored as intervals: the same exploration in less memory.

use stillpoint_model::Storage;
use stillpoint_tests::peer::each;

use super::shipped::shipped;
use super::{TIMERS, YARDSTICK, compare, reduced};

#[test]
fn timers_as_intervals_change_nothing_but_memory() {
    let stored = each(shipped(), |(bound, whole)| {
        let name = &bound.system.name;
        if stillpoint_lang::timers::countdowns(&bound.system).is_empty() {
            return false;
        }
        let part = reduced(bound, false, TIMERS);
        compare(bound, whole, &part, name);
        let (plain, timers) = (&whole.report, &part.report);
        assert_eq!(plain.states, timers.states, "{name}");
        assert_eq!(plain.transitions, timers.transitions, "{name}");
        assert_eq!(plain.coverage, timers.coverage, "{name}");
        if timers.storage != Storage::Intervals {
            return false;
        }
        println!(
            "{name}: {} states, {} bytes in place of {}",
            timers.states, timers.memory, plain.memory
        );
        if name == YARDSTICK {
            // Timers of 501 ticks: some two thousandths of the states have an interval each.
            assert!(timers.memory < timers.states / 4, "{}", timers.memory);
        }
        true
    });
    let stored = stored.into_iter().filter(|s| *s).count();
    assert!(stored >= 4, "{stored} systems have a timer");
}
