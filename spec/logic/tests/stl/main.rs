//! Statement lists: what is refused, checks, timers, jumps and blocks of the control against definitions of their own, and how a program is
//! wired to the machine that it takes the place of.

#[path = "../common/mod.rs"]
mod common;
mod example;
mod listings;
mod meaning;
mod refused;
mod rig;
mod wired;
