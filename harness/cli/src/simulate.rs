//! `stillpoint simulate`.

use std::path::PathBuf;

use clap::Args;
use stillpoint_harness::families;
use stillpoint_harness::recording::{csv, ndjson};
use stillpoint_harness::simulate::{self, Scenario};
use stillpoint_machine as machine;

use super::{Failure, emit, tell_data, write};

#[derive(Args)]
pub struct Arguments {
    /// Machine file
    file: PathBuf,
    /// Scenario file: motions, doors, modes, faults at given times
    #[arg(long, value_name = "FILE")]
    scenario: PathBuf,
    /// Write the diagram as a picture
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write every signal of every cycle as a table
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a recording that `diff --trace` replays
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Print stops and expectations only, without the diagram
    #[arg(long)]
    brief: bool,
    /// List also the times that are no whole number of cycles, with what became of them
    #[arg(short, long)]
    verbose: bool,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let machine = machine::load(&arguments.file, &machine::families(&arguments.file))?;
    tell_data(Some(&machine));
    // Before the scenario: its messages name what this family alone has.
    families::of(&machine).map_err(Failure::Other)?;
    let scenario = Scenario::load(&arguments.scenario, &machine)?;
    let simulation = simulate::run(&machine, &scenario).map_err(Failure::Other)?;
    let diagram = simulation.diagram();
    write(arguments.svg.as_deref(), |out| {
        out.write_all(diagram.svg().as_bytes())
    })?;
    write(arguments.csv.as_deref(), |out| {
        csv::write(&simulation.recording, out)
    })?;
    write(arguments.trace.as_deref(), |out| {
        ndjson::write(&simulation.recording, out)
    })?;
    let mut text = match simulation.title.as_str() {
        "" => String::new(),
        title => format!("{title}\n"),
    };
    text.push_str(&simulation.summary(arguments.verbose));
    if !arguments.brief {
        text.push('\n');
        text.push_str(&simulation.text());
    }
    emit(&text);
    Ok(u8::from(!simulation.holds()))
}
