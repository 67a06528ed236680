//! Explores finite systems exhaustively and judges their properties.
#![forbid(unsafe_code)]

mod choices;
mod crew;
mod cursor;
mod explore;
mod hashed;
mod pack;
mod property;
mod report;
mod search;
mod store;
mod system;
mod trace;

pub use choices::Replay;
pub use explore::explore;
pub use property::{Form, Property};
pub use report::{Error, FaultReport, Judgement, Limits, Options, Progress, Report, Storage, Trace, Verdict};
pub use system::{Choices, Domain, Fault, System};
