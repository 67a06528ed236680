//! The protocol as a document to be printed, filled in and signed.

use stillpoint_machine::acceptance::{Protocol, Test};
use stillpoint_machine::units::Dimension;
use stillpoint_machine::{Machine, Shown};
use stillpoint_show::document::{Block, Document, Inline, Tone};

use super::results::results;
use super::{Checksums, Decided, Ran, Since, expected, guaranteed, latest, selected};

/// The protocol of a machine; with `since` only what has to be repeated.
pub fn document(
    machine: &Machine,
    protocol: &Protocol,
    checksums: &Checksums,
    since: Option<&Since>,
    ran: Option<&[Ran]>,
    decided: Option<&Decided>,
) -> Document {
    let tests = selected(protocol, since);
    let mut blocks = Vec::new();
    if let Some(since) = since {
        blocks.extend(changed(protocol, since));
    }
    let simulated = ran.map(|ran| results(ran, &tests));
    let (verdict, results) = simulated.unzip();
    blocks.extend(verdict);
    blocks.push(identity(machine, protocol, checksums));
    blocks.push(configuration(machine, protocol));
    blocks.extend(guaranteed::section(machine, decided));
    blocks.push(list(&tests));
    blocks.push(points("Before the tests", "before", &protocol.before));
    for (k, part) in protocol.parts.iter().enumerate() {
        let of: Vec<&&Test> = tests.iter().filter(|t| t.part == k).collect();
        if of.is_empty() {
            continue;
        }
        let mut inner = Vec::new();
        if !part.text.is_empty() {
            inner.push(Block::Paragraph(vec![Inline::text(&part.text)]));
        }
        inner.extend(of.iter().map(|test| one(machine, test)));
        blocks.push(Block::Section {
            title: part.title.clone(),
            anchor: part.name.clone(),
            blocks: inner,
        });
    }
    blocks.push(points("Completion", "completion", &protocol.after));
    blocks.push(signatures(protocol));
    blocks.push(measures(protocol));
    blocks.extend(results);
    Document {
        title: match since {
            Some(_) => format!("Partial acceptance test of {}", machine.name),
            None => format!("Acceptance test of {}", machine.name),
        },
        subtitle: format!("{}; {}", machine.title, machine.family_title),
        blocks,
    }
}

/// Points with a place for a tick.
fn points(title: &str, anchor: &str, list: &[String]) -> Block {
    let rows = list
        .iter()
        .map(|p| vec![vec![Inline::text(p)], vec![Inline::Blank(6)]]);
    Block::Section {
        title: title.to_owned(),
        anchor: anchor.to_owned(),
        blocks: vec![Block::table(&["What", "Done"], rows)],
    }
}

fn identity(machine: &Machine, protocol: &Protocol, checksums: &Checksums) -> Block {
    let row = |name: &str, value: Inline| vec![vec![Inline::text(name)], vec![value]];
    let mut rows = vec![
        row("Machine", Inline::text(&machine.name)),
        row("Configuration", Inline::Code(checksums.file.clone())),
        row(
            "SHA-256 of the configuration",
            Inline::Code(checksums.machine.clone()),
        ),
        row(
            "SHA-256 of the family's data and specifications",
            Inline::Code(checksums.family.clone()),
        ),
        row(
            "Made by",
            Inline::text(concat!("Stillpoint ", env!("CARGO_PKG_VERSION"))),
        ),
        row(
            "Monitoring cycle",
            Inline::Text(time(machine.monitoring_cycle)),
        ),
        row("Follows", Inline::text(&protocol.source)),
    ];
    for record in &protocol.records {
        rows.push(row(record, Inline::Blank(24)));
    }
    Block::Section {
        title: "Machine".to_owned(),
        anchor: "machine".to_owned(),
        blocks: vec![
            Block::Paragraph(vec![Inline::text(
                "This protocol belongs to exactly this configuration: a changed file has another checksum and needs a new protocol. It is a template, not a certificate; an authorised person carries out and judges the tests.",
            )]),
            Block::table(&["Item", "Value"], rows),
        ],
    }
}

fn configuration(machine: &Machine, protocol: &Protocol) -> Block {
    let mut rows = Vec::new();
    for axis in &machine.axes {
        let functions = axis.functions.iter();
        let functions = functions.map(|f| format!("{f} ({})", machine.function_text(f)));
        let functions: Vec<String> = functions.collect();
        let functions = match functions.is_empty() {
            true => "none".to_owned(),
            false => functions.join("; "),
        };
        let mut row = vec![
            vec![Inline::Strong(axis.name.clone())],
            vec![Inline::text(&axis.title)],
        ];
        if machine.has_functions() {
            row.push(vec![Inline::Text(functions)]);
        }
        row.extend(
            protocol
                .axis_records
                .iter()
                .map(|_| vec![Inline::Blank(12)]),
        );
        rows.push(row);
    }
    let mut heads = vec!["Axis", "What it is"];
    if machine.has_functions() {
        heads.push("Functions");
    }
    heads.extend(protocol.axis_records.iter().map(String::as_str));
    let mut blocks = vec![Block::table(&heads, rows)];
    blocks.push(details("Control", &machine.control_shown()));
    for axis in &machine.axes {
        blocks.push(details(
            &format!("Axis {}", axis.name),
            &machine.axis_shown(axis),
        ));
    }
    for group in &machine.axis_groups {
        let names: Vec<&str> = group.axes.iter().map(|a| a.get_ref().as_str()).collect();
        blocks.push(details(
            &format!("Group {} of {}", group.name, names.join(", ")),
            &machine.group_shown(group),
        ));
    }
    for door in &machine.doors {
        blocks.push(details(
            &format!("Door {}", door.name),
            &machine.door_shown(door),
        ));
    }
    Block::Section {
        title: "Configuration".to_owned(),
        anchor: "configuration".to_owned(),
        blocks,
    }
}

fn details(title: &str, values: &[Shown]) -> Block {
    let rows = values.iter().map(|v| {
        vec![
            vec![Inline::Code(v.name.clone())],
            vec![Inline::text(&v.value)],
            vec![Inline::text(if v.given { "" } else { "default" })],
            vec![Inline::text(&v.text)],
            vec![Inline::text(&v.manual)],
        ]
    });
    let heads = ["Parameter", "Value", "", "What it is", "Machine data"];
    Block::Details {
        summary: vec![Inline::text(format!("{title}: all values"))],
        blocks: vec![Block::table(&heads, rows)],
    }
}

fn list(tests: &[&Test]) -> Block {
    let rows = tests.iter().map(|test| {
        vec![
            vec![Inline::Link {
                text: test.id.clone(),
                to: format!("#{}", anchor(&test.id)),
            }],
            vec![Inline::text(&test.title)],
            vec![Inline::Blank(6)],
            vec![Inline::Blank(10)],
        ]
    });
    Block::Section {
        title: format!("{} tests", tests.len()),
        anchor: "tests".to_owned(),
        blocks: vec![Block::table(
            &["Test", "What is tested", "Passed", "Date, initials"],
            rows,
        )],
    }
}

pub(super) fn anchor(id: &str) -> String {
    let plain = |c: char| match c {
        '+' => "plus".to_owned(),
        c if c.is_ascii_alphanumeric() || c == '-' => c.to_ascii_lowercase().to_string(),
        _ => "-".to_owned(),
    };
    let name: String = id.chars().map(plain).collect();
    format!("test-{name}")
}

fn one(machine: &Machine, test: &Test) -> Block {
    let cycle = machine.monitoring_cycle;
    let bullets =
        |list: &[String]| Block::List(list.iter().map(|t| vec![Inline::text(t)]).collect());
    let mut blocks = Vec::new();
    if !test.requires.is_empty() {
        blocks.push(Block::Paragraph(vec![Inline::Strong("Before".to_owned())]));
        blocks.push(bullets(&test.requires));
    }
    let steps = test.steps.iter().enumerate().map(|(k, step)| {
        let number = Inline::Text((k + 1).to_string());
        vec![
            vec![number],
            vec![Inline::text(step)],
            vec![Inline::Blank(5)],
        ]
    });
    let heads = ["#", "Step", "Done"];
    blocks.push(Block::table(&heads, steps));
    let rows = test.expect.iter().map(|e| {
        let (time, cycles) = match latest(e, cycle) {
            Some((us, cycles)) => (self::time(us), cycles.to_string()),
            None => (String::new(), String::new()),
        };
        vec![
            vec![Inline::text(&e.text)],
            vec![Inline::Text(time)],
            vec![Inline::Text(cycles)],
            match e.formula.is_empty() {
                true => Vec::new(),
                false => vec![Inline::Code(e.formula.clone())],
            },
            vec![Inline::Text(
                e.after.map_or(String::new(), |_| e.tolerance.to_string()),
            )],
            vec![Inline::Blank(10)],
            vec![Inline::Blank(5)],
        ]
    });
    let heads = [
        "Expected",
        "#At the latest after",
        "#Cycles",
        "computed from",
        "#of them tolerance",
        "Measured",
        "OK",
    ];
    blocks.push(Block::table(&heads, rows));
    if let Some(diagram) = expected(test, cycle) {
        blocks.push(Block::Details {
            summary: vec![Inline::text(
                "Expected trace, each change at the latest cycle",
            )],
            blocks: vec![Block::Timing(Box::new(diagram))],
        });
    }
    if !test.measure.is_empty() {
        let rows = test.measure.iter().map(|m| {
            let limit = if m.limit.is_empty() {
                "machine builder"
            } else {
                &m.limit
            };
            vec![
                vec![Inline::text(&m.text)],
                vec![Inline::text(limit)],
                vec![Inline::Blank(12), Inline::Text(format!(" {}", m.unit))],
                vec![Inline::Blank(5)],
            ]
        });
        let heads = ["To be measured", "Limit", "Value", "OK"];
        blocks.push(Block::table(&heads, rows));
    }
    let mut end = vec![
        Inline::Strong("Passed".to_owned()),
        Inline::text(" "),
        Inline::Blank(5),
        Inline::text("  Alarms "),
        Inline::Blank(24),
        Inline::text("  Date, initials "),
        Inline::Blank(14),
    ];
    if !test.req.is_empty() {
        end.push(Inline::Text(format!("  ({})", test.req.join(", "))));
    }
    blocks.push(Block::Paragraph(end));
    Block::Section {
        title: format!("{}: {}", test.id, test.title),
        anchor: anchor(&test.id),
        blocks,
    }
}

fn signatures(protocol: &Protocol) -> Block {
    let rows = protocol.signatures.iter().map(|who| {
        vec![
            vec![Inline::text(who)],
            vec![Inline::Blank(20)],
            vec![Inline::Blank(12)],
            vec![Inline::Blank(20)],
        ]
    });
    Block::Section {
        title: "Signatures".to_owned(),
        anchor: "signatures".to_owned(),
        blocks: vec![Block::table(&["Who", "Name", "Date", "Signature"], rows)],
    }
}

fn measures(protocol: &Protocol) -> Block {
    let mut rows = protocol.measures.iter();
    let heads = rows.next().cloned().unwrap_or_default();
    let rows = rows.map(|row| row.iter().map(|cell| vec![Inline::text(cell)]).collect());
    Block::Section {
        title: "After a later change".to_owned(),
        anchor: "measures".to_owned(),
        blocks: vec![Block::table(&heads, rows)],
    }
}

/// What changed and what follows from it.
fn changed(protocol: &Protocol, since: &Since) -> Vec<Block> {
    let (tone, head) = match since.repeat.len() {
        0 => (Tone::Good, "No test has to be repeated".to_owned()),
        1 => (Tone::Open, "1 test has to be repeated".to_owned()),
        n => (Tone::Open, format!("{n} tests have to be repeated")),
    };
    let about = format!(
        "{} values changed; the full protocol has {} tests.",
        since.changes.len(),
        protocol.tests.len()
    );
    let rows = since.changes.iter().map(|c| {
        let mut row = vec![
            vec![Inline::text(&c.of)],
            vec![Inline::Code(c.name.clone())],
            vec![Inline::text(&c.old)],
            vec![Inline::text(&c.new)],
        ];
        if !since.untested.is_empty() {
            let why = since.untested.iter().find(|(u, _)| u == c);
            row.push(vec![Inline::text(why.map_or("", |(_, why)| why))]);
        }
        row
    });
    let mut heads = vec!["Of", "What", "Before", "Now"];
    if !since.untested.is_empty() {
        heads.push("No test, because");
    }
    let mut blocks = vec![
        Block::Verdict {
            tone,
            head,
            text: vec![Inline::Text(about)],
        },
        Block::Section {
            title: "What changed".to_owned(),
            anchor: "changes".to_owned(),
            blocks: vec![Block::table(&heads, rows)],
        },
    ];
    let rows = since.repeat.iter().map(|r| {
        vec![
            vec![Inline::Link {
                text: r.id.clone(),
                to: format!("#{}", anchor(&r.id)),
            }],
            vec![Inline::Text(r.reasons.join("; "))],
        ]
    });
    let mut inner = vec![Block::table(&["Test", "Reason"], rows)];
    if !since.gone.is_empty() {
        let gone = format!("No longer there: {}.", since.gone.join(", "));
        inner.push(Block::Paragraph(vec![Inline::Text(gone)]));
    }
    blocks.push(Block::Section {
        title: "To be repeated".to_owned(),
        anchor: "repeat".to_owned(),
        blocks: inner,
    });
    blocks
}

fn time(us: i64) -> String {
    Dimension::Time.show(us)
}
