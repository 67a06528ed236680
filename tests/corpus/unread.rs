//! No value of a machine file is read by nobody. A parameter decides a guarantee, or `exceptions.toml` says why it need not; and turned in the
//! machine files that there are it changes what is explored for one.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use stillpoint_machine::data;
use stillpoint_machine::knob::{Knob, Range};
use stillpoint_machine::uses::Readers;
use stillpoint_machine::{self as machine, Machine, Run, Setting, Settings, families};
use stillpoint_tests::peer::each;
use stillpoint_tests::{exceptions, files, root};

/// Of each family the parameters that some pattern of guarantees reads, and those that none does.
fn parameters() -> (BTreeSet<String>, BTreeSet<String>) {
    let root = root().join("spec/families");
    let of = |family: String| {
        let folder = root.join(&family);
        let readers = Readers::load(&folder).unwrap_or_else(|e| panic!("{e}"));
        let data = data::load(&folder).unwrap_or_else(|e| panic!("{e}"));
        let names = data.parameters.into_iter().map(|datum| datum.name);
        let read = |name: String| {
            let read = !readers.of(&name).patterns.is_empty();
            (format!("{family}/{name}"), read)
        };
        names.map(read).collect::<Vec<_>>()
    };
    let all = machine::names(&root).into_iter().flat_map(of);
    let (read, unread): (Vec<_>, Vec<_>) = all.partition(|(_, read)| *read);
    let names = |list: Vec<(String, bool)>| list.into_iter().map(|(name, _)| name).collect();
    (names(read), names(unread))
}

#[test]
fn every_parameter_decides_a_guarantee_or_has_a_reason() {
    let (read, unread) = parameters();
    assert!(read.len() >= 165, "{}", read.len());
    let allowed = exceptions("parameters that decide no guarantee");
    let open: Vec<_> = unread.difference(&allowed).collect();
    let closed: Vec<_> = allowed.difference(&unread).collect();
    assert!(open.is_empty(), "read by no pattern: {open:#?}");
    assert!(closed.is_empty(), "read now, or gone: {closed:#?}");
}

/// A value as a machine file has it: names, numbers and truth values are one already.
fn literal(shown: &str) -> String {
    match toml::from_str::<toml::Table>(&format!("x = {shown}")) {
        Ok(_) => shown.to_owned(),
        Err(_) => format!("\"{shown}\""),
    }
}

/// The values of one table that its file leaves to the family, as lines. What is nothing by default is left out: to write it would be an
/// error.
fn missing(values: &Settings) -> String {
    let line = |(name, setting): (&String, &Setting)| {
        let cells: Vec<String> = setting.shown.iter().map(|s| literal(s)).collect();
        let told = !setting.is_given() && !cells.iter().all(|c| c == "\"none\"");
        told.then(|| match cells.as_slice() {
            [one] => format!("{name} = {one}\n"),
            _ => format!("{name} = [{}]\n", cells.join(", ")),
        })
    };
    values.iter().filter_map(line).collect()
}

/// The machine file with every value in it.
fn whole(source: &str, machine: &Machine) -> String {
    let mut text = source.to_owned();
    let mut write = |header: String, values: &Settings| {
        let lines = missing(values);
        match text.split_once(&header) {
            Some((before, after)) => text = format!("{before}{header}\n{lines}{after}"),
            None => text.push_str(&format!("\n{header}\n{lines}")),
        }
    };
    write("[control]".to_owned(), &machine.control);
    for axis in &machine.axes {
        write(format!("[axis.{}]", axis.name), &axis.values);
    }
    for group in &machine.axis_groups {
        write(format!("[group.{}]", group.name), &group.values);
    }
    for door in &machine.doors {
        write(format!("[door.{}]", door.name), &door.values);
    }
    text
}

/// What is explored for the guarantees.
fn explored(machine: &Machine) -> Vec<Run> {
    let asked = machine.runs.iter().filter(|run| run.guarantee.is_some());
    let told = |run: &Run| Run {
        sources: BTreeMap::new(),
        abstractions: Vec::new(),
        ..run.clone()
    };
    asked.map(told).collect()
}

/// The other values that are tried: of many names a few, of a range its ends and what is near.
fn others(knob: &Knob) -> Vec<i64> {
    let mut values = match knob.range() {
        Range::All(all) => all.iter().copied().step_by(1 + all.len() / 24).collect(),
        Range::Between(min, max, step) => {
            let near = [
                knob.given / 2,
                knob.given * 2,
                knob.given - step,
                knob.given + step,
            ];
            let near = near.into_iter().filter(|v| (min..=max).contains(v));
            near.chain([min, max]).collect::<Vec<i64>>()
        }
    };
    values.retain(|value| *value != knob.given);
    values
}

/// Whether another value in the place of this one changes what is explored for a guarantee.
fn decides(path: &Path, source: &str, before: &[Run], knob: &Knob) -> bool {
    others(knob).into_iter().any(|value| {
        let text = knob.turned(source, value);
        machine::load_bytes(path, text.into_bytes(), &families(path))
            .is_ok_and(|after| explored(&after) != before)
    })
}

/// `family/STANDSTILL_TOL`, `family/VELO_LIMIT[0]` of `axis.X.VELO_LIMIT[0]`; a guarantee has no parameters but arguments.
fn parameter(machine: &Machine, knob: &Knob) -> Option<String> {
    let (table, _) = knob.name.split_once('.')?;
    let (_, name) = knob.name.rsplit_once('.')?;
    (table != "guarantee").then(|| format!("{}/{name}", machine.family))
}

/// The machines that ship, and those of tests that can be read.
fn machine_files() -> Vec<PathBuf> {
    let mut found = files("spec/machines", "toml");
    found.extend(files("tests/machines", "toml"));
    found
}

#[test]
fn every_value_that_is_read_is_seen_to_decide() {
    let (read, _) = parameters();
    let mut seen: BTreeMap<String, bool> = BTreeMap::new();
    for path in machine_files() {
        let load = |text: &str| machine::load_bytes(&path, text.into(), &families(&path));
        let given = std::fs::read_to_string(&path).expect("readable");
        let Ok(machine) = load(&given) else { continue };
        let source = whole(&given, &machine);
        let machine = load(&source).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut knobs: BTreeMap<String, Vec<Knob>> = BTreeMap::new();
        for knob in machine.knobs() {
            let Some(name) = parameter(&machine, &knob) else {
                continue;
            };
            let plain = name.split('[').next().unwrap_or(&name);
            if read.contains(plain) && seen.get(&name) != Some(&true) {
                knobs.entry(name).or_default().push(knob);
            }
        }
        let knobs: Vec<(String, Vec<Knob>)> = knobs.into_iter().collect();
        let before = explored(&machine);
        let found = each(&knobs, |(_, knobs)| {
            let mut knobs = knobs.iter();
            knobs.any(|knob| decides(&path, &source, &before, knob))
        });
        let names = knobs.into_iter().map(|(name, _)| name);
        seen.extend(names.zip(found));
    }
    let blind = seen.into_iter().filter(|(_, decides)| !decides);
    let blind: BTreeSet<String> = blind.map(|(name, _)| name).collect();
    let allowed = exceptions("parameters that no machine file shows to decide");
    let open: Vec<_> = blind.difference(&allowed).collect();
    let closed: Vec<_> = allowed.difference(&blind).collect();
    assert!(open.is_empty(), "without effect in any file: {open:#?}");
    assert!(closed.is_empty(), "with an effect now: {closed:#?}");
}
