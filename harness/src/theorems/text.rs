//! Theorems as a file, and as a list for readers.

use std::collections::BTreeMap;
use std::fmt::Write;

use stillpoint_engine::theorems::{Failing, OfSystem, Proved, Theorems};

use crate::report::{counted, wrapped};

/// What stands above the theorems.
const HEAD: &str = "# Properties that hold for every value of the parameters, of the ranges and under the conditions beside them. Written by `stillpoint theorems`;
# `check` of a machine cites them.
# Behind each stands the fingerprint of what decides it: with other tables it is no theorem any more. `fails` has values for which a property
# does not hold.
";

/// The file of the theorems.
pub fn text(theorems: &Theorems) -> String {
    let mut out = HEAD.to_owned();
    for (name, own) in &theorems.systems {
        let name = quoted(name);
        let _ = writeln!(out, "\n[system.{name}]\nfile     = {}", quoted(&own.file));
        let _ = writeln!(out, "readings = {}", table(&own.readings, |v| quoted(v)));
        let _ = writeln!(out, "open     = {}", table(&own.open, |v| quoted(v)));
        for proved in &own.proved {
            let _ = writeln!(out, "\n[[system.{name}.proved]]");
            found(&mut out, proved);
        }
    }
    out
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn table<V>(list: &BTreeMap<String, V>, value: impl Fn(&V) -> String) -> String {
    let one = |(key, own): (&String, &V)| format!("{} = {}", quoted(key), value(own));
    let all: Vec<String> = list.iter().map(one).collect();
    match all[..] {
        [] => "{  }".to_owned(),
        _ => format!("{{ {} }}", all.join(", ")),
    }
}

/// What was found over some ranges.
fn found(out: &mut String, proved: &Proved) {
    let _ = writeln!(out, "every   = {}", quoted(&proved.every));
    let range = |(lo, hi): &(i64, i64)| format!("[{lo}, {hi}]");
    let _ = writeln!(out, "within  = {}", table(&proved.within, range));
    if !proved.conditions.is_empty() {
        let conditions: Vec<String> = proved.conditions.iter().map(|c| quoted(c)).collect();
        let _ = writeln!(out, "where   = [{}]", conditions.join(", "));
    }
    let _ = writeln!(out, "seconds = {:?}", proved.seconds);
    if !proved.holds.is_empty() {
        let _ = writeln!(out, "holds   = {}", table(&proved.holds, |v| quoted(v)));
    }
    if !proved.fails.is_empty() {
        let failing = |f: &Failing| {
            let with = table(&f.with, |v| quoted(v));
            format!("{{ cycles = {}, with = {with} }}", f.cycles)
        };
        let _ = writeln!(out, "fails   = {}", table(&proved.fails, failing));
    }
}

/// A list for readers.
pub fn told(theorems: &Theorems) -> String {
    let mut out = String::new();
    for (name, own) in &theorems.systems {
        let _ = writeln!(out, "{name}");
        for proved in own.proved.iter().filter(|p| !p.holds.is_empty()) {
            wrapped(&mut out, "  for every ", &proved.every);
            if !proved.conditions.is_empty() {
                wrapped(&mut out, "    where    ", &proved.conditions.join(", "));
            }
            let names: Vec<&str> = proved.holds.keys().map(String::as_str).collect();
            wrapped(&mut out, "    holds    ", &names.join(", "));
            let _ = writeln!(out, "    {:.1} s", proved.seconds);
        }
        let (failing, undecided) = open(own);
        if !failing.is_empty() {
            out.push_str("  not for every value, and under no condition that was found\n");
        }
        for (label, failing) in failing {
            wrapped(&mut out, "    ", &format!("{label}: {}", broken(failing)));
        }
        if !undecided.is_empty() {
            wrapped(&mut out, "  not decided ", &undecided.join(", "));
        }
        out.push('\n');
    }
    let _ = writeln!(out, "{}", count(theorems));
    out
}

fn broken(failing: &Failing) -> String {
    let with: Vec<String> = (failing.with.iter())
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    let cycles = counted(failing.cycles, "cycle");
    match with[..] {
        [] => format!("broken after {cycles}, whatever the values are"),
        _ => format!("broken after {cycles} with {}", with.join(", ")),
    }
}

/// The properties of a system that are no theorem: those that do not hold for all values, and those of which nothing is known.
fn open(own: &OfSystem) -> (Vec<(&str, &Failing)>, Vec<&str>) {
    let (mut failing, mut undecided) = (Vec::new(), Vec::new());
    for label in own.open.keys() {
        let mut fails = own.proved.iter().filter_map(|p| p.fails.get(label));
        match fails.next() {
            Some(known) => failing.push((label.as_str(), known)),
            None => undecided.push(label.as_str()),
        }
    }
    (failing, undecided)
}

/// How many theorems there are, and how many properties are none.
pub fn count(theorems: &Theorems) -> String {
    let systems = theorems.systems.values();
    let proved = systems.clone().flat_map(|own| &own.proved);
    let holding = |wanted: fn(&Proved) -> bool| {
        let these = proved.clone().filter(|p| wanted(p));
        these.map(|p| p.holds.len() as u64).sum::<u64>()
    };
    let (mut failing, mut undecided) = (0, 0);
    for own in systems {
        let open = open(own);
        (failing, undecided) = (failing + open.0.len(), undecided + open.1.len());
    }
    format!(
        "{} about {}, {} of them under conditions, {} over fewer values than are documented; {failing} more fail for some values, {undecided} are not decided",
        counted(holding(|_| true), "theorem"),
        counted(theorems.systems.len() as u64, "system"),
        holding(|p| !p.conditions.is_empty()),
        holding(|p| !p.within.is_empty()),
    )
}
