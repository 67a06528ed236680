//! Reads a program into its syntax tree.

mod declarations;
mod expressions;
mod statements;

use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{File, Word};
use crate::st::lex::{Token, tokens};

/// Deeper nesting is refused, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 40;

/// Words that cannot be names, in upper case.
const KEYWORDS: &[&str] = &[
    "PROGRAM",
    "END_PROGRAM",
    "FUNCTION",
    "END_FUNCTION",
    "FUNCTION_BLOCK",
    "END_FUNCTION_BLOCK",
    "VAR",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_IN_OUT",
    "VAR_TEMP",
    "VAR_GLOBAL",
    "VAR_EXTERNAL",
    "CONSTANT",
    "RETAIN",
    "NON_RETAIN",
    "PERSISTENT",
    "AT",
    "END_VAR",
    "TYPE",
    "END_TYPE",
    "STRUCT",
    "END_STRUCT",
    "ARRAY",
    "OF",
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "CASE",
    "END_CASE",
    "FOR",
    "TO",
    "BY",
    "DO",
    "END_FOR",
    "WHILE",
    "END_WHILE",
    "REPEAT",
    "UNTIL",
    "END_REPEAT",
    "RETURN",
    "EXIT",
    "CONTINUE",
    "AND",
    "OR",
    "XOR",
    "NOT",
    "MOD",
    "TRUE",
    "FALSE",
];

/// Whether a word is a keyword, however it is written.
pub(crate) fn is_keyword(word: &str) -> bool {
    KEYWORDS.iter().any(|k| k.eq_ignore_ascii_case(word))
}

/// Reads a file: functions and function blocks in any number, and one program.
///
/// # Errors
/// The first place that is not of the language; what follows it can be misread.
pub(crate) fn parse(text: &str) -> Checked<File> {
    let mut parser = Parser {
        tokens: tokens(text)?,
        at: 0,
        depth: 0,
    };
    parser.file()
}

struct Parser {
    tokens: Vec<(Token, Span)>,
    at: usize,
    depth: usize,
}

impl Parser {
    fn token(&self, ahead: usize) -> &(Token, Span) {
        // The list ends with `End`, which is never left.
        &self.tokens[(self.at + ahead).min(self.tokens.len() - 1)]
    }

    fn peek(&self) -> &Token {
        &self.token(0).0
    }

    fn span(&self) -> Span {
        self.token(0).1.clone()
    }

    /// The end of what was read last.
    fn end(&self) -> usize {
        self.at
            .checked_sub(1)
            .and_then(|k| self.tokens.get(k))
            .map_or(0, |(_, span)| span.end)
    }

    fn since(&self, start: usize) -> Span {
        start..self.end().max(start)
    }

    fn is_sym(&self, symbol: &str) -> bool {
        matches!(self.peek(), Token::Sym(s) if *s == symbol)
    }

    fn sym(&mut self, symbol: &str) -> bool {
        let hit = self.is_sym(symbol);
        self.at += usize::from(hit);
        hit
    }

    fn is_word(&self, word: &str) -> bool {
        matches!(self.peek(), Token::Word(w) if w.eq_ignore_ascii_case(word))
    }

    fn word(&mut self, word: &str) -> bool {
        let hit = self.is_word(word);
        self.at += usize::from(hit);
        hit
    }

    /// The next word in upper case; empty where there is none.
    fn upper(&self) -> String {
        match self.peek() {
            Token::Word(word) => word.to_ascii_uppercase(),
            _ => String::new(),
        }
    }

    fn wanted<T>(&self, what: &str) -> Checked<T> {
        Err(Fault::new(
            &self.span(),
            format!("{what} is missing before {}", self.peek().describe()),
            format!("write {what} here"),
        ))
    }

    fn expect(&mut self, symbol: &str) -> Checked<()> {
        match self.sym(symbol) {
            true => Ok(()),
            false => self.wanted(&format!("`{symbol}`")),
        }
    }

    fn expect_word(&mut self, word: &str) -> Checked<()> {
        match self.word(word) {
            true => Ok(()),
            false => self.wanted(&format!("`{word}`")),
        }
    }

    /// The word that closes what was opened by `opener` at a place.
    fn close(&mut self, word: &str, opener: &str, opened: &Span) -> Checked<()> {
        if self.word(word) {
            return Ok(());
        }
        Err(Fault::new(
            opened,
            format!(
                "this {opener} is not closed: `{word}` is missing before {}",
                self.peek().describe()
            ),
            format!("end it with `{word}`"),
        )
        .label(format!("{opener} without {word}")))
    }

    /// The `;` after a statement or declaration, missed where the text before it ends.
    fn semicolon(&mut self) -> Checked<()> {
        if self.sym(";") {
            return Ok(());
        }
        let end = self.end();
        Err(Fault::new(
            &(end.saturating_sub(1)..end),
            format!("`;` is missing before {}", self.peek().describe()),
            "end each statement and each declaration with `;`",
        )
        .label("after this"))
    }

    fn name(&mut self) -> Checked<Word> {
        match self.peek() {
            Token::Word(text) if !is_keyword(text) => {
                let word = Word {
                    text: text.clone(),
                    span: self.span(),
                };
                self.at += 1;
                Ok(word)
            }
            Token::Word(text) => Err(Fault::new(
                &self.span(),
                format!("a name is missing before `{text}`, which is a word of the language"),
                "choose another name",
            )),
            _ => self.wanted("a name"),
        }
    }

    /// One level of nesting deeper.
    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Checked<T>) -> Checked<T> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(Fault::new(
                &self.span(),
                format!("this is nested more than {MAX_DEPTH} deep"),
                "give parts of it a variable of their own",
            ));
        }
        let out = read(self);
        self.depth -= 1;
        out
    }
}
