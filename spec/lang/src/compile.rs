//! What the build script of a family's crate calls: the tables of a folder as Rust, and the files of a family as data.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::{Spec, codegen};

/// Writes `family.rs` to the folder of the build's output: the generated tables of all specification files in `folder`, which
/// is named from the crate of the build script, and the files themselves where they are a family's.
///
/// # Panics
/// If a file is wrong: a build that goes on without it would run another family than its folder says.
pub fn family(folder: &str) {
    let variable = |name: &str| PathBuf::from(std::env::var_os(name).expect("cargo sets it"));
    let folder = variable("CARGO_MANIFEST_DIR").join(folder);
    let folder = folder.canonicalize().expect("the folder of the family");
    println!("cargo::rerun-if-changed={}", folder.display());
    let files = files(&folder);
    let mut out = String::new();
    let mut names = Vec::new();
    for path in &files {
        println!("cargo::rerun-if-changed={}", path.display());
        let text = std::fs::read_to_string(path).expect("it was listed");
        if text.lines().any(|line| line.starts_with("spec ")) {
            tables(path, &mut out, &mut names);
        }
    }
    let list = names.join(", ");
    let number = names.len();
    writeln!(out, "pub static TABLES: [Table; {number}] = [{list}];").expect("a string");
    let family = folder.file_name().unwrap_or_default().to_string_lossy();
    let mut carried = Vec::new();
    if folder.join("family.toml").is_file() {
        carried.clone_from(&files);
        // Products of whole machines are judged by the proof engines, which need no code.
        let products = folder.join("products");
        if products.is_dir() {
            carried.extend(self::files(&products));
        }
    }
    let number = carried.len();
    writeln!(out, "pub static DATA: [Carried; {number}] = [").expect("a string");
    for path in carried {
        let name = path.strip_prefix(&folder).unwrap_or(&path).display();
        let name = format!("{family}/{name}");
        writeln!(out, "    ({name:?}, include_bytes!({path:?})),").expect("a string");
    }
    out.push_str("];\n");
    std::fs::write(variable("OUT_DIR").join("family.rs"), out).expect("it can be written");
}

/// The code of every system of a specification file, and of each of its own machines by itself.
fn tables(path: &Path, out: &mut String, names: &mut Vec<String>) {
    let spec = Spec::load(path).unwrap_or_else(|e| panic!("{e}"));
    let systems = spec.systems().map(|name| spec.system(name, None));
    let machines = spec.own_machines().map(|name| spec.open_machine(name));
    for system in systems.chain(machines) {
        let system = system.unwrap_or_else(|e| panic!("{e}"));
        let number = names.len();
        let (type_name, table_name) = (format!("System{number}"), format!("TABLE_{number}"));
        out.push_str(&codegen::rust(&system, &type_name, &table_name));
        names.push(table_name);
    }
}

/// The TOML files of a folder, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder of the family");
    let mut files: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files
}
