//! Whether an answer is older than what it was given for: a fingerprint of the sources of a harness.
//!
//! The sources are found by names: a file needs the modules of its family that it names as `module::`, and so on. That may be
//! a few too many, so that an answer counts as older than it is; comments and blank lines do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::inventory::Entry;

/// Whether the file of its monitor is found, or another one is named: else an answer would never be older than its monitor.
pub fn has_sources(entry: &Entry) -> bool {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../impl/src");
    entry.file.is_some() || modules(&root.join(entry.family)).contains_key(entry.monitor)
}

/// The fingerprint of everything the harness is made of: monitors, kernel, draws, property, attributes.
pub fn fingerprint(entry: &Entry) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let monitors = root.join("../impl/src");
    let modules = modules(&monitors.join(entry.family));
    let draws = modules_of_draws(&root.join("src/arbitrary").join(entry.family));

    // What every harness of a family is made of.
    let mut files: Vec<PathBuf> = ["kernel.rs", "units.rs", "contract.rs", "fields.rs"]
        .map(|name| monitors.join(name))
        .into();
    files
        .extend(["kani_source.rs", "source.rs", "draw.rs"].map(|name| root.join("src").join(name)));
    let mut texts: Vec<String> = files.iter().map(|file| code(file)).collect();

    let mut open: Vec<String> = Vec::new();
    if let Some(file) = entry.file {
        let text = code(&root.join("src").join(file));
        // The draws of the monitors that the property names, and those it shares with others.
        open.extend(named(&text, &modules));
        texts.extend(draws.values().cloned());
        texts.push(text);
    } else {
        open.push(entry.monitor.to_owned());
        let draw = format!("pub fn {}<", entry.monitor);
        let of_it =
            |(name, text): &(&String, &String)| *name == entry.monitor || text.contains(&draw);
        texts.extend(draws.iter().filter(of_it).map(|(_, text)| text.clone()));
        texts.extend(draws.get("mod").cloned());
    }
    let mut seen = BTreeSet::new();
    while let Some(module) = open.pop() {
        if let Some(files) = modules.get(&module).filter(|_| seen.insert(module.clone())) {
            for text in files {
                open.extend(named(text, &modules));
            }
        }
    }
    texts.extend(
        seen.iter()
            .filter_map(|name| modules.get(name))
            .flatten()
            .cloned(),
    );
    let named = stubs(entry.kani).into_iter().map(|file| root.join(file));
    texts.extend(named.map(|file| code(&file)));
    texts.push(format!("{} {} {:?}", entry.id, entry.kani, entry.few));
    if !entry.few_in.is_empty() {
        texts.push(format!("{:?}", entry.few_in));
    }
    hash(&texts)
}

/// The files of the stubs that the attributes of a harness name, but for those that every harness is made of, or its draws.
pub fn stubs(attributes: &str) -> BTreeSet<PathBuf> {
    let attributes = attributes.replace(' ', "");
    let paths = attributes.split("crate::").skip(1);
    let of = |path: &str| {
        let end = path.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
        let modules: Vec<&str> = path.get(..end?)?.split("::").collect();
        let known = matches!(modules.first(), Some(&("kani_source" | "arbitrary")) | None);
        // What stands behind the file are its modules and the function.
        let files = (1..modules.len()).rev().map(|count| {
            let mut file = Path::new("src").join(modules.get(..count)?.join("/"));
            file.set_extension("rs");
            Some(file)
        });
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut files = files.flatten().filter(|file| root.join(file).exists());
        files.next().filter(|_| !known)
    };
    paths.filter_map(of).collect()
}

/// The modules of `modules` that a text names.
pub fn named(text: &str, modules: &BTreeMap<String, Vec<String>>) -> Vec<String> {
    let is_named = |name: &&String| {
        text.match_indices(&format!("{name}::")).any(|(at, _)| {
            let before = text.get(..at).and_then(|text| text.chars().next_back());
            !before.is_some_and(|c| c.is_alphanumeric() || c == '_')
        })
    };
    modules.keys().filter(is_named).cloned().collect()
}

/// The modules of a family of monitors, however deep, each with its files without comments: a folder has all that is in it. The
/// wrong variants are left out.
pub fn modules(folder: &Path) -> BTreeMap<String, Vec<String>> {
    let mut modules: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in texts(folder) {
        let inside = path.strip_prefix(folder).unwrap_or(&path);
        let names: Vec<String> = inside
            .components()
            .map(|part| part.as_os_str().to_string_lossy())
            .map(|name| name.trim_end_matches(".rs").to_owned())
            .filter(|name| name != "mod")
            .collect();
        if !names.iter().any(|name| name == "mutant") {
            for name in names {
                modules.entry(name).or_default().push(text.clone());
            }
        }
    }
    modules
}

/// The files of the draws of a family by name.
fn modules_of_draws(folder: &Path) -> BTreeMap<String, String> {
    let name = |path: PathBuf| {
        path.file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    texts(folder)
        .into_iter()
        .map(|(path, text)| (name(path), text))
        .collect()
}

/// Every source in a folder, in the order of the paths.
fn texts(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut texts = BTreeMap::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            texts.append(&mut self::texts(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = code(&path);
            texts.insert(path, text);
        }
    }
    texts
}

/// The lines of a file that are neither blank nor a comment; nothing of a file that cannot be read.
pub fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let lines = text.lines().map(str::trim);
    let lines: Vec<&str> = lines
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
        .collect();
    lines.join("\n")
}

/// FNV-1a of 64 bits: tells that something was edited, not that somebody has forged it.
fn hash(texts: &[String]) -> String {
    let bytes = texts.iter().flat_map(|text| text.bytes().chain([0]));
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    format!("{hash:016x}")
}
