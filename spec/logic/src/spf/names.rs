//! The names of a program, and what printed texts did to them.

use std::collections::BTreeMap;

use super::lex::Token;
use super::listing::Repair;
use super::variable::Variable;
use crate::fault::Span;

/// Words that cannot be names.
pub(crate) const RESERVED: [&str; 31] = [
    "PROC",
    "SBLOF",
    "DISPLOF",
    "DEF",
    "INT",
    "REAL",
    "BOOL",
    "DEFINE",
    "AS",
    "MSG",
    "SIRELIN",
    "SIRELOUT",
    "SIRELTIME",
    "SIRELAY",
    "M02",
    "M2",
    "M17",
    "M30",
    "IDS",
    "ID",
    "DO",
    "WHEN",
    "WHENEVER",
    "EVERY",
    "FROM",
    "AND",
    "OR",
    "XOR",
    "NOT",
    "TRUE",
    "FALSE",
];

/// Whether a word is one of the language, however it is written.
pub(crate) fn is_reserved(word: &str) -> bool {
    RESERVED.iter().any(|r| r.eq_ignore_ascii_case(word))
}

/// A name has at most so many pieces in print.
const PIECES: usize = 6;

/// What a name stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Meaning {
    Variable(Variable),
    /// In millionths, and whether it has a decimal point.
    Number(i64, bool),
    /// Of DEF: it takes the answer of a set-up.
    Local,
    /// A fragment uses it and does not define it.
    Undefined,
}

/// A name that is known.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    /// As it is written where it is defined.
    pub name: String,
    pub meaning: Meaning,
    pub span: Span,
}

/// The names of a program; they have no case.
#[derive(Debug, Default)]
pub(crate) struct Names(BTreeMap<String, Known>);

impl Names {
    pub fn get(&self, name: &str) -> Option<&Known> {
        self.0.get(&name.to_ascii_uppercase())
    }

    pub fn insert(&mut self, known: Known) {
        self.0.insert(known.name.to_ascii_uppercase(), known);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Known> {
        self.0.values()
    }

    /// Adds a name of a fragment that nothing defines.
    pub fn undefined(&mut self, name: &str, span: &Span) {
        if self.get(name).is_none() {
            self.insert(Known {
                name: name.to_owned(),
                meaning: Meaning::Undefined,
                span: span.clone(),
            });
        }
    }

    /// The one name for which something holds.
    fn only(&self, holds: impl Fn(&Known) -> bool) -> Option<&Known> {
        let mut found = self.iter().filter(|known| holds(known));
        let first = found.next()?;
        found.next().is_none().then_some(first)
    }

    /// Puts together what was one name in print; each repair is noted.
    pub fn repair(&self, source: &str, tokens: &mut Vec<(Token, Span)>, repairs: &mut Vec<Repair>) {
        let mut at = 0;
        while at < tokens.len() {
            if let Token::Text(text) = &tokens[at].0 {
                let words: Vec<&str> = text.split_whitespace().collect();
                if let Some((rule, name)) = self.joined(&words).filter(|_| words.len() > 1) {
                    let note = format!("`{name}` for `{text}`");
                    repairs.push(Repair::new(tokens[at].1.start, rule, note));
                    tokens[at].0 = Token::Text(name);
                }
            }
            self.repair_words(source, tokens, at, repairs);
            at += 1;
        }
    }

    /// The words from one token on.
    fn repair_words(
        &self,
        source: &str,
        tokens: &mut Vec<(Token, Span)>,
        at: usize,
        repairs: &mut Vec<Repair>,
    ) {
        let parts = tokens[at..].iter().take(PIECES);
        let words: Vec<String> = parts
            .map_while(|(token, span)| part(source, token, span))
            .collect();
        for length in (1..=words.len()).rev() {
            let words: Vec<&str> = words[..length].iter().map(String::as_str).collect();
            let plain = |word: &&str| is_reserved(word) || self.get(word).is_some();
            let number = matches!(tokens[at].0, Token::Number(..));
            if words.iter().all(plain) || (number && length == 1) {
                continue;
            }
            let span = tokens[at].1.start..tokens[at + length - 1].1.end;
            let printed = words.join(" ");
            let (rule, new) = if let Some((rule, name)) = self.joined(&words) {
                let text = format!("`{name}` for `{printed}`");
                (Repair::new(span.start, rule, text), vec![Token::Word(name)])
            } else if let Some(name) = self.after_not(&words) {
                let text = format!("`NOT {name}` for `{printed}`");
                let tokens = vec![Token::Word("NOT".to_owned()), Token::Word(name)];
                (Repair::new(span.start, "R5", text), tokens)
            } else {
                continue;
            };
            repairs.push(rule);
            let new = new.into_iter().map(|token| (token, span.clone()));
            tokens.splice(at..at + length, new);
            return;
        }
    }

    /// The name that words were in print, and the repair.
    fn joined(&self, words: &[&str]) -> Option<(&'static str, String)> {
        let joined = words.join("_").to_ascii_uppercase();
        if let Some(known) = self.get(&joined) {
            return Some(("R2", known.name.clone()));
        }
        let upper = |known: &Known| known.name.to_ascii_uppercase();
        let alike = |known: &Known| confused(&upper(known)) == confused(&joined);
        if let Some(known) = self.only(alike) {
            return Some(("R6", known.name.clone()));
        }
        // Each blank may have been a letter.
        let lost = |known: &Known| {
            let name = upper(known);
            let printed = words.join(" ").to_ascii_uppercase();
            name.len() == printed.len()
                && name
                    .chars()
                    .zip(printed.chars())
                    .all(|(n, p)| p == ' ' || n == p)
        };
        if words.len() > 1 {
            return self.only(lost).map(|known| ("R5", known.name.clone()));
        }
        if let Some(known) = self.only(|known| misnumbered(&upper(known), &joined, &known.meaning))
        {
            return Some(("R10", known.name.clone()));
        }
        let same = |known: &Known| {
            let name = upper(known);
            let digit = name
                .strip_prefix(&joined)
                .is_some_and(|rest| rest.len() == 1 && rest.chars().all(|c| c.is_ascii_digit()));
            digit || name.replace('_', "") == joined.replace('_', "")
        };
        let named = |known: &Known| known.meaning != Meaning::Undefined && same(known);
        self.only(named).map(|known| ("R13", known.name.clone()))
    }

    /// `NOTIE02 SCHUTZTUER`: the name after a NOT that runs into it.
    fn after_not(&self, words: &[&str]) -> Option<String> {
        let joined = words.join("_").to_ascii_uppercase();
        let rest = joined
            .strip_prefix("NOT")
            .filter(|rest| !rest.starts_with('_'))?;
        Some(self.get(rest)?.name.clone())
    }
}

/// A word or a number without sign or point, as a part of a name.
fn part(source: &str, token: &Token, span: &Span) -> Option<String> {
    match token {
        Token::Word(word) => Some(word.clone()),
        Token::Number(_, false) => source.get(span.clone()).map(str::to_owned),
        _ => None,
    }
}

/// Letters that print alike become one.
fn confused(name: &str) -> String {
    let letter = |c: char| match c {
        '0' => 'O',
        '1' => 'I',
        other => other,
    };
    name.chars().map(letter).collect()
}

/// R10: names that differ in their numbers, of which the one that is used is that of the variable: `OE07_P1P2` for `$A_OUTSE[07]`.
fn misnumbered(defined: &str, used: &str, meaning: &Meaning) -> bool {
    let Meaning::Variable(variable) = meaning else {
        return false;
    };
    let digits = |name: &str| -> String {
        let number = name.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        number.chars().take_while(char::is_ascii_digit).collect()
    };
    let (is, was) = (digits(used), digits(defined));
    let index = is.parse::<u16>().ok();
    was != is
        && !was.is_empty()
        && index.is_some_and(|index| variable.to_string().ends_with(&format!("[{index}]")))
        && defined.replacen(&was, &is, 1) == used
}

/// R4: names of system variables that were misprinted.
pub(crate) fn misprinted(tokens: &mut [(Token, Span)], repairs: &mut Vec<Repair>) {
    for (token, span) in tokens {
        let Token::System(name) = token else { continue };
        let right = match name.to_ascii_uppercase().as_str() {
            "A_MAKERSI" => "A_MARKERSI",
            "A_INST" => "A_INSI",
            _ => continue,
        };
        let text = format!("`${right}` for `${name}`");
        repairs.push(Repair::new(span.start, "R4", text));
        *token = Token::System(right.to_owned());
    }
}
