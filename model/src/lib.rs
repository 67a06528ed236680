//! An explicit-state model checker: explores finite systems exhaustively and judges their properties.
//!
//! A [`System`] says what its initial states are and what one cycle does; it asks a [`Choices`] for each input it reads.
//! [`explore`] makes every cycle from every reachable state, enumerating only the inputs that are read, and judges
//! properties ([`Form`]) about cycles and runs. Verdicts are exact: every state has an exact index, no state is
//! confused with another, and what a limit leaves open is called [`Verdict::Inconclusive`].
//!
//! How it works, module by module:
//!
//! * `choices`, `cursor`, `process`: the odometer over the inputs read, and the cycles of one state. Evaluating a property
//!   may read further inputs of the cycle; a transition counts with all combinations of the inputs nobody read.
//! * `pack`, `bitmap`, `store`, `set`, `hashed`: a state is a number in mixed radix. The states found are a bitmap over all
//!   numbers where that fits the memory (at most two bits an index), else an exact hash set.
//! * `parts`: systems that fall into parts with nothing in common but inputs; their cycles are put together from tables.
//! * `stages`: cycles that come about in stages; what a stage, or several as one, makes of what it looks at is found once.
//! * `ticks`: the values of a timer as intervals. `checkpoint`: an exploration between two levels, in a file.
//! * `crew`, `search`: one breadth-first search, level by level, on some threads. It tells for each property the first
//!   place, in the order (depth, state), where something showed: so the report does not depend on the threads.
//! * `graph`, `response`, `liveness`, `recoverable`: what the search cannot tell. The cycles under a pending duty form a graph;
//!   bounded responses ask for its longest path, responses under fairness for its strongly connected components. Recoverability
//!   goes backwards from the goal through all states, and asks the components of a graph of what is left. `duty` makes a weak
//!   until part of the state, for its shortest counterexample.
//! * `trace`: shortest runs. The search keeps no parents; a second search keeps its levels, and a walk back through them
//!   finds the least predecessors.
//! * `symmetry`, `narrow`: a system up to a group of permutations, and a part of a system; both systems again.
//! * `distributed` (a cargo feature): the same search over several processes.
//! * `proof`: engines that do not enumerate states, over and-inverter graphs.
//! * `twin`: two runs side by side; `reachable`: the reachable states in order. `cycles`: those of one state, to walk by hand.
//!
//! A cycle whose evaluation meets a fault has no successor and is reported. A fault in a property's atom makes that atom
//! FALSE there and is reported too: verdicts stand on their own only in a report without faults.
#![forbid(unsafe_code)]

mod bitmap;
mod checkpoint;
mod choices;
mod crew;
mod cursor;
mod cycles;
mod distinct;
#[cfg(feature = "distributed")]
mod distributed;
mod duty;
mod explore;
mod graph;
mod hashed;
mod level;
mod liveness;
mod model;
mod narrow;
mod nodes;
mod pack;
mod parts;
mod process;
pub mod proof;
mod property;
mod reachable;
mod recoverable;
mod report;
mod response;
mod search;
mod set;
mod stages;
mod store;
mod symmetry;
mod system;
mod tally;
mod ticks;
mod trace;
mod twin;
mod watch;

pub use choices::Replay;
pub use crew::Beside;
pub use cycles::{Cycle, Held, cycles, initials};
#[cfg(feature = "distributed")]
pub use distributed::{Cluster, ClusterError, digest, explore_together};
pub use explore::explore;
pub use narrow::{Narrow, NarrowWork, Part};
pub use parts::Component;
pub use property::{Form, Property};
pub use reachable::reachable;
pub use report::{
    Checkpoint, Error, FaultReport, Interrupt, Judgement, Limits, Options, Progress, Report, Step,
    Storage, Trace, Until, Verdict, Way,
};
pub use stages::{Condition, Outcome, Stages};
pub use symmetry::{Group, Permutation, Symmetric, SymmetricWork};
pub use system::{Choices, Domain, Fault, System};
pub use twin::{Twin, TwinWork};
