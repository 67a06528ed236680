//! Reads the file of [`super::format`].

use sha2::{Digest, Sha256};

use super::clause::{Clause, Literal};
use super::duty::Measure;
use super::format::{Claim, File, Lemmas, MAGIC, Proof, Run, System, THEOREMS, VERDICTS, VERSION};
use super::question::Induction;
use super::ways::{Rank, Step};
use crate::Failure;

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
                system.free.every.push((name.to_owned(), range));
            }
            while let Some(words) = self.words("where") {
                system.free.conditions.push(words.join(" "));
            }
            system.free.such = self.values("such")?;
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

    /// Names with their values, a line each.
    fn values(&mut self, word: &str) -> Option<Vec<(String, i64)>> {
        let mut list = Vec::new();
        while let Some(words) = self.words(word) {
            let pair = match words[..] {
                [name, value] => value.parse().ok().map(|v| (name.to_owned(), v)),
                _ => None,
            };
            list.push(self.wrong(pair)?);
        }
        Some(list)
    }

    fn run(&mut self) -> Option<Option<Run>> {
        if self.words("run").is_none() {
            return Some(None);
        }
        let mut run = Run {
            with: self.values("with")?,
            start: self.values("start")?,
            cycles: Vec::new(),
        };
        while let Some(words) = self.words("cycle") {
            run.cycles.push(self.wrong(inputs(&words))?);
        }
        Some(Some(run))
    }

    /// A number that falls or rises, if there is one.
    fn rank(&mut self) -> Option<Option<Rank>> {
        for (word, rises) in [("falls", false), ("rises", true)] {
            if let Some(words) = self.words(word) {
                let name = match words[..] {
                    [name] => Some(name.to_owned()),
                    _ => None,
                };
                let name = self.wrong(name)?;
                return Some(Some(Rank { name, rises }));
            }
        }
        Some(None)
    }

    fn measure(&mut self) -> Option<Option<Measure>> {
        let Some(words) = self.words("rounds") else {
            return Some(None);
        };
        let rounds = match words[..] {
            [rounds] => rounds.parse().ok(),
            _ => None,
        };
        let mut measure = Measure {
            rounds: self.wrong(rounds)?,
            ..Measure::default()
        };
        while let Some(rank) = self.rank()? {
            measure.numbers.push(rank);
        }
        Some(Some(measure))
    }

    fn ways(&mut self) -> Option<Vec<Step>> {
        let mut ways = Vec::new();
        while let Some(words) = self.words("region") {
            let region = words.iter().map(|word| Literal::read(word)).collect();
            let region = self.wrong(region)?;
            let words = self.words("by")?;
            let inputs = self.wrong(inputs(&words))?;
            let rank = self.rank()?;
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
        proof.measure = self.measure()?;
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
