//! Timing diagrams as SVG.

use std::fmt::Write;
use std::ops::Range;

use super::columns::Column;
use super::panel::{self, Scale};
use super::{Diagram, Lane};
use crate::escape::{cut, html, lines};
use crate::number::millis;
use crate::svg::{path, picture, rect, text};

/// Pixels in which the columns of a row have room.
const ROOM: i32 = 780;
/// Columns that are drawn at most; a longer run is cut in its middle.
const MOST_COLUMNS: usize = 1500;
/// Width of a character of a lane in tenths of a pixel.
const LETTER: i32 = 67;
/// Height of a lane.
const LANE: i32 = 24;
/// Height of a signal inside its lane.
const SIGNAL: i32 = 16;
/// Height of a line of words.
const LINE: i32 = 15;

/// Width of words in pixels.
fn width_of(words: &str) -> i32 {
    let letters = i32::try_from(words.chars().count()).unwrap_or(1000);
    letters.min(1000) * LETTER / 10 + 1
}

/// Width that a gathered column needs for its number; 0 for another one.
fn gathered_width(column: Column) -> i32 {
    match column {
        Column::Cycle(_) => 0,
        Column::Idle { count, .. } | Column::Cut { count, .. } => {
            width_of(&format!("+{count}")) + 8
        }
    }
}

/// Columns side by side, with the left edge of each and the right edge of the last.
pub(super) struct Row<'a> {
    pub(super) columns: &'a [Column],
    pub(super) edges: Vec<i32>,
}

impl Row<'_> {
    pub(super) fn left(&self) -> i32 {
        self.edges[0]
    }

    pub(super) fn right(&self) -> i32 {
        self.edges[self.edges.len() - 1]
    }

    pub(super) fn middle(&self, n: usize) -> i32 {
        (self.edges[n] + self.edges[n + 1]) / 2
    }
}

impl Diagram {
    /// The diagram as SVG that stands alone.
    pub fn svg(&self) -> String {
        self.draw(true)
    }

    /// The diagram as SVG, with or without the rules that it needs to stand alone.
    pub(crate) fn draw(&self, standalone: bool) -> String {
        let least = if self.panels.is_empty() { 3 } else { 12 };
        let columns = self.drawn(least, MOST_COLUMNS);
        let widths = self.widths(&columns);
        let lanes = self.lanes.iter().map(|l| width_of(&l.name) + 12);
        let curves = self.panels.iter().flat_map(|p| &p.curves);
        let curves = curves.map(|c| width_of(&c.name) + 30 + panel::NUMBERS);
        let names = self.panels.iter();
        let names = names.map(|p| width_of(&p.heading()) + 6 + panel::NUMBERS);
        let gutter = lanes.chain(curves).chain(names).max().unwrap_or(0);
        let gutter = gutter.clamp(70, 250);
        let scales: Vec<Option<Scale>> = self.panels.iter().map(Scale::of).collect();
        let mut body = String::new();
        let mut y = 6;
        if !self.title.is_empty() {
            for words in lines(&self.title, 110) {
                y += LINE + 2;
                text(&mut body, 4, y, "title", &words);
            }
            y += 8;
        }
        let mut right = gutter + 240;
        for part in rows(&widths) {
            let mut edges = vec![gutter];
            for width in &widths[part.clone()] {
                edges.push(edges[edges.len() - 1] + width);
            }
            let row = Row {
                columns: &columns[part],
                edges,
            };
            right = right.max(row.right());
            y = self.row(&mut body, &row, &scales, (gutter, &mut right), y) + 10;
        }
        if let Some(k) = self.loop_start {
            y += LINE;
            let words = format!("↻ from cycle {k} on the run repeats for ever");
            text(&mut body, 4, y, "notetext", &words);
        }
        let name = match self.title.as_str() {
            "" => "timing diagram",
            title => title,
        };
        picture((right + 12, y + 8), name, standalone, &body)
    }

    /// The width of each column: wide enough for the words in it if that is not much.
    fn widths(&self, columns: &[Column]) -> Vec<i32> {
        let count = columns.iter().filter(|c| matches!(c, Column::Cycle(_)));
        let count = i32::try_from(count.count()).unwrap_or(i32::MAX).max(1);
        let gathered: i32 = columns.iter().map(|c| gathered_width(*c)).sum();
        // A curve is read as a whole, so that its columns may be narrow: one row, if the run is not too long.
        let base = if self.panels.is_empty() {
            // Every column has its time, if all of them fit one row then.
            let last = u64::try_from(self.columns).unwrap_or(u64::MAX);
            let time = self.cycle.map(|us| millis(us.saturating_mul(last)));
            let timed = time.map_or(0, |time| width_of(&time) + 10);
            if timed.saturating_mul(count) <= ROOM {
                timed.max(26)
            } else {
                26
            }
        } else {
            ((ROOM - gathered) / count).clamp(2, 26)
        };
        let mut widths: Vec<i32> = columns
            .iter()
            .map(|c| match c {
                Column::Cycle(_) => base,
                gathered => base.max(gathered_width(*gathered)),
            })
            .collect();
        // Beside curves the time is drawn to scale: words that do not fit are cut there.
        let even = !self.panels.is_empty();
        for lane in self.lanes.iter().filter(|l| !l.level && !even) {
            for part in lane.segments(columns) {
                let Some(value) = lane.at(columns[part.start].first()) else {
                    continue;
                };
                let need = (width_of(value) + 12).min(110);
                let has: i32 = widths[part.clone()].iter().sum();
                if need > has {
                    // Only the first column grows, so that a change stays where it is.
                    widths[part.start] += need - has;
                }
            }
        }
        widths
    }

    /// Draws a row from `top` on and tells where it ends.
    fn row(
        &self,
        out: &mut String,
        row: &Row,
        scales: &[Option<Scale>],
        (gutter, right): (i32, &mut i32),
        top: i32,
    ) -> i32 {
        let head = if self.cycle.is_some() { 2 } else { 1 };
        let top_of_signals = top + head * LINE + 6;
        let groups = {
            let mut names: Vec<&str> = self.lanes.iter().map(|l| l.group.as_str()).collect();
            names.dedup();
            i32::try_from(names.iter().filter(|n| !n.is_empty()).count()).unwrap_or(0)
        };
        let panels = i32::try_from(self.panels.len()).unwrap_or(0);
        let lanes = i32::try_from(self.lanes.len()).unwrap_or(0);
        let bottom =
            top_of_signals + panels * panel::HEIGHT + groups * (LINE + 4) + lanes * LANE + 2;
        self.grounds(out, row, top_of_signals, bottom);
        self.axis(out, row, top, top_of_signals, bottom);
        let mut y = top_of_signals;
        for (panel, scale) in self.panels.iter().zip(scales) {
            panel.draw(out, row, scale.as_ref(), y);
            y += panel::HEIGHT;
        }
        let mut group = "";
        for lane in &self.lanes {
            if lane.group != group {
                group = &lane.group;
                if !group.is_empty() {
                    y += LINE + 4;
                    text(out, 4, y - 5, "head", group);
                }
            }
            let most = usize::try_from((gutter - 12) * 10 / LETTER).unwrap_or(8);
            let _ = writeln!(
                out,
                "<text x=\"4\" y=\"{}\">{}<title>{}</title></text>",
                y + 15,
                html(&cut(&lane.name, most)),
                html(&lane.name)
            );
            if lane.level {
                lane.level(out, row, y + 4);
            } else {
                lane.values(out, row, y + 4);
            }
            y += LANE;
        }
        self.remarks(out, row, (top_of_signals, bottom), right)
    }

    /// Folded columns and marked ones stand on a ground of their own.
    fn grounds(&self, out: &mut String, row: &Row, top: i32, bottom: i32) {
        for (n, column) in row.columns.iter().enumerate() {
            let (left, right) = (row.edges[n], row.edges[n + 1]);
            let size = (right - left, bottom - top);
            if !matches!(column, Column::Cycle(_)) {
                rect(out, (left, top), size, "fold");
            }
            let mut marks = self.marks.iter().filter(|m| column.holds(m.column));
            match marks.clone().any(|m| m.fault) {
                true => rect(out, (left, top), size, "fault"),
                false if marks.next().is_some() => rect(out, (left, top), size, "note"),
                false => {}
            }
        }
    }

    /// Cycle numbers, their times, and lines between the columns.
    fn axis(&self, out: &mut String, row: &Row, top: i32, first: i32, bottom: i32) {
        text(out, 4, top + LINE - 3, "dim", "cycle");
        if self.cycle.is_some() {
            text(out, 4, top + 2 * LINE - 3, "dim", "time");
        }
        let mut grid = String::new();
        let mut free = (row.left(), row.left());
        for (n, column) in row.columns.iter().enumerate() {
            let (left, right) = (row.edges[n], row.edges[n + 1]);
            if right - left >= 14 {
                let _ = write!(grid, "M{left} {first}V{bottom}");
            }
            let (name, time) = match column {
                Column::Cycle(k) => {
                    let k = *k;
                    let again = if self.loop_start == Some(k) {
                        "↻"
                    } else {
                        ""
                    };
                    let cycles = u64::try_from(k).unwrap_or(u64::MAX);
                    let time = self.cycle.map(|us| millis(us.saturating_mul(cycles)));
                    (format!("{k}{again}"), time)
                }
                Column::Idle { count, .. } | Column::Cut { count, .. } => {
                    (format!("+{count}"), None)
                }
            };
            let (own, below) = (width_of(&name), time.as_deref().map_or(0, width_of));
            let length = own.max(below);
            let middle = ((left + right) / 2).max(row.left() + length / 2);
            if middle - own / 2 < free.0 || below > 0 && middle - below / 2 < free.1 {
                continue;
            }
            free.0 = middle + own / 2 + 8;
            if below > 0 {
                free.1 = middle + below / 2 + 8;
            }
            if right - left < 14 {
                let _ = write!(grid, "M{middle} {first}V{bottom}");
            }
            text(out, middle, top + LINE - 3, "mid", &name);
            if let Some(time) = time {
                text(out, middle, top + 2 * LINE - 3, "mid dim", &time);
            }
        }
        let _ = write!(
            grid,
            "M{} {first}V{bottom}M{} {first}H{}",
            row.right(),
            row.left(),
            row.right()
        );
        path(out, "grid", &grid);
    }

    /// Lines and words of the remarks in this row, below it; tells where they end.
    fn remarks(
        &self,
        out: &mut String,
        row: &Row,
        (top, bottom): (i32, i32),
        right: &mut i32,
    ) -> i32 {
        let mut y = bottom;
        let starts = |c: &Column| Some(c.first()) == self.loop_start;
        if let Some(n) = row.columns.iter().position(starts) {
            path(
                out,
                "noteline",
                &format!("M{} {top}V{bottom}", row.edges[n]),
            );
        }
        for mark in &self.marks {
            let Some(n) = row.columns.iter().position(|c| c.holds(mark.column)) else {
                continue;
            };
            let middle = row.middle(n);
            let (line, class) = match mark.fault {
                true => ("faultline", "faulttext"),
                false => ("noteline", "notetext"),
            };
            path(out, line, &format!("M{middle} {bottom}V{}", y + 6));
            let words = lines(&format!("▲ cycle {}: {}", mark.column, mark.text), 110);
            let length = words.iter().map(|w| width_of(w)).max().unwrap_or(0);
            let x = (middle - 4).min(row.left() + ROOM - length).max(4);
            for words in words {
                y += LINE;
                text(out, x, y, class, &words);
            }
            *right = (*right).max(x + length);
        }
        y + LINE
    }
}

/// The columns of each row: as few rows as there is room for, of about the same width.
fn rows(widths: &[i32]) -> Vec<Range<usize>> {
    let fewest = rows_within(widths, ROOM);
    let narrower = (1..ROOM / 20).map(|n| rows_within(widths, n * 20));
    narrower
        .into_iter()
        .find(|r| r.len() == fewest.len())
        .unwrap_or(fewest)
}

fn rows_within(widths: &[i32], room: i32) -> Vec<Range<usize>> {
    let mut out = Vec::new();
    let (mut start, mut used) = (0, 0);
    for (n, width) in widths.iter().enumerate() {
        if used + width > room && n > start {
            out.push(start..n);
            (start, used) = (n, 0);
        }
        used += width;
    }
    if start < widths.len() {
        out.push(start..widths.len());
    }
    out
}

impl Lane {
    /// Stretches of columns with one value; a gathered column in which it counts stands alone.
    fn segments(&self, columns: &[Column]) -> Vec<Range<usize>> {
        let mut out: Vec<Range<usize>> = Vec::new();
        for (n, column) in columns.iter().enumerate() {
            match out.last_mut() {
                Some(last) if !self.moves(*column) && !self.moves(columns[n - 1]) => {
                    if self.same(columns[n - 1].first(), column.first()) {
                        last.end = n + 1;
                    } else {
                        out.push(n..n + 1);
                    }
                }
                _ => out.push(n..n + 1),
            }
        }
        out
    }

    /// Whether the value is not the same throughout a gathered column.
    fn moves(&self, column: Column) -> bool {
        let (first, count) = (column.first(), column.count());
        (first + 1..first + count).any(|k| !self.same(first, k))
    }

    /// A level that is high or low; a dotted line where it may be either.
    fn level(&self, out: &mut String, row: &Row, top: i32) {
        let (mut line, mut free) = (String::new(), String::new());
        let mut before: Option<i32> = None;
        for (n, column) in row.columns.iter().enumerate() {
            let (left, right) = (row.edges[n], row.edges[n + 1]);
            let value = match self.at(column.first()) {
                Some(value) if !self.moves(*column) => value,
                _ => {
                    let _ = write!(free, "M{left} {}H{right}", top + SIGNAL / 2);
                    before = None;
                    continue;
                }
            };
            let high = value == "TRUE";
            let y = if high { top } else { top + SIGNAL };
            if high {
                rect(out, (left, top), (right - left, SIGNAL), "high");
            }
            match before {
                Some(_) => {
                    let _ = write!(line, "V{y}H{right}");
                }
                None => {
                    let _ = write!(line, "M{left} {y}H{right}");
                }
            }
            before = Some(y);
        }
        path(out, "free", &free);
        path(out, "level", &line);
    }

    /// A value in a hexagon as long as it stays; the first value of the run is drawn pale.
    fn values(&self, out: &mut String, row: &Row, top: i32) {
        let rest = self.values.iter().flatten().next().map(String::as_str);
        let (middle, bottom) = (top + SIGNAL / 2, top + SIGNAL);
        let mut free = String::new();
        for part in self.segments(row.columns) {
            let (left, right) = (row.edges[part.start], row.edges[part.end]);
            let column = row.columns[part.start];
            let moves = self.moves(column);
            let value = match self.at(column.first()) {
                Some(_) if moves => "…",
                Some(value) => value,
                None => {
                    let _ = write!(free, "M{left} {middle}H{right}");
                    continue;
                }
            };
            let class = if Some(value) == rest { "rest" } else { "value" };
            let slant = 4.min((right - left) / 2);
            let (a, b) = (left + slant, right - slant);
            let d = format!("M{left} {middle}L{a} {top}H{b}L{right} {middle}L{b} {bottom}H{a}Z");
            path(out, class, &d);
            let most = usize::try_from((right - left - 6) * 10 / LETTER).unwrap_or(0);
            if most == 0 {
                continue;
            }
            let strong = if class == "value" {
                "mid strong"
            } else {
                "mid"
            };
            // Long stretches tell their value at the beginning and are read from there.
            let x = (left + right) / 2;
            let _ = writeln!(
                out,
                "<text x=\"{x}\" y=\"{}\" class=\"{strong}\">{}<title>{}</title></text>",
                middle + 4,
                html(&cut(value, most)),
                html(value)
            );
        }
        path(out, "free", &free);
    }
}
