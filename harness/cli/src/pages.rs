//! `stillpoint pages`.

use std::path::PathBuf;

use clap::Args;
use stillpoint_harness::export::write_atomically;
use stillpoint_harness::pages::{PagesError, differences, pages, target};

use super::{Failure, emit};

#[derive(Args)]
pub struct Arguments {
    /// Folders of families
    #[arg(required = true, value_name = "FAMILY")]
    families: Vec<PathBuf>,
    /// Write the pages of each family to a folder of its name in this one
    #[arg(long, value_name = "DIR")]
    output: PathBuf,
    /// Write nothing: tell which files are not as they would be written
    #[arg(long)]
    check: bool,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let mut made = Vec::new();
    for family in &arguments.families {
        let written = pages(family).map_err(|e| match e {
            PagesError::Input(found) => Failure::Input(found),
            PagesError::Diagram(message) => Failure::Other(message),
        })?;
        let folder = target(&arguments.output, family).ok_or_else(|| {
            Failure::Other(format!("{} is no folder of a family", family.display()))
        })?;
        made.push((folder, written));
    }
    let mut status = 0;
    for (folder, written) in made {
        if !arguments.check {
            let cannot = |path: &std::path::Path, e: std::io::Error| {
                Failure::Other(format!("{} cannot be written: {e}", path.display()))
            };
            std::fs::create_dir_all(&folder).map_err(|e| cannot(&folder, e))?;
            for file in &written {
                let path = folder.join(&file.name);
                write_atomically(&path, &file.text).map_err(|e| cannot(&path, e))?;
            }
        }
        let different = differences(&folder, &written);
        for one in &different {
            emit(&format!("{}/{one}\n", folder.display()));
        }
        if arguments.check && !different.is_empty() {
            status = 1;
        }
        let verb = if arguments.check {
            "compared"
        } else {
            "written"
        };
        emit(&format!(
            "{}: {} files {verb}\n",
            folder.display(),
            written.len()
        ));
    }
    Ok(status)
}
