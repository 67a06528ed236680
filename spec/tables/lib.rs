//! The families that the programs carry: the list of their crates.
//!
//! Only programs and tests name this crate, and hand the list to the engine: an edit of a table builds the crate of its family
//! and links, and nothing else.

#![no_std]

use stillpoint_native::Family;

/// Every family, and what is no family but has tables.
pub static FAMILIES: [Family; 6] = [
    stillpoint_tables_sinumerik_840d::FAMILY,
    stillpoint_tables_heidenhain_fs::FAMILY,
    stillpoint_tables_iec_61800_5_2::FAMILY,
    stillpoint_tables_srm_fblocks::FAMILY,
    stillpoint_tables_sinamics_s120::FAMILY,
    stillpoint_tables_bench::FAMILY,
];
