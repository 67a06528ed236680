//! `stillpoint diff`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::diff::peer;
use stillpoint_harness::diff::slices::slices;
use stillpoint_harness::diff::{
    Compared, DiffError, Pairing, exhaustive, pairings, sample, text, to_json,
};
use stillpoint_harness::families;
use stillpoint_harness::recording::csv::{self, Columns};
use stillpoint_harness::recording::{self, Target, ndjson};
use stillpoint_harness::replay;
use stillpoint_harness::simulate;
use stillpoint_machine as machine;
use stillpoint_model::{Limits, Options};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_show::diagram::Diagram;

use super::interrupt::Interruptible;
use super::limits::LimitOptions;
use super::progress::Line;
use super::{Failure, emit, show, write};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// Every reachable pair of table and monitor, every input (the default)
    #[arg(long, conflicts_with = "random")]
    exhaustive: bool,
    /// Random runs of that many cycles in all
    #[arg(long, value_name = "CYCLES")]
    random: Option<u64>,
    /// Seed of the random runs
    #[arg(long, requires = "random", default_value_t = 1)]
    seed: u64,
    /// Replay a recording on monitors and tables and compare its outputs: NDJSON, or CSV with --columns
    #[arg(long, value_name = "FILE", conflicts_with_all = ["exhaustive", "random", "mutant"])]
    trace: Option<PathBuf>,
    /// The columns of a CSV recording: a TOML file, or SIGNAL=HEADING,...
    #[arg(long, value_name = "MAP", requires = "trace", alias = "csv-columns")]
    columns: Option<String>,
    /// How many cycles a recorded output may come earlier or later
    #[arg(long, value_name = "CYCLES", requires = "trace", default_value_t = 0)]
    tolerance: u32,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
    /// Draw the first divergence as a timing diagram; without a divergence nothing is written
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    limits: LimitOptions,
    /// Compare with a deliberately wrong monitor: a test of the comparison itself
    #[arg(long, value_name = "NAME")]
    mutant: Option<String>,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if let Some(path) = &arguments.trace {
        return replay(arguments, path);
    }
    let mutant = arguments
        .mutant
        .as_ref()
        .map(|name| peer::mutant(name).map_err(|e| Failure::Other(format!("`{name}`: {e}"))))
        .transpose()?;
    let subject = subject::load(&arguments.file, &Readings::new())?;
    let fail = |e: DiffError| match e {
        DiffError::Input(d) => Failure::Input(d),
        other => Failure::Other(other.to_string()),
    };
    let pairings = pairings(&subject).map_err(fail)?;
    if pairings.is_empty() {
        return Err(Failure::Other(format!(
            "{}: none of its machines has a monitor",
            subject.name
        )));
    }
    let compared = match arguments.random {
        Some(cycles) => {
            let line = Line::new("random runs");
            let progress = |done: u64, of: u64| line.share(done, of, "cycles");
            let threads = arguments.limits.threads;
            sample(
                &pairings,
                mutant,
                cycles,
                arguments.seed,
                threads,
                &progress,
            )
            .map_err(fail)?
        }
        None => {
            let interrupt = Interruptible::begin()?;
            explore(&pairings, mutant, &arguments.limits, &interrupt).map_err(fail)?
        }
    };
    let what = match arguments.random {
        Some(_) => format!("random runs, seed {}: a test, not a proof", arguments.seed),
        None if compared.iter().any(|c| !c.narrowed.is_empty()) => {
            "every reachable pair, of the inputs those values that the lines below do not leave out"
                .to_owned()
        }
        None if compared.iter().all(|c| c.held.is_empty()) => {
            "every reachable pair, every input of the interface".to_owned()
        }
        None => "every reachable pair, every input of the interface but those held".to_owned(),
    };
    let seed = arguments.random.map(|_| arguments.seed);
    if arguments.json {
        emit(&format!("{:#}\n", to_json(&compared, seed)));
    } else {
        show(&text(&compared, &what));
    }
    let mut diagrams = compared.iter().filter_map(|c| c.divergence.as_ref());
    draw(arguments, diagrams.next())?;
    Ok(if compared.iter().any(|c| c.divergence.is_some()) {
        1
    } else if compared.iter().all(|c| c.complete) {
        0
    } else {
        3
    })
}

fn explore(
    pairings: &[Pairing],
    mutant: Option<Mutant>,
    given: &LimitOptions,
    interrupt: &Interruptible,
) -> Result<Vec<Compared>, DiffError> {
    let start = Instant::now();
    let one = |pairing: &Pairing| {
        let limits = Limits {
            memory: given.memory,
            time: given.time.map(|t| t.saturating_sub(start.elapsed())),
            threads: given.threads,
        };
        let options = Options {
            limits,
            interrupt: Some(interrupt.handle()),
            ..Options::default()
        };
        exhaustive(
            pairing,
            mutant,
            &options,
            &mut Line::new(&pairing.machine).within(given.memory),
        )
    };
    let mut compared = Vec::new();
    for pairing in pairings {
        for slice in slices(pairing)? {
            compared.push(one(&slice)?);
        }
    }
    Ok(compared)
}

/// Replays a recording.
fn replay(arguments: &Arguments, path: &Path) -> Result<u8, Failure> {
    let machine = machine::load(&arguments.file, &machine::families(&arguments.file))?;
    families::of(&machine).map_err(Failure::Other)?;
    let signals = simulate::signals(&machine);
    let target = Target {
        machine: &machine.name,
        cycle_us: u64::try_from(machine.monitoring_cycle).unwrap_or(0),
        signals: &signals,
    };
    let text = recording::read_file(path)?;
    let name = path.display().to_string();
    let recording = match &arguments.columns {
        Some(map) => {
            let columns = match map.contains('=') {
                true => Columns::parse(map, &target).map_err(Failure::Other)?,
                false => Columns::load(Path::new(map))?,
            };
            csv::read(&name, &text, &columns, &target)?
        }
        // A table whose headings are the names of signals needs no map.
        None if !text.starts_with('{') => {
            csv::read(&name, &text, &Columns::by_name(&text, &target), &target)?
        }
        None => ndjson::read(&name, &text, &target)?,
    };
    let replayed =
        replay::replay(&machine, &recording, arguments.tolerance).map_err(Failure::Other)?;
    if arguments.json {
        emit(&format!("{:#}\n", replayed.to_json()));
    } else {
        emit(&replayed.text());
    }
    draw(arguments, replayed.diagram.as_ref())?;
    Ok(u8::from(!replayed.divergences.is_empty()))
}

fn draw(arguments: &Arguments, divergence: Option<&Diagram>) -> Result<(), Failure> {
    let Some(diagram) = divergence else {
        return Ok(());
    };
    write(arguments.svg.as_deref(), |out| {
        out.write_all(diagram.svg().as_bytes())
    })
}
