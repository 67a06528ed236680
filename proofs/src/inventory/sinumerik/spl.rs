//! The harnesses of the monitors of the safe logic.

inventory! {
    [contract spl_protection_contract on sinumerik::spl_protection {
        property: "every clause of the contract of the SPL's protection: read at power-on, its lack shown once",
        tries: "",
        caveat: "that a change of the setting is written to the control while it is off is not modelled",
    }]
    [contract spl_signal_contract on sinumerik::spl_signal {
        property: "every clause of the contract of one compared signal: exact time, CMDSI, RESET, start",
        tries: "plain: 1 2 32000; extended: 1..4 320000; left: 0..4 287999..288001 319999 320000",
        caveat: "cycles without an exchange count with the signals that were received last; readings B-02, B-03, B-39",
    }]
    [contract spl_comparison_contract on sinumerik::spl_comparison {
        property: "every clause of the contract of the SPL comparison: alarm, first number, stop of a protected channel, RESET",
        tries: "found number: 0..2 ends",
        caveat: "which signal is found is the matter of spl_signal; that all 320 are compared is a test; reading B-40",
    }]
    [contract spl_link_contract on sinumerik::spl_link {
        property: "every clause of the contract of the SPL's watchdog: silence, alarm, grace, cleared outputs, power-on",
        tries: "patience: 1 2 32000; grace: 1 2 160000; time: 0..2 31999 32000 159999 160000; outsed: 0 1 max",
        caveat: "that a channel which does not run any more is silent is assumed; reading B-38",
    }]
    [contract spl_start_contract on sinumerik::spl_start {
        property: "every clause of the contract of the SPL's start: order, machine data, end of program, failure, refusal",
        tries: "",
        caveat: "that the program of the PLC waits for what is released is its duty; reading B-01",
    }]
    [contract spl_file_contract on sinumerik::spl_file {
        property: "every clause of the contract of the program's integrity: reference, length, content, own checksum",
        tries: "length sum value: 0 1 max",
        caveat: "how a checksum is formed, and how often, is outside; reading B-37",
    }]
    [contract spl_access_contract on sinumerik::spl_access {
        property: "every clause of the contract of the access to the SPL: writing, exchange, images, protected actions",
        tries: "first last action: 0..3 max",
        caveat: "reading B-06",
    }]
    [contract spl_output_test_contract on sinumerik::spl_output_test {
        property: "every clause of the contract of the forced check of an output: off, answer, lock, stuck test input",
        tries: "delay: 1 2 320000; wrong: 0..2 319999 320000",
        caveat: "after power-on a test is due (S840D-TEST-024): what was locked before is not remembered",
    }]
    [contract spl_stop_test_contract on sinumerik::spl_stop_test {
        property: "every clause of the contract of the test of external stops: one channel at a time, edge, order, end",
        tries: "delay: 1 2 320000; left: 0..2 319999 320000",
        caveat: "which answer belongs to a step is wired outside",
    }]
}
