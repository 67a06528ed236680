//! What was explored: sizes, abstractions, control states, rules.

use stillpoint_engine::Evaluator;
use stillpoint_engine::check::{By, Checked, Unfired};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_lang::cells::together;
use stillpoint_show::document::{Block, Inline, Tone};
use stillpoint_show::graph::Graph;

use super::document::{Control, code, ids, paragraph, table, words};
use super::{coarser, counted, grouped, params, reduced, reduction, storage_name, theorems};

/// One row of figures for each exploration, then its parameters and abstractions.
pub(super) fn blocks(subject: &Subject, checked: &[Checked]) -> Vec<Block> {
    let mut rows = Vec::new();
    let mut details = Vec::new();
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        let report = &done.outcome.report;
        let evaluator = match done.outcome.evaluator {
            Evaluator::Generated => "generated step",
            Evaluator::Interpreter => "interpreter",
        };
        let told = |text: String| {
            words(match reduced(done) || !done.explored() {
                true => "not told".to_owned(),
                false => text,
            })
        };
        rows.push(vec![
            words((n + 1).to_string()),
            words(&task.title),
            words(grouped(u128::from(report.states))),
            told(grouped(report.index_space)),
            words(grouped(report.transitions)),
            words(report.depth.to_string()),
            told(grouped(u128::from(report.absorbing))),
            words(match done.by {
                By::Exploration => format!("{evaluator}, {}", storage_name(report.storage)),
                By::Theorems => "theorems of the family".to_owned(),
                By::Proofs => "proof engines".to_owned(),
            }),
            vec![match report.complete {
                true => Inline::Badge(Tone::Good, "complete".to_owned()),
                false => Inline::Badge(Tone::Open, "not complete".to_owned()),
            }],
        ]);
        details.push(about(n + 1, task, done));
    }
    let heads = [
        "#run",
        "what",
        "#states",
        "#of",
        "#transitions",
        "#depth",
        "#absorbing",
        "how",
        "",
    ];
    let mut out = vec![
        table(&heads, rows),
        paragraph(
            "Transitions count every combination of inputs. Depth is the number of cycles to the farthest state; an \
             absorbing state has only itself as its successor.",
        ),
    ];
    out.extend(details);
    out
}

fn about(n: usize, task: &Task, done: &Checked) -> Block {
    let mut inside = vec![Block::Paragraph(vec![
        Inline::Text("System ".to_owned()),
        Inline::Code(task.bound.system.name.clone()),
        Inline::Text(".".to_owned()),
    ])];
    let mut points: Vec<Vec<Inline>> = Vec::new();
    let coarse = coarser(task, done).map(|item| ("Abstraction: ", item));
    // A theorem is about the tables as they are.
    let warnings = task.bound.system.warnings.iter();
    let warnings = warnings.filter(|_| done.by != By::Theorems);
    let warnings = warnings.map(|item| ("Warning: ", item.as_str()));
    points.extend(coarse.chain(warnings).map(|(kind, item)| {
        let (kind, item) = (kind.to_owned(), item.to_owned());
        vec![Inline::Strong(kind), Inline::Text(item)]
    }));
    points.extend(task.analysis.skipped.iter().map(|skipped| {
        words(format!(
            "Not analysed: guards of {skipped} read too many values"
        ))
    }));
    let cited = theorems(done);
    if !cited.is_empty() {
        points.push(words(cited));
    }
    if let Some(reduction) = &done.outcome.reduction {
        points.extend(
            reduction::lines(&task.bound, reduction)
                .into_iter()
                .map(words),
        );
    }
    if !points.is_empty() {
        inside.push(Block::List(points));
    }
    let params = together(params(&task.bound));
    let count = params.len();
    if count > 0 {
        let rows = params
            .into_iter()
            .map(|(name, value)| vec![code(name), words(value)]);
        inside.push(table(&["parameter", "#value"], rows.collect()));
    }
    let coarse = match coarser(task, done).count() as u64 {
        0 => String::new(),
        n => format!(", {}", counted(n, "abstraction")),
    };
    let count = counted(count as u64, "parameter");
    Block::Details {
        summary: words(format!("Run {n}: {count}{coarse}")),
        blocks: inside,
    }
}

/// The control states of each machine, drawn.
pub(super) fn control(subject: &Subject, drawn: &[Control]) -> Vec<Block> {
    let mut out = Vec::new();
    for (n, (task, drawn)) in subject.tasks.iter().zip(drawn).enumerate() {
        let title = match subject.tasks.len() {
            1 => task.title.clone(),
            _ => format!("Run {}: {}", n + 1, task.title),
        };
        let inside: Vec<Block> = match drawn {
            Control::Omitted(why) => vec![paragraph(format!("{title}: {why}."))],
            Control::Drawn(graphs) => pictures(graphs),
        };
        match drawn {
            Control::Omitted(_) => out.extend(inside),
            Control::Drawn(_) if inside.is_empty() => {}
            Control::Drawn(_) if subject.tasks.len() == 1 => out.extend(inside),
            Control::Drawn(graphs) => out.push(Block::Details {
                summary: words(match machines(graphs) {
                    1 => format!("{title} (1 machine)"),
                    n => format!("{title} ({n} machines)"),
                }),
                blocks: inside,
            }),
        }
    }
    if out.is_empty() {
        return out;
    }
    let about = paragraph(
        "A state of a machine is a combination of the values of its variables with names for values; where these are many, \
         each variable is drawn by itself. What is reached is drawn strong, what no run reaches pale; runs begin at the thick frame. The words at an arrow are the rules that \
         lead there.",
    );
    out.insert(0, about);
    out
}

/// How many machines these are, of which one may have several graphs.
fn machines(graphs: &[(String, Graph)]) -> usize {
    let mut names: Vec<&String> = graphs.iter().map(|(name, _)| name).collect();
    names.dedup();
    names.len()
}

/// The graphs of each machine under its name.
fn pictures(graphs: &[(String, Graph)]) -> Vec<Block> {
    let mut out = Vec::new();
    let mut before = "";
    for (name, graph) in graphs {
        if name != before {
            before = name;
            out.push(Block::Paragraph(vec![
                Inline::Text("Machine ".to_owned()),
                Inline::Strong(name.clone()),
            ]));
        }
        out.push(Block::Graph(Box::new(graph.clone())));
    }
    out
}

/// How often each rule fired, and why some never did.
pub(super) fn coverage(subject: &Subject, checked: &[Checked]) -> Vec<Block> {
    let mut out = Vec::new();
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        let title = format!("Run {}: {}", n + 1, task.title);
        let untold = match reduced(done) {
            true => Some("by a reduced exploration"),
            false => (!done.explored()).then_some("where nothing is explored"),
        };
        if let Some(why) = untold {
            out.push(paragraph(format!("{title}: not told {why}.")));
            continue;
        }
        let system = &task.bound.system;
        let mut fired = 0;
        let mut findings = 0;
        let mut rows = Vec::new();
        for (rule, count) in system.rules().zip(&done.outcome.report.coverage) {
            let why = done.unfired.iter().find(|(name, _)| *name == rule.name);
            let told = match why.map(|(_, why)| why) {
                None => Vec::new(),
                Some(Unfired::Parameters) => words("excluded by these parameters"),
                Some(Unfired::Explained(reason)) => words(reason),
                Some(Unfired::Unknown) => words("not before the limit was reached"),
                Some(Unfired::Unexplained) => {
                    findings += 1;
                    match subject.machine {
                        Some(_) => words("not with these values"),
                        None => vec![Inline::Badge(
                            Tone::Bad,
                            "finding: nothing says why".to_owned(),
                        )],
                    }
                }
            };
            fired += usize::from(*count > 0);
            rows.push(vec![
                code(&rule.name),
                words(grouped(u128::from(*count))),
                told,
                ids(&rule.ids),
            ]);
        }
        let of = rows.len();
        let summary = match findings {
            _ if subject.machine.is_some() => format!("{title}: {fired} of {of} rules fire"),
            0 => format!("{title}: {fired} of {of} rules fire"),
            n => format!("{title}: {fired} of {of} rules fire, {n} findings"),
        };
        out.push(Block::Details {
            summary: words(summary),
            blocks: vec![table(
                &["rule", "#transitions", "why not", "requirements"],
                rows,
            )],
        });
    }
    out
}
