//! Fail-safe blocks for storage and retrieval machines: generated tables and data.

#![no_std]

stillpoint_native::family!();
