//! `stillpoint certify`.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use stillpoint_certify::format::Verdict;
use stillpoint_certify::{Confirmed, certify};

use super::progress::Line;
use super::{BAD_INPUT, Failure, complain, emit, show};

#[derive(Args)]
pub struct Arguments {
    /// Certificate written by `check --certificate`
    file: PathBuf,
    /// The specification or machine file, where it is not the path that the certificate names
    #[arg(long, value_name = "FILE")]
    spec: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Worker threads; 0 for all processors
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let threads = match arguments.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    let name = arguments.file.display();
    let line = Line::new(&format!("checking {name}"));
    let checked = certify(&arguments.file, arguments.spec.as_deref(), threads);
    drop(line);
    match checked {
        Ok(confirmed) => {
            match arguments.json {
                true => emit(&format!("{:#}\n", to_json(&confirmed))),
                false => show(&text(&confirmed)),
            }
            Ok(0)
        }
        Err(failure) => {
            let (status, word) = match failure {
                stillpoint_certify::Failure::Rejected(_) => (1, "rejected"),
                stillpoint_certify::Failure::Unreadable(_) => (BAD_INPUT, "unreadable"),
            };
            let reason = failure.to_string().replace('\n', " ");
            if arguments.json {
                emit(&format!(
                    "{:#}\n",
                    json!({ "result": word, "reason": reason })
                ));
            }
            complain(&format!("{word}: {name}: {reason}"));
            Ok(status)
        }
    }
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::Violated => "violated",
        Verdict::Vacuous => "vacuous",
        Verdict::Reached => "reached",
        Verdict::Unreachable => "unreachable",
        Verdict::Open => "not certified",
    }
}

/// How many claims there are of one verdict.
fn count(confirmed: &Confirmed, of: impl Fn(Verdict) -> bool) -> usize {
    let properties = confirmed.header.task.iter().flat_map(|task| &task.property);
    properties.filter(|p| of(p.verdict)).count()
}

fn text(confirmed: &Confirmed) -> String {
    let header = &confirmed.header;
    let faults: usize = header.task.iter().map(|task| task.faults.len()).sum();
    let ranges = |verdict| {
        let proved = confirmed.proved.iter().flatten();
        let ranges = proved.filter_map(|p| p.range.as_ref());
        ranges.filter(|(v, _)| *v == verdict).count()
    };
    let faults = faults + ranges(Verdict::Violated);
    let claims = count(confirmed, |v| v != Verdict::Open) + faults + ranges(Verdict::Holds);
    let mut out = format!("{}: CONFIRMED, {claims} claims", header.subject);
    let violated = count(confirmed, |v| v == Verdict::Violated) + faults;
    let unreachable = count(confirmed, |v| v == Verdict::Unreachable);
    let open = count(confirmed, |v| v == Verdict::Open);
    for (number, what) in [
        (violated, "of them violations"),
        (unreachable, "of them missing witnesses"),
        (open, "properties not certified"),
    ] {
        if number > 0 {
            let _ = write!(out, ", {number} {what}");
        }
    }
    out.push('\n');
    for source in &header.file {
        let _ = writeln!(out, "  {}  {}", source.sha256, source.name);
    }
    for (id, option) in &header.readings {
        let _ = writeln!(out, "  reading {id}: {option}");
    }
    for (k, (task, bounds)) in header.task.iter().zip(&confirmed.bounds).enumerate() {
        let proved = confirmed.proved.as_ref().map(|all| &all[k]);
        let _ = writeln!(out, "\n{} ({})", task.title, task.system);
        for (name, value) in &task.parameters {
            let every = proved.map_or(&[][..], |proved| &proved.free.every[..]);
            let _ = match every.iter().find(|(free, _)| free == name) {
                Some((_, (lo, hi))) => writeln!(out, "  {name} = {lo} .. {hi}, every value"),
                None => writeln!(out, "  {name} = {value}"),
            };
        }
        for condition in proved.iter().flat_map(|proved| &proved.free.conditions) {
            let _ = writeln!(out, "  where {condition}");
        }
        match task.states {
            _ if proved.is_some() => {}
            0 => out.push_str("  runs only: nothing is claimed about all runs\n"),
            states => {
                let _ = writeln!(
                    out,
                    "  {states} states, closed under every combination of inputs"
                );
            }
        }
        for fault in &task.faults {
            let _ = writeln!(out, "  violated       range: {fault}");
        }
        if let Some((claimed, by)) = proved.and_then(|proved| proved.range.as_ref()) {
            let what = "range: no assignment leaves the range of its variable";
            let _ = writeln!(out, "  {:<14} {what} [{by}]", verdict(*claimed));
        }
        for (n, (property, bound)) in task.property.iter().zip(bounds).enumerate() {
            let by = proved.map_or("", |proved| &proved.by[n]);
            let by = match by {
                "" => String::new(),
                by => format!(" [{by}]"),
            };
            let bound = bound.map_or(String::new(), |n| format!(" [in at most {n} cycles]"));
            let recorded = |w: &String| w.starts_with("exactly: ") || w.starts_with("fastest: ");
            let reason = match property.reason.as_str() {
                "" if property.written.iter().any(recorded) => {
                    " (without the recorded bounds)".to_owned()
                }
                "" => String::new(),
                reason => format!(" ({reason})"),
            };
            let (word, id) = (verdict(property.verdict), &property.id);
            let _ = writeln!(
                out,
                "  {word:<14} {id}: {}{bound}{by}{reason}",
                property.text
            );
        }
    }
    out
}

fn to_json(confirmed: &Confirmed) -> serde_json::Value {
    let header = &confirmed.header;
    let tasks = header
        .task
        .iter()
        .zip(&confirmed.bounds)
        .enumerate()
        .map(|(k, (task, bounds))| {
            let proved = confirmed.proved.as_ref().map(|all| &all[k]);
            let properties = task.property.iter().zip(bounds).enumerate();
            let properties = properties.map(|(n, (p, bound))| {
                json!({
                    "id": p.id, "text": p.text, "verdict": verdict(p.verdict),
                    "bound": bound, "reason": p.reason, "by": proved.map(|proved| &proved.by[n]),
                })
            });
            json!({
                "every": proved.map(|proved| &proved.free.every),
                "where": proved.map(|proved| &proved.free.conditions),
                "range": proved.and_then(|proved| proved.range.as_ref()).map(|(v, _)| verdict(*v)),
                "system": task.system, "title": task.title, "parameters": task.parameters,
                "states": task.states, "faults": task.faults,
                "properties": properties.collect::<Vec<_>>(),
            })
        });
    let files = header.file.iter();
    json!({
        "result": "confirmed",
        "subject": header.subject,
        "files": files.map(|f| json!({ "name": f.name, "sha256": f.sha256 })).collect::<Vec<_>>(),
        "readings": header.readings,
        "confirmed": count(confirmed, |v| v != Verdict::Open),
        "violated": count(confirmed, |v| v == Verdict::Violated),
        "not_certified": count(confirmed, |v| v == Verdict::Open),
        "tasks": tasks.collect::<Vec<_>>(),
    })
}
