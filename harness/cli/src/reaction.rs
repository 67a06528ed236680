//! `stillpoint reaction`.

use std::path::PathBuf;

use clap::Args;
use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::reaction::{self, Error, Wishes};
use stillpoint_machine::{self as machine, Run, families};

use super::interrupt::Interruptible;
use super::limits::LimitOptions;
use super::progress::Line;
use super::{Failure, emit, tell_data, write};

#[derive(Args)]
pub struct Arguments {
    /// Machine file
    file: PathBuf,
    /// Count the over-travel at this speed, e.g. "5000 mm/min", or for one axis "X=5000 mm/min" [default: the limit of the stage]
    #[arg(long, value_name = "[AXIS=]VALUE")]
    speed: Vec<String>,
    /// Let the drive accelerate that much until the stop works, e.g. "2 m/s2" or "S=100 rev/s2" [default: 0]
    #[arg(long, value_name = "[AXIS=]VALUE")]
    acceleration: Vec<String>,
    /// Show this axis only; may be given several times
    #[arg(long, value_name = "AXIS")]
    axis: Vec<String>,
    /// Write the chains as an HTML page to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print the chains as Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Print the chains as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    limits: LimitOptions,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Input(diagnostics) => Self::Input(diagnostics),
            Error::Other(message) => Self::Other(message),
        }
    }
}

/// `X=5000 mm/min` as axis and value.
fn split(list: &[String]) -> Vec<(Option<String>, String)> {
    let parts = |text: &String| match text.split_once('=') {
        Some((axis, value)) => (Some(axis.trim().to_owned()), value.trim().to_owned()),
        None => (None, text.trim().to_owned()),
    };
    list.iter().map(parts).collect()
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let file = &arguments.file;
    let machine = machine::load(file, &families(file))?;
    tell_data(Some(&machine));
    let wishes = Wishes {
        speed: split(&arguments.speed),
        acceleration: split(&arguments.acceleration),
        axes: arguments.axis.clone(),
    };
    reaction::check_wishes(&machine, &wishes)?;
    let reactions = machine.reactions()?;
    // What no chain shown can name need not be explored.
    let shown =
        |run: &&Run| wishes.axes.is_empty() || run.axes.iter().any(|a| wishes.axes.contains(a));
    let runs: Vec<Run> = reactions.runs.iter().filter(shown).cloned().collect();
    let mut subject = subject::of_runs(file, machine.clone(), &runs, &Readings::new())?;
    let interrupt = Interruptible::begin()?;
    let settings = Settings {
        threads: arguments.limits.threads,
        memory: arguments.limits.memory,
        time: arguments.limits.time,
        interrupt: Some(interrupt.handle()),
        ..Settings::default()
    };
    let checked = check(&mut subject, &settings, &mut |task| {
        Box::new(Line::new(&task.title).within(settings.memory))
    })
    .map_err(|(title, e)| Failure::Other(format!("{title}: {e}")))?;
    let judged = reaction::judge(&machine, reactions, &subject, &checked, &wishes)?;
    let document = || reaction::document(&judged, &machine, &subject, &checked);
    write(arguments.html.as_deref(), |out| {
        out.write_all(document().html().as_bytes())
    })?;
    if arguments.json {
        let json = judged.to_json(&machine, &subject, &checked);
        emit(&format!("{json:#}\n"));
    } else if arguments.markdown {
        emit(&document().markdown());
    } else {
        emit(&reaction::text(&judged, &machine));
    }
    Ok(judged.exit_status(&checked))
}
