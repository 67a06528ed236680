//! The matrix as text, HTML and JSON.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_lang::catalogue::Scope;

use super::{Matrix, Row, Sentence, Shown, Status, area};

fn scope_name(scope: Scope) -> &'static str {
    match scope {
        Scope::Core => "core",
        Scope::Support => "support",
        Scope::Hardware => "hardware",
    }
}

/// Requirements covered, delegated, excepted and open.
#[derive(Default, Clone, Copy)]
struct Count {
    covered: usize,
    delegated: usize,
    excepted: usize,
    open: usize,
    open_core: usize,
}

impl Count {
    fn add(&mut self, row: &Row) {
        match row.status() {
            Status::Covered => self.covered += 1,
            Status::Delegated => self.delegated += 1,
            Status::Excepted => self.excepted += 1,
            Status::Open => self.open += 1,
        }
        self.open_core +=
            usize::from(row.status() == Status::Open && row.requirement.scope == Scope::Core);
    }
}

/// Counts by family, and by area inside.
fn counts(matrix: &Matrix) -> BTreeMap<&str, (Count, BTreeMap<&str, Count>)> {
    let mut out: BTreeMap<&str, (Count, BTreeMap<&str, Count>)> = BTreeMap::new();
    for row in &matrix.rows {
        let (all, areas) = out.entry(&row.requirement.family).or_default();
        all.add(row);
        areas.entry(area(&row.requirement.id)).or_default().add(row);
    }
    out
}

/// Counts by family and area, then what is wrong, then the open core requirements.
pub fn text(matrix: &Matrix) -> String {
    let mut out = String::new();
    let line = |out: &mut String, name: &str, c: Count| {
        let (a, b, d, open, core) = (c.covered, c.delegated, c.excepted, c.open, c.open_core);
        let _ = writeln!(out, "{name:<24}{a:>8}{b:>11}{d:>10}{open:>8}{core:>12}");
    };
    let _ = writeln!(
        out,
        "{:<24}{:>8}{:>11}{:>10}{:>8}{:>12}",
        "", "covered", "delegated", "excepted", "open", "of it core"
    );
    for (family, (all, areas)) in counts(matrix) {
        line(&mut out, family, all);
        for (area, count) in areas {
            line(&mut out, &format!("  {area}"), count);
        }
        let declared = if matrix.complete.contains(family) {
            "declared complete"
        } else {
            "not declared complete"
        };
        let _ = writeln!(out, "  ({declared})");
    }
    for (id, place) in &matrix.unknown {
        let _ = writeln!(out, "UNKNOWN  {id}, named by {place}, is in no catalogue");
    }
    for message in &matrix.nowhere {
        let _ = writeln!(out, "NOWHERE  {message}");
    }
    out.push_str("\nOpen core requirements and what is missing\n");
    for row in matrix.open_core() {
        let _ = writeln!(
            out,
            "  {:<20}{} [{}]",
            row.requirement.id,
            row.requirement.title,
            missing(row)
        );
    }
    out
}

/// The evidence that an open requirement has not, or each of its open sentences.
fn missing(row: &Row) -> String {
    if row.sentences.is_empty() {
        return lacking(row, &row.shown).join(", ");
    }
    let mut list: Vec<String> = row
        .sentences
        .iter()
        .filter(|s| s.shown.status == Status::Open)
        .map(|s| format!("{}: {}", s.name, lacking(row, &s.shown).join(", ")))
        .collect();
    if !row.vague.is_empty() {
        list.push(format!("{} places name no sentence", row.vague.len()));
    }
    list.join("; ")
}

fn lacking(row: &Row, shown: &Shown) -> Vec<&'static str> {
    let mut list = Vec::new();
    if shown.rules.is_empty() {
        list.push("rule");
    }
    if shown.monitors.is_empty() && super::about_monitors(&row.requirement) {
        list.push("monitor");
    }
    if shown.proofs.is_empty() && shown.tests.is_empty() {
        list.push("proof or test");
    }
    if list.is_empty() {
        // A chain alone specifies nothing that a monitor does.
        list.push("rule of a table");
    }
    list
}

fn evidence(shown: &Shown) -> Value {
    json!({
        "status": shown.status.name(), "rules": shown.rules, "monitors": shown.monitors, "proofs": shown.proofs,
        "tests": shown.tests, "reason": shown.reason,
    })
}

fn sentence(sentence: &Sentence) -> Value {
    let mut value = evidence(&sentence.shown);
    value["name"] = json!(sentence.name);
    value["text"] = json!(sentence.text);
    value
}

/// The matrix as JSON: the keys of the design, the sentences, what no catalogue has and where a delegation leads nowhere.
pub fn to_json(matrix: &Matrix) -> Value {
    let rows: Vec<Value> = matrix
        .rows
        .iter()
        .map(|r| {
            let mut row = evidence(&r.shown);
            row["id"] = json!(r.requirement.id);
            row["family"] = json!(r.requirement.family);
            row["scope"] = json!(scope_name(r.requirement.scope));
            row["sentences"] = r.sentences.iter().map(sentence).collect();
            row
        })
        .collect();
    let unknown: Vec<Value> = matrix
        .unknown
        .iter()
        .map(|(id, by)| json!({ "id": id, "named_by": by }))
        .collect();
    json!({
        "requirements": rows, "unknown": unknown, "nowhere": matrix.nowhere, "complete": matrix.complete,
    })
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// The matrix as one HTML page without anything from outside.
pub fn html(matrix: &Matrix) -> String {
    let mut out = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Requirement matrix</title>\n<style>\n\
         body { font-family: sans-serif; }\ntable { border-collapse: collapse; }\n\
         td, th { border: 1px solid #999; padding: 2px 6px; text-align: left; vertical-align: top; }\n\
         .covered { background: #dfd; } .delegated { background: #ddf; } .excepted { background: #eee; } .open { background: #fdd; }\n\
         </style>\n</head>\n<body>\n<h1>Requirement matrix</h1>\n\
         <table>\n<tr><th>family</th><th>covered</th><th>delegated</th><th>excepted</th><th>open</th><th>open core</th></tr>\n",
    );
    for (family, (c, _)) in counts(matrix) {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escaped(family),
            c.covered,
            c.delegated,
            c.excepted,
            c.open,
            c.open_core
        );
    }
    out.push_str("</table>\n");
    if !matrix.unknown.is_empty() {
        out.push_str("<h2>Ids that no catalogue has</h2>\n<ul>\n");
        for (id, place) in &matrix.unknown {
            let _ = writeln!(out, "<li>{} in {}</li>", escaped(id), escaped(place));
        }
        out.push_str("</ul>\n");
    }
    out.push_str(
        "<h2>Requirements</h2>\n<table>\n<tr><th>id</th><th>title</th><th>scope</th><th>status</th><th>rules</th>\
         <th>monitors</th><th>proofs</th><th>tests</th><th>reason</th></tr>\n",
    );
    for row in &matrix.rows {
        let (requirement, scope) = (&row.requirement, scope_name(row.requirement.scope));
        table_row(
            &mut out,
            &requirement.id,
            &requirement.title,
            scope,
            &row.shown,
        );
        for sentence in &row.sentences {
            let id = format!("{}/{}", requirement.id, sentence.name);
            table_row(&mut out, &id, &sentence.text, scope, &sentence.shown);
        }
    }
    out.push_str("</table>\n</body>\n</html>\n");
    out
}

fn table_row(out: &mut String, id: &str, title: &str, scope: &str, shown: &Shown) {
    let list = |places: &[String]| escaped(&places.join("\n")).replace('\n', "<br>");
    let status = shown.status.name();
    let _ = writeln!(
        out,
        "<tr class=\"{status}\"><td>{}</td><td>{}</td><td>{scope}</td><td>{status}</td><td>{}</td><td>{}</td><td>{}</td>\
         <td>{}</td><td>{}</td></tr>",
        escaped(id),
        escaped(title),
        list(&shown.rules),
        list(&shown.monitors),
        list(&shown.proofs),
        list(&shown.tests),
        escaped(shown.reason.as_deref().unwrap_or("")),
    );
}
