//! Stops, selection of the function, referencing, user agreement and gear stage.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract stop_contract on sinumerik::stop {
        property: "every clause of the arbitration's contract: priority, latching, acknowledgement, timers, actions",
        tries: "t_b t_d: 0 2; t_c t_e: 2; timer: 0..2",
        caveat: "longer times only under Kani and in samples; the code compares times, it never treats one by its value",
    }]
    [contract external_contract on sinumerik::external {
        property: "every clause of the external stops' contract: table of priorities, enables, latch of the safe logic",
        tries: "",
        caveat: "none",
    }]
    [contract fault_contract on sinumerik::fault {
        property: "every clause of STOP F's contract: escalation, delay, latching, acknowledgement, interlock",
        tries: "t_f: 0..3 5; timer: 0..5",
        caveat: "what counts as an active function and as a discrepancy comes from outside",
    }]
    [contract [kani(stub(stillpoint_monitors::kernel::Speed::reduced, crate::kani_source::reduced_small))] selection_contract on sinumerik::selection {
        property: "every clause of the selection's contract: delays, override, forced operating stop, reference position, feedback",
        domain: Domain { delays: &[0, 2], highest_speed: 2 },
        domain_text: "t_vel 0 or 2 cycles; limits 0 to 2 in every order; no override, or factors of 1 or 100 % at 0 and elsewhere; two positions; every consistent state and input",
        caveat: "the comparison of speed and position with the limits is not part of this monitor; Kani takes no override: selection_override and units_factor do",
    }]
    [contract reference_contract on sinumerik::reference {
        property: "every clause of the referencing's contract: both agreements, history between, loss",
        tries: "",
        caveat: "the result of the comparison with the history comes through the agreements",
    }]
    [contract agreement_contract on sinumerik::agreement {
        property: "every clause of the user agreement's contract: key, reference, gear, history, difference of the channels",
        tries: "t_differ: 1 2 4; timer: 0..4",
        caveat: "that the non-volatile memory keeps the agreement is assumed",
    }]
    [contract gear_contract on sinumerik::gear {
        property: "every clause of the gear stage's contract: a change is an event in the same cycle",
        tries: "",
        caveat: "a mechanical change without its signals is not detected (S840D-REF-012)",
    }]
    [contract group_contract on sinumerik::group {
        property: "every clause of the effect on other axes: table of 5.2, setting, ESR, external stops",
        tries: "",
        caveat: "of several stopping axes the highest reaction counts: a maximum, tested in the monitor's module",
    }]
    [contract bus_failure_contract on sinumerik::bus_failure {
        property: "every clause of the reaction to a failure of the drive bus: at once, delayed, kept, what each channel still does",
        tries: "delay: 0..2; left: 0..2",
        caveat: "that the signals and the monitored stage are those still known to the channel is up to the caller",
    }]
    [run(18) initial_states on sinumerik::"all" by initial::initial_states {
        property: "the initial state of every monitor satisfies its invariant: the base of the induction",
        requirements: ["S840D-ARCH-504"],
        covers: ["an accepted configuration"],
        domain: Domain { delays: &[0, 1, 3], highest_speed: 1 },
        domain_text: "small delays and limits",
        bound: "none",
        caveat: "none",
    }]
    [run(6) stop_b_ends on sinumerik::"stop" by stop::b_ends_with_pulses_cancelled {
        property: "STOP B cancels the pulses within t_B cycles, whatever speed, RESET and signals do",
        requirements: ["S840D-P-01", "S840D-P-03", "S840D-P-05", "S840D-STOP-021", "S840D-STOP-022", "S840D-STOP-023"],
        covers: ["the whole time passes", "the axis stands still before"],
        domain: NARROW,
        domain_text: "t_B 0 to 3 cycles; every sequence of the inputs named in the property",
        bound: "t_B at most 3; longer times follow from the contract (stop_b_ends_in_time)",
        caveat: "without power-on; external STOP A is left out, since it cancels the pulses itself",
    }]
    [run(6) stop_braking_ends on sinumerik::"stop" by stop::braking_ends_in_standstill {
        property: "STOP E, D, C reach the operating stop within the time of the first one",
        requirements: ["S840D-P-06", "S840D-STOP-031", "S840D-STOP-080", "S840D-STOP-091", "S840D-ACK-004"],
        covers: ["at the last moment", "earlier, by a higher stop with a shorter time"],
        domain: NARROW,
        domain_text: "t_C, t_D, t_E 0 to 3 cycles; every sequence of demands, external STOP C and RESET",
        bound: "times at most 3; longer ones follow from the contract (braking_ends_in_time)",
        caveat: "reading A-38 TIMER_EARLIEST",
    }]
    [run(4) stop_queue on sinumerik::"stop" by stop::queued_stop_acts_after_withdrawal {
        property: "a stop queued beneath an external STOP A acts after its withdrawal and starts its time then",
        requirements: ["S840D-P-20", "S840D-EXT-009", "S840D-STOP-097", "S840D-SIGNAL-011"],
        covers: ["a queued STOP C, D or E", "a queued STOP B"],
        domain: Domain { delays: &[0, 1, 2], highest_speed: 0 },
        domain_text: "times 0, 1 or 2 cycles each; every queued stop",
        bound: "three cycles",
        caveat: "none",
    }]
    [run(9) stop_pair on sinumerik::"stop, two channels" by stop::channels_do_not_hold_each_other {
        property: "both channels take the higher of their stops, and one RESET frees both",
        requirements: ["S840D-P-45", "S840D-STOP-007", "S840D-STOP-090", "S840D-ACK-001"],
        covers: ["a stop of one channel only"],
        domain: NARROW,
        domain_text: "every pair of demands of STOP E, D, C",
        bound: "times 0 to 2 cycles, exchange in one cycle, RESET to both channels when neither brakes",
        caveat: "the joint RESET is wired outside the monitor",
    }]
    [run(4) fault_delay on sinumerik::"fault" by fault::delay_leads_to_stop_b {
        property: "STOP F with an active function requests STOP B after exactly t_F cycles, whatever comes in between",
        requirements: ["S840D-P-21", "S840D-P-24", "S840D-STOP-063", "S840D-STOP-099"],
        covers: ["a delay runs", "RESET arrives in it"],
        domain: NARROW,
        domain_text: "t_F 0 to 2 cycles; every sequence of inputs",
        bound: "t_F at most 2; longer delays follow from the contract (delay_cannot_be_aborted, delay_is_kept)",
        caveat: "without power-on; reading A-08 F_DELAY_STICKY",
    }]
    [run(7) selection_delay on sinumerik::"selection" by selection::old_limit_for_exactly_the_delay {
        property: "a lower limit, or the operating stop, comes after exactly t_vel cycles; the old limit is compared until then",
        requirements: ["S840D-P-08", "S840D-P-53", "S840D-SG-004", "S840D-SBH-003"],
        covers: ["a lower limit with a delay", "the operating stop with a delay", "no delay"],
        domain: NARROW,
        domain_text: "t_vel 0 to 4 cycles; every pair of stages; two positions in each cycle",
        bound: "t_vel at most 4; longer delays follow from the contract (lower_limit_comes_in_time, standstill_comes_in_time)",
        caveat: "none",
    }]
    [run(18) [kani(stub(stillpoint_monitors::kernel::Speed::reduced, crate::kani_source::reduced_small))] selection_forced on sinumerik::"selection" by selection::forced_standstill_does_not_depend_on_signals {
        property: "two runs of a forced operating stop that differ in the signals only are the same",
        requirements: ["S840D-P-07", "S840D-STOP-080", "S840D-EXT-018"],
        covers: ["the signals differ and one of them de-selects"],
        domain: Domain { delays: &[1], highest_speed: 1 },
        domain_text: "t_vel 1 cycle; limits 0 or 1; with and without override; every consistent state; every pair of signals",
        bound: "one step from any consistent state; inductive",
        caveat: "Kani takes limits below a factor of at most 15, see units_factor",
    }]
    [run(5) selection_reference on sinumerik::"selection" by selection::reference_does_not_creep {
        property: "an acknowledged operating stop keeps the reference it was forced with",
        requirements: ["S840D-P-07", "S840D-SBH-001", "S840D-SBH-012"],
        covers: ["the axis moves"],
        domain: NARROW,
        domain_text: "two positions in each cycle",
        bound: "four cycles",
        caveat: "reading A-39 REF_KEEP",
    }]
    [run(4) axis_gear on sinumerik::"gear, agreement, reference" by axis::gear_change_ends_safe_reference {
        property: "a change of the gear stage in one channel ends the safe reference in the same cycle",
        requirements: ["S840D-P-14", "S840D-P-37", "S840D-GEAR-505", "S840D-UA-006"],
        covers: ["the axis was safely referenced"],
        domain: NARROW,
        domain_text: "every pair of stages, either channel, every agreement, the user agreeing or not",
        bound: "one cycle of two channels",
        caveat: "the exchange between the channels takes one cycle at most",
    }]
    [run(7) axis_history on sinumerik::"gear, agreement, reference" by axis::history_decides_after_power_on {
        property: "after power-on with stored agreements the history of both channels decides on the safe reference",
        requirements: ["S840D-P-15", "S840D-REF-004", "S840D-REF-008", "S840D-REF-014", "S840D-REF-015"],
        covers: ["the comparison succeeds", "it fails in one channel only"],
        domain: NARROW,
        domain_text: "every result of the comparisons, stored positions present or not",
        bound: "three cycles from power-on",
        caveat: "the subtraction of the positions is outside the monitor",
    }]
    [run(6) axis_single on sinumerik::"gear, agreement, reference" by axis::single_agreement_does_not_last {
        property: "an agreement in one channel only is withdrawn after t_differ and never makes the axis safely referenced",
        requirements: ["S840D-P-13", "S840D-UA-009", "S840D-REF-006/a"],
        covers: ["one channel alone agreed"],
        domain: NARROW,
        domain_text: "t_differ 1 to 3 cycles; either channel; parking in every pattern",
        bound: "t_differ at most 3; longer times follow from the contract (difference_ends_in_time)",
        caveat: "none",
    }]
}
