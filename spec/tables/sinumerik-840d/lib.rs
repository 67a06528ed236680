//! SINUMERIK 840D with Safety Integrated: generated tables and data.

#![no_std]

stillpoint_native::family!();
