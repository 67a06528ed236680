//! `stillpoint validate`.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use stillpoint_engine::subject;
use stillpoint_harness::report::{counted, values};
use stillpoint_machine::Machine;

use super::{Failure, complain, show, tell_data};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// List also the explorations that `check` would make, and in what each is coarser than the machine
    #[arg(short, long)]
    verbose: bool,
    #[command(flatten)]
    warnings: Warnings,
}

/// What becomes of warnings about values.
#[derive(Args)]
pub struct Warnings {
    /// Exit status 1 if there is a warning about a value that the machine file does not accept
    #[arg(long)]
    deny_warnings: bool,
}

impl Warnings {
    /// The exit status, which a warning makes 1 where it is denied; bad input and violated properties keep theirs.
    pub fn status(&self, machine: Option<&Machine>, status: u8) -> u8 {
        let open = values::unaccepted(machine);
        if !self.deny_warnings || open == 0 {
            return status;
        }
        let warnings = counted(open as u64, "warning");
        complain(&format!(
            "error: {warnings} about the values (--deny-warnings): correct the values, or accept them under [[accepted]]"
        ));
        match status {
            0 | 3 => 1,
            other => other,
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let file = &arguments.file;
    let subject = subject::load(file, &subject::Readings::new())?;
    tell_data(subject.machine.as_ref());
    let mut out = format!("{}: plausible", subject.name);
    if let Some(machine) = &subject.machine {
        let axes: Vec<&str> = machine.axes.iter().map(|a| a.name.as_str()).collect();
        let _ = write!(out, "; axes {}", axes.join(", "));
    }
    let explorations = counted(subject.tasks.len() as u64, "exploration");
    let _ = write!(out, "; `check` makes {explorations}");
    out.push_str(if arguments.verbose {
        "\n"
    } else {
        ", listed with -v\n"
    });
    for task in subject.tasks.iter().filter(|_| arguments.verbose) {
        let _ = writeln!(
            out,
            "  to explore: {} ({})",
            task.title, task.bound.system.name
        );
        for item in &task.abstractions {
            let _ = writeln!(out, "    abstraction: {}", item.text);
        }
    }
    if let Some(machine) = &subject.machine {
        out.push_str(&values::text(machine, &file.display().to_string()));
    }
    show(&out);
    Ok(arguments.warnings.status(subject.machine.as_ref(), 0))
}
