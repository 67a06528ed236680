//! The properties, one file per monitor, and the step functions they are stated about.

pub mod axis;
pub mod contracts;
pub mod fault;
pub mod selection;
pub mod stop;

use stillpoint_monitors::{agreement, external, fault as fault_monitor, gear, reference};
use stillpoint_monitors::{selection as selection_monitor, stop as stop_monitor};

/// The step functions under test: the production ones, or some replaced by mutants.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Arbitration.
    pub stop: stop_monitor::Next,
    /// External stops.
    pub external: external::Next,
    /// STOP F.
    pub fault: fault_monitor::Next,
    /// Selection.
    pub selection: selection_monitor::Next,
    /// Referencing.
    pub reference: reference::Next,
    /// User agreement.
    pub agreement: agreement::Next,
    /// Gear stage.
    pub gear: gear::Next,
}

impl Subject {
    /// The production monitors.
    pub const PRODUCTION: Self = Self {
        stop: stop_monitor::next,
        external: external::next,
        fault: fault_monitor::next,
        selection: selection_monitor::next,
        reference: reference::next,
        agreement: agreement::next,
        gear: gear::next,
    };
}
