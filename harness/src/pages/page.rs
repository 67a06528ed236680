//! The document of one page.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::catalogue::{Catalogue, requirement_id};
use stillpoint_lang::outline::{Machine, Outline, Property};
use stillpoint_machine::acceptance::Test;
use stillpoint_machine::reaction::{Basis, Chain, Reactions};
use stillpoint_machine::units::Dimension;
use stillpoint_machine::{self as machine, families};
use stillpoint_model::Options;
use stillpoint_show::document::{Block, Document, Inline};
use stillpoint_show::graph::{Edge, Graph};

use super::PagesError;
use super::data::{Family, Figure, Page};
use super::tables::{self, Cell, code, codes, words};
use crate::states::control_states_of;

/// What an example machine tells.
pub(super) struct Example {
    name: String,
    reactions: Option<Reactions>,
    tests: Vec<Test>,
}

impl Example {
    /// Reads the example of a family. A family without data for reaction chains or acceptance tests has none.
    pub fn load(folder: &Path, family: &Family) -> Result<Self, PagesError> {
        let path = folder.join(family.data.example.get_ref());
        let machine = machine::load(&path, &families(&path))?;
        let has = |file: &str| folder.join(file).is_file();
        let reactions = has("reaction-chain.toml").then(|| machine.reactions());
        let protocol = has("acceptance.toml").then(|| machine.acceptance());
        Ok(Self {
            reactions: reactions.transpose()?,
            tests: protocol.transpose()?.map(|p| p.tests).unwrap_or_default(),
            name: machine.name,
        })
    }
}

pub(super) fn document(
    folder: &Path,
    family: &Family,
    page: &Page,
    catalogue: &Catalogue,
    example: &Example,
) -> Result<Document, PagesError> {
    let mut blocks = vec![text(&page.text)];
    section(&mut blocks, "Enabled by", enabled(family, page));
    let parameters = page.parameters.iter().filter_map(|name| {
        let mut all = family.known.parameters.iter();
        all.find(|p| p.name == *name.get_ref())
    });
    let parameters: Vec<_> = parameters.collect();
    section(&mut blocks, "Parameters", tables::parameters(&parameters));
    let machines: Vec<&Machine> = (page.machines.iter())
        .filter_map(|name| family.machine(name.get_ref()))
        .collect();
    section(
        &mut blocks,
        "Control states",
        figures(folder, family, page)?,
    );
    for machine in &machines {
        let title = format!("Machine {}", machine.name);
        section(&mut blocks, &title, of_machine(family, machine));
    }
    vocabulary(&mut blocks, family, &machines);
    let found = properties(family, page);
    let of = |topic: Option<&str>| -> Vec<_> {
        let some = found.iter().filter(|(p, _)| p.topic.as_deref() == topic);
        some.cloned().collect()
    };
    section(
        &mut blocks,
        "Properties",
        told(
            "What `check` proves of every run, in the systems named.",
            tables::properties(&of(None)),
        ),
    );
    let mut times = told(
        "In cycles, over all runs, as explored; recorded, so that a change fails the check.",
        tables::times(&of(Some("reaction"))),
    );
    times.extend(chains(page, example));
    section(&mut blocks, "Reaction times", times);
    section(
        &mut blocks,
        "Single faults",
        told(
            "A fault in one of two channels, at any moment and for good; cycles to the answer.",
            tables::times(&of(Some("fault"))),
        ),
    );
    section(
        &mut blocks,
        "Acceptance tests",
        tests(family, page, example),
    );
    section(&mut blocks, "Monitors", monitors(page));
    section(
        &mut blocks,
        "Requirements",
        requirements(&machines, &parameters, catalogue),
    );
    Ok(Document {
        title: page.title.clone(),
        subtitle: format!(
            "{}. Made from the specification; not to be edited.",
            family.known.title
        ),
        blocks,
    })
}

fn text(text: &str) -> Block {
    Block::Paragraph(words(text))
}

/// A table under a sentence; nothing without the table.
fn told(sentence: &str, table: Option<Block>) -> Vec<Block> {
    let mut words = Vec::new();
    for (k, part) in sentence.split('`').enumerate() {
        words.push(match k % 2 {
            0 => Inline::Text(part.to_owned()),
            _ => Inline::Code(part.to_owned()),
        });
    }
    table.map_or(Vec::new(), |t| vec![Block::Paragraph(words), t])
}

/// A part of the page, if there is anything in it.
fn section(out: &mut Vec<Block>, title: &str, blocks: impl IntoIterator<Item = Block>) {
    let blocks: Vec<Block> = blocks.into_iter().collect();
    if !blocks.is_empty() {
        out.push(Block::Section {
            title: title.to_owned(),
            anchor: title.to_lowercase().replace(' ', "-"),
            blocks,
        });
    }
}

fn enabled(family: &Family, page: &Page) -> Option<Block> {
    let named = page.functions.iter().filter_map(|name| {
        let mut all = family.known.functions.iter();
        all.find(|f| f.name == *name.get_ref())
    });
    let points: Vec<Cell> = named
        .map(|f| {
            let mut point = code(&f.name);
            point.push(Inline::Text(format!(": {} (", f.text)));
            point.extend(codes(f.ids.iter().map(String::as_str)));
            point.push(Inline::Text(")".to_owned()));
            point
        })
        .collect();
    (!points.is_empty()).then_some(Block::List(points))
}

fn of_machine(family: &Family, machine: &Machine) -> Vec<Block> {
    let file = family
        .tables
        .iter()
        .find(|t| t.spec.own_machines().any(|m| m == machine.name));
    let mut about = words(&format!("{}. ", capital(&machine.text)));
    if let Some(file) = file {
        about.push(Inline::Text("It stands in ".to_owned()));
        about.extend(code(&file.file));
        about.push(Inline::Text(". ".to_owned()));
    }
    about.extend(words(match (machine.rules.is_empty(), machine.ordered) {
        (true, _) => {
            "It has no state of its own: its outputs follow from the inputs of the same cycle."
        }
        (false, true) => "In each cycle the first rule whose condition holds is taken.",
        (false, false) => "Conditions that hold together have the same effect.",
    }));
    if machine.stays && !machine.rules.is_empty() {
        about.extend(words(" Where none does, everything stays as it is."));
    }
    let mut blocks = vec![Block::Paragraph(about)];
    let parts = [
        ("Inputs", tables::ports(&machine.inputs, "default")),
        (
            "Parameters of the table",
            tables::ports(&machine.params, "default"),
        ),
        ("State", tables::ports(&machine.states, "at first")),
        ("Named expressions", tables::named(&machine.lets)),
        ("Rules", tables::rules(&machine.rules)),
        ("Outputs", tables::named(&machine.outputs)),
    ];
    for (title, table) in parts {
        if let Some(table) = table {
            blocks.push(Block::Paragraph(vec![Inline::Strong(title.to_owned())]));
            blocks.push(table);
        }
    }
    blocks
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + chars.as_str()
}

/// The control states in the systems that the page names, explored with their default parameters.
fn figures(folder: &Path, family: &Family, page: &Page) -> Result<Vec<Block>, PagesError> {
    let mut blocks = Vec::new();
    for figure in &page.diagrams {
        let Figure {
            file,
            system,
            instance,
            variables,
        } = figure.get_ref();
        let at = || format!("{}: {system}, {instance}", folder.join(file).display());
        let failed = |why: &str| PagesError::Diagram(format!("{}: {why}", at()));
        let tables = family.tables.iter().find(|t| t.file == *file);
        let tables = tables.ok_or_else(|| failed("there is no such file"))?;
        let resolved = tables.spec.system(system, None)?;
        let bound = Bound::new(resolved, &BTreeMap::new(), &BTreeMap::new())
            .map_err(|e| failed(&e.to_string()))?;
        // Of several copies of an instance the first one stands for all.
        let mut all = bound.system.instances.iter().map(|i| i.name.as_str());
        let named = all
            .find(|name| name.split('[').next() == Some(instance.as_str()))
            .ok_or_else(|| failed("there is no such instance"))?;
        let mut graph = control_states_of(&bound, named, variables.as_deref(), &Options::default())
            .map_err(|e| failed(&e.to_string()))?
            .ok_or_else(|| failed("it has none of these variables"))?;
        graph.title = format!("{} in system {system}", graph.title);
        let mut about = words("What is reached in system ");
        about.extend(code(system));
        about.push(Inline::Text(format!(
            " ({}) with its default parameters, and the rules that lead from one to the other.",
            bound.system.text
        )));
        blocks.push(Block::Paragraph(about));
        let ways = ways(&graph);
        blocks.push(Block::Graph(Box::new(graph)));
        blocks.extend(ways);
    }
    Ok(blocks)
}

/// How each state of a graph is entered, kept and left.
fn ways(graph: &Graph) -> Option<Block> {
    let state = |n: usize| graph.nodes.get(n).map_or("", |node| node.label.as_str());
    let told = |edges: Vec<&Edge>, other: fn(&Edge) -> usize| -> Cell {
        let mut cell = Vec::new();
        for edge in edges {
            if !cell.is_empty() {
                cell.push(Inline::Text("\n".to_owned()));
            }
            cell.extend(code(state(other(edge))));
            cell.extend(words(&format!(": {}", edge.labels.join(", "))));
        }
        cell
    };
    let rows = (0..graph.nodes.len()).map(|n| {
        let of = |wanted: fn(&Edge, usize) -> bool| -> Vec<&Edge> {
            graph.edges.iter().filter(|e| wanted(e, n)).collect()
        };
        let stays = of(|e, n| e.from == n && e.to == n);
        let stays: Vec<&str> = stays
            .iter()
            .flat_map(|e| &e.labels)
            .map(String::as_str)
            .collect();
        let mut name = code(state(n));
        if !graph.nodes[n].reached {
            name.extend(words(" (not reached)"));
        }
        vec![
            name,
            told(of(|e, n| e.to == n && e.from != n), |e| e.from),
            words(&stays.join(", ")),
            told(of(|e, n| e.from == n && e.to != n), |e| e.to),
        ]
    });
    tables::table(
        &["state", "entered from, by", "kept by", "left to, by"],
        rows.collect(),
    )
}

/// Functions, enums and readings that the expressions of the page's machines use.
fn vocabulary(blocks: &mut Vec<Block>, family: &Family, machines: &[&Machine]) {
    let mut known = Outline::default();
    for tables in &family.tables {
        let outline = &tables.outline;
        add(&mut known.enums, &outline.enums, |e| &e.name);
        add(&mut known.functions, &outline.functions, |f| &f.name);
        add(&mut known.readings, &outline.readings, |r| &r.id);
    }
    let mut used = BTreeSet::new();
    for machine in machines {
        used.extend(tables::identifiers(machine, &known));
    }
    let functions: Vec<_> = (known.functions.iter())
        .filter(|f| used.contains(&f.name))
        .collect();
    section(blocks, "Functions", tables::functions(&functions));
    let enums = known.enums.iter().filter(|e| used.contains(&e.name));
    let rows = enums.map(|e| {
        vec![
            code(&e.name),
            codes(e.values.iter().map(String::as_str)),
            words(&e.text),
        ]
    });
    let table = tables::table(&["type", "values, rising", "what it is"], rows.collect());
    section(blocks, "Types", table);
    let readings = (known.readings.iter()).filter(|r| r.options.iter().any(|o| used.contains(o)));
    let rows = readings.map(|r| {
        vec![
            code(&r.id),
            words(&r.text),
            codes(r.options.iter().map(String::as_str)),
            words(&r.note),
        ]
    });
    let heads = ["id", "question", "options", "note"];
    let sentence = "Where the manual can be read in two ways; the first option is the recommended one. `check --readings all` tells what depends on them.";
    section(
        blocks,
        "Readings",
        told(sentence, tables::table(&heads, rows.collect())),
    );
}

/// Adds what is not there yet: files include the same ones.
fn add<T: Clone>(to: &mut Vec<T>, from: &[T], name: fn(&T) -> &String) {
    for one in from {
        if !to.iter().any(|known| name(known) == name(one)) {
            to.push(one.clone());
        }
    }
}

/// The properties of the page, each once, with the systems in which it stands.
fn properties<'a>(family: &'a Family, page: &Page) -> Vec<(&'a Property, Vec<String>)> {
    let mut out: Vec<(&Property, Vec<String>)> = Vec::new();
    for (_, system) in family.systems() {
        for property in &system.properties {
            let mut ids = property.req.iter().chain([&property.id]);
            if !ids.any(|id| page.carries(&family.data.prefix, id)) {
                continue;
            }
            let same = |(p, _): &&mut (&Property, Vec<String>)| {
                p.id == property.id && p.text == property.text
            };
            match out.iter_mut().find(same) {
                Some((_, systems)) => systems.push(system.name.clone()),
                None => out.push((property, vec![system.name.clone()])),
            }
        }
    }
    out
}

/// The reaction chains of the example, the first one of each beginning that the page names.
fn chains(page: &Page, example: &Example) -> Vec<Block> {
    let Some(reactions) = &example.reactions else {
        return Vec::new();
    };
    let named = page.chains.iter().filter_map(|beginning| {
        let mut all = reactions.chains.iter();
        all.find(|c| c.name.starts_with(beginning.as_str()))
    });
    let mut blocks = Vec::new();
    for chain in named {
        let sentence = format!(
            "The chain `{}` of axis `{}` of `{}`: {}. `stillpoint reaction` makes it for any machine.",
            chain.name, chain.axis, example.name, chain.title
        );
        blocks.extend(told(&sentence, chain_table(reactions, chain)));
    }
    blocks
}

fn chain_table(reactions: &Reactions, chain: &Chain) -> Option<Block> {
    let rows = chain.steps.iter().map(|step| {
        let stage = reactions.stages.get(step.stage).map_or("", String::as_str);
        let basis = match (&step.property, step.basis) {
            (Some(claim), _) => format!("explored: {}", claim.id),
            (None, Basis::Manual) => "manual".to_owned(),
            (None, Basis::Computed) => "computed".to_owned(),
            (None, Basis::Measured) => "to be measured".to_owned(),
        };
        let time = step.time.map(|t| Dimension::Time.show(t));
        vec![
            words(stage),
            words(&step.text),
            code(&step.formula),
            words(&time.unwrap_or_default()),
            words(&basis),
            codes(step.id.iter().map(String::as_str)),
        ]
    });
    let heads = [
        "stage",
        "what takes the time",
        "formula",
        "at most",
        "basis",
        "requirements",
    ];
    tables::table(&heads, rows.collect())
}

/// The acceptance tests of the example that belong to the page, for the first axis that has any.
fn tests(family: &Family, page: &Page, example: &Example) -> Vec<Block> {
    let of_page = |test: &&Test| {
        let mut ids = test.req.iter();
        ids.any(|id| page.carries(&family.data.prefix, id))
    };
    let found: Vec<&Test> = example.tests.iter().filter(of_page).collect();
    let axis = found.iter().find_map(|t| t.axis.as_ref());
    let shown = found
        .iter()
        .filter(|t| t.axis.is_none() || t.axis.as_ref() == axis);
    let rows = shown.map(|test| {
        let expected: Vec<&str> = test.expect.iter().map(|e| e.text.as_str()).collect();
        vec![
            code(&test.id),
            words(&test.title),
            words(&test.steps.join("\n")),
            words(&expected.join("\n")),
            codes(test.req.iter().map(String::as_str)),
        ]
    });
    let sentence = format!(
        "As for the machine `{}`{}. `stillpoint acceptance` makes the protocol of any machine.",
        example.name,
        axis.map_or(String::new(), |a| format!(", axis `{a}`"))
    );
    let heads = [
        "test",
        "what is tested",
        "steps",
        "what must be seen",
        "requirements",
    ];
    told(&sentence, tables::table(&heads, rows.collect()))
}

fn monitors(page: &Page) -> Vec<Block> {
    let mut about = words("The same behaviour as code, written separately: ");
    about.extend(codes(page.monitors.iter().map(|m| m.get_ref().as_str())));
    about.extend(words(". "));
    about.extend(code("stillpoint diff"));
    about.extend(words(" compares both in every reachable pair of states."));
    vec![Block::Paragraph(about)]
}

/// What the manual asks for, of the ids that the page's machines and parameters name.
fn requirements(
    machines: &[&Machine],
    parameters: &[&machine::data::Datum],
    catalogue: &Catalogue,
) -> Vec<Block> {
    let mut named: BTreeSet<&String> = parameters.iter().flat_map(|p| &p.ids).collect();
    for machine in machines {
        named.extend(machine.rules.iter().flat_map(|r| &r.ids));
        named.extend(
            machine
                .lets
                .iter()
                .chain(&machine.outputs)
                .flat_map(|n| &n.ids),
        );
        let ports = [&machine.params, &machine.inputs, &machine.states];
        named.extend(ports.into_iter().flatten().flat_map(|p| &p.ids));
    }
    let named: BTreeSet<&str> = named.into_iter().map(|n| requirement_id(n)).collect();
    let listed = catalogue
        .requirements
        .iter()
        .filter(|r| named.contains(r.id.as_str()));
    let rows = listed.map(|r| vec![code(&r.id), words(&r.title), words(&r.source)]);
    let sentence = "Of the catalogue, with the place in the manual; named by the tables above.";
    told(
        sentence,
        tables::table(&["id", "title", "source"], rows.collect()),
    )
}
