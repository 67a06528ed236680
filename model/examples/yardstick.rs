//! Explores the yardstick and prints the figures: `cargo run --release -p stillpoint-model --example yardstick [threads]`.

#[allow(dead_code)]
#[path = "../tests/common/yardstick.rs"]
mod yardstick;

use stillpoint_model::{Limits, Options, explore};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let threads = std::env::args().nth(1).map_or(Ok(0), |arg| arg.parse())?;
    let options = Options {
        limits: Limits {
            threads,
            ..Limits::default()
        },
        ..Options::default()
    };
    let report = explore(&yardstick::TwoAxis::new(500), &[], &options, &mut ())?;
    println!(
        "{} states, {} transitions, depth {}",
        report.states, report.transitions, report.depth
    );
    println!(
        "{:.3} s, {} bytes of tables, {:?}",
        report.seconds, report.memory, report.storage
    );
    Ok(())
}
