//! Reading the text of a file a user names.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::diag::{Diagnostic, Diagnostics, Result};

/// No file of a user is that long; a longer one is a mistake (a device, a log).
const LONGEST: u64 = 4 << 20;

/// Reads a text file. `kind` names it in messages: `machine file`.
///
/// # Errors
/// Not there, not readable, a directory or device, longer than 4 MiB, not UTF-8, nothing in it.
pub fn read_text(path: &Path, kind: &str) -> Result<Arc<str>> {
    let name = path.display().to_string();
    let fail = |message: String, help: &str| {
        Diagnostics::from(Diagnostic::new(&name, &Arc::from(""), None, message).help(help))
    };
    if crate::files::is_carried(path) {
        let bytes = crate::files::read(path).map_err(|e| {
            let message = format!("this program carries no such {kind}: {}", plain(&e));
            fail(message, "this is an error of the family's data")
        })?;
        return decode(&name, bytes, kind);
    }
    let meta = fs::metadata(path).map_err(|e| {
        fail(
            format!("cannot read this {kind}: {}", plain(&e)),
            "check the path and the permissions",
        )
    })?;
    if meta.is_dir() {
        return Err(fail(
            format!("this is a directory, not a {kind}"),
            "name one file in it, such as milling.toml",
        ));
    }
    if !meta.is_file() {
        return Err(fail(
            format!("this is a device or pipe, not a {kind}"),
            "name a regular file",
        ));
    }
    if meta.len() > LONGEST {
        return Err(fail(
            format!("{} bytes are too long for a {kind}", meta.len()),
            "at most 4 MiB are read",
        ));
    }
    let bytes = fs::read(path).map_err(|e| {
        fail(
            format!("cannot read this {kind}: {}", plain(&e)),
            "check the path and the permissions",
        )
    })?;
    decode(&name, bytes, kind)
}

/// The operating system's words without its error number.
fn plain(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}

/// Checks that `bytes` are UTF-8 and that something is in them.
pub fn decode(name: &str, bytes: Vec<u8>, kind: &str) -> Result<Arc<str>> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let byte = error.as_bytes().get(at).copied().unwrap_or(0);
        // The replacement text keeps every offset up to the bad byte.
        let shown: Arc<str> = String::from_utf8_lossy(error.as_bytes()).into();
        Diagnostic::new(
            name,
            &shown,
            Some(at..at + '\u{fffd}'.len_utf8()),
            format!("the file is not UTF-8: byte 0x{byte:02X} at offset {at}"),
        )
        .label("not UTF-8 from here")
        .help("save the file as UTF-8; editors call this the encoding of the file")
    })?;
    let filled = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    if !text.trim_start_matches('\u{feff}').lines().any(filled) {
        return Err(
            Diagnostic::new(name, &text.into(), None, format!("this {kind} is empty"))
                .help("it starts with a line such as: family = \"sinumerik-840d\"")
                .into(),
        );
    }
    Ok(text.into())
}
