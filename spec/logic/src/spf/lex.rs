//! Tokens of one block of a program, without its comment.

use super::lines::Line;
use super::variable::is_name;
use crate::fault::{Checked, Fault, Span};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Token {
    /// A name or reserved word as it is written.
    Word(String),
    /// The name of a system variable, without `$`.
    System(String),
    /// A number in millionths, and whether it has a decimal point.
    Number(i64, bool),
    /// A text, without its quotation marks.
    Text(String),
    Sym(&'static str),
    /// What belongs to no block; printed texts have it in comments that lost their `;`.
    Junk(String),
    End,
}

impl Token {
    pub fn describe(&self) -> String {
        match self {
            Token::Word(word) | Token::Junk(word) => format!("`{word}`"),
            Token::System(name) => format!("`${name}`"),
            Token::Number(millionths, real) => format!("`{}`", decimal(*millionths, *real)),
            Token::Text(text) => format!("`\"{text}\"`"),
            Token::Sym(symbol) => format!("`{symbol}`"),
            Token::End => "the end of the line".to_owned(),
        }
    }
}

/// A number as it is written.
pub(crate) fn decimal(millionths: i64, real: bool) -> String {
    let sign = if millionths < 0 { "-" } else { "" };
    let (whole, rest) = (millionths.abs() / MILLION, millionths.abs() % MILLION);
    match (rest, real) {
        (0, false) => format!("{sign}{whole}"),
        (0, true) => format!("{sign}{whole}.0"),
        _ => format!(
            "{sign}{whole}.{}",
            format!("{rest:06}").trim_end_matches('0')
        ),
    }
}

/// Numbers are counted in millionths.
pub(crate) const MILLION: i64 = 1_000_000;

// Longest first.
const SYMBOLS: [&str; 13] = [
    "==", "<>", ">=", "<=", ">", "<", "=", "(", ")", "[", "]", ",", "-",
];

/// The tokens of a block; the last one is [`Token::End`]. `printed` takes what only printed texts have.
///
/// # Errors
/// What is no token, in strict texts.
pub(crate) fn tokens(line: &Line, printed: bool) -> Checked<Vec<(Token, Span)>> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(c) = line.char(at) {
        if c.is_whitespace() {
            at += 1;
            continue;
        }
        if c == ';' || (printed && c == '/' && line.char(at + 1) == Some('/')) {
            break;
        }
        let (token, length) = token(line, at, c, printed)?;
        out.push((token, line.span(at..at + length)));
        at += length;
    }
    out.push((Token::End, line.end()));
    Ok(out)
}

fn token(line: &Line, at: usize, c: char, printed: bool) -> Checked<(Token, usize)> {
    let word = line.run(at, |c| c.is_ascii_alphanumeric() || c == '_');
    if c.is_ascii_digit() {
        return number(line, at, &word, printed);
    }
    if is_name(&word) {
        let length = word.len();
        return Ok((Token::Word(word), length));
    }
    if c == '$' {
        let name = line.run(at + 1, |c| c.is_ascii_alphanumeric() || c == '_');
        if is_name(&name) {
            let length = name.len() + 1;
            return Ok((Token::System(name), length));
        }
    }
    if c == '"' {
        let text = line.run(at + 1, |c| c != '"');
        let length = text.chars().count();
        if line.char(at + 1 + length).is_some() {
            return Ok((Token::Text(text), length + 2));
        }
        let span = line.span(at..at + 1 + length);
        let fault = Fault::new(
            &span,
            "this text is not closed",
            "end it with `\"` on the same line",
        );
        return if printed {
            Ok((Token::Junk(text), 1 + length))
        } else {
            Err(fault)
        };
    }
    let symbol = SYMBOLS.iter().find(|symbol| {
        let mut letters = symbol.chars().enumerate();
        letters.all(|(k, c)| line.char(at + k) == Some(c))
    });
    if let Some(symbol) = symbol {
        return Ok((Token::Sym(symbol), symbol.len()));
    }
    if printed {
        return Ok((Token::Junk(c.to_string()), 1));
    }
    let span = line.span(at..at + 1);
    Err(match c {
        '+' | '*' | '/' => Fault::new(
            &span,
            format!("`{c}`: the safe logic does not calculate"),
            "compare with a number, and combine with AND, OR, XOR, NOT; a comment begins with `;`",
        ),
        '\\' => Fault::new(
            &span,
            "a backslash has no meaning here",
            "leave it out; a program as a manual prints it is read as a listing",
        ),
        '$' => Fault::new(
            &span,
            "the name of a system variable is missing after `$`",
            "write it without a blank: `$A_INSE[1]`",
        ),
        _ => Fault::new(
            &span,
            format!("`{c}` has no meaning here"),
            "use names, system variables such as `$A_INSE[1]`, numbers, = == <> < > <= >= ( ) ,; a comment begins with `;`",
        ),
    })
}

/// `0`, `08`, `1.0`, `0.4`.
fn number(line: &Line, at: usize, word: &str, printed: bool) -> Checked<(Token, usize)> {
    let span = |length: usize| line.span(at..at + length);
    if !word.chars().all(|c| c.is_ascii_digit()) {
        if printed {
            return Ok((Token::Word(word.to_owned()), word.len()));
        }
        return Err(Fault::new(
            &span(word.len()),
            format!("`{word}` is neither a number nor a name"),
            "a name begins with a letter or `_`; numbers are written 5 or 0.4",
        ));
    }
    let mut length = word.len();
    let mut fraction = String::new();
    let mut real = false;
    if line.char(at + length) == Some('.') {
        fraction = line.run(at + length + 1, |c| c.is_ascii_digit());
        real = true;
        length += 1 + fraction.len();
    }
    let value = word
        .parse::<i64>()
        .ok()
        .filter(|v| *v <= i64::from(i32::MAX));
    let fine = fraction.trim_end_matches('0').len() <= 6;
    let (Some(value), true) = (value, fine) else {
        let written = line.text(at..at + length);
        let (message, help) = match fine {
            true => ("is too large", "numbers go up to 2147483647"),
            false => (
                "is finer than a microsecond",
                "write at most six digits after the point",
            ),
        };
        return Err(Fault::new(
            &span(length),
            format!("`{written}` {message}"),
            help,
        ));
    };
    let mut millionths = value * MILLION;
    let mut unit = MILLION;
    for digit in fraction.bytes().take(6) {
        unit /= 10;
        millionths += i64::from(digit - b'0') * unit;
    }
    Ok((Token::Number(millionths, real), length))
}
