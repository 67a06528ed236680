//! The certificate file: a line of text, a header in TOML, compact proofs, a checksum.
//!
//! ```text
//! stillpoint-certificate 1 <bytes of the header>
//! <header: TOML>
//! <for each task: states, one proof for each property, one run for each range fault>
//! <SHA-256 of everything before, 32 bytes>
//! ```
//!
//! Every number after the header is in LEB128: seven bits a byte, the low ones first. A list of states (or pairs of
//! states) is their count and then the distance of each from the one before, less one; the first counts from -1. A map
//! over the states is (count, value) again and again until every state has its value.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::Failure;

/// What a certificate file starts with; then the version.
pub const MAGIC: &str = "stillpoint-certificate";
/// The version of the format.
pub const VERSION: u32 = 1;
/// Bytes of the checksum.
pub const CHECKSUM: usize = 32;

/// What the file is about, as text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The specification or machine file, as it was named to the producer.
    pub subject: String,
    /// Which of the two it is.
    pub kind: Kind,
    /// The option of each reading that occurs.
    pub readings: BTreeMap<String, String>,
    /// Every file whose text decides what the systems are.
    pub file: Vec<Source>,
    /// The systems, with parameter values.
    pub task: Vec<Task>,
}

/// What kind of file a certificate is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The systems of a specification file, with default parameters.
    Specification,
    /// The runs of a machine file.
    Machine,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Its name without folders.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// A system with parameter values, and what is claimed about it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// `specification/system`.
    pub system: String,
    /// What it shows.
    pub title: String,
    /// The number of states in the set; 0 where it was not explored to the end.
    pub states: u64,
    /// Names of the places where reachable cycles leave a range.
    pub faults: Vec<String>,
    /// Parameter values by name.
    pub parameters: BTreeMap<String, i32>,
    /// The properties, in the order of the specification.
    pub property: Vec<Property>,
}

/// A property and the verdict claimed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Property {
    /// Id, with the index of a copy.
    pub id: String,
    /// In plain words.
    pub text: String,
    /// Its expressions as written, `key: expression`.
    pub written: Vec<String>,
    /// What is claimed.
    pub verdict: Verdict,
    /// Why nothing is claimed.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub reason: String,
}

/// What a certificate claims about a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It holds on every run, and its condition occurs.
    Holds,
    /// A run violates it.
    Violated,
    /// Its condition never occurs.
    Vacuous,
    /// What was looked for occurs.
    Reached,
    /// What was looked for never occurs.
    Unreachable,
    /// Nothing is claimed.
    Open,
}

/// What shows the claims of one task.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Body {
    /// Numbers of states in ascending order; see [`crate::states::Radix`]. Empty: nothing is claimed about all runs.
    pub states: Vec<u128>,
    /// One for each property.
    pub proofs: Vec<Proof>,
    /// A run into each fault.
    pub faults: Vec<Run>,
}

/// What shows one claim; which parts it needs depends on the property's form and the verdict.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Proof {
    /// Witnesses and counterexamples.
    pub runs: Vec<Run>,
    /// A number for each state: a rank, or whether it belongs to a set.
    pub map: Vec<u32>,
    /// Pairs of states: the place of the first one times the number of states, plus the place of the second one.
    pub pairs: Vec<u128>,
}

/// A run from an initial state.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Run {
    /// Number of the initial state.
    pub initial: u128,
    /// For each cycle inputs with their values above the least.
    pub steps: Vec<Vec<(u32, u32)>>,
    /// The steps from this one on repeat forever.
    pub repeats: Option<usize>,
}

fn broken(what: impl Into<String>) -> Failure {
    Failure::Unreadable(what.into())
}

/// Checks the first line and the checksum. The header, and the bytes of the proofs.
///
/// # Errors
/// No certificate, another version, bytes that are missing or altered.
pub fn open(file: &[u8]) -> Result<(Header, &[u8]), Failure> {
    let line = file.iter().take(64).position(|b| *b == b'\n');
    let words = line.and_then(|end| std::str::from_utf8(&file[..end]).ok());
    let words: Vec<&str> = words.unwrap_or_default().split(' ').collect();
    let [MAGIC, version, length] = words[..] else {
        return Err(broken("this is no certificate of stillpoint"));
    };
    if version != VERSION.to_string() {
        return Err(broken(format!(
            "version {version} of the format is not known; this program reads version {VERSION}"
        )));
    }
    let altered = || Failure::Rejected("the file is truncated or was altered".to_owned());
    let end = file.len().checked_sub(CHECKSUM).ok_or_else(altered)?;
    let (content, checksum) = file.split_at(end);
    if Sha256::digest(content).as_slice() != checksum {
        return Err(altered());
    }
    let start = line.map_or(0, |end| end + 1);
    let (header, proofs) = length
        .parse()
        .ok()
        .and_then(|length: usize| content.get(start..)?.split_at_checked(length))
        .ok_or_else(|| broken("the header is longer than the file"))?;
    let header = std::str::from_utf8(header).map_err(|_| broken("the header is not UTF-8"))?;
    let header = toml::from_str(header).map_err(|e| broken(format!("header: {}", e.message())))?;
    Ok((header, proofs))
}

/// Reads the proofs. Memory grows with what is read, never with a number that a file states; call it once the header is
/// known to be that of the specification.
///
/// # Errors
/// Bytes that are no proofs of the tasks of this header.
pub fn bodies(header: &Header, proofs: &[u8]) -> Result<Vec<Body>, Failure> {
    let mut bytes = Bytes(proofs);
    let tasks = header.task.iter().map(|task| bytes.body(task));
    let read: Option<Vec<Body>> = tasks.collect();
    read.filter(|_| bytes.0.is_empty()).ok_or_else(|| {
        Failure::Rejected("its proofs are not those of the claims in its header".to_owned())
    })
}

/// What is left to read. None stands for bytes that make no sense.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn number(&mut self) -> Option<u128> {
        let mut value = 0_u128;
        for shift in (0..128).step_by(7) {
            let (byte, rest) = self.0.split_first()?;
            self.0 = rest;
            let part = u128::from(byte & 0x7f);
            if part << shift >> shift != part {
                return None;
            }
            value |= part << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    fn small<T: TryFrom<u128>>(&mut self) -> Option<T> {
        T::try_from(self.number()?).ok()
    }

    /// As many things as a number says; each takes at least one byte.
    fn list<T>(&mut self, mut one: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let count: usize = self.small()?;
        let mut list = Vec::new();
        for _ in 0..count {
            list.push(one(self)?);
        }
        Some(list)
    }

    fn ascending(&mut self) -> Option<Vec<u128>> {
        let mut next = 0_u128;
        self.list(|bytes| {
            let value = next.checked_add(bytes.number()?)?;
            next = value.checked_add(1)?;
            Some(value)
        })
    }

    fn map(&mut self, states: usize) -> Option<Vec<u32>> {
        let mut map = Vec::new();
        let present: bool = self.number()? == 1;
        while present && map.len() < states {
            let count: usize = self.small()?;
            let value = self.small()?;
            if count == 0 || count > states - map.len() {
                return None;
            }
            map.resize(map.len() + count, value);
        }
        Some(map)
    }

    fn run(&mut self) -> Option<Run> {
        let initial = self.number()?;
        let repeats: usize = self.small()?;
        let steps = self.list(|b| b.list(|b| Some((b.small()?, b.small()?))))?;
        Some(Run {
            initial,
            steps,
            repeats: repeats.checked_sub(1),
        })
    }

    fn body(&mut self, task: &Task) -> Option<Body> {
        let mut body = Body {
            states: self.ascending()?,
            ..Body::default()
        };
        if body.states.len() as u64 != task.states {
            return None;
        }
        for _ in &task.property {
            body.proofs.push(Proof {
                runs: self.list(Self::run)?,
                map: self.map(body.states.len())?,
                pairs: self.ascending()?,
            });
        }
        for _ in &task.faults {
            body.faults.push(self.run()?);
        }
        Some(body)
    }
}
