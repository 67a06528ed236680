//! Generates Rust from the tables of the folder.

fn main() {
    stillpoint_lang::compile::family("../../families/sinumerik-840d");
}
