//! Every mutant of the monitors dies: the tables `kills/<family>.txt` say by which harnesses of the inventory, and by which
//! law.

use stillpoint_monitors::{heidenhain, sinumerik};
use stillpoint_proofs::inventory;
use stillpoint_proofs::properties::{self, Subject};

/// The test of a family, from the list of its monitors that have mutants.
///
/// The table has one kill in a line: mutant, harness, broken law; in the order of the mutants and of the inventory.
macro_rules! family {
    ($family:ident: $($monitor:ident)+) => {
        #[test]
        fn $family() {
            let mut kills = Vec::new();
            // Both channels together have no contract of their own: the table composed for them finds their mutants.
            let single = |mutant: &&$family::mutant::Mutant| mutant.monitor() != "pair";
            for mutant in $family::mutant::Mutant::ALL.iter().filter(single) {
                let $family = properties::$family::Subject { $($monitor: mutant.$monitor()),+ };
                let subject = Subject { $family, ..Subject::PRODUCTION };
                kills.extend(killed_by(stringify!($family), mutant.monitor(), mutant.name(), &subject));
            }
            let listed = include_str!(concat!("kills/", stringify!($family), ".txt"));
            assert!(
                kills == listed.lines().collect::<Vec<_>>(),
                concat!("kills/", stringify!($family), ".txt must read:\n{}"),
                kills.join("\n")
            );
        }
    };
}

family! { sinumerik:
    stop external fault selection reference agreement gear group test_stop shutdown_test pulses compare slip history
    forced_check motion standstill speed limit_switch ramp threshold cam results channel
}

family! { heidenhain:
    gate both_channels both_fields both_status stop report neighbour global_sto judge group startup axis_release som button switch_on output_enable channel
    speed operating_stop stop_path position_limit revolutions comparison deceleration axis_count
    reference agreement brakes tool_holder acceptance cc_link self_test cut_out holding_brake status_bits sampling self_checks start_checks
    key_filter axes_logic spindle_logic magazine_logic
    safe_input working_space control_voltage jog_increment general_fields program_check availability allowed_functions
    f_limited group_motion safe_output
}

/// The lines of the table for a mutant of `monitor`, whose step function `subject` has.
fn killed_by(family: &str, monitor: &str, mutant: &str, subject: &Subject) -> Vec<String> {
    // Harnesses of other monitors would run the production functions only.
    let same =
        |entry: &&inventory::Entry| entry.family == family && entry.monitor.contains(monitor);
    let kills: Vec<String> = inventory::all()
        .filter(same)
        .filter_map(|entry| {
            let (law, _) = (entry.enumerate)(subject).broken?;
            Some(format!("{mutant} {} {law}", entry.id))
        })
        .collect();
    assert!(
        !kills.is_empty(),
        "the mutant {mutant} survives every harness"
    );
    kills
}
