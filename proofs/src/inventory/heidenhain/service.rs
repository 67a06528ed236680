//! Referencing, outputs, self-test and checks.

use crate::inventory::NARROW;

inventory! {
    [contract hfs_reference_contract on heidenhain::reference {
        property: "every clause of the referencing's contract: comparison, person at the mark, permission to move",
        tries: "",
        caveat: "the subtraction of the positions is outside",
    }]
    [contract hfs_agreement_contract on heidenhain::agreement {
        property: "every clause of the contract of the comparison between the channels: window, fault beyond it",
        tries: "window: 1 2 4 max; cycles: 0..4 max",
        caveat: "which value counts in the meantime is decided elsewhere",
    }]
    [contract hfs_brakes_contract on heidenhain::brakes {
        property: "every clause of the brake outputs' contract: copy, all, one in the test",
        tries: "",
        caveat: "that no request comes without a drive is the kernel's promise",
    }]
    [contract hfs_tool_holder_contract on heidenhain::tool_holder {
        property: "every clause of the tool holder's contract: order of the conditions, no torque while open",
        tries: "",
        caveat: "the SS2 before is the program's business",
    }]
    [contract hfs_acceptance_contract on heidenhain::acceptance {
        property: "every clause of the acceptance's contract: no service without password and every confirmation",
        tries: "most: 1..3 max; open changes: 0..3 max",
        caveat: "the checksum itself is outside",
    }]
    [contract hfs_self_test_contract on heidenhain::self_test {
        property: "every clause of the self-test's contract: order, waiting, faults, interval",
        tries: "interval: 2; rest: 0..2",
        caveat: "what a step tests is outside",
    }]
    [contract hfs_cut_out_contract on heidenhain::cut_out {
        property: "every clause of the contract of the cut-out test: order, feedback of each channel alone, times, faults, end state",
        tries: "t_relay t_ready t_off: 1..3; timer: 0..3",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_holding_brake_contract on heidenhain::holding_brake {
        property: "every clause of the contract of the holding-brake test: order, path, current, faults that stay",
        tries: "factor: 0 1 300",
        caveat: "path and current are measured outside",
    }]
    [contract hfs_status_bits_contract on heidenhain::status_bits {
        property: "every clause of the status bits' contract: the reaction table of MC and CC",
        tries: "",
        caveat: "none",
    }]
    [contract hfs_sampling_contract on heidenhain::sampling {
        property: "every clause of the forced dynamic sampling's contract: order of the pulses, open contacts, short circuits",
        tries: "t_low: 1 3 max; timer: 0..3 max",
        caveat: "the length of a pulse is not published",
    }]
    [contract hfs_self_checks_contract on heidenhain::self_checks {
        property: "every clause of the contract of the kernel's checks: the fault tables",
        tries: "",
        caveat: "how a fault is found is outside",
    }]
    [contract hfs_start_checks_contract on heidenhain::start_checks {
        property: "every clause of the contract of the checks while booting: refusal until the main switch",
        tries: "motor_speed: -1..1 99..101 ends; rated_speed: -1..1 ends",
        caveat: "none",
    }]
    [run(13) [kani(solver(kissat)) parts(11: axis_limit = 1, spindle_axis_limit = 2, spindle_limit = 3, standstill_path = 4, stop_path = 5, deviation = 6, stop_time = 7, brake_time = 8, test_interval = 9, permissive_time = 10, window = 11)] hfs_units on heidenhain::"parameters" by units::values_round_to_the_earlier_reaction {
        property: "a safe machine parameter in its printed range becomes the exact value rounded to the earlier reaction; any other is refused",
        requirements: ["HFS-PARAM-010", "HFS-TIMING-001"],
        covers: ["accepted", "refused", "rounded down", "rounded up"],
        domain: NARROW,
        domain_text: "11 parameters; values 0 to 40, those around both ends of each range, and the highest number",
        bound: "none",
        caveat: "absolute positions and the bits of SMP560 are tested by examples",
    }]
}
