//! `stillpoint trace`.

use std::path::{Path, PathBuf};

use clap::Args;
use stillpoint_harness::export::write_atomically;
use stillpoint_harness::matrix::{self, Matrix, ReadError};

use super::{Failure, emit};

#[derive(Args)]
pub struct Arguments {
    /// Write the matrix as an HTML page too
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print the matrix as JSON
    #[arg(long)]
    json: bool,
    /// The repository [default: the nearest folder upwards with a Cargo.toml and a folder impl]
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let none = "no folder from here upwards has a Cargo.toml and a folder impl; name the repository with --root";
    let root = match &arguments.root {
        Some(root) => root.clone(),
        None => matrix::find_root(Path::new(".")).ok_or_else(|| Failure::Other(none.to_owned()))?,
    };
    let sources = matrix::read(&root).map_err(|e| match e {
        ReadError::File(diagnostics) => Failure::Input(diagnostics),
        ReadError::Other(message) => Failure::Other(message),
    })?;
    let matrix = Matrix::new(&sources);
    if let Some(path) = &arguments.html {
        write_atomically(path, &matrix::html(&matrix))
            .map_err(|e| Failure::Other(format!("{} cannot be written: {e}", path.display())))?;
    }
    if arguments.json {
        emit(&format!("{:#}\n", matrix::to_json(&matrix)));
    } else {
        emit(&matrix::text(&matrix));
    }
    Ok(matrix.exit_status())
}
