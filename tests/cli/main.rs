//! The binary `stillpoint` as its users meet it: commands, files, terminals, pipes, signals, browsers.
//!
//! One test binary for all of them, of the package that has the binary: only there cargo tells where it lies.

mod acceptance;
mod adding;
mod beginning;
mod book;
mod certify;
mod commands;
mod common;
mod compared;
mod crane;
mod distributed;
mod explore;
mod export_and_trace;
mod first_hour;
mod heidenhain;
mod numbers;
mod proof;
mod reaction;
mod recording;
mod report;
mod s120;
mod scenarios;
mod simulate;
mod sinamics;
mod stacker;
mod structured_text;
mod survival;
mod terminal;
mod theorems;
mod values;
