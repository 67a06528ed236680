//! Progress on stderr, for explorations that take more than a moment.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use stillpoint::report::grouped;
use stillpoint_model::{Error, Progress};

/// Shorter explorations show nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// A line that tells depth, states and rate.
pub struct Line {
    title: String,
    start: Instant,
    bar: Option<ProgressBar>,
}

impl Line {
    pub fn new(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            start: Instant::now(),
            bar: None,
        }
    }
}

impl Progress for Line {
    fn on_level(&mut self, depth: u32, states: u64, transitions: u128, frontier: u64) {
        let elapsed = self.start.elapsed();
        if elapsed < PATIENCE || !std::io::stderr().is_terminal() {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
                bar.set_style(style);
            }
            bar
        });
        let rate = (states as f64 / elapsed.as_secs_f64()) as u128;
        bar.set_message(format!(
            "{}: depth {depth}, {} states ({} a second), {} transitions, frontier {}",
            self.title,
            grouped(u128::from(states)),
            grouped(rate),
            grouped(transitions),
            grouped(u128::from(frontier)),
        ));
        bar.tick();
    }

    fn on_lost_checkpoint(&mut self, error: &Error) {
        self.warn(&format!(
            "warning: {error}; the exploration goes on, and an earlier checkpoint is still there"
        ));
    }
}

impl Line {
    fn warn(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => eprintln!("{text}"),
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
