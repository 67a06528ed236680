//! The command line: arguments, exit status, and what goes to which stream.

mod acceptance;
mod certify;
mod check;
mod cluster;
mod colour;
mod diff;
mod explore;
mod export;
mod interrupt;
mod limits;
mod manual;
mod new;
mod pages;
mod params;
mod progress;
mod prove;
mod reaction;
mod simulate;
mod theorems;
mod trace;
mod validate;
mod values;

use std::io::{IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use miette::MietteHandlerOpts;
use stillpoint_harness::atomic::write_with;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine::{self as machine, Machine};

/// Exit status for bad input: nothing was run.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(
    name = "stillpoint",
    version,
    about = "Stillpoint proves that a machine stops: it checks the safety functions of drives exhaustively.",
    after_help = "Exit status: 0 all holds; 1 a property is violated, a divergence was found or a warning is denied; 2 bad input, nothing was run; 3 a limit was reached first.\n\nExample: stillpoint check spec/machines/milling-840d.toml"
)]
struct Arguments {
    /// Take the data of the families from this folder, in place of those that this program carries
    #[arg(long, global = true, value_name = "DIR", value_parser = family_folder)]
    family_data: Option<PathBuf>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Explore every reachable state and judge every property
    #[command(
        after_help = "Examples:\n  stillpoint check spec/machines/milling-840d.toml\n  stillpoint check spec/machines/milling-840d.toml --html milling.html\n  stillpoint check spec/bench/two-axis.toml --json\n  stillpoint check spec/bench/two-axis.toml --processes 2\n  stillpoint check spec/machines/milling-840d.toml --readings A-25=RESET_AT_ONCE"
    )]
    Check(check::Arguments),
    /// Check a certificate again, without the explorer
    #[command(
        after_help = "Exit status: 0 every claim is confirmed, also one that a property is violated; 1 the certificate does not show what it claims; 2 there is no certificate or specification to be read.\n\nExamples:\n  stillpoint check spec/machines/milling-840d.toml --certificate milling.cert\n  stillpoint certify milling.cert\n  stillpoint certify milling.cert --spec elsewhere/machines/milling-840d.toml --json"
    )]
    Certify(certify::Arguments),
    /// Check the production monitors against the tables, or both against a recording
    #[command(
        after_help = "Examples:\n  stillpoint diff spec/machines/milling-840d.toml --exhaustive\n  stillpoint diff spec/machines/milling-840d.toml --random 1000000 --seed 7\n  stillpoint diff spec/machines/milling-840d.toml --trace recorded.ndjson --tolerance 1\n  stillpoint diff spec/machines/milling-840d.toml --trace recorded.csv --columns map.toml\n  stillpoint diff spec/machines/milling-840d.toml --mutant stop-b-no-timer-exit   (must diverge)"
    )]
    Diff(diff::Arguments),
    /// Walk through the state space in the browser, on a page that only this computer sees
    #[command(
        after_help = "Prints the address of the page and serves it until the command is ended.\n\nExamples:\n  stillpoint explore spec/machines/milling-840d.toml\n  stillpoint explore spec/families/sinumerik-840d/axis.toml --system stop --port 8080"
    )]
    Explore(explore::Arguments),
    /// Write a system in the format of another tool
    #[command(
        after_help = "Examples:\n  stillpoint export spec/bench/two-axis.toml --to promela --output two-axis.pml\n  stillpoint export spec/families/sinumerik-840d/axis.toml --system stop --to dot | dot -Tsvg"
    )]
    Export(export::Arguments),
    /// The protocol of the acceptance test for exactly this machine, and what of it to repeat after a change
    #[command(
        after_help = "Exit status: 0; 1 a test that was run with --run does not give what is expected; 2 bad input.\n\nExamples:\n  stillpoint acceptance spec/machines/milling-840d.toml > protocol.md\n  stillpoint acceptance spec/machines/milling-840d.toml --html protocol.html\n  stillpoint acceptance spec/machines/milling-840d.toml --run --html protocol.html\n  stillpoint acceptance milling-840d.toml --since milling-840d.old.toml --html repeat.html"
    )]
    Acceptance(acceptance::Arguments),
    /// Reaction times from the sensor to standstill, summand by summand, and the over-travel
    #[command(
        after_help = "Exit status: 0; 1 the exploration contradicts a reaction time; 2 bad input; 3 a limit was reached first.\n\nExamples:\n  stillpoint reaction spec/machines/milling-840d.toml\n  stillpoint reaction spec/machines/milling-840d.toml --axis X --speed \"10000 mm/min\" --acceleration \"2 m/s2\"\n  stillpoint reaction spec/machines/milling-840d.toml --html reaction.html"
    )]
    Reaction(reaction::Arguments),
    /// Run a scenario on the production monitors of both channels, with a simple axis before them
    #[command(
        after_help = "Exit status: 0 every expectation of the scenario holds; 1 one does not; 2 bad input, nothing was run.\n\nExamples:\n  stillpoint simulate spec/machines/milling-840d.toml --scenario spec/scenarios/door-while-moving.toml\n  stillpoint simulate spec/machines/milling-840d.toml --scenario spec/scenarios/encoder-freeze.toml --svg freeze.svg --trace freeze.ndjson"
    )]
    Simulate(simulate::Arguments),
    /// The requirement matrix: which rules, monitors, proofs and tests carry each requirement
    #[command(
        after_help = "Exit status: 0; 1 if a family declared complete has open core requirements, an id is in no catalogue or a delegation leads nowhere; 2 bad input.\n\nExample: stillpoint trace --html matrix.html"
    )]
    Trace(trace::Arguments),
    /// The theorems of a family: what holds of its tables for every value of their parameters; proves them anew
    #[command(
        after_help = "Exit status: 0; 1 with --check, a theorem is not confirmed; 2 bad input; 3 ended from outside, what was proved before is written.\n\nExamples:\n  stillpoint theorems spec/families/sinumerik-840d\n  stillpoint theorems spec/families/sinumerik-840d --check\n  stillpoint theorems spec/families/sinumerik-840d --prove"
    )]
    Theorems(theorems::Arguments),
    /// Check whether the values of a machine file are plausible, and tell which are unusual, without exploring anything
    #[command(
        after_help = "Exit status: 0; 1 with --deny-warnings if a value is unusual and not accepted; 2 bad input.\n\nExamples:\n  stillpoint validate spec/machines/milling-840d.toml\n  stillpoint validate spec/machines/milling-840d.toml --deny-warnings"
    )]
    Validate(validate::Arguments),
    /// The parameters of a family, or one of them whole: range, default, what reads it, where the manual has it
    #[command(
        after_help = "Examples:\n  stillpoint params sinumerik-840d\n  stillpoint params sinumerik-840d STANDSTILL_TOL\n  stillpoint params sinumerik-840d 36951\n  stillpoint params heidenhain-fs SMP560 --json"
    )]
    Params(params::Arguments),
    /// A machine file to begin with: axes, doors and guarantees with values that fit each other, to be replaced by those of the machine
    #[command(
        after_help = "Examples:\n  stillpoint new sinumerik-840d --name lathe --linear X,Z --spindles S --output lathe.toml\n  stillpoint new heidenhain-fs --name mill --linear X,Y,Z --rotary C --spindles S --doors front,rear"
    )]
    New(new::Arguments),
    /// Write the pages of the book about the safety functions of a family
    #[command(
        after_help = "Exit status: 0; 1 if --check finds a difference; 2 bad input.\n\nExamples:\n  stillpoint pages spec/families/sinumerik-840d --output docs/src/functions\n  stillpoint pages spec/families/sinumerik-840d --output docs/src/functions --check"
    )]
    Pages(pages::Arguments),
    /// Print completions of commands and options for a shell
    #[command(
        after_help = "Examples:\n  stillpoint completions bash > ~/.local/share/bash-completion/completions/stillpoint\n  stillpoint completions zsh > ~/.zfunc/_stillpoint\n  stillpoint completions fish > ~/.config/fish/completions/stillpoint.fish"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write one for each command
    #[command(
        after_help = "Examples:\n  stillpoint man | man -l -\n  stillpoint man --output ~/.local/share/man/man1"
    )]
    Man {
        /// Write stillpoint.1, stillpoint-check.1 and so on to this folder, which is made if it is missing
        #[arg(long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    stillpoint_engine::table::provide(&stillpoint_tables::FAMILIES);
    let data = stillpoint_tables::FAMILIES.iter().map(|family| family.data);
    stillpoint_lang::files::provide(data.collect());
    let painted = colour::on_stderr();
    // What another program reads keeps its lines: a text that breaks where the path was long is found by no search.
    let wrapped = std::io::stderr().is_terminal();
    // Only the first hook counts, and there is no other.
    let _ = miette::set_hook(Box::new(move |_| {
        let options = MietteHandlerOpts::new().color(painted);
        Box::new(options.wrap_lines(wrapped).build())
    }));
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) => {
            let _ = e.print();
            return ExitCode::from(if e.use_stderr() { BAD_INPUT } else { 0 });
        }
    };
    if let Some(folder) = arguments.family_data {
        stillpoint_lang::files::prefer(folder);
    }
    let status = match arguments.command {
        Command::Acceptance(arguments) => acceptance::run(&arguments),
        Command::Certify(arguments) => certify::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Diff(arguments) => diff::run(&arguments),
        Command::Explore(arguments) => explore::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Reaction(arguments) => reaction::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Trace(arguments) => trace::run(&arguments),
        Command::Params(arguments) => params::run(&arguments),
        Command::Theorems(arguments) => theorems::run(&arguments),
        Command::Validate(arguments) => validate::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Pages(arguments) => pages::run(&arguments),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { output } => manual::pages(output.as_deref()),
    };
    ExitCode::from(status.unwrap_or_else(|failure| failure.show()))
}

/// A folder of families, one folder each.
fn family_folder(text: &str) -> Result<PathBuf, String> {
    let folder = PathBuf::from(text);
    let entries = std::fs::read_dir(&folder).map_err(|e| e.to_string())?;
    let mut families = entries.flatten().map(|e| e.path().join("family.toml"));
    match families.any(|f| f.is_file()) {
        true => Ok(folder),
        false => Err(
            "no folder in it holds a family.toml; name the folder above a family, such as spec/families"
                .to_owned(),
        ),
    }
}

/// Why a command did not run.
pub enum Failure {
    /// The input is wrong.
    Input(Diagnostics),
    /// Anything else that stops a command before it starts: one sentence.
    Other(String),
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Input(diagnostics)
    }
}

impl Failure {
    fn show(self) -> u8 {
        match self {
            Self::Input(Diagnostics(list)) => {
                let n = list.len();
                for diagnostic in list {
                    eprintln!("{:?}", miette::Report::new(diagnostic));
                }
                if n > 1 {
                    eprintln!("{n} errors; nothing was run");
                }
            }
            Self::Other(message) => complain(&format!("error: {message}")),
        }
        BAD_INPUT
    }
}

/// One line on stderr that begins with what is the matter.
fn complain(line: &str) {
    match colour::on_stderr() {
        true => eprintln!("{}", colour::paint(line)),
        false => eprintln!("{line}"),
    }
}

/// Writes a report to stdout, its verdicts painted where that is a terminal.
fn show(report: &str) {
    match colour::on_stdout() {
        true => emit(&colour::paint(report)),
        false => emit(report),
    }
}

/// Writes to stdout. A reader that has gone away, as in `stillpoint ... | head`, ends the output, not the program.
fn emit(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Writes a file that the user asked for, whole or not at all.
fn write(
    path: Option<&std::path::Path>,
    content: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>,
) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    write_with(path, content)
        .map_err(|e| Failure::Other(format!("{} cannot be written: {e}", path.display())))
}

/// Tells on stderr that the family's data are neither those that the program carries nor what the user named.
fn tell_data(machine: Option<&Machine>) {
    if let Some(folder) = machine.and_then(machine::strange_data) {
        complain(&format!(
            "note: family data of {}, which differ from those of this program",
            folder.display()
        ));
    }
}
