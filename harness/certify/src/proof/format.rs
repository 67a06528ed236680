//! The file: lines of text.
//!
//! ```text
//! stillpoint-proofs 1 <lines of the header>
//! <header: TOML, as that of the other certificates>
//! system <specification/system>
//! every <parameter> <least> <greatest>
//! claim <property, or range> <verdict>
//! run
//! with <parameter> <value>
//! start <state variable> <value>
//! cycle <input>=<value> ...
//! invariant
//! clause <literal> ...
//! induction <cycles>
//! differ <cycle> <cycle>
//! region <literal> ...
//! by <input>=<value> ...
//! falls <number>
//! lemmas <start, step, base or path, cover or way>
//! <number> ...
//! end
//! sha256 <of everything before, in hexadecimal digits>
//! ```
//!
//! One `system` for each of the header, in its order; one `claim` for each property about which something is claimed, in its order, then
//! perhaps one about ranges. The numbers of a lemma are those of gates: a clause that follows from the clauses and lemmas before it.
//!
//! The theorems of a family are kept without header and lemmas, which are nearly all of such a file: `stillpoint-theorems 1`, then
//! `system` after `system`, then the checksum. Their tables are the family's, and the lemmas are found again by a solver.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::clause::{Clause, Literal};
use super::question::Induction;
use super::ways::{Rank, Step};
use crate::Failure;
use crate::format::{Header, Verdict};

/// What such a file starts with; then the version.
pub const MAGIC: &str = "stillpoint-proofs";
/// What the theorems of a family start with, version included: they speak of no gates.
pub const THEOREMS: &str = "stillpoint-theorems 1";
/// The version of the format, and of the gates that lemmas speak of.
pub const VERSION: u32 = 1;
/// The claim that no assignment leaves its range.
pub const RANGE: &str = "range";

/// The whole file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// What it is about.
    pub header: Header,
    /// As the systems of the header.
    pub systems: Vec<System>,
}

/// The claims about a system.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct System {
    /// Its name.
    pub name: String,
    /// The line on which it begins.
    pub line: usize,
    /// Parameters that have every value from the first to the second; all others have that of the header.
    pub every: Vec<(String, (i64, i64))>,
    /// What is claimed.
    pub claims: Vec<Claim>,
}

/// A claim and what shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The property with the number of its copy, or [`RANGE`].
    pub id: String,
    /// What is claimed.
    pub verdict: Verdict,
    /// The line on which it stands.
    pub line: usize,
    /// A witness or a counterexample.
    pub run: Option<Run>,
    /// What shows that something is never seen.
    pub proof: Option<Proof>,
}

/// A run, by names; an input that is not named has its least value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Run {
    /// The configuration, where parameters are free.
    pub with: Vec<(String, i64)>,
    /// State variables that start with any value.
    pub start: Vec<(String, i64)>,
    /// The inputs of each cycle.
    pub cycles: Vec<Vec<(String, i64)>>,
}

/// What shows that something is never seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Proof {
    /// In every reachable state each of these holds.
    pub invariant: Vec<Clause>,
    /// The line of the first clause, if there is one.
    pub line: usize,
    /// Where that alone is not enough.
    pub induction: Option<Induction>,
    /// Of what can always be reached: the regions, in their order.
    pub ways: Vec<Step>,
    /// For each obligation, in their order.
    pub lemmas: Vec<Lemmas>,
}

/// Clauses, each of which follows by unit propagation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lemmas {
    /// The line before the first one.
    pub line: usize,
    /// The clauses.
    pub list: Vec<Vec<i32>>,
}

impl Proof {
    /// What its obligations are called.
    pub fn obligations(&self) -> &'static [&'static str] {
        match (&self.induction, &self.ways[..]) {
            (None, []) => &["start", "step"],
            (Some(_), _) => &["start", "step", "base", "path"],
            (None, _) => &["start", "step", "cover", "way"],
        }
    }
}

const VERDICTS: [(Verdict, &str); 5] = [
    (Verdict::Holds, "holds"),
    (Verdict::Violated, "violated"),
    (Verdict::Vacuous, "vacuous"),
    (Verdict::Reached, "reached"),
    (Verdict::Unreachable, "unreachable"),
];

/// Whether these bytes are to be such a file.
pub fn is_one(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC.as_bytes())
}

/// The file as text.
///
/// # Errors
/// A header that is no TOML.
pub fn text(file: &File) -> Result<String, toml::ser::Error> {
    let header = toml::to_string(&file.header)?;
    let mut out = format!("{MAGIC} {VERSION} {}\n{header}", header.lines().count());
    systems(&mut out, &file.systems);
    Ok(out)
}

/// Theorems as text, whatever lemmas they have left out.
pub fn theorems_text(theorems: &[System]) -> String {
    let mut out = format!("{THEOREMS}\n");
    let bare = theorems.iter().map(|system| {
        let mut system = system.clone();
        let proofs = system.claims.iter_mut().filter_map(|c| c.proof.as_mut());
        proofs.for_each(|proof| proof.lemmas.clear());
        system
    });
    systems(&mut out, &bare.collect::<Vec<_>>());
    out
}

/// The systems, and the checksum of everything.
fn systems(out: &mut String, systems: &[System]) {
    for system in systems {
        line(out, "system", [&system.name]);
        for (name, (lo, hi)) in &system.every {
            line(out, "every", [name, &lo.to_string(), &hi.to_string()]);
        }
        for claim in &system.claims {
            self::claim(out, claim);
        }
    }
    let digits = Sha256::digest(out.as_bytes());
    let _ = writeln!(out, "sha256 {digits:x}");
}

fn line<'a>(out: &mut String, word: &str, rest: impl IntoIterator<Item = &'a String>) {
    out.push_str(word);
    for part in rest {
        let _ = write!(out, " {part}");
    }
    out.push('\n');
}

fn words<T: ToString>(list: &[T]) -> Vec<String> {
    list.iter().map(T::to_string).collect()
}

fn pairs(inputs: &[(String, i64)]) -> Vec<String> {
    inputs.iter().map(|(n, v)| format!("{n}={v}")).collect()
}

fn claim(out: &mut String, claim: &Claim) {
    let named = |(_, name): &&(Verdict, &str)| (*name).to_owned();
    let verdict = VERDICTS.iter().find(|(v, _)| *v == claim.verdict);
    let verdict = verdict.as_ref().map_or(String::new(), named);
    line(out, "claim", [&claim.id, &verdict]);
    if let Some(run) = &claim.run {
        line(out, "run", []);
        for (word, list) in [("with", &run.with), ("start", &run.start)] {
            for (name, value) in list {
                line(out, word, [name, &value.to_string()]);
            }
        }
        for inputs in &run.cycles {
            line(out, "cycle", &pairs(inputs));
        }
    }
    let Some(proof) = &claim.proof else {
        return;
    };
    line(out, "invariant", []);
    for clause in &proof.invariant {
        line(out, "clause", [&clause.to_string()]);
    }
    if let Some(induction) = &proof.induction {
        line(out, "induction", [&induction.cycles.to_string()]);
        for (one, other) in &induction.differ {
            line(out, "differ", [&one.to_string(), &other.to_string()]);
        }
    }
    for step in &proof.ways {
        line(out, "region", &words(&step.region));
        line(out, "by", &pairs(&step.inputs));
        if let Some(rank) = &step.rank {
            line(
                out,
                if rank.rises { "rises" } else { "falls" },
                [&rank.name],
            );
        }
    }
    for (lemmas, name) in proof.lemmas.iter().zip(proof.obligations()) {
        line(out, "lemmas", [&(*name).to_owned()]);
        for lemma in &lemmas.list {
            let numbers: Vec<String> = lemma.iter().map(i32::to_string).collect();
            out.push_str(&numbers.join(" "));
            out.push('\n');
        }
        line(out, "end", []);
    }
}

/// Reads a file.
///
/// # Errors
/// No such file or another version: unreadable. Cut off, altered, or not of this form: rejected, with the line.
pub fn read(bytes: &[u8]) -> Result<File, Failure> {
    let unreadable = |what: &str| Failure::Unreadable(what.to_owned());
    let text = std::str::from_utf8(bytes).map_err(|_| unreadable("the file is no text"))?;
    let first: Vec<&str> = text.lines().next().unwrap_or_default().split(' ').collect();
    let [MAGIC, version, length] = first[..] else {
        return Err(unreadable("this is no certificate of stillpoint"));
    };
    if version != VERSION.to_string() {
        return Err(Failure::Unreadable(format!(
            "version {version} of the format is not known; this program reads version {VERSION}"
        )));
    }
    let end = sealed(text)?;
    let lines: Vec<&str> = text[..end].lines().collect();
    let length = length.parse().ok().filter(|n: &usize| *n < lines.len());
    let length = length.ok_or_else(|| unreadable("the header is longer than the file"))?;
    let header = lines[1..=length].join("\n");
    let header =
        toml::from_str(&header).map_err(|e| unreadable(&format!("header: {}", e.message())))?;
    let mut reader = Reader {
        lines: &lines,
        at: length + 1,
        bare: false,
    };
    let systems = reader.systems().ok_or_else(|| reader.failure())?;
    Ok(File { header, systems })
}

/// Reads the theorems of a family, which have no lemmas.
///
/// # Errors
/// As [`read`].
pub fn read_theorems(bytes: &[u8]) -> Result<Vec<System>, Failure> {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    if text.lines().next() != Some(THEOREMS) {
        return Err(Failure::Unreadable(format!(
            "this is no file of theorems: its first line is not `{THEOREMS}`"
        )));
    }
    let end = sealed(text)?;
    let lines: Vec<&str> = text[..end].lines().collect();
    let mut reader = Reader {
        lines: &lines,
        at: 1,
        bare: true,
    };
    reader.systems().ok_or_else(|| reader.failure())
}

/// Where the last line begins, which must be the checksum of what is before it.
fn sealed(text: &str) -> Result<usize, Failure> {
    let last = text.strip_suffix('\n').and_then(|whole| {
        let start = whole.rfind('\n')? + 1;
        Some((start, whole[start..].strip_prefix("sha256 ")?))
    });
    let right = last.filter(|(start, digits)| {
        let own = Sha256::digest(&text.as_bytes()[..*start]);
        format!("{own:x}") == *digits
    });
    right.map(|(start, _)| start).ok_or_else(|| {
        Failure::Rejected(format!(
            "line {}: the file is truncated or was altered: its last line is not the SHA-256 of those before",
            text.lines().count()
        ))
    })
}

fn inputs(words: &[&str]) -> Option<Vec<(String, i64)>> {
    let one = |word: &&str| {
        let (name, value) = word.rsplit_once('=')?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    words.iter().map(one).collect()
}

/// Reads line after line; None where a line is not what it must be.
struct Reader<'a> {
    lines: &'a [&'a str],
    at: usize,
    /// No proof has lemmas.
    bare: bool,
}

impl<'a> Reader<'a> {
    fn failure(&self) -> Failure {
        Failure::Rejected(format!(
            "line {}: this is not what must stand here",
            self.at + 1
        ))
    }

    /// The words after this one, if the line begins with it; then the line is done.
    fn words(&mut self, first: &str) -> Option<Vec<&'a str>> {
        let mut words = self.lines.get(self.at)?.split(' ');
        if words.next() != Some(first) {
            return None;
        }
        self.at += 1;
        Some(words.collect())
    }

    /// Steps back to the line just read, which made no sense.
    fn wrong<T>(&mut self, value: Option<T>) -> Option<T> {
        if value.is_none() {
            self.at -= 1;
        }
        value
    }

    fn systems(&mut self) -> Option<Vec<System>> {
        let mut systems = Vec::new();
        while let Some(words) = self.words("system") {
            let mut system = System {
                name: words.join(" "),
                line: self.at,
                ..System::default()
            };
            while let Some(words) = self.words("every") {
                let every = match words[..] {
                    [name, lo, hi] => lo.parse().ok().zip(hi.parse().ok()).map(|r| (name, r)),
                    _ => None,
                };
                let (name, range) = self.wrong(every)?;
                system.every.push((name.to_owned(), range));
            }
            while let Some(words) = self.words("claim") {
                let known = match words[..] {
                    [id, verdict] => {
                        let mut known = VERDICTS.iter();
                        known.find(|(_, name)| *name == verdict).map(|v| (id, v.0))
                    }
                    _ => None,
                };
                let (id, verdict) = self.wrong(known)?;
                system.claims.push(Claim {
                    id: id.to_owned(),
                    verdict,
                    line: self.at,
                    run: self.run()?,
                    proof: self.proof()?,
                });
            }
            systems.push(system);
        }
        (self.at == self.lines.len()).then_some(systems)
    }

    fn run(&mut self) -> Option<Option<Run>> {
        if self.words("run").is_none() {
            return Some(None);
        }
        let mut run = Run::default();
        for (word, list) in [("with", &mut run.with), ("start", &mut run.start)] {
            while let Some(words) = self.words(word) {
                let pair = match words[..] {
                    [name, value] => value.parse().ok().map(|v| (name.to_owned(), v)),
                    _ => None,
                };
                list.push(self.wrong(pair)?);
            }
        }
        while let Some(words) = self.words("cycle") {
            run.cycles.push(self.wrong(inputs(&words))?);
        }
        Some(Some(run))
    }

    fn ways(&mut self) -> Option<Vec<Step>> {
        let mut ways = Vec::new();
        while let Some(words) = self.words("region") {
            let region = words.iter().map(|word| Literal::read(word)).collect();
            let region = self.wrong(region)?;
            let words = self.words("by")?;
            let inputs = self.wrong(inputs(&words))?;
            let mut rank = None;
            for (word, rises) in [("falls", false), ("rises", true)] {
                if let Some(words) = self.words(word) {
                    let name = match words[..] {
                        [name] => Some(name.to_owned()),
                        _ => None,
                    };
                    let name = self.wrong(name)?;
                    rank = Some(Rank { name, rises });
                }
            }
            ways.push(Step {
                region,
                inputs,
                rank,
            });
        }
        Some(ways)
    }

    fn proof(&mut self) -> Option<Option<Proof>> {
        if self.words("invariant").is_none() {
            return Some(None);
        }
        let mut proof = Proof {
            line: self.at + 1,
            ..Proof::default()
        };
        while let Some(words) = self.words("clause") {
            let clause = Clause::read(words.into_iter());
            proof.invariant.push(self.wrong(clause)?);
        }
        if let Some(words) = self.words("induction") {
            let cycles = match words[..] {
                [cycles] => cycles.parse().ok(),
                _ => None,
            };
            let mut induction = Induction {
                cycles: self.wrong(cycles)?,
                differ: Vec::new(),
            };
            while let Some(words) = self.words("differ") {
                let pair = match words[..] {
                    [one, other] => one.parse().ok().zip(other.parse().ok()),
                    _ => None,
                };
                induction.differ.push(self.wrong(pair)?);
            }
            proof.induction = Some(induction);
        }
        proof.ways = self.ways()?;
        let obligations = if self.bare { &[] } else { proof.obligations() };
        for name in obligations {
            let words = self.words("lemmas")?;
            self.wrong((words[..] == [*name]).then_some(()))?;
            let mut lemmas = Lemmas {
                line: self.at,
                list: Vec::new(),
            };
            while self.words("end").is_none() {
                let numbers = self.lines.get(self.at)?.split(' ');
                let numbers: Option<Vec<i32>> = numbers.map(|n| n.parse().ok()).collect();
                lemmas.list.push(numbers?);
                self.at += 1;
            }
            proof.lemmas.push(lemmas);
        }
        Some(Some(proof))
    }
}
