//! The page with the warnings about values that a family has.

use stillpoint_machine::warnings::Known;
use stillpoint_show::document::{Block, Document, Inline, Table};

/// The name of the page.
pub(super) const NAME: &str = "warnings.md";

/// The catalogue in its order; none where the family has no warnings.
pub(super) fn document(title: &str, catalogue: &[Known]) -> Option<Document> {
    let rows = catalogue.iter().map(|w| {
        let mut reason = vec![Inline::text(&w.reason)];
        if w.source.is_empty() {
            reason.push(Inline::Text(" (Engineering.)".to_owned()));
        }
        vec![
            vec![Inline::Code(w.id.clone())],
            vec![Inline::text(&w.text)],
            reason,
            vec![Inline::text(&w.better)],
            vec![Inline::Code(w.when.clone())],
            lines(&w.source),
            vec![Inline::Text(w.req.join(" "))],
        ]
    });
    let heads = [
        "warning",
        "what is unusual",
        "why it matters",
        "what is better",
        "given when",
        "lines of the manual",
        "requirements",
    ];
    let rows: Vec<Vec<Vec<Inline>>> = rows.collect();
    let table = Table::new(&heads, rows).without_empty_columns();
    (!catalogue.is_empty()).then(|| Document {
        title: format!("Warnings: {title}"),
        subtitle: "Values of a machine file that are legal but unusual, or contradict their purpose. Expressions are over base units. \
                   Made from the family's data by stillpoint pages; not to be edited."
            .to_owned(),
        blocks: vec![Block::Table(table)],
    })
}

/// The lines without the manual, which is the same for all.
fn lines(source: &str) -> Vec<Inline> {
    let lines = source.rsplit_once(", line").map_or("", |(_, lines)| lines);
    let lines = lines.trim_start_matches('s').trim();
    match lines {
        "" => Vec::new(),
        lines => vec![Inline::text(lines)],
    }
}
