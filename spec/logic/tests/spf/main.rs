//! SAFE.SPF: the programs that the manual prints, what is refused, triggers and timers against definitions of their own, and how a
//! program is wired to the machine that it takes the place of.

#[path = "../common/mod.rs"]
mod common;
mod example;
mod listings;
mod meaning;
mod refused;
mod rig;
mod wired;
