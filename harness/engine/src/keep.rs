//! A folder of checkpoints: one file for each exploration of a subject.

use std::path::{Path, PathBuf};
use std::time::Duration;

use stillpoint_lang::bind::Bound;
use stillpoint_model::Checkpoint;

const ENDING: &str = "checkpoint";

/// Where a check keeps its explorations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Keep {
    folder: PathBuf,
    every: Duration,
    resume: bool,
}

impl Keep {
    /// A new folder of checkpoints, made if it is not there.
    ///
    /// # Errors
    /// It cannot be made, or holds checkpoints already, which a new check would overwrite: a sentence.
    pub fn create(folder: &Path, every: Duration) -> Result<Self, String> {
        let shown = folder.display();
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("the folder {shown} for checkpoints cannot be made: {e}"))?;
        if !checkpoints(folder)?.is_empty() {
            return Err(format!(
                "{shown} already holds checkpoints; continue with --resume {shown}, or name another folder"
            ));
        }
        Ok(Self {
            folder: folder.to_owned(),
            every,
            resume: false,
        })
    }

    /// The folder of a check that was broken off.
    ///
    /// # Errors
    /// It cannot be read, holds no checkpoints or those of something else than these systems: a sentence.
    pub fn resume<'a>(
        folder: &Path,
        every: Duration,
        systems: impl Iterator<Item = &'a Bound>,
    ) -> Result<Self, String> {
        let (shown, found) = (folder.display(), checkpoints(folder)?);
        if found.is_empty() {
            return Err(format!(
                "{shown} holds no checkpoints; they are written by --checkpoint DIR"
            ));
        }
        let keep = Self {
            folder: folder.to_owned(),
            every,
            resume: true,
        };
        let names: Vec<_> = systems
            .enumerate()
            .map(|(n, bound)| keep.of(n, bound).file)
            .collect();
        let belongs = |file: &PathBuf| {
            let stem = |path: &Path| path.with_extension("").to_string_lossy().into_owned();
            names.iter().any(|n| stem(file).starts_with(&stem(n)))
        };
        match found.iter().find(|file| !belongs(file)) {
            Some(other) => Err(format!(
                "{}: this checkpoint belongs to another specification or machine than the one to check",
                other.display()
            )),
            None => Ok(keep),
        }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The checkpoint of exploration `number` of the subject. What is explored is told by everything that decides it:
    /// tables, parameter values, initial values and properties.
    pub fn of(&self, number: usize, bound: &Bound) -> Checkpoint {
        let system = &bound.system;
        let name: String = system
            .name
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
            .collect();
        let forms: Vec<_> = system.properties.iter().map(|p| (&p.id, &p.form)).collect();
        Checkpoint {
            file: self.folder.join(format!("{number:02}-{name}.{ENDING}")),
            identity: format!(
                "{} {:016x} {:?} {:?} {forms:?}",
                system.name,
                system.fingerprint(),
                bound.values,
                bound.initial
            ),
            every: self.every,
            resume: self.resume,
        }
    }
}

/// The checkpoint of another exploration that belongs to this one, told apart by a name.
pub fn beside(checkpoint: &Checkpoint, name: &str) -> Checkpoint {
    let file_name = checkpoint.file.file_stem().unwrap_or_default();
    let mut file = file_name.to_owned();
    file.push(format!("-{name}.{ENDING}"));
    Checkpoint {
        file: checkpoint.file.with_file_name(file),
        identity: format!("{} {name}", checkpoint.identity),
        ..checkpoint.clone()
    }
}

fn checkpoints(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder)
        .map_err(|e| format!("{} cannot be read: {e}", folder.display()))?;
    let paths = entries.flatten().map(|entry| entry.path());
    Ok(paths
        .filter(|path| path.extension().is_some_and(|e| e == ENDING))
        .collect())
}
