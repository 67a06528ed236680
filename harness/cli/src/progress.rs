//! Progress on stderr, for work that takes more than a moment. Nothing is drawn where stderr is no terminal.

use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressState, ProgressStyle};
use stillpoint_harness::report::grouped;
use stillpoint_model::{Error, Progress};

/// Shorter work shows nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two drawings: a long level is seen to go on.
const TICK: Duration = Duration::from_millis(200);

/// All lines, one below the other.
static LINES: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// A line that tells what is being done and how far it is.
pub struct Line {
    now: Arc<Mutex<Now>>,
    bar: Option<ProgressBar>,
}

/// What the line tells.
struct Now {
    title: String,
    start: Instant,
    /// The most bytes the explorer may hold, if there is a limit.
    limit: Option<u64>,
    held: u64,
    stage: Stage,
}

#[derive(Clone, Copy)]
enum Stage {
    /// Nothing is counted.
    Unknown,
    /// An exploration, by its last complete level.
    Level {
        depth: u32,
        states: u64,
        frontier: u64,
    },
    /// So many of a known number.
    Share {
        done: u64,
        of: u64,
        unit: &'static str,
    },
}

impl Line {
    /// A line about the work of this title.
    pub fn new(title: &str) -> Self {
        let now = Arc::new(Mutex::new(Now {
            title: title.to_owned(),
            start: Instant::now(),
            limit: None,
            held: 0,
            stage: Stage::Unknown,
        }));
        let bar = std::io::stderr().is_terminal().then(|| {
            let shown = Arc::clone(&now);
            let line = move |_: &ProgressState, out: &mut dyn Write| {
                // A formatter that fails has nobody to tell it to.
                let _ = write!(
                    out,
                    "{}",
                    shown.lock().unwrap_or_else(PoisonError::into_inner).text()
                );
            };
            let bar = LINES.add(ProgressBar::new_spinner());
            if let Ok(style) = ProgressStyle::with_template("{line}") {
                bar.set_style(style.with_key("line", line));
            }
            bar.enable_steady_tick(TICK);
            bar
        });
        Self { now, bar }
    }

    /// The same under a limit on memory, if there is one.
    pub fn within(self, limit: Option<u64>) -> Self {
        self.change(|now| now.limit = limit);
        self
    }

    /// Tells that `done` of `of` things are done.
    pub fn share(&self, done: u64, of: u64, unit: &'static str) {
        self.change(|now| now.stage = Stage::Share { done, of, unit });
    }

    fn change(&self, change: impl FnOnce(&mut Now)) {
        change(&mut self.now.lock().unwrap_or_else(PoisonError::into_inner));
    }

    fn warn(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => eprintln!("{text}"),
        }
    }
}

impl Now {
    /// The line; empty as long as the work has taken but a moment.
    fn text(&self) -> String {
        match self.start.elapsed() {
            elapsed if elapsed < PATIENCE => String::new(),
            elapsed => self.after(elapsed, available()),
        }
    }

    /// The line after this time, with so many bytes that the machine can still give.
    fn after(&self, elapsed: Duration, available: Option<u64>) -> String {
        let rate = |n: u64| grouped((n as f64 / elapsed.as_secs_f64()) as u128);
        let number = |n: u64| grouped(u128::from(n));
        let told = match self.stage {
            Stage::Unknown => return format!("{} s  {}", elapsed.as_secs(), self.title),
            Stage::Level {
                depth,
                states,
                frontier,
            } => {
                let left = match (self.limit.map(|l| l.saturating_sub(self.held)), available) {
                    (Some(allowed), Some(there)) => Some(allowed.min(there)),
                    (one, other) => one.or(other),
                };
                let left = left.map_or(String::new(), |bytes| format!(", {} left", size(bytes)));
                format!(
                    "{} states, {}/s, depth {depth}, frontier {}, {} held{left}",
                    number(states),
                    rate(states),
                    number(frontier),
                    size(self.held),
                )
            }
            Stage::Share { done, of, unit } => {
                let percent = u128::from(done) * 100 / u128::from(of.max(1));
                format!(
                    "{} of {} {unit} ({percent} %), {}/s",
                    number(done),
                    number(of),
                    rate(done),
                )
            }
        };
        format!("{} s  {}: {told}", elapsed.as_secs(), self.title)
    }
}

/// Bytes in the largest unit that leaves a number of at least 1: `1.9 GiB`.
fn size(bytes: u64) -> String {
    let mut value = bytes as f64;
    for unit in ["B", "KiB", "MiB", "GiB"] {
        if value < 1024.0 {
            let digits = usize::from(unit != "B");
            return format!("{value:.digits$} {unit}");
        }
        value /= 1024.0;
    }
    format!("{value:.1} TiB")
}

/// Bytes of memory that the machine can still give; none where the system does not tell it this way.
fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

impl Progress for Line {
    fn on_level(&mut self, depth: u32, states: u64, _: u128, frontier: u64) {
        self.change(|now| {
            now.stage = Stage::Level {
                depth,
                states,
                frontier,
            };
        });
    }

    fn on_memory(&mut self, bytes: u64) {
        self.change(|now| now.held = bytes);
    }

    fn on_lost_checkpoint(&mut self, error: &Error) {
        self.warn(&format!(
            "warning: {error}; the exploration goes on, and an earlier checkpoint is still there"
        ));
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now(stage: Stage, limit: Option<u64>, held: u64) -> Now {
        Now {
            title: "stops".to_owned(),
            start: Instant::now(),
            limit,
            held,
            stage,
        }
    }

    #[test]
    fn a_level_is_told_with_rate_and_memory_left() {
        let level = Stage::Level {
            depth: 7,
            states: 4_000_000,
            frontier: 1200,
        };
        let after = Duration::from_secs(4);
        assert_eq!(
            now(level, Some(3 << 30), 1 << 30).after(after, Some(8 << 30)),
            "4 s  stops: 4 000 000 states, 1 000 000/s, depth 7, frontier 1 200, 1.0 GiB held, 2.0 GiB left"
        );
        let unlimited = now(level, None, 1 << 20);
        assert!(
            unlimited
                .after(after, Some(1 << 30))
                .ends_with("1.0 MiB held, 1.0 GiB left")
        );
        assert!(unlimited.after(after, None).ends_with("1.0 MiB held"));
    }

    #[test]
    fn a_share_is_told_in_percent_and_short_work_not_at_all() {
        let share = Stage::Share {
            done: 500,
            of: 2000,
            unit: "cycles",
        };
        assert_eq!(
            now(share, None, 0).after(Duration::from_secs(5), None),
            "5 s  stops: 500 of 2 000 cycles (25 %), 100/s"
        );
        assert_eq!(now(share, None, 0).text(), "");
    }
}
