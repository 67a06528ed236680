//! Function blocks against what IEC 61131-3 says of them, over every sequence of inputs up to a length. The references speak of the
//! whole past, not of a state, so that they share nothing with the blocks.

use super::rig::{Plc, whole};

/// A call of a timer: in which cycle, and with which IN.
type Call = (i64, bool);

/// Q and ET of a timer after the last of its calls.
type Timer = fn(&[Call], i64) -> (bool, i64);

/// TON: Q when IN has been TRUE in all calls since one that is PT ago; ET counts from the first of them.
fn ton(calls: &[Call], pt: i64) -> (bool, i64) {
    let (now, _) = calls[calls.len() - 1];
    let run = calls.iter().rev().take_while(|(_, on)| *on).last();
    run.map_or((false, 0), |(start, _)| {
        (now - start >= pt, (now - start).min(pt))
    })
}

/// TOF: Q while IN is TRUE, and less than PT after the first call in which it was no more.
fn tof(calls: &[Call], pt: i64) -> (bool, i64) {
    let (now, on) = calls[calls.len() - 1];
    let Some(last) = calls.iter().rposition(|(_, on)| *on) else {
        return (false, 0);
    };
    if on {
        return (true, 0);
    }
    let (fallen, _) = calls[last + 1];
    (now - fallen < pt, (now - fallen).min(pt))
}

/// TP: a rising edge begins a pulse, unless the call before was in one; ET stays at PT while IN stays.
fn tp(calls: &[Call], pt: i64) -> (bool, i64) {
    let Some((&(now, on), past)) = calls.split_last() else {
        return (false, 0);
    };
    let ((running, was), rises) = (tp(past, pt), past.last().is_none_or(|(_, before)| !before));
    if on && rises && !running {
        return (pt > 0, 0);
    }
    match running {
        true => {
            let age = now - begun(past, pt);
            (age < pt, if age < pt || on { age.min(pt) } else { 0 })
        }
        false => (false, if on { was } else { 0 }),
    }
}

/// When the pulse began that the last call was in.
fn begun(calls: &[Call], pt: i64) -> i64 {
    let first = (1..=calls.len())
        .rev()
        .take_while(|k| tp(&calls[..*k], pt).0)
        .last();
    // Two pulses never touch: between them lies the call that ended the first.
    calls[first.unwrap_or(1) - 1].0
}

/// Every sequence of `length` values below `base`.
fn sequences(base: usize, length: u32) -> impl Iterator<Item = Vec<usize>> {
    (0..base.pow(length)).map(move |mut number| {
        (0..length)
            .map(|_| {
                let value = number % base;
                number /= base;
                value
            })
            .collect()
    })
}

fn timer_is(name: &str, reference: Timer) {
    for pt in 0..=4 {
        // m is ET in cycles, counted by comparison: times and numbers do not mix.
        let ranks = "IF t.ET >= T#4ms THEN m := 4; ELSIF t.ET >= T#3ms THEN m := 3; ELSIF t.ET >= T#2ms THEN m := 2; \
                     ELSIF t.ET >= T#1ms THEN m := 1; ELSE m := 0; END_IF;";
        let called = whole(
            &format!("VAR t : {name}; END_VAR"),
            &format!("t(IN := a, PT := T#{pt}ms, Q => p); {ranks}"),
        );
        let mut plc = Plc::new(&called);
        assert!(plc.cells() <= 6, "{name}: {} cells", plc.cells());
        for inputs in sequences(2, 10) {
            plc.restart();
            let mut calls = Vec::new();
            for (cycle, on) in inputs.iter().enumerate() {
                calls.push((cycle as i64, *on == 1));
                let out = plc.step(&[("a", *on as i32)]).expect("no fault");
                let (q, et) = reference(&calls, pt);
                assert_eq!((out[0] == 1, out[2]), (q, et), "{name} PT {pt}: {calls:?}");
            }
        }
        // A call that is left out does not stop the time.
        let sometimes = whole(
            &format!("VAR t : {name} := (PT := T#{pt}ms); END_VAR"),
            &format!("IF b THEN t(IN := a); END_IF; p := t.Q; {ranks}"),
        );
        let mut plc = Plc::new(&sometimes);
        for inputs in sequences(4, 6) {
            plc.restart();
            let (mut calls, mut expected) = (Vec::new(), (false, 0));
            for (cycle, input) in inputs.iter().enumerate() {
                let (on, called) = (input % 2 == 1, input / 2 == 1);
                if called {
                    calls.push((cycle as i64, on));
                    expected = reference(&calls, pt);
                }
                let out = plc
                    .step(&[("a", i32::from(on)), ("b", i32::from(called))])
                    .expect("no fault");
                assert_eq!(
                    (out[0] == 1, out[2]),
                    expected,
                    "{name} PT {pt}: {calls:?} in cycle {cycle}"
                );
            }
        }
    }
}

#[test]
fn an_on_delay_waits() {
    timer_is("TON", ton);
}

#[test]
fn an_off_delay_stays() {
    timer_is("TOF", tof);
}

#[test]
fn a_pulse_has_its_length() {
    timer_is("TP", tp);
}

/// A block with up to two inputs against what its output is, from all inputs so far.
fn block_is(declared: &str, call: &str, reference: fn(&[(bool, bool)]) -> bool) {
    let mut plc = Plc::new(&whole(&format!("VAR x : {declared}; END_VAR"), call));
    for inputs in sequences(4, 6) {
        plc.restart();
        let mut past = Vec::new();
        for input in inputs {
            past.push((input % 2 == 1, input / 2 == 1));
            let out = plc.step(&[("a", (input % 2) as i32), ("b", (input / 2) as i32)]);
            assert_eq!(
                out.map(|o| o[0] == 1),
                Some(reference(&past)),
                "{declared}: {past:?}"
            );
        }
    }
}

#[test]
fn edges_are_seen_once() {
    block_is("R_TRIG", "x(CLK := a); p := x.Q;", |past| {
        let before = past.len().checked_sub(2).map(|k| past[k].0);
        past[past.len() - 1].0 && before != Some(true)
    });
    // With CLK FALSE from the start Q is TRUE in the first cycle: so the standard has it.
    block_is("F_TRIG", "x(CLK := a, Q => p);", |past| {
        let before = past.len().checked_sub(2).map(|k| past[k].0);
        !past[past.len() - 1].0 && before != Some(false)
    });
}

#[test]
fn flip_flops_prefer_their_side() {
    // Set dominates: the last cycle with S or R decides, S before R.
    block_is("SR", "x(S1 := a, R := b); p := x.Q1;", |past| {
        let last = past.iter().rev().find(|(set, reset)| *set || *reset);
        last.is_some_and(|(set, _)| *set)
    });
    block_is("RS", "x(S := a, R1 := b, Q1 => p);", |past| {
        let last = past.iter().rev().find(|(set, reset)| *set || *reset);
        last.is_some_and(|(_, reset)| !reset)
    });
}
