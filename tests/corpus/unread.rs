//! No value of a machine file is read by nobody. A parameter decides a guarantee, or `exceptions.toml` says why it need not; and turned in the
//! machine files that there are it changes what is explored for one, and what is answered.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use stillpoint_engine::check::Settings as CheckSettings;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::data;
use stillpoint_machine::knob::{Knob, Range};
use stillpoint_machine::uses::Readers;
use stillpoint_machine::{self as machine, Machine, Run, Setting, Settings, families};
use stillpoint_tests::guarantees::decided;
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

/// A machine file with every value in it, its machine, and what is explored for its guarantees.
struct Case {
    path: PathBuf,
    source: String,
    machine: Machine,
    runs: Vec<Run>,
}

impl Case {
    /// None of a file that is none of a machine, or is wrong on purpose.
    fn read(path: PathBuf) -> Option<Self> {
        let given = std::fs::read_to_string(&path).expect("readable");
        let load = |text: &str| machine::load_bytes(&path, text.into(), &families(&path));
        let source = whole(&given, &load(&given).ok()?);
        let machine = load(&source).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let runs = explored(&machine);
        Some(Self {
            path,
            source,
            machine,
            runs,
        })
    }

    /// The machines with another value in this place for which something else is explored for a guarantee.
    fn altered<'a>(&'a self, knob: &'a Knob) -> impl Iterator<Item = Machine> + 'a {
        let machine = |value: i64| {
            let text = knob.turned(&self.source, value).into_bytes();
            machine::load_bytes(&self.path, text, &families(&self.path)).ok()
        };
        let machines = others(knob).into_iter().filter_map(machine);
        machines.filter(|machine| explored(machine) != self.runs)
    }

    /// Whether a guarantee of this machine has another verdict, or another bound or way in one of its runs.
    fn answers_differ(&self, other: &Machine) -> bool {
        let runs = explored(other);
        let new = runs.iter().filter(|run| !self.runs.contains(run));
        let gone = self.runs.iter().filter(|run| !runs.contains(run));
        let names: BTreeSet<String> = new
            .chain(gone)
            .filter_map(|r| r.guarantee.clone())
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let told = |machine: &Machine| {
            let settings = CheckSettings {
                threads: 1,
                ..CheckSettings::default()
            };
            let (subject, checked) = decided(&self.path, machine.clone(), &names, &settings);
            let answers = answers(&subject, &checked).into_iter();
            let runs = answers.flat_map(|answer| answer.runs);
            let runs = runs.map(|run| (run.verdict, run.bound, run.way));
            runs.collect::<Vec<_>>()
        };
        told(&self.machine) != told(other)
    }

    /// The values in the file of parameters that are asked about, those of one together.
    fn knobs(&self, asked: impl Fn(&str) -> bool) -> Vec<(String, Vec<Knob>)> {
        let mut knobs: BTreeMap<String, Vec<Knob>> = BTreeMap::new();
        for knob in self.machine.knobs() {
            let name = parameter(&self.machine, &knob).filter(|name| asked(name));
            if let Some(name) = name {
                knobs.entry(name).or_default().push(knob);
            }
        }
        knobs.into_iter().collect()
    }
}

/// `family/STANDSTILL_TOL`, `family/VELO_LIMIT[0]` of `axis.X.VELO_LIMIT[0]`; what a guarantee says are no parameters.
fn parameter(machine: &Machine, knob: &Knob) -> Option<String> {
    let (table, _) = knob.name.split_once('.')?;
    let (_, name) = knob.name.rsplit_once('.')?;
    (table != "guarantee").then(|| format!("{}/{name}", machine.family))
}

/// The parameters that some pattern reads, but for these, and that have no effect in any of these files. `effect` says whether one has it in a
/// file; none where that is not to be told.
fn without_effect(
    files: Vec<PathBuf>,
    left_out: &BTreeSet<String>,
    effect: impl Fn(&Case, &[Knob]) -> Option<bool> + Sync,
) -> BTreeSet<String> {
    let (read, _) = parameters();
    let mut seen: BTreeMap<String, bool> = BTreeMap::new();
    for case in files.into_iter().filter_map(Case::read) {
        let knobs = case.knobs(|name| {
            let plain = name.split('[').next().unwrap_or(name);
            let known = left_out.contains(name) || seen.get(name) == Some(&true);
            read.contains(plain) && !known
        });
        let found = each(&knobs, |(_, knobs)| effect(&case, knobs));
        let names = knobs.into_iter().map(|(name, _)| name);
        seen.extend(
            names
                .zip(found)
                .filter_map(|(name, has)| Some((name, has?))),
        );
    }
    let blind = seen.into_iter().filter(|(_, has)| !has);
    blind.map(|(name, _)| name).collect()
}

/// These are the exceptions of this name.
fn are_exceptions(found: &BTreeSet<String>, test: &str) {
    let allowed = exceptions(test);
    let open: Vec<_> = found.difference(&allowed).collect();
    let closed: Vec<_> = allowed.difference(found).collect();
    assert!(open.is_empty(), "{test}: {open:#?}");
    assert!(closed.is_empty(), "{test} no more: {closed:#?}");
}

#[test]
fn every_parameter_decides_a_guarantee_or_has_a_reason() {
    let (read, unread) = parameters();
    assert!(read.len() >= 165, "{}", read.len());
    are_exceptions(&unread, "parameters that decide no guarantee");
}

/// What of a parameter that some pattern reads no machine file shows.
const HIDDEN: &str = "parameters that no machine file shows to decide";

fn machine_files() -> Vec<PathBuf> {
    let mut all = files("spec/machines", "toml");
    all.extend(files("tests/machines", "toml"));
    all
}

/// Whether another value changes what is explored.
fn is_explored(case: &Case, knobs: &[Knob]) -> Option<bool> {
    Some(knobs.iter().any(|knob| case.altered(knob).next().is_some()))
}

#[test]
#[ignore = "deep: a minute"]
fn what_no_machine_file_shows_to_decide_is_an_exception() {
    let blind = without_effect(machine_files(), &BTreeSet::new(), is_explored);
    are_exceptions(&blind, HIDDEN);
}

/// With another value something else is true: a verdict, a bound, a way.
#[test]
#[ignore = "deep: twenty minutes"]
fn every_value_that_decides_changes_an_answer() {
    let ship = files("spec/machines", "toml");
    let blind = without_effect(ship, &BTreeSet::new(), |case, knobs| {
        let mut altered = knobs.iter().flat_map(|knob| case.altered(knob)).peekable();
        altered.peek()?;
        Some(altered.any(|other| case.answers_differ(&other)))
    });
    are_exceptions(&blind, "parameters that change no answer");
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn every_value_that_is_read_is_seen_to_decide() {
        let blind = without_effect(machine_files(), &exceptions(HIDDEN), is_explored);
        assert!(blind.is_empty(), "{HIDDEN}: {blind:#?}");
    }
}
