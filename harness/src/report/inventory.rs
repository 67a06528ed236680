//! The proofs of the monitors: the inventory of the book, as it was when this program was built.
//!
//! The inventory is made by the crate `stillpoint-proofs`, on which nothing here may depend; its page is read as text.

use stillpoint_show::document::{Block, Inline};

use super::document::{code, paragraph, table, words};

const PAGE: &str = include_str!("../../../docs/src/proofs.md");

/// What is said before the table, and the table folded away.
pub(super) fn blocks() -> Vec<Block> {
    let rows = rows();
    let count = rows.len();
    vec![
        paragraph(
            "The explorations above judge the specification. The production monitors are compared with it by stillpoint diff, \
             and have the contracts below. An enumeration is a proof for the finite domain that the inventory states, a \
             sampling is a test.",
        ),
        Block::Details {
            summary: words(format!("{count} harnesses, with bounds and caveats")),
            blocks: vec![table(
                &[
                    "harness",
                    "property",
                    "enumeration",
                    "sampling",
                    "Kani",
                    "bound",
                    "caveat",
                ],
                rows,
            )],
        },
    ]
}

/// The rows of the table: all its columns but the third, which names the requirements.
pub fn rows() -> Vec<Vec<Vec<Inline>>> {
    PAGE.lines()
        .skip_while(|l| !l.starts_with("| harness |"))
        .skip(2)
        .take_while(|l| l.starts_with('|'))
        .map(|line| {
            let mut cells: Vec<&str> = line.trim().trim_matches('|').split(" | ").collect();
            if cells.len() > 2 {
                cells.remove(2);
            }
            cells.iter().map(|cell| inline(cell.trim())).collect()
        })
        .collect()
}

/// Words with code between backticks.
fn inline(text: &str) -> Vec<Inline> {
    match text.strip_prefix('`').and_then(|t| t.strip_suffix('`')) {
        Some(name) if !name.contains('`') => code(name),
        _ => words(text.replace('`', "").replace("\\|", "|")),
    }
}
