//! `stillpoint check`.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;
use stillpoint::certificate;
use stillpoint::check::{Settings, check, exit_status, summarise};
use stillpoint::readings::compare;
use stillpoint::report;
use stillpoint::subject::{self, Subject};

use super::limits::LimitOptions;
use super::progress::Line;
use super::values;
use super::{Failure, emit};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
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
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let choice = values::readings(&arguments.readings).map_err(Failure::Other)?;
    let subject = subject::load(&arguments.file, &choice.chosen)?;
    known_readings(&subject, &choice.chosen)?;
    let settings = Settings {
        threads: arguments.limits.threads,
        memory: arguments.limits.memory,
        time: arguments.limits.time,
        interpret: arguments.interpret,
    };
    let fail =
        |(title, e): (String, stillpoint_model::Error)| Failure::Other(format!("{title}: {e}"));
    let checked = check(&subject, &settings, &mut |task| {
        Box::new(Line::new(&task.title))
    })
    .map_err(fail)?;
    let summaries = summarise(&subject, &checked);
    let mut status = exit_status(&summaries, &checked);
    let compared = if choice.all {
        let compared = compare(
            &subject,
            &checked,
            &settings,
            &choice.chosen,
            &mut |title| Box::new(Line::new(title)),
        )
        .map_err(|e| match e {
            stillpoint::readings::Failed::Input(d) => Failure::Input(d),
            stillpoint::readings::Failed::Explore(title, e) => fail((title, e)),
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
                stillpoint::readings::to_json(compared),
            );
        }
        emit(&format!("{json:#}\n"));
    } else {
        emit(&report::text(&subject, &checked, &summaries));
        if let Some(compared) = &compared {
            emit(&stillpoint::readings::text(compared));
        }
    }
    // The report is out by now: it is not lost if the disk is full.
    if let Some(path) = &arguments.certificate {
        certificate::certify(path, &subject, &checked, settings.threads).map_err(Failure::Other)?;
    }
    Ok(status)
}

fn known_readings(subject: &Subject, chosen: &subject::Readings) -> Result<(), Failure> {
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
