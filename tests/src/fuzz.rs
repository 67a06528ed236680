//! What fuzzers drive: one target for every kind of text or bytes that a user can hand over, and one for the monitors.
//!
//! A target takes any bytes. It panics where its property is broken; else it tells whether the bytes were accepted. The
//! coverage-guided fuzzer of `harness/fuzz` runs a target for hours, the test `fuzz` each of them for a moment.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::browse::http::Head;
use stillpoint_harness::diff::product::Product;
use stillpoint_harness::diff::{Pairing, bytes, pairings, peer};
use stillpoint_harness::recording::csv::{self, Columns};
use stillpoint_harness::recording::{Recording, Signal, Target as Machinery, ndjson};
use stillpoint_harness::simulate::{self, Scenario};
use stillpoint_lang::Spec;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_lang::syntax::{parse_decl, parse_effect, parse_expr, parse_type};
use stillpoint_logic::spf::{self, Interface, Mode, Output};
use stillpoint_logic::st::{Signature, compile};
use stillpoint_logic::stl;
use stillpoint_machine::{self as machine, Machine, families};

use crate::random::Random;
use crate::{drive, files, root, telegram};

/// What a fuzzer drives.
pub struct Target {
    /// The name of the file in `harness/fuzz/fuzz_targets`.
    pub name: &'static str,
    /// What it drives.
    pub component: &'static str,
    /// What must be true of every input.
    pub property: &'static str,
    /// Inputs to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Whether the bytes are accepted.
    pub run: fn(&[u8]) -> bool,
}

/// Every target.
pub static TARGETS: [Target; 13] = [
    Target {
        name: "certificate",
        component: "`stillpoint certify`",
        property: "altered bytes are refused: a certificate is confirmed only as it was written",
        seeds: || read(&[stored()]),
        run: certificate,
    },
    Target {
        name: "differential",
        component: "monitors and tables of the milling machine",
        property: "both sides give the same outputs in every cycle",
        seeds: || (0..=255).map(|k| vec![k; 40]).collect(),
        run: differential,
    },
    Target {
        name: "drive",
        component: "a drive of SINAMICS S120 at its F host, by telegrams of any bits, too short ones, and none",
        property: "each answer is one that the manual allows: STO at once, SS1 and a missing host in their times, what is deselected ends, no event that nobody acknowledges, limits and window kept or told",
        seeds: drive::seeds,
        run: drive::drive,
    },
    Target {
        name: "expression",
        component: "Structured Text of tables and machine files",
        property: "an expression, effect, type or declaration, or an error whose place lies in the text",
        seeds: || {
            let texts = [
                "a + 2 * b MOD 3 >= LIMIT(0, c[i + 1], 9) AND NOT (d = e)",
                "IF x > 0 THEN y := MIN(x, 3); ELSIF z THEN y := 0; ELSE y := -x; END_IF",
                "ARRAY[0..3] OF INT(-5..n * 2)",
                "speed : INT(0..v_max)",
                "SEL(a, b, ABS(c)) <> MAX(1, 2, 3) OR FORALL i IN 0..2 : on[i]",
            ];
            texts.map(|t| t.as_bytes().to_vec()).to_vec()
        },
        run: expression,
    },
    Target {
        name: "machine",
        component: "machine files",
        property: "a machine, or errors whose places lie in the text",
        seeds: || {
            let folders = [
                "spec/machines",
                "tests/machines",
                "tests/plausible",
                "tests/bad-input",
            ];
            read(&folders.map(|f| files(f, "toml")).concat())
        },
        run: machine,
    },
    Target {
        name: "program",
        component: "programs of a safe PLC in Structured Text",
        property: "a table that takes the place of the family's example, or errors whose places lie in the text",
        seeds: || read(&files("tests/machines", "st")),
        run: program,
    },
    Target {
        name: "recording",
        component: "recordings to be replayed, NDJSON and CSV",
        property: "a recording, which is the same when it is written and read again, or an error whose place lies in the text",
        seeds: recordings,
        run: recording,
    },
    Target {
        name: "request",
        component: "requests to the page of `stillpoint explore`",
        property: "a head, refused, or not yet whole; what follows a head does not change it",
        seeds: || {
            let texts = [
                "GET / HTTP/1.1\r\nHost: 127.0.0.1:8080\r\n\r\n",
                "POST /api HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\nContent-Length: 2\r\nContent-Type: application/json\r\n\r\n{}",
                "POST /x?y#z HTTP/1.1\r\nHost: a\r\nHost: b\r\nExpect: 100-continue\r\nTransfer-Encoding: chunked\r\n\r\n",
            ];
            texts.map(|t| t.as_bytes().to_vec()).to_vec()
        },
        run: request,
    },
    Target {
        name: "safe_logic",
        component: "the safe logic of a SINUMERIK 840D, SAFE.SPF",
        property: "a program, which is the same when it is shown and read again, with a table; or errors whose places lie in the text",
        seeds: || read(&files("tests/corpus/sinumerik-840d/safe-spf", "spf")),
        run: safe_logic,
    },
    Target {
        name: "scenario",
        component: "scenarios of `stillpoint simulate`",
        property: "a scenario of the milling machine, or errors whose places lie in the text",
        seeds: || read(&files("spec/scenarios", "toml")),
        run: scenario,
    },
    Target {
        name: "specification",
        component: "specification files",
        property: "a specification, or errors whose places lie in the text",
        seeds: || {
            let mut all = files("tests/must-fail", "toml");
            all.push(root().join("tests/certified/forms.toml"));
            read(&all)
        },
        run: specification,
    },
    Target {
        name: "statement_list",
        component: "the safe logic of a SINUMERIK 840D in the PLC, statement lists",
        property: "a program with a table; or errors whose places lie in the text",
        seeds: || read(&files("tests/corpus/sinumerik-840d/stl", "stl")),
        run: statement_list,
    },
    Target {
        name: "telegram",
        component: "telegrams of SINAMICS S120, received and sent",
        property: "a telegram whose fields are the bits that the manual prints, and the same when it is written; or refused for its length or a position that no drive sends",
        seeds: telegram::seeds,
        run: telegram::telegram,
    },
];

/// Runs the target of this name.
///
/// # Panics
/// If its property is broken, or there is none of this name.
pub fn run(name: &str, data: &[u8]) -> bool {
    let target = TARGETS.iter().find(|target| target.name == name);
    (target.unwrap_or_else(|| panic!("no target {name}")).run)(data)
}

fn read(paths: &[PathBuf]) -> Vec<Vec<u8>> {
    let text = |path: &PathBuf| std::fs::read(path).unwrap_or_else(|e| panic!("{path:?}: {e}"));
    paths.iter().map(text).collect()
}

fn milling_file() -> PathBuf {
    root().join("spec/machines/milling-840d.toml")
}

static MILLING: LazyLock<(Machine, Vec<Signal>)> = LazyLock::new(|| with_signals(&milling_file()));

/// A machine that runs as a whole, with the signals of another family.
static CENTRE: LazyLock<(Machine, Vec<Signal>)> =
    LazyLock::new(|| with_signals(&root().join("spec/machines/machining-centre-heidenhain.toml")));

fn with_signals(path: &Path) -> (Machine, Vec<Signal>) {
    let machine = machine::load(path, &families(path)).unwrap_or_else(|e| panic!("{e}"));
    let signals = simulate::signals(&machine);
    (machine, signals)
}

/// A text of valid UTF-8; else nothing is driven, since all readers refuse it alike.
fn text(data: &[u8]) -> Option<Arc<str>> {
    std::str::from_utf8(data).ok().map(Arc::from)
}

/// Accepted, or refused as a user can use it: every error has a message, can be shown, and marks a place of its text.
fn judged<T>(result: Result<T, Diagnostics>) -> bool {
    let Err(Diagnostics(found)) = result else {
        return true;
    };
    assert!(!found.is_empty(), "refused without an error");
    for error in found {
        assert!(!error.message.is_empty(), "an error without a message");
        if let Some(span) = &error.span {
            assert!(
                error.source.get(span.clone()).is_some(),
                "a place outside the text: {span:?}"
            );
        }
        assert!(!Diagnostics(vec![error]).to_string().is_empty());
    }
    false
}

fn stored() -> PathBuf {
    root().join("tests/certified/forms.cert")
}

fn certificate(data: &[u8]) -> bool {
    static STORED: LazyLock<Vec<u8>> = LazyLock::new(|| read(&[stored()]).concat());
    let spec = root().join("tests/certified/forms.toml");
    let confirmed = stillpoint_certify::certify_bytes(data, Some(&spec), 1).is_ok();
    assert!(!confirmed || data == STORED.as_slice());
    confirmed
}

fn differential(data: &[u8]) -> bool {
    static PAIRINGS: LazyLock<Vec<Pairing>> = LazyLock::new(|| {
        let subject =
            subject::load(&milling_file(), &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
        pairings(&subject).unwrap_or_else(|e| panic!("{e}"))
    });
    let Some((machine, run)) = data.split_first() else {
        return false;
    };
    let pairing = &PAIRINGS[usize::from(*machine) % PAIRINGS.len()];
    let monitor = peer::peer(&pairing.machine, &pairing.bound, None)
        .unwrap_or_else(|e| panic!("{e}"))
        .unwrap_or_else(|| panic!("machine `{}` has no monitor", pairing.machine));
    let product = Product::new(&pairing.bound, monitor.as_ref()).unwrap_or_else(|e| panic!("{e}"));
    if let Some(found) = bytes::run(&product, pairing.bound.inputs.len(), run) {
        let diagram = product.diagram(&found.start, &found.cycles).text();
        panic!("{}\n{diagram}", pairing.machine);
    }
    true
}

fn expression(data: &[u8]) -> bool {
    let Some(text) = text(data) else {
        return false;
    };
    let results = [
        parse_expr(&text).map(drop),
        parse_effect(&text).map(drop),
        parse_type(&text).map(drop),
        parse_decl(&text).map(drop),
    ];
    for error in results.iter().filter_map(|r| r.as_ref().err()) {
        assert!(text.get(error.span.clone()).is_some(), "{:?}", error.span);
        assert!(!error.message.is_empty());
    }
    results.iter().any(Result::is_ok)
}

fn machine(data: &[u8]) -> bool {
    let path = milling_file();
    judged(machine::load_bytes(&path, data.to_vec(), &families(&path)))
}

fn program(data: &[u8]) -> bool {
    static PLC: LazyLock<(Spec, Signature)> = LazyLock::new(|| {
        let path = root().join("spec/families/heidenhain-fs/splc.toml");
        let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
        let signature = Signature::of(&spec, "splc").unwrap_or_else(|e| panic!("{e}"));
        (spec, signature)
    });
    let Some(source) = text(data) else {
        return false;
    };
    let (spec, signature) = &*PLC;
    let compiled = compile("fuzzed.st", &source, signature);
    if let Ok(compiled) = &compiled {
        let mut spec = spec.clone();
        let name = toml::Spanned::new(0..0, "splc".to_owned());
        spec.replace("fuzzed.st", &source, &name, &compiled.machine)
            .and_then(|()| spec.open_machine("splc").map(drop))
            .unwrap_or_else(|e| panic!("accepted, and no table: {e}"));
    }
    judged(compiled)
}

fn safe_logic(data: &[u8]) -> bool {
    static SPL: LazyLock<Spec> = LazyLock::new(|| {
        let text = "spec = \"fuzzed\"\n[machine.spl]\ntext = \"t\"\notherwise = \"stay\"\n[machine.spl.output]\np = \"FALSE\"\n";
        Spec::from_text("spl.toml".as_ref(), Arc::from(text)).unwrap_or_else(|e| panic!("{e}"))
    });
    let Some(source) = text(data) else {
        return false;
    };
    let mut accepted = false;
    for mode in [Mode::Strict, Mode::Listing] {
        let read = spf::parse("fuzzed.spf", &source, mode);
        if let Ok(program) = &read {
            let shown: Arc<str> = Arc::from(program.to_string());
            if !program.is_fragment() {
                let again = spf::parse("again.spf", &shown, Mode::Strict);
                let again = again.unwrap_or_else(|e| panic!("{e}\n{shown}"));
                assert_eq!(again.to_string(), *shown);
            }
            let written = program.variables().into_iter().find(|used| used.writes);
            let variable = written.map(|used| used.variable);
            let variable = variable.filter(|v| v.to_string().starts_with("OUTS"));
            let interface = Interface {
                signature: Signature::of(&SPL, "spl").unwrap_or_else(|e| panic!("{e}")),
                inputs: Vec::new(),
                outputs: vec![(
                    "p".to_owned(),
                    variable.map_or(Output::Constant(true), |variable| Output::Variable {
                        variable,
                        inverted: false,
                    }),
                )],
                scan: None,
                readings: spf::Readings::default(),
            };
            let compiled = program.compile(&interface);
            if let Ok(compiled) = &compiled {
                let mut spec = SPL.clone();
                let name = toml::Spanned::new(0..0, "spl".to_owned());
                spec.replace("fuzzed.spf", &source, &name, &compiled.machine)
                    .and_then(|()| spec.open_machine("spl").map(drop))
                    .unwrap_or_else(|e| panic!("accepted, and no table: {e}"));
            }
            accepted |= judged(compiled);
        }
        accepted |= judged(read);
    }
    accepted
}

fn statement_list(data: &[u8]) -> bool {
    static SPL: LazyLock<Spec> = LazyLock::new(|| {
        let text = "spec = \"fuzzed\"\n[machine.spl]\ntext = \"t\"\notherwise = \"stay\"\n[machine.spl.output]\np = \"FALSE\"\n";
        Spec::from_text("spl.toml".as_ref(), Arc::from(text)).unwrap_or_else(|e| panic!("{e}"))
    });
    let Some(source) = text(data) else {
        return false;
    };
    let read = stl::parse("fuzzed.stl", &source);
    let Ok(program) = &read else {
        return judged(read);
    };
    let written = program.bits().into_iter().find(|used| used.writes);
    let output = written.map_or(stl::Output::Constant(true), |used| stl::Output::Bit {
        bit: used.bit,
        inverted: false,
    });
    let interface = stl::Interface {
        signature: Signature::of(&SPL, "spl").unwrap_or_else(|e| panic!("{e}")),
        inputs: Vec::new(),
        outputs: vec![("p".to_owned(), output)],
        scan: None,
    };
    let compiled = program.compile(&interface);
    if let Ok(compiled) = &compiled {
        let mut spec = SPL.clone();
        let name = toml::Spanned::new(0..0, "spl".to_owned());
        spec.replace("fuzzed.stl", &source, &name, &compiled.machine)
            .and_then(|()| spec.open_machine("spl").map(drop))
            .unwrap_or_else(|e| panic!("accepted, and no table: {e}"));
    }
    judged(compiled)
}

/// Short runs of both machines, in both formats.
fn recordings() -> Vec<Vec<u8>> {
    let runs = [
        (&MILLING.0, "encoder-freeze.toml"),
        (&CENTRE.0, "heidenhain-fs/emergency-stop.toml"),
    ];
    let both = runs.map(|(machine, scenario)| {
        let path = root().join("spec/scenarios").join(scenario);
        let scenario = Scenario::load(&path, machine).unwrap_or_else(|e| panic!("{e}"));
        let simulation = simulate::run(machine, &scenario).unwrap_or_else(|e| panic!("{e}"));
        let mut short = simulation.recording;
        short.rows.truncate(20);
        let written = |write: fn(&Recording, &mut dyn std::io::Write) -> std::io::Result<()>| {
            let mut bytes = Vec::new();
            write(&short, &mut bytes).expect("written to memory");
            bytes
        };
        [written(ndjson::write), written(csv::write)]
    });
    both.concat()
}

/// The recording of a machine, of whichever it is one.
fn recording(data: &[u8]) -> bool {
    let Some(text) = text(data) else {
        return false;
    };
    let read = [&*MILLING, &*CENTRE].map(|of| recording_of(&text, of));
    read.contains(&true)
}

fn recording_of(text: &Arc<str>, (machine, signals): &(Machine, Vec<Signal>)) -> bool {
    let target = Machinery {
        machine: &machine.name,
        cycle_us: u64::try_from(machine.monitoring_cycle).unwrap_or(0),
        signals,
    };
    let result = if text.starts_with('{') {
        ndjson::read("fuzzed", text, &target)
    } else {
        csv::read("fuzzed", text, &Columns::by_name(text, &target), &target)
    };
    if let Ok(recording) = &result {
        let mut bytes = Vec::new();
        ndjson::write(recording, &mut bytes).expect("written to memory");
        let again = Arc::from(String::from_utf8(bytes).expect("UTF-8"));
        let again = ndjson::read("again", &again, &target).unwrap_or_else(|e| panic!("{e}"));
        let differs =
            (again.rows.iter().zip(&recording.rows).enumerate()).find_map(|(row, (new, old))| {
                let cell = new.iter().zip(old).position(|(new, old)| new != old)?;
                let name = &recording.signals[cell].name;
                Some(format!(
                    "{name} in row {row}: {:?} from {:?}",
                    new[cell], old[cell]
                ))
            });
        assert_eq!(differs, None, "not the same when read again");
        assert!(&again == recording, "not the same when read again");
    }
    judged(result)
}

fn request(data: &[u8]) -> bool {
    match Head::parse(data) {
        Ok(Some((head, length))) => {
            let alone = Head::parse(&data[..length]);
            assert_eq!(alone, Ok(Some((head, length))), "the body changes the head");
            true
        }
        Ok(None) => false,
        Err(refused) => {
            assert!((400..600).contains(&refused.status) && !refused.reason.is_empty());
            false
        }
    }
}

fn scenario(data: &[u8]) -> bool {
    text(data).is_some_and(|text| judged(Scenario::from_text("fuzzed", &text, &MILLING.0)))
}

fn specification(data: &[u8]) -> bool {
    // Where the seeds lie: what they use is found from there.
    let path = root().join("tests/must-fail/fuzzed.toml");
    let Some(text) = text(data) else {
        return false;
    };
    judged(Spec::from_text(Path::new(&path), text).and_then(|spec| {
        let names: Vec<String> = spec.systems().map(str::to_owned).collect();
        names
            .iter()
            .try_for_each(|name| spec.system(name, None).map(drop))
    }))
}

/// An altered input: parts of it taken out, doubled, exchanged with those of another one, bytes and numbers changed.
pub fn altered(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    const TOKENS: [&str; 16] = [
        "\"",
        "]",
        "[[",
        "{",
        "=",
        "\n",
        "\0",
        "é",
        ":=",
        "..",
        "-",
        "0",
        "99999999999999999999",
        "-9223372036854775808",
        "1e400",
        "AND",
    ];
    let any = |random: &mut Random, count: usize| (random.draw() % count.max(1) as u64) as usize;
    let part = |random: &mut Random, length: usize| {
        let start = any(random, length + 1);
        start..start + any(random, (length - start).min(60) + 1)
    };
    let mut input = seeds[any(random, seeds.len())].clone();
    for _ in 0..1 + any(random, 4) {
        let place = part(random, input.len());
        match any(random, 6) {
            0 => drop(input.drain(place)),
            1 => {
                let copy = input[place.clone()].to_vec();
                input.splice(place.end..place.end, copy);
            }
            2 => {
                let other = &seeds[any(random, seeds.len())];
                let copy = other[part(random, other.len())].to_vec();
                input.splice(place, copy);
            }
            3 => {
                let token = TOKENS[any(random, TOKENS.len())];
                input.splice(place.start..place.start, token.bytes());
            }
            4 => {
                let digit = input.iter().skip(place.start).position(u8::is_ascii_digit);
                if let Some(at) = digit {
                    let token = TOKENS[any(random, TOKENS.len())];
                    let at = place.start + at;
                    input.splice(at..=at, token.bytes());
                }
            }
            _ => {
                if let Some(byte) = input.get_mut(place.start) {
                    *byte ^= 1 << any(random, 8);
                }
            }
        }
    }
    input
}
