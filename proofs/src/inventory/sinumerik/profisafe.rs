//! The harnesses of what belongs to PROFIsafe.

use crate::inventory::NARROW;

inventory! {
    [contract f_master_contract on sinumerik::f_master {
        property: "every clause of the F master's contract: its cycle, repeated attempts, 50 ms, acknowledgement, overruns, power-on",
        tries: "ratio overruns: 1 2; tolerated: 2 4 5; until: 0 1; since: 0..5; exceeded: 0..2",
        caveat: "that the PLC executes what is started is taken from its ready signal; repeated attempts leave the grid (reading B-41)",
    }]
    [contract f_module_contract on sinumerik::f_module {
        property: "every clause of the F module's contract: both channels, data only at a start, cleared inputs, stops, acknowledgement",
        tries: "bits: 2 32; received: 1 max; bad: 0 1; outse: 1 max; outsep: 1 2; shown net: 0 1; blocked: 0 2",
        caveat: "cleared inputs return with RESET (reading B-42); what the module does without telegrams is its own",
    }]
    [run(4) net_data_row on sinumerik::"net_data" by profisafe::row_is_its_ends {
        property: "the datum 00aaabbb of a row is its two ends; every number that is no row, and every filter of another width, is refused",
        requirements: ["S840D-PSPARAM-004", "S840D-PSPARAM-005", "S840D-PSPARAM-006", "S840D-PSAFE-028", "S840D-PSAFE-030"],
        covers: ["a row of eight", "a number that is no row"],
        domain: NARROW,
        domain_text: "lower ends 0 to 999; upper ends 0 to 70 and the last; filters 0 to 7 and none",
        bound: "none",
        caveat: "none",
    }]
    [run(10) [kani(solver(kissat))] net_data_taken on sinumerik::"net_data" by profisafe::taken_in_order {
        property: "a bit of an F module that is used is the variable with as many used bits below it; all else stays as it is",
        requirements: ["S840D-P-22", "S840D-PSAFE-001", "S840D-PSPARAM-003", "S840D-PSPARAM-004", "S840D-PSPARAM-006"],
        covers: ["no filter", "a filter with gaps", "a bit that is not used"],
        domain: NARROW,
        domain_text: "filters 0 to 40 and none; rows from variable 1, 2, 3 and the last possible on; net data 0 to 3 and all; every bit",
        bound: "none",
        caveat: "rows of at most eight variables (AMB-19)",
    }]
    [run(10) [kani(solver(kissat))] net_data_given on sinumerik::"net_data" by profisafe::given_in_order {
        property: "a bit for an F module is its variable where both channels have it, and 0 where it is not used",
        requirements: ["S840D-P-22", "S840D-PSAFE-003", "S840D-PSAFE-007", "S840D-PSPARAM-005", "S840D-PSPARAM-006"],
        covers: ["no filter", "a filter with gaps", "a variable that both channels have"],
        domain: NARROW,
        domain_text: "filters 0 to 40 and none; rows from variable 1, 2, 3 and the last possible on; words 0, 1 and all of each channel; every bit",
        bound: "none",
        caveat: "rows of at most eight variables (AMB-19)",
    }]
    [run(10) [kani(solver(kissat))] net_data_there_and_back on sinumerik::"net_data" by profisafe::there_and_back {
        property: "variables that are given to an F module and taken back are the same, and so are bits",
        requirements: ["S840D-P-22", "S840D-PSPARAM-003", "S840D-PSPARAM-005"],
        covers: ["no filter", "a filter with gaps"],
        domain: NARROW,
        domain_text: "filters 0 to 40 and none; rows from variable 1, 2, 3 and the last possible on; net data and variables 0 to 8 and all",
        bound: "none",
        caveat: "both channels alike; rows of at most eight variables (AMB-19)",
    }]
}
