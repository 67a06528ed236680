//! Explores finite systems exhaustively and judges their properties.
#![forbid(unsafe_code)]

mod choices;
mod control;
mod crew;
mod cursor;
mod duty;
mod explore;
mod graph;
mod hashed;
mod liveness;
mod pack;
mod process;
mod property;
mod report;
mod response;
mod search;
mod store;
mod system;
pub mod table;
mod trace;
mod twin;

pub use choices::Replay;
pub use control::{ControlGraph, control_graph, reachable};
pub use explore::explore;
pub use property::{Form, Property};
pub use report::{Error, FaultReport, Judgement, Limits, Options, Progress, Report, Storage, Trace, Verdict};
pub use system::{Choices, Domain, Fault, System};
pub use twin::{Twin, TwinWork};
