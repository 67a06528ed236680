//! The page with everything that a machine file of a family may say.

use stillpoint_machine::data::{Allowed, Datum, FamilyData};
use stillpoint_show::document::{Block, Document, Inline, Table};

/// The name of the page.
pub(super) const NAME: &str = "machine-file.md";

/// Functions first, then the parameters of each table of the file.
pub(super) fn document(data: &FamilyData) -> Document {
    let mut blocks = Vec::new();
    if !data.functions.is_empty() {
        let rows = data.functions.iter().map(|f| {
            vec![
                vec![Inline::Code(format!("\"{}\"", f.name))],
                vec![Inline::text(&f.text)],
                vec![Inline::Text(f.ids.join(" "))],
            ]
        });
        let heads = ["in functions", "what it enables", "requirements"];
        blocks.push(section(
            "Functions of an axis",
            "functions",
            &heads,
            rows.collect(),
        ));
    }
    let tables = [
        ("control", "The control: [control]"),
        ("axis", "An axis: [axis.NAME]"),
        ("group", "An axis group: [group.NAME]"),
        ("door", "A guard door: [door.NAME]"),
    ];
    for (table, title) in tables {
        let of = data.parameters.iter().filter(|p| p.table == table);
        let rows: Vec<Vec<Vec<Inline>>> = of.map(row).collect();
        if !rows.is_empty() {
            let heads = [
                "parameter",
                "what it is",
                "allowed",
                "default",
                "the manual's name",
                "requirements",
            ];
            blocks.push(section(title, table, &heads, rows));
        }
    }
    Document {
        title: format!("Machine file: {}", data.title),
        subtitle: "Everything that a machine file of this family may say. A value that is not given has the default. \
                   Made from the family's data by stillpoint pages; not to be edited."
            .to_owned(),
        blocks,
    }
}

fn section(title: &str, anchor: &str, heads: &[&str], rows: Vec<Vec<Vec<Inline>>>) -> Block {
    Block::Section {
        title: title.to_owned(),
        anchor: anchor.to_owned(),
        blocks: vec![Table::new(heads, rows).without_empty_columns().into()],
    }
}

fn row(datum: &Datum) -> Vec<Vec<Inline>> {
    let of = |what: fn(&Allowed) -> &String| match &datum.rotary {
        None => what(&datum.linear).clone(),
        Some(rotary) if what(rotary) == what(&datum.linear) => what(rotary).clone(),
        Some(rotary) => format!("{}; rotary: {}", what(&datum.linear), what(rotary)),
    };
    let text = match datum.elements.is_empty() {
        true => datum.text.clone(),
        false => format!("{} (a list: {})", datum.text, datum.elements),
    };
    vec![
        vec![Inline::Code(datum.name.clone())],
        vec![Inline::Text(text)],
        vec![Inline::Text(of(|a| &a.range))],
        vec![Inline::Text(of(|a| &a.default))],
        vec![Inline::Text(datum.manual.clone())],
        vec![Inline::Text(datum.ids.join(" "))],
    ]
}
