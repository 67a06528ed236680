//! The tables of a page: ports, rules, expressions, properties, in the words of the specification.

use std::collections::BTreeSet;

use stillpoint_lang::outline::{Function, Machine, Named, Outline, Port, Property, Rule};
use stillpoint_machine::data::Datum;
use stillpoint_show::document::{Block, Inline, Table};

/// A cell of a table.
pub(super) type Cell = Vec<Inline>;

/// A cell of words.
pub(super) fn words(text: &str) -> Cell {
    match text {
        "" => Vec::new(),
        text => vec![Inline::text(text)],
    }
}

/// A cell of code, each line on its own.
pub(super) fn code(text: &str) -> Cell {
    let mut out = Vec::new();
    for line in text.lines().map(str::trim).filter(|l| !l.is_empty()) {
        if !out.is_empty() {
            out.push(Inline::text("\n"));
        }
        out.push(Inline::code(line));
    }
    out
}

/// A list of names.
pub(super) fn codes<'a>(names: impl Iterator<Item = &'a str>) -> Cell {
    let mut out = Vec::new();
    for name in names {
        if !out.is_empty() {
            out.push(Inline::text(", "));
        }
        out.push(Inline::code(name));
    }
    out
}

/// A table; columns that are empty in every row are left out, and a table without rows is none.
pub(super) fn table(heads: &[&str], rows: Vec<Vec<Cell>>) -> Option<Block> {
    let table = Table::new(heads, rows).without_empty_columns();
    (!table.columns.is_empty()).then(|| table.into())
}

/// Requirement ids.
fn ids(ids: &[String]) -> Cell {
    codes(ids.iter().map(String::as_str))
}

/// Parameters of a machine file.
pub(super) fn parameters(data: &[&Datum]) -> Option<Block> {
    let rows = data.iter().map(|d| {
        let text = match d.elements.as_str() {
            "" => d.text.clone(),
            elements => format!("{} ({elements})", d.text),
        };
        let both = |of: fn(&stillpoint_machine::data::Allowed) -> &String| match &d.rotary {
            Some(rotary) => words(&format!("{}\nrotary: {}", of(&d.linear), of(rotary))),
            None => words(of(&d.linear)),
        };
        vec![
            code(&d.name),
            words(&d.manual),
            words(&text),
            both(|a| &a.range),
            both(|a| &a.default),
            ids(&d.ids),
        ]
    });
    let heads = [
        "parameter",
        "manual",
        "what it is",
        "range",
        "default",
        "requirements",
    ];
    table(&heads, rows.collect())
}

/// Inputs, parameters or state variables. Numbered ones that are alike stand in one row.
pub(super) fn ports(ports: &[Port], value: &str) -> Option<Block> {
    let alike = |a: &Port, b: &Port| {
        let plain =
            |text: &str| -> String { text.chars().filter(|c| !c.is_ascii_digit()).collect() };
        let numbered = a.name.ends_with(|c: char| c.is_ascii_digit());
        numbered
            && plain(&a.name) == plain(&b.name)
            && plain(&a.text) == plain(&b.text)
            && (&a.ty, &a.value, &a.ids) == (&b.ty, &b.value, &b.ids)
    };
    let rows = ports.chunk_by(alike).filter_map(|run| {
        let (first, last) = (run.first()?, run.last()?);
        let mut name = code(&first.name);
        if run.len() > 1 {
            name.push(Inline::Text(" to ".to_owned()));
            name.extend(code(&last.name));
        }
        let text = match run.len() {
            1 => first.text.clone(),
            _ => format!("{}, and so on", first.text),
        };
        Some(vec![
            name,
            code(&first.ty),
            code(first.value.as_deref().unwrap_or_default()),
            words(&text),
            ids(&first.ids),
        ])
    });
    table(
        &["name", "type", value, "what it is", "requirements"],
        rows.collect(),
    )
}

/// Named expressions or outputs.
pub(super) fn named(named: &[Named]) -> Option<Block> {
    let rows = named
        .iter()
        .map(|n| vec![code(&n.name), code(&n.value), words(&n.text), ids(&n.ids)]);
    table(
        &["name", "value", "what it is", "requirements"],
        rows.collect(),
    )
}

/// Rules.
pub(super) fn rules(rules: &[Rule]) -> Option<Block> {
    let rows = rules.iter().map(|r| {
        vec![
            code(&r.name),
            code(&r.when),
            code(&r.then),
            words(&r.note),
            ids(&r.ids),
        ]
    });
    table(
        &["rule", "when", "then", "note", "requirements"],
        rows.collect(),
    )
}

/// Functions that expressions call.
pub(super) fn functions(functions: &[&Function]) -> Option<Block> {
    let rows = functions.iter().map(|f| {
        vec![
            code(&format!("{}({})", f.name, f.args.join("; "))),
            code(&f.value),
            words(&f.text),
        ]
    });
    table(&["function", "value", "what it is"], rows.collect())
}

/// Properties, each with the systems in which it stands.
pub(super) fn properties(properties: &[(&Property, Vec<String>)]) -> Option<Block> {
    let rows = properties.iter().map(|(p, systems)| {
        let mut told = words(&p.text);
        if !p.note.is_empty() {
            told.push(Inline::Text(format!("\n({})", p.note)));
        }
        vec![
            code(&p.id),
            told,
            statement(p),
            codes(systems.iter().map(String::as_str)),
            ids(&p.req),
        ]
    });
    let heads = [
        "property",
        "in plain words",
        "as stated",
        "systems",
        "requirements",
    ];
    table(&heads, rows.collect())
}

/// The expressions of a property with their keys.
fn statement(property: &Property) -> Cell {
    let bounds = [("within", &property.within)].into_iter();
    let bounds = bounds.filter_map(|(key, v)| Some((key.to_owned(), v.clone()?)));
    let mut out = Vec::new();
    for (key, text) in property.written.iter().cloned().chain(bounds) {
        if !out.is_empty() {
            out.push(Inline::text("\n"));
        }
        out.push(Inline::Text(format!("{} ", key.replace('_', " "))));
        out.push(Inline::Code(
            text.split_whitespace().collect::<Vec<_>>().join(" "),
        ));
    }
    out
}

/// Bounded responses with the recorded figures, in cycles.
pub(super) fn times(properties: &[(&Property, Vec<String>)]) -> Option<Block> {
    let rows = properties.iter().map(|(p, systems)| {
        let expression = |e: &Option<String>| code(e.as_deref().unwrap_or_default());
        vec![
            words(&p.text),
            expression(&p.fastest),
            expression(&p.exactly),
            expression(&p.within),
            codes(systems.iter().map(String::as_str)),
            code(&p.id),
        ]
    });
    let heads = [
        "what", "fastest", "slowest", "allowed", "systems", "property",
    ];
    table(&heads, rows.collect())
}

/// The identifiers in the expressions of a machine and of the functions that it calls.
pub(super) fn identifiers(machine: &Machine, outline: &Outline) -> BTreeSet<String> {
    let named = machine
        .lets
        .iter()
        .chain(&machine.outputs)
        .map(|n| &n.value);
    let rules = machine.rules.iter().flat_map(|r| [&r.when, &r.then]);
    let ports = [&machine.params, &machine.inputs, &machine.states];
    let ports = ports.into_iter().flatten();
    let ports = ports.flat_map(|p| std::iter::once(&p.ty).chain(&p.value));
    let mut open: Vec<String> = named.chain(rules).chain(ports).cloned().collect();
    let mut out = BTreeSet::new();
    while let Some(text) = open.pop() {
        for word in text.split(|c: char| !c.is_alphanumeric() && c != '_') {
            if !word.is_empty() && out.insert(word.to_owned()) {
                let called = outline.functions.iter().filter(|f| f.name == word);
                open.extend(called.map(|f| f.value.clone()));
            }
        }
    }
    out
}
