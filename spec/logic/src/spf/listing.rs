//! Printed programs: what a printer, a scanner and a column layout did to the lines is undone, and each repair is noted. Which
//! repairs there are says the book, chapter "SAFE.SPF"; nothing else is guessed.

use super::Note;
use super::definitions::{self, Pieces};
use super::lines::Line;
use crate::fault::Fault;

/// The words that statements begin with.
const STATEMENTS: [&str; 13] = [
    "PROC",
    "DEF",
    "DEFINE",
    "MSG",
    "SIRELIN",
    "SIRELOUT",
    "SIRELTIME",
    "IDS",
    "ID",
    "M02",
    "M2",
    "M17",
    "M30",
];

/// A note of a repair, with the place that it was made at.
pub(crate) struct Repair {
    pub at: usize,
    pub rule: &'static str,
    pub text: String,
}

impl Repair {
    pub fn new(at: usize, rule: &'static str, text: impl Into<String>) -> Self {
        Self {
            at,
            rule,
            text: text.into(),
        }
    }

    pub fn noted(self, source: &str) -> Note {
        Note::new(source, self.at, self.rule, self.text)
    }
}

/// What a line is by its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    Blank,
    Comment,
    Header,
    Block,
    Other,
}

/// The blocks of a printed program, each in one line: S840D-LANG-701.
pub(crate) fn blocks(
    source: &str,
    repairs: &mut Vec<Repair>,
    faults: &mut Vec<Fault>,
) -> Vec<Line> {
    let mut lines = Line::all(source);
    revived(&mut lines, repairs);
    let lines = definitions::merged(lines, repairs);
    let lines = definitions::paired(lines, repairs, faults);
    let lines = ordered(lines, repairs);
    let mut blocks = joined(lines, repairs);
    for block in &mut blocks {
        clean(block, repairs);
    }
    blocks
}

/// The length of a block number with the blanks after it.
pub(crate) fn block_number(line: &Line, at: usize) -> usize {
    if !matches!(line.char(at), Some('N' | 'n')) {
        return 0;
    }
    let digits = line.run(at + 1, |c| c.is_ascii_digit()).len();
    match digits {
        0 => 0,
        _ => {
            1 + digits
                + line
                    .run(at + 1 + digits, char::is_whitespace)
                    .chars()
                    .count()
        }
    }
}

fn word(line: &Line, at: usize) -> String {
    line.run(at, |c| c.is_ascii_alphanumeric() || c == '_')
        .to_ascii_uppercase()
}

fn class(line: &Line) -> Class {
    let at = line.indent();
    match line.char(at) {
        None => Class::Blank,
        Some(';' | ':') => Class::Comment,
        Some('%') => Class::Header,
        _ if block_number(line, at) > 0 => Class::Block,
        _ if STATEMENTS.contains(&word(line, at).as_str()) => Class::Block,
        _ => Class::Other,
    }
}

/// Whether an action begins at a place: `IDS = 250 WHENEVER`.
fn is_action(line: &Line, at: usize) -> Option<u32> {
    let name = word(line, at);
    if name != "IDS" && name != "ID" {
        return None;
    }
    let blanks = |at: usize| at + line.run(at, char::is_whitespace).chars().count();
    let equals = blanks(at + name.len());
    if line.char(equals) != Some('=') {
        return None;
    }
    let digits = blanks(equals + 1);
    let number = line.run(digits, |c| c.is_ascii_digit());
    let next = word(line, blanks(digits + number.len()));
    let begins = ["DO", "WHEN", "WHENEVER", "EVERY", "FROM"].contains(&next.as_str());
    number.parse().ok().filter(|_| begins)
}

/// R8: a block behind a `;`, whose id nothing else has, is taken as a block.
fn revived(lines: &mut [Line], repairs: &mut Vec<Repair>) {
    let id = |line: &Line| {
        let at = line.indent();
        is_action(line, at + block_number(line, at))
    };
    let live: Vec<u32> = lines.iter().filter_map(id).collect();
    for line in lines {
        let at = line.indent();
        if line.char(at) != Some(';') {
            continue;
        }
        let mut inner = line.part(at + 1..line.len());
        let begin = inner.indent();
        let number = block_number(&inner, begin);
        if number == 0 {
            continue;
        }
        if let Some(id) = is_action(&inner, begin + number) {
            if !live.contains(&id) {
                let text = format!("the block behind `;` is taken: no other has the id {id}");
                repairs.push(Repair::new(line.start(), "R8", text));
                std::mem::swap(line, &mut inner);
            }
        }
    }
}

/// R9 outside definitions: the right half of a line, printed far indented before the block that ends with `=`.
fn ordered(lines: Vec<Line>, repairs: &mut Vec<Repair>) -> Vec<Line> {
    const COLUMN: usize = 16;
    let mut out: Vec<Line> = Vec::new();
    for line in lines {
        let open = class(&line) == Class::Block && line.code().trim_end().ends_with('=');
        let displaced = out
            .last()
            .is_some_and(|last| class(last) == Class::Other && last.indent() >= COLUMN);
        match (open && displaced, out.pop()) {
            (true, Some(last)) => {
                let text = "the right half of the block stands on the line before it";
                repairs.push(Repair::new(line.start(), "R9", text));
                out.push(line);
                out.push(last);
            }
            (_, last) => {
                out.extend(last);
                out.push(line);
            }
        }
    }
    out
}

/// R1, R6, R7, R8, R12: what belongs to one block comes on one line; comments that lost their `;` are left out.
fn joined(lines: Vec<Line>, repairs: &mut Vec<Repair>) -> Vec<Line> {
    let mut blocks: Vec<Line> = Vec::new();
    // Whether text that follows is a comment: after a comment, and at the beginning.
    let mut comment = true;
    for line in lines {
        let at = line.indent();
        match class(&line) {
            Class::Blank => {}
            Class::Comment => {
                if line.char(at) == Some(':') {
                    repairs.push(Repair::new(line.start(), "R8", "`:` is read as `;`"));
                }
                comment = true;
            }
            Class::Header | Class::Block => {
                comment = line.whole().contains(';');
                blocks.push(line.trimmed());
            }
            Class::Other => {
                let begin = (0..line.len()).find(|at| {
                    let before = at.checked_sub(1).and_then(|at| line.char(at));
                    !before.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_')
                        && is_action(&line, *at).is_some()
                });
                if let Some(begin) = begin {
                    let before = line.text(at..begin);
                    let text = format!("the block begins at `{}`", word(&line, begin));
                    let text = format!("{text}; `{}` is left out", shortened(&before));
                    repairs.push(Repair::new(line.start(), "R12", text));
                    comment = line.text(begin..line.len()).contains(';');
                    blocks.push(line.part(begin..line.len()).trimmed());
                    continue;
                }
                let text = line.text(at..line.len());
                match blocks.last_mut() {
                    Some(block) if !comment && !text.starts_with("--") => {
                        continued(block, &line, repairs);
                    }
                    _ => {
                        let text = format!("`{}` is read as a comment", shortened(&text));
                        repairs.push(Repair::new(line.start(), "R7", text));
                        comment = true;
                    }
                }
            }
        }
    }
    blocks
}

/// R1: the line goes on with the block before it; a hyphen at its end joins both without a blank (R6).
fn continued(block: &mut Line, line: &Line, repairs: &mut Vec<Repair>) {
    let line = line.trimmed();
    repairs.push(Repair::new(
        line.start(),
        "R1",
        "goes on with the block before it",
    ));
    let last = block.len().saturating_sub(1);
    let divided = block.char(last) == Some('-')
        && last
            .checked_sub(1)
            .and_then(|at| block.char(at))
            .is_some_and(char::is_alphanumeric);
    if divided {
        let text = "the hyphen at the end of the line is left out";
        repairs.push(Repair::new(block.end().start, "R6", text));
        block.replace(last, None);
    } else {
        block.append_text(" ");
    }
    block.append(&line);
}

/// R3: `\$` and `\_` without their backslash, `$A INSE` with its `_`. R2 in the header.
fn clean(block: &mut Line, repairs: &mut Vec<Repair>) {
    let mut at = 0;
    while let Some(c) = block.char(at) {
        if c == ';' {
            return;
        }
        if c == '\\' && matches!(block.char(at + 1), Some('$' | '_')) {
            let place = block.span(at..at + 1).start;
            repairs.push(Repair::new(place, "R3", "the backslash is left out"));
            block.replace(at, None);
        }
        let head = block.run(at + 1, |c| c.is_ascii_alphabetic());
        let gap = at + 1 + head.len();
        let prefix = ["A", "AC", "VA", "AA"].contains(&head.to_ascii_uppercase().as_str());
        let blank = block.char(gap).is_some_and(char::is_whitespace);
        let name = block.char(gap + 1).is_some_and(|c| c.is_ascii_alphabetic());
        if block.char(at) == Some('$') && prefix && blank && name {
            let text = format!("`${head}_` for `${head} `");
            repairs.push(Repair::new(block.span(at..gap).start, "R3", text));
            block.replace(gap, Some('_'));
        }
        at += 1;
    }
}

/// A text as it is quoted in a note.
pub(crate) fn shortened(text: &str) -> String {
    let text = text.trim();
    match text.char_indices().nth(40) {
        Some((cut, _)) => format!("{} ...", &text[..cut]),
        None => text.to_owned(),
    }
}

/// The parts of a definition, for [`definitions`].
pub(crate) fn pieces(line: &Line) -> Option<Pieces> {
    match class(line) {
        Class::Block | Class::Other => Pieces::of(line),
        Class::Blank | Class::Comment | Class::Header => None,
    }
}
