//! What a diagnostic shows of its source: a few lines, and of a long line the part around the marked place.

use std::ops::Range;

use miette::{MietteError, MietteSpanContents, NamedSource, SourceCode, SourceSpan, SpanContents};

/// Lines shown before and after the marked ones, and the most marked ones.
const AROUND: usize = 2;
const MARKED: usize = 8;
/// A line of more bytes is cut, to so many before and after the place.
const LONG: usize = 160;
const BEFORE: usize = 60;
const AFTER: usize = 80;
const CUT: &str = "…";

/// Some lines of a source under their own numbers. The lines before them are there, empty.
#[derive(Debug, Clone)]
pub(crate) struct Excerpt {
    text: NamedSource<String>,
    /// The marked place in it.
    pub(crate) span: Range<usize>,
    /// Bytes that were cut in front of the marked place in its line.
    cut: usize,
}

/// The greatest place between two characters that is not beyond `at`.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl Excerpt {
    pub(crate) fn new(file: &str, source: &str, span: &Range<usize>) -> Self {
        let start = floor(source, span.start);
        let end = floor(source, span.end).max(start);
        let first = source[..start].matches('\n').count();
        let last = (first + source[start..end].matches('\n').count()).min(first + MARKED - 1);
        let (mut text, mut at) = (String::new(), 0);
        let (mut new, mut cut) = (0..0, 0);
        for (number, line) in source.split_inclusive('\n').enumerate() {
            let range = at..at + line.len();
            at = range.end;
            if number + AROUND < first {
                text.push('\n');
                continue;
            }
            if number > last + AROUND {
                break;
            }
            let line = line.trim_end_matches(['\n', '\r']);
            // The place that must be seen: where the mark begins, else where the line does.
            let place = match number == first {
                true => start - range.start,
                false => 0,
            };
            let window = match line.len() > LONG {
                true => {
                    let start = floor(line, place.saturating_sub(BEFORE));
                    // A cut saves more than its sign takes.
                    let start = if start > CUT.len() { start } else { 0 };
                    start..floor(line, place + AFTER)
                }
                false => 0..line.len(),
            };
            let before = text.len();
            if window.start > 0 {
                text.push_str(CUT);
            }
            let shown = text.len();
            text.push_str(&line[window.clone()]);
            let moved = |at: usize| {
                let inside = at.saturating_sub(range.start + window.start);
                shown + inside.min(window.len())
            };
            if number == first {
                new = moved(start)..moved(start);
                cut = window.start - (shown - before);
            }
            if (first..=last).contains(&number) {
                new.end = moved(end);
            }
            if window.end < line.len() {
                text.push_str(CUT);
            }
            text.push('\n');
        }
        if first > 0 && start == source.len() && source.ends_with('\n') {
            // The mark stands behind the last line.
            new = text.len()..text.len();
        }
        Self {
            text: NamedSource::new(file, text),
            span: new,
            cut,
        }
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, before, after)?;
        // What begins in the marked place has the column of the whole line.
        let cut = match found.span().offset() == self.span.start {
            true => self.cut,
            false => 0,
        };
        let contents = MietteSpanContents::new_named(
            found.name().unwrap_or_default().to_owned(),
            found.data(),
            *found.span(),
            found.line(),
            found.column() + cut,
            found.line_count(),
        );
        Ok(Box::new(contents))
    }
}

/// A text of a diagnostic, with its middle left out where it is longer than anybody reads.
pub(crate) fn shortened(text: String) -> String {
    const MOST: usize = 1200;
    const START: usize = 800;
    const END: usize = 300;
    if text.len() <= MOST {
        return text;
    }
    let (start, end) = (floor(&text, START), floor(&text, text.len() - END));
    let left_out = text.len() - START - END;
    format!(
        "{} {CUT} ({left_out} bytes left out) {CUT} {}",
        &text[..start],
        &text[end..]
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is shown at the mark, and the line and column told for it.
    fn shown(source: &str, span: Range<usize>) -> (String, usize, usize, usize) {
        let excerpt = Excerpt::new("f", source, &span);
        let label = SourceSpan::from((excerpt.span.start, excerpt.span.len()));
        let at = excerpt.read_span(&label, 0, 0).expect("in the text");
        let whole = excerpt.text.inner().clone();
        let marked = whole[excerpt.span.clone()].to_owned();
        (marked, at.line(), at.column(), whole.len())
    }

    #[test]
    fn a_mark_keeps_its_text_line_and_column() {
        for before in [0, 3, 59, 60, 61, 100, 5_000, 100_000] {
            for after in [0, 10, 200, 100_000] {
                let line = format!("{}MARK{}", "a".repeat(before), "b".repeat(after));
                let source = format!("one\ntwo\nthree\n{line}\nfive\n{line}\nseven");
                let start = 14 + before;
                let (marked, row, column, size) = shown(&source, start..start + 4);
                assert_eq!((marked.as_str(), row, column), ("MARK", 3, before));
                assert!(size < 1000, "{size}");
            }
        }
        // Characters of several bytes, a mark that is too long, one behind the end.
        let source = "\u{e9}".repeat(10_000);
        let (marked, row, column, size) = shown(&source, 5_000..15_000);
        assert!(marked.len() <= AFTER && !marked.is_empty() && size < 400);
        assert_eq!((row, column), (0, 5_000));
        for (source, span) in [("", 0..0), ("a\n", 2..2), ("a", 1..9), ("a\nb", 9..12)] {
            shown(source, span);
        }
        let many = "line\n".repeat(100_000);
        let (_, row, _, size) = shown(&many, 250_000..500_000);
        assert_eq!(row, 50_000);
        assert!(size < 51_000);
        let text = shortened("y".repeat(400_000));
        assert!(text.len() < 1_300 && text.contains("bytes left out"));
    }
}
