//! The loader of specification files under arbitrary and damaged texts: a result or diagnostics, never a panic.
//! (Machine files: see `machine.rs`.)

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use proptest::prelude::*;
use proptest::sample::{Index, select};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_lang::{Spec, read_text};

/// A diagnostic can be shown: its place lies within the text, on character boundaries, and there is something to say.
fn showable(Diagnostics(list): &Diagnostics) {
    assert!(!list.is_empty());
    for one in list {
        assert!(!one.message.is_empty());
        if let Some(span) = &one.span {
            assert!(
                one.source.get(span.clone()).is_some(),
                "{span:?} in {}: {}",
                one.file,
                one.message
            );
            assert!(one.position().is_some());
        }
        assert!(!one.to_string().is_empty());
    }
}

/// Loads a text and resolves all its systems and own machines, as a check does.
fn load(path: &Path, text: &str, analyse: bool) {
    let spec = match Spec::from_text(path, text.into()) {
        Ok(spec) => spec,
        Err(errors) => return showable(&errors),
    };
    let systems: Vec<String> = spec.systems().map(str::to_owned).collect();
    let machines: Vec<String> = spec.own_machines().map(str::to_owned).collect();
    let resolved = systems
        .iter()
        .map(|s| spec.system(s, None))
        .chain(machines.iter().map(|m| spec.open_machine(m)));
    for system in resolved {
        match system {
            Err(errors) => showable(&errors),
            Ok(system) => match Bound::new(system, &BTreeMap::new(), &BTreeMap::new()) {
                Err(error) => assert!(!error.to_string().is_empty()),
                Ok(bound) if analyse => {
                    if let Err(errors) =
                        spec.analyse(&bound, &stillpoint_lang::analysis::Known::default())
                    {
                        showable(&errors);
                    }
                }
                Ok(_) => {}
            },
        }
    }
}

/// Shipped specification files and must-fail files, with their texts.
fn corpus() -> &'static [(PathBuf, String)] {
    static CORPUS: OnceLock<Vec<(PathBuf, String)>> = OnceLock::new();
    CORPUS.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut out = Vec::new();
        for folder in ["families/sinumerik-840d", "bench", "../tests/must-fail"] {
            for entry in std::fs::read_dir(root.join(folder)).expect("the folder") {
                let path = entry.expect("an entry").path();
                let text = std::fs::read_to_string(&path).unwrap_or_default();
                if text.lines().any(|l| l.starts_with("spec ")) {
                    out.push((path, text));
                }
            }
        }
        out.sort();
        assert!(out.len() >= 15, "{} files", out.len());
        out
    })
}

const FRAGMENTS: [&str; 34] = [
    "",
    " ",
    "\n",
    "\"",
    "'",
    "[",
    "]",
    "[[",
    "{",
    "}",
    "(",
    ")",
    "=",
    ":=",
    ";",
    ",",
    ".",
    "..",
    "-",
    "NOT ",
    "AND ",
    "PREV(",
    "MAX(",
    "[i]",
    "T#18446744073709551.999ms",
    "9223372036854775807",
    "-9223372036854775808",
    "ARRAY[0..4095] OF ",
    "INT(0..2147483647)",
    "TRUE",
    "\u{fffd}ä",
    "\\u0041",
    "(*",
    "count = 64\n",
];

/// Word-like pieces of a text: (start, end).
fn words(text: &str) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        let inside = c.is_alphanumeric() || c == '_';
        match (start, inside) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                out.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    out
}

/// One damage to a text.
#[derive(Debug, Clone)]
enum Damage {
    Byte(Index, u8),
    Delete(Index, usize),
    Duplicate(Index, usize, Index),
    Insert(Index, &'static str),
    Swap(Index, Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        (any::<Index>(), any::<u8>()).prop_map(|(at, b)| Damage::Byte(at, b)),
        (any::<Index>(), 1_usize..60).prop_map(|(at, n)| Damage::Delete(at, n)),
        (any::<Index>(), 1_usize..300, any::<Index>())
            .prop_map(|(at, n, to)| Damage::Duplicate(at, n, to)),
        (any::<Index>(), select(FRAGMENTS.to_vec())).prop_map(|(at, f)| Damage::Insert(at, f)),
        (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Damage::Swap(a, b)),
    ]
}

fn apply(text: &str, damage: &Damage) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let len = bytes.len().max(1);
    let cut = |at: usize, n: usize| at.min(text.len())..(at + n).min(text.len());
    match damage {
        Damage::Byte(at, b) => {
            if let Some(byte) = bytes.get_mut(at.index(len)) {
                *byte = *b;
            }
        }
        Damage::Delete(at, n) => {
            bytes.drain(cut(at.index(len), *n));
        }
        Damage::Duplicate(at, n, to) => {
            let piece = bytes[cut(at.index(len), *n)].to_vec();
            let to = to.index(len).min(bytes.len());
            bytes.splice(to..to, piece);
        }
        Damage::Insert(at, fragment) => {
            let at = at.index(len).min(bytes.len());
            bytes.splice(at..at, fragment.bytes());
        }
        Damage::Swap(a, b) => {
            let list = words(text);
            if !list.is_empty() {
                let (a, b) = (list[a.index(list.len())], list[b.index(list.len())]);
                let (a, b) = (a.min(b), a.max(b));
                if a.1 <= b.0 {
                    return [
                        &text[..a.0],
                        &text[b.0..b.1],
                        &text[a.1..b.0],
                        &text[a.0..a.1],
                        &text[b.1..],
                    ]
                    .concat();
                }
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn any_text(text in any::<String>()) {
        load(Path::new("t.toml"), &text, true);
        load(Path::new("t.toml"), &format!("spec = \"t\"\n{text}"), true);
    }

    /// Arbitrary expressions and effects in a sound file.
    #[test]
    fn any_expression(parts in prop::collection::vec(
        select(vec!["x", "y", "m", "1", "0", "(", ")", "[", "]", ",", ";", ":=", "=", "<", "+", "-", "*", "/", "MOD", "AND", "OR",
            "NOT", "IF", "THEN", "ELSE", "END_IF", "PREV", "MAX", "SEL", "MUX", "ORD", "T#1ms", "TRUE", "Level#A", "A", "f",
            "FORALL", "j", "IN", ".", "#", "9223372036854775807", "ABS"]), 0..24), place in 0..4_usize)
    {
        let mut slots = ["x = 1".to_owned(), "x := 1;".to_owned(), "x > 0".to_owned(), "x + v".to_owned()];
        slots[place] = parts.join(" ");
        let [when, then, always, value] = slots;
        load(Path::new("t.toml"), &format!("spec = \"t\"\n[enum.Level]\nvalues = [\"A\", \"B\"]\n[function.f]\nargs = [\"v : INT\"]\nvalue = \"{value}\"\n[machine.m]\ntext = \"m\"\notherwise = \"stay\"\n[machine.m.state]\nx = {{ type = \"INT(0..9)\", init = 0 }}\ny = {{ type = \"ARRAY[0..3] OF Level\", init = \"A\" }}\n[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"{when}\"\nthen = \"{then}\"\n[system.s]\ntext = \"s\"\n[system.s.instance]\nm = {{ machine = \"m\", count = 2 }}\n[[system.s.property]]\nid = \"P\"\ntext = \"p\"\nalways = \"{always}\"\n"), true);
    }

    #[test]
    fn damaged_files(which in any::<Index>(), list in prop::collection::vec(damage(), 1..6)) {
        let (path, text) = &corpus()[which.index(corpus().len())];
        let damaged = list.iter().fold(text.clone(), |text, one| apply(&text, one));
        // The guards of the shipped machines are many; the small files are analysed as well.
        load(path, &damaged, path.components().any(|c| c.as_os_str() == "must-fail"));
    }
}

/// Bytes reach the loader through a file.
#[test]
fn any_bytes() {
    let path = std::env::temp_dir().join(format!("stillpoint-fuzz-{}.toml", std::process::id()));
    let mut seed = 1_u64;
    for n in 0..200 {
        let bytes: Vec<u8> = (0..n)
            .map(|_| {
                seed = seed
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (seed >> 56) as u8
            })
            .collect();
        std::fs::write(&path, bytes).expect("a file");
        match read_text(&path, "specification file") {
            Ok(text) => load(&path, &text, true),
            Err(errors) => showable(&errors),
        }
    }
    std::fs::remove_file(&path).expect("the file goes");
}

/// Texts that are small, and large when they are expanded: they are refused, or cost little.
#[test]
fn small_texts_with_large_meaning() {
    let file = |functions: &str, when: &str| {
        format!(
            "spec = \"t\"\n{functions}[machine.m]\ntext = \"m\"\notherwise = \"stay\"\n[machine.m.state]\nx = {{ type = \"INT(0..9)\", init = 0 }}\n[[machine.m.rule]]\nname = \"r\"\nnote = \"n\"\nwhen = \"{when}\"\nthen = \"x := 1;\"\n[system.s]\ntext = \"s\"\n[system.s.instance]\nm = {{ machine = \"m\" }}\n"
        )
    };
    let nested = |open: &str, middle: &str, close: &str| {
        file(
            "",
            &format!("{}{middle}{} = 1", open.repeat(50), close.repeat(50)),
        )
    };
    let doubling: String = (0..60)
        .map(|k| {
            format!(
                "[function.f{}]\nargs = [\"v : INT\"]\nvalue = \"f{k}(v) + f{k}(v)\"\n",
                k + 1
            )
        })
        .collect();
    let texts = [
        nested("MAX(", "x", ", 1)"),
        nested("MAX(", "nosuch", ", 1)"),
        nested("SEL(x = 1, ", "nosuch", ", 1)"),
        nested("(", "nosuch", " = 1)"),
        file(
            &format!("[function.f0]\nargs = [\"v : INT\"]\nvalue = \"v\"\n{doubling}"),
            "f60(x) = 1",
        ),
        file(
            "[function.d]\nargs = [\"v : INT\"]\nvalue = \"MAX(v, v)\"\n",
            &format!("{}x{} = 1", "d(".repeat(50), ")".repeat(50)),
        ),
    ];
    let (sender, receiver) = std::sync::mpsc::channel();
    for (k, text) in texts.into_iter().enumerate() {
        let sender = sender.clone();
        std::thread::spawn(move || {
            load(Path::new("t.toml"), &text, true);
            sender.send(k).expect("the test waits");
        });
    }
    drop(sender);
    let done: Vec<usize> = (0..6)
        .map_while(|_| {
            receiver
                .recv_timeout(std::time::Duration::from_secs(60))
                .ok()
        })
        .collect();
    assert_eq!(done.len(), 6, "only {done:?} came to an end");
}
