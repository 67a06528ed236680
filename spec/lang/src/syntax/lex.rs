//! Tokens of Structured Text.

use super::ast::Span;
use super::parse::SyntaxError;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Int(i64),
    Time(u64),
    Word(String),
    Sym(&'static str),
    End,
}

impl Token {
    pub(super) fn describe(&self) -> String {
        match self {
            Token::Int(v) => format!("`{v}`"),
            Token::Time(us) => format!("`T#{us}us`"),
            Token::Word(w) => format!("`{w}`"),
            Token::Sym(s) => format!("`{s}`"),
            Token::End => "the end of the text".to_owned(),
        }
    }
}

// Longest first, so that `:=` is not read as `:` and `=`.
const SYMBOLS: [&str; 22] = [
    ":=", "<>", "<=", ">=", "..", "=", "<", ">", "+", "-", "*", "/", "(", ")", "[", "]", ",", ";",
    ":", ".", "#", "&",
];

pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Span)>, SyntaxError> {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &text[at..];
        let c = bytes[at];
        if c.is_ascii_whitespace() {
            at += 1;
        } else if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("(*") {
            let len = rest.find("*)").ok_or_else(|| {
                SyntaxError::new(at..at + 2, "comment is not closed", "end it with `*)`")
            })?;
            at += len + 2;
        } else if rest.starts_with("T#") || rest.starts_with("TIME#") {
            let (us, len) = time_literal(rest, at)?;
            out.push((Token::Time(us), at..at + len));
            at += len;
        } else if c.is_ascii_digit() {
            let len = rest
                .find(|ch: char| !ch.is_ascii_digit() && ch != '_')
                .unwrap_or(rest.len());
            let digits: String = rest[..len].chars().filter(|ch| *ch != '_').collect();
            let value = digits.parse::<i64>().map_err(|_| {
                SyntaxError::new(
                    at..at + len,
                    format!("number `{digits}` is too large"),
                    "use a number below 9223372036854775808",
                )
            })?;
            out.push((Token::Int(value), at..at + len));
            at += len;
        } else if c.is_ascii_alphabetic() {
            let len = rest
                .find(|ch: char| !ch.is_ascii_alphanumeric() && ch != '_')
                .unwrap_or(rest.len());
            out.push((Token::Word(rest[..len].to_owned()), at..at + len));
            at += len;
        } else if let Some(sym) = SYMBOLS.iter().find(|s| rest.starts_with(**s)) {
            out.push((Token::Sym(sym), at..at + sym.len()));
            at += sym.len();
        } else {
            let ch = rest.chars().next().unwrap_or(' ');
            return Err(SyntaxError::new(
                at..at + ch.len_utf8(),
                format!("character `{ch}` has no meaning here"),
                "use Structured Text: names, numbers, AND OR NOT = <> < > <= >= + - * / MOD",
            ));
        }
    }
    out.push((Token::End, text.len()..text.len()));
    Ok(out)
}

/// `T#1s500ms` and the like, in microseconds, exactly.
fn time_literal(rest: &str, at: usize) -> Result<(u64, usize), SyntaxError> {
    let head = rest.find('#').unwrap_or(0) + 1;
    let body = &rest[head..];
    let len = body
        .find(|ch: char| !ch.is_ascii_alphanumeric() && ch != '_' && ch != '.')
        .unwrap_or(body.len());
    // `T#1ms..T#2ms`: two dots belong to a range.
    let len = body[..len].find("..").unwrap_or(len);
    let span = at..at + head + len;
    let bad = |what: &str| {
        SyntaxError::new(
            span.clone(),
            format!("time literal `{}` {what}", &rest[..head + len]),
            "write for example T#100ms, T#1s500ms or T#0.5s",
        )
    };
    let mut left = &body[..len];
    if left.is_empty() {
        return Err(bad("has no value"));
    }
    let mut total: u64 = 0;
    while !left.is_empty() {
        let digits = left
            .find(|ch: char| !ch.is_ascii_digit() && ch != '.' && ch != '_')
            .ok_or_else(|| bad("has a number without unit"))?;
        let number: String = left[..digits].chars().filter(|c| *c != '_').collect();
        let unit_len = left[digits..]
            .find(|ch: char| !ch.is_ascii_alphabetic())
            .unwrap_or(left.len() - digits);
        let unit = &left[digits..digits + unit_len];
        let scale: u64 = match unit.to_ascii_lowercase().as_str() {
            "us" => 1,
            "ms" => 1_000,
            "s" => 1_000_000,
            "m" => 60_000_000,
            "h" => 3_600_000_000,
            "d" => 86_400_000_000,
            _ => return Err(bad("has an unknown unit (d, h, m, s, ms, us)")),
        };
        let (whole, fraction) = number.split_once('.').unwrap_or((&number, ""));
        let mut value = whole
            .parse::<u64>()
            .ok()
            .and_then(|w| w.checked_mul(scale))
            .ok_or_else(|| bad("is too large or has no number"))?;
        let mut place = scale;
        for digit in fraction.bytes() {
            if !digit.is_ascii_digit() || place % 10 != 0 {
                return Err(bad("is finer than a microsecond"));
            }
            place /= 10;
            value = value
                .checked_add(u64::from(digit - b'0') * place)
                .ok_or_else(|| bad("is too large or has no number"))?;
        }
        total = total
            .checked_add(value)
            .ok_or_else(|| bad("is too large"))?;
        left = &left[digits + unit_len..];
    }
    Ok((total, head + len))
}
