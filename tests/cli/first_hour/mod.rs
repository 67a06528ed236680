//! The first hour of a user: a machine file of their own, in a folder of their own, and what the commands say about it.

mod acceptance;
mod answers;
mod book;
mod messages;
mod place;

use std::process::Output;

use crate::common::{Folder, command};

/// The smallest machine file.
const SMALLEST: &str =
    "family = \"sinumerik-840d\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"SBH/SG\", \"SE\"]\n";

/// Runs the binary in a folder that knows nothing of Stillpoint's sources.
fn away(folder: &Folder, arguments: &[&str]) -> Output {
    let mut command = command(arguments);
    command.current_dir(&folder.0).output().expect("it runs")
}

/// A folder outside the workspace.
fn elsewhere(name: &str) -> Folder {
    let path = std::env::temp_dir().join(format!("stillpoint-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("a folder");
    Folder(path)
}
