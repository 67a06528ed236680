//! The requirement catalogues of the repository load, and what is wrong with a catalogue is said.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use stillpoint_lang::catalogue::{self, Scope};

const FAMILIES: [&str; 5] = [
    "heidenhain-fs",
    "iec-61800-5-2",
    "sinamics-s120",
    "sinumerik-840d",
    "srm-fblocks",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../families")
}

/// Lines of a family's catalogues that read `key = 'value'`, in either kind of quotes.
fn lines(family: &str, key: &str, value: &str) -> usize {
    let wanted = [format!("{key} = \"{value}\""), format!("{key} = '{value}'")];
    let mut count = 0;
    for entry in fs::read_dir(root().join(family)).expect(family) {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.starts_with("requirements") {
            let text = fs::read_to_string(&path).expect("a catalogue");
            count += text
                .lines()
                .filter(|l| wanted.iter().any(|w| w == l))
                .count();
        }
    }
    count
}

#[test]
fn all_catalogues_load_and_nothing_is_lost() {
    let catalogue = catalogue::load(&root()).unwrap_or_else(|e| panic!("{e}"));
    let mut counts: BTreeMap<(&str, Scope), usize> = BTreeMap::new();
    for one in &catalogue.requirements {
        *counts.entry((one.family.as_str(), one.scope)).or_default() += 1;
        assert!(!one.title.is_empty() && !one.text.is_empty(), "{}", one.id);
    }
    let scopes = [
        ("core", Scope::Core),
        ("support", Scope::Support),
        ("hardware", Scope::Hardware),
    ];
    for family in FAMILIES {
        for (word, scope) in scopes {
            let counted = counts.get(&(family, scope)).copied().unwrap_or(0);
            assert_eq!(counted, lines(family, "scope", word), "{family} {word}");
        }
    }
    assert_eq!(catalogue.requirements.len(), 2467);
    assert_eq!(catalogue.manuals.len(), FAMILIES.len());
    let merged = catalogue
        .requirements
        .iter()
        .filter(|r| r.merged_into.is_some())
        .count();
    assert_eq!(merged, 83);
}

#[test]
fn a_known_requirement_is_read_as_it_stands() {
    let catalogue = catalogue::load(&root()).unwrap_or_else(|e| panic!("{e}"));
    let one = catalogue
        .requirements
        .iter()
        .find(|r| r.id == "S840D-PARAM-506")
        .expect("it");
    assert_eq!(one.family, "sinumerik-840d");
    assert_eq!(one.title, "SE limits plausibility");
    assert_eq!(one.scope, Scope::Core);
    assert!(one.source.starts_with("SI0306; 5.6 lines 3704-3719"));
    assert_eq!(catalogue.manuals["SI0306"].edition, "03.06");
}

/// A folder tree with one family of these two files.
fn tree(name: &str, requirements: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let family = root.join("family");
    fs::create_dir_all(&family).expect("a folder");
    let manual = "[manual.M]\ntitle = \"t\"\nedition = \"e\"\nlines = 9\nnote = \"n\"\n";
    fs::write(family.join("manual.toml"), manual).expect("written");
    fs::write(family.join("requirements.toml"), requirements).expect("written");
    root
}

fn entry(id: &str, rest: &str) -> String {
    format!(
        "[[requirement]]\nid = \"{id}\"\ntitle = \"t\"\ntext = \"x\"\nkind = \"state\"\nscope = \"core\"\n{rest}\n"
    )
}

#[test]
fn errors_name_the_place() {
    let good = "source = \"M; 1\"";
    let cases = [
        (
            "twice",
            entry("A", good) + &entry("A", good),
            "requirements.toml:9:6: the id A is used twice",
        ),
        (
            "manual",
            entry("A", "source = \"N; 1\""),
            "requirements.toml:7:10: the source cites the unknown manual 'N'",
        ),
        (
            "merged",
            entry("A", "source = \"M; 1\"\nmerged_into = \"B\""),
            "requirements.toml:8:15: merged into the unknown requirement 'B'",
        ),
        (
            "scope",
            entry("A", good).replace("core", "cor"),
            "unknown variant `cor`",
        ),
        (
            "key",
            entry("A", "source = \"M; 1\"\nsauce = \"\""),
            "requirements.toml:8:1: unknown field `sauce`",
        ),
        ("missing", entry("A", ""), "missing field `source`"),
    ];
    for (name, text, message) in cases {
        let error = catalogue::load(&tree(name, &text))
            .expect_err(name)
            .to_string();
        assert!(error.contains(message), "{name}: {error}");
    }
    let none = catalogue::load(&root().join("no-such-folder")).expect_err("no folder");
    assert!(
        none.to_string().contains("cannot list this folder"),
        "{none}"
    );
}
