//! An axis with both channels: stories of the manual told cycle by cycle, and the laws on long random runs.

mod comparison;
mod laws;
mod machine;
mod position;
mod slip;
mod stops;
mod tests_of_paths;
