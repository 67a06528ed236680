//! What monitors braking, and the brakes.

use super::super::NARROW;

inventory! {
    [contract [kani(solver(kissat))] s120_sam_contract on sinamics::sam {
        property: "every clause of SAM: first cycle, limit that never rises, shutdown speed, STOP A, failed encoder",
        tries: "tolerance: 0 3 max; ratio: 1 3 255; shutdown: 0 5; ssm_limit: 0 4; limit: 0 3 6 8 max; speed: 0 3 4 5 6 8 9 max",
        caveat: "none",
    }]
    [contract [kani(solver(minisat)) parts(7: first = 1, second = 2, third = 3, fourth = 4, fifth = 5, sixth = 6, seventh = 7)] s120_sbr_contract on sinamics::sbr {
        property: "every clause of SBR: delay, exact ramp, its begin and end, violation",
        tries: "config.reference: 0 1 7 max; time: 1 3 max; delay: 2 4; resolution: 0 1; left: 0..4; ramp: 0 1 2 7 8 max; rest: 0 1 2 4294967294; speed: 0 1 2 3 7 8 max",
        few: [("time", 0, 7), ("reference", 0, 63), ("ramp", 0, 63)] in parts [3, 4],
        caveat: "none",
    }]
    [run(12) s120_ss1_by_ramp_ends on sinamics::"ss1, sbr" by braking::ss1_by_ramp_ends {
        property: "SS1 without encoder and without time (p9506 = 1) ends in STO within the bound of the ramp, whatever the speed does",
        requirements: ["S120-PF-05", "S120-SBR-006", "S120-SS1-013", "S120-SBR-005"],
        covers: ["a slow axis ends it", "the ramp ends it", "the whole bound passes"],
        domain: NARROW,
        domain_text: "start 0 to 6, shutdown speed 1 to 2, ramp of 1 to 3 in 1 to 2 cycles, delay 2; speed in each cycle 0 to 6",
        bound: "at most 10 cycles",
        caveat: "small speeds and times",
    }]
    [contract s120_sbc_contract on sinamics::sbc {
        property: "every clause of SBC: STO, faults of either channel, both switches, diagnosis at changes",
        tries: "",
        caveat: "none",
    }]
    [contract [kani(solver(minisat))] s120_brake_test_contract on sinamics::brake_test {
        property: "every clause of SBT: selection, load, choice, brakes and their times, torque, result, interruption, stops",
        tries: "ramp: 2; duration: 2; tolerance: 1; external: 3; opening closing: 2; left: 0..3; begin: 0; position: 0 2",
        caveat: "one set of times and tolerances; others only under Kani and in samples",
    }]
    [contract s120_brake_test_request_contract on sinamics::brake_test_request {
        property: "every clause of the brake test by the test stop: order, choice, automatic test, one request",
        tries: "",
        caveat: "none",
    }]
}
