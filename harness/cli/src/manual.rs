//! `stillpoint completions` and `stillpoint man`: what shells and `man` know of the command line, made from its definition.

use std::path::Path;

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use stillpoint_harness::atomic::write_with;

use super::{Arguments, Failure, emit};

/// Prints the completions for a shell.
pub fn completions(shell: Shell) -> Result<u8, Failure> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "stillpoint", &mut text);
    emit(&String::from_utf8_lossy(&text));
    Ok(0)
}

/// Prints the page of the program, or writes that page and one for each command to a folder.
pub fn pages(folder: Option<&Path>) -> Result<u8, Failure> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let Some(folder) = folder else {
        emit(&String::from_utf8_lossy(&page(program)?.1));
        return Ok(0);
    };
    let commands: Vec<Command> = program.get_subcommands().cloned().collect();
    let made: Result<Vec<_>, Failure> =
        std::iter::once(program).chain(commands).map(page).collect();
    std::fs::create_dir_all(folder).map_err(|e| cannot(folder, &e))?;
    for (name, text) in made? {
        let path = folder.join(name);
        write_with(&path, |out| out.write_all(&text)).map_err(|e| cannot(&path, &e))?;
    }
    Ok(0)
}

/// The name of a command's page and its text.
fn page(command: Command) -> Result<(String, Vec<u8>), Failure> {
    let page = Man::new(command);
    let mut text = Vec::new();
    page.render(&mut text)
        .map_err(|e| Failure::Other(format!("no manual page can be made: {e}")))?;
    Ok((page.get_filename(), text))
}

fn cannot(path: &Path, e: &std::io::Error) -> Failure {
    Failure::Other(format!("{} cannot be written: {e}", path.display()))
}
