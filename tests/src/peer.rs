//! Running other tools on exported systems.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings, Subject, Task};
use stillpoint_lang::bind::Bound;
use stillpoint_model::Report;

use crate::root;

/// Whether these programs are there and start. A user without them sees that the test was skipped; where the environment has
/// `CI`, it fails then.
///
/// # Panics
/// If one is missing and `CI` is set.
pub fn tools(programs: &[&str]) -> bool {
    for program in programs {
        let reason = match Command::new(program).arg("--version").output() {
            // SPIN answers with its usage and status 1.
            Ok(output) if output.status.success() || !output.stdout.is_empty() => continue,
            Ok(output) => format!(
                "does not start: {}, {}",
                output.status,
                String::from_utf8_lossy(&output.stderr).trim()
            ),
            Err(error) => format!("is not installed: {error}"),
        };
        let message = format!("SKIPPED: {program} {reason}");
        assert!(std::env::var_os("CI").is_none(), "{message}");
        eprintln!("{message}");
        return false;
    }
    true
}

/// Whether a program is there and starts with this option: for a tool that another one can stand in for.
pub fn starts(program: &str, option: &str) -> bool {
    let output = Command::new(program).arg(option).output();
    output.is_ok_and(|output| output.status.success())
}

/// A peer that `.ci/peers` has put into `target/tools`, if it is there. A user without it sees that the test was skipped; where
/// the environment has `CI`, it fails then.
///
/// # Panics
/// If it is missing and `CI` is set.
pub fn fetched(file: &str) -> Option<PathBuf> {
    let path = root().join("target/tools").join(file);
    if path.exists() {
        return Some(path);
    }
    let message = format!("SKIPPED: {file} is not in target/tools; .ci/peers puts it there");
    assert!(std::env::var_os("CI").is_none(), "{message}");
    eprintln!("{message}");
    None
}

/// The limit of transitions of what is compared daily: most systems are smaller, and most of the time goes into the others.
pub const QUICK: u128 = 10_000;

/// The files with a system, which those that only others use have not; but for the yardstick, whose 193 million transitions take some peers
/// minutes.
pub fn shipped() -> Vec<PathBuf> {
    let mut files = crate::specification_files();
    files.retain(|path| has_system(path) && !path.ends_with("bench/two-axis.toml"));
    files
}

/// Values of parameters in place of the defaults.
pub type Values = &'static [(&'static str, i64)];

/// Times of a machine in cycles, not scaled down: of the stops of `sinumerik-840d/axis`.
pub const TRUE_TIMES: Values = &[
    ("t_b", 25),
    ("t_c", 25),
    ("t_d", 34),
    ("t_e", 50),
    ("t_f", 9),
];

/// A system of a file of the workspace with these values.
///
/// # Panics
/// If the file has no such system, or it has not these parameters.
pub fn system(file: &str, name: &str, values: Values) -> Bound {
    let mut tasks = load(&root().join(file)).tasks.into_iter();
    let task = tasks.find(|t| t.bound.system.name == name);
    let task = task.unwrap_or_else(|| panic!("{file} has no system {name}"));
    let values = values.iter();
    let values = values.map(|(name, value)| ((*name).to_owned(), vec![*value]));
    let bound = Bound::new(task.bound.system, &values.collect(), &BTreeMap::new());
    bound.unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// A folder that goes away with the value.
pub struct Folder(PathBuf);

impl Folder {
    /// A new folder in one for temporary files, which a test calls `env!("CARGO_TARGET_TMPDIR")`.
    ///
    /// # Panics
    /// If it cannot be made.
    pub fn new(parent: &str, name: &str) -> Self {
        let path = Path::new(parent).join(format!("{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder of one's own");
        Self(path)
    }

    /// The same file under a name in it.
    ///
    /// # Panics
    /// If it cannot be linked.
    pub fn link(&self, file: &Path, name: &str) {
        std::os::unix::fs::symlink(file, self.file(name)).expect("linked");
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.file(name), text).expect("written");
    }

    /// Runs a program in it; the answer is its standard output.
    ///
    /// # Panics
    /// If it does not run, or does not end with status 0.
    pub fn run(&self, program: &str, arguments: &[&str]) -> String {
        let (text, errors, good) = self.output(program, arguments);
        assert!(good, "{program} {arguments:?}: {text}{errors}");
        text
    }

    /// The same for a program whose status says what it found.
    ///
    /// # Panics
    /// If it does not run, or says nothing.
    pub fn findings(&self, program: &str, arguments: &[&str]) -> String {
        let (text, errors, _) = self.output(program, arguments);
        assert!(!text.is_empty(), "{program} {arguments:?}: {errors}");
        text
    }

    /// What rumur's verifier of a Murphi model says, in its form for machines; it goes on after an error until it has found this
    /// many.
    ///
    /// # Panics
    /// If rumur or gcc refuses the model, or the verifier does not run.
    pub fn rumur(&self, model: &str, errors: u32) -> String {
        self.write("model.m", model);
        let most = errors.to_string();
        let options = [
            "--deadlock-detection",
            "off",
            "--value-type",
            "int32_t",
            "--max-errors",
            &most,
            "--counterexample-trace",
            "off",
            "--output-format",
            "machine-readable",
            "--pack-state",
            "off",
            "--threads",
            "1",
            "--output",
            "model.c",
            "model.m",
        ];
        self.run("rumur", &options);
        // To optimise such small verifiers would take longer than they run.
        let gcc = [
            "-O0", "-w", "-mcx16", "-pthread", "-o", "verifier", "model.c",
        ];
        self.run("gcc", &gcc);
        self.findings("./verifier", &[])
    }

    fn output(&self, program: &str, arguments: &[&str]) -> (String, String, bool) {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .unwrap_or_else(|e| panic!("{program}: {e}"));
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (
            text(&output.stdout),
            format!("{}: {}", output.status, text(&output.stderr)),
            output.status.success(),
        )
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A specification or machine file with the recommended readings.
///
/// # Panics
/// If something is wrong with it.
pub fn load(path: &Path) -> Subject {
    subject::load(path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// The explorations so far: of each file and task the report, once it is there.
type Reports = BTreeMap<(PathBuf, String, String), Arc<OnceLock<Report>>>;

/// The exploration of one system of a file, complete; made once for all tools that are compared with it.
///
/// # Panics
/// If it fails or is not complete.
pub fn explored(subject: &Subject, task: &Task) -> Report {
    static REPORTS: Mutex<Reports> = Mutex::new(BTreeMap::new());
    let key = (
        subject.path.clone(),
        task.title.clone(),
        task.bound.system.name.clone(),
    );
    let place = REPORTS
        .lock()
        .expect("nothing panics under it")
        .entry(key)
        .or_default()
        .clone();
    place.get_or_init(|| explored_now(subject, task)).clone()
}

fn explored_now(subject: &Subject, task: &Task) -> Report {
    let mut alone = Subject {
        tasks: vec![task.clone()],
        ..subject.clone()
    };
    // What others are given is the system itself.
    let settings = Settings {
        exact: true,
        ..Settings::default()
    };
    let mut all = check(&mut alone, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let report = all.remove(0).outcome.report;
    assert!(report.complete, "{}: {}", subject.name, task.title);
    report
}

/// What `work` makes of each of these, in their order. Another tool keeps one processor busy, so each processor has one.
///
/// # Panics
/// If `work` does.
pub fn each<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..processors {
            scope.spawn(|| {
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(n) else { break };
                    let result = work(item);
                    done.lock()
                        .expect("nothing panics under it")
                        .push((n, result));
                }
            });
        }
    });
    let mut done = done.into_inner().expect("nothing panics under it");
    done.sort_by_key(|(n, _)| *n);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Whether a file declares a system of its own; others only serve to be included.
pub fn has_system(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| text.contains("\n[system."))
}
