//! Where the data of the families come from: a folder, or the program itself.
//!
//! A program may carry the data of the families it was built with ([`provide`]). They stand under the path [`BUILT_IN`], which
//! no file system has. Everything that reads a family's data reads through this module, so that both places are alike.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The folder, in name only, of the families that the program carries.
pub const BUILT_IN: &str = "<built in>";

/// A file that the program carries: `family/name.toml` and its bytes.
pub type Carried = (&'static str, &'static [u8]);

static CARRIED: OnceLock<Vec<&'static [Carried]>> = OnceLock::new();
static PREFERRED: OnceLock<PathBuf> = OnceLock::new();

/// Gives the program the files of its families; only the first call counts.
pub fn provide(families: Vec<&'static [Carried]>) {
    let _ = CARRIED.set(families);
}

/// Takes the families from this folder, wherever a machine file lies; only the first call counts.
pub fn prefer(folder: PathBuf) {
    let _ = PREFERRED.set(folder);
}

/// The folder that was preferred.
pub fn preferred() -> Option<&'static Path> {
    PREFERRED.get().map(PathBuf::as_path)
}

/// The families that the program carries, if it does.
pub fn built_in() -> Option<PathBuf> {
    CARRIED.get().map(|_| PathBuf::from(BUILT_IN))
}

/// Whether the folders of the same name hold the same data files, in the program and in `root`.
pub fn same_as_built_in(root: &Path, family: &str) -> bool {
    let here = root.join(family);
    let carried = Path::new(BUILT_IN).join(family);
    let contents = |folder: &Path| -> io::Result<Vec<(PathBuf, Vec<u8>)>> {
        let named = list(folder)?.into_iter();
        let named = named.filter(|p| p.extension().is_some_and(|e| e == "toml"));
        named
            .map(|p| Ok((PathBuf::from(p.file_name().unwrap_or_default()), read(&p)?)))
            .collect()
    };
    match (contents(&here), contents(&carried)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// The path below [`BUILT_IN`], with `/` between its parts; `x/../y` is `y`.
fn carried(path: &Path) -> Option<String> {
    let rest = path.strip_prefix(BUILT_IN).ok()?;
    let mut parts: Vec<String> = Vec::new();
    for part in rest.components() {
        match part {
            std::path::Component::ParentDir => _ = parts.pop(),
            std::path::Component::CurDir => {}
            other => parts.push(other.as_os_str().to_string_lossy().into_owned()),
        }
    }
    Some(parts.join("/"))
}

fn all() -> impl Iterator<Item = &'static Carried> {
    CARRIED.get().into_iter().flatten().copied().flatten()
}

/// The bytes of a file.
///
/// # Errors
/// As [`std::fs::read`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let Some(name) = carried(path) else {
        return std::fs::read(path);
    };
    let found = all().find(|(known, _)| *known == name);
    found
        .map(|(_, bytes)| bytes.to_vec())
        .ok_or_else(|| io::ErrorKind::NotFound.into())
}

/// The text of a file.
///
/// # Errors
/// As [`std::fs::read_to_string`].
pub fn read_to_string(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|e| io::Error::new(io::ErrorKind::InvalidData, e))
}

/// Whether the path is one of the program's own files.
pub fn is_carried(path: &Path) -> bool {
    carried(path).is_some()
}

/// Whether there is such a file.
pub fn is_file(path: &Path) -> bool {
    match carried(path) {
        Some(name) => all().any(|(known, _)| *known == name),
        None => path.is_file(),
    }
}

/// The paths in a folder, sorted.
///
/// # Errors
/// As [`std::fs::read_dir`].
pub fn list(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut out: Vec<PathBuf> = match carried(folder) {
        None => std::fs::read_dir(folder)?
            .map(|entry| entry.map(|e| e.path()))
            .collect::<io::Result<_>>()?,
        Some(name) => {
            let below = all().filter_map(|(known, _)| match name.is_empty() {
                true => Some(*known),
                false => known.strip_prefix(&name)?.strip_prefix('/'),
            });
            let first = below.filter_map(|rest| rest.split('/').next());
            first.map(|part| folder.join(part)).collect()
        }
    };
    out.sort();
    out.dedup();
    Ok(out)
}

/// Whether there is such a folder.
pub fn is_dir(path: &Path) -> bool {
    match carried(path) {
        Some(_) => !is_file(path) && list(path).is_ok_and(|l| !l.is_empty()),
        None => path.is_dir(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carried_files_read_like_a_folder() {
        provide(vec![
            &[("a/family.toml", b"x"), ("a/b.toml", b"y")],
            &[("c/d.toml", b"z")],
        ]);
        let root = built_in().expect("provided");
        assert_eq!(
            list(&root).expect("a folder"),
            [root.join("a"), root.join("c")]
        );
        assert_eq!(
            list(&root.join("a")).expect("a folder"),
            [root.join("a/b.toml"), root.join("a/family.toml")]
        );
        assert_eq!(read(&root.join("a/../c/d.toml")).expect("a file"), b"z");
        assert!(is_file(&root.join("a/b.toml")) && !is_file(&root.join("a")));
        assert!(is_dir(&root.join("a")) && !is_dir(&root.join("e")));
        assert!(read(&root.join("a/e.toml")).is_err());
    }
}
