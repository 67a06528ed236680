//! Cases as they are written, and what a runner reads of them.

use serde::Deserialize;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// From what is given to what is answered; an error tells what of the case cannot be run.
pub type Runner = fn(&Given<'_>) -> Result<Table, String>;

/// A number, or several, that the manual prints in one place.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Unique in the family.
    pub id: String,
    /// Lines of the manual: `2555` or `2555-2560`, several after commas.
    pub lines: String,
    /// What the place is.
    pub kind: Kind,
    /// What is printed there, in our words.
    pub says: String,
    /// What the case is evidence for.
    pub requirements: Vec<String>,
    /// The runner.
    pub run: String,
    /// What the runner reads.
    pub given: Table,
    /// What it must answer.
    pub expect: Table,
    /// The reading under which the number holds.
    #[serde(default)]
    pub reading: Option<String>,
    /// Lines of the place that is followed where this one is not, and why.
    #[serde(default)]
    pub contradicts: Option<String>,
    /// The keys of `given` that stand in the case itself, not at the head of its file.
    #[serde(skip)]
    pub own: Vec<String>,
    /// The file it stands in.
    #[serde(skip)]
    pub file: String,
}

/// What a place of the manual is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A worked example.
    Example,
    /// A row of a table.
    Table,
    /// A formula.
    Formula,
    /// A figure or timing diagram.
    Figure,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    /// What is given to every case of the file that does not give it itself.
    #[serde(default)]
    given: Table,
    case: Vec<Case>,
}

impl Case {
    /// One case.
    pub fn parse(file: &str, text: &str) -> Self {
        let mut case: Self = toml::from_str(text).unwrap_or_else(|e| panic!("{file}: {e}"));
        file.clone_into(&mut case.file);
        case.own = case.given.keys().cloned().collect();
        case
    }

    /// File, id and lines, for messages.
    pub fn place(&self) -> String {
        format!("{} {} (lines {})", self.file, self.id, self.lines)
    }

    /// What is wrong with the case as it is written.
    pub fn faults(&self, last_line: usize) -> Option<String> {
        let line = |text: &str| text.trim().parse::<usize>().ok();
        let range = |part: &str| match part.split_once('-') {
            Some((from, to)) => {
                line(from) < line(to) && line(from).is_some() && line(to) <= Some(last_line)
            }
            None => line(part).is_some_and(|n| n > 0 && n <= last_line),
        };
        if !self.lines.split(',').all(range) {
            return Some(format!(
                "the lines are not of a manual of {last_line} lines"
            ));
        }
        let reading = |text: &String| text.starts_with("A-") || text.starts_with("AMB-");
        if !self.reading.as_ref().is_none_or(reading) {
            return Some(
                "a reading has the name of an ambiguity of the digest, A-07 or AMB-07".to_owned(),
            );
        }
        if self.contradicts.as_ref().is_some_and(String::is_empty) {
            return Some("contradicts: which lines are followed instead, and why?".to_owned());
        }
        (self.expect.is_empty() || self.says.is_empty()).then(|| "nothing is expected".to_owned())
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The last line of the text of a family's manual, by which a mistyped line is seen.
pub fn last_line(family: &str) -> usize {
    let path = root()
        .join("spec/families")
        .join(family)
        .join("manual.toml");
    let text = std::fs::read_to_string(path).expect("the manual of the family");
    let table: Table = toml::from_str(&text).expect("TOML");
    let manuals = table["manual"].as_table().expect("manuals by their keys");
    let lines = manuals.values().map(|manual| manual["lines"].as_integer());
    let most = lines.map(|n| usize::try_from(n.expect("a number")).expect("a line"));
    most.max().expect("a manual")
}

/// All cases of a family.
pub fn load(family: &str) -> Vec<Case> {
    let folder = root().join("tests/corpus").join(family);
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .expect("the folder of the family")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no case of {family}");
    let last_line = last_line(family);
    let known: BTreeSet<String> = stillpoint_lang::catalogue::load(&root().join("spec/families"))
        .expect("the catalogues")
        .requirements
        .into_iter()
        .map(|requirement| requirement.id)
        .collect();
    let mut cases = Vec::new();
    for path in files {
        let name = path
            .file_name()
            .and_then(|n| n.to_str())
            .unwrap_or("")
            .to_owned();
        let text = std::fs::read_to_string(&path).expect("readable");
        let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for mut case in file.case {
            case.file.clone_from(&name);
            case.own = case.given.keys().cloned().collect();
            for (key, value) in &file.given {
                case.given
                    .entry(key.clone())
                    .or_insert_with(|| value.clone());
            }
            if let Some(fault) = case.faults(last_line) {
                panic!("{}: {fault}", case.place());
            }
            for id in &case.requirements {
                assert!(
                    known.contains(id.split('/').next().unwrap_or(id)),
                    "{}: no requirement {id}",
                    case.place()
                );
            }
            cases.push(case);
        }
    }
    cases
}

/// What a runner reads; remembers what was read.
pub struct Given<'a> {
    table: &'a Table,
    read: RefCell<BTreeSet<String>>,
}

// Runners differ in what they need of this.
#[allow(dead_code)]
impl<'a> Given<'a> {
    pub fn new(table: &'a Table) -> Self {
        Self {
            table,
            read: RefCell::default(),
        }
    }

    /// The value, if it is given.
    pub fn get(&self, key: &str) -> Option<&'a Value> {
        self.read.borrow_mut().insert(key.to_owned());
        self.table.get(key)
    }

    fn need<T>(&self, key: &str, what: &str, value: Option<T>) -> Result<T, String> {
        let _ = self.get(key);
        value.ok_or_else(|| format!("given {key}: {what} is needed"))
    }

    /// An integer.
    pub fn int(&self, key: &str) -> Result<i64, String> {
        self.need(key, "an integer", self.get(key).and_then(Value::as_integer))
    }

    /// An integer, or this one where none is given.
    pub fn int_or(&self, key: &str, default: i64) -> Result<i64, String> {
        self.get(key).map_or(Ok(default), |_| self.int(key))
    }

    /// A truth value, `false` where none is given.
    pub fn flag(&self, key: &str) -> Result<bool, String> {
        match self.get(key) {
            None => Ok(false),
            Some(value) => self.need(key, "true or false", value.as_bool()),
        }
    }

    /// A text.
    pub fn text(&self, key: &str) -> Result<&'a str, String> {
        self.need(key, "a text", self.get(key).and_then(Value::as_str))
    }

    /// A list of texts; empty where none is given.
    pub fn texts(&self, key: &str) -> Result<Vec<&'a str>, String> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let list = value
            .as_array()
            .map(|list| list.iter().filter_map(Value::as_str).collect());
        self.need(key, "a list of texts", list)
    }

    /// A list of integers; empty where none is given.
    pub fn ints(&self, key: &str) -> Result<Vec<i64>, String> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let list = value
            .as_array()
            .map(|list| list.iter().filter_map(Value::as_integer).collect());
        self.need(key, "a list of integers", list)
    }

    /// A number with decimals, as the manual prints it.
    pub fn number(&self, key: &str) -> Result<f64, String> {
        let value = self.get(key);
        #[allow(clippy::cast_precision_loss)] // Printed numbers are short.
        let number = value.and_then(|v| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)));
        self.need(key, "a number", number)
    }

    /// Those of `keys` that nobody asked for.
    pub fn unread(&self, keys: &[String]) -> Vec<String> {
        let read = self.read.borrow();
        keys.iter()
            .filter(|key| !read.contains(*key))
            .cloned()
            .collect()
    }
}
