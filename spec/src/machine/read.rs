//! From the TOML tables of a machine file to axes and doors with a checked value for every parameter.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Findings;
use super::family::{Family, Param};
use super::units::alternatives;
use super::value::{Raw, number_in_range};
use super::{Axis, AxisKind, Door, Place, Setting, Settings};
use crate::diag::nearest;

const KINDS: [(&str, AxisKind); 3] = [
    ("linear", AxisKind::Linear),
    ("rotary", AxisKind::Rotary),
    ("spindle", AxisKind::Rotary),
];

/// What a machine file says, before the rules between its values are looked at.
pub(super) struct Draft {
    pub name: Option<String>,
    pub title: Option<String>,
    /// `None`: not all values of the control could be read.
    pub control: Option<Settings>,
    /// The axes whose values could all be read.
    pub axes: Vec<Axis>,
    /// The doors whose values could all be read.
    pub doors: Vec<Door>,
}

/// Reads the tables of a machine file; what is wrong goes to `findings`.
pub(super) fn read(family: &Family, table: &DeTable<'_>, findings: &mut Findings) -> Draft {
    let mut draft = Draft {
        name: None,
        title: None,
        control: Some(BTreeMap::new()),
        axes: Vec::new(),
        doors: Vec::new(),
    };
    let mut reader = Reader { family, findings };
    let mut control = None;
    for (key, value) in table.iter() {
        match key.get_ref().as_ref() {
            "family" => {}
            "name" => draft.name = reader.findings.text("name", value),
            "title" => draft.title = reader.findings.text("title", value),
            "control" => control = reader.findings.table("control", value),
            "axis" => draft.axes = reader.axes(value),
            "door" => draft.doors = reader.doors(value),
            other => reader.findings.unknown_key(
                key.span(),
                other,
                "a machine file",
                &["family", "name", "title", "control", "axis", "door"],
            ),
        }
    }
    let empty = DeTable::new();
    let (settings, sound) = reader.settings(
        &family.control,
        control.unwrap_or(&empty),
        "the control",
        AxisKind::Linear,
        &[],
    );
    draft.control = sound.then_some(settings);
    if !table.contains_key("axis") {
        reader.findings.add(
            None,
            "the machine has no axis",
            "",
            "add a table such as [axis.X] with kind = \"linear\" and its parameters",
        );
    }
    reader.references(&draft, table);
    draft
}

struct Reader<'a> {
    family: &'a Family,
    findings: &'a mut Findings,
}

impl Reader<'_> {
    fn axes(&mut self, value: &Spanned<DeValue<'_>>) -> Vec<Axis> {
        let Some(table) = self.findings.table("axis", value) else {
            return Vec::new();
        };
        if table.len() > self.family.max_axes {
            self.findings.add(
                value.span(),
                format!(
                    "{} axes: a control has at most {}",
                    table.len(),
                    self.family.max_axes
                ),
                "too many axes",
                "describe each control in a file of its own",
            );
            return Vec::new();
        }
        self.names("axis", table);
        let mut axes = Vec::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            if let Some(table) = self.findings.table(&format!("axis.{name}"), value) {
                axes.extend(self.axis(name, key.span(), table));
            }
        }
        axes
    }

    /// The names of axes or doors: well-formed, and different also for a reader who ignores case.
    fn names(&mut self, what: &str, table: &DeTable<'_>) {
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        for (key, _) in table.iter() {
            let name = key.get_ref().as_ref();
            let letter = name.starts_with(|c: char| c.is_ascii_alphabetic());
            if !letter || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
                self.findings.add(
                    key.span(),
                    format!("'{name}' is no name for {what}s"),
                    "not a name",
                    "use letters, digits and '_', a letter first",
                );
            }
            if let Some(first) = seen.insert(name.to_lowercase(), name) {
                self.findings.add(
                    key.span(),
                    format!("two {what} names differ only in case: '{first}' and '{name}'"),
                    "the second one",
                    format!("give each {what} a name of its own"),
                );
            }
        }
    }

    /// `None`: not all values could be read, the findings say why.
    fn axis(&mut self, name: &str, place: Place, table: &DeTable<'_>) -> Option<Axis> {
        let family = self.family;
        let mut axis = Axis {
            name: name.to_owned(),
            title: String::new(),
            kind: AxisKind::Linear,
            functions: Vec::new(),
            values: BTreeMap::new(),
            interpolates_with: Vec::new(),
            place: place.clone(),
            functions_place: None,
        };
        let mut kind = None;
        for (key, value) in table.iter() {
            match key.get_ref().as_ref() {
                "title" => axis.title = self.findings.text("title", value).unwrap_or_default(),
                "kind" => kind = self.kind(value),
                "functions" => {
                    axis.functions_place = Some(value.span());
                    axis.functions = self.functions(value);
                }
                "interpolates_with" => {
                    axis.interpolates_with = self.findings.texts("interpolates_with", value);
                }
                _ => {}
            }
        }
        if !table.contains_key("kind") {
            self.findings.add(
                place,
                format!("axis {name} has no kind"),
                "this axis",
                "add a line such as kind = \"linear\"; a spindle has kind = \"spindle\"",
            );
        }
        axis.kind = kind?;
        let structural = ["title", "kind", "functions", "interpolates_with"];
        let place = format!("axis {name}");
        let (values, sound) = self.settings(&family.axis, table, &place, axis.kind, &structural);
        axis.values = values;
        sound.then_some(axis)
    }

    fn kind(&mut self, value: &Spanned<DeValue<'_>>) -> Option<AxisKind> {
        let text = self.findings.text("kind", value)?;
        let found = KINDS.iter().find(|(name, _)| *name == text);
        if found.is_none() {
            self.findings.add(
                value.span(),
                format!("\"{text}\" is no kind of axis"),
                "no such kind",
                format!("allowed: {}", alternatives(&KINDS.map(|(name, _)| name))),
            );
        }
        found.map(|(_, kind)| *kind)
    }

    fn functions(&mut self, value: &Spanned<DeValue<'_>>) -> Vec<String> {
        let known: Vec<&str> = self
            .family
            .functions
            .iter()
            .map(|f| f.name.as_str())
            .collect();
        let mut list: Vec<String> = Vec::new();
        for name in self.findings.texts("functions", value) {
            let span = name.span();
            let name = name.into_inner();
            if !known.contains(&name.as_str()) {
                self.findings.add(
                    span,
                    format!("\"{name}\" is no safety function of this family"),
                    "no such function",
                    match nearest(&name, known.iter().copied()) {
                        Some(near) => format!("did you mean \"{near}\"?"),
                        None => format!("allowed: {}", alternatives(&known)),
                    },
                );
            } else if list.contains(&name) {
                self.findings.add(
                    span,
                    format!("\"{name}\" is enabled twice"),
                    "the second one",
                    "name each function once",
                );
            } else {
                list.push(name);
            }
        }
        list
    }

    fn doors(&mut self, value: &Spanned<DeValue<'_>>) -> Vec<Door> {
        let Some(table) = self.findings.table("door", value) else {
            return Vec::new();
        };
        self.names("door", table);
        let mut doors = Vec::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            let Some(table) = self.findings.table(&format!("door.{name}"), value) else {
                continue;
            };
            let mut title = String::new();
            let mut axes = Vec::new();
            for (key, value) in table.iter() {
                match key.get_ref().as_ref() {
                    "title" => title = self.findings.text("title", value).unwrap_or_default(),
                    "axes" => axes = self.findings.texts("axes", value),
                    _ => {}
                }
            }
            if axes.is_empty() {
                self.findings.add(
                    key.span(),
                    format!("door {name} names no axes"),
                    "this door",
                    "add a line such as axes = [\"X\", \"Y\"]: the axes a person can reach through it",
                );
            }
            let place = format!("door {name}");
            let params = &self.family.door;
            let (values, sound) =
                self.settings(params, table, &place, AxisKind::Linear, &["title", "axes"]);
            if sound {
                doors.push(Door {
                    name: name.to_owned(),
                    title,
                    axes,
                    values,
                    place: key.span(),
                });
            }
        }
        doors
    }

    /// A value for each of `params`, given in `table` or by default, and whether all could be read.
    fn settings(
        &mut self,
        params: &IndexMap<String, Param>,
        table: &DeTable<'_>,
        place: &str,
        kind: AxisKind,
        structural: &[&str],
    ) -> (Settings, bool) {
        let mut sound = true;
        let mut settings: Settings = params
            .iter()
            .map(|(name, param)| (name.clone(), Setting::by_default(param, kind)))
            .collect();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            if let Some(param) = params.get(name) {
                match self.setting(name, param, value, place, kind) {
                    Some(setting) => _ = settings.insert(name.to_owned(), setting),
                    None => sound = false,
                }
            } else if !structural.contains(&name) {
                let mut known = structural.to_vec();
                known.extend(params.keys().map(String::as_str));
                self.findings.unknown_key(key.span(), name, place, &known);
                sound = false;
            }
        }
        (settings, sound)
    }

    fn setting(
        &mut self,
        name: &str,
        param: &Param,
        value: &Spanned<DeValue<'_>>,
        place: &str,
        kind: AxisKind,
    ) -> Option<Setting> {
        if param.count == 0 {
            let cell = self.cell(&format!("{place}: {name}"), param, value, kind)?;
            return Some(Setting::given(param, kind, vec![cell], vec![value.span()]));
        }
        let items = match value.get_ref() {
            DeValue::Array(items) if items.len() == param.count => items,
            other => {
                let got = match other {
                    DeValue::Array(items) => format!("{} values", items.len()),
                    _ => "one value".to_owned(),
                };
                self.findings.add(
                    value.span(),
                    format!(
                        "{place}: {name} needs a list of {} values, {}; got {got}",
                        param.count, param.elements
                    ),
                    got,
                    format!("write all of them, in this order: {name} = [value, value, ...]"),
                );
                return None;
            }
        };
        let mut cells = Vec::new();
        for (k, item) in items.iter().enumerate() {
            cells.extend(self.cell(&format!("{place}: {name}[{k}]"), param, item, kind));
        }
        let spans = items.iter().map(Spanned::span).collect();
        (cells.len() == param.count).then(|| Setting::given(param, kind, cells, spans))
    }

    fn cell(
        &mut self,
        place: &str,
        param: &Param,
        value: &Spanned<DeValue<'_>>,
        kind: AxisKind,
    ) -> Option<i64> {
        match number_in_range(&Raw::from(value.get_ref()), param, kind) {
            Ok(cell) => Some(cell),
            Err(refusal) => {
                let message = format!("{place}: {}", refusal.message);
                self.findings
                    .add(value.span(), message, refusal.label, refusal.help);
                None
            }
        }
    }

    /// Axes that other entries name must exist; an axis does not interpolate with itself.
    fn references(&mut self, draft: &Draft, table: &DeTable<'_>) {
        // Also those whose values could not be read: a follow-on finding about them would mislead.
        let names: Vec<&str> = match table.get("axis").map(Spanned::get_ref) {
            Some(DeValue::Table(axes)) => axes.keys().map(|k| k.get_ref().as_ref()).collect(),
            _ => Vec::new(),
        };
        let lists = draft
            .axes
            .iter()
            .map(|a| (Some(&a.name), &a.interpolates_with));
        let lists = lists.chain(draft.doors.iter().map(|d| (None, &d.axes)));
        for (own, list) in lists {
            for other in list {
                let name = other.get_ref();
                if own == Some(name) {
                    self.findings.add(
                        other.span(),
                        format!("axis {name} interpolates with itself"),
                        "this axis itself",
                        "name the other axes only",
                    );
                } else if !names.contains(&name.as_str()) {
                    self.findings.add(
                        other.span(),
                        format!("there is no axis '{name}'"),
                        "no such axis",
                        format!("axes of this machine: {}", names.join(", ")),
                    );
                }
            }
        }
    }
}
