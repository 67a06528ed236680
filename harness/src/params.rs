//! The parameters of a family for whoever writes a machine file: all of them in a list, or one whole.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_lang::catalogue::{Catalogue, requirement_id};
use stillpoint_lang::diag::nearest;
use stillpoint_machine::data::{Allowed, Datum, FamilyData, Told};
use stillpoint_machine::uses::{Readers, Uses};

use crate::report::wrapped;

/// The parameters of the family, and the arguments of its guarantees, that a user may call so. `Err`: what to write instead.
pub fn find<'a>(data: &'a FamilyData, word: &str) -> Result<Vec<&'a Datum>, String> {
    let all = || data.parameters.iter().chain(&data.arguments);
    let found: Vec<&Datum> = all().filter(|d| d.is_called(word)).collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let digits = word.bytes().any(|b| b.is_ascii_digit());
    let names = all().flat_map(|d| {
        let printed = d.manual.split(['/', ' ']).filter(|_| digits);
        std::iter::once(d.name.as_str()).chain(printed)
    });
    let part = all().filter(|d| word.len() > 2 && d.name.contains(&word.to_uppercase()));
    let part: Vec<&str> = part.map(|d| d.name.as_str()).take(5).collect();
    Err(match (part.as_slice(), nearest(word, names)) {
        ([], Some(near)) => format!("did you mean {near}?"),
        ([], None) => "without a name all of them are listed".to_owned(),
        (list, _) => format!("did you mean {}?", list.join(", ")),
    })
}

/// The list as text.
pub fn list(name: &str, data: &FamilyData) -> String {
    let mut out = format!("{name}: {}\n", data.title);
    let names = data.parameters.iter().map(|d| d.name.chars().count());
    let width = names.max().unwrap_or(0);
    for table in ["control", "axis", "group", "door"] {
        let mut of = data.parameters.iter().filter(|d| d.table == table);
        let first = of.next();
        if first.is_some() {
            let _ = writeln!(out, "\n[{}]", header(table));
        }
        for datum in first.into_iter().chain(of) {
            let mut line = format!("{}; default {}", range(datum), default(datum));
            if let Some(numbers) = numbers(datum) {
                line = format!("{numbers}; {line}");
            }
            wrapped(&mut out, &format!("  {:<width$} ", datum.name), &line);
            wrapped(&mut out, &" ".repeat(width + 3), &text(datum));
        }
    }
    if !data.patterns.is_empty() {
        out.push_str("\npatterns of [guarantee.NAME]\n");
    }
    for told in &data.patterns {
        wrapped(
            &mut out,
            &format!("  {:<width$} ", told.name),
            &arguments(told),
        );
    }
    let _ = writeln!(
        out,
        "\n{} parameters; one of them, a pattern or its argument whole: stillpoint params {name} NAME",
        data.parameters.len()
    );
    out
}

/// A pattern of guarantees whole, as text.
pub fn pattern(told: &Told) -> String {
    let mut out = format!("{}: a pattern of [guarantee.NAME]\n", told.name);
    for (head, text) in [
        ("says:", &told.text),
        ("arguments:", &arguments(told)),
        ("source:", &told.source),
    ] {
        wrapped(&mut out, &format!("  {head:<11} "), text);
    }
    out
}

/// A pattern of guarantees as JSON.
pub fn pattern_to_json(told: &Told) -> Value {
    json!({
        "pattern": told.name, "text": told.text, "source": told.source, "required": told.required, "optional": told.optional,
    })
}

/// The arguments of a pattern, first those that a guarantee has to give.
fn arguments(told: &Told) -> String {
    let lists = [("", &told.required), ("may have ", &told.optional)];
    let lists = lists.iter().filter(|(_, list)| !list.is_empty());
    let lists = lists.map(|(head, list)| format!("{head}{}", list.join(", ")));
    lists.collect::<Vec<_>>().join("; ")
}

/// One parameter whole, as text.
pub fn whole(readers: &Readers, datum: &Datum, catalogue: &Catalogue) -> String {
    let mut out = format!("{}: {}\n", datum.name, text(datum));
    let mut line = |head: &str, text: &str| {
        if !text.is_empty() {
            wrapped(&mut out, &format!("  {head:<11} "), text);
        }
    };
    line("written in:", &format!("[{}]", header(datum.table)));
    line("kinds:", &datum.kinds.join(", "));
    line("manual:", &datum.manual);
    line("unit:", &both(datum, |a| &a.units));
    line("range:", &range(datum));
    line("default:", &default(datum));
    let Uses {
        functions,
        rules,
        warnings,
        patterns,
        systems,
    } = readers.of(&datum.name);
    line("functions:", &functions.join("; "));
    line("decides:", &patterns.join(", "));
    let mut part = |head: &str, list: &[(String, String)]| {
        if !list.is_empty() {
            let _ = writeln!(out, "  {head}:");
        }
        for (name, text) in list {
            wrapped(&mut out, "    - ", &format!("{name}: {text}"));
        }
    };
    part("refused when", &rules);
    part("warned of", &warnings);
    part("explored in", &systems);
    part("requirements", &sources(datum, catalogue));
    out
}

/// The requirements that it implements, with their place in the manual.
fn sources(datum: &Datum, catalogue: &Catalogue) -> Vec<(String, String)> {
    let of = |id: &String| {
        let known = catalogue.requirements.iter();
        let mut known = known.filter(|r| r.id == requirement_id(id));
        let place = known.next().map(|r| format!("{}; {}", r.title, r.source));
        (id.clone(), place.unwrap_or_default())
    };
    datum.ids.iter().map(of).collect()
}

/// A parameter as JSON, with what reads it if that is wanted.
pub fn to_json(datum: &Datum, read: Option<(&Readers, &Catalogue)>) -> Value {
    let allowed = |a: &Allowed| json!({ "unit": a.units, "range": a.range, "default": a.default });
    let mut out = json!({
        "name": datum.name, "table": datum.table, "manual": datum.manual, "text": datum.text,
        "elements": datum.elements, "kinds": datum.kinds, "linear": allowed(&datum.linear),
        "rotary": allowed(datum.rotary.as_ref().unwrap_or(&datum.linear)), "requirements": datum.ids,
    });
    if let (Some((readers, catalogue)), Some(object)) = (read, out.as_object_mut()) {
        let uses = readers.of(&datum.name);
        let pairs = |list: &[(String, String)], names: [&str; 2]| -> Value {
            let one = |(a, b): &(String, String)| json!({ names[0]: a, names[1]: b });
            list.iter().map(one).collect()
        };
        let more = [
            ("functions", json!(uses.functions)),
            ("guarantees", json!(uses.patterns)),
            ("rules", pairs(&uses.rules, ["text", "fix"])),
            ("warnings", pairs(&uses.warnings, ["id", "text"])),
            ("systems", pairs(&uses.systems, ["system", "text"])),
            (
                "sources",
                pairs(&sources(datum, catalogue), ["id", "source"]),
            ),
        ];
        object.extend(more.map(|(key, value)| (key.to_owned(), value)));
    }
    out
}

fn header(table: &str) -> String {
    match table {
        "control" => table.to_owned(),
        _ => format!("{table}.NAME"),
    }
}

fn text(datum: &Datum) -> String {
    match datum.elements.is_empty() {
        true => datum.text.clone(),
        false => format!("{} (a list: {})", datum.text, datum.elements),
    }
}

/// The manual's number, `MD36930/1330`; nothing where the name in the file is the number.
fn numbers(datum: &Datum) -> Option<&str> {
    let first = datum.manual.split(' ').next()?;
    let own = first.trim_end_matches(".x");
    (!own.is_empty() && !datum.name.starts_with(own)).then_some(first)
}

fn range(datum: &Datum) -> String {
    both(datum, |a| &a.range)
}

fn default(datum: &Datum) -> String {
    both(datum, |a| &a.default)
}

/// What holds on a linear and on a rotary axis.
fn both(datum: &Datum, of: fn(&Allowed) -> &String) -> String {
    match &datum.rotary {
        Some(rotary) if of(rotary) != of(&datum.linear) => {
            format!("{} (rotary: {})", of(&datum.linear), of(rotary))
        }
        _ => of(&datum.linear).clone(),
    }
}
