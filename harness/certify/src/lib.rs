//! Checks certificates: files that show verdicts of `stillpoint check` without asking anybody to trust the explorer.
//!
//! The crate uses the loader and the interpreter of `stillpoint-lang`, machine files by `stillpoint-machine`, SHA-256 and the TOML
//! reader, and nothing else of this project: its `Cargo.toml` shows it. What a property means is taken from the specification, which is loaded
//! again; a certificate only adds sets, ranks and runs, and every one of them is checked.
//!
//! To be read in this order: [`format`] (the file), [`subject`] (the specification), [`states`], `cells` (the values of a
//! cycle, and backtracking over its inputs), `later` and `memo` (what is not evaluated again), [`cycle`] (all cycles of a state, and
//! the cycles of a run), `claim` (what each verdict needs), `check` (what has to be true in every cycle).
//! [`write()`] is for producers; nothing rests on it. Certificates of the proof engines are another kind of file: [`proof`].

mod cells;
mod check;
mod claim;
pub mod cycle;
pub mod format;
mod later;
mod memo;
pub mod proof;
mod replay;
pub mod states;
pub mod subject;
mod write;

use std::path::{Path, PathBuf};

use format::Header;
use proof::check::Proved;
use subject::Subject;

pub use write::write;

/// Why a certificate is not confirmed: one line.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// There is no certificate or no specification to be read.
    #[error("{0}")]
    Unreadable(String),
    /// It does not show what it claims.
    #[error("{0}")]
    Rejected(String),
}

/// A certificate whose claims are all true.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confirmed {
    /// What it claims.
    pub header: Header,
    /// For each task and property the greatest number of cycles until a response has come, where ranks show one.
    pub bounds: Vec<Vec<Option<u32>>>,
    /// For each task what a certificate of the proof engines shows; none for one of the explorer.
    pub proved: Option<Vec<Proved>>,
}

/// No certificate is that long: 16 GiB.
const LONGEST: u64 = 16 << 30;

/// Checks the certificate in a file. The specification is the one it names, or `spec`.
///
/// # Errors
/// Files that cannot be read; a certificate that does not show what it claims.
pub fn certify(path: &Path, spec: Option<&Path>, threads: usize) -> Result<Confirmed, Failure> {
    let fail = |what: String| Failure::Unreadable(format!("{}: {what}", path.display()));
    let meta = std::fs::metadata(path).map_err(|e| fail(e.to_string()))?;
    if !meta.is_file() || meta.len() > LONGEST {
        return Err(fail("this is no regular file of at most 16 GiB".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(|e| fail(e.to_string()))?;
    certify_bytes(&bytes, spec, threads)
}

/// Like [`certify`], for a certificate that was read already.
///
/// # Errors
/// As [`certify`].
pub fn certify_bytes(
    bytes: &[u8],
    spec: Option<&Path>,
    threads: usize,
) -> Result<Confirmed, Failure> {
    if proof::format::is_one(bytes) {
        return certify_proofs(bytes, spec);
    }
    let (header, proofs) = format::open(bytes)?;
    let path = spec.map_or_else(|| PathBuf::from(&header.subject), Path::to_owned);
    let subject = Subject::load(&path, header.kind, &header.readings)?;
    subject.matches(&header)?;
    let bodies = format::bodies(&header, proofs)?;
    let tasks = subject.bounds.iter().zip(&header.task).zip(&bodies);
    let bounds = tasks
        .map(|((bound, task), body)| {
            check::check(bound, task, body, threads)
                .map_err(|what| Failure::Rejected(format!("{}: {what}", task.system)))
        })
        .collect::<Result<_, _>>()?;
    Ok(Confirmed {
        header,
        bounds,
        proved: None,
    })
}

fn certify_proofs(bytes: &[u8], spec: Option<&Path>) -> Result<Confirmed, Failure> {
    let file = proof::read::read(bytes)?;
    let header = file.header;
    let path = spec.map_or_else(|| PathBuf::from(&header.subject), Path::to_owned);
    let subject = Subject::load(&path, header.kind, &header.readings)?;
    subject.matches(&header)?;
    if file.systems.len() != header.task.len() {
        return Err(Failure::Rejected(format!(
            "there are proofs for {} systems, the header speaks of {}",
            file.systems.len(),
            header.task.len()
        )));
    }
    let tasks = subject.bounds.iter().zip(&header.task).zip(&file.systems);
    let proved = tasks
        .map(|((bound, task), system)| {
            proof::check::check(bound, task, system).map_err(Failure::Rejected)
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Confirmed {
        bounds: proved.iter().map(|p| vec![None; p.by.len()]).collect(),
        header,
        proved: Some(proved),
    })
}
