//! `pages.toml` of a family: which pages there are, and what belongs on each.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result, nearest};
use stillpoint_lang::outline::{Machine, Outline, System};
use stillpoint_lang::{Spec, read_text};
use stillpoint_machine::data::FamilyData;
use toml::Spanned;

/// The file and what it says.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Data {
    /// What the requirement ids of the family begin with.
    pub prefix: String,
    /// A machine file whose reaction times and acceptance tests are shown.
    pub example: Spanned<String>,
    /// Files whose machines are no safety functions.
    pub surroundings: Vec<String>,
    pub page: Vec<Page>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Page {
    pub name: Spanned<String>,
    pub title: String,
    pub text: String,
    pub functions: Vec<Spanned<String>>,
    pub machines: Vec<Spanned<String>>,
    pub parameters: Vec<Spanned<String>>,
    /// Areas of the catalogue, or single requirements of one.
    pub requirements: Vec<String>,
    #[serde(default)]
    pub diagrams: Vec<Spanned<Figure>>,
    #[serde(default)]
    pub chains: Vec<String>,
    pub monitors: Vec<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Figure {
    pub file: String,
    pub system: String,
    pub instance: String,
    pub variables: Option<Vec<String>>,
}

/// A file of tables.
pub(super) struct Tables {
    /// Its name without folder.
    pub file: String,
    pub spec: Spec,
    pub outline: Outline,
}

/// Everything the pages are made of.
pub(super) struct Family {
    pub data: Data,
    pub known: FamilyData,
    pub tables: Vec<Tables>,
}

impl Family {
    /// A machine by its name.
    pub fn machine(&self, name: &str) -> Option<&Machine> {
        let mut all = self.tables.iter().flat_map(|t| &t.outline.machines);
        all.find(|m| m.name == name)
    }

    /// All systems, each with the name of its file.
    pub fn systems(&self) -> impl Iterator<Item = (&str, &System)> {
        self.tables.iter().flat_map(|t| {
            let systems = t.outline.systems.iter();
            systems.map(|s| (t.file.as_str(), s))
        })
    }
}

/// Reads the tables and the pages of a family and checks that they fit each other.
///
/// # Errors
/// What is wrong in any of the files; a name that does not exist, a machine without a page.
pub(super) fn load(folder: &Path) -> Result<Family> {
    let path = folder.join("pages.toml");
    let text = read_text(&path, "file of pages")?;
    let name = path.display().to_string();
    let data: Data = toml::from_str(&text).map_err(|e| {
        let message = e.message().trim().replace('\n', ", ");
        Diagnostic::new(&name, &text, e.span(), message)
            .help("compare with the other entries of this file")
    })?;
    let family = Family {
        data,
        known: stillpoint_machine::data::load(folder)?,
        tables: tables(folder)?,
    };
    let mut check = Check {
        name,
        text,
        errors: Vec::new(),
    };
    check.pages(&family, folder);
    check.complete(&family);
    match check.errors.is_empty() {
        true => Ok(family),
        false => Err(Diagnostics(check.errors)),
    }
}

/// The files with the key `spec`, by name.
fn tables(folder: &Path) -> Result<Vec<Tables>> {
    let listed = std::fs::read_dir(folder).into_iter().flatten();
    let mut files: Vec<String> = listed
        .filter_map(std::result::Result::ok)
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    files.sort();
    let mut out = Vec::new();
    for file in files {
        let path = folder.join(&file);
        let text = read_text(&path, "file of the family")?;
        if stillpoint_engine::subject::has_key(&text, "spec") {
            let spec = Spec::from_text(&path, text)?;
            let outline = spec.outline();
            out.push(Tables {
                file,
                spec,
                outline,
            });
        }
    }
    Ok(out)
}

struct Check {
    name: String,
    text: Arc<str>,
    errors: Vec<Diagnostic>,
}

impl Check {
    fn error(&mut self, span: std::ops::Range<usize>, message: String, help: String) {
        let found = Diagnostic::new(&self.name, &self.text, Some(span), message);
        self.errors.push(found.label("here").help(help));
    }

    fn names(&mut self, what: &str, given: &[Spanned<String>], known: &[&str]) {
        for name in given {
            let word = name.get_ref().as_str();
            if !known.contains(&word) {
                let help = match nearest(word, known.iter().copied()) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("there are {}", known.join(", ")),
                };
                self.error(name.span(), format!("there is no {what} \"{word}\""), help);
            }
        }
    }

    fn pages(&mut self, family: &Family, folder: &Path) {
        let known = &family.known;
        let functions: Vec<&str> = known.functions.iter().map(|f| f.name.as_str()).collect();
        let parameters: Vec<&str> = known.parameters.iter().map(|p| p.name.as_str()).collect();
        let machines: Vec<&str> = (family.tables.iter())
            .flat_map(|t| &t.outline.machines)
            .map(|m| m.name.as_str())
            .collect();
        let mut names: BTreeMap<&str, ()> = BTreeMap::new();
        for page in &family.data.page {
            self.names("function", &page.functions, &functions);
            self.names("parameter", &page.parameters, &parameters);
            self.names("machine", &page.machines, &machines);
            let name = page.name.get_ref().as_str();
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            if name.is_empty() || !name.chars().all(plain) || name == "index" {
                let help = "write a-z, 0-9 and - only; the page `index` is made by itself";
                let message = format!("\"{name}\" cannot be the name of a page");
                self.error(page.name.span(), message, help.to_owned());
            }
            if names.insert(name, ()).is_some() {
                let message = format!("there are two pages \"{name}\"");
                let help = "give one of them another name";
                self.error(page.name.span(), message, help.to_owned());
            }
            for figure in &page.diagrams {
                let of = figure.get_ref();
                let system = family
                    .systems()
                    .find(|(file, s)| *file == of.file && s.name == of.system);
                let found = system
                    .is_some_and(|(_, s)| s.instances.iter().any(|(name, _)| *name == of.instance));
                if !found {
                    let message = format!(
                        "{} has no system `{}` with an instance `{}`",
                        of.file, of.system, of.instance
                    );
                    let help = "name a file of this folder, one of its systems and an instance";
                    self.error(figure.span(), message, help.to_owned());
                }
            }
            let root = folder.join("../../..");
            for monitor in &page.monitors {
                if !root.join(monitor.get_ref()).is_file() {
                    let message = format!("there is no file {}", monitor.get_ref());
                    let help = "name it from the root of the repository";
                    self.error(monitor.span(), message, help.to_owned());
                }
            }
        }
    }

    /// Every machine that is a safety function stands on a page, and every property.
    fn complete(&mut self, family: &Family) {
        let shown = |machine: &str| {
            let mut all = family.data.page.iter().flat_map(|p| &p.machines);
            all.any(|m| m.get_ref() == machine)
        };
        let end = self.text.len()..self.text.len();
        for tables in &family.tables {
            let surrounds = family.data.surroundings.contains(&tables.file);
            for machine in tables.spec.own_machines() {
                if !surrounds && !shown(machine) {
                    let message = format!("machine `{machine}` of {} is on no page", tables.file);
                    let help = "add it to the `machines` of a page, or its file to `surroundings`";
                    self.error(end.clone(), message, help.to_owned());
                }
            }
        }
        for (file, system) in family.systems() {
            for property in &system.properties {
                let ids = || property.req.iter().chain([&property.id]);
                let on = |page: &Page| ids().any(|id| page.carries(&family.data.prefix, id));
                if !family.data.page.iter().any(on) {
                    let message = format!(
                        "property {} of system `{}` in {file} is on no page",
                        property.id, system.name
                    );
                    let help = "add the area of one of its requirements to a page";
                    self.error(end.clone(), message, help.to_owned());
                }
            }
        }
    }
}

impl Page {
    /// Whether an id `PREFIX-AREA-...` belongs to the page, by its area or by its beginning.
    pub fn carries(&self, prefix: &str, id: &str) -> bool {
        let Some(rest) = id.strip_prefix(prefix).and_then(|r| r.strip_prefix('-')) else {
            return false;
        };
        let begins = |with: &String| {
            let more = rest.strip_prefix(with.as_str());
            more.is_some_and(|more| more.is_empty() || more.starts_with('-'))
        };
        self.requirements.iter().any(begins)
    }
}
