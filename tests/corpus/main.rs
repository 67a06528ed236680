//! What the repository holds as data, tried: the tables, the machine files, the worked examples of the manuals, the requirements
//! and the book. Files are discovered, never listed.

mod alarms;
mod blocks;
mod book;
mod claimed_times;
mod conversion;
mod crane_ways;
mod db18;
mod explored;
mod fuzz;
mod guarantees;
mod interface;
mod loose;
mod machines;
mod manuals;
mod messages;
mod parameters;
mod patterns;
mod printed_programs;
mod profisafe_example;
mod programs;
mod reaction_times;
mod safe_logic;
mod safe_relay;
mod spl;
mod structure;
mod structured_text;
mod tables;
mod trace;
mod truth_tables;
mod unread;
