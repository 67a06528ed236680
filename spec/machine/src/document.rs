//! A TOML text with the place of every key and value, and the collection of everything that is wrong in it.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result, nearest};

/// The errors of one file, collected while it is read.
pub(super) struct Findings {
    file: String,
    source: Arc<str>,
    list: Vec<Diagnostic>,
}

impl Findings {
    /// No finding yet in the file `file` with this text.
    pub(super) fn new(file: &str, source: &Arc<str>) -> Self {
        Self {
            file: file.to_owned(),
            source: source.clone(),
            list: Vec::new(),
        }
    }

    /// Adds one finding; the place may be missing.
    pub(super) fn add(
        &mut self,
        span: impl Into<Option<Range<usize>>>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) {
        let one = Diagnostic::new(&self.file, &self.source, span.into(), message);
        self.list.push(one.label(label).help(help));
    }

    /// The value of a result; its errors become findings.
    pub(super) fn take<T>(&mut self, result: Result<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(Diagnostics(list)) => {
                self.list.extend(list);
                None
            }
        }
    }

    /// Whether nothing is wrong so far.
    pub(super) fn none(&self) -> bool {
        self.list.is_empty()
    }

    /// The findings in the order of the file.
    pub(super) fn into_diagnostics(mut self) -> Diagnostics {
        self.list
            .sort_by_key(|d| d.span.as_ref().map_or(usize::MAX, |s| s.start));
        Diagnostics(self.list)
    }

    /// `value` if nothing is wrong, else the findings in the order of the file.
    pub(super) fn finish<T>(self, value: T) -> Result<T> {
        if self.list.is_empty() {
            Ok(value)
        } else {
            Err(self.into_diagnostics())
        }
    }

    /// Parses TOML. Keys given twice become findings and the rest is returned; after a syntax error nothing is, since
    /// what follows it can be misread.
    pub(super) fn parse<'t>(&mut self, text: &'t str) -> Option<DeTable<'t>> {
        let (table, errors) = DeTable::parse_recoverable(text);
        let mut sound = true;
        let mut repeated_until = 0;
        for error in errors {
            let span = error.span().unwrap_or(0..0);
            if error.message() != "duplicate key" {
                sound = false;
                self.add(
                    span,
                    format!("not valid TOML: {}", error.message()),
                    "here",
                    "the form is `key = value`, with tables `[axis.X]`; texts stand in double quotes",
                );
            } else if span.start >= repeated_until {
                let line = text
                    .get(..span.start)
                    .and_then(|t| t.rfind('\n'))
                    .map_or(0, |n| n + 1);
                let rest = text.get(line..).unwrap_or("");
                let what = if rest.trim_start().starts_with('[') {
                    // The keys below a repeated header are no errors of their own.
                    let next = rest.find("\n[").map_or(text.len(), |n| line + n);
                    repeated_until = next.max(span.end);
                    rest.lines().next().unwrap_or("").trim()
                } else {
                    text.get(span.clone()).unwrap_or("")
                };
                self.add(
                    span,
                    format!("'{what}' stands twice"),
                    "the second one",
                    "give each axis, door and parameter once, each under a name of its own",
                );
            }
        }
        sound.then(|| table.into_inner())
    }

    /// The value as text, or a finding.
    pub(super) fn text(&mut self, key: &str, value: &Spanned<DeValue<'_>>) -> Option<String> {
        match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            other => {
                let got = kind_of(other);
                self.add(
                    value.span(),
                    format!("'{key}' needs a text; got {got}"),
                    got,
                    format!("write {key} = \"...\""),
                );
                None
            }
        }
    }

    /// The value as a list of texts, each with its place, or findings.
    pub(super) fn texts(
        &mut self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
    ) -> Vec<Spanned<String>> {
        let DeValue::Array(items) = value.get_ref() else {
            let got = kind_of(value.get_ref());
            self.add(
                value.span(),
                format!("'{key}' needs a list of texts; got {got}"),
                got,
                format!("write {key} = [\"...\", \"...\"]"),
            );
            return Vec::new();
        };
        let mut list = Vec::new();
        for item in items.iter() {
            if let Some(text) = self.text(key, item) {
                list.push(Spanned::new(item.span(), text));
            }
        }
        list
    }

    /// The value as a table, or a finding.
    pub(super) fn table<'a, 't>(
        &mut self,
        key: &str,
        value: &'a Spanned<DeValue<'t>>,
    ) -> Option<&'a DeTable<'t>> {
        if let DeValue::Table(table) = value.get_ref() {
            return Some(table);
        }
        let got = kind_of(value.get_ref());
        self.add(
            value.span(),
            format!("'{key}' needs a table; got {got}"),
            got,
            format!("write a line [{key}] and the values below it"),
        );
        None
    }

    /// A key that does not exist in `place`, with the nearest one that does.
    pub(super) fn unknown_key(
        &mut self,
        span: Range<usize>,
        key: &str,
        place: &str,
        known: &[&str],
    ) {
        let help = match nearest(key, known.iter().copied()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("keys that can stand here: {}", known.join(", ")),
        };
        self.add(
            span,
            format!("unknown key '{key}' in {place}"),
            "not a key of this table",
            help,
        );
    }
}

/// With article, for messages.
pub(super) fn kind_of(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
