//! Lines of a text whose letters keep their places, also where a repair joins what stands apart.

use std::ops::Range;

use crate::fault::Span;

/// Letters with their places in the file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Line {
    chars: Vec<(char, usize)>,
}

impl Line {
    /// The lines of a text as they stand in it.
    pub fn all(text: &str) -> Vec<Line> {
        let mut lines = vec![Line::default()];
        for (at, c) in text.char_indices() {
            match c {
                '\n' => lines.push(Line::default()),
                '\r' | '\u{feff}' => {}
                _ => lines
                    .last_mut()
                    .into_iter()
                    .for_each(|line| line.chars.push((c, at))),
            }
        }
        lines
    }

    pub fn char(&self, at: usize) -> Option<char> {
        self.chars.get(at).map(|(c, _)| *c)
    }

    pub fn len(&self) -> usize {
        self.chars.len()
    }

    pub fn is_blank(&self) -> bool {
        self.chars.iter().all(|(c, _)| c.is_whitespace())
    }

    /// The letters from a place on for which `of` holds.
    pub fn run(&self, at: usize, of: impl Fn(char) -> bool) -> String {
        let rest = self.chars.get(at..).unwrap_or_default();
        rest.iter()
            .map(|(c, _)| *c)
            .take_while(|c| of(*c))
            .collect()
    }

    pub fn text(&self, range: Range<usize>) -> String {
        let part = self.chars.get(range).unwrap_or_default();
        part.iter().map(|(c, _)| *c).collect()
    }

    /// All of it.
    pub fn whole(&self) -> String {
        self.text(0..self.len())
    }

    /// Its letters before a comment.
    pub fn code(&self) -> String {
        let text = self.whole();
        text.split(';').next().unwrap_or_default().to_owned()
    }

    /// Where a piece of it stands in the file.
    pub fn span(&self, range: Range<usize>) -> Span {
        let piece = self.chars.get(range.clone()).unwrap_or_default();
        match (piece.first(), piece.last()) {
            (Some((_, start)), Some((c, end))) => *start..end + c.len_utf8(),
            _ => self.end(),
        }
    }

    /// The place behind its last letter.
    pub fn end(&self) -> Span {
        let end = self.chars.last().map_or(0, |(c, at)| at + c.len_utf8());
        end..end
    }

    /// The place of its first letter that is no blank.
    pub fn start(&self) -> usize {
        let first = self.chars.iter().find(|(c, _)| !c.is_whitespace());
        first.or(self.chars.first()).map_or(0, |(_, at)| *at)
    }

    /// How many blanks stand before it.
    pub fn indent(&self) -> usize {
        self.chars
            .iter()
            .take_while(|(c, _)| c.is_whitespace())
            .count()
    }

    pub fn part(&self, range: Range<usize>) -> Line {
        Line {
            chars: self.chars.get(range).unwrap_or_default().to_vec(),
        }
    }

    /// Appends letters that stand elsewhere.
    pub fn append(&mut self, other: &Line) {
        self.chars.extend(&other.chars);
    }

    /// Appends letters that stand nowhere: their place is that of what comes before them.
    pub fn append_text(&mut self, text: &str) {
        let at = self.chars.last().map_or(0, |(_, at)| *at);
        self.chars.extend(text.chars().map(|c| (c, at)));
    }

    /// Appends letters that all have one place.
    pub fn append_at(&mut self, text: &str, at: usize) {
        self.chars.extend(text.chars().map(|c| (c, at)));
    }

    /// Without blanks at its ends.
    pub fn trimmed(&self) -> Line {
        let start = self.indent();
        let blank = |(c, _): &&(char, usize)| c.is_whitespace();
        let after = self.chars.iter().rev().take_while(blank).count();
        self.part(start..self.len().saturating_sub(after).max(start))
    }

    /// Puts a letter in the place of another one, or takes it out.
    pub fn replace(&mut self, at: usize, by: Option<char>) {
        match (by, self.chars.get_mut(at)) {
            (Some(c), Some(letter)) => letter.0 = c,
            (None, Some(_)) => {
                self.chars.remove(at);
            }
            (_, None) => {}
        }
    }
}
