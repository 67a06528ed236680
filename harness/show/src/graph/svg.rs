//! Graphs as SVG.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::layout::{At, Layout, Line, Way, lay_out};
use super::{Edge, Graph};
use crate::escape::{cut, html};
use crate::svg::{picture, text};

/// More edges than this stand without words, which would cover each other; they are told when a node is chosen.
const MOST_WORDS: usize = 14;
/// Characters of a reason on an edge.
const WORDS: usize = 26;
/// Space around the picture.
const MARGIN: f64 = 14.0;

impl Graph {
    /// The graph as SVG that stands alone.
    pub fn svg(&self) -> String {
        self.draw(true, "")
    }

    /// The graph as SVG. Its nodes are named `{name}-n0` and so on, for a page that lets them be chosen.
    pub(crate) fn draw(&self, standalone: bool, name: &str) -> String {
        let labels: Vec<Vec<&str>> = self
            .nodes
            .iter()
            .map(|n| n.label.lines().collect())
            .collect();
        let sizes: Vec<At> = labels.iter().map(|l| size(l)).collect();
        let mut edges = self.drawn();
        let with_words = edges.len() <= MOST_WORDS;
        let mut both = BTreeSet::new();
        if !with_words {
            // A way there and back is one line then.
            both = edges
                .keys()
                .copied()
                .filter(|(from, to)| from < to && edges.contains_key(&(*to, *from)))
                .collect();
            edges.retain(|(from, to), _| !both.contains(&(*to, *from)));
        }
        let words: Vec<Vec<String>> = edges
            .values()
            .map(|labels| {
                if with_words {
                    short(labels)
                } else {
                    Vec::new()
                }
            })
            .collect();
        let width = |words: &[String]| words.iter().map(|w| w.chars().count()).max();
        let lines: Vec<Line> = edges
            .keys()
            .zip(&words)
            .map(|((from, to), words)| Line {
                from: *from,
                to: *to,
                words: (width(words).unwrap_or(0).max(4), words.len()),
            })
            .collect();
        let layout = if self.nodes.is_empty() {
            Layout::default()
        } else {
            lay_out(&sizes, &lines)
        };
        let (shift, extent) = frame(&layout);
        let mut body = String::new();
        let mut top = 0;
        if !self.title.is_empty() {
            text(&mut body, 8, 20, "title", &self.title);
            top = 26;
        }
        let _ = writeln!(
            body,
            "<g transform=\"translate({:.1} {:.1})\">",
            shift.0,
            shift.1 + f64::from(top)
        );
        for way in &layout.edges {
            let line = &lines[way.edge];
            let pale = !(self.nodes[line.from].reached && self.nodes[line.to].reached);
            let class = if pale { "edge pale" } else { "edge" };
            let both = both.contains(&(line.from, line.to));
            let back = if both { " data-both=\"\"" } else { "" };
            let _ = writeln!(
                body,
                "<g class=\"{class}\" data-from=\"{}\" data-to=\"{}\"{back}>",
                line.from, line.to
            );
            arrow(&mut body, way, both);
            if let Some((x, y)) = layout.words.get(&way.edge) {
                let lines = &words[way.edge];
                let first = y - 6.0 * (lines.len() as f64 - 1.0) + 3.5;
                for (k, words) in lines.iter().enumerate() {
                    let y = first + 12.0 * k as f64;
                    let _ = writeln!(
                        body,
                        "<text x=\"{x:.1}\" y=\"{y:.1}\">{}</text>",
                        html(words)
                    );
                }
            }
            body.push_str("</g>\n");
        }
        for (n, (corner, size)) in &layout.nodes {
            self.node(&mut body, *n, *corner, *size, name, &labels[*n]);
        }
        body.push_str("</g>\n");
        let title = match self.title.as_str() {
            "" => "graph",
            title => title,
        };
        // A picture narrower than its title would cut it.
        let wide = i32::try_from(self.title.chars().count())
            .unwrap_or(0)
            .min(120)
            * 8
            + 16;
        let (width, height) = (extent.0.ceil() as i32, extent.1.ceil() as i32);
        picture((width.max(wide), height + top), title, standalone, &body)
    }

    /// Edges from one node to another, one for each pair, with their reasons. An edge that stays is told in words only.
    fn drawn(&self) -> BTreeMap<(usize, usize), Vec<&str>> {
        let mut out: BTreeMap<(usize, usize), Vec<&str>> = BTreeMap::new();
        let exists = |n: usize| n < self.nodes.len();
        for Edge { from, to, labels } in &self.edges {
            if from != to && exists(*from) && exists(*to) {
                let known = out.entry((*from, *to)).or_default();
                known.extend(labels.iter().map(String::as_str));
            }
        }
        out
    }

    fn node(&self, out: &mut String, n: usize, corner: At, size: At, name: &str, label: &[&str]) {
        let node = &self.nodes[n];
        let mut class = String::from("node");
        if !node.reached {
            class.push_str(" pale");
        }
        if node.initial {
            class.push_str(" initial");
        }
        let chosen = match name {
            "" => String::new(),
            name => format!(
                " data-info=\"{name}-n{n}\" data-node=\"{n}\" tabindex=\"0\" role=\"button\""
            ),
        };
        let _ = writeln!(out, "<g class=\"{class}\"{chosen}>");
        let _ = writeln!(out, "<title>{}</title>", html(&self.told(n)));
        let ((x, y), (width, height)) = (corner, size);
        let _ = writeln!(
            out,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" rx=\"6\"/>"
        );
        let first = y + height / 2.0 - 7.0 * (label.len() as f64 - 1.0) + 4.0;
        for (k, words) in label.iter().enumerate() {
            let _ = writeln!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                x + width / 2.0,
                first + 14.0 * k as f64,
                html(words)
            );
        }
        out.push_str("</g>\n");
    }

    /// How a node is reached and left, in lines.
    fn told(&self, n: usize) -> String {
        let mut out = self.name(n);
        if self.nodes[n].initial {
            out.push_str("\nruns begin here");
        }
        for edge in self.edges_of(n, true) {
            let _ = write!(
                out,
                "\nfrom {}: {}",
                self.name(edge.from),
                edge.labels.join(", ")
            );
        }
        for edge in self.edges_of(n, false) {
            let _ = write!(
                out,
                "\nto {}: {}",
                self.name(edge.to),
                edge.labels.join(", ")
            );
        }
        out
    }
}

/// The size of a node with this label.
fn size(label: &[&str]) -> At {
    let letters = label.iter().map(|l| l.chars().count()).max().unwrap_or(0);
    (
        (letters as f64 * 6.7 + 20.0).max(44.0),
        label.len().max(1) as f64 * 14.0 + 14.0,
    )
}

/// The reasons of an edge as they stand on it.
fn short(labels: &[&str]) -> Vec<String> {
    let mut out: Vec<String> = labels.iter().take(2).map(|l| cut(l, WORDS)).collect();
    if labels.len() == 3 {
        out.push(cut(labels[2], WORDS));
    } else if labels.len() > 3 {
        out.push(format!("and {} more", labels.len() - 2));
    }
    out
}

/// What brings everything into the picture, and the picture's size.
fn frame(layout: &Layout) -> (At, At) {
    let mut low = (f64::INFINITY, f64::INFINITY);
    let mut high = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    let mut hold = |(x, y): At| {
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x), high.1.max(y));
    };
    for ((x, y), (width, height)) in layout.nodes.values() {
        hold((*x, *y));
        hold((x + width, y + height));
    }
    for (_, point) in layout.edges.iter().flat_map(|w| w.path.iter().skip(1)) {
        hold(*point);
    }
    for (x, y) in layout.words.values() {
        let half = WORDS as f64 * 3.0;
        hold((x - half, y - 12.0));
        hold((x + half, y + 12.0));
    }
    if low.0 > high.0 {
        return ((0.0, 0.0), (2.0 * MARGIN, 2.0 * MARGIN));
    }
    (
        (MARGIN - low.0, MARGIN - low.1),
        (high.0 - low.0 + 2.0 * MARGIN, high.1 - low.1 + 2.0 * MARGIN),
    )
}

/// A smooth line with its head, or with one at each end.
fn arrow(out: &mut String, way: &Way, both: bool) {
    let [(start, leave), (arrive, end), rest @ ..] = way.path.as_slice() else {
        return;
    };
    let mut d = format!(
        "M{:.1} {:.1}C{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}",
        start.0, start.1, leave.0, leave.1, arrive.0, arrive.1, end.0, end.1
    );
    for ((cx, cy), (x, y)) in rest {
        let _ = write!(d, "S{cx:.1} {cy:.1} {x:.1} {y:.1}");
    }
    let _ = writeln!(out, "<path d=\"{d}\"/>");
    if way.reversed || both {
        head(out, *start, *leave);
    }
    if !way.reversed || both {
        let (from, tip) = rest.last().copied().unwrap_or((*arrive, *end));
        head(out, tip, from);
    }
}

/// The head of an arrow that comes from somewhere.
fn head(out: &mut String, tip: At, from: At) {
    let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
    let length = dx.hypot(dy);
    if length < 0.5 {
        return;
    }
    let (dx, dy) = (dx / length, dy / length);
    let base = (tip.0 - 8.0 * dx, tip.1 - 8.0 * dy);
    let _ = writeln!(
        out,
        "<polygon points=\"{:.1},{:.1} {:.1},{:.1} {:.1},{:.1}\"/>",
        tip.0,
        tip.1,
        base.0 - 3.5 * dy,
        base.1 + 3.5 * dx,
        base.0 + 3.5 * dy,
        base.1 - 3.5 * dx
    );
}
