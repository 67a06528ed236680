//! The harnesses of the monitors that check the monitoring.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract test_stop_contract on sinumerik::test_stop {
        property: "every clause of the contract of the test of the shutdown path: refusal, feedback in time, hold, higher stops",
        tries: "t_chk: 0..2 4; timer: 0..4",
        caveat: "standstill before the test is a duty of the user (reading A-32)",
    }]
    [contract shutdown_test_contract on sinumerik::shutdown_test {
        property: "every clause of the contract of the test of the external shutdown",
        tries: "t_chk: 0..2 4; timer: 0..4",
        caveat: "which axes share the output is decided outside (S840D-TEST-018)",
    }]
    [contract pulses_contract on sinumerik::pulses {
        property: "every clause of the pulse cancellation's contract: at once, supervised, fallback to the external path",
        tries: "t_chk: 0..2 4; timer: 0..4",
        caveat: "that the pulses are off once their enable is gone is an assumption about the drive",
    }]
    [contract compare_contract on sinumerik::compare {
        property: "every clause of the comparison's contract: order of the list, suspension by changes, checking timer, codes",
        domain: Domain { delays: &[0, 1, 2], highest_speed: 0 },
        domain_text: "t_chg 0, 1 or 2 cycles; lists of 1, 6 and 84 items; every consistent state; every input",
        caveat: "what differs comes from outside, see compare_tolerance",
    }]
    [contract [kani(solver(kissat)) parts(3: first = 1, second = 2, third = 3)] slip_contract on sinumerik::slip {
        property: "every clause of the synchronisation's contract: half of the difference, dead band, tolerance, never past",
        tries: "dead tol: 0..3 max; offset: -4294967295..-4294967293 -2147483650..-2147483645 -2..2 2147483645..2147483650 4294967293..4294967295; own other: -3..3 ends",
        caveat: "none",
    }]
    [contract history_contract on sinumerik::history {
        property: "every clause of the history's contract: exact at the tolerance, kept through power-on, not overtaken",
        tries: "tol: 0..3 max; standstill: -2..2 ends; position: 0 -7; refpos: -3..3 ends; travelled: -1..1 ends",
        caveat: "that the non-volatile memory keeps the position is assumed",
    }]
    [contract forced_check_contract on sinumerik::forced_check {
        property: "every clause of the forced checking's contract: both paths, interval, failure, power-on",
        tries: "interval: 1 2 4; drive nck: 0..4",
        caveat: "what follows from a due test is decided outside (S840D-TEST-002)",
    }]
    [contract relay_contract on sinumerik::relay {
        property: "every clause of the safety relay's contract: shutdown at once, acknowledgement, window of the test, delays",
        tries: "window: 0..2; delay_1: 0; delay_2: 0 1; delay_3: 0 2; left least off_1 off_2 off_3: 0..2",
        caveat: "a shutdown counts in whole cycles; that the button acknowledges by its edge is reading B-07",
    }]
    [run(4) checking_initial_states on sinumerik::"the checking monitors" by checking::checking_initial_states {
        property: "the initial states of the checking monitors satisfy their invariants: the base of the induction",
        requirements: ["S840D-ARCH-504"],
        covers: ["an accepted configuration"],
        domain: Domain { delays: &[0, 1, 2], highest_speed: 0 },
        domain_text: "small delays and tolerances",
        bound: "none",
        caveat: "none",
    }]
    [run(6) test_stuck_feedback on sinumerik::"test_stop, shutdown_test" by checking::stuck_feedback_never_passes {
        property: "with the feedback stuck no test ever passes: at 0 STOP A comes after exactly t_chk, at 1 the test is refused",
        requirements: ["S840D-P-28", "S840D-P-29", "S840D-P-55", "S840D-TEST-008", "S840D-TEST-012", "S840D-TEST-017"],
        covers: ["stuck at 0", "a test is refused", "the selection is withdrawn early"],
        domain: NARROW,
        domain_text: "t_chk 0 to 3 cycles; either test; the selection in every pattern",
        bound: "t_chk at most 3; longer times follow from the contract (missing_feedback_ends_in_stop_a, feedback_is_seen_to_change)",
        caveat: "without power-on and without internal STOP A or B, which end the test without result",
    }]
    [run(6) test_ends on sinumerik::"test_stop, shutdown_test" by checking::every_test_ends {
        property: "a test that runs ends: failed or with its feedback within t_chk, and then with the withdrawal of its selection",
        requirements: ["S840D-P-35", "S840D-TEST-009", "S840D-TEST-029"],
        covers: ["a test passes", "a test fails"],
        domain: NARROW,
        domain_text: "t_chk 1 to 3 cycles; either test; selection and feedback in every pattern",
        bound: "t_chk at most 3; longer times follow from the contract",
        caveat: "without power-on and without internal STOP A or B",
    }]
    [run(6) pulses_fallback on sinumerik::"pulses" by checking::failed_cancellation_falls_back {
        property: "pulses not reported cancelled lose the external enable after exactly t_chk, and at once when the report is lost",
        requirements: ["S840D-PULSE-005", "S840D-PULSE-007"],
        covers: ["the whole time passes", "the feedback is lost again"],
        domain: NARROW,
        domain_text: "t_chk 0 to 3 cycles; the feedback in every pattern",
        bound: "t_chk at most 3; longer times follow from the contract (missing_feedback_falls_back)",
        caveat: "reading A-19 CANCEL_FAIL_TCHK",
    }]
    [run(7) compare_finds on sinumerik::"compare" by checking::lasting_difference_is_found {
        property: "a lasting difference is found within one pass: a static one whatever changes, a dynamic one after t_chg, not before",
        requirements: ["S840D-P-26", "S840D-P-27", "S840D-P-40", "S840D-KDV-504", "S840D-KDV-506"],
        covers: ["a static item while signals change", "a dynamic item after a change", "a dynamic item without change"],
        domain: NARROW,
        domain_text: "t_chg 0 to 2 cycles; a list of 3 items from every place; every pattern of changes and other differences",
        bound: "3 items, t_chg at most 2; longer ones follow from the contract (list_is_worked_off, suspension_ends)",
        caveat: "what STOP F does with the finding is the property of fault",
    }]
    [run(23) compare_endless_changes on sinumerik::"compare, two channels" by checking::endless_changes_are_found {
        property: "a change timer kept running for 10 t_chg is found by the other channel with code 1000, not earlier",
        requirements: ["S840D-P-50", "S840D-KDV-507", "S840D-KDV-715", "S840D-KDV-731"],
        covers: ["code 1000", "the changes end before"],
        domain: NARROW,
        domain_text: "t_chg 1 or 2 cycles; every pattern of changes",
        bound: "t_chg at most 2; longer times follow from the contract (checking_runs_once, lasting_change_is_found)",
        caveat: "the channels learn of each other with one cycle of delay",
    }]
    [run(18) compare_tolerance on sinumerik::"compare" by checking::tolerance_is_exact {
        property: "equal channels never differ; positions and limits differ exactly beyond the tolerance",
        requirements: ["S840D-P-33", "S840D-KDV-501", "S840D-KDV-505/a", "S840D-KDV-516", "S840D-SLIP-504"],
        covers: ["at the tolerance", "just beyond it", "a limit"],
        domain: NARROW,
        domain_text: "every item; positions -3 to 3 and both ends in each channel; tolerance 0 to 3 and the greatest",
        bound: "none",
        caveat: "the comparison of each parameter is a test against the manual's table of codes",
    }]
    [run(5) [kani(solver(kissat)) parts(2: together = 1, alone = 2)] slip_meets on sinumerik::"slip, two channels" by checking::synchronised_channels_meet {
        property: "both channels meet in one comparison up to one increment; one alone comes closer each time; never past each other",
        requirements: ["S840D-SLIP-502", "S840D-SLIP-503"],
        covers: ["the channels meet", "within the dead band from the beginning", "one channel is alone"],
        domain: NARROW,
        domain_text: "positions -9 to 9 and both ends in each channel; dead band and tolerance 0 to 3 and the greatest",
        bound: "three comparisons at standstill, exchange in one cycle",
        caveat: "a moving axis shows its feed as a difference unless both positions are of one instant; Kani takes one comparison from any corrections, these and the positions of 12 bits",
    }]
    [run(4) history_moved on sinumerik::"history" by checking::moved_while_off_is_seen {
        property: "the history is accepted exactly if the axis was moved no further than the tolerance while it was off",
        requirements: ["S840D-REF-007", "S840D-REF-009", "S840D-REF-010", "S840D-KDV-516"],
        covers: ["at the tolerance", "just beyond it"],
        domain: NARROW,
        domain_text: "positions and ways -1 to 1 and both ends, movements -5 to 5; tolerance 0 to 3 and the greatest; storing throughout",
        bound: "standstill, power-on, reference point, comparison",
        caveat: "positions beyond the range of 32 bits are left out",
    }]
    [run(6) forced_check_due on sinumerik::"forced_check" by checking::test_becomes_due {
        property: "a test is due exactly when a path has passed none within the interval since power-on and the last failure",
        requirements: ["S840D-TEST-001/a", "S840D-TEST-005", "S840D-TIMING-513"],
        covers: ["both paths are tested", "a test has grown too old"],
        domain: NARROW,
        domain_text: "interval 1 to 3 cycles; every sequence of four cycles",
        bound: "interval at most 3; longer ones follow from the contract (paths_run_down)",
        caveat: "none",
    }]
}
