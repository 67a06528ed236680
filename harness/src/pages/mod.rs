//! A page of the book for each safety function, made from the tables of its family.
//!
//! Which pages there are stands in `pages.toml` in the folder of the family; everything else on them comes from the tables,
//! from `family.toml`, and from the reaction chains and acceptance tests of an example machine.

mod data;
mod page;
mod parameters;
mod tables;
mod warnings;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use stillpoint_lang::catalogue;
use stillpoint_lang::diag::{Diagnostic, Diagnostics};
use stillpoint_show::document::{Block, Column, Document, Inline, Table};

use data::Family;

/// A file to be written: its name in the folder of the family, and its contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Such as `sbh.md` or `sbh-1.svg`.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// Why pages cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PagesError {
    /// A file is wrong.
    #[error(transparent)]
    Input(#[from] Diagnostics),
    /// A system cannot be explored, or the machine of a diagram has no control states.
    #[error("{0}")]
    Diagram(String),
}

impl From<Diagnostic> for PagesError {
    fn from(one: Diagnostic) -> Self {
        Self::Input(one.into())
    }
}

/// The pages of the family in `folder`, an index first; equal tables give equal bytes.
///
/// # Errors
/// Whatever is wrong with the files of the family; see [`PagesError`].
pub fn pages(folder: &Path) -> Result<Vec<Written>, PagesError> {
    let family = data::load(folder)?;
    let catalogue = catalogue::load(&folder.join(".."))?;
    let example = page::Example::load(folder, &family)?;
    let mut out = vec![Written {
        name: "index.md".to_owned(),
        text: index(&family).markdown(),
    }];
    out.push(Written {
        name: parameters::NAME.to_owned(),
        text: parameters::document(&family.known).markdown(),
    });
    let warned = stillpoint_machine::warnings::catalogue(folder)?;
    out.extend(
        warnings::document(&family.known.title, &warned).map(|page| Written {
            name: warnings::NAME.to_owned(),
            text: page.markdown(),
        }),
    );
    for page in &family.data.page {
        let document = page::document(folder, &family, page, &catalogue, &example)?;
        let stem = page.name.get_ref();
        let (text, pictures) = document.markdown_with_pictures(stem);
        out.push(Written {
            name: format!("{stem}.md"),
            text,
        });
        out.extend(
            pictures
                .into_iter()
                .map(|(name, text)| Written { name, text }),
        );
    }
    Ok(out)
}

/// What differs between the files in `folder` and what is to be written there: `missing`, `differs` or `is not made by this
/// command`, each with the name. Files beside Markdown and SVG are not looked at.
pub fn differences(folder: &Path, written: &[Written]) -> Vec<String> {
    let mut out = Vec::new();
    for file in written {
        match std::fs::read(folder.join(&file.name)) {
            Ok(bytes) if bytes == file.text.as_bytes() => {}
            Ok(_) => out.push(format!("{} differs", file.name)),
            Err(_) => out.push(format!("{} is missing", file.name)),
        }
    }
    let made: BTreeSet<&str> = written.iter().map(|w| w.name.as_str()).collect();
    let mut others: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(Result::ok)
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.ends_with(".md") || name.ends_with(".svg"))
        .filter(|name| !made.contains(name.as_str()))
        .collect();
    others.sort();
    out.extend(
        others
            .iter()
            .map(|name| format!("{name} is not made by this command")),
    );
    out
}

/// The folder below `output` for the pages of a family.
pub fn target(output: &Path, family: &Path) -> Option<PathBuf> {
    let named = family.canonicalize().ok()?;
    Some(output.join(named.file_name()?))
}

fn index(family: &Family) -> Document {
    let column = |title: &str| Column {
        title: title.to_owned(),
        number: false,
    };
    let rows = family.data.page.iter().map(|page| {
        let machines = page.machines.iter().map(|m| m.get_ref().as_str());
        vec![
            vec![Inline::Link {
                text: page.title.clone(),
                to: format!("{}.md", page.name.get_ref()),
            }],
            vec![Inline::Text(page.text.clone())],
            tables::codes(machines),
        ]
    });
    Document {
        title: format!("Safety functions: {}", family.known.title),
        subtitle: "Made from the specification by `stillpoint pages`; not to be edited."
            .replace('`', ""),
        blocks: vec![Block::Table(Table {
            caption: String::new(),
            columns: ["function", "what it is for", "machines"]
                .map(column)
                .into(),
            rows: rows.collect(),
        })],
    }
}
