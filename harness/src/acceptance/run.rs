//! Tests on a simulated axis: the scenario that the catalogue gives a test, run on the production monitors.

use std::sync::Arc;

use serde_json::{Value, json};
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine::Machine;
use stillpoint_machine::acceptance::{Simulated, Test};
use stillpoint_show::diagram::Diagram;

use crate::simulate::{self, Scenario};

/// What became of a test on the simulated axis.
#[derive(Debug, Clone)]
pub struct Ran {
    /// The test.
    pub id: String,
    /// Every expectation of the scenario holds.
    pub holds: bool,
    /// The expectations: in words, whether it holds, and the cycle in which it came.
    pub judged: Vec<(String, bool, Option<u64>)>,
    /// The stops that occurred, in words.
    pub stops: Vec<String>,
    /// The run.
    pub diagram: Diagram,
}

/// A test whose scenario does not fit the values of the machine: it was not run. None of it is the user's fault but the
/// catalogue's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unfit {
    /// The test.
    pub id: String,
    /// What is wrong with its scenario.
    pub reason: String,
}

/// The longest scenario that is run: the results of longer ones would keep a user waiting.
const LONGEST_US: u64 = 3_600_000_000;

/// Runs the tests that have a scenario, one after the other; those that only the real machine can show are not in the result.
pub fn run(machine: &Machine, tests: &[&Test]) -> (Vec<Ran>, Vec<Unfit>) {
    let mut all = Vec::new();
    let mut unfit = Vec::new();
    for test in tests {
        let Simulated::Scenario(text) = &test.simulated else {
            continue;
        };
        let text: Arc<str> = Arc::from(text.as_str());
        let name = format!("scenario of {}", test.id);
        let mut not = |reason: String| {
            let id = test.id.clone();
            unfit.push(Unfit { id, reason });
        };
        let scenario = match Scenario::from_text(&name, &text, machine) {
            Ok(scenario) => scenario,
            Err(Diagnostics(list)) => {
                let said: Vec<String> = list.iter().map(|d| d.message.clone()).collect();
                not(format!(
                    "its scenario does not fit these values: {}",
                    said.join("; ")
                ));
                continue;
            }
        };
        let cycle = u64::try_from(machine.monitoring_cycle).unwrap_or(1);
        let length = u64::from(scenario.cycles).saturating_mul(cycle);
        if length > LONGEST_US {
            not(format!(
                "it would take {} s on this machine",
                length / 1_000_000
            ));
            continue;
        }
        let simulation = match simulate::run(machine, &scenario) {
            Ok(simulation) => simulation,
            Err(e) => {
                not(e.to_string());
                continue;
            }
        };
        let judged = simulation.judged.iter();
        let stops = simulation.stops.iter().map(|s| {
            format!(
                "{} of {} in cycle {} ({}): {}, over-travel {}",
                s.name, s.axis, s.cycle, s.channels, s.reason, s.travel_shown
            )
        });
        all.push(Ran {
            id: test.id.clone(),
            holds: simulation.holds(),
            judged: judged.map(|j| (j.text.clone(), j.holds, j.cycle)).collect(),
            stops: stops.collect(),
            diagram: simulation.diagram(),
        });
    }
    (all, unfit)
}

/// The tests that only the real machine can show, each with the reason.
pub fn on_the_machine<'a>(tests: &[&'a Test]) -> Vec<(&'a str, &'a str)> {
    let not = tests.iter().filter_map(|test| match &test.simulated {
        Simulated::Not(reason) => Some((test.id.as_str(), reason.as_str())),
        Simulated::Scenario(_) => None,
    });
    not.collect()
}

/// The results as JSON.
pub fn json(ran: &[Ran]) -> Value {
    let one = |r: &Ran| {
        let judged = r.judged.iter();
        let judged = judged
            .map(|(text, holds, cycle)| json!({"text": text, "holds": holds, "cycle": cycle}));
        json!({
            "id": r.id, "holds": r.holds, "expectations": judged.collect::<Vec<_>>(),
            "stops": r.stops,
        })
    };
    ran.iter().map(one).collect::<Vec<_>>().into()
}
