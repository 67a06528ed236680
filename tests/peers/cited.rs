//! What a check of a machine cites of the theorems of its family, and what it does not.

use std::collections::BTreeMap;
use std::path::Path;

use stillpoint_engine::check::{Checked, Settings, check, summarise};
use stillpoint_engine::label;
use stillpoint_engine::subject::{self, Readings};
use stillpoint_engine::theorems::{Known, Proved, Theorems};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Node, System};
use stillpoint_model::Verdict;
use stillpoint_tests::root;

use super::theorems::{FAMILIES, bound, explored, folder, theorems};

type Change = fn(&mut System);

/// Whatever is changed of what decides a property, it is a theorem no more.
#[test]
fn another_table_has_other_theorems() {
    let known = theorems("sinumerik-840d");
    let file = folder("sinumerik-840d").join("axis.toml");
    let bound = bound(&file, "stop");
    let Known {
        properties: cited,
        range,
        ..
    } = known.of(&bound);
    assert!(cited.len() >= 20 && range, "{cited:?}");
    let changes: [(&str, Change); 8] = [
        ("guard", |s| {
            let rule = &mut s.instances[3].rules[0];
            rule.when = Node::Not(Box::new(rule.when.clone()));
        }),
        ("effect", |s| _ = s.instances[3].rules[1].then.pop()),
        ("order", |s| s.instances[3].rules.swap(0, 1)),
        ("range", |s| s.states[0].var.hi = Node::Const(0)),
        ("start", |s| s.states[0].init = None),
        ("input", |s| s.inputs[0].lo = Node::Const(1)),
        ("name", |s| s.lazies[0].value = Node::Const(0)),
        ("parameter", |s| s.params[0].var.hi = Node::Const(0)),
    ];
    for (what, change) in changes {
        let mut other = bound.clone();
        change(&mut other.system);
        assert_eq!(known.of(&other), Known::default(), "{what}");
    }
    // The property itself: what it says, and what its expressions mean.
    let number = cited[0];
    let mut other = bound.clone();
    other.system.properties[number].form = Form::Reachable { goal: 0 };
    assert!(!known.of(&other).properties.contains(&number));
    let (atoms, _) = bound.system.properties[number].form.expressions();
    let mut other = bound.clone();
    other.system.atoms[atoms[0]] = Node::Const(1);
    assert!(!known.of(&other).properties.contains(&number));
    // Another reading.
    let reading = bound.system.readings.first().expect("it has readings");
    let option = reading.options.last().expect("with options").clone();
    let chosen = BTreeMap::from([(reading.id.clone(), option)]);
    let other = Bound::new(bound.system.clone(), &BTreeMap::new(), &chosen).expect("an option");
    assert_eq!(known.of(&other), Known::default(), "reading");
}

/// What is known for fewer values or under conditions is told apart from what holds whatever the values are.
#[test]
fn whole_ranges_are_told_apart() {
    let all = theorems("sinumerik-840d");
    let file = folder("sinumerik-840d").join("axis.toml");
    let bound = bound(&file, "stop");
    let changed = |change: &dyn Fn(&mut Vec<Proved>)| {
        let mut known = all.clone();
        let own = known.systems.get_mut(&bound.system.name);
        change(&mut own.expect("it has theorems").proved);
        known.of(&bound)
    };
    let whole = |proved: &Proved| proved.within.is_empty() && proved.conditions.is_empty();
    let known = changed(&|proved| proved.retain(whole));
    assert!(known.everywhere && known.range, "{known:?}");
    let within = |proved: &mut Vec<Proved>| {
        for one in proved {
            one.within.insert("t_b".to_owned(), (0, 480_000));
        }
    };
    let conditions = |proved: &mut Vec<Proved>| {
        for one in proved {
            one.conditions.push("t_b >= 0".to_owned());
        }
    };
    for fewer in [changed(&within), changed(&conditions)] {
        assert!(!fewer.everywhere, "{fewer:?}");
        assert_eq!(fewer.properties, all.of(&bound).properties);
    }
    assert!(!changed(&|proved| proved.clear()).everywhere);
}

/// A machine's values outside the ranges of a proof: it is not cited.
#[test]
fn values_outside_the_ranges_are_not_covered() {
    let mut seen = 0;
    for family in FAMILIES {
        let known = theorems(family);
        for bound in explored(family) {
            let own = known.systems.get(&bound.system.name);
            let narrow = own.and_then(|own| own.proved.iter().find(|p| !p.within.is_empty()));
            let Some(narrow) = narrow else {
                continue;
            };
            let (name, (lo, hi)) = narrow.within.iter().next().expect("it is not empty");
            let params = bound.system.params.iter();
            let place = params.clone().position(|p| p.var.array() == name);
            let mut inside = bound.clone();
            for (param, value) in params.zip(&mut inside.values) {
                let name = param.var.array();
                if let Some((lo, hi)) = narrow.within.get(name) {
                    *value = i64::from(*value).clamp(*lo, *hi) as i32;
                }
            }
            let mut outside = inside.clone();
            let place = place.expect("a parameter of the system");
            outside.values[place] = *hi as i32 + 1;
            assert!(*lo <= i64::from(inside.values[place]));
            let count = |bound: &Bound| {
                let known = known.of(bound);
                known.properties.len() + usize::from(known.range)
            };
            let wide = count(&outside);
            // A property that records its bound is no citation.
            assert!(count(&inside) >= wide, "{}: {name}", bound.system.name);
            seen += usize::from(count(&inside) > wide);
        }
    }
    assert!(seen >= 10, "{seen}");
}

/// Checks a machine with and without the theorems of its family; the answer tells how many properties are known from them.
fn compare(path: &Path) -> usize {
    let mut subject = subject::load(path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let family = subject
        .machine
        .as_ref()
        .expect("a machine")
        .family_folder()
        .to_owned();
    let known = Theorems::load(&family).unwrap_or_else(|e| panic!("{e}"));
    let mut with = Settings {
        theorems: Some(known.into()),
        ..Settings::default()
    };
    let citing = check(&mut subject, &with, &mut |_| Box::new(())).expect("it ends");
    with.theorems = None;
    let whole = check(&mut subject, &with, &mut |_| Box::new(())).expect("it ends");
    for (task, (one, other)) in subject.tasks.iter().zip(citing.iter().zip(&whole)) {
        let properties = task.bound.system.properties.iter().enumerate();
        let judged = |done: &Checked, k: usize| done.outcome.report.properties[k].verdict;
        for (k, property) in properties {
            let context = format!("{}: {}", task.title, label(property));
            match (judged(one, k), judged(other, k)) {
                // With the values of this machine its condition cannot occur.
                (Verdict::Holds, Verdict::Vacuous) if one.cited.contains(&k) => {}
                (a, b) => assert_eq!(a, b, "{context}"),
            }
        }
        assert!(one.explored() || other.outcome.report.faults.is_empty());
    }
    let verdicts = |checked: &[Checked]| -> Vec<_> {
        let all = summarise(&subject, checked).into_iter();
        let guarantees = all.filter(|summary| summary.guarantee);
        guarantees
            .map(|summary| (summary.id, summary.verdict))
            .collect()
    };
    assert_eq!(verdicts(&citing), verdicts(&whole));
    citing.iter().map(|done| done.cited.len()).sum()
}

#[test]
fn a_machine_has_the_same_verdicts_without_theorems() {
    let cited = compare(&root().join("spec/machines/feeder-s120.toml"));
    println!("{cited} cited");
    assert!(cited > 0);
}

#[test]
#[ignore = "deep: every shipped machine"]
fn machines_have_the_same_verdicts_without_theorems() {
    for path in std::fs::read_dir(root().join("spec/machines")).expect("shipped machines") {
        let path = path.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "toml") {
            let cited = compare(&path);
            println!("{}: {cited} cited", path.display());
        }
    }
}
