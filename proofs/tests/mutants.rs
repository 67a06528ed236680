//! Every mutant of the monitors dies: the table says by which harnesses of the inventory, and by which law.

use stillpoint_monitors::mutant::Mutant;
use stillpoint_proofs::inventory::INVENTORY;
use stillpoint_proofs::properties::Subject;

fn with(mutant: Mutant) -> Subject {
    Subject {
        stop: mutant.stop(),
        external: mutant.external(),
        fault: mutant.fault(),
        selection: mutant.selection(),
        reference: mutant.reference(),
        agreement: mutant.agreement(),
        gear: mutant.gear(),
    }
}

/// Mutant, harness, broken law; in the order of the mutants and of the inventory.
const KILLS: &[(&str, &str, &str)] = &[
    (
        "stop-b-no-timer-exit",
        "stop_contract",
        "stop_b_ends_in_time",
    ),
    (
        "stop-b-no-timer-exit",
        "stop_b_ends",
        "pulses_are_cancelled_within_t_b",
    ),
    (
        "stop-lower-displaces",
        "stop_contract",
        "only_acknowledgement_lowers_the_latch",
    ),
    (
        "stop-lower-displaces",
        "stop_b_ends",
        "pulses_are_cancelled_within_t_b",
    ),
    (
        "stop-lower-displaces",
        "stop_braking_ends",
        "braking_ends_in_the_operating_stop",
    ),
    (
        "stop-reset-while-braking",
        "stop_contract",
        "braking_ends_in_time",
    ),
    (
        "stop-reset-while-braking",
        "stop_braking_ends",
        "braking_ends_in_the_operating_stop",
    ),
    (
        "stop-releases-standstill",
        "stop_contract",
        "operating_stop_is_kept",
    ),
    (
        "external-before-start",
        "external_contract",
        "stop_a_until_comparison_runs",
    ),
    (
        "external-wrong-priority",
        "external_contract",
        "highest_request_acts",
    ),
    (
        "fault-delay-aborted",
        "fault_contract",
        "delay_cannot_be_aborted",
    ),
    ("fault-delay-aborted", "fault_delay", "stop_b_within_t_f"),
    (
        "fault-delay-held-by-stop",
        "fault_contract",
        "delay_cannot_be_aborted",
    ),
    (
        "fault-delay-held-by-stop",
        "fault_delay",
        "stop_b_within_t_f",
    ),
    (
        "selection-delay-short",
        "selection_contract",
        "standstill_comes_in_time",
    ),
    (
        "selection-delay-short",
        "selection_delay",
        "old_limit_for_exactly_the_delay",
    ),
    (
        "selection-forced-deselects",
        "selection_contract",
        "ended_stop_forces_standstill",
    ),
    (
        "selection-forced-deselects",
        "selection_forced",
        "forced_standstill_does_not_depend_on_signals",
    ),
    (
        "selection-reference-creeps",
        "selection_contract",
        "reference_is_kept_on_acknowledgement",
    ),
    (
        "selection-reference-creeps",
        "selection_reference",
        "reference_does_not_creep",
    ),
    (
        "reference-one-agreement",
        "reference_contract",
        "safely_referenced_needs_both",
    ),
    (
        "reference-one-agreement",
        "axis_gear",
        "gear_change_ends_safe_reference",
    ),
    (
        "reference-one-agreement",
        "axis_history",
        "history_decides_after_power_on",
    ),
    (
        "reference-one-agreement",
        "axis_single",
        "no_safe_reference_with_one_agreement",
    ),
    (
        "reference-late-reset",
        "reference_contract",
        "safely_referenced_needs_both",
    ),
    (
        "reference-late-reset",
        "axis_gear",
        "gear_change_ends_safe_reference",
    ),
    (
        "agreement-kept-after-gear",
        "agreement_contract",
        "gear_change_withdraws",
    ),
    (
        "agreement-kept-after-gear",
        "axis_gear",
        "gear_change_ends_safe_reference",
    ),
    (
        "agreement-no-history",
        "agreement_contract",
        "failed_history_withdraws",
    ),
    (
        "agreement-no-history",
        "axis_history",
        "history_decides_after_power_on",
    ),
    (
        "agreement-without-key",
        "agreement_contract",
        "locked_without_key",
    ),
    (
        "gear-change-overlooked",
        "gear_contract",
        "change_is_an_event",
    ),
    (
        "gear-change-overlooked",
        "axis_gear",
        "gear_change_ends_safe_reference",
    ),
];

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
        for entry in INVENTORY
            .iter()
            .filter(|entry| entry.monitor.contains(monitor))
        {
            if let Some((law, _)) = (entry.enumerate)(&subject).broken {
                kills.push((mutant.name(), entry.id, law));
                killed = true;
            }
        }
        assert!(
            killed,
            "the mutant {} survives every harness",
            mutant.name()
        );
    }
    assert_eq!(kills, KILLS);
}
