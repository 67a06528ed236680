//! Colour: on a terminal only, and as NO_COLOR, CLICOLOR and CLICOLOR_FORCE say.
//!
//! Reports are plain text. Here, on their way to a terminal, the words of a verdict are painted: in the headline, at the
//! head of a counterexample and in the first column of the table of properties.

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};

/// Whether text for stdout is painted.
pub fn on_stdout() -> bool {
    AutoStream::choice(&std::io::stdout()) != ColorChoice::Never
}

/// Whether text for stderr is painted.
pub fn on_stderr() -> bool {
    AutoStream::choice(&std::io::stderr()) != ColorChoice::Never
}

const GOOD: Style = AnsiColor::Green.on_default().bold();
const BAD: Style = AnsiColor::Red.on_default().bold();
const OPEN: Style = AnsiColor::Yellow.on_default().bold();

/// Verdicts in the headline of a report, after the name and a colon.
const HEADS: [(&str, Style); 8] = [
    ("ALL PROPERTIES HOLD", GOOD),
    ("ALL GUARANTEES HOLD", GOOD),
    ("NO GUARANTEE IS ASKED", OPEN),
    ("NOT SHOWN", OPEN),
    ("CONFIRMED", GOOD),
    ("plausible", GOOD),
    ("VIOLATED", BAD),
    ("INCONCLUSIVE", OPEN),
];

/// Words at the head of a line, after its indent and a number.
const WORDS: [(&str, Style); 17] = [
    ("VIOLATED", BAD),
    ("DIVERGENCE", BAD),
    ("DIVERGENCES", BAD),
    ("NO DIVERGENCE", GOOD),
    ("INCONCLUSIVE", OPEN),
    ("holds", GOOD),
    ("reached", GOOD),
    ("violated", BAD),
    ("unreachable", BAD),
    ("MISSING", BAD),
    ("excluded", OPEN),
    ("vacuous", OPEN),
    ("inconclusive", OPEN),
    ("not certified", OPEN),
    ("error:", BAD),
    ("warning:", OPEN),
    ("rejected:", BAD),
];

/// The text with the words of its verdicts painted.
pub fn paint(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 64);
    for line in text.split_inclusive('\n') {
        match verdict(line) {
            Some((range, style)) => {
                let (before, rest) = line.split_at(range.start);
                let (word, after) = rest.split_at(range.len());
                out.push_str(&format!("{before}{style}{word}{style:#}{after}"));
            }
            None => out.push_str(line),
        }
    }
    out
}

/// Where the verdict of a line stands, if it tells one.
fn verdict(line: &str) -> Option<(std::ops::Range<usize>, Style)> {
    let at = |start: usize, words: &[(&str, Style)]| {
        let rest = &line[start..];
        let ends = |word: &str| {
            let next = rest[word.len()..].chars().next();
            word.ends_with(':') || next.is_none_or(|c| !c.is_alphanumeric())
        };
        let found = words
            .iter()
            .find(|(word, _)| rest.starts_with(word) && ends(word));
        found.map(|(word, style)| (start..start + word.len(), *style))
    };
    let indent = line.len() - line.trim_start_matches(' ').len();
    let number = |c: char| c.is_ascii_digit() || c == ' ';
    let start = line.len() - line.trim_start_matches(number).len();
    // Deeper lines are those of diagrams and remarks, where such a word is none of ours.
    if indent > 2 {
        return None;
    }
    at(start, &WORDS).or_else(|| {
        let colon = line.find(": ").filter(|_| indent == 0)?;
        at(colon + 2, &HEADS)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: &str = "\u{1b}[1m\u{1b}[31m";
    const GREEN: &str = "\u{1b}[1m\u{1b}[32m";
    const OFF: &str = "\u{1b}[0m";

    #[test]
    fn verdicts_are_painted_where_they_stand() {
        assert_eq!(paint("m: VIOLATED\n"), format!("m: {RED}VIOLATED{OFF}\n"));
        assert_eq!(
            paint("m: ALL PROPERTIES HOLD\n"),
            format!("m: {GREEN}ALL PROPERTIES HOLD{OFF}\n")
        );
        assert_eq!(
            paint("2 DIVERGENCES (all)\n"),
            format!("2 {RED}DIVERGENCES{OFF} (all)\n")
        );
        assert_eq!(
            paint("  holds  P-1  it holds\n"),
            format!("  {GREEN}holds{OFF}  P-1  it holds\n")
        );
    }

    #[test]
    fn other_words_stay_as_they_are() {
        for line in [
            "  holdsome\n",
            "    holds a lane\n",
            "the motor: stands, holds\n",
            "",
        ] {
            assert_eq!(paint(line), line);
        }
    }
}
