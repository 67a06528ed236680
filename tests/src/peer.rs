//! Running other tools on exported systems.

use std::path::{Path, PathBuf};
use std::process::Command;

use stillpoint::check::{Checked, Settings, check};
use stillpoint::subject::{self, Readings, Subject};

/// Whether these programs are there. A user without them sees that the test was skipped; where the environment has `CI`,
/// it fails then.
///
/// # Panics
/// If one is missing and `CI` is set.
pub fn tools(programs: &[&str]) -> bool {
    for program in programs {
        if Command::new(program).arg("--version").output().is_err() {
            let message = format!("SKIPPED: {program} is not installed");
            assert!(std::env::var_os("CI").is_none(), "{message}");
            eprintln!("{message}");
            return false;
        }
    }
    true
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
    /// If it does not run.
    pub fn findings(&self, program: &str, arguments: &[&str]) -> String {
        self.output(program, arguments).0
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
            text(&output.stderr),
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

/// The explorations of a file, all of them complete.
///
/// # Panics
/// If one fails or is not complete.
pub fn explored(subject: &Subject) -> Vec<Checked> {
    let all = check(subject, &Settings::default(), &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    for done in &all {
        assert!(done.outcome.report.complete, "{}", subject.name);
    }
    all
}

/// Whether a file declares a system of its own; others only serve to be included.
pub fn has_system(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| text.contains("\n[system."))
}
