//! Something wrong in a program: where, what, and what to write instead.

use std::ops::Range;
use std::sync::Arc;

use stillpoint_lang::diag::Diagnostic;

/// A byte range of the program's text.
pub(crate) type Span = Range<usize>;

/// An error in a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    pub span: Span,
    pub message: String,
    pub label: String,
    pub help: String,
}

/// The result of reading or translating a part of a program.
pub(crate) type Checked<T> = Result<T, Fault>;

impl Fault {
    /// A fault at a place; an empty label leaves the place marked without words.
    pub fn new(span: &Span, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            span: span.clone(),
            message: message.into(),
            label: String::new(),
            help: help.into(),
        }
    }

    /// The words at the marked place.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The fault as all errors of input are told.
    pub fn told(self, file: &str, source: &Arc<str>) -> Diagnostic {
        Diagnostic::new(file, source, Some(self.span), self.message)
            .label(self.label)
            .help(self.help)
    }
}
