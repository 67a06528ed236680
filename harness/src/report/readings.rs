//! What depends on how an ambiguity of the manual is read, told.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_engine::readings::Compared;

/// The comparison for readers.
pub fn text(compared: &[Compared]) -> String {
    let mut out = String::from("Readings of the manual\n");
    for c in compared {
        let _ = writeln!(
            out,
            "  {} {} instead of {} ({})",
            c.reading, c.option, c.against, c.text
        );
        if c.tasks == 0 {
            out.push_str("    no system of this file uses it\n");
        } else if c.changes.is_empty() {
            let _ = writeln!(
                out,
                "    no verdict depends on it ({} explorations)",
                c.tasks
            );
        }
        for (id, a, b) in &c.changes {
            let _ = writeln!(out, "    {id}: {a} -> {b}");
        }
        if !c.complete {
            out.push_str("    not explored to the end: a limit was reached\n");
        }
    }
    out
}

/// The comparison as JSON.
pub fn to_json(compared: &[Compared]) -> Value {
    compared
        .iter()
        .map(|c| {
            let changes: Vec<Value> = c
                .changes
                .iter()
                .map(|(id, a, b)| json!({ "id": id, "main": a, "other": b }))
                .collect();
            json!({
                "id": c.reading, "option": c.option, "against": c.against,
                "explorations": c.tasks, "complete": c.complete, "changes": changes,
            })
        })
        .collect::<Vec<_>>()
        .into()
}
