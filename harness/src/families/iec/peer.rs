//! The monitors as peers of their tables, and what is called otherwise. POWER ON is a new monitor.

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params, Peers};

pub(super) const PEERS: Peers = Peers {
    machines: &[MACHINES],
    systems: &[],
    fixed: &[],
    slices: &[],
    calm: &[],
    make: &[make],
};

peers! { iec |p|
    "window" => window
        .constants(&[("power_on", 0)])
        .named(&[
            ("low", "lower"), ("high", "upper"), ("t_delay", "config.delay"), ("t_tol", "tolerance"), ("delay", "left"),
            ("violated", "demand"), ("was_ack", "ack_held"),
        ])
        // Under a demand the table counts on and the monitor does not; no output tells that.
        .hidden(&["state.outside"])
        .cell("outside", upto(p.value("t_tol")));
    "acceleration" => acceleration
        .constants(&[("power_on", 0)])
        .named(&[("value_valid", "outputs.valid"), ("value", "acceleration"), ("known", "last.some"), ("last", "last.value")]);
    "temperature" => temperature
        .constants(&[("power_on", 0)])
        .named(&[("shorted", "short_circuit"), ("violated", "demand"), ("was_ack", "ack_held"), ("warn", "outputs.warning")]);
    "cam" => cam
        .constants(&[("power_on", 0)])
        .named(&[("low", "lower"), ("high", "upper"), ("cam", "outputs.on")]);
    "increment" => increment
        .constants(&[("power_on", 0)])
        .named(&[
            ("t_move", "time"), ("now", "phase"), ("timer", "left"), ("violated", "demand"), ("was_ack", "ack_held"),
            ("was_start", "start_held"), ("moving", "permitted"),
        ]);
}
