//! Documents as one HTML page that needs nothing else.

use std::fmt::Write;

use super::{Block, Document, Inline, Table, Tone};
use crate::escape::html;
use crate::graph::{Edge, Graph};
use crate::svg;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

impl Document {
    /// The document as a page: readable in light and dark, on narrow screens and on A4 paper, without a network.
    pub fn html(&self) -> String {
        let title = html(&self.title);
        let mut writer = Writer {
            out: String::new(),
            graphs: 0,
        };
        writer.blocks(&self.blocks, 2);
        let mut out = String::new();
        let _ = writeln!(
            out,
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
             <style>\n{STYLE}{}</style>\n</head>\n<body>",
            svg::STYLE
        );
        let _ = writeln!(out, "<header>\n<h1>{title}</h1>");
        if !self.subtitle.is_empty() {
            let _ = writeln!(out, "<p class=\"subtitle\">{}</p>", html(&self.subtitle));
        }
        out.push_str("</header>\n");
        self.contents(&mut out);
        let _ = writeln!(
            out,
            "<main>\n{}</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>",
            writer.out
        );
        out
    }

    /// Links to the parts, where there are several.
    fn contents(&self, out: &mut String) {
        let parts: Vec<(&str, &str)> = self
            .blocks
            .iter()
            .filter_map(|b| match b {
                Block::Section { title, anchor, .. } => Some((title.as_str(), anchor.as_str())),
                _ => None,
            })
            .collect();
        if parts.len() < 3 {
            return;
        }
        out.push_str("<nav aria-label=\"contents\">\n<ul>\n");
        for (title, anchor) in parts {
            let _ = writeln!(
                out,
                "<li><a href=\"#{}\">{}</a></li>",
                html(anchor),
                html(title)
            );
        }
        out.push_str("</ul>\n</nav>\n");
    }
}

struct Writer {
    out: String,
    /// Graphs so far, to name their nodes.
    graphs: usize,
}

impl Writer {
    fn blocks(&mut self, blocks: &[Block], level: usize) {
        for block in blocks {
            self.block(block, level);
        }
    }

    fn block(&mut self, block: &Block, level: usize) {
        let out = &mut self.out;
        match block {
            Block::Section {
                title,
                anchor,
                blocks,
            } => {
                let h = level.min(6);
                let _ = writeln!(
                    out,
                    "<section class=\"level{h}\" id=\"{}\">\n<h{h}>{}</h{h}>",
                    html(anchor),
                    html(title)
                );
                self.blocks(blocks, level + 1);
                self.out.push_str("</section>\n");
            }
            Block::Paragraph(words) => {
                let _ = writeln!(out, "<p>{}</p>", inline(words));
            }
            Block::List(points) => {
                out.push_str("<ul>\n");
                for words in points {
                    let _ = writeln!(out, "<li>{}</li>", inline(words));
                }
                out.push_str("</ul>\n");
            }
            Block::Verdict { tone, head, text } => {
                let _ = writeln!(
                    out,
                    "<div class=\"verdict {}\">\n<p class=\"result\">{}</p>",
                    class(*tone),
                    html(head)
                );
                if !text.is_empty() {
                    let _ = writeln!(out, "<p>{}</p>", inline(text));
                }
                out.push_str("</div>\n");
            }
            Block::Figures(figures) => {
                out.push_str("<dl class=\"figures\">\n");
                for (value, name) in figures {
                    let _ = writeln!(
                        out,
                        "<div><dt>{}</dt><dd>{}</dd></div>",
                        html(name),
                        html(value)
                    );
                }
                out.push_str("</dl>\n");
            }
            Block::Table(rows) => table(out, rows),
            Block::Timing(diagram) => {
                let _ = writeln!(
                    out,
                    "<figure class=\"timing\"><div class=\"scroll\" tabindex=\"0\">\n{}</div></figure>",
                    diagram.draw(false)
                );
            }
            Block::Graph(drawn) => self.graph(drawn),
            Block::Preformatted(text) => {
                let _ = writeln!(out, "<pre>{}</pre>", html(text.trim_end_matches('\n')));
            }
            Block::Details { summary, blocks } => {
                let _ = writeln!(
                    out,
                    "<details>\n<summary>{}</summary>\n<div class=\"inside\">",
                    inline(summary)
                );
                self.blocks(blocks, level);
                self.out.push_str("</div>\n</details>\n");
            }
        }
    }

    /// The picture, and for each node how it is reached and left: shown below the picture when it is chosen, and as a
    /// list that can be opened, for paper and for readers without scripts.
    fn graph(&mut self, graph: &Graph) {
        let name = format!("graph{}", self.graphs);
        self.graphs += 1;
        let out = &mut self.out;
        let _ = writeln!(
            out,
            "<figure class=\"graph\"><div class=\"scroll\" tabindex=\"0\">\n{}</div>\n\
             <div class=\"chosen\" aria-live=\"polite\"><p class=\"hint\">Choose a state to see how it is reached and \
             left.</p></div>\n<details class=\"states\">\n<summary>All states: how each is reached and left</summary>\n\
             <div class=\"inside\">",
            graph.draw(false, &name)
        );
        for (n, node) in graph.nodes.iter().enumerate() {
            let _ = writeln!(
                out,
                "<div class=\"state\" id=\"{name}-n{n}\">\n<p><strong>{}</strong>{}{}</p>",
                html(&graph.name(n)),
                if node.initial {
                    ", runs begin here"
                } else {
                    ""
                },
                if node.reached { "" } else { ", not reached" },
            );
            if !node.note.is_empty() {
                let _ = writeln!(out, "<p>{}</p>", html(&node.note));
            }
            out.push_str("<ul>\n");
            for edge in graph.edges_of(n, true) {
                way(out, "reached from", &graph.name(edge.from), edge);
            }
            for edge in graph.edges_of(n, false) {
                way(out, "left for", &graph.name(edge.to), edge);
            }
            for edge in graph.stays(n) {
                way(out, "stays", "", edge);
            }
            out.push_str("</ul>\n</div>\n");
        }
        out.push_str("</div>\n</details></figure>\n");
    }
}

/// One way into or out of a node.
fn way(out: &mut String, verb: &str, other: &str, edge: &Edge) {
    let other = match other {
        "" => String::new(),
        other => format!(" <strong>{}</strong>", html(other)),
    };
    let reasons: Vec<String> = edge.labels.iter().map(|l| html(l)).collect();
    let why = match reasons.is_empty() {
        true => String::new(),
        false => format!(": {}", reasons.join("; ")),
    };
    let _ = writeln!(out, "<li>{verb}{other}{why}</li>");
}

fn class(tone: Tone) -> &'static str {
    match tone {
        Tone::Good => "good",
        Tone::Bad => "bad",
        Tone::Open => "open",
        Tone::Plain => "plain",
    }
}

fn table(out: &mut String, table: &Table) {
    // A row of more than two cells becomes a card on a narrow screen.
    let kind = match table.columns.len() {
        0 | 1 => "table",
        2 => "table pair",
        _ => "table stack",
    };
    let _ = writeln!(out, "<div class=\"{kind}\"><table>");
    if !table.caption.is_empty() {
        let _ = writeln!(out, "<caption>{}</caption>", html(&table.caption));
    }
    out.push_str("<thead><tr>");
    for column in &table.columns {
        let number = if column.number {
            " class=\"number\""
        } else {
            ""
        };
        let _ = write!(
            out,
            "<th scope=\"col\"{number}>{}</th>",
            html(&column.title)
        );
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        out.push_str("<tr>");
        for (column, cell) in table.columns.iter().zip(row) {
            let number = if column.number {
                " class=\"number\""
            } else {
                ""
            };
            let _ = write!(
                out,
                "<td{number} data-label=\"{}\">{}</td>",
                html(&column.title),
                inline(cell).replace('\n', "<br>")
            );
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table></div>\n");
}

fn inline(words: &[Inline]) -> String {
    let mut out = String::new();
    for word in words {
        let _ = match word {
            Inline::Text(text) => write!(out, "{}", html(text)),
            Inline::Code(text) => write!(out, "<code>{}</code>", html(text)),
            Inline::Name(text) => write!(out, "<span class=\"name\">{}</span>", html(text)),
            Inline::Strong(text) => write!(out, "<strong>{}</strong>", html(text)),
            Inline::Badge(tone, text) => write!(
                out,
                "<span class=\"badge {}\">{}</span>",
                class(*tone),
                html(text)
            ),
            Inline::Link { text, to } => {
                write!(out, "<a href=\"{}\">{}</a>", html(to), html(text))
            }
            Inline::Blank(width) => {
                write!(
                    out,
                    "<span class=\"blank\" style=\"width:{width}ch\"></span>"
                )
            }
        };
    }
    out
}
