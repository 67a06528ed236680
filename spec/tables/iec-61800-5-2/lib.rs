//! Functions of IEC 61800-5-2 without a manual: generated tables and data.

#![no_std]
// Nearly all of it is generated, and some lints take minutes for a long condition.
#![allow(clippy::all)]

stillpoint_native::family!();
