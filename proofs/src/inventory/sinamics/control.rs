//! The control part.

inventory! {
    [contract s120_input_filter_contract on sinamics::input_filter {
        property: "every clause of the input filter: short pulses, lasting levels",
        tries: "time: 0..4 max; other: 0..4 max",
        caveat: "none",
    }]
    [contract s120_terminal_pair_contract on sinamics::terminal_pair {
        property: "every clause of the terminal pair: selection at once, discrepancy, hold, fault",
        tries: "tolerance: 1..3 max; timer: 0..3 max",
        caveat: "none",
    }]
    [contract s120_chatter_contract on sinamics::chatter {
        property: "every clause of the watch over frequent switching: rest, watch, fault",
        tries: "rest: 1..3; unrested: 0..3; watch: 0..15",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract s120_basic_selection_contract on sinamics::basic_selection {
        property: "every clause of the selection of Basic Functions: paths in parallel, STO before SS1",
        tries: "",
        caveat: "none",
    }]
    [contract s120_basic_stop_contract on sinamics::basic_stop {
        property: "every clause of STOP F and A of the Basic Functions: delay, internal and general acknowledgement, lock",
        tries: "delay: 0..3 max; timer: 0..3 max",
        caveat: "none",
    }]
    [contract s120_fail_safe_input_contract on sinamics::fail_safe_input {
        property: "every clause of an F-DI: truth tables, discrepancy, latch, start, freezing",
        tries: "tolerance: 1..3 max; timer: 0..3 max",
        caveat: "none",
    }]
    [contract s120_fail_safe_output_contract on sinamics::fail_safe_output {
        property: "every clause of an F-DO: AND of the connected sources, test",
        tries: "",
        caveat: "none",
    }]
    [contract [kani(unwind(9))] s120_safe_state_contract on sinamics::safe_state {
        property: "every clause of Safe State: AND over the drives, then OR over the functions",
        tries: "functions: 0 1 2 5 255; drives: 0..7; active: 0 1 2 5",
        caveat: "three of the eight functions; others only under Kani and in samples",
    }]
    [contract s120_stop_arbiter_contract on sinamics::stop_arbiter {
        property: "every clause of the arbitration: table of priorities, latch, times, STOP F, acknowledgement, actions",
        tries: "t_b t_c: 0 2; t_d t_e: 2; t_f: 0 2; timer: 0..2; fault_timer: 0..2",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract s120_cross_check_contract on sinamics::cross_check {
        property: "every clause of the cross-check: each result of both channels, the time they may be apart, findings of this channel",
        tries: "apart: 1 3; since: 0..3; own.sls_level own.stage own.stop own.function: 0; other.sls_level other.stage: 0 1; other.stop: 0 3; other.function: 0 2",
        caveat: "two values of each result of the other channel; others, and longer times, only under Kani and in samples",
    }]
    [contract s120_acknowledgement_edge_contract on sinamics::acknowledgement_edge {
        property: "every clause of an acknowledging edge: rest, rise, fall, interruption, unsettled inputs",
        tries: "",
        caveat: "none",
    }]
    [contract s120_acknowledgement_contract on sinamics::acknowledgement {
        property: "every clause of the acknowledgement: enabled sources, event, faults of the module",
        tries: "",
        caveat: "none",
    }]
    [contract s120_restart_contract on sinamics::restart {
        property: "every clause of the restart: STO, both edges, latched stops",
        tries: "",
        caveat: "the start of a drive without encoder is another monitor",
    }]
    [contract s120_communication_contract on sinamics::communication {
        property: "every clause of the supervised communication: watchdog, substitute values, reaction, ESR, reintegration",
        tries: "watchdog: 1..3 max; config.esr: 0..2; watch: 0..3 max; state.esr: 0..2",
        caveat: "that the telegram is valid is found by the PROFIsafe driver",
    }]
    [contract s120_io_test_contract on sinamics::io_test {
        property: "every clause of the I/O test stop: start, steps, levels, failure, interval",
        tries: "read: 1 2; config.interval: 1 2 max; timer: 0..2; state.interval: 0 1 2 max",
        caveat: "none",
    }]
    [contract [kani(solver(minisat), unwind(18)) parts(3: first = 1, second = 2, third = 3)] s120_message_buffer_contract on sinamics::message_buffer {
        property: "every clause of the message buffer: entry, overflow, cases, clearing, changes",
        tries: "current.count: 0..8; current.codes.0: 1701; current.codes.3: 1704; current.codes.7: 1707 1708; current: 1711; acknowledged.0.count: 0 1; acknowledged.0: 1714; acknowledged.5.count: 0 1; acknowledged.5: 1715; acknowledged.6.count: 0 1; acknowledged.6: 1716; acknowledged: 0; changes: 0 max; message: 0 1700; rectified: 0 1 2 5 64 85 128 255",
        caveat: "few codes and masks; others only under Kani and in samples",
    }]
    [contract s120_acceptance_mode_contract on sinamics::acceptance_mode {
        property: "every clause of the acceptance test mode: edge, time, what is tolerated",
        tries: "duration: 1..3 max; left: 0..3 max",
        caveat: "none",
    }]
    [contract s120_commissioning_contract on sinamics::commissioning {
        property: "every clause of the commissioning mode: password, changes, copies, checksums, POWER ON",
        tries: "",
        caveat: "what a checksum is formed of is not part of this monitor",
    }]
    [contract s120_replacement_contract on sinamics::replacement {
        property: "every clause of replaced components: message, confirmation, saving",
        tries: "",
        caveat: "none",
    }]
}
