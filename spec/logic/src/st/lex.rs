//! Tokens of a program, without its comments.

use stillpoint_lang::syntax::{ast::Kind, parse_expr};

use crate::fault::{Checked, Fault, Span};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Token {
    /// A number; those with a base are whole numbers too.
    Int(i64),
    /// A duration in microseconds.
    Time(u64),
    /// A name or keyword as it is written.
    Word(String),
    Sym(&'static str),
    End,
}

impl Token {
    pub fn describe(&self) -> String {
        match self {
            Token::Int(v) => format!("`{v}`"),
            Token::Time(us) => format!("`T#{us}us`"),
            Token::Word(w) => format!("`{w}`"),
            Token::Sym(s) => format!("`{s}`"),
            Token::End => "the end of the file".to_owned(),
        }
    }
}

// Longest first, so that `:=` is not read as `:` and `=`.
const SYMBOLS: [&str; 24] = [
    ":=", "=>", "<>", "<=", ">=", "..", "**", "=", "<", ">", "+", "-", "*", "/", "(", ")", "[",
    "]", ",", ";", ":", ".", "#", "&",
];

/// The tokens with their places; the last one is [`Token::End`].
pub(crate) fn tokens(text: &str) -> Checked<Vec<(Token, Span)>> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if c.is_whitespace() || c == '\u{feff}' {
            at += c.len_utf8();
        } else if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("(*") {
            at += comment(rest, at, "*)")?;
        } else if rest.starts_with("/*") {
            at += comment(rest, at, "*/")?;
        } else {
            let (token, length) = token(rest, at, c)?;
            out.push((token, at..at + length));
            at += length;
        }
    }
    out.push((Token::End, text.len()..text.len()));
    Ok(out)
}

fn comment(rest: &str, at: usize, end: &str) -> Checked<usize> {
    let length = rest[2..].find(end).ok_or_else(|| {
        Fault::new(
            &(at..at + 2),
            "this comment is not closed",
            format!("end it with `{end}`"),
        )
    })?;
    Ok(length + 4)
}

fn token(rest: &str, at: usize, c: char) -> Checked<(Token, usize)> {
    if c.is_ascii_digit() {
        return number(rest, at);
    }
    if c.is_ascii_alphabetic() || c == '_' {
        let length = word(rest);
        let name = &rest[..length];
        if rest[length..].starts_with('#') && is_time(name) {
            return time(rest, at, length + 1);
        }
        return Ok((Token::Word(name.to_owned()), length));
    }
    if let Some(symbol) = SYMBOLS.iter().find(|s| rest.starts_with(**s)) {
        return Ok((Token::Sym(symbol), symbol.len()));
    }
    let span = at..at + c.len_utf8();
    Err(match c {
        '\'' | '"' => Fault::new(
            &span,
            "texts (STRING) are not taken",
            "a safe PLC program decides by BOOL, INT, TIME and enums",
        ),
        '%' => Fault::new(
            &span,
            "addresses such as %IX0.0 are not taken",
            "use the names of the inputs and outputs; how they are wired stands in the machine file",
        ),
        '{' => Fault::new(
            &span,
            "pragmas are not taken",
            "take it out: it could change what the program means",
        ),
        '^' => Fault::new(&span, "pointers are not taken", "name the variable itself"),
        _ => Fault::new(
            &span,
            format!("`{c}` has no meaning here"),
            "use names, numbers, := ; , ( ) AND OR XOR NOT = <> < > <= >= + - * / MOD",
        ),
    })
}

/// The length of the word at the start of a text.
fn word(text: &str) -> usize {
    text.find(|ch: char| !ch.is_ascii_alphanumeric() && ch != '_')
        .unwrap_or(text.len())
}

fn is_time(name: &str) -> bool {
    ["T", "TIME", "LT", "LTIME"]
        .iter()
        .any(|prefix| name.eq_ignore_ascii_case(prefix))
}

/// `12`, `1_000`, `16#FF`, `2#1010`.
fn number(rest: &str, at: usize) -> Checked<(Token, usize)> {
    let head = word(rest);
    let (digits, base, length) = match rest[head..].strip_prefix('#') {
        Some(tail) => {
            let length = head + 1 + word(tail);
            (&rest[head + 1..length], &rest[..head], length)
        }
        None => (&rest[..head], "10", head),
    };
    let span = at..at + length;
    let after = &rest[length..];
    if after.starts_with('.') && !after.starts_with("..") {
        return Err(Fault::new(
            &span,
            "numbers with a decimal point (REAL) are not taken",
            "count in whole units: INT, or TIME such as T#1.5s",
        ));
    }
    let plain: String = digits.chars().filter(|ch| *ch != '_').collect();
    let radix = [("2", 2), ("8", 8), ("10", 10), ("16", 16)];
    let radix = radix.iter().find(|(text, _)| *text == base);
    let value = radix.and_then(|(_, radix)| i64::from_str_radix(&plain, *radix).ok());
    match value.filter(|v| *v <= i64::from(i32::MAX)) {
        Some(value) => Ok((Token::Int(value), length)),
        None => Err(Fault::new(
            &span,
            format!("`{}` is not a number", &rest[..length]),
            "write 12, 1_000, 16#FF, 8#17 or 2#1010, at most 2147483647",
        )),
    }
}

/// `T#1s500ms`: as the tables have it, with any spelling of the prefix.
fn time(rest: &str, at: usize, head: usize) -> Checked<(Token, usize)> {
    let body = &rest[head..];
    let length = body
        .find(|ch: char| !ch.is_ascii_alphanumeric() && ch != '_' && ch != '.')
        .unwrap_or(body.len());
    let length = body[..length].find("..").unwrap_or(length);
    match parse_expr(&format!("T#{}", &body[..length])).map(|e| e.kind) {
        Ok(Kind::Time(us)) if us <= LONGEST_TIME => Ok((Token::Time(us), head + length)),
        _ => Err(Fault::new(
            &(at..at + head + length),
            format!("`{}` is not a time", &rest[..head + length]),
            "write T#100ms, T#1s500ms or TIME#0.5s, with the units d h m s ms us, at most 24 days",
        )),
    }
}

/// Longer times have no place in a program that is explored.
const LONGEST_TIME: u64 = 24 * 86_400 * 1_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<Token> {
        let read = tokens(text).unwrap_or_else(|e| panic!("{}", e.message));
        read.into_iter().map(|(token, _)| token).collect()
    }

    #[test]
    fn literals_have_their_value() {
        let read = kinds("16#FF 2#1010 1_000 0..3 T#1s500ms time#0.5s");
        let time = |us| Token::Time(us);
        let int = |v| Token::Int(v);
        let range = [int(0), Token::Sym(".."), int(3)];
        let expected = [vec![int(255), int(10), int(1000)], range.to_vec()].concat();
        assert_eq!(read[..6], expected);
        assert_eq!(read[6..8], [time(1_500_000), time(500_000)]);
    }

    #[test]
    fn comments_are_left_out() {
        assert_eq!(kinds("(* a *) // b\n /* c *) */").len(), 1);
        assert!(tokens("a (* b").is_err());
        assert!(tokens("(*)").is_err());
    }

    #[test]
    fn what_is_not_taken_has_its_place() {
        for (text, at) in [("a := 1.5;", 5), ("x 'a'", 2), ("%IX0.0", 0), ("é", 0)] {
            let fault = tokens(text).expect_err("refused");
            assert_eq!(fault.span.start, at, "{text}");
            assert!(text.get(fault.span).is_some(), "{text}");
        }
    }
}
