//! Which harnesses Kani compiles: all of them, or those that `STILLPOINT_KANI` names, with blanks between.
//!
//! Kani compiles and links every harness that it finds, whichever are asked for: a second or two for each. So the binary
//! `kani`, which shares the harnesses out among several runs, names to each its own.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=STILLPOINT_KANI");
    if let Ok(chosen) = std::env::var("STILLPOINT_KANI") {
        println!("cargo::rustc-cfg=kani_chosen");
        for id in chosen.split_whitespace() {
            println!("cargo::rustc-cfg={id}");
        }
    }
}
