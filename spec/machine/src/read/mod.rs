//! From the TOML tables of a machine file to axes, groups and doors with a checked value for every parameter.

mod doors;
mod groups;
mod guarantees;

use std::collections::BTreeMap;

use indexmap::IndexMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Findings;
use super::family::{Family, Param, Quantity};
use super::guarantee::Guarantee;
use super::units::{alternatives, quoted};
use super::value::{Raw, number_in_range};
use super::{Axis, AxisKind, Door, Group, Place, Setting, Settings};
use stillpoint_lang::diag::{nearest, with_part};

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
    /// The axis groups whose values could all be read.
    pub groups: Vec<Group>,
    /// The doors whose values could all be read.
    pub doors: Vec<Door>,
    /// The guarantees whose values could all be read.
    pub guarantees: Vec<Guarantee>,
}

/// Reads the tables of a machine file; what is wrong goes to `findings`.
pub(super) fn read(family: &Family, table: &DeTable<'_>, findings: &mut Findings) -> Draft {
    let mut reader = Reader {
        family,
        axes: names_in(table, "axis"),
        groups: names_in(table, "group"),
        findings,
    };
    reader.keys(table);
    let empty = DeTable::new();
    let control = reader.part(table, "control").unwrap_or(&empty);
    let (settings, sound) = reader.settings(&family.control, control, &Owner::of("the control"));
    let text = |reader: &mut Reader<'_>, key| {
        let value = table.get(key)?;
        reader.findings.text(key, value)
    };
    let mut draft = Draft {
        name: text(&mut reader, "name"),
        title: text(&mut reader, "title"),
        control: sound.then_some(settings),
        axes: Vec::new(),
        groups: Vec::new(),
        doors: Vec::new(),
        guarantees: Vec::new(),
    };
    match table.get("axis") {
        Some(value) => draft.axes = reader.axes(value),
        None => reader.findings.add(
            None,
            "the machine has no axis",
            "",
            "add a table such as [axis.X] with kind = \"linear\" and its parameters",
        ),
    }
    if let Some(params) = &family.group {
        draft.groups = reader.read_groups(params, table);
    }
    if let Some(value) = table.get("door") {
        draft.doors = reader.doors(value, &draft.groups);
    }
    reader.references(&draft);
    if let Some(value) = table.get("guarantee") {
        draft.guarantees = reader.guarantees(value, &draft.axes, &draft.doors);
    }
    draft
}

/// The names of the tables below `part`, also of those whose values cannot be read: a follow-on finding about them would
/// mislead.
fn names_in(table: &DeTable<'_>, part: &str) -> Vec<String> {
    match table.get(part).map(Spanned::get_ref) {
        Some(DeValue::Table(inner)) => inner.keys().map(|k| k.get_ref().to_string()).collect(),
        _ => Vec::new(),
    }
}

/// Whose values are read.
struct Owner<'a> {
    /// Its name in messages.
    place: &'a str,
    kind: AxisKind,
    /// The kind as the file names it; empty for what is no axis.
    word: &'a str,
    /// The keys that are no parameters.
    structural: &'a [&'a str],
}

impl<'a> Owner<'a> {
    fn of(place: &'a str) -> Self {
        Self {
            place,
            kind: AxisKind::Linear,
            word: "",
            structural: &[],
        }
    }
}

struct Reader<'a> {
    family: &'a Family,
    /// The names of all axes and groups of the file.
    axes: Vec<String>,
    groups: Vec<String>,
    findings: &'a mut Findings,
}

impl Reader<'_> {
    /// The keys at the top of the file.
    fn keys(&mut self, table: &DeTable<'_>) {
        let mut known = vec![
            "family", "name", "title", "control", "axis", "door", "accepted",
        ];
        if self.family.group.is_some() {
            known.push("group");
        }
        if !self.family.patterns.is_empty() {
            known.push("guarantee");
        }
        if !self.family.logic.is_empty() {
            known.push("logic");
        }
        for key in table.keys() {
            let name = key.get_ref().as_ref();
            if !known.contains(&name) {
                self.findings
                    .unknown_key(key.span(), name, "a machine file", &known);
            }
        }
    }

    /// The table `key` of the file, if it is there and a table.
    fn part<'t, 'a>(&mut self, table: &'t DeTable<'a>, key: &str) -> Option<&'t DeTable<'a>> {
        let value = table.get(key)?;
        self.findings.table(key, value)
    }

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

    /// The names of axes, groups or doors: well-formed, and different also for a reader who ignores case.
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
            spindle: false,
            functions: Vec::new(),
            values: BTreeMap::new(),
            interpolates_with: Vec::new(),
            pair: None,
            place: place.clone(),
            functions_place: None,
        };
        let mut structural = vec!["title", "kind"];
        if !family.functions.is_empty() {
            structural.push("functions");
        }
        if family.group.is_none() {
            structural.push("interpolates_with");
        }
        if !family.own.is_empty() {
            structural.push("pair");
        }
        let mut kind = None;
        for (key, value) in table.iter() {
            let key = key.get_ref().as_ref();
            if !structural.contains(&key) {
                continue;
            }
            match key {
                "title" => axis.title = self.findings.text("title", value).unwrap_or_default(),
                "kind" => kind = self.kind(value),
                "functions" => {
                    axis.functions_place = Some(value.span());
                    axis.functions = self.functions(value);
                }
                "interpolates_with" => {
                    axis.interpolates_with = self.findings.texts("interpolates_with", value);
                }
                "pair" => {
                    let named = self.findings.text("pair", value);
                    axis.pair = named.map(|name| Spanned::new(value.span(), name));
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
        let (word, kind) = kind?;
        axis.kind = kind;
        axis.spindle = word == "spindle";
        let owner = Owner {
            place: &format!("axis {name}"),
            kind,
            word,
            structural: &structural,
        };
        let (values, sound) = self.settings(&family.axis, table, &owner);
        axis.values = values;
        sound.then_some(axis)
    }

    fn kind(&mut self, value: &Spanned<DeValue<'_>>) -> Option<(&'static str, AxisKind)> {
        let text = self.findings.text("kind", value)?;
        let found = KINDS.iter().find(|(name, _)| *name == text);
        if found.is_none() {
            self.findings.add(
                value.span(),
                format!("\"{text}\" is no kind of axis"),
                "no such kind",
                format!("allowed: {}", quoted(&KINDS.map(|(name, _)| name))),
            );
        }
        found.copied()
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
                    match (
                        &with_part(&name, known.iter().copied())[..],
                        nearest(&name, known.iter().copied()),
                    ) {
                        ([], Some(near)) => format!("did you mean \"{near}\"?"),
                        ([], None) => format!("allowed: {}", quoted(&known)),
                        (of, _) => format!("did you mean {}?", quoted(of)),
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

    /// A value for each of `params`, given in `table` or by default, and whether all could be read. An axis has no value of a
    /// parameter for other kinds of axes.
    fn settings(
        &mut self,
        params: &IndexMap<String, Param>,
        table: &DeTable<'_>,
        owner: &Owner<'_>,
    ) -> (Settings, bool) {
        let mut sound = true;
        let mut settings: Settings = params
            .iter()
            .filter(|(_, param)| param.is_of(owner.word))
            .map(|(name, param)| (name.clone(), Setting::by_default(param, owner.kind)))
            .collect();
        for (key, value) in table.iter() {
            let written = key.get_ref().as_ref();
            let of_manual = || params.iter().find(|(_, p)| p.is_called(written));
            let found = params.get_key_value(written).or_else(of_manual);
            if let Some((name, param)) = found {
                let name = name.as_str();
                if settings.get(name).is_some_and(Setting::is_given) {
                    let message = format!("{}: {name} is given twice", owner.place);
                    let help = format!("remove '{written}', or the other one");
                    let label = format!("'{written}' is {name}");
                    self.findings.add(key.span(), message, label, help);
                    sound = false;
                    continue;
                }
                let setting = if param.is_of(owner.word) {
                    self.setting(name, param, value, owner)
                } else {
                    self.other_kind(key.span(), name, param, owner);
                    None
                };
                match setting {
                    Some(setting) => _ = settings.insert(name.to_owned(), setting),
                    None => sound = false,
                }
            } else if !owner.structural.contains(&written) {
                let mut known = owner.structural.to_vec();
                let own = params.iter().filter(|(_, param)| param.is_of(owner.word));
                known.extend(own.map(|(name, _)| name.as_str()));
                self.findings
                    .unknown_key(key.span(), written, owner.place, &known);
                sound = false;
            }
        }
        (settings, sound)
    }

    fn other_kind(&mut self, at: Place, name: &str, param: &Param, owner: &Owner<'_>) {
        let message = format!(
            "{}: {name} is for an axis with kind {}, this one has kind \"{}\"",
            owner.place,
            alternatives(&param.kinds.iter().map(String::as_str).collect::<Vec<_>>()),
            owner.word
        );
        let help = "remove it, or correct the kind";
        self.findings.add(at, message, "of another kind", help);
    }

    fn setting(
        &mut self,
        name: &str,
        param: &Param,
        value: &Spanned<DeValue<'_>>,
        owner: &Owner<'_>,
    ) -> Option<Setting> {
        let (place, kind) = (owner.place, owner.kind);
        if param.quantity == Quantity::Groups {
            return self.predecessors(name, value, place);
        }
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

    /// Axes that other entries name must exist; an axis does not interpolate with itself, nor is it a pair with itself.
    fn references(&mut self, draft: &Draft) {
        for axis in &draft.axes {
            match &axis.pair {
                Some(pair) if *pair.get_ref() == axis.name => self.findings.add(
                    pair.span(),
                    format!("axis {} is a pair with itself", axis.name),
                    "this axis itself",
                    "name the axis whose drive moves the same thing",
                ),
                Some(pair) => self.known_axis(pair),
                None => {}
            }
        }
        let of_axes = draft.axes.iter();
        let of_axes = of_axes.map(|a| (Some(&a.name), &a.interpolates_with));
        let of_groups = draft.groups.iter().map(|g| (None, &g.axes));
        // A door that names groups has their axes.
        let of_doors = draft.doors.iter().filter(|d| d.groups.is_empty());
        let of_doors = of_doors.map(|d| (None, &d.axes));
        for (own, list) in of_axes.chain(of_groups).chain(of_doors) {
            for other in list {
                let name = other.get_ref();
                if own == Some(name) {
                    self.findings.add(
                        other.span(),
                        format!("axis {name} interpolates with itself"),
                        "this axis itself",
                        "name the other axes only",
                    );
                } else {
                    self.known_axis(other);
                }
            }
        }
    }

    /// An axis that is named must be in the file.
    fn known_axis(&mut self, name: &Spanned<String>) {
        if !self.axes.contains(name.get_ref()) {
            self.findings.add(
                name.span(),
                format!("there is no axis '{}'", name.get_ref()),
                "no such axis",
                format!("axes of this machine: {}", self.axes.join(", ")),
            );
        }
    }
}
