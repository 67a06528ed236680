//! Documents as Markdown, as GitHub and mdBook read it.

use std::fmt::Write;

use super::{Block, Document, Inline, Table, Tone};
use crate::graph::Graph;

impl Document {
    /// The document as Markdown: figures as fenced text, graphs as lists of their edges.
    pub fn markdown(&self) -> String {
        self.write(&mut Figures::Text)
    }

    /// The document as Markdown with its figures as pictures `{stem}-1.svg` and so on beside it: the text, and the name and
    /// contents of each picture.
    pub fn markdown_with_pictures(&self, stem: &str) -> (String, Vec<(String, String)>) {
        let mut pictures = Vec::new();
        let text = self.write(&mut Figures::Beside(stem, &mut pictures));
        (text, pictures)
    }

    fn write(&self, figures: &mut Figures) -> String {
        let mut out = format!("# {}\n\n", escaped(&self.title));
        if !self.subtitle.is_empty() {
            let _ = write!(out, "{}\n\n", escaped(&self.subtitle));
        }
        blocks(&mut out, &self.blocks, 2, figures);
        while out.ends_with("\n\n") {
            out.pop();
        }
        out
    }
}

/// What becomes of figures.
enum Figures<'a> {
    /// They are written as text.
    Text,
    /// They are pictures in files of this stem, which are gathered here.
    Beside(&'a str, &'a mut Vec<(String, String)>),
}

impl Figures<'_> {
    fn add(
        &mut self,
        out: &mut String,
        title: &str,
        text: impl FnOnce(&mut String),
        svg: impl FnOnce() -> String,
    ) {
        match self {
            Self::Text => text(out),
            Self::Beside(stem, pictures) => {
                let name = format!("{stem}-{}.svg", pictures.len() + 1);
                // A page may show it smaller than it is; following it shows it whole.
                let _ = write!(out, "[![{}]({name})]({name})\n\n", escaped(title));
                pictures.push((name, svg()));
            }
        }
    }
}

fn blocks(out: &mut String, blocks: &[Block], level: usize, figures: &mut Figures) {
    for block in blocks {
        one(out, block, level, figures);
    }
}

fn one(out: &mut String, block: &Block, level: usize, figures: &mut Figures) {
    match block {
        Block::Section {
            title,
            anchor,
            blocks: inner,
        } => {
            // Readers make an anchor of a heading themselves; another one is stated.
            let named = if slug(title) == *anchor {
                String::new()
            } else {
                format!("<a id=\"{}\"></a>", crate::escape::html(anchor))
            };
            let hashes = "#".repeat(level.min(6));
            let _ = write!(out, "{hashes} {named}{}\n\n", escaped(title));
            blocks(out, inner, level + 1, figures);
        }
        Block::Paragraph(words) => {
            let _ = write!(out, "{}\n\n", inline(words));
        }
        Block::List(points) => {
            for words in points {
                let _ = writeln!(out, "- {}", inline(words));
            }
            out.push('\n');
        }
        Block::Verdict { head, text, .. } => {
            let _ = writeln!(out, "> **{}**", escaped(head));
            if !text.is_empty() {
                let _ = writeln!(out, ">\n> {}", inline(text));
            }
            out.push('\n');
        }
        Block::Figures(figures) => {
            for (value, name) in figures {
                let _ = writeln!(out, "- **{}** {}", escaped(value), escaped(name));
            }
            out.push('\n');
        }
        Block::Table(rows) => table(out, rows),
        Block::Timing(diagram) => figures.add(
            out,
            &diagram.title,
            |out| fenced(out, &diagram.text()),
            || diagram.svg(),
        ),
        Block::Graph(drawn) => {
            figures.add(out, &drawn.title, |out| graph(out, drawn), || drawn.svg())
        }
        Block::Preformatted(text) => fenced(out, text),
        Block::Details {
            summary,
            blocks: inner,
        } => {
            let _ = write!(out, "**{}**\n\n", inline(summary).replace("**", ""));
            blocks(out, inner, level, figures);
        }
    }
}

fn table(out: &mut String, table: &Table) {
    if !table.caption.is_empty() {
        let _ = write!(out, "*{}*\n\n", escaped(&table.caption));
    }
    if table.columns.is_empty() {
        return;
    }
    let cells = |out: &mut String, cells: &mut dyn Iterator<Item = String>| {
        let cells: Vec<String> = cells.collect();
        let _ = writeln!(out, "| {} |", cells.join(" | "));
    };
    cells(out, &mut table.columns.iter().map(|c| escaped(&c.title)));
    let rule = |number: bool| if number { "---:" } else { "---" }.to_owned();
    cells(out, &mut table.columns.iter().map(|c| rule(c.number)));
    for row in &table.rows {
        cells(
            out,
            &mut row.iter().map(|c| inline(c).replace('\n', "<br>")),
        );
    }
    out.push('\n');
}

fn graph(out: &mut String, graph: &Graph) {
    if !graph.title.is_empty() {
        let _ = write!(out, "**{}**\n\n", escaped(&graph.title));
    }
    let entered: Vec<bool> = (0..graph.nodes.len())
        .map(|n| {
            graph
                .edges_of(n, true)
                .chain(graph.edges_of(n, false))
                .next()
                .is_some()
        })
        .collect();
    for (n, node) in graph.nodes.iter().enumerate() {
        if node.initial || !node.reached || !entered[n] {
            let mut said = Vec::new();
            if node.initial {
                said.push("runs begin here");
            }
            said.push(if node.reached {
                "reached"
            } else {
                "not reached"
            });
            let _ = writeln!(out, "- {}: {}", code(&graph.name(n)), said.join(", "));
        }
    }
    for edge in &graph.edges {
        let why = match edge.labels.is_empty() {
            true => String::new(),
            false => format!(": {}", escaped(&edge.labels.join(", "))),
        };
        let (from, to) = (code(&graph.name(edge.from)), code(&graph.name(edge.to)));
        let _ = writeln!(out, "- {from} → {to}{why}");
    }
    out.push('\n');
}

fn fenced(out: &mut String, text: &str) {
    let fence = "`".repeat(longest(text).max(2) + 1);
    let _ = write!(
        out,
        "{fence}text\n{}\n{fence}\n\n",
        text.trim_end_matches('\n')
    );
}

/// The longest run of backticks.
fn longest(text: &str) -> usize {
    text.split(|c| c != '`').map(str::len).max().unwrap_or(0)
}

fn code(text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    let ticks = "`".repeat(longest(text) + 1);
    // Backticks at the ends need a space, and a pipe would end the cell of a table even inside of code.
    let space = if text.starts_with('`') || text.ends_with('`') {
        " "
    } else {
        ""
    };
    let text = text.replace('\n', " ").replace('|', "\\|");
    format!("{ticks}{space}{text}{space}{ticks}")
}

fn inline(words: &[Inline]) -> String {
    let mut out = String::new();
    for word in words {
        match word {
            Inline::Text(text) | Inline::Name(text) => out.push_str(&escaped(text)),
            Inline::Code(text) => out.push_str(&code(text)),
            Inline::Strong(text) if text.trim().is_empty() => out.push_str(text),
            Inline::Strong(text) => {
                let _ = write!(out, "**{}**", escaped(text.trim()));
            }
            Inline::Badge(tone, text) => {
                let sign = match tone {
                    Tone::Good => "✓ ",
                    Tone::Bad => "✗ ",
                    Tone::Open => "? ",
                    Tone::Plain => "",
                };
                let _ = write!(out, "**{sign}{}**", escaped(text));
            }
            Inline::Link { text, to } => {
                let to = to
                    .replace(' ', "%20")
                    .replace('(', "%28")
                    .replace(')', "%29");
                let _ = write!(out, "[{}]({to})", escaped(text));
            }
            Inline::Blank(width) => out.push_str(&"\\_".repeat(usize::from(*width))),
        }
    }
    out
}

/// The anchor that readers make of a heading.
fn slug(title: &str) -> String {
    title
        .chars()
        .filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => c.to_lowercase().next(),
            _ => None,
        })
        .collect()
}

/// Text without a meaning as markup, also at the beginning of a line.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut begins = true;
    for (n, c) in text.char_indices() {
        let rest = &text[n + c.len_utf8()..];
        match c {
            '\\' | '`' | '*' | '[' | ']' | '|' | '#' => {
                out.push('\\');
                out.push(c);
            }
            // Inside of a word an underscore is no markup.
            '_' => {
                let inside =
                    out.ends_with(char::is_alphanumeric) && rest.starts_with(char::is_alphanumeric);
                out.push_str(if inside { "_" } else { "\\_" });
            }
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '~' if rest.starts_with('~') || out.ends_with('~') => out.push_str("\\~"),
            '-' | '+' | '=' if begins => {
                out.push('\\');
                out.push(c);
            }
            '.' | ')' if begun_by_number(&out) => {
                out.push('\\');
                out.push(c);
            }
            c => out.push(c),
        }
        begins = c == '\n' || begins && c.is_whitespace();
    }
    out
}

/// Whether the line so far is a number, which a dot would make a point of a list.
fn begun_by_number(out: &str) -> bool {
    let line = out.rsplit('\n').next().unwrap_or(out).trim_start();
    !line.is_empty() && line.chars().all(|c| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::super::Column;
    use super::*;
    use crate::graph::{Edge, Node};

    #[test]
    fn text_is_escaped() {
        assert_eq!(
            escaped("- a_b <x> & \"q\" | *s* _t_\n1. [l](#)"),
            "\\- a_b &lt;x&gt; &amp; \"q\" \\| \\*s\\* \\_t\\_\n1\\. \\[l\\](\\#)"
        );
        assert_eq!(code("a|b"), "`a\\|b`");
        assert_eq!(code("`x"), "`` `x ``");
    }

    #[test]
    fn a_table_keeps_its_cells() {
        let document = Document {
            title: "T".to_owned(),
            subtitle: String::new(),
            blocks: vec![Block::Section {
                title: "What is set".to_owned(),
                anchor: "config".to_owned(),
                blocks: vec![Block::Table(Table {
                    caption: String::new(),
                    columns: vec![
                        Column {
                            title: "name".to_owned(),
                            number: false,
                        },
                        Column {
                            title: "value".to_owned(),
                            number: true,
                        },
                    ],
                    rows: vec![vec![
                        vec![Inline::Code("a|b".to_owned())],
                        vec![Inline::Blank(3)],
                    ]],
                })],
            }],
        };
        assert_eq!(
            document.markdown(),
            "# T\n\n## <a id=\"config\"></a>What is set\n\n| name | value |\n| --- | ---: |\n| `a\\|b` | \\_\\_\\_ |\n"
        );
    }

    #[test]
    fn figures_can_be_pictures_beside() {
        let drawn = Graph {
            title: "states".to_owned(),
            ..Graph::default()
        };
        let document = Document {
            title: "T".to_owned(),
            subtitle: String::new(),
            blocks: vec![Block::Graph(Box::new(drawn.clone()))],
        };
        let (text, pictures) = document.markdown_with_pictures("stop");
        assert_eq!(text, "# T\n\n[![states](stop-1.svg)](stop-1.svg)\n");
        assert_eq!(pictures, [("stop-1.svg".to_owned(), drawn.svg())]);
    }

    #[test]
    fn a_graph_is_a_list_of_edges() {
        let node = |label: &str, initial| Node {
            label: label.to_owned(),
            note: String::new(),
            reached: true,
            initial,
        };
        let drawn = Graph {
            title: String::new(),
            nodes: vec![node("A", true), node("B\nC", false)],
            edges: vec![Edge {
                from: 0,
                to: 1,
                labels: vec!["x > 1".to_owned()],
            }],
        };
        let mut out = String::new();
        graph(&mut out, &drawn);
        assert_eq!(
            out,
            "- `A`: runs begin here, reached\n- `A` → `B, C`: x &gt; 1\n\n"
        );
    }
}
