//! What the tests of the binary share: where the workspace is, how the binary is run, what it said, and folders that go away.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The binary, to be run in the root of the workspace.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stillpoint"));
    command
        .args(arguments)
        .current_dir(root())
        .env("NO_COLOR", "1");
    command
}

/// Runs the binary in the root of the workspace.
pub fn stillpoint(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the binary runs")
}

/// What it wrote to the standard output.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("stdout is UTF-8")
}

/// The words of the messages on standard error, wherever their lines break.
pub fn messages(output: &Output) -> String {
    let text = stderr(output).replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What it wrote to the standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("stderr is UTF-8")
}

/// Its exit status.
pub fn status(output: &Output) -> i32 {
    output.status.code().expect("no signal ended it")
}

/// A command and what came of it, for a snapshot: the exit status and what stands in both streams.
pub fn session(arguments: &[&str], output: &Output) -> String {
    let mut text = format!("$ stillpoint {}\n", arguments.join(" "));
    for stream in [stdout(output), stderr(output)] {
        text.push_str(&stream);
    }
    text.push_str(&format!("[exit status {}]\n\n", status(output)));
    text
}

/// A copy of a machine file and of the folder of its family, in a folder of this name: the path of the copied machine. Both are
/// named from the root of the workspace, like the files in which then, one after the other, a text is replaced where it stands
/// first.
pub fn copied(name: &str, machine: &str, family: &str, replace: &[(&str, &str, &str)]) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let copy = |path: &Path| {
        let to = folder.join(path);
        std::fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        std::fs::copy(root().join(path), to).expect("copied");
    };
    copy(Path::new(machine));
    // The program beside it.
    let program = Path::new(machine).with_extension("st");
    if root().join(&program).is_file() {
        copy(&program);
    }
    let mut folders = vec![PathBuf::from(family)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).expect("the family") {
            let path = folder.join(entry.expect("an entry").file_name());
            match root().join(&path).is_file() {
                true => copy(&path),
                false => folders.push(path),
            }
        }
    }
    for (file, from, to) in replace {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).expect("readable");
        assert!(text.contains(from), "{file} has no {from}");
        std::fs::write(&path, text.replacen(from, to, 1)).expect("written");
    }
    folder.join(machine).display().to_string()
}

/// A folder of one test, gone with the value.
pub struct Folder(pub PathBuf);

impl Folder {
    /// An empty folder.
    pub fn new(name: &str) -> Self {
        let name = format!("{name}-{}", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// Writes a file, and the folders above it; its path.
    pub fn write(&self, name: &str, content: &str) -> String {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, content).expect("written");
        self.file(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
