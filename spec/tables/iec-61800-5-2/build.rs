//! Generates Rust from the tables of the folder.

fn main() {
    stillpoint_lang::compile::family("../../families/iec-61800-5-2");
}
