//! Definitions of printed programs: columns that a scanner took apart come together again (R9), names without their `_` (R2), a name
//! that runs into `AS` (R5), lines that were merged (R11).

use super::lines::Line;
use super::listing::{Repair, block_number, pieces, shortened};
use super::variable::is_name;
use crate::fault::Fault;

/// What one line holds of a definition.
pub(crate) struct Pieces {
    define: bool,
    name: Option<Line>,
    has_as: bool,
    operand: Option<Line>,
    /// Nothing but names: only among other definitions this is a part of one.
    bare: bool,
}

impl Pieces {
    /// The pieces of a line, if it is nothing but pieces of a definition.
    pub fn of(line: &Line) -> Option<Self> {
        let code = line.part(0..line.code().chars().count()).trimmed();
        let mut at = block_number(&code, 0);
        let word = |at: usize| code.run(at, |c| c.is_ascii_alphanumeric() || c == '_');
        let blanks = |at: usize| at + code.run(at, char::is_whitespace).chars().count();
        let define = word(at).eq_ignore_ascii_case("DEFINE");
        if define {
            at = blanks(at + "DEFINE".len());
        }
        let start = at;
        let mut end = at;
        let (mut has_as, mut operand) = (false, None);
        while at < code.len() {
            let found = word(at);
            if found.eq_ignore_ascii_case("AS") {
                has_as = true;
                let from = blanks(at + 2);
                operand = (from < code.len()).then(|| code.part(from..code.len()));
                break;
            }
            if matches!(code.char(at), Some('$' | '\\')) {
                operand = Some(code.part(at..code.len()));
                break;
            }
            if found.is_empty() {
                return None;
            }
            end = at + found.len();
            at = blanks(end);
        }
        let name = (end > start).then(|| code.part(start..end));
        let first = name.as_ref().map(Line::whole).unwrap_or_default();
        let begins = first.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        if let Some(operand) = &operand {
            let text = operand.whole();
            let text = text.trim_start_matches('\\');
            let variable = text.starts_with('$') && text.ends_with(']');
            if !variable && !text.chars().all(|c| c.is_ascii_digit() || c == '.') {
                return None;
            }
        }
        let bare = !define && !has_as && operand.is_none();
        let some = define || has_as || operand.is_some() || (bare && begins);
        (some && (name.is_none() || begins)).then_some(Self {
            define,
            name,
            has_as,
            operand,
            bare,
        })
    }

    const fn is_whole(&self) -> bool {
        self.define && self.name.is_some() && self.has_as && self.operand.is_some()
    }
}

/// R11: three lines of the brake example, which the print made of four.
const MERGED: [&str; 3] = [
    "DEFINE P_BREMSE_X1 AS $A_INST[1]",
    "DEFINE NOT UT:",
    "AS $A_OUTSE[1]",
];

/// The brake example with the definitions that it had.
pub(crate) fn merged(lines: Vec<Line>, repairs: &mut Vec<Repair>) -> Vec<Line> {
    let plain = |line: &Line| line.whole().replace('\\', "").trim().to_owned();
    let found = lines
        .windows(MERGED.len())
        .position(|group| group.iter().map(plain).eq(MERGED));
    let Some(at) = found else {
        return lines;
    };
    let mut out = lines;
    let mut put = |k: usize, text: &str| {
        let line = &mut out[at + k];
        let mut new = Line::default();
        new.append_at(text, line.start());
        *line = new;
    };
    put(0, "DEFINE STOP_A_B_aktiv AS $A_INSI[1]");
    put(1, "DEFINE P_BREMSE_X1 AS $A_OUTSE[1]");
    put(2, "");
    let text = "these lines are STOP_A_B_aktiv for `$A_INSI[1]` and P_BREMSE_X1 for `$A_OUTSE[1]`";
    repairs.push(Repair::new(out[at].start(), "R11", text));
    out
}

/// R9: names and variables of neighbouring lines are paired in their order.
pub(crate) fn paired(
    lines: Vec<Line>,
    repairs: &mut Vec<Repair>,
    faults: &mut Vec<Fault>,
) -> Vec<Line> {
    let found: Vec<Option<Pieces>> = lines.iter().map(pieces).collect();
    let part = |k: usize| found.get(k).and_then(Option::as_ref);
    let sure = |k: usize| part(k).is_some_and(|p| !p.bare);
    let mut out = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        if !sure(at) {
            out.push(lines[at].clone());
            at += 1;
            continue;
        }
        // A line of mere names belongs to the definitions if it stands among them.
        let mut end = at;
        while sure(end) || (end > at && part(end).is_some() && sure(end + 1)) {
            end += 1;
        }
        // Without DEFINE it is the end of a block.
        if !(at..end).any(|k| part(k).is_some_and(|p| p.define)) {
            out.extend_from_slice(&lines[at..end]);
            at = end;
            continue;
        }
        out.extend(region(&lines[at..end], &found[at..end], repairs, faults));
        // After a definition nothing can go on: what follows is the rest of its comment.
        out.push(comment(&lines[end - 1]));
        at = end;
    }
    out
}

/// An empty comment at the end of a line.
fn comment(line: &Line) -> Line {
    let mut out = Line::default();
    out.append_at(";", line.end().start);
    out
}

fn region(
    lines: &[Line],
    found: &[Option<Pieces>],
    repairs: &mut Vec<Repair>,
    faults: &mut Vec<Fault>,
) -> Vec<Line> {
    let (mut names, mut operands, mut out) = (Vec::new(), Vec::new(), Vec::new());
    for (line, pieces) in lines.iter().zip(found) {
        let Some(pieces) = pieces else { continue };
        match (&pieces.name, &pieces.operand) {
            (Some(name), Some(operand)) => {
                if !pieces.is_whole() && pieces.has_as {
                    repairs.push(Repair::new(line.start(), "R9", "`DEFINE` is added"));
                }
                out.push(definition(&named(name, pieces.has_as, repairs), operand));
            }
            (name, operand) => {
                names.extend(name.as_ref().map(|name| named(name, true, repairs)));
                operands.extend(operand.clone());
            }
        }
    }
    if names.len() != operands.len() {
        let at = lines.first().map_or(0..0, |line| line.span(0..line.len()));
        let message = format!(
            "the definitions from here on have {} names and {} variables in lines of their own",
            names.len(),
            operands.len()
        );
        let help = "write each on one line: `DEFINE NAME AS $A_INSE[1]`";
        faults.push(Fault::new(&at, message, help));
    }
    for (name, operand) in names.iter().zip(&operands) {
        let text = format!("`{}` is `{}`", name.whole(), shortened(&operand.whole()));
        repairs.push(Repair::new(name.start(), "R9", text));
        out.push(definition(name, operand));
    }
    out
}

/// The name that is defined, in one word.
fn named(printed: &Line, has_as: bool, repairs: &mut Vec<Repair>) -> Line {
    let mut name = printed.clone();
    for at in 0..name.len() {
        if name.char(at).is_some_and(char::is_whitespace) {
            name.replace(at, Some('_'));
        }
    }
    if name.whole() != printed.whole() {
        let text = format!("`{}` for `{}`", name.whole(), printed.whole());
        repairs.push(Repair::new(printed.start(), "R2", text));
    }
    let text = name.whole();
    if let Some(rest) = text
        .strip_suffix("AS")
        .filter(|rest| !has_as && is_name(rest))
    {
        let note = format!("`{rest} AS` for `{text}`");
        repairs.push(Repair::new(printed.start(), "R5", note));
        name = name.part(0..rest.len());
    }
    name
}

/// `DEFINE NAME AS OPERAND`, each with the place that it has.
fn definition(name: &Line, operand: &Line) -> Line {
    let mut line = Line::default();
    line.append_at("DEFINE ", name.start());
    line.append(name);
    line.append_text(" AS ");
    line.append(operand);
    line
}
