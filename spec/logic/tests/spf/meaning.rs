//! Triggers, timers, the order of actions and relays against definitions that speak of the whole past, over every sequence of inputs
//! up to a length. They keep no state, so that they share nothing with the translation.

use stillpoint_logic::spf::{Interface, Readings};

use super::rig::{Spl, interface, sequences};

/// A past: `a` and `b` in each cycle so far.
type Past<'p> = &'p [(bool, bool)];

/// Runs blocks over all sequences of `a` and `b`, against what `p` is from the past.
fn output_is(blocks: &str, interface: &Interface, length: u32, p: impl Fn(Past<'_>) -> bool) {
    let mut spl = Spl::new(blocks, interface, 10_000);
    let mut seen = [false; 2];
    for inputs in sequences(4, length) {
        spl.restart();
        let mut past = Vec::new();
        for input in inputs {
            past.push((input % 2 == 1, input / 2 == 1));
            let out = spl.step(&[("a", (input % 2) as i32), ("b", (input / 2) as i32)]);
            let expected = p(&past);
            seen[usize::from(expected)] = true;
            assert_eq!(out[0] == 1, expected, "{blocks}: {past:?}");
        }
    }
    assert_eq!(seen, [true; 2], "{blocks}: always the same");
}

/// `p` is b as it was when the action fired last; `fires` says so of the past.
fn fires(trigger: &str, readings: Readings, fires: fn(Past<'_>) -> bool) {
    let blocks = format!("IDS=5 {trigger} DO $A_OUTSE[1] = $A_INSE[2]");
    let interface = Interface {
        readings,
        ..interface()
    };
    output_is(&blocks, &interface, 6, |past| {
        let last = (1..=past.len()).rev().find(|n| fires(&past[..*n]));
        last.is_some_and(|n| past[n - 1].1)
    });
}

#[test]
fn an_action_without_condition_fires_in_each_cycle() {
    fires("", Readings::default(), |_| true);
}

#[test]
fn whenever_fires_while_the_condition_holds() {
    fires("WHENEVER $A_INSE[1] == 1", Readings::default(), |past| {
        past[past.len() - 1].0
    });
}

/// S840D-LANG-705.
#[test]
fn every_fires_at_an_edge_and_when_the_condition_holds_from_the_start() {
    fires("EVERY $A_INSE[1] == 1", Readings::default(), |past| {
        past[past.len() - 1].0 && (past.len() == 1 || !past[past.len() - 2].0)
    });
    let sample = Readings {
        first_sample_is_no_edge: true,
        ..Readings::default()
    };
    fires("EVERY $A_INSE[1] == 1", sample, |past| {
        past[past.len() - 1].0 && past.len() > 1 && !past[past.len() - 2].0
    });
}

/// S840D-SPLSTART-014: `WHEN TRUE` presets a variable in the first cycle and never again.
#[test]
fn when_fires_once() {
    fires("WHEN $A_INSE[1] == 1", Readings::default(), |past| {
        past[past.len() - 1].0 && past[..past.len() - 1].iter().all(|(a, _)| !a)
    });
    fires("WHEN TRUE", Readings::default(), |past| past.len() == 1);
}

#[test]
fn from_fires_for_ever() {
    fires("FROM $A_INSE[1] == 1", Readings::default(), |past| {
        past.iter().any(|(a, _)| *a)
    });
}

/// The memory of an edge is set at the place of the action: what is undone before it is no edge.
#[test]
fn an_edge_is_looked_at_once_in_a_cycle() {
    // Marker 1 follows a, and is taken back where b is TRUE, before the action looks at it: the action counts every other firing.
    let blocks = "IDS=1 DO $A_MARKERSI[1] = $A_INSE[1]\n\
                  IDS=2 WHENEVER $A_INSE[2] == 1 DO $A_MARKERSI[1] = 0\n\
                  IDS=3 EVERY $A_MARKERSI[1] == 1 DO $A_OUTSE[1] = NOT $A_OUTSE[1]\n\
                  IDS=4 DO $A_MARKERSI[1] = 0";
    output_is(blocks, &interface(), 6, |past| {
        let holds = |k: usize| past[k].0 && !past[k].1;
        let edges = (0..past.len()).filter(|k| holds(*k) && (*k == 0 || !holds(k - 1)));
        edges.count() % 2 == 1
    });
    // What the action itself writes is no edge of the same cycle, but one of the next.
    let own = "IDS=7 EVERY ($A_INSE[1] AND NOT $A_OUTSE[1]) DO $A_OUTSE[1] = 1\n\
               IDS=8 WHENEVER $A_INSE[2] DO $A_OUTSE[1] = 0";
    output_is(own, &interface(), 6, |past| {
        // By the rules of the language, cycle by cycle.
        let (mut was, mut out) = (false, false);
        for (a, b) in past {
            let now = *a && !out;
            out |= now && !was;
            was = now;
            out &= !b;
        }
        out
    });
}

/// Actions run by their ids, not by their places; a value counts at once.
/// S840D-LANG-704.
#[test]
fn actions_run_in_the_order_of_their_ids() {
    let blocks = "IDS=30 DO $A_OUTSE[1] = $A_MARKERSI[2]\n\
                  IDS=010 DO $A_MARKERSI[1] = $A_INSE[1]\n\
                  IDS=20 DO $A_MARKERSI[2] = $A_MARKERSI[1]";
    output_is(blocks, &interface(), 4, |past| past[past.len() - 1].0);
    let late = "IDS=1 DO $A_OUTSE[1] = $A_MARKERSI[1]\nIDS=2 DO $A_MARKERSI[1] = $A_INSE[1]";
    output_is(late, &interface(), 4, |past| {
        past.len() > 1 && past[past.len() - 2].0
    });
    let swapped = "IDS=1 DO $A_OUTSE[1] = $A_INSE[1] $A_OUTSE[1] = $A_OUTSE[1] AND $A_INSE[2]";
    output_is(swapped, &interface(), 4, |past| {
        past[past.len() - 1] == (true, true)
    });
}

/// What a timer reads, in microseconds: `a` starts it, `b` stops it, the start before the stop.
fn time(past: Past<'_>, cycle: i64) -> i64 {
    let started = past.iter().rposition(|(a, _)| *a);
    let Some(started) = started else { return 0 };
    let stopped = (started..past.len()).find(|k| past[*k].1);
    let end = stopped.unwrap_or(past.len() - 1);
    (end - started) as i64 * cycle
}

/// S840D-LANG-706.
#[test]
fn a_timer_counts_the_cycles_since_its_start_and_keeps_its_time() {
    // 30 ms are three cycles of 10 ms, and no whole number of those of 7 ms, 20 ms or 29999 µs.
    for cycle in [10_000, 7_000, 20_000, 29_999, 30_000] {
        for (order, holds) in [
            (">", (|t, l| t > l) as fn(i64, i64) -> bool),
            (">=", |t, l| t >= l),
            ("<", |t, l| t < l),
            ("<=", |t, l| t <= l),
            ("==", |t, l| t == l),
            ("<>", |t, l| t != l),
        ] {
            let blocks = format!(
                "IDS=1 WHENEVER $A_INSE[1] DO $A_TIMERSI[1] = 0\n\
                 IDS=2 WHENEVER $A_INSE[2] DO $A_TIMERSI[1] = -1\n\
                 IDS=3 DO $A_OUTSE[1] = ($A_TIMERSI[1] {order} 0.03)"
            );
            let mut spl = Spl::new(&blocks, &interface(), cycle as u64);
            for inputs in sequences(4, 6) {
                spl.restart();
                let mut past = Vec::new();
                for input in inputs {
                    past.push((input % 2 == 1, input / 2 == 1));
                    let out = spl.step(&[("a", (input % 2) as i32), ("b", (input / 2) as i32)]);
                    // From 40 ms on the count may stand still: nothing tells the difference.
                    let expected = holds(time(&past, cycle), 30_000);
                    assert_eq!(out[0] == 1, expected, "{order} {cycle} µs: {past:?}");
                }
            }
        }
    }
}

/// The manual's sentence on strict comparisons: with a start in cycle k the condition is first true in cycle k + m, m the smallest
/// number with m * T > L.
#[test]
fn a_strict_limit_is_exceeded_in_the_first_cycle_above_it() {
    for (cycle, limit, first) in [
        (10_000, "0.02", 3),
        (10_000, "0.0201", 3),
        (10_000, "0.0299", 3),
        (10_000, "0.03", 4),
        (10_000, "0.0", 1),
        (7_000, "0.02", 3),
        (7_000, "0.021", 4),
        (7_000, "0.020999", 3),
        (30_000, "0.02", 1),
    ] {
        let blocks = format!(
            "IDS=1 EVERY $A_INSE[1] DO $A_TIMERSI[4] = 0\nIDS=2 DO $A_OUTSE[1] = ($A_TIMERSI[4] > {limit})"
        );
        let mut spl = Spl::new(&blocks, &interface(), cycle);
        let found = (0..20).find(|_| spl.step(&[("a", 1)])[0] == 1);
        assert_eq!(found, Some(first), "{cycle} µs, {limit} s");
    }
}

/// S840D-LANG-712.
#[test]
fn a_timer_that_was_never_started_is_at_0_or_beyond_all_limits() {
    let blocks = "IDS=1 WHENEVER $A_INSE[1] DO $A_TIMERSI[1] = 0\n\
                  IDS=2 DO $A_OUTSE[1] = ($A_TIMERSI[1] < 0.02)";
    for large in [false, true] {
        let readings = Readings {
            timers_begin_large: large,
            ..Readings::default()
        };
        let interface = Interface {
            readings,
            ..interface()
        };
        output_is(blocks, &interface, 6, |past| {
            let started = past.iter().rposition(|(a, _)| *a);
            started.map_or(!large, |k| past.len() - 1 - k < 2)
        });
    }
    // A timer that nothing sets is there too; such a comparison is the same in each cycle.
    let mut spl = Spl::new(
        "IDS=2 DO $A_OUTSE[1] = ($A_TIMERSI[1] < 0.02)",
        &interface(),
        10_000,
    );
    assert_eq!((spl.step(&[])[0], spl.cells()), (1, 0));
}

/// A past of a relay: E, Q1, Q2.
type Calls<'p> = &'p [[bool; 3]];

/// A0 of a relay with a window of so many cycles: from the past alone.
fn a0(past: Calls<'_>, window: usize, level: bool) -> bool {
    let Some(([e, ..], before)) = past.split_last() else {
        return false;
    };
    let acknowledges = |q: usize| {
        let last = before.last().is_some_and(|was| was[q]);
        past[past.len() - 1][q] && (level || !last)
    };
    // The longest time without E since A0 was there.
    let lost = (1..=before.len())
        .rev()
        .find(|n| a0(&before[..*n], window, level));
    let soon = lost.is_some_and(|n| {
        let phases = before[n..].split(|[e, ..]| *e);
        phases.map(<[_]>::len).max().unwrap_or(0) < window
    });
    *e && (lost == Some(before.len()) && !before.is_empty()
        || acknowledges(1)
        || (acknowledges(2) && soon))
}

/// S840D-RELAY-001, S840D-RELAY-002, S840D-RELAY-003, S840D-RELAY-005, S840D-RELAY-006, S840D-RELAY-009, S840D-RELAY-010,
/// S840D-RELAY-011.
#[test]
fn a_relay_holds_until_its_inputs_fall_and_wants_an_acknowledgement() {
    let blocks = "DEF INT S\n\
                  SIRELIN(1, S, \"$A_INSE[2]\", \"$A_MARKERSI[3]\", \"$A_INSE[1]\")\n\
                  SIRELOUT(1, S, \"$A_OUTSE[1]\", \"$A_OUTSE[2]\")\n\
                  SIRELTIME(1, S, 0.02, 0.015)\n\
                  IDS=1 DO $A_MARKERSI[3] = $A_INSI[1]\n\
                  IDS=2 DO $AC_MARKER[1] = SIRELAY(1)";
    for level in [false, true] {
        let readings = Readings {
            relay_acknowledged_by_level: level,
            ..Readings::default()
        };
        let interface = Interface {
            readings,
            ..interface()
        };
        let mut spl = Spl::new(blocks, &interface, 10_000);
        let mut seen = [[false; 2]; 2];
        for inputs in sequences(8, 6) {
            spl.restart();
            let mut past = Vec::new();
            for input in inputs {
                let bits = [0, 1, 2].map(|k| input >> k & 1);
                past.push(bits.map(|bit| bit == 1));
                let given = [("a", bits[0]), ("b", bits[1]), ("insi_1", bits[2])];
                let out = spl.step(&given.map(|(name, bit)| (name, bit as i32)));
                // 20 ms are two cycles; 15 ms end in the second one after the fall.
                let is = |n: usize| a0(&past[..n], 2, level);
                let now = is(past.len());
                let late = now || (1..=2).any(|ago| past.len() > ago && is(past.len() - ago));
                seen[0][usize::from(now)] = true;
                seen[1][usize::from(late)] = true;
                assert_eq!((out[0] == 1, out[1] == 1), (now, late), "{level}: {past:?}");
                assert_eq!(out[2], 0, "the status");
            }
        }
        assert_eq!(seen, [[true; 2]; 2]);
    }
}

/// The status of S840D-RELAY-012 for each part that is missing; nothing is on then.
#[test]
fn a_relay_that_is_not_set_up_says_so_and_gives_0() {
    let input = "SIRELIN(1, S, \"$A_INSE[2]\", \"$A_MARKERSI[3]\", \"$A_INSE[1]\")\n";
    let output = "SIRELOUT(1, S, \"$A_OUTSE[1]\")\n";
    let times = "SIRELTIME(1, S, 0.02)\n";
    for missing in 0..8 {
        let part = |bit: i64, text: &str| {
            if missing & bit == 0 {
                text.to_owned()
            } else {
                String::new()
            }
        };
        let blocks = format!(
            "DEF INT S\n{}{}{}IDS=2 DO $AC_MARKER[1] = SIRELAY(1)",
            part(1, input),
            part(2, output),
            part(4, times)
        );
        let mut spl = Spl::new(&blocks, &interface(), 10_000);
        let out = spl.step(&[("a", 1), ("b", 1)]);
        assert_eq!(out, [i64::from(missing == 0), 0, missing], "{blocks}");
    }
}

/// The example of the language's description, cycle by cycle: section 14.
#[test]
fn the_run_on_of_a_pump() {
    let blocks = "N10 DEFINE PUMP_OK AS $A_INSE[1]\n\
                  N20 DEFINE PUMP_ON AS $A_OUTSE[1]\n\
                  N30 DEFINE RUNON   AS $A_TIMERSI[9]\n\
                  N40 IDS=70 EVERY PUMP_OK == 0 DO RUNON = 0          ; start run-on time\n\
                  N50 IDS=71 EVERY PUMP_OK == 1 DO PUMP_ON = 1 RUNON = -1\n\
                  N60 IDS=72 EVERY (RUNON > 0.02) AND NOT PUMP_OK DO PUMP_ON = 0";
    let mut spl = Spl::new(blocks, &interface(), 10_000);
    let given = [1, 1, 0, 0, 0, 0, 1].map(|ok| spl.step(&[("a", ok)])[0]);
    assert_eq!(given, [1, 1, 1, 1, 1, 0, 1]);
    // The output, the time and whether it runs, three edges: nothing else is kept.
    assert_eq!(spl.cells(), 6);
}
