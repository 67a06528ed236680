//! Generates Rust from every specification file that ships with the project.

use std::path::{Path, PathBuf};

use stillpoint_lang::{Spec, codegen};

/// Folders with specification files, relative to `spec/`.
const FOLDERS: [&str; 3] = ["families/sinumerik-840d", "families/heidenhain-fs", "bench"];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut code = String::new();
    let mut names = Vec::new();
    for folder in FOLDERS {
        let dir = root.join(folder);
        println!("cargo::rerun-if-changed={}", dir.display());
        for path in specification_files(&dir) {
            println!("cargo::rerun-if-changed={}", path.display());
            let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
            let own: Vec<String> = spec.own_machines().map(str::to_owned).collect();
            let systems: Vec<String> = spec.systems().map(str::to_owned).collect();
            let machines = own.iter().map(|m| spec.open_machine(m));
            for system in systems.iter().map(|s| spec.system(s, None)).chain(machines) {
                let system = system.unwrap_or_else(|e| panic!("{e}"));
                let (type_name, table_name) = (
                    format!("System{}", names.len()),
                    format!("TABLE_{}", names.len()),
                );
                code.push_str(&codegen::rust(&system, &type_name, &table_name));
                names.push(table_name);
            }
        }
    }
    let list = names.join(", ");
    code.push_str(&format!(
        "/// Every generated table.\npub static TABLES: [Table; {}] = [{list}];\n",
        names.len()
    ));
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    std::fs::write(out.join("tables.rs"), code).expect("OUT_DIR can be written");
}

fn specification_files(dir: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(dir)
        .map(|entries| entries.flatten().map(|e| e.path()).collect())
        .unwrap_or_default();
    files.retain(|p| {
        p.extension().is_some_and(|e| e == "toml")
            && std::fs::read_to_string(p).is_ok_and(|t| t.lines().any(|l| l.starts_with("spec ")))
    });
    files.sort();
    files
}
