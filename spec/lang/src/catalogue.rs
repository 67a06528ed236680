//! The requirement catalogues: one testable behaviour per entry, with its place in the manual.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Deserialize;
use toml::Spanned;

use crate::diag::{Diagnostic, Diagnostics, Result};

/// Which part of the project carries a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scope {
    /// Behaviour of the safety functions: specified, implemented, proved.
    Core,
    /// Tools, commissioning and diagnosis around them.
    Support,
    /// A property of hardware: traced, never implemented here.
    Hardware,
}

/// What a requirement speaks about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// How the system is composed.
    Architecture,
    /// What is done when a machine is set up.
    Commissioning,
    /// What must not be, or must hold of a configuration.
    Constraint,
    /// What is shown to the user.
    Diagnostic,
    /// Reaction to a fault or violation.
    Fault,
    /// What a safety function does.
    Function,
    /// A signal, telegram or call.
    Interface,
    /// Meaning, range or default of a parameter.
    Parameter,
    /// What holds in a state.
    State,
    /// A test the system or the user carries out.
    Test,
    /// A duration or an order in time.
    Timing,
    /// A change of state and its condition.
    Transition,
}

/// One requirement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Requirement {
    /// Unique over all families: `S840D-STOP-021`.
    pub id: String,
    /// The family: the folder of the catalogue.
    pub family: String,
    /// A few words.
    pub title: String,
    /// The behaviour, testable.
    pub text: String,
    /// The parameters it depends on, as the catalogue names them.
    pub params: Vec<String>,
    /// Key of the manual, then chapter and lines: `SI0306; 5.1.5 lines 2198-2200`.
    pub source: String,
    /// What it speaks about.
    pub kind: Kind,
    /// Who carries it.
    pub scope: Scope,
    /// The requirement that carries this one's content, when the two were found to be one.
    pub merged_into: Option<String>,
}

/// A manual that catalogues cite.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manual {
    /// Its printed title.
    pub title: String,
    /// Its printed edition.
    pub edition: String,
    /// The last line of its plain text.
    pub lines: usize,
    /// What it is valid for.
    pub note: String,
}

/// All requirements of a folder tree and the manuals they cite.
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    /// In the order of the folders, files and entries, by name.
    pub requirements: Vec<Requirement>,
    /// By key.
    pub manuals: BTreeMap<String, Manual>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CatalogueFile {
    requirement: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ManualFile {
    manual: BTreeMap<Spanned<String>, Manual>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: Spanned<String>,
    title: String,
    text: String,
    #[serde(default)]
    params: Vec<String>,
    source: Spanned<String>,
    kind: Kind,
    scope: Scope,
    merged_into: Option<Spanned<String>>,
}

/// The first of a list of requirements that stands in it before.
pub fn twice(list: &[String]) -> Option<&str> {
    let (_, repeated) = list
        .iter()
        .enumerate()
        .find(|(at, id)| list.iter().take(*at).any(|earlier| earlier == *id))?;
    Some(repeated)
}

/// A list of requirements of a file, for `deserialize_with`.
///
/// # Errors
/// Another value, or a requirement that stands in the list twice.
pub fn once<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Vec<String>, D::Error> {
    let list = Vec::deserialize(deserializer)?;
    match twice(&list) {
        Some(id) => {
            let message = format!("{id} stands twice in this list: remove one of them");
            Err(serde::de::Error::custom(message))
        }
        None => Ok(list),
    }
}

/// The requirement that a name stands for, its id or one of its sentences: `F-STOP-001` for `F-STOP-001/a`.
pub fn requirement_id(named: &str) -> &str {
    named.split('/').next().unwrap_or(named)
}

/// Loads every `requirements*.toml` and `manual.toml` in the folders of `root`, one folder a family.
///
/// # Errors
/// Files that cannot be read or have another form, ids used twice, sources that cite no declared manual, and merged
/// requirements whose carrier does not exist.
pub fn load(root: &Path) -> Result<Catalogue> {
    let mut loader = Loader::default();
    for folder in entries(root)?
        .into_iter()
        .filter(|p| crate::files::is_dir(p))
    {
        for file in entries(&folder)? {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let family = folder.file_name().unwrap_or_default().to_string_lossy();
            if name == "manual.toml" {
                loader.manual(&file);
            } else if name.starts_with("requirements") && name.ends_with(".toml") {
                loader.requirements(&file, &family);
            }
        }
    }
    loader.finish()
}

/// The entries of a folder, sorted by name, so that the order is the same everywhere.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let fail = |e: std::io::Error| {
        let message = format!("cannot list this folder: {e}");
        Diagnostic::new(&folder.display().to_string(), &Arc::from(""), None, message)
            .help("check the path and the permissions")
    };
    Ok(crate::files::list(folder).map_err(fail)?)
}

/// The place of something that is checked after all files are read.
struct Cited {
    file: Arc<Source>,
    what: Spanned<String>,
}

struct Source {
    name: String,
    text: Arc<str>,
}

#[derive(Default)]
struct Loader {
    catalogue: Catalogue,
    seen: BTreeMap<String, String>,
    sources: Vec<Cited>,
    carriers: Vec<Cited>,
    findings: Vec<Diagnostic>,
}

impl Loader {
    /// Reads a file and gives it its form, or adds the finding.
    fn open<T: serde::de::DeserializeOwned>(&mut self, path: &Path) -> Option<(Arc<Source>, T)> {
        let name = path.display().to_string();
        let text: Arc<str> = match crate::files::read_to_string(path) {
            Ok(text) => text.into(),
            Err(error) => {
                let message = format!("cannot read this file: {error}");
                self.findings.push(
                    Diagnostic::new(&name, &Arc::from(""), None, message)
                        .help("check the permissions and that the file is UTF-8"),
                );
                return None;
            }
        };
        match toml::from_str(&text) {
            Ok(data) => Some((Arc::new(Source { name, text }), data)),
            Err(error) => {
                self.findings.push(
                    Diagnostic::new(&name, &text, error.span(), error.message())
                        .help("compare with the other entries of this file"),
                );
                None
            }
        }
    }

    fn find(&mut self, file: &Source, at: std::ops::Range<usize>, message: String, help: &str) {
        self.findings
            .push(Diagnostic::new(&file.name, &file.text, Some(at), message).help(help));
    }

    fn manual(&mut self, path: &Path) {
        let Some((file, data)) = self.open::<ManualFile>(path) else {
            return;
        };
        for (key, manual) in data.manual {
            if self
                .catalogue
                .manuals
                .insert(key.get_ref().clone(), manual)
                .is_some()
            {
                let message = format!("the manual '{}' is declared twice", key.get_ref());
                self.find(&file, key.span(), message, "declare each manual once");
            }
        }
    }

    fn requirements(&mut self, path: &Path, family: &str) {
        let Some((file, data)) = self.open::<CatalogueFile>(path) else {
            return;
        };
        for entry in data.requirement {
            let id = entry.id.get_ref().clone();
            if let Some(first) = self.seen.insert(id.clone(), file.name.clone()) {
                let message = format!("the id {id} is used twice, first in {first}");
                self.find(
                    &file,
                    entry.id.span(),
                    message,
                    "give each requirement an id of its own",
                );
            }
            let merged_into = entry.merged_into.as_ref().map(|m| m.get_ref().clone());
            self.carriers.extend(entry.merged_into.map(|what| Cited {
                file: file.clone(),
                what,
            }));
            self.sources.push(Cited {
                file: file.clone(),
                what: entry.source.clone(),
            });
            self.catalogue.requirements.push(Requirement {
                id,
                family: family.to_owned(),
                title: entry.title,
                text: entry.text.trim().to_owned(),
                params: entry.params,
                source: entry.source.into_inner(),
                kind: entry.kind,
                scope: entry.scope,
                merged_into,
            });
        }
    }

    fn finish(mut self) -> Result<Catalogue> {
        for cited in std::mem::take(&mut self.sources) {
            let key = cited.what.get_ref().split(';').next().unwrap_or("").trim();
            if !self.catalogue.manuals.contains_key(key) {
                let message = format!("the source cites the unknown manual '{key}'");
                let help = "start it with the key of a manual that manual.toml declares, then ';'";
                self.find(&cited.file, cited.what.span(), message, help);
            }
        }
        for cited in std::mem::take(&mut self.carriers) {
            if !self.seen.contains_key(cited.what.get_ref()) {
                let message = format!(
                    "merged into the unknown requirement '{}'",
                    cited.what.get_ref()
                );
                self.find(
                    &cited.file,
                    cited.what.span(),
                    message,
                    "name the requirement that carries it",
                );
            }
        }
        if self.findings.is_empty() {
            return Ok(self.catalogue);
        }
        // The files were read in order; what was checked at the end goes to its file's place.
        let start = |d: &Diagnostic| d.span.as_ref().map_or(0, |s| s.start);
        self.findings
            .sort_by(|a, b| (&a.file, start(a)).cmp(&(&b.file, start(b))));
        Err(Diagnostics(self.findings))
    }
}
