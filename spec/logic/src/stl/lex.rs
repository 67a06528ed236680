//! Words, names in quotation marks, signs and ends of lines, each with its place; comments are left out.

use crate::fault::Span;

/// What a token is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Kind {
    /// Letters, digits and `_`.
    Word(String),
    /// A symbol in quotation marks.
    Quoted(String),
    Sign(&'static str),
    /// Something that has no meaning outside of a title.
    Other(char),
    Newline,
}

/// A token.
#[derive(Debug, Clone)]
pub(super) struct Token {
    pub kind: Kind,
    pub span: Span,
}

/// Longer signs come first.
const SIGNS: [&str; 21] = [
    ":=", "==", "<>", ">=", "<=", "=", "<", ">", "(", ")", "[", "]", ".", ",", ":", ";", "#", "+",
    "-", "$", "*",
];

/// The tokens of a text.
pub(super) fn lex(source: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = source[at..].chars().next() {
        let rest = &source[at..];
        let start = at;
        if c == '\n' {
            at += 1;
            tokens.push(Token {
                kind: Kind::Newline,
                span: start..at,
            });
        } else if c.is_whitespace() || c == '\u{feff}' {
            at += c.len_utf8();
        } else if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if let Some(name) = quoted(rest) {
            at += name.len() + 2;
            tokens.push(Token {
                kind: Kind::Quoted(name.trim().to_owned()),
                span: start..at,
            });
        } else if c.is_alphanumeric() || c == '_' {
            let word: String = rest
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect();
            at += word.len();
            tokens.push(Token {
                kind: Kind::Word(word),
                span: start..at,
            });
        } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            at += sign.len();
            tokens.push(Token {
                kind: Kind::Sign(sign),
                span: start..at,
            });
        } else {
            at += c.len_utf8();
            tokens.push(Token {
                kind: Kind::Other(c),
                span: start..at,
            });
        }
    }
    let end = source.len();
    tokens.push(Token {
        kind: Kind::Newline,
        span: end..end,
    });
    tokens
}

/// The symbol that a text begins with, without its quotation marks; it ends in its line.
fn quoted(text: &str) -> Option<&str> {
    let line = text.strip_prefix('"')?.lines().next()?;
    line.split_once('"').map(|(name, _)| name)
}
