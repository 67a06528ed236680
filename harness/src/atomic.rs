//! Files that are there in full or not at all.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes a file through `write`, under a name of its own first, then renamed. A path that is no regular file, for
/// example a device or a pipe, is written to as it is.
///
/// # Errors
/// As of writing and renaming; nothing is left behind then.
pub fn write_with(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    if path
        .metadata()
        .is_ok_and(|meta| !meta.is_file() && !meta.is_dir())
    {
        // It is neither replaced nor cut off, and need not be able to reach the disk.
        let mut out = BufWriter::new(File::options().write(true).open(path)?);
        return write(&mut out).and_then(|()| out.flush());
    }
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::other("this names no file"))?;
    let mut own = OsString::from(".");
    own.push(name);
    own.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(own);
    let done = File::create(&temporary)
        .and_then(|file| {
            let mut out = BufWriter::new(file);
            write(&mut out)?;
            out.into_inner()?.sync_all()
        })
        .and_then(|()| std::fs::rename(&temporary, path));
    if done.is_err() {
        // The first error is the one to tell.
        let _ = std::fs::remove_file(&temporary);
    }
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let dir = std::env::temp_dir().join(format!("stillpoint-atomic-{}", std::process::id()));
        std::fs::create_dir_all(&dir).expect("a folder");
        let file = dir.join("file");
        write_with(&file, |out| out.write_all(b"old")).expect("written");
        let failed = write_with(&file, |out| {
            out.write_all(b"new")?;
            Err(io::Error::other("enough"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(&file).expect("there"), b"old");
        assert_eq!(std::fs::read_dir(&dir).expect("a folder").count(), 1);
        std::fs::remove_dir_all(&dir).expect("removed");
    }
}
