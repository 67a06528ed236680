//! What Kani answered: the file `kani.toml`, which a run writes and the inventory shows.

pub mod log;
pub mod sources;

pub use log::answers;
pub use sources::{fingerprint, has_sources};

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use crate::inventory::{self, Entry};

/// The file, in the folder of this crate.
pub const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/kani.toml");

/// The time that a harness has.
pub const LIMIT_SECONDS: u32 = 60;

/// Where a Kani that was not installed by `cargo install` is looked for last, in the home folder: `cargo-kani`, `cbmc`, `kissat`.
pub const HOME_FOLDER: &str = ".local/share/kani-tools/bin";

/// What Kani answered for one harness.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// The time of the verification, without that of the compiler: all parts of the harness.
    pub seconds: f64,
    /// The time of the slowest part.
    pub slowest: f64,
    /// The parts: 1 for a harness that is not divided.
    pub parts: u64,
    /// The checks made: assertions, overflows, indices, dereferences.
    pub checks: u64,
    /// The covers that were met.
    pub met: u64,
    /// All covers of the harness.
    pub covers: u64,
    /// The solver that gave it, as CBMC names it. Not always the one that was asked for: a CBMC that was built without CaDiCaL
    /// takes another one.
    pub solver: String,
}

/// How a harness ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every check holds, every cover was met.
    Holds,
    /// Every check holds, but a cover cannot be met: the harness proves less than it says.
    Vacuous,
    /// A check fails; its description.
    Fails(String),
    /// Not within [`LIMIT_SECONDS`].
    NoAnswer,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Holds => f.write_str("holds"),
            Self::Vacuous => f.write_str("vacuous"),
            Self::Fails(check) => write!(f, "fails: {check}"),
            Self::NoAnswer => f.write_str("no answer"),
        }
    }
}

impl Verdict {
    fn parse(text: &str) -> Option<Self> {
        match text {
            "holds" => Some(Self::Holds),
            "vacuous" => Some(Self::Vacuous),
            "no answer" => Some(Self::NoAnswer),
            _ => Some(Self::Fails(text.strip_prefix("fails: ")?.to_owned())),
        }
    }
}

/// One row of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The answer.
    pub answer: Answer,
    /// The [`fingerprint`] of the sources it was given for.
    pub sources: String,
}

/// The file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// The version of Kani.
    pub kani: String,
    /// The version of CBMC.
    pub cbmc: String,
    /// The rows by harness.
    pub rows: BTreeMap<String, Row>,
}

/// The solver that a harness asks for.
pub fn solver(entry: &Entry) -> &'static str {
    if entry.kani.contains("kissat") {
        "kissat"
    } else if entry.kani.contains("minisat") {
        "minisat"
    } else {
        // Kani's own choice.
        "cadical"
    }
}

/// The Kani harnesses of an entry: 1, or its parts, and for a property beside its parts the whole with the covers.
pub fn parts(entry: &Entry) -> u64 {
    let declared = text_of_parts(entry).matches('=').count() as u64;
    if declared == 0 {
        1
    } else {
        declared + u64::from(entry.file.is_some())
    }
}

/// By how many numbers the parts of a harness share its clauses: 1 where it is not divided.
pub fn shares(entry: &Entry) -> u64 {
    numbers_of_parts(entry).first().copied().unwrap_or(1)
}

/// The declaration of the parts.
fn text_of_parts(entry: &Entry) -> &'static str {
    entry.kani.split_once("parts").map_or("", |(_, rest)| rest)
}

/// By how many numbers the clauses are shared, then those of each part; nothing for a harness that is not divided.
pub fn numbers_of_parts(entry: &Entry) -> Vec<u64> {
    text_of_parts(entry)
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|digits| digits.parse().ok())
        .collect()
}

impl Results {
    /// Reads [`FILE`]; a file that is not there has no rows.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn read() -> Result<Self, String> {
        match std::fs::read_to_string(FILE) {
            Ok(text) => Self::parse(&text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            Err(error) => Err(format!("{FILE}: {error}")),
        }
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// What is wrong with it; also a row of a harness that does not exist.
    pub fn parse(text: &str) -> Result<Self, String> {
        let table: toml::Table = text.parse().map_err(|error| format!("{error}"))?;
        let word = |table: &toml::Table, key: &str| {
            let value = table.get(key).and_then(toml::Value::as_str);
            value
                .map(str::to_owned)
                .ok_or_else(|| format!("no text `{key}`"))
        };
        let decimal = |table: &toml::Table, key: &str| {
            let value = table.get(key).and_then(toml::Value::as_float);
            value.ok_or_else(|| format!("no decimal `{key}`"))
        };
        let number = |table: &toml::Table, key: &str| {
            let value = table.get(key).and_then(toml::Value::as_integer);
            value
                .and_then(|value| u64::try_from(value).ok())
                .ok_or_else(|| format!("no number `{key}`"))
        };
        let mut results = Self {
            kani: word(&table, "kani")?,
            cbmc: word(&table, "cbmc")?,
            rows: BTreeMap::new(),
        };
        let rows = table.get("harness").and_then(toml::Value::as_table);
        for (id, row) in rows.into_iter().flatten() {
            let row = row.as_table().ok_or(format!("{id}: not a table"))?;
            let read = || {
                let verdict = word(row, "verdict")?;
                Ok::<_, String>(Row {
                    answer: Answer {
                        verdict: Verdict::parse(&verdict)
                            .ok_or(format!("no verdict `{verdict}`"))?,
                        seconds: decimal(row, "seconds")?,
                        slowest: decimal(row, "slowest")?,
                        parts: number(row, "parts")?,
                        checks: number(row, "checks")?,
                        met: number(row, "met")?,
                        covers: number(row, "covers")?,
                        solver: word(row, "solver")?,
                    },
                    sources: word(row, "sources")?,
                })
            };
            let row = read().map_err(|error| format!("{id}: {error}"))?;
            if inventory::all().all(|entry| entry.id != id) {
                return Err(format!("{id}: there is no such harness"));
            }
            results.rows.insert(id.clone(), row);
        }
        Ok(results)
    }

    /// The text of the file, in the order of the inventory.
    pub fn render(&self) -> String {
        let mut text = format!(
            "# Answers of Kani. Written by `cargo run -p stillpoint-proofs --bin kani`; shown in the proof inventory.\n\
             # `sources`: fingerprint of what the harness is made of; another one means that the answer is older.\n\
             kani = \"{}\"\ncbmc = \"{}\"\n\n[harness]\n",
            self.kani, self.cbmc
        );
        for entry in inventory::all() {
            let Some(Row { answer, sources }) = self.rows.get(entry.id) else {
                continue;
            };
            let verdict = answer.verdict.to_string().replace(['"', '\\'], "'");
            let _ = writeln!(
                text,
                "{} = {{ verdict = \"{verdict}\", seconds = {:.1}, slowest = {:.1}, parts = {}, checks = {}, met = {}, covers = {}, \
                 solver = \"{}\", sources = \"{sources}\" }}",
                entry.id,
                answer.seconds,
                answer.slowest,
                answer.parts,
                answer.checks,
                answer.met,
                answer.covers,
                answer.solver
            );
        }
        text
    }

    /// The row of a harness, and whether its sources are still the same.
    pub fn row(&self, entry: &Entry) -> Option<(&Row, bool)> {
        let row = self.rows.get(entry.id)?;
        Some((row, row.sources == fingerprint(entry)))
    }
}
