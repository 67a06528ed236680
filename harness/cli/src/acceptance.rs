//! `stillpoint acceptance`.

use std::path::{Path, PathBuf};

use clap::Args;
use stillpoint_harness::acceptance::{
    Undecided, checksums, decide, document, run as simulate, selected, since, to_json,
};
use stillpoint_machine::acceptance::{Protocol, Simulated};
use stillpoint_machine::{self as machine, Machine, families};

use super::{Failure, emit, tell_data, write};

#[derive(Args)]
pub struct Arguments {
    /// Machine file
    file: PathBuf,
    /// Write the protocol as an HTML page to this file, for printing
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print the protocol as Markdown, as without any option
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Print the protocol as JSON
    #[arg(long)]
    json: bool,
    /// An earlier state of the machine file: say what changed, and give only the tests to be repeated
    #[arg(long, value_name = "OLD.toml")]
    since: Option<PathBuf>,
    /// Run the tests that have a scenario on the production monitors with a simulated axis, and say what came of it
    #[arg(long)]
    run: bool,
    /// Explore what decides the guarantees of the machine file, and put verdicts, bounds and the values they depend on into the protocol
    #[arg(long)]
    guarantees: bool,
}

fn load(path: &Path) -> Result<(Machine, Protocol), Failure> {
    let machine = machine::load(path, &families(path))?;
    tell_data(Some(&machine));
    let protocol = machine.acceptance()?;
    Ok((machine, protocol))
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let (machine, mut protocol) = load(&arguments.file)?;
    let since = match &arguments.since {
        Some(path) => {
            let (old, before) = load(path)?;
            if old.family != machine.family {
                return Err(Failure::Other(format!(
                    "{} is of the family {}, {} of {}: machines of different families cannot be compared; repeat every test",
                    path.display(),
                    old.family,
                    arguments.file.display(),
                    machine.family
                )));
            }
            Some(since(&old, &before, &machine, &protocol))
        }
        None => None,
    };
    let sums = checksums(&arguments.file, &machine)
        .map_err(|e| Failure::Other(format!("the checksums cannot be made: {e}")))?;
    let ran = match arguments.run {
        true => {
            let tests = selected(&protocol, since.as_ref());
            let (ran, unfit) = simulate(&machine, &tests);
            for one in unfit {
                let test = protocol.tests.iter_mut().find(|t| t.id == one.id);
                if let Some(test) = test {
                    test.simulated = Simulated::Not(one.reason);
                }
            }
            Some(ran)
        }
        false => None,
    };
    let decided = match arguments.guarantees {
        true => Some(decide(&arguments.file, &machine).map_err(|e| match e {
            Undecided::Input(diagnostics) => Failure::Input(diagnostics),
            Undecided::Other(message) => Failure::Other(message),
        })?),
        false => None,
    };
    let (since, ran) = (since.as_ref(), ran.as_deref());
    let document = document(&machine, &protocol, &sums, since, ran, decided.as_ref());
    write(arguments.html.as_deref(), |out| {
        out.write_all(document.html().as_bytes())
    })?;
    if arguments.json {
        let json = to_json(&machine, &protocol, &sums, since, ran, decided.as_ref());
        emit(&format!("{json:#}\n"));
    } else if arguments.markdown || arguments.html.is_none() {
        emit(&document.markdown());
    }
    let holds = ran.iter().copied().flatten().all(|r| r.holds);
    let holds = holds && decided.is_none_or(|d| d.hold);
    Ok(u8::from(!holds))
}
