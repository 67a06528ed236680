//! The yardsticks of the explorer: generated tables and data.

#![no_std]

stillpoint_native::family!();
