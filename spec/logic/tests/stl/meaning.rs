//! Checks, edges, timers, jumps and the safety relay against definitions that speak of the whole past, over every sequence of inputs up to
//! a length. They keep no state, so that they share nothing with the translation.

use super::rig::{Plc, interface, sequences};

/// A past: `a` and `b` in each cycle so far.
type Past<'p> = &'p [(bool, bool)];

/// Runs a program over all sequences of `a` and `b`, against what `p` is from the past. A cycle has 10 ms.
fn output_is(text: &str, length: u32, p: impl Fn(Past<'_>) -> bool) {
    let mut plc = Plc::new(text, &interface(), 10_000);
    let mut seen = [false; 2];
    for inputs in sequences(4, length) {
        plc.restart();
        let mut past = Vec::new();
        for input in inputs {
            past.push((input % 2 == 1, input / 2 == 1));
            let out = plc.step(&[("a", (input % 2) as i32), ("b", (input / 2) as i32)]);
            let expected = p(&past);
            seen[usize::from(expected)] = true;
            assert_eq!(out[0], expected, "{text}: {past:?}");
        }
    }
    assert_eq!(seen, [true; 2], "{text}: always the same");
}

fn last(past: Past<'_>) -> (bool, bool) {
    past[past.len() - 1]
}

/// `p` of `a`, `b`, `c` in one cycle, for all eight.
fn table(text: &str, expected: impl Fn(bool, bool, bool) -> bool) {
    let mut plc = Plc::new(text, &interface(), 10_000);
    for k in 0..8 {
        let [a, b, c] = [0, 1, 2].map(|bit| k >> bit & 1);
        plc.restart();
        let out = plc.step(&[("a", a), ("b", b), ("c", c)]);
        let [x, y, z] = [a, b, c].map(|v| v == 1);
        assert_eq!(out[0], expected(x, y, z), "{text}: {a} {b} {c}");
    }
}

#[test]
fn checks_are_combined_from_left_to_right() {
    table("U E 0.0\nU E 0.1\n= A 4.0", |a, b, _| a && b);
    table("U E 0.0\nUN E 0.1\n= A 4.0", |a, b, _| a && !b);
    table("O E 0.0\nO E 0.1\nU E 0.2\n= A 4.0", |a, b, c| {
        (a || b) && c
    });
    table("U E 0.0\nU E 0.1\nO E 0.2\n= A 4.0", |a, b, c| {
        (a && b) || c
    });
    table("X E 0.0\nX E 0.1\nXN E 0.2\n= A 4.0", |a, b, c| a ^ b ^ !c);
    table("ON E 0.0\nON E 0.1\n= A 4.0", |a, b, _| !a || !b);
    table("A I 0.0\nAN I 0.1\nNOT\n= Q 4.0", |a, b, _| !a || b);
}

/// O without operand: AND before OR.
#[test]
fn o_alone_combines_what_stands_before_and_behind_it() {
    table(
        "U E 0.0\nU E 0.1\nO\nU E 0.2\nUN E 0.0\n= A 4.0",
        |a, b, c| (a && b) || (c && !a),
    );
    table(
        "U E 0.0\nO\nU E 0.1\nU E 0.2\nO\nUN E 0.2\n= A 4.0",
        |a, b, c| [a, b && c, !c].contains(&true),
    );
    // A check with O behind it is combined with all of it.
    table("U E 0.0\nO\nU E 0.1\nX E 0.2\n= A 4.0", |a, b, c| {
        (a || b) ^ c
    });
}

#[test]
fn brackets_come_first() {
    table("U E 0.0\nU(\nO E 0.1\nO E 0.2\n)\n= A 4.0", |a, b, c| {
        a && (b || c)
    });
    table(
        "U(\nU E 0.0\nO E 0.1\n)\nUN(\nU E 0.1\nU E 0.2\n)\n= A 4.0",
        |a, b, c| (a || b) && !(b && c),
    );
    table(
        "U E 0.0\nO(\nX(\nU E 0.1\nU E 0.2\n)\nX E 0.2\n)\n= A 4.0",
        |a, b, c| a || ((b && c) ^ c),
    );
}

/// The result stays as it was computed, whatever is written with it.
#[test]
fn the_result_is_kept_while_it_is_used() {
    // M 1.0 is reset with the result that it is part of.
    output_is(
        "U E 0.0\nS M 1.0\nU M 1.0\nU E 0.1\nR M 1.0\n= A 4.0",
        5,
        |past| {
            let set = |n: usize| {
                // Set by a, reset by b once it is set.
                let mut on = false;
                for (a, b) in &past[..n] {
                    on |= a;
                    if on && *b {
                        on = false;
                    }
                }
                on
            };
            let n = past.len();
            (set(n - 1) || past[n - 1].0) && past[n - 1].1
        },
    );
    table(
        "U E 0.0\n= M 1.0\nNOT\n= M 1.1\nU M 1.1\nUN M 1.0\n= A 4.0",
        |a, _, _| !a,
    );
    table("SET\n= A 4.0", |_, _, _| true);
    table(
        "SET\nCLR\n= A 4.0\nSET\n= M 1.0\nU M 1.0\nU E 0.1\n= A 4.0",
        |_, b, _| b,
    );
}

#[test]
fn set_and_reset_the_last_one_wins() {
    output_is("U E 0.0\nS A 4.0\nU E 0.1\nR A 4.0", 6, |past| {
        let set = past.iter().rposition(|(a, b)| *a && !b);
        let reset = past.iter().rposition(|(_, b)| *b);
        set > reset
    });
    output_is("U E 0.1\nR A 4.0\nU E 0.0\nS A 4.0", 6, |past| {
        let set = past.iter().rposition(|(a, _)| *a);
        let reset = past.iter().rposition(|(a, b)| *b && !a);
        set > reset
    });
}

#[test]
fn edges_last_a_cycle() {
    let before = |past: Past<'_>| past.len() > 1 && past[past.len() - 2].0;
    output_is("U E 0.0\nFP M 1.0\n= A 4.0", 6, |past| {
        last(past).0 && !before(past)
    });
    output_is("U E 0.0\nFN M 1.0\n= A 4.0", 6, |past| {
        !last(past).0 && before(past)
    });
    // What stands behind an edge is combined with it.
    output_is("U E 0.0\nFP M 1.0\nU E 0.1\n= A 4.0", 6, |past| {
        last(past).0 && !before(past) && last(past).1
    });
}

/// For how many cycles up to now, this one not counted, `a` has been so without a break.
fn stood(past: Past<'_>, level: bool) -> usize {
    let run = past.iter().rev().take_while(|(a, _)| *a == level);
    run.count()
}

/// A timer of 30 ms is three cycles.
#[test]
fn on_delay() {
    for text in [
        "U E 0.0\nL S5T#30MS\nSE T 1\nU T 1\n= A 4.0",
        "A I 0.0\nL S5T#30MS\nSD T 1\nA T 1\n= Q 4.0",
    ] {
        output_is(text, 8, |past| stood(past, true) > 3);
    }
    // Rounded up: 20 ms and 25 ms in cycles of 10 ms would differ; a timer counts steps of 10 ms, and cycles of 7 ms need three for 20 ms.
    let mut plc = Plc::new(
        "U E 0.0\nL S5T#20MS\nSE T 1\nU T 1\n= A 4.0",
        &interface(),
        7_000,
    );
    let seen: Vec<bool> = (0..5).map(|_| plc.step(&[("a", 1)])[0]).collect();
    assert_eq!(seen, [false, false, false, true, true]);
}

/// After a reset it begins again with the next edge.
#[test]
fn an_on_delay_is_reset() {
    output_is(
        "U E 0.0\nL S5T#20MS\nSE T 1\nU E 0.1\nR T 1\nU T 1\n= A 4.0",
        7,
        |past| {
            let n = stood(past, true);
            let reset = past[past.len() - n..].iter().any(|(_, b)| *b);
            n > 2 && !reset
        },
    );
}

#[test]
fn off_delay() {
    output_is("U E 0.0\nL S5T#20MS\nSA T 1\nU T 1\n= A 4.0", 8, |past| {
        let off = stood(past, false);
        off == 0 || (off <= 2 && off < past.len())
    });
}

#[test]
fn pulses() {
    // On with a, at most two cycles.
    output_is("U E 0.0\nL S5T#20MS\nSI T 1\nU T 1\n= A 4.0", 8, |past| {
        let on = stood(past, true);
        (1..=2).contains(&on)
    });
    // Two cycles from each edge on.
    output_is("U E 0.0\nL S5T#20MS\nSV T 1\nU T 1\n= A 4.0", 8, |past| {
        let edge = |k: usize| past[k].0 && (k == 0 || !past[k - 1].0);
        (past.len().saturating_sub(2)..past.len()).any(edge)
    });
    output_is("A I 0.0\nL S5T#20MS\nSE T 1\nA T 1\n= Q 4.0", 8, |past| {
        let edge = |k: usize| past[k].0 && (k == 0 || !past[k - 1].0);
        (past.len().saturating_sub(2)..past.len()).any(edge)
    });
}

#[test]
fn a_retentive_delay_waits_for_its_reset() {
    output_is(
        "U E 0.0\nL S5T#20MS\nSS T 1\nU E 0.1\nR T 1\nU T 1\n= A 4.0",
        7,
        |past| {
            let edge = |k: &usize| past[*k].0 && (*k == 0 || !past[*k - 1].0);
            let last = (0..past.len()).rev().find(edge);
            last.is_some_and(|from| {
                past.len() - 1 - from >= 2 && !past[from..].iter().any(|(_, b)| *b)
            })
        },
    );
}

/// A timer that was not reached in a cycle goes on.
#[test]
fn a_timer_goes_on_where_it_is_left_out() {
    output_is(
        "U E 0.1\nSPB M001\nU E 0.0\nL S5T#20MS\nSE T 1\nM001: NOP 0\nU T 1\n= A 4.0",
        7,
        |past| {
            // The last cycles that reached it.
            let reached: Vec<usize> = (0..past.len()).filter(|k| !past[*k].1).collect();
            let on = reached.iter().rev().take_while(|k| past[**k].0).count();
            let begun = reached.len().checked_sub(on).and_then(|k| reached.get(k));
            begun.is_some_and(|begun| past.len() - 1 - begun >= 2)
        },
    );
}

#[test]
fn jumps_leave_out_what_lies_before_their_label() {
    table(
        "U E 0.0\nSPB M001\nU E 0.1\n= A 4.0\nM001: NOP 0",
        |a, b, _| !a && b,
    );
    table(
        "U E 0.0\nSPBN M001\nU E 0.1\n= A 4.0\nM001: NOP 0",
        |a, b, _| a && b,
    );
    table("U E 0.0\n= M 1.0\nJUMP:\nU E 0.1\n= A 4.0", |_, b, _| b);
    // One of two ways.
    table(
        "U E 0.0\nSPB M001\nU E 0.1\n= A 4.0\nSPA M002\nM001: U E 0.2\n= A 4.0\nM002: NOP 0",
        |a, b, c| {
            if a { c } else { b }
        },
    );
    // Who has not jumped has a result of 1.
    table("U E 0.0\nSPB M001\n= A 4.0\nM001: NOP 0", |a, _, _| !a);
    // Jumps that cross.
    table(
        "U E 0.0\nSPB M001\nU E 0.1\nSPB M002\nSET\n= A 4.0\nM001: U E 0.2\n= M 1.0\nM002: U M 1.0\nS A 4.0",
        |a, b, c| match (a, b) {
            (true, _) => c,
            (false, true) => false,
            (false, false) => true,
        },
    );
}

#[test]
fn numbers_are_loaded_transferred_and_compared() {
    output_is(
        "U E 0.0\nSPB M001\nL 1\nT MB 10\nM001: NOP 0\nU E 0.1\nSPB M002\nL 2\nT MB 10\nM002: NOP 0\nL MB 10\nL 1\n==I\n= A 4.0",
        4,
        |past| {
            let one = past.iter().rposition(|(a, b)| !a && *b);
            let two = past.iter().rposition(|(_, b)| !b);
            one > two
        },
    );
    // The second accumulator is compared with the first.
    for (relation, expected) in [
        (">I", true),
        ("<I", false),
        (">=I", true),
        ("<=I", false),
        ("<>I", true),
        ("==I", false),
    ] {
        let text = format!("L 5\nL 3\n{relation}\nU E 0.0\n= A 4.0");
        table(&text, |a, _, _| a && expected);
    }
    // A check that has been made sees nothing of what is transferred behind it.
    table(
        "U E 0.0\n= M 2.3\nU M 2.3\nL 0\nT MB 2\nU E 0.1\n= A 4.0",
        |a, b, _| a && b,
    );
    // A constant is written bit by bit, the highest byte first.
    table(
        "L W#16#0104\nT MW 20\nU M 20.0\nU M 21.2\nUN M 21.0\nU E 0.0\n= A 4.0",
        |a, _, _| a,
    );
}

const CALLS: &str = "ORGANIZATION_BLOCK OB 100\nBEGIN\nSET\nS M 7.0\nEND_ORGANIZATION_BLOCK\n\
FUNCTION FC 1 : VOID\nTITLE =anything, \"even\" this\nVERSION : 0.1\nBEGIN\nNETWORK\nTITLE =\nU E 0.0\nBEB\nU E 0.1\n= A 4.0;\nEND_FUNCTION\n\
ORGANIZATION_BLOCK OB 1\nCALL FC 1\nU E 0.2\nCC FC 2\nEND_ORGANIZATION_BLOCK\n\
FUNCTION FC 2 : VOID\nBEGIN\nSET\nR A 4.0\nEND_FUNCTION\n";

#[test]
fn blocks_stand_where_they_are_called() {
    let mut plc = Plc::new(CALLS, &interface(), 10_000);
    let out = |plc: &mut Plc, a, b, c| plc.step(&[("a", a), ("b", b), ("c", c)])[0];
    assert!(out(&mut plc, 0, 1, 0));
    // With `a` the block ends before it writes.
    assert!(out(&mut plc, 1, 0, 0));
    assert!(!out(&mut plc, 1, 1, 1));
    assert!(out(&mut plc, 0, 1, 0));
}

/// What no output depends on is no state.
#[test]
fn what_nothing_needs_is_left_out() {
    let timer = "U E 0.1\nL S5T#1S\nSE T 1\nU T 1\n";
    let unused = Plc::new(
        &format!("U E 0.0\n= A 4.0\n{timer}= M 1.0"),
        &interface(),
        10_000,
    );
    assert_eq!(unused.cells(), 0);
    let used = Plc::new(&format!("{timer}= A 4.0"), &interface(), 10_000);
    assert_eq!(used.cells(), 3);
}

/// OB 100 runs once, before the first run of OB 1.
#[test]
fn the_start_runs_once() {
    let text = "ORGANIZATION_BLOCK OB 100\nSET\nS A 4.0\nS A 4.1\nEND_ORGANIZATION_BLOCK\n\
                ORGANIZATION_BLOCK OB 1\nU E 0.0\nR A 4.0\nEND_ORGANIZATION_BLOCK";
    let mut plc = Plc::new(text, &interface(), 10_000);
    assert_eq!(plc.step(&[]), [true, true]);
    assert_eq!(plc.step(&[("a", 1)]), [false, true]);
    assert_eq!(plc.step(&[]), [false, true]);
}

/// FB10 over the whole past: S840D-RELAY-014, S840D-RELAY-018.
#[test]
fn the_safety_relay() {
    let text = "CALL FB 10, DB 80 (\nIn1 := E 0.0,\nQuit1 := E 0.1,\nTimeValue1 := T#20MS,\nOut0 := A 4.0,\nOut1 := A 4.1)";
    let mut plc = Plc::new(text, &interface(), 10_000);
    for inputs in sequences(4, 7) {
        plc.restart();
        let mut past: Vec<(bool, bool)> = Vec::new();
        for input in inputs {
            past.push((input % 2 == 1, input / 2 == 1));
            let [a0, a1] = plc.step(&[("a", (input % 2) as i32), ("b", (input / 2) as i32)]);
            // On since an edge of the button with the input closed, if the input has been closed since.
            let on = |n: usize| {
                let closed = past[..n].iter().rev().take_while(|(a, _)| *a).count();
                (n - closed..n).any(|k| past[k].1 && k > 0 && !past[k - 1].1)
            };
            let n = past.len();
            assert_eq!(a0, on(n), "{past:?}");
            let late = (1..=2).any(|k| n > k && on(n - k));
            assert_eq!(a1, on(n) || late, "{past:?}");
        }
    }
}

/// The second acknowledgement of FB10 counts only after the first one, and has no time limit: S840D-RELAY-008.
#[test]
fn the_second_acknowledgement_has_no_limit_in_the_plc() {
    let text = "CALL \"SI_RELAY\", \"DB\" (In1 := E 0.0, Quit1 := E 0.1, Quit2 := E 0.2, Out0 := A 4.0, FirstRun := M 1.0)";
    let mut plc = Plc::new(text, &interface(), 10_000);
    let mut out = |a, b, c| plc.step(&[("a", a), ("b", b), ("c", c)])[0];
    out(1, 0, 0);
    assert!(!out(1, 0, 1), "before the first acknowledgement");
    out(1, 0, 0);
    assert!(out(1, 1, 0));
    for _ in 0..200 {
        assert!(!out(0, 0, 0));
    }
    assert!(out(1, 0, 1), "after two seconds");
}

/// The steps of FB11 in their order, each left at the latest when its time is over: S840D-BRAKE-708, S840D-BRAKE-709, S840D-BRAKE-710.
#[test]
fn the_brake_test() {
    let plc = |outputs: &str| {
        let text = format!(
            "CALL FB 11 (\nStart := E 0.0,\nQuit := E 0.1,\nBclosed := E 0.2,\nAxis := 3,\nTV_BTactiv := T#20MS,\nTV_Bclose := T#30MS,\nTV_FeedCommand := T#40MS,\nTV_FXSreached := T#50MS,\nTV_FXShold := T#60MS,\n{outputs})"
        );
        Plc::new(&text, &interface(), 10_000)
    };
    // What is there from each cycle on: the start, then the feedback of each step.
    let feedback = ["a", "db33_dbx71_0", "c", "db33_dbx64_6", "db33_dbx62_5"];
    let inputs = |cycle: usize, known: usize, active: i32| {
        let mut list = vec![("fb11_1_ready", 1), ("db33_dbx63_1", 1)];
        let there = feedback.iter().take(cycle.min(known));
        let there = there.filter(|name| active == 1 || **name != "db33_dbx71_0");
        list.extend(there.map(|name| (*name, 1)));
        list
    };
    // From the cycle of the start on: 1 selected, 2 closes, 3 commanded, 4 runs, 5 holds for six cycles, then it is deselected.
    let (mut moves, mut ends) = (
        plc("CloseBrake := A 4.0,\nMoveAxis := A 4.1"),
        plc("Done := A 4.0,\nError := A 4.1"),
    );
    for cycle in 0..14 {
        let now = inputs(cycle, 5, i32::from(cycle < 12));
        assert_eq!(
            moves.step(&now),
            [(2..11).contains(&cycle), (3..11).contains(&cycle)],
            "{cycle}"
        );
        assert_eq!(ends.step(&now), [cycle >= 12, false], "{cycle}");
    }
    // A feedback that does not come, and the longest time of its step.
    for (known, longest) in [(1, 2), (2, 3), (3, 4), (4, 5)] {
        ends.restart();
        for cycle in 0..20 {
            let failed = cycle >= known + longest;
            assert_eq!(
                ends.step(&inputs(cycle, known, 1)),
                [false, failed],
                "{known}, {cycle}"
            );
        }
        // Acknowledged, and a start that stays is none.
        let mut quit = inputs(20, known, 1);
        quit.push(("b", 1));
        assert_eq!(ends.step(&quit), [false, false]);
        assert_eq!(ends.step(&inputs(21, known, 1)), [false, false]);
    }
    // A test that stays selected, a brake that gives way, an axis that is not the PLC's.
    ends.restart();
    for cycle in 0..20 {
        assert_eq!(
            ends.step(&inputs(cycle, 5, 1)),
            [false, cycle >= 13],
            "{cycle}"
        );
    }
    ends.restart();
    for cycle in 0..20 {
        let known = if cycle < 8 { 5 } else { 4 };
        assert_eq!(
            ends.step(&inputs(cycle, known, 1)),
            [false, cycle >= 8],
            "{cycle}"
        );
    }
    ends.restart();
    ends.step(&[]);
    assert_eq!(ends.step(&[("a", 1), ("fb11_1_ready", 1)]), [false, true]);
}

/// What a block of the control gives is free while it is started, and 0 else.
#[test]
fn blocks_that_are_not_read_can_give_anything() {
    let text = "CALL FC 60 (\nstart := E 0.0,\nnum_axis := 2,\nready := A 4.0,\nerror := A 4.1)";
    let mut plc = Plc::new(text, &interface(), 10_000);
    assert_eq!(plc.step(&[("a", 1), ("fc60_1_ready", 1)]), [true, false]);
    assert_eq!(plc.step(&[("a", 0), ("fc60_1_ready", 1)]), [false, false]);
    assert_eq!(plc.step(&[("a", 1), ("fc60_1_error", 1)]), [false, true]);
}
