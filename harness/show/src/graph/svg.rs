//! Graphs as SVG.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::layout::{At, Line, Way, frame, lay_out};
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
        let lines: Vec<Line> = edges
            .keys()
            .zip(&words)
            .map(|((from, to), words)| Line {
                from: *from,
                to: *to,
                words: room(words),
            })
            .collect();
        let layout = lay_out(&sizes, &lines);
        let (low, high) = frame(&layout, &sizes, &lines).unwrap_or_default();
        let mut body = String::new();
        let mut top = 0;
        if !self.title.is_empty() {
            text(&mut body, 8, 20, "title", &self.title);
            top = 26;
        }
        let _ = writeln!(
            body,
            "<g transform=\"translate({:.1} {:.1})\">",
            MARGIN - low.0,
            MARGIN - low.1 + f64::from(top)
        );
        for ((way, line), words) in layout.ways.iter().zip(&lines).zip(&words) {
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
            if let Some((x, y)) = way.words {
                let first = y - 6.0 * (words.len() as f64 - 1.0) + 3.5;
                for (k, words) in words.iter().enumerate() {
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
        for (n, (corner, size)) in layout.nodes.iter().zip(&sizes).enumerate() {
            self.node(&mut body, n, *corner, *size, name, &labels[n]);
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
        let width = (high.0 - low.0 + 2.0 * MARGIN).ceil() as i32;
        let height = (high.1 - low.1 + 2.0 * MARGIN).ceil() as i32;
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

/// The width and height of words on an edge.
fn room(words: &[String]) -> Option<At> {
    let letters = words.iter().map(|w| w.chars().count()).max()?;
    Some((letters as f64 * 6.1 + 8.0, words.len() as f64 * 12.0 + 4.0))
}

/// A smooth line that is vertical at each of its points, with its head, or with one at each end.
fn arrow(out: &mut String, way: &Way, both: bool) {
    let [first, rest @ ..] = way.points.as_slice() else {
        return;
    };
    let mut d = format!("M{:.1} {:.1}", first.0, first.1);
    let mut at = *first;
    for to in rest {
        let half = (at.1 + to.1) / 2.0;
        if (at.0 - to.0).abs() < 0.5 {
            let _ = write!(d, "L{:.1} {:.1}", to.0, to.1);
        } else {
            let _ = write!(
                d,
                "C{:.1} {half:.1} {:.1} {half:.1} {:.1} {:.1}",
                at.0, to.0, to.0, to.1
            );
        }
        at = *to;
    }
    let _ = writeln!(out, "<path d=\"{d}\"/>");
    if way.upwards || both {
        head(out, *first, 8.0);
    }
    if !way.upwards || both {
        head(out, at, -8.0);
    }
}

/// The head of an arrow whose line comes from below (a positive length) or from above.
fn head(out: &mut String, (x, y): At, length: f64) {
    let base = y + length;
    let _ = writeln!(
        out,
        "<polygon points=\"{x:.1},{y:.1} {:.1},{base:.1} {:.1},{base:.1}\"/>",
        x - 3.5,
        x + 3.5
    );
}
