//! The values of each axis, group and door under the names that expressions know, and the plausibility rules over them.

use super::document::Findings;
use super::eval::{Values, eval};
use super::family::{Family, Formula, Rule, Scope};
use super::guarantee::Guarantee;
use super::read::Draft;
use super::whole::{Whole, add_before};
use super::{Axis, AxisKind, Door, Group, Place, Settings};
use stillpoint_lang::diag::{Diagnostic, Result};
use stillpoint_lang::syntax::ast::{Expr, Kind};

/// What the expressions of a family yield for a machine.
#[derive(Debug)]
pub(super) struct Judged {
    /// The monitoring cycle in microseconds.
    pub cycle: i64,
    /// The values of each axis, in the order of the draft.
    pub axes: Vec<Values>,
    /// The values of each group, with those of its axes and of the doors to it as lists.
    pub groups: Vec<Values>,
    /// The values of each door, with those of the axes and groups behind it as lists.
    pub doors: Vec<Values>,
    /// The values of the control, with those of all axes, groups and doors as lists.
    pub machine: Values,
}

/// Evaluates `formula`. An evaluation that fails is a fault of the family's data and says so.
pub(super) fn evaluate(
    family: &Family,
    formula: &Formula,
    values: &Values,
    cycle: i64,
) -> Result<i64> {
    eval(&formula.expr, values, cycle).map_err(|message| {
        Diagnostic::new(
            &family.file,
            &family.source,
            Some(formula.text.span()),
            format!("this expression cannot be evaluated: {message}"),
        )
        .help("this is an error of the family's data, not of the machine file")
        .into()
    })
}

/// Judges all rules. `None`: the control's values could not be read, so nothing that depends on them can be judged.
///
/// # Errors
/// Faults of the family's data. What is wrong with the machine goes to `findings`.
pub(super) fn judge(
    family: &Family,
    draft: &Draft,
    findings: &mut Findings,
) -> Result<Option<Judged>> {
    let Some(settings) = &draft.control else {
        return Ok(None);
    };
    let mut control = Values::new();
    insert(&mut control, settings);
    let cycle = evaluate(family, &family.monitoring_cycle, &control, 0)?;
    let mut judge = Judge {
        family,
        cycle,
        findings,
    };
    judge.rules(
        Scope::Control,
        &mut control.clone(),
        &Subject::new("the control", &[settings]),
    )?;
    let mut axes = Vec::new();
    for axis in &draft.axes {
        let mut values = axis_values(family, axis, &control, cycle)?;
        let subject = Subject::of_axis(axis, settings);
        judge.rules(Scope::Axis, &mut values, &subject)?;
        axes.push(values);
    }
    judge.unique(draft, &axes, settings)?;
    let whole = Whole::new(family, draft, &axes, &control, cycle);
    let mut groups = Vec::new();
    // Without all of its axes, values of a group would mislead; what is wrong with the axis is told.
    let read = |axis: &toml::Spanned<String>| draft.axes.iter().any(|a| a.name == *axis.get_ref());
    for group in &draft.groups {
        if !group.axes.iter().all(read) {
            groups.push(Values::new());
            continue;
        }
        let mut values = whole.group(group)?;
        let subject = Subject::of_group(group, settings);
        judge.rules(Scope::Group, &mut values, &subject)?;
        groups.push(values);
    }
    add_before(family, &draft.groups, &mut groups);
    for door in &draft.doors {
        for (axis, values) in draft.axes.iter().zip(&axes) {
            if door.axes.iter().any(|name| *name.get_ref() == axis.name) {
                let mut values = values.clone();
                insert(&mut values, &door.values);
                judge.rules(Scope::Door, &mut values, &Subject::of_door(door, axis))?;
            }
        }
    }
    for guarantee in &draft.guarantees {
        judge.guarantee(guarantee, draft, &axes, settings)?;
    }
    let doors = draft.doors.iter().map(|door| whole.door(door, &groups));
    let doors = doors.collect();
    let mut machine = whole.machine(&groups);
    if judge.findings.none() {
        let subject = Subject::new("the machine", &[settings]);
        judge.rules(Scope::Machine, &mut machine, &subject)?;
    }
    Ok(Some(Judged {
        cycle,
        axes,
        groups,
        doors,
        machine,
    }))
}

pub(super) fn insert(values: &mut Values, settings: &Settings) {
    values.extend(
        settings
            .iter()
            .map(|(name, s)| (name.clone(), s.cells.clone())),
    );
}

/// The names an expression about `axis` may read.
fn axis_values(family: &Family, axis: &Axis, control: &Values, cycle: i64) -> Result<Values> {
    let mut values = control.clone();
    insert(&mut values, &axis.values);
    for function in &family.functions {
        let cells = values.entry(function.variable.clone()).or_default();
        if cells.len() <= function.index {
            cells.resize(function.index + 1, 0);
        }
        if let (true, Some(cell)) = (axis.has(&function.name), cells.get_mut(function.index)) {
            *cell = 1;
        }
    }
    let kind = match axis.kind {
        AxisKind::Linear => 0,
        AxisKind::Rotary => 1,
    };
    let scalars = [
        ("LINEAR", 0),
        ("ROTARY", 1),
        ("kind", kind),
        ("spindle", i64::from(axis.spindle)),
        ("enabled_any", i64::from(!axis.functions.is_empty())),
        ("monitoring_cycle", cycle),
    ];
    values.extend(scalars.map(|(name, value)| (name.to_owned(), vec![value])));
    for (name, formula) in &family.lets {
        let value = evaluate(family, formula, &values, cycle)?;
        values.insert(name.clone(), vec![value]);
    }
    Ok(values)
}

/// What a rule is judged for: its name in messages, and where its values stand.
struct Subject<'a> {
    name: String,
    place: Option<Place>,
    functions: Option<Place>,
    settings: Vec<&'a Settings>,
}

impl<'a> Subject<'a> {
    fn new(name: &str, settings: &[&'a Settings]) -> Self {
        Self {
            name: name.to_owned(),
            place: None,
            functions: None,
            settings: settings.to_vec(),
        }
    }

    fn of_axis(axis: &'a Axis, control: &'a Settings) -> Self {
        Self {
            place: Some(axis.place.clone()),
            functions: axis.functions_place.clone(),
            ..Self::new(&format!("axis {}", axis.name), &[&axis.values, control])
        }
    }

    fn of_group(group: &'a Group, control: &'a Settings) -> Self {
        Self {
            place: Some(group.place.clone()),
            ..Self::new(&format!("group {}", group.name), &[&group.values, control])
        }
    }

    fn of_guarantee(guarantee: &'a Guarantee, axis: &'a Axis, control: &'a Settings) -> Self {
        let name = format!("guarantee {}", guarantee.name);
        Self {
            place: Some(guarantee.place.clone()),
            ..Self::new(&name, &[&guarantee.values, &axis.values, control])
        }
    }

    fn of_door(door: &'a Door, axis: &'a Axis) -> Self {
        let named = door.axes.iter().find(|name| *name.get_ref() == axis.name);
        Self {
            place: named.map(toml::Spanned::span).or(Some(door.place.clone())),
            ..Self::new(
                &format!("door {}, axis {}", door.name, axis.name),
                &[&door.values, &axis.values],
            )
        }
    }

    fn setting(&self, name: &str) -> Option<&'a super::Setting> {
        self.settings.iter().find_map(|s| s.get(name))
    }

    /// Where `at` stands: the value if the file gives it, else the subject itself.
    fn find(&self, at: &str, k: i64) -> Option<Place> {
        let (name, index) = match at.split_once('[') {
            Some((name, index)) => {
                let index = index.trim_end_matches(']');
                (name, index.parse().unwrap_or(k))
            }
            None => (at, 0),
        };
        let place = match name {
            "functions" => self.functions.clone(),
            _ => self.setting(name).and_then(|s| {
                usize::try_from(index)
                    .ok()
                    .and_then(|index| s.places.get(index).cloned())
            }),
        };
        place.or_else(|| self.place.clone())
    }

    /// The parameters that `expr` reads, with their values: `VELO_X = 20 mm/min`.
    fn shown(&self, expr: &Expr, values: &Values, list: &mut Vec<String>) {
        let mut add = |name: &str, index: Option<i64>| {
            let Some(setting) = self.setting(name) else {
                return;
            };
            let cell = usize::try_from(index.unwrap_or(0)).unwrap_or(0);
            let Some(shown) = setting.shown.get(cell) else {
                return;
            };
            let default = if setting.is_given() { "" } else { " (default)" };
            let entry = match index {
                Some(k) => format!("{name}[{k}] = {shown}{default}"),
                None => format!("{name} = {shown}{default}"),
            };
            if !list.contains(&entry) {
                list.push(entry);
            }
        };
        match &expr.kind {
            Kind::Name(name) => add(name, None),
            Kind::Index(base, index) => {
                if let (Kind::Name(name), Ok(k)) = (&base.kind, eval(index, values, 1)) {
                    add(name, Some(k));
                }
            }
            Kind::Unary(_, a) => self.shown(a, values, list),
            Kind::Binary(_, a, b) => {
                self.shown(a, values, list);
                self.shown(b, values, list);
            }
            Kind::Call(_, args) => args.iter().for_each(|a| self.shown(a, values, list)),
            _ => {}
        }
    }
}

struct Judge<'a> {
    family: &'a Family,
    cycle: i64,
    findings: &'a mut Findings,
}

impl Judge<'_> {
    fn rules(&mut self, scope: Scope, values: &mut Values, subject: &Subject<'_>) -> Result<()> {
        let family = self.family;
        let rules = family.rules.iter().filter(|r| r.of == scope);
        self.each(rules.filter(|r| r.unique.is_none()), values, subject)
    }

    /// What no two axes may have alike. The later one is told, with the name of the earlier one as `{other}`.
    fn unique(&mut self, draft: &Draft, axes: &[Values], control: &Settings) -> Result<()> {
        let family = self.family;
        for rule in &family.rules {
            let Some(name) = &rule.unique else { continue };
            let mut seen: Vec<(&Axis, &Vec<i64>)> = Vec::new();
            for (axis, values) in draft.axes.iter().zip(axes) {
                if evaluate(family, &rule.when, values, self.cycle)? == 0 {
                    continue;
                }
                let Some(cells) = values.get(name) else {
                    continue;
                };
                match seen.iter().find(|(_, known)| *known == cells) {
                    Some((other, _)) => {
                        let text = rule.text.replace("{other}", &other.name);
                        let subject = Subject::of_axis(axis, control);
                        self.told(rule, 0, &text, values, &subject);
                    }
                    None => seen.push((axis, cells)),
                }
            }
        }
        Ok(())
    }

    /// The rules of the pattern; what they read is the same for each axis of one guarantee.
    fn guarantee(
        &mut self,
        guarantee: &Guarantee,
        draft: &Draft,
        axes: &[Values],
        control: &Settings,
    ) -> Result<()> {
        let family = self.family;
        let pattern = family.patterns.get(&guarantee.pattern);
        let first = guarantee.axes.first().map(toml::Spanned::get_ref);
        let mut all = draft.axes.iter().zip(axes);
        let found = all.find(|(axis, _)| Some(&axis.name) == first);
        let (Some(pattern), Some((axis, values))) = (pattern, found) else {
            return Ok(());
        };
        let mut values = values.clone();
        let mut doors = draft.doors.iter();
        if let Some(door) = doors.find(|door| Some(&door.name) == guarantee.door.as_ref()) {
            insert(&mut values, &door.values);
        }
        insert(&mut values, &guarantee.values);
        let subject = Subject::of_guarantee(guarantee, axis, control);
        self.each(pattern.rules.iter(), &mut values, &subject)
    }

    fn each<'r>(
        &mut self,
        rules: impl Iterator<Item = &'r Rule>,
        values: &mut Values,
        subject: &Subject<'_>,
    ) -> Result<()> {
        for rule in rules {
            for k in &rule.each {
                values.insert("k".to_owned(), vec![*k]);
                if evaluate(self.family, &rule.when, values, self.cycle)? != 0 {
                    self.told(rule, *k, &rule.text, values, subject);
                }
            }
        }
        values.remove("k");
        Ok(())
    }

    fn told(&mut self, rule: &Rule, k: i64, text: &str, values: &Values, subject: &Subject<'_>) {
        let mut shown = Vec::new();
        subject.shown(&rule.when.expr, values, &mut shown);
        let mut names = rule.id.join(", ");
        if let Some(alarm) = rule.alarm {
            names = format!("{names}, alarm {alarm}");
        }
        let insert_k = |text: &str| text.replace("{k}", &k.to_string());
        let text = insert_k(text);
        let message = match shown.as_slice() {
            [] => format!("{}: {text} [{names}]", subject.name),
            list => format!("{}: {text}: {} [{names}]", subject.name, list.join(", ")),
        };
        let place = subject.find(&rule.at, k);
        let label = "this does not fit";
        self.findings
            .add(place, message, label, insert_k(&rule.fix));
    }
}
