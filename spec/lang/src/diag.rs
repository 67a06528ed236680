//! Diagnostics: every error names file, line and column, the offending text, and the fix.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use miette::{LabeledSpan, SourceCode};

use crate::excerpt::{Excerpt, shortened};

/// One finding about an input file.
#[derive(Debug, Clone)]
pub struct Diagnostic {
    /// File name as the user gave it.
    pub file: String,
    /// The whole text of the file (empty if it could not be read).
    pub source: Arc<str>,
    /// Byte range of the offending text, when there is one.
    pub span: Option<Range<usize>>,
    /// What is wrong, with the offending value.
    pub message: String,
    /// Short text at the marked place.
    pub label: String,
    /// What to write instead, or which values are allowed.
    pub help: String,
    /// What is shown of the source: small, whatever its size.
    excerpt: Option<Excerpt>,
}

/// All errors found in an input, in file order. Never empty when returned as an error.
#[derive(Debug, Clone)]
pub struct Diagnostics(pub Vec<Diagnostic>);

/// Result of reading an input.
pub type Result<T> = core::result::Result<T, Diagnostics>;

impl Diagnostic {
    /// A finding in `file` with the text `source`, at `span`.
    pub fn new(
        file: &str,
        source: &Arc<str>,
        span: Option<Range<usize>>,
        message: impl Into<String>,
    ) -> Self {
        Self {
            file: file.to_owned(),
            source: source.clone(),
            excerpt: span.as_ref().map(|span| Excerpt::new(file, source, span)),
            span,
            message: shortened(message.into()),
            label: String::new(),
            help: String::new(),
        }
    }

    /// Sets the text shown at the marked place.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = shortened(label.into());
        self
    }

    /// Sets the fix.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = shortened(help.into());
        self
    }

    /// Line and column, both from 1, of the marked place.
    pub fn position(&self) -> Option<(usize, usize)> {
        position(&self.source, self.span.as_ref()?.start)
    }
}

/// Line and column, both from 1, of a byte of a text; the end for one beyond it.
pub fn position(text: &str, at: usize) -> Option<(usize, usize)> {
    let before = text.get(..at.min(text.len()))?;
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
    Some((line, column))
}

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        Self(vec![one])
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.position() {
            Some((line, column)) => {
                write!(f, "{}:{line}:{column}: {}", self.file, self.message)
            }
            None => write!(f, "{}: {}", self.file, self.message),
        }
    }
}

impl std::error::Error for Diagnostic {}

impl miette::Diagnostic for Diagnostic {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        (!self.help.is_empty()).then(|| Box::new(&self.help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt.as_ref().map(|e| e as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.excerpt.as_ref()?.span.clone();
        let label = (!self.label.is_empty()).then(|| self.label.clone());
        Some(Box::new(std::iter::once(LabeledSpan::new(
            label,
            span.start,
            span.len(),
        ))))
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, one) in self.0.iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{one}")?;
            if !one.help.is_empty() {
                write!(f, "\n  help: {}", one.help)?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

/// The candidate nearest to `word` by edit distance, if it is near enough to be a misspelling.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters = word.chars().count();
    // In a short word one letter makes another name.
    let limit = match letters {
        0 | 1 => return None,
        2 | 3 => 1,
        _ => letters / 3 + 1,
    };
    candidates
        .into_iter()
        .map(|c| (edit_distance(&word.to_lowercase(), &c.to_lowercase()), c))
        .filter(|(d, _)| *d <= limit)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

/// The candidates of which `word` is a part: `SBH` of `SBH/SG`, `SN1` of `SN1+` and `SN1-`.
pub fn with_part<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let is_part = |candidate: &&str| {
        let mut parts = candidate.split(|c: char| !c.is_alphanumeric());
        parts.any(|part| part.eq_ignore_ascii_case(word))
    };
    candidates.into_iter().filter(is_part).collect()
}

fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let change = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
