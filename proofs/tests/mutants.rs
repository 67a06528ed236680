//! Every mutant of the monitors dies: the table says by which harnesses of the inventory, and by which law.

use stillpoint_monitors::sinumerik::mutant::Mutant;
use stillpoint_proofs::inventory;
use stillpoint_proofs::properties::{Subject, sinumerik};

fn with(mutant: Mutant) -> Subject {
    let sinumerik = sinumerik::Subject {
        stop: mutant.stop(),
        external: mutant.external(),
        fault: mutant.fault(),
        selection: mutant.selection(),
        reference: mutant.reference(),
        agreement: mutant.agreement(),
        gear: mutant.gear(),
        group: mutant.group(),
        test_stop: mutant.test_stop(),
        shutdown_test: mutant.shutdown_test(),
        pulses: mutant.pulses(),
        compare: mutant.compare(),
        slip: mutant.slip(),
        history: mutant.history(),
        forced_check: mutant.forced_check(),
        motion: mutant.motion(),
        standstill: mutant.standstill(),
        speed: mutant.speed(),
        limit_switch: mutant.limit_switch(),
        ramp: mutant.ramp(),
        threshold: mutant.threshold(),
        cam: mutant.cam(),
        results: mutant.results(),
        channel: mutant.channel(),
    };
    Subject { sinumerik }
}

/// Mutant, harness, broken law, one kill in a line; in the order of the mutants and of the inventory.
const KILLS: &str = include_str!("kills.txt");

#[test]
fn every_mutant_is_killed_as_listed() {
    let mut kills = Vec::new();
    for mutant in Mutant::ALL {
        let monitor = mutant
            .name()
            .split('-')
            .next()
            .expect("a name has a first word");
        let subject = with(*mutant);
        let mut killed = false;
        // Harnesses of other monitors would run the production functions only.
        let same = |e: &&inventory::Entry| e.family == "sinumerik" && e.monitor.contains(monitor);
        for entry in inventory::all().filter(same) {
            if let Some((law, _)) = (entry.enumerate)(&subject).broken {
                kills.push(format!("{} {} {law}", mutant.name(), entry.id));
                killed = true;
            }
        }
        assert!(
            killed,
            "the mutant {} survives every harness",
            mutant.name()
        );
    }
    let listed: Vec<_> = KILLS.lines().collect();
    assert!(
        kills == listed,
        "kills.txt must read:\n{}",
        kills.join("\n")
    );
}
