//! The file: lines of text.
//!
//! ```text
//! stillpoint-proofs 1 <lines of the header>
//! <header: TOML, as that of the other certificates>
//! system <specification/system>
//! every <parameter> <least> <greatest>
//! where <condition on parameters>
//! such <parameter> <value>
//! claim <property, or range> <verdict>
//! run
//! with <parameter> <value>
//! start <state variable> <value>
//! cycle <input>=<value> ...
//! invariant
//! clause <literal> ...
//! induction <cycles>
//! differ <cycle> <cycle>
//! rounds <number>
//! falls <number>
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

use super::clause::Clause;
use super::duty::Measure;
use super::question::Induction;
use super::ways::{Rank, Step};
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
    /// The configurations that the claims are about.
    pub free: Free,
    /// What is claimed.
    pub claims: Vec<Claim>,
}

/// Configurations: values of parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Free {
    /// Parameters that have every value from the first to the second; all others have that of the header.
    pub every: Vec<(String, (i64, i64))>,
    /// Conditions that they satisfy ([`stillpoint_lang::condition`]).
    pub conditions: Vec<String>,
    /// With conditions: one of the configurations, so that there are some.
    pub such: Vec<(String, i64)>,
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
    /// Of a response without a bound.
    pub measure: Option<Measure>,
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

pub(super) const VERDICTS: [(Verdict, &str); 5] = [
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
        for (name, (lo, hi)) in &system.free.every {
            line(out, "every", [name, &lo.to_string(), &hi.to_string()]);
        }
        for condition in &system.free.conditions {
            line(out, "where", [condition]);
        }
        values(out, "such", &system.free.such);
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

fn values(out: &mut String, word: &str, list: &[(String, i64)]) {
    for (name, value) in list {
        line(out, word, [name, &value.to_string()]);
    }
}

fn words<T: ToString>(list: &[T]) -> Vec<String> {
    list.iter().map(T::to_string).collect()
}

fn pairs(inputs: &[(String, i64)]) -> Vec<String> {
    inputs.iter().map(|(n, v)| format!("{n}={v}")).collect()
}

fn ranks<'a>(out: &mut String, ranks: impl IntoIterator<Item = &'a Rank>) {
    for rank in ranks {
        let word = if rank.rises { "rises" } else { "falls" };
        line(out, word, [&rank.name]);
    }
}

fn claim(out: &mut String, claim: &Claim) {
    let named = |(_, name): &&(Verdict, &str)| (*name).to_owned();
    let verdict = VERDICTS.iter().find(|(v, _)| *v == claim.verdict);
    let verdict = verdict.as_ref().map_or(String::new(), named);
    line(out, "claim", [&claim.id, &verdict]);
    if let Some(run) = &claim.run {
        line(out, "run", []);
        values(out, "with", &run.with);
        values(out, "start", &run.start);
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
    if let Some(measure) = &proof.measure {
        line(out, "rounds", [&measure.rounds.to_string()]);
        ranks(out, &measure.numbers);
    }
    for step in &proof.ways {
        line(out, "region", &words(&step.region));
        line(out, "by", &pairs(&step.inputs));
        ranks(out, &step.rank);
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
