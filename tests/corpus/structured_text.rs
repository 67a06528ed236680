//! The safe PLC program of the machining centre, written in Structured Text, is the one that stands in the tables of its machine file:
//! in every cycle of every run both give the same outputs. Programs with a mistake are found, with the line that it stands in.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use stillpoint_certify::format::Kind;
use stillpoint_certify::subject as certified;
use stillpoint_engine::check::{Settings, Summary, check, summarise};
use stillpoint_engine::lines;
use stillpoint_engine::subject::{Readings, Subject, Task};
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_logic::st::{Signature, compile};
use stillpoint_machine as machine;
use stillpoint_model::Verdict;
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

use crate::programs::{self, Programs, checked, judging};

/// The machine, and its program.
const MACHINE: &str = "tests/machines/machining-centre-st.toml";
const PROGRAM: &str = "tests/machines/machining-centre-st.st";
const TABLES: &str = "spec/machines/machining-centre-heidenhain.toml";

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn family(file: &str) -> PathBuf {
    root().join("spec/families/heidenhain-fs").join(file)
}

/// A system with the program beside that of the tables: both are told the same, and the property is that they give the same answer.
fn product(file: &str, name: &str) -> Spec {
    let table = |file: &str| {
        text(&format!("spec/families/heidenhain-fs/{file}"))
            .parse::<toml::Table>()
            .expect("TOML")
    };
    let (mut composed, splc) = (table(file), table("splc.toml"));
    let plc = &splc["machine"]["splc"];
    let names = |key: &str| {
        plc[key]
            .as_table()
            .into_iter()
            .flat_map(toml::Table::keys)
            .cloned()
            .collect::<Vec<_>>()
    };
    let system = composed["system"][name].as_table_mut().expect("a table");
    let into = |system: &mut toml::Table, part: &str, key: String, value: toml::Value| {
        let part = system
            .get_mut(part)
            .and_then(toml::Value::as_table_mut)
            .expect("a table");
        part.insert(key, value);
    };
    let instance = toml::Table::from_iter([("machine".to_owned(), "twin".into())]);
    into(system, "instance", "twin".to_owned(), instance.into());
    for input in names("input") {
        into(
            system,
            "wire",
            format!("twin.{input}"),
            format!("splc.{input}").into(),
        );
    }
    let alike = names("output").into_iter().map(|output| {
        let same = format!("splc.{output} = twin.{output}");
        let keys = [
            ("id", output),
            ("text", "both say the same".to_owned()),
            ("always", same),
        ];
        toml::Value::Table(toml::Table::from_iter(
            keys.map(|(key, value)| (key.to_owned(), toml::Value::from(value))),
        ))
    });
    system.insert("property".to_owned(), toml::Value::Array(alike.collect()));
    let logic = system.clone();
    composed.insert(
        "system".to_owned(),
        toml::Table::from_iter([(name.to_owned(), logic.into())]).into(),
    );
    let machines = composed
        .entry("machine")
        .or_insert_with(|| toml::Table::new().into());
    let machines = machines.as_table_mut().expect("a table");
    machines.insert("twin".to_owned(), plc.clone());
    let written = toml::to_string(&composed).expect("TOML");
    let mut spec =
        Spec::from_text(&family("both.toml"), Arc::from(written)).unwrap_or_else(|e| panic!("{e}"));
    let source: Arc<str> = Arc::from(text(PROGRAM));
    let compiled = Signature::of(&spec, "splc")
        .and_then(|signature| compile(PROGRAM, &source, &signature))
        .unwrap_or_else(|e| panic!("{e}"));
    let name = toml::Spanned::new(0..0, "twin".to_owned());
    spec.replace(PROGRAM, &source, &name, &compiled.machine)
        .unwrap_or_else(|e| panic!("{e}"));
    spec
}

/// Every pair of reachable states of both programs, in every cycle, in every situation of doors and keys of the panel in SOM_2.
#[test]
fn the_program_says_what_the_tables_say() {
    alike("splc.toml", "doors_and_panel", 20);
}

/// The same in every situation that the system `logic` has: modes, units, permissives, all keys, all reports of the kernel.
#[test]
#[ignore = "deep: minutes"]
fn the_program_says_in_every_situation_what_the_tables_say() {
    alike("composed.toml", "logic", 500);
}

/// Explores the product under each reading of the manual that the program depends on, and with times of one to three cycles.
fn alike(file: &str, name: &str, least: u64) {
    let spec = product(file, name);
    let readings = ["AMB-28", "AMB-52", "AMB-57", "AMB-68", "AMB-74"];
    let one = spec
        .system(name, Some(21_000))
        .unwrap_or_else(|e| panic!("{e}"));
    let options = |id: &str| {
        let reading = one
            .readings
            .iter()
            .find(|r| r.id == id)
            .unwrap_or_else(|| panic!("{id}"));
        reading.options.clone()
    };
    // Each reading alone, and the times of one to three steps.
    let mut cases = vec![
        (Readings::new(), 1),
        (Readings::new(), 2),
        (Readings::new(), 3),
    ];
    for id in readings {
        for option in options(id).into_iter().skip(1) {
            cases.push((Readings::from([(id.to_owned(), option)]), 2));
        }
    }
    for (chosen, clear) in cases {
        let system = spec
            .system(name, Some(21_000))
            .unwrap_or_else(|e| panic!("{e}"));
        let params = BTreeMap::from([("t_clear".to_owned(), vec![clear])]);
        let bound = Bound::new(system, &params, &chosen).unwrap_or_else(|e| panic!("{e}"));
        let title = format!("{name}, {chosen:?}, t_clear = {clear}");
        let mut subject = Subject {
            path: family("both.toml"),
            name: "both".to_owned(),
            title: String::new(),
            machine: None,
            tasks: vec![task(&spec, bound, title.clone())],
        };
        let done = check(&mut subject, &Settings::default(), &mut |_| Box::new(()))
            .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
        let report = &done[0].outcome.report;
        println!(
            "{title}: {} states, {} transitions",
            report.states, report.transitions
        );
        assert!(
            report.complete && report.faults.is_empty(),
            "{title}: {:?}",
            report.faults
        );
        assert_eq!(report.properties.len(), 15);
        for property in &report.properties {
            assert_eq!(property.verdict, Verdict::Holds, "{title}: {}", property.id);
        }
        assert!(report.states > least, "{title}: {}", report.states);
    }
}

fn task(spec: &Spec, bound: Bound, title: String) -> Task {
    let analysis = spec
        .analyse(&bound, &stillpoint_lang::analysis::Known::default())
        .unwrap_or_else(|e| panic!("{e}"));
    Task {
        title,
        axes: Vec::new(),
        guarantee: None,
        faults: Vec::new(),
        travel: 0,
        window: 0,
        before: 0,
        abstractions: Vec::new(),
        bound,
        analysis,
        file: family("both.toml"),
        sources: BTreeMap::new(),
        loose: None,
        loosely: false,
    }
}

/// The explorations of a machine that judge its program by the event tables.
fn library(path: &Path) -> Subject {
    let machine =
        machine::load(path, &root().join("spec/families")).unwrap_or_else(|e| panic!("{e}"));
    judging(path, machine)
}

fn judged(subject: &Subject) -> Vec<Summary> {
    summarise(subject, &checked(subject))
}

/// Every row of the event tables has the same verdict and length for the program and for the tables, and all hold.
#[test]
fn the_program_keeps_every_row_of_the_event_tables() {
    let answers = [MACHINE, TABLES].map(|file| {
        let list = judged(&library(&root().join(file))).into_iter();
        list.map(|one| (one.id, one.verdict, one.length))
            .collect::<Vec<_>>()
    });
    assert_eq!(answers[0], answers[1]);
    assert!(
        answers[0].len() >= 30
            && answers[0]
                .iter()
                .all(|(_, verdict, _)| *verdict == Verdict::Holds)
    );
}

/// The example of the book is a program: it lacks nothing but the outputs that it leaves out.
#[test]
fn the_example_of_the_book_is_read() {
    let page = text("docs/src/structured-text.md");
    let (_, rest) = page.split_once("```text\n").expect("an example");
    let (program, _) = rest.split_once("```").expect("its end");
    let spec = Spec::load(&family("splc.toml")).unwrap_or_else(|e| panic!("{e}"));
    let signature = Signature::of(&spec, "splc").unwrap_or_else(|e| panic!("{e}"));
    let Err(errors) = compile("book.st", &Arc::from(program), &signature) else {
        panic!("outputs are missing");
    };
    let told: Vec<&str> = errors.0.iter().map(|e| e.message.as_str()).collect();
    assert_eq!(
        told,
        ["program 'doors' lacks outputs that the safety kernel reads"]
    );
}

/// A certificate names the program, and one of another program is refused.
#[test]
fn a_certificate_is_about_this_program() {
    let header = |path: &Path| {
        let subject = certified::Subject::load(path, Kind::Machine, &BTreeMap::new())
            .unwrap_or_else(|e| panic!("{e}"));
        subject.header
    };
    let own = header(&root().join(MACHINE));
    let program = own
        .file
        .iter()
        .find(|f| f.name == "machining-centre-st.st")
        .expect("the program");
    let comment = [(
        "(* --- Spindle --- *)".to_owned(),
        "(* --- spindle --- *)".to_owned(),
    )];
    let other = header(&changed("another comment", &comment));
    let changed = other
        .file
        .iter()
        .find(|f| f.name == program.name)
        .expect("the program");
    assert_ne!(program.sha256, changed.sha256);
}

fn programs() -> Programs {
    Programs::of("st-mistakes.toml")
}

/// The machine with a changed program, in a folder of its own.
fn changed(title: &str, replace: &[(String, String)]) -> PathBuf {
    let program = programs::changed(title, text(PROGRAM), replace);
    let name: String = title
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("st-{name}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("machining-centre-st.st"), program).expect("written");
    let path = folder.join("machine.toml");
    std::fs::write(&path, text(MACHINE)).expect("written");
    path
}

#[test]
fn programs_with_a_mistake_are_found_with_their_line() {
    let wrong = each(&programs().mistake, |mistake| {
        let subject = mistake.asked(library(&changed(&mistake.text, &mistake.replace)));
        let done = checked(&subject);
        let missed = mistake.missed(&summarise(&subject, &done));
        if missed.is_some() {
            return missed;
        }
        let expected = mistake.line.as_ref().expect("a line");
        let named: Vec<String> = (subject.tasks.iter().zip(&done))
            .filter_map(|(task, one)| {
                let judged = &one.outcome.report.properties[0];
                Some(lines::deciding(
                    &task.bound,
                    &task.bound.system.properties[0],
                    judged.trace.as_ref()?,
                ))
            })
            .flatten()
            .map(|line| line.text)
            .collect();
        (!named.iter().any(|line| line.contains(expected)))
            .then(|| format!("{}: no line has '{expected}': {named:#?}", mistake.text))
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn programs_that_are_right_in_another_way_are_not_accused() {
    each(&programs().right, |right| {
        for one in judged(&library(&changed(&right.text, &right.replace))) {
            assert_eq!(one.verdict, Verdict::Holds, "{}: {}", right.text, one.id);
        }
    });
}
