//! Runs the enumerations and writes the proof inventory, with the answers of Kani from `proofs/kani.toml`, `docs/src/proofs.md` or the file named as the only argument.

use std::path::PathBuf;
use std::process::ExitCode;

use stillpoint_proofs::page;
use stillpoint_proofs::results::Results;

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let default = || {
        PathBuf::from(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../docs/src/proofs.md"
        ))
    };
    let path = arguments.next().map_or_else(default, PathBuf::from);
    if arguments.next().is_some() {
        eprintln!("usage: inventory [FILE]");
        return ExitCode::from(2);
    }
    let results = page::results();
    for (entry, count) in &results {
        let state = if count.proves() {
            "holds"
        } else {
            "NOT PROVED"
        };
        println!("{:24} {state:10} {:>12} cases", entry.id, count.cases);
    }
    // Read last: the enumerations take minutes, in which a run of Kani may have ended.
    let kani = match Results::read() {
        Ok(kani) => kani,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    if let Err(error) = std::fs::write(&path, page::render(&results, &kani)) {
        eprintln!("cannot write {}: {error}", path.display());
        return ExitCode::from(2);
    }
    if results.iter().all(|(_, count)| count.proves()) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
