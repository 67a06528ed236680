//! From the values of the axes, groups and doors to the explorations that cover the machine.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use toml::Spanned;

use super::bind::bind;
use super::eval::Values;
use super::family::{Explore, Family, Half, Scope};
use super::guarantee::{Asked, Guarantee, HALF, WITHIN, asked};
use super::logic::Logic;
use super::own::{Asks, Own};
use super::plausible::{Judged, evaluate};
use super::wired::wiring;
use super::{Axis, Door, Group, Run, Wiring};
use stillpoint_lang::Spec;
use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result};

/// What a machine consists of.
#[derive(Clone, Copy)]
pub(super) struct Parts<'a> {
    pub axes: &'a [Axis],
    pub groups: &'a [Group],
    pub doors: &'a [Door],
}

/// The groups of coupled axes and the runs.
pub(super) struct Plan {
    pub groups: Vec<Vec<String>>,
    pub runs: Vec<Run>,
    /// The axes that a run is about, by themselves or in their group.
    pub about: BTreeSet<String>,
}

/// Plans the runs of a machine.
///
/// # Errors
/// Faults of the family's data.
pub(super) fn plan(
    family: &Family,
    explored: &[Explore],
    parts: Parts<'_>,
    judged: &Judged,
    logic: &Logic,
) -> Result<Plan> {
    let coupled = coupled(family, parts.axes, judged)?;
    let mut planned: Vec<Planned> = Vec::new();
    let mut files = BTreeMap::new();
    let mut about = BTreeSet::new();
    for explore in explored {
        let system = declared(family, explore, &mut files, logic)?;
        for subject in subjects(family, explore, parts, &coupled, judged)? {
            if matches!(explore.each, Scope::Axis | Scope::Group) {
                about.extend(subject.axes.iter().cloned());
            }
            // A group whose members differ is explored with the values of each.
            for of in 0..subject.members.len() {
                let run = bind(family, explore, &system, judged.cycle, &subject, of)?;
                merge(&mut planned, run);
            }
        }
    }
    let name = |k: &usize| parts.axes.get(*k).map(|a| a.name.clone());
    let names = |group: &Vec<usize>| group.iter().filter_map(name).collect();
    let declared = |group: &Group| group.axes.iter().map(|a| a.get_ref().clone()).collect();
    Ok(Plan {
        groups: match family.group {
            Some(_) => parts.groups.iter().map(declared).collect(),
            None => coupled.iter().map(names).collect(),
        },
        runs: planned.into_iter().map(Planned::titled).collect(),
        about,
    })
}

/// The runs that decide the guarantees of a machine, whose file and text are `own`.
///
/// # Errors
/// Faults of the family's data, and a guarantee that cannot be asked of an axis.
pub(super) fn guaranteed(
    family: &Family,
    own: (&str, &Arc<str>),
    guarantees: &[Guarantee],
    parts: Parts<'_>,
    judged: &Judged,
    logic: &Logic,
) -> Result<Vec<Run>> {
    let mut planned: Vec<Planned> = Vec::new();
    let mut files = BTreeMap::new();
    for asked in asked(family, guarantees, parts, judged, logic.is_programmed())? {
        let (name, axis) = (&asked.guarantee.name, asked.axis);
        if asked.pattern.needs_program && !logic.is_programmed() {
            let message = format!(
                "guarantee {name} is about the program of the safe logic, and the file has none"
            );
            let place = Some(asked.guarantee.place.clone());
            let found = logic.fault(place, message).label("this guarantee");
            let help = "add [logic.NAME] with source = \"...\", a program beside the machine file";
            return Err(found.help(help).into());
        }
        let mut answered: Vec<&str> = Vec::new();
        let mut decided = false;
        for explore in &asked.pattern.explore {
            if evaluate(family, &explore.when, &asked.values, judged.cycle)? == 0 {
                continue;
            }
            decided = true;
            let declared = declared(family, explore, &mut files, logic)?;
            if asked.pattern.needs_program && logic.lacks_half(family, &declared.machines) {
                let message = format!(
                    "guarantee {name} is about both halves of the safe logic, and the file has none in the PLC"
                );
                let place = Some(asked.guarantee.place.clone());
                let found = logic.fault(place, message).label("this guarantee");
                let help =
                    "add plc = \"...\" to [logic.NAME], a statement list beside the machine file";
                return Err(found.help(help).into());
            }
            let mut faults = Vec::new();
            for (name, when) in &explore.covers {
                let counts = asked.guarantee.after_fault()
                    && evaluate(family, when, &asked.values, judged.cycle)? != 0;
                if let Some(fault) = family.faults.get(name).filter(|_| counts) {
                    answered.push(name);
                    faults.push(fault);
                }
            }
            let alone =
                faults.iter().any(|fault| fault.takes_half) && asked.guarantee.own.is_none();
            let half = logic.half(family, &declared.machines).filter(|_| alone);
            let mut asked_of_half = asked.clone();
            asked_of_half.values.insert(HALF.to_owned(), vec![1]);
            let half = half.map(|(logic, half)| (&asked_of_half, logic, Some(half)));
            for (asked, logic, half) in [(&asked, logic, None)].into_iter().chain(half) {
                let mut run = decided_by(family, explore, asked, &declared, judged, logic, half)?;
                let texts = faults.iter().map(|fault| fault.text.clone());
                run.run.faults.extend(texts);
                merge(&mut planned, run);
            }
        }
        let open = family.faults.keys();
        let mut open = open.filter(|fault| !answered.contains(&fault.as_str()));
        let open = open.next().filter(|_| asked.guarantee.after_fault());
        if !decided {
            let (file, source) = own;
            let message = format!(
                "guarantee {name}: axis {axis} has not the functions that the pattern {} asks about",
                asked.guarantee.pattern
            );
            let named = asked.guarantee.axes.iter().find(|n| *n.get_ref() == axis);
            let place = named.map_or(asked.guarantee.place.clone(), Spanned::span);
            let fault = Diagnostic::new(file, source, Some(place), message);
            let help =
                "enable them at the axis (`functions`), or take the axis out of the guarantee";
            return Err(fault
                .label("cannot be asked of this axis")
                .help(help)
                .into());
        }
        if let Some(open) = open {
            let message = format!(
                "nothing decides the guarantee {name} for the axis {axis} after the fault '{open}'"
            );
            let fault = Diagnostic::new(&family.file, &family.source, None, message);
            let help = "this is an error of the family's data, not of the machine file: an entry of its pattern must apply";
            return Err(fault.help(help).into());
        }
    }
    Ok(planned.into_iter().map(Planned::titled).collect())
}

/// The run of an axis by which an exploration decides a guarantee, with this logic: that of the machine, or its half in the PLC alone.
fn decided_by(
    family: &Family,
    explore: &Explore,
    asked: &Asked<'_>,
    declared: &Declared,
    judged: &Judged,
    logic: &Logic,
    half: Option<&Half>,
) -> Result<Planned> {
    let mut system = declared.clone();
    let mut connected = Wiring::new();
    let takes = logic.takes(&system.machines);
    if takes || asked.guarantee.own.is_some() {
        let spec = Spec::load(&family.folder.join(&explore.file))?;
        if takes {
            connected = wiring(family, explore, asked, logic, &spec, half)?;
        }
        if let Some(own) = &asked.guarantee.own {
            connected = logic.shown(&spec, own, &asked.guarantee.place)?;
        }
        if !connected.is_empty() {
            let times = logic.times(&spec, &connected)?;
            system.durations.extend(times.running);
            if let Some(scan) = &explore.scan {
                let scan = evaluate(family, scan, &asked.values, judged.cycle)?.max(1);
                system.scanned = times.scanned.into_iter().map(|d| (d, scan)).collect();
            }
        }
    }
    let subject = Subject {
        members: vec![(asked.axis, &asked.values)],
        axes: vec![asked.axis.to_owned()],
    };
    let mut planned = bind(family, explore, &system, judged.cycle, &subject, 0)?;
    let run = &mut planned.run;
    run.wiring = connected;
    run.guarantee = Some(asked.guarantee.name.clone());
    run.half = half.is_some();
    if let Some(half) = half {
        run.title = format!("{}, {}", run.title, half.text);
    }
    if let Some(own) = &asked.guarantee.own {
        run.axes.clear();
        run.asks = Some(asks(own, asked, run.cycle, logic)?);
        // It is about the logic, whatever axis there is.
        planned.each = Scope::Machine;
    }
    Ok(planned)
}

/// The question of a machine file, with its time in cycles: what is asked for begins at any moment between two of them.
fn asks(own: &Own, asked: &Asked<'_>, cycle: i64, logic: &Logic) -> Result<Asks> {
    let within = asked.values.get(WITHIN).and_then(|cells| cells.first());
    let within = within.copied().unwrap_or(0);
    if within > 0 && within < cycle {
        let cycle = super::units::Dimension::Time.show(cycle);
        let message = format!("guarantee {}: the logic runs once in {cycle}", own.name);
        let found = logic.fault(Some(asked.guarantee.place.clone()), message);
        let help =
            format!("write within = \"{cycle}\" or more, or leave it out: then in the same cycle");
        return Err(found.label("this guarantee").help(help).into());
    }
    Ok(Asks {
        own: own.clone(),
        within: (within > 0).then(|| within / cycle.max(1) - 1),
    })
}

/// An exploration, and what it stands for.
pub(super) struct Planned {
    pub run: Run,
    pub each: Scope,
    /// Whether the values are those of one member among several.
    pub of_member: bool,
    /// The axes, groups or doors it stands for.
    pub names: Vec<String>,
}

impl Planned {
    /// The run with the names in its title.
    fn titled(mut self) -> Run {
        let (one, several) = match (self.each, self.of_member) {
            (Scope::Axis, _) | (Scope::Group, true) => ("axis", "axes"),
            (Scope::Group, false) => ("group", "groups"),
            (Scope::Door, _) => ("door", "doors"),
            (Scope::Machine | Scope::Control, _) => return self.run,
        };
        let noun = if self.names.len() == 1 { one } else { several };
        self.run.title = format!("{}, {noun} {}", self.run.title, self.names.join(", "));
        self.run
    }
}

/// An axis or a whole and its values.
type Member<'a> = (&'a str, &'a Values);

/// What a system is explored for.
pub(super) struct Subject<'a> {
    /// One member, or for a system of several axes all of them.
    pub members: Vec<Member<'a>>,
    /// The axes it stands for.
    pub axes: Vec<String>,
}

/// Everything that `explore` is meant for.
fn subjects<'a>(
    family: &Family,
    explore: &Explore,
    parts: Parts<'a>,
    coupled: &[Vec<usize>],
    judged: &'a Judged,
) -> Result<Vec<Subject<'a>>> {
    let all = parts.axes.iter().map(|a| a.name.clone()).collect();
    let names = |list: &[toml::Spanned<String>]| list.iter().map(|a| a.get_ref().clone()).collect();
    let wholes: Vec<(Member<'a>, Vec<String>)> = match explore.each {
        Scope::Group if explore.members.is_none() => (parts.groups.iter().zip(&judged.groups))
            .map(|(group, values)| ((group.name.as_str(), values), names(&group.axes)))
            .collect(),
        Scope::Door => (parts.doors.iter().zip(&judged.doors))
            .map(|(door, values)| ((door.name.as_str(), values), names(&door.axes)))
            .collect(),
        Scope::Machine => vec![(("", &judged.machine), all)],
        Scope::Axis | Scope::Group | Scope::Control => Vec::new(),
    };
    let mut list = Vec::new();
    for ((name, values), axes) in wholes {
        if evaluate(family, &explore.when, values, judged.cycle)? != 0 {
            let members = vec![(name, values)];
            list.push(Subject { members, axes });
        }
    }
    let singles: Vec<Vec<usize>>;
    let (candidates, sizes) = match (explore.each, &explore.members) {
        (Scope::Group, Some(sizes)) => (coupled, sizes),
        (Scope::Axis, _) => {
            singles = (0..parts.axes.len()).map(|k| vec![k]).collect();
            (&singles[..], &(1..=1))
        }
        _ => (&[][..], &(1..=1)),
    };
    for candidate in candidates {
        let members = members(family, explore, parts.axes, judged, candidate)?;
        if sizes.contains(&members.len()) {
            let axes = members.iter().map(|(name, _)| (*name).to_owned()).collect();
            list.push(Subject { members, axes });
        }
    }
    Ok(list)
}

/// The axes of `candidate` that `explore` is meant for.
fn members<'a>(
    family: &Family,
    explore: &Explore,
    axes: &'a [Axis],
    judged: &'a Judged,
    candidate: &[usize],
) -> Result<Vec<Member<'a>>> {
    let mut members = Vec::new();
    for k in candidate {
        if let (Some(axis), Some(values)) = (axes.get(*k), judged.axes.get(*k)) {
            if evaluate(family, &explore.when, values, judged.cycle)? != 0 {
                members.push((axis.name.as_str(), values));
            }
        }
    }
    Ok(members)
}

/// The connected groups of axes: those that interpolate, and those whose stop acts on the whole channel.
fn coupled(family: &Family, axes: &[Axis], judged: &Judged) -> Result<Vec<Vec<usize>>> {
    let mut label: Vec<usize> = (0..axes.len()).collect();
    for (i, axis) in axes.iter().enumerate() {
        let everyone = match (&family.coupled_to_all, judged.axes.get(i)) {
            (Some(formula), Some(values)) => evaluate(family, formula, values, judged.cycle)? != 0,
            _ => false,
        };
        for (j, other) in axes.iter().enumerate() {
            let named = axis
                .interpolates_with
                .iter()
                .any(|n| *n.get_ref() == other.name);
            if everyone || named {
                let (from, to) = (label[i].max(label[j]), label[i].min(label[j]));
                label
                    .iter_mut()
                    .filter(|l| **l == from)
                    .for_each(|l| *l = to);
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (k, l) in label.into_iter().enumerate() {
        groups.entry(l).or_default().push(k);
    }
    Ok(groups.into_values().filter(|g| g.len() > 1).collect())
}

/// What the specification file says about a system.
#[derive(Clone)]
pub(super) struct Declared {
    /// Whether its timers are scaled.
    pub scaled: bool,
    /// The machines in it.
    pub machines: Vec<String>,
    /// The times of the programs in it.
    pub durations: Vec<(String, u64)>,
    /// Times that are counted in the scans of a program, each with the time from one scan to the next.
    pub scanned: Vec<((String, u64), i64)>,
}

/// How the specification file declares the system; `files` keeps what was read.
///
/// # Errors
/// The file or the system does not exist.
fn declared<'e>(
    family: &Family,
    explore: &'e Explore,
    files: &mut BTreeMap<&'e str, toml::Table>,
    logic: &Logic,
) -> Result<Declared> {
    let fault = |message: String| -> Diagnostics {
        Diagnostic::new(&family.file, &family.source, None, message)
            .help("this is an error of the family's data, not of the machine file")
            .into()
    };
    let path = family.folder.join(&explore.file);
    if !files.contains_key(explore.file.as_str()) {
        let text = stillpoint_lang::files::read_to_string(&path)
            .map_err(|e| fault(format!("cannot read {}: {e}", path.display())))?;
        let table = toml::from_str(&text).map_err(|e| {
            fault(format!(
                "{} is not valid TOML: {}",
                path.display(),
                e.message()
            ))
        })?;
        files.insert(&explore.file, table);
    }
    let system = files
        .get(explore.file.as_str())
        .and_then(|file| file.get("system"))
        .and_then(|s| s.get(&explore.system))
        .ok_or_else(|| {
            fault(format!(
                "{} has no system '{}'",
                path.display(),
                explore.system
            ))
        })?;
    let instances = system.get("instance").and_then(toml::Value::as_table);
    let machine = |i: &toml::Value| Some(i.get("machine")?.as_str()?.to_owned());
    let machines: Vec<String> = instances
        .into_iter()
        .flat_map(|i| i.values().filter_map(machine))
        .collect();
    Ok(Declared {
        scaled: system.get("timers").and_then(toml::Value::as_str) == Some("scaled"),
        durations: logic.durations(&machines).cloned().collect(),
        scanned: Vec::new(),
        machines,
    })
}

/// Adds a run, or what it stands for to the one that explores the same.
fn merge(list: &mut Vec<Planned>, new: Planned) {
    let same = list.iter_mut().find(|known| {
        let (a, b) = (&known.run, &new.run);
        (&a.file, &a.system, a.cycle, a.before, &a.params, &a.wiring)
            == (&b.file, &b.system, b.cycle, b.before, &b.params, &b.wiring)
            && (&a.asks, a.half, a.travel, a.window) == (&b.asks, b.half, b.travel, b.window)
            && a.guarantee == b.guarantee
            && (known.each, known.of_member) == (new.each, new.of_member)
            && (!new.of_member || known.names == new.names)
    });
    let Some(known) = same else {
        list.push(new);
        return;
    };
    add(&mut known.names, new.names);
    add(&mut known.run.axes, new.run.axes);
    add(&mut known.run.faults, new.run.faults);
    add(&mut known.run.abstractions, new.run.abstractions);
}

/// Adds what is not there yet.
fn add<T: PartialEq>(into: &mut Vec<T>, from: Vec<T>) {
    for one in from {
        if !into.contains(&one) {
            into.push(one);
        }
    }
}
