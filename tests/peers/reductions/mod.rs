//! Reductions keep verdicts: every reduced check says what the unreduced one says, and its runs are real.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use stillpoint_engine::{self as engine, Outcome, label, replay};
use stillpoint_engine::{Reductions, reduce};
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::Form;
use stillpoint_model::{Options, Verdict, Way};

pub(crate) mod random;
pub(crate) mod shipped;
mod small;
mod timers;

pub(crate) const SLICE: Reductions = Reductions {
    slice: true,
    symmetry: false,
    timers: false,
};
pub(crate) const SYMMETRY: Reductions = Reductions {
    slice: false,
    symmetry: true,
    timers: false,
};

pub(crate) const TIMERS: Reductions = Reductions {
    slice: false,
    symmetry: false,
    timers: true,
};

/// The one system with that many transitions that is compared here: what the reductions gain shows in it.
pub(crate) const YARDSTICK: &str = "bench/two-axis/two_axis";

/// All systems of a text.
pub(crate) fn systems(text: &str) -> Vec<Bound> {
    let source: Arc<str> = text.into();
    let spec =
        Spec::from_text(Path::new("t.toml"), source).unwrap_or_else(|e| panic!("{e}\n{text}"));
    of(&spec)
}

/// All systems of a specification with its defaults.
pub(crate) fn of(spec: &Spec) -> Vec<Bound> {
    let names: Vec<String> = spec.systems().map(str::to_owned).collect();
    let bound = |name: &String| {
        let system = spec.system(name, None).unwrap_or_else(|e| panic!("{e}"));
        Bound::new(system, &BTreeMap::new(), &BTreeMap::new()).expect("the defaults fit")
    };
    names.iter().map(bound).collect()
}

pub(crate) fn options() -> Options {
    let mut options = Options {
        witnesses: false,
        way: Way::Single,
        ..Options::default()
    };
    options.limits.threads = 1;
    options
}

pub(crate) fn full(bound: &Bound, interpret: bool) -> Outcome {
    engine::run(bound, &options(), interpret, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

pub(crate) fn reduced(bound: &Bound, interpret: bool, how: Reductions) -> Outcome {
    reduce::run(bound, &options(), interpret, how, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// Compares the judgements and looks at the runs of the reduced one. The explorations made.
pub(crate) fn compare(bound: &Bound, whole: &Outcome, part: &Outcome, context: &str) -> usize {
    assert_eq!(whole.report.complete, part.report.complete, "{context}");
    let faults = |o: &Outcome| -> Vec<(u32, Option<u64>)> {
        o.report.faults.iter().map(|f| (f.code, f.length)).collect()
    };
    assert_eq!(faults(whole), faults(part), "{context}");
    assert_eq!(whole.refuted, part.refuted, "{context}");
    let both = whole.report.properties.iter().zip(&part.report.properties);
    for (k, (property, (a, b))) in bound.system.properties.iter().zip(both).enumerate() {
        let name = format!("{} of {context}", label(property));
        assert_eq!((&a.id, a.verdict), (&b.id, b.verdict), "{name}");
        assert_eq!((a.bound, a.fastest), (b.bound, b.fastest), "{name}");
        // A run with a loop need not be the shortest one.
        let looped = |t: &Option<stillpoint_model::Trace>| {
            t.as_ref().is_some_and(|t| t.loop_start.is_some())
        };
        assert_eq!(looped(&a.trace), looped(&b.trace), "{name}");
        if !looped(&a.trace) {
            assert_eq!(a.length, b.length, "{name}");
        }
        assert_eq!(a.trace.is_some(), b.trace.is_some(), "{name}");
        if let (Some(trace), Verdict::Violated | Verdict::Reached) = (&b.trace, b.verdict) {
            real(bound, k, trace, part, &name);
        }
    }
    part.reduction
        .as_ref()
        .map_or(0, |r| if r.whole.is_some() { 1 } else { r.parts.len() })
}

/// The run is one of the whole system, and it shows what it is said to show.
pub(crate) fn real(
    bound: &Bound,
    k: usize,
    trace: &stillpoint_model::Trace,
    part: &Outcome,
    name: &str,
) {
    let cycles = replay(bound, trace);
    assert_eq!(
        cycles.len(),
        trace.steps.len(),
        "{name}: no fault on the way"
    );
    for pair in cycles.windows(2) {
        assert_eq!(pair[0].frame.now, pair[1].frame.before, "{name}");
    }
    let Some(last) = cycles.last() else { return };
    if let Some(start) = trace.loop_start {
        let first = &cycles[start].frame.before;
        assert_eq!(&last.frame.now, first, "{name}: the loop is closed");
    }
    let atom = |k: usize, frame: &Frame| {
        let mut frame = frame.clone();
        let choices = &last.choices;
        bound.atom(k, &mut frame, &mut |i| {
            let read = choices.iter().find(|(n, _)| *n as usize == i);
            bound.inputs[i].0 + read.map_or(0, |(_, v)| *v as i32)
        })
    };
    match &bound.system.properties[k].form {
        Form::Always { when, then } => {
            assert!(when.is_none_or(|w| atom(w, &last.frame)), "{name}");
            assert!(!atom(*then, &last.frame), "{name}");
        }
        Form::Reachable { goal } => assert!(atom(*goal, &last.frame), "{name}"),
        Form::Unless { holds, unless, .. } => {
            assert!(
                !atom(*holds, &last.frame) && !atom(*unless, &last.frame),
                "{name}"
            );
        }
        Form::Independent { observe, .. } => {
            let second = part.pairs.get(&k).and_then(|p| p.second.as_ref());
            let second = replay(bound, second.expect("a second run"));
            assert_eq!(second.len(), cycles.len(), "{name}");
            let value = |c: &engine::Cycle, o: usize| {
                let mut frame = c.frame.clone();
                bound.observe(o, &mut frame, &mut |i| {
                    let read = c.choices.iter().find(|(n, _)| *n as usize == i);
                    bound.inputs[i].0 + read.map_or(0, |(_, v)| *v as i32)
                })
            };
            let other = second.last().expect("a cycle");
            assert!(
                observe.iter().any(|o| value(last, *o) != value(other, *o)),
                "{name}"
            );
        }
        Form::LeadsTo { .. } | Form::CanAlwaysReach { .. } => {}
    }
}
