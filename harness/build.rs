//! Puts the data of the families into the program: a list of `family/name.toml` with the bytes of each file.

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() {
    let here = std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
    let families = Path::new(&here).join("../spec/families");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed={}", families.display());
    let mut files: Vec<PathBuf> = Vec::new();
    for family in entries(&families)
        .into_iter()
        .filter(|f| f.join("family.toml").is_file())
    {
        println!("cargo:rerun-if-changed={}", family.display());
        let data = entries(&family).into_iter();
        files.extend(data.filter(|f| f.extension().is_some_and(|e| e == "toml")));
    }
    let mut out = String::from("&[\n");
    for file in files {
        println!("cargo:rerun-if-changed={}", file.display());
        let part =
            |p: Option<&std::ffi::OsStr>| p.expect("a name").to_str().expect("UTF-8").to_owned();
        let family = part(file.parent().and_then(Path::file_name));
        let name = part(file.file_name());
        let full = file.canonicalize().expect("it was listed");
        writeln!(
            out,
            "    ({:?}, include_bytes!({full:?})),",
            format!("{family}/{name}")
        )
        .expect("a string");
    }
    out.push(']');
    let to = std::env::var("OUT_DIR").expect("cargo sets it");
    std::fs::write(Path::new(&to).join("family_data.rs"), out).expect("written");
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let read = std::fs::read_dir(folder).expect("the folder of the specifications");
    let mut list: Vec<PathBuf> = read.map(|e| e.expect("an entry").path()).collect();
    list.sort();
    list
}
