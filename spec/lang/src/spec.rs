//! A specification file with everything it includes.

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use indexmap::IndexMap;

use crate::diag::{Diagnostic, Diagnostics, Result};
use crate::schema::{self, Text};
use crate::syntax::{self, SyntaxError, ast};
use crate::text::read_text;

/// A file that was read.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub name: String,
    pub text: Arc<str>,
    /// The name its key `spec` gives.
    pub spec: String,
}

/// A definition and the file it stands in.
#[derive(Clone)]
pub(crate) struct Located<T> {
    pub file: usize,
    pub span: Range<usize>,
    pub def: T,
}

/// A specification: enums, functions, readings, machines and systems of a file and of the files it includes.
#[derive(Clone)]
pub struct Spec {
    /// Name given by the key `spec`.
    pub name: String,
    /// Title.
    pub title: String,
    /// Where its facts come from.
    pub source: String,
    pub(crate) sources: Vec<Source>,
    pub(crate) enums: IndexMap<String, Located<schema::Enum>>,
    pub(crate) functions: IndexMap<String, Located<schema::Function>>,
    pub(crate) readings: IndexMap<String, Located<schema::Reading>>,
    pub(crate) machines: IndexMap<String, Located<schema::Machine>>,
    pub(crate) systems: IndexMap<String, Located<schema::System>>,
}

/// What this module reads, in messages.
const KIND: &str = "specification file";

/// Turns an error of the TOML reader into a diagnostic.
pub fn toml_error(file: &str, text: &Arc<str>, e: &toml::de::Error) -> Diagnostic {
    let message = e.message().trim().replace('\n', ", ");
    let help = if message.contains("unknown field") {
        "only the keys named are allowed here; check the spelling and the table it stands in"
    } else if message.contains("missing field") {
        "add the key"
    } else {
        "correct the TOML syntax or the value at the marked place"
    };
    Diagnostic::new(file, text, e.span(), message).help(help)
}

impl Spec {
    /// Reads a specification file and all it includes.
    ///
    /// # Errors
    /// Everything wrong in the files' TOML, and definitions that stand twice.
    pub fn load(path: &Path) -> Result<Self> {
        let text = read_text(path, KIND)?;
        Self::from_text(path, text)
    }

    /// Like [`Spec::load`], from a text already read; `path` names it and locates its includes.
    ///
    /// # Errors
    /// As [`Spec::load`].
    pub fn from_text(path: &Path, text: Arc<str>) -> Result<Self> {
        let mut spec = Spec {
            name: String::new(),
            title: String::new(),
            source: String::new(),
            sources: Vec::new(),
            enums: IndexMap::new(),
            functions: IndexMap::new(),
            readings: IndexMap::new(),
            machines: IndexMap::new(),
            systems: IndexMap::new(),
        };
        let mut errors = Vec::new();
        let mut seen = HashSet::new();
        spec.include(path, text, &mut seen, &mut errors);
        if errors.is_empty() {
            Ok(spec)
        } else {
            Err(Diagnostics(errors))
        }
    }

    fn include(
        &mut self,
        path: &Path,
        text: Arc<str>,
        seen: &mut HashSet<PathBuf>,
        errors: &mut Vec<Diagnostic>,
    ) {
        seen.insert(path.canonicalize().unwrap_or_else(|_| path.to_owned()));
        let name = path.display().to_string();
        let file: schema::File = match toml::from_str(&text) {
            Ok(file) => file,
            Err(e) => return errors.push(toml_error(&name, &text, &e)),
        };
        let id = self.sources.len();
        self.sources.push(Source {
            name: name.clone(),
            text: text.clone(),
            spec: file.spec.get_ref().clone(),
        });
        if id == 0 {
            self.name = file.spec.get_ref().clone();
            self.title = file.title;
            self.source = file.source;
        }
        for used in &file.uses {
            let target = path
                .parent()
                .unwrap_or_else(|| Path::new("."))
                .join(used.get_ref());
            let known = target.canonicalize().unwrap_or_else(|_| target.clone());
            if seen.contains(&known) {
                continue;
            }
            match read_text(&target, KIND) {
                Ok(inner) => self.include(&target, inner, seen, errors),
                Err(Diagnostics(list)) => errors.extend(list.into_iter().map(|d| {
                    Diagnostic::new(&name, &text, Some(used.span()), d.to_string())
                        .label("included here")
                        .help("`use` names files relative to this one")
                })),
            }
        }
        let mut duplicates = Vec::new();
        merge(&mut self.enums, file.enums, id, &mut duplicates);
        merge(&mut self.functions, file.function, id, &mut duplicates);
        merge(&mut self.readings, file.reading, id, &mut duplicates);
        merge(&mut self.machines, file.machine, id, &mut duplicates);
        if id == 0 {
            merge(&mut self.systems, file.system, id, &mut duplicates);
        }
        for (what, span) in duplicates {
            errors.push(
                Diagnostic::new(
                    &name,
                    &text,
                    Some(span),
                    format!("`{what}` is defined twice"),
                )
                .label("second definition")
                .help("rename one of them, or include the common file once"),
            );
        }
    }

    /// Puts a machine that stands in another file in the place of the one with its name.
    pub(crate) fn put_machine(
        &mut self,
        file: &str,
        text: &Arc<str>,
        name: &Text,
        def: schema::Machine,
    ) {
        let id = self.sources.len();
        self.sources.push(Source {
            name: file.to_owned(),
            text: text.clone(),
            spec: self.name.clone(),
        });
        let located = Located {
            file: id,
            span: name.span(),
            def,
        };
        self.machines.insert(name.get_ref().clone(), located);
    }

    /// Names of the systems of this file, in the order they stand there.
    pub fn systems(&self) -> impl Iterator<Item = &str> {
        self.systems.keys().map(String::as_str)
    }

    /// Names of the machines, included ones too.
    pub fn machines(&self) -> impl Iterator<Item = &str> {
        self.machines.keys().map(String::as_str)
    }

    /// Names of the machines declared in the file itself.
    pub fn own_machines(&self) -> impl Iterator<Item = &str> {
        self.machines
            .iter()
            .filter(|(_, m)| m.file == 0)
            .map(|(n, _)| n.as_str())
    }

    /// The files this specification was read from.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.sources.iter().map(|s| s.name.as_str())
    }

    /// A diagnostic at a text of a file.
    pub(crate) fn error(
        &self,
        file: usize,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> Diagnostic {
        let source = &self.sources[file];
        Diagnostic::new(&source.name, &source.text, Some(span), message)
    }

    /// Where byte range `inner` of the parsed value of `text` stands in the file.
    pub(crate) fn locate(&self, file: usize, text: &Text, inner: &Range<usize>) -> Range<usize> {
        let span = text.span();
        let Some(raw) = self.sources[file].text.get(span.clone()) else {
            return span;
        };
        let quotes = if raw.starts_with("\"\"\"") || raw.starts_with("'''") {
            if raw[3..].starts_with('\n') { 4 } else { 3 }
        } else {
            1
        };
        // With escapes in the text the offsets differ: then the whole text is marked.
        match raw.get(quotes..) {
            Some(body) if body.starts_with(text.get_ref().as_str()) => {
                let start = span.start + quotes + inner.start;
                start..(span.start + quotes + inner.end).max(start)
            }
            _ => span,
        }
    }

    fn syntax(&self, file: usize, text: &Text, e: SyntaxError) -> Diagnostic {
        self.error(file, self.locate(file, text, &e.span), e.message)
            .help(e.help)
    }

    pub(crate) fn expr(
        &self,
        file: usize,
        text: &Text,
    ) -> std::result::Result<ast::Expr, Diagnostic> {
        syntax::parse_expr(text.get_ref()).map_err(|e| self.syntax(file, text, e))
    }

    pub(crate) fn effect(
        &self,
        file: usize,
        text: &Text,
    ) -> std::result::Result<Vec<ast::Stmt>, Diagnostic> {
        syntax::parse_effect(text.get_ref()).map_err(|e| self.syntax(file, text, e))
    }

    pub(crate) fn type_of(
        &self,
        file: usize,
        text: &Text,
    ) -> std::result::Result<ast::TypeExpr, Diagnostic> {
        syntax::parse_type(text.get_ref()).map_err(|e| self.syntax(file, text, e))
    }

    pub(crate) fn decl(
        &self,
        file: usize,
        text: &Text,
    ) -> std::result::Result<(String, ast::TypeExpr), Diagnostic> {
        syntax::parse_decl(text.get_ref()).map_err(|e| self.syntax(file, text, e))
    }
}

fn merge<T>(
    into: &mut IndexMap<String, Located<T>>,
    from: schema::Map<T>,
    file: usize,
    duplicates: &mut Vec<(String, Range<usize>)>,
) {
    for (key, def) in from {
        let span = key.span();
        let name = key.into_inner();
        if into.contains_key(&name) {
            duplicates.push((name, span));
        } else {
            into.insert(name, Located { file, span, def });
        }
    }
}
