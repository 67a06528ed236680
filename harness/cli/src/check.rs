//! `stillpoint check`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::Args;
use stillpoint_engine::Reductions;
use stillpoint_engine::check::{Settings, check, exit_status, summarise};
use stillpoint_engine::keep::Keep;
use stillpoint_engine::readings::compare;
use stillpoint_engine::subject::{self, Subject};
use stillpoint_engine::theorems::Theorems;
use stillpoint_harness::certificate;
use stillpoint_harness::product;
use stillpoint_harness::proof::Which;
use stillpoint_harness::report::{self, About};
use stillpoint_harness::sweep::{Failed, sweep};

use super::cluster::ClusterOptions;
use super::interrupt::Interruptible;
use super::limits::LimitOptions;
use super::progress::Line;
use super::prove;
use super::validate::Warnings;
use super::values;
use super::{Failure, emit, show, tell_data, write};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// For a machine file also the parameters of each system and the rules that did not fire
    #[arg(short, long, conflicts_with_all = ["json", "markdown"])]
    verbose: bool,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
    /// Print the report as Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Write the report to this file as one HTML page that needs nothing else, also no network
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    limits: LimitOptions,
    /// `all` compares every option of every reading; ID=OPTION chooses one
    #[arg(long, value_name = "all|ID=OPTION")]
    readings: Vec<String>,
    /// Write a certificate of the verdicts to this file, for `stillpoint certify`
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// Use the interpreter even where there is generated code
    #[arg(long)]
    interpret: bool,
    /// Keep the exploration in this new folder, so that it can be continued after a limit, a kill or a power failure
    #[arg(long, value_name = "DIR", conflicts_with = "resume")]
    checkpoint: Option<PathBuf>,
    /// Continue from the checkpoints in this folder, and go on keeping them there
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,
    /// The least time between two checkpoints
    #[arg(long, value_name = "DURATION", value_parser = values::duration, default_value = "30s")]
    checkpoint_every: Duration,
    /// Explore less where that keeps the verdicts: `slice` (each property on what it depends on), `symmetry` (identical
    /// axes), `timers` (values of a timer stored as intervals), several with commas, or `all`. With the first two, rule
    /// coverage, absorbing states and the number of states of the whole system, which need the full exploration, are not told
    #[arg(
        long,
        value_name = "slice,symmetry,timers|all|none",
        default_value = "none"
    )]
    reduce: Reductions,
    /// Tell for which values of one parameter the guarantees of a machine file hold, in place of the report: axis.X.STANDSTILL_TOL,
    /// door.front.open, guarantee.table.within, a value of a list as axis.X.VELO_LIMIT[0]
    #[arg(long, value_name = "PARAMETER", conflicts_with_all = [
        "json", "markdown", "html", "certificate", "checkpoint", "resume", "readings", "processes"
    ])]
    sweep: Option<String>,
    /// Judge the properties by this engine and tell for each one which has decided it, in place of the report; with -v also the time
    /// of each
    #[arg(long, value_enum, value_name = "ENGINE", conflicts_with_all = [
        "markdown", "html", "checkpoint", "resume", "reduce", "sweep", "interpret", "processes"
    ])]
    engine: Option<prove::Engine>,
    /// Cycles that --engine bmc and kinduction look at at most
    #[arg(
        long,
        value_name = "CYCLES",
        default_value_t = 100,
        requires = "engine"
    )]
    depth: usize,
    /// The most wall time for each property, with --engine
    #[arg(long, value_name = "DURATION", value_parser = values::duration, requires = "engine")]
    each: Option<Duration>,
    /// Judge for every value of these parameters at once: NAME over its whole range or NAME=LO..HI, several with commas, or `all`
    #[arg(long, value_name = "all|NAME[=LO..HI],...", value_parser = prove::every, requires = "engine")]
    every: Option<Which>,
    /// Of these values only those that satisfy a condition: a comparison of one parameter with a value or another one, as "t_c <= t_d"; may
    /// be given several times
    #[arg(long = "where", value_name = "CONDITION", requires = "every")]
    conditions: Vec<String>,
    /// Judge the products of the machine, such as all of it or the axes of a group together, which are too large to be explored, in place of its
    /// parts: of families that describe some
    #[arg(long, requires = "engine", conflicts_with = "certificate")]
    whole: bool,
    /// Explore also what is a theorem of the machine's family, see `stillpoint theorems`
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    warnings: Warnings,
    #[command(flatten)]
    cluster: ClusterOptions,
}

/// The products of a machine in place of its parts.
fn whole(subject: &Subject, readings: &subject::Readings) -> Result<Subject, Failure> {
    product::products(subject, readings)?.ok_or_else(|| {
        Failure::Other(format!(
            "--whole: {} is described by its parts alone; leave it out",
            subject.name
        ))
    })
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if let Some(name) = &arguments.sweep {
        return swept(arguments, name);
    }
    let choice = values::readings(&arguments.readings).map_err(Failure::Other)?;
    let mut subject = subject::load(&arguments.file, &choice.chosen)?;
    tell_data(subject.machine.as_ref());
    known_readings(&subject, &choice.chosen)?;
    if let Some(engine) = arguments.engine {
        if choice.all {
            return Err(Failure::Other(
                "--readings all is for the explorer's report; with --engine choose options: --readings ID=OPTION".to_owned(),
            ));
        }
        if arguments.whole {
            subject = whole(&subject, &choice.chosen)?;
        }
        let asked = prove::Asked {
            engine,
            every: arguments.every.as_ref(),
            conditions: &arguments.conditions,
            depth: arguments.depth,
            each: arguments.each,
            certificate: arguments.certificate.as_deref(),
            limits: &arguments.limits,
            json: arguments.json,
            verbose: arguments.verbose,
        };
        let status = prove::run(&mut subject, &asked)?;
        return Ok(arguments.warnings.status(subject.machine.as_ref(), status));
    }
    if choice.all && (arguments.checkpoint.is_some() || arguments.resume.is_some()) {
        return Err(Failure::Other(
            "--readings all makes one check for each option; keep one of them: --readings ID=OPTION"
                .to_owned(),
        ));
    }
    if let Some(path) = &arguments.html {
        can_be_written(path)?;
    }
    let every = arguments.checkpoint_every;
    let keep = match (&arguments.checkpoint, &arguments.resume) {
        (Some(folder), _) => Some(Keep::create(folder, every)),
        (None, Some(folder)) => {
            let systems = subject.tasks.iter().map(|t| &t.bound);
            Some(Keep::resume(folder, every, systems))
        }
        (None, None) => None,
    };
    // What a reading changes is told of two explorations.
    let only = choice.all || only_explored(arguments);
    let products = match only {
        true => None,
        false => product::products(&subject, &choice.chosen)?,
    };
    let products = products.map_or(Vec::new(), |whole| whole.tasks);
    let place = arguments.cluster.meet(
        &arguments.file,
        &subject,
        arguments.limits.threads,
        &for_helpers(arguments, &choice.chosen),
    )?;
    let interrupt = Interruptible::begin()?;
    let settings = Settings {
        keep: keep.transpose().map_err(Failure::Other)?,
        threads: arguments.limits.threads,
        memory: arguments.limits.memory,
        time: arguments.limits.time,
        interpret: arguments.interpret,
        reductions: arguments.reduce,
        // Processes that explore together agree on a search without them.
        decisive: place.cluster.is_none(),
        witnesses: (arguments.markdown || arguments.html.is_some()) && place.cluster.is_none(),
        cluster: place.cluster.clone(),
        interrupt: Some(interrupt.handle()),
        // A certificate is about the system that whoever checks it makes of the file.
        exact: arguments.certificate.is_some(),
        theorems: theorems(arguments.all || only, &subject)?,
        ..Settings::default()
    };
    let start = Instant::now();
    let fail =
        |(title, e): (String, stillpoint_model::Error)| Failure::Other(format!("{title}: {e}"));
    let mut checked = check(&mut subject, &settings, &mut |task| {
        Box::new(Line::new(&task.title).within(settings.memory))
    })
    .map_err(fail)?;
    if place.is_helper() {
        return Ok(0);
    }
    let judged = product::judged(products, &settings.after(start), &mut |task| {
        Box::new(Line::new(&task.title))
    });
    for (task, mut done) in judged {
        done.ended = start.elapsed().as_secs_f64();
        subject.tasks.push(task);
        checked.push(done);
    }
    if let Some(cluster) = &place.cluster {
        eprintln!(
            "{} processes with {} threads each, {} states sent from one to another",
            cluster.processes(),
            cluster.threads(),
            report::grouped(u128::from(cluster.sent()))
        );
    }
    let summaries = summarise(&subject, &checked);
    let mut status = exit_status(&summaries, &checked);
    let compared = if choice.all {
        let compared = compare(
            &subject,
            &checked,
            &settings.after(start),
            &choice.chosen,
            &mut |title| Box::new(Line::new(title).within(settings.memory)),
        )
        .map_err(|e| match e {
            stillpoint_engine::readings::Failed::Input(d) => Failure::Input(d),
            stillpoint_engine::readings::Failed::Explore(title, e) => fail((title, e)),
        })?;
        if status == 0 && compared.iter().any(|c| !c.complete) {
            status = 3;
        }
        Some(compared)
    } else {
        None
    };
    if arguments.json {
        let mut json = report::to_json(&subject, &checked, &summaries);
        if let (Some(compared), Some(object)) = (&compared, json.as_object_mut()) {
            object.insert(
                "readings".to_owned(),
                stillpoint_harness::report::readings::to_json(compared),
            );
        }
        emit(&format!("{json:#}\n"));
    } else if !arguments.markdown {
        show(&report::text(
            &subject,
            &checked,
            &summaries,
            arguments.verbose,
        ));
        emit(&report::further(&checked, &settings));
        if let Some(compared) = &compared {
            emit(&stillpoint_harness::report::readings::text(compared));
        }
    }
    if arguments.markdown || arguments.html.is_some() {
        let mut about = About::of(&subject, &checked, &settings.after(start), &mut |_| ())
            .map_err(Failure::Other)?;
        about.readings = compared;
        let document = report::document(&subject, &checked, &summaries, &about);
        if arguments.markdown {
            emit(&document.markdown());
        }
        write(arguments.html.as_deref(), |out| {
            out.write_all(document.html().as_bytes())
        })?;
    }
    // The report is out by now: it is not lost if the disk is full, nor by a signal.
    drop(interrupt);
    if let Some(path) = &arguments.certificate {
        let line = Line::new("certificate");
        let progress = |done: usize, of: usize| line.share(done as u64, of as u64, "systems");
        certificate::certify(path, &subject, &checked, settings.threads, &progress)
            .map_err(Failure::Other)?;
    }
    Ok(arguments.warnings.status(subject.machine.as_ref(), status))
}

/// A certificate, a checkpoint and other processes are about whole explorations.
fn only_explored(arguments: &Arguments) -> bool {
    arguments.certificate.is_some()
        || arguments.checkpoint.is_some()
        || arguments.resume.is_some()
        || arguments.cluster.is_asked()
}

/// The theorems of the machine's family, unless the whole of it is explored.
fn theorems(whole: bool, subject: &Subject) -> Result<Option<Arc<Theorems>>, Failure> {
    match subject.machine.as_ref().filter(|_| !whole) {
        Some(machine) => Ok(Some(Arc::new(Theorems::load(machine.family_folder())?))),
        None => Ok(None),
    }
}

/// For which values of a parameter the guarantees hold.
fn swept(arguments: &Arguments, name: &str) -> Result<u8, Failure> {
    let interrupt = Interruptible::begin()?;
    let settings = Settings {
        threads: arguments.limits.threads,
        memory: arguments.limits.memory,
        time: arguments.limits.time,
        interpret: arguments.interpret,
        reductions: arguments.reduce,
        interrupt: Some(interrupt.handle()),
        ..Settings::default()
    };
    let line = Line::new("sweep");
    let swept = sweep(&arguments.file, name, &settings);
    drop(line);
    let swept = swept.map_err(|e| match e {
        Failed::Input(diagnostics) => Failure::Input(diagnostics),
        Failed::Other(message) => Failure::Other(message),
    })?;
    show(&swept.text());
    Ok(u8::from(!swept.holds()))
}

/// A report that cannot be written is better told before the check than after it.
fn can_be_written(path: &Path) -> Result<(), Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let why = if path.is_dir() {
        "is a folder; name a file in it"
    } else if !folder.is_dir() {
        "is in no folder that exists; make it first"
    } else {
        return Ok(());
    };
    Err(Failure::Other(format!(
        "--html {}: this {why}",
        path.display()
    )))
}

/// The options with which another process explores the same.
fn for_helpers(arguments: &Arguments, chosen: &subject::Readings) -> Vec<String> {
    let mut options = Vec::new();
    if arguments.interpret {
        options.push("--interpret".to_owned());
    }
    if let Some(bytes) = arguments.limits.memory {
        options.extend(["--memory".to_owned(), bytes.to_string()]);
    }
    for (id, option) in chosen {
        options.extend(["--readings".to_owned(), format!("{id}={option}")]);
    }
    options
}

pub(super) fn known_readings(subject: &Subject, chosen: &subject::Readings) -> Result<(), Failure> {
    let known: BTreeSet<String> = subject
        .tasks
        .iter()
        .flat_map(|t| t.bound.system.readings.iter().map(|r| r.id.clone()))
        .collect();
    match values::unknown(chosen, &known) {
        None => Ok(()),
        Some(id) => {
            let list: Vec<&str> = known.iter().map(String::as_str).collect();
            Err(Failure::Other(format!(
                "there is no reading `{id}`; this file has {}",
                list.join(", ")
            )))
        }
    }
}
