//! Every mutant of the monitors dies: the snapshots `kills/<family>.snap` say by which harnesses of the inventory, and by which
//! law. The daily run makes every fourth of these kills again; all of them, and that there are no others, take a minute.

use std::collections::BTreeSet;

use rayon::prelude::*;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_proofs::inventory::{self, Entry};
use stillpoint_proofs::properties::Subject;

/// What exists of a family: its name, and each mutant with the step functions it is one of.
type Family = (&'static str, Vec<(Mutant, Subject)>);

/// The mutants of a family, from the list of its monitors.
macro_rules! family {
    ($family:ident [] $($monitor:ident)+) => {
        fn $family() -> Family {
            let mut mutants = Vec::new();
            // In functions of their own: LLVM takes hours for all copies of the subject in one.
            $({
                #[inline(never)]
                fn wrong(mutants: &mut Vec<(Mutant, Subject)>) {
                    for wrong in stillpoint_monitors::$family::mutant::$monitor() {
                        let mut subject = Subject::PRODUCTION;
                        subject.$family.$monitor = wrong.next;
                        mutants.push((wrong.mutant, subject));
                    }
                }
                wrong(&mut mutants);
            })+
            (stringify!($family), mutants)
        }
    };
}

stillpoint_monitors::heidenhain_monitors! { family }
stillpoint_monitors::iec_monitors! { family }
stillpoint_monitors::sinamics_monitors! { family }
stillpoint_monitors::sinumerik_monitors! { family }
stillpoint_monitors::srm_monitors! { family }

fn families() -> [Family; 5] {
    [heidenhain(), iec(), sinamics(), sinumerik(), srm()]
}

/// How a harness kills a mutant, in a line: mutant, harness, broken law.
fn kill(mutant: &Mutant, subject: &Subject, entry: &Entry) -> Option<String> {
    let (law, _) = (entry.enumerate)(subject).broken?;
    Some(format!("{} {} {law}", mutant.name, entry.id))
}

/// The lines of a snapshot, without its head.
fn recorded(family: &str) -> Vec<String> {
    let path = format!("{}/tests/kills/{family}.snap", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let kills = text.splitn(3, "---\n").nth(2).expect("a head between ---");
    kills.lines().map(str::to_owned).collect()
}

/// Every mutant is recorded as killed, and nothing else is; every fourth of them is killed again.
#[test]
fn mutants_die_as_recorded() {
    let name = |line: &str| line.split(' ').next().map(str::to_owned);
    let mut again = Vec::new();
    for (family, mutants) in families() {
        let recorded = recorded(family);
        let killed: BTreeSet<String> = recorded.iter().filter_map(|line| name(line)).collect();
        let known = mutants.iter().map(|(mutant, _)| mutant.name.to_owned());
        assert_eq!(killed, known.collect(), "{family}");
        for (mutant, subject) in mutants.into_iter().step_by(4) {
            let own = |line: &&String| name(line).as_deref() == Some(mutant.name);
            let own = recorded.iter().filter(own).cloned();
            again.extend(own.map(|line| (mutant, subject, line)));
        }
    }
    let wrong = again.into_par_iter().filter_map(|(mutant, subject, line)| {
        let id = line.split(' ').nth(1);
        let entry = inventory::all().find(|entry| Some(entry.id) == id);
        let entry = entry.unwrap_or_else(|| panic!("{line}: no such harness"));
        let now = kill(&mutant, &subject, entry);
        (now.as_ref() != Some(&line)).then(|| format!("{line}: now {now:?}"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    /// In the order of the mutants and of the inventory.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn no_other_harness_kills_a_mutant() {
        for (family, mutants) in families() {
            let kills: Vec<String> = mutants
                .par_iter()
                .flat_map_iter(|(mutant, subject)| {
                    // Harnesses of other monitors would run the production functions only.
                    let of_it = |entry: &&Entry| {
                        entry.family == mutant.family && entry.monitor.contains(mutant.monitor)
                    };
                    let entries = inventory::all().filter(of_it);
                    entries.filter_map(|entry| kill(mutant, subject, entry))
                })
                .collect();
            insta::with_settings!({ snapshot_path => "kills", prepend_module_to_snapshot => false }, {
                insta::assert_snapshot!(family, kills.join("\n"));
            });
        }
    }
}
