//! `stillpoint explore`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use stillpoint_engine::subject;
use stillpoint_harness::browse::server::Listening;
use stillpoint_harness::browse::{Bounds, Walks};
use stillpoint_harness::export::select;

use super::{Failure, emit, values};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// The port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// The system shown first, where the file has several: NAME, NAME:AXIS, or the number of its run
    #[arg(long, value_name = "NAME|N")]
    system: Option<String>,
    /// ID=OPTION chooses an option of a reading
    #[arg(long, value_name = "ID=OPTION")]
    readings: Vec<String>,
    /// Most wall time of the exploration for a counterexample or witness
    #[arg(long, value_name = "DURATION", value_parser = values::duration, default_value = "20s")]
    time: Duration,
    /// Most memory of that exploration
    #[arg(long, value_name = "SIZE", value_parser = values::size, default_value = "1GiB")]
    memory: u64,
    /// Its worker threads [default: all processors]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    threads: usize,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let choice = values::readings(&arguments.readings).map_err(Failure::Other)?;
    if choice.all {
        return Err(Failure::Other(
            "one walk has one option of each reading; write --readings ID=OPTION".to_owned(),
        ));
    }
    let subject = subject::load(&arguments.file, &choice.chosen)?;
    super::check::known_readings(&subject, &choice.chosen)?;
    let start = match arguments.system.as_deref() {
        None => 0,
        Some(wanted) => {
            let chosen = select(&subject, Some(wanted)).map_err(Failure::Other)?;
            let mut tasks = subject.tasks.iter();
            tasks
                .position(|task| std::ptr::eq(task, chosen))
                .unwrap_or(0)
        }
    };
    let bounds = Bounds {
        time: arguments.time,
        memory: arguments.memory,
        threads: arguments.threads,
    };
    let walks = Walks::new(subject, start, bounds);
    let listening = Listening::new(arguments.port).map_err(Failure::Other)?;
    emit(&format!("{}\n", listening.url()));
    eprintln!("The page is there until this command is ended (Ctrl+C).");
    listening.serve(&walks);
    Ok(0)
}
