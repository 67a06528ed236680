//! The expression language: IEC 61131-3 Structured Text, parsed to a syntax tree with spans.

pub mod ast;
mod lex;
mod parse;

pub use parse::{SyntaxError, parse_decl, parse_effect, parse_expr, parse_type};

/// Whether a word belongs to the language and cannot be a name.
pub(crate) fn is_keyword(word: &str) -> bool {
    parse::KEYWORDS.contains(&word)
}
