//! The chains as a document.

use stillpoint_engine::check::Checked;
use stillpoint_engine::subject::Subject;
use stillpoint_engine::verdict_name;
use stillpoint_machine::Machine;
use stillpoint_show::document::{Block, Document, Inline, Table, Tone};

use super::{Judged, Proof, Result, basis, cycles, time};
use crate::report::grouped;

/// The document of all chains.
pub fn document(
    judged: &Judged,
    machine: &Machine,
    subject: &Subject,
    checked: &[Checked],
) -> Document {
    let mut blocks = vec![verdict(judged, checked), overview(judged, machine)];
    for axis in &machine.axes {
        let of = judged.results.iter();
        let of = of.filter(|r| r.chain.axis == axis.name);
        let chains: Vec<Block> = of.map(|r| chain(judged, machine, r)).collect();
        if !chains.is_empty() {
            blocks.push(Block::Section {
                title: format!("Axis {}", axis.name),
                anchor: format!("axis-{}", axis.name.to_lowercase()),
                blocks: chains,
            });
        }
    }
    blocks.push(explored(subject, checked));
    blocks.push(sources(judged));
    let notes = judged.reactions.notes.iter().map(|n| vec![Inline::text(n)]);
    blocks.push(Block::Section {
        title: "What these figures are".to_owned(),
        anchor: "notes".to_owned(),
        blocks: vec![
            Block::List(notes.collect()),
            Block::Paragraph(vec![Inline::text(format!(
                "Manual: {}.",
                judged.reactions.source
            ))]),
        ],
    });
    Document {
        title: format!("Reaction times of {}", machine.name),
        subtitle: format!(
            "{}; {}; monitoring cycle {}",
            machine.title,
            machine.family_title,
            time(machine.monitoring_cycle.into())
        ),
        blocks,
    }
}

fn verdict(judged: &Judged, checked: &[Checked]) -> Block {
    let counts = judged.results.iter().map(Judged::proven);
    let (proven, all) = counts.fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
    let (tone, head) = match judged.exit_status(checked) {
        0 => (Tone::Good, "Every explored bound holds"),
        3 => (
            Tone::Open,
            "A limit was reached before everything was explored",
        ),
        _ => (Tone::Bad, "The exploration contradicts a reaction time"),
    };
    let text = format!(
        "{proven} of {all} summands of {} chains are proven: the slowest case of a property, explored with this machine's times, fits them. The others come from parameters or from the manual, as their rows say; coasting has to be measured.",
        judged.results.len()
    );
    Block::Verdict {
        tone,
        head: head.to_owned(),
        text: vec![Inline::Text(text)],
    }
}

fn overview(judged: &Judged, machine: &Machine) -> Block {
    let mut columns = ["Axis", "What", "#Stop requested after"]
        .map(str::to_owned)
        .to_vec();
    for outcome in &judged.reactions.outcomes {
        columns.push(format!("#{}", outcome.title));
        columns.push("#over-travel".to_owned());
    }
    columns.push("#Proven".to_owned());
    let rows = judged.results.iter().map(|result| {
        let chain = &result.chain;
        let requested = Judged::until(result, judged.reactions.accelerates);
        let mut row = vec![
            vec![Inline::text(&chain.axis)],
            vec![Inline::Link {
                text: chain.name.clone(),
                to: format!("#{}", anchor(result)),
            }],
            vec![Inline::Text(time(requested))],
        ];
        for end in &result.ends {
            let more = if end.open { " +" } else { "" };
            let over = result.way(end);
            row.push(vec![Inline::Text(format!("{}{more}", time(end.time)))]);
            row.push(vec![Inline::Text(format!("{over}{more}"))]);
        }
        let (proven, all) = Judged::proven(result);
        row.push(vec![Inline::Text(format!("{proven} of {all}"))]);
        row
    });
    let table = Table::new(&columns, rows).captioned("Longest times from the violation, and the way meanwhile; +: coasting follows, to be measured");
    let meaning = judged.reactions.outcomes.iter();
    let meaning = meaning.map(|o| {
        vec![
            Inline::Strong(o.title.clone()),
            Inline::text(format!(": {}.", o.text)),
        ]
    });
    Block::Section {
        title: "Overview".to_owned(),
        anchor: "overview".to_owned(),
        blocks: vec![
            Block::List(meaning.collect()),
            Block::Table(table),
            Block::Paragraph(vec![Inline::Text(format!(
                "One monitoring cycle is {}. Times count from the moment the limit is passed, or the sensor changes.",
                time(machine.monitoring_cycle.into())
            ))]),
        ],
    }
}

fn anchor(result: &Result) -> String {
    let name = format!("{}-{}", result.chain.axis, result.chain.name).to_lowercase();
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    name.chars().map(plain).collect()
}

fn chain(judged: &Judged, machine: &Machine, result: &Result) -> Block {
    let chain = &result.chain;
    let dimensions = chain.kind.dimensions();
    let mut rows = Vec::new();
    let mut stage = usize::MAX;
    for (step, proof) in chain.steps.iter().zip(&result.proofs) {
        let title = match judged.reactions.stages.get(step.stage) {
            Some(title) if step.stage != stage => vec![Inline::text(title)],
            _ => Vec::new(),
        };
        stage = step.stage;
        let (long, short) = match step.time {
            Some(us) => (time(us.into()), cycles(us.into(), machine.monitoring_cycle)),
            None => ("to be measured".to_owned(), String::new()),
        };
        let mut formula = Vec::new();
        if step.time != Some(0) && !step.formula.is_empty() {
            formula.push(Inline::Code(step.formula.clone()));
        }
        let values = step.values.iter();
        let values: Vec<String> = values.map(|(name, v)| format!("{name} = {v}")).collect();
        if !values.is_empty() {
            formula.push(Inline::Text(format!(" {}", values.join(", "))));
        }
        rows.push(vec![
            title,
            vec![Inline::text(&step.text)],
            formula,
            vec![Inline::Text(long)],
            vec![Inline::Text(short)],
            grounds(step.basis, proof, step.property.as_ref()),
            vec![Inline::Code(step.id.join(" "))],
        ]);
    }
    let columns = [
        "Stage",
        "Summand",
        "Formula",
        "#At most",
        "#Cycles",
        "Basis",
        "Requirement",
    ];
    let mut speed = format!("Over-travel at {} ({})", result.speed(), result.speed_text);
    if result.motion.acceleration != 0 {
        let a = dimensions.acceleration.show(result.motion.acceleration);
        speed.push_str(&format!(", accelerating by {a} until the stop works"));
    }
    let ends = judged.reactions.outcomes.iter().zip(&result.ends);
    let ends = ends.map(|(outcome, end)| {
        let more = if end.open {
            ", then coasting, to be measured"
        } else {
            ""
        };
        vec![
            Inline::Strong(format!("{}: ", outcome.title)),
            Inline::Text(format!(
                "{} ({} cycles), over-travel {}{more}",
                time(end.time),
                cycles(end.time, machine.monitoring_cycle),
                result.way(end)
            )),
        ]
    });
    Block::Section {
        title: format!("{}: {}", chain.name, chain.title),
        anchor: anchor(result),
        blocks: vec![
            Block::table(&columns, rows),
            Block::Paragraph(vec![Inline::Text(format!("{speed}:"))]),
            Block::List(ends.collect()),
        ],
    }
}

fn grounds(
    of: stillpoint_machine::reaction::Basis,
    proof: &Proof,
    claim: Option<&stillpoint_machine::reaction::Claim>,
) -> Vec<Inline> {
    let tone = match proof {
        Proof::Proven(_) => Tone::Good,
        Proof::Refuted(_) => Tone::Bad,
        Proof::None | Proof::Open(_) => Tone::Plain,
    };
    let mut cell = vec![Inline::Badge(tone, basis(of, proof).to_owned())];
    let Some(claim) = claim else {
        return cell;
    };
    cell.push(Inline::text(" "));
    cell.push(Inline::Code(claim.id.clone()));
    cell.push(Inline::Text(match proof {
        Proof::Proven(us) if claim.spans > 1 => {
            format!(
                ": slowest case {} for {} summands together",
                time(*us),
                claim.spans
            )
        }
        Proof::Proven(us) => format!(": slowest case {}", time(*us)),
        Proof::Refuted(why) | Proof::Open(why) => format!(": {why}"),
        Proof::None => String::new(),
    }));
    cell
}

/// Where the manual says what the summands count on.
fn sources(judged: &Judged) -> Block {
    let rows = judged
        .sources
        .iter()
        .map(|(id, source)| vec![vec![Inline::Code(id.clone())], vec![Inline::text(source)]]);
    Block::Section {
        title: "Places in the manual".to_owned(),
        anchor: "sources".to_owned(),
        blocks: vec![Block::table(&["Requirement", "Place"], rows)],
    }
}

fn explored(subject: &Subject, checked: &[Checked]) -> Block {
    let mut rows = Vec::new();
    for (task, done) in subject.tasks.iter().zip(checked) {
        let properties = task.bound.system.properties.iter();
        for (property, judged) in properties.zip(&done.outcome.report.properties) {
            let cell = |s: String| vec![Inline::Text(s)];
            rows.push(vec![
                cell(super::short(&task.bound.system.name).to_owned()),
                cell(task.axes.join(", ")),
                cell(grouped(u128::from(done.outcome.report.states))),
                vec![Inline::Code(property.id.clone())],
                cell(property.text.clone()),
                cell(verdict_name(judged.verdict).to_owned()),
                cell(judged.bound.map_or(String::new(), |n| n.to_string())),
            ]);
        }
    }
    let columns = [
        "System",
        "Axes",
        "#States",
        "Property",
        "In words",
        "Verdict",
        "#Slowest case, cycles of the system",
    ];
    Block::Section {
        title: "What was explored".to_owned(),
        anchor: "explored".to_owned(),
        blocks: vec![
            Table::new(&columns, rows)
                .captioned("All reachable states of each system, with the times of the axes named")
                .into(),
        ],
    }
}
