//! The options that bound an exploration, the same for every command that explores.

use std::time::Duration;

use clap::Args;

use super::values;

#[derive(Args)]
pub struct LimitOptions {
    /// Worker threads [default: all processors]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    pub threads: usize,
    /// Most memory for the explorer, e.g. 2GiB
    #[arg(long, value_parser = values::size)]
    pub memory: Option<u64>,
    /// Most wall time, e.g. 90s
    #[arg(long, value_parser = values::duration)]
    pub time: Option<Duration>,
}
