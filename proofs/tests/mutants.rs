//! Every mutant of the monitors dies: the snapshots `kills/<family>.snap` say by which harnesses of the inventory, and by which
//! law.

use rayon::prelude::*;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_proofs::inventory;
use stillpoint_proofs::properties::{self, Subject};

/// One kill in a line: mutant, harness, broken law; in the order of the mutants and of the inventory.
fn check(family: &str, mutants: Vec<(Mutant, Subject)>) {
    let kills: Vec<String> = mutants
        .into_par_iter()
        .flat_map_iter(|(mutant, subject)| killed_by(mutant, &subject))
        .collect();
    insta::with_settings!({ snapshot_path => "kills", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!(family, kills.join("\n"));
    });
}

/// The test of a family, from the list of its monitors.
macro_rules! family {
    ($family:ident [] $($monitor:ident)+) => {
        #[test]
        fn $family() {
            let production = properties::$family::Subject::PRODUCTION;
            let mut mutants = Vec::new();
            $(for wrong in stillpoint_monitors::$family::mutant::$monitor() {
                let $family = properties::$family::Subject { $monitor: wrong.next, ..production };
                mutants.push((wrong.mutant, Subject { $family, ..Subject::PRODUCTION }));
            })+
            check(stringify!($family), mutants);
        }
    };
}

stillpoint_monitors::heidenhain_monitors! { family }
stillpoint_monitors::iec_monitors! { family }
stillpoint_monitors::sinamics_monitors! { family }
stillpoint_monitors::sinumerik_monitors! { family }
stillpoint_monitors::srm_monitors! { family }

/// The lines of the table for a mutant, whose step function `subject` has.
fn killed_by(mutant: Mutant, subject: &Subject) -> Vec<String> {
    let Mutant {
        family,
        monitor,
        name,
        ..
    } = mutant;
    // Harnesses of other monitors would run the production functions only.
    let same =
        |entry: &&inventory::Entry| entry.family == family && entry.monitor.contains(monitor);
    let kills: Vec<String> = inventory::all()
        .filter(same)
        .filter_map(|entry| {
            let (law, _) = (entry.enumerate)(subject).broken?;
            Some(format!("{name} {} {law}", entry.id))
        })
        .collect();
    assert!(
        !kills.is_empty(),
        "the mutant {name} survives every harness"
    );
    kills
}
