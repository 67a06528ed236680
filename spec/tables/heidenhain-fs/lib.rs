//! HEIDENHAIN Functional Safety: generated tables and data.

#![no_std]

stillpoint_native::family!();
