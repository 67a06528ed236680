//! The brake test.

inventory! {
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls), stub(stillpoint_monitors::srm::common::multiple, crate::arbitrary::srm::few_whole_times), stub(stillpoint_monitors::srm::common::remainder, crate::arbitrary::srm::few_rests)) parts(4: first = 1, second = 2, third = 3, fourth = 4)] srm_brake_test_contract on srm::brake_test {
        property: "every clause of F_BRAKE_TEST: order of the sequences, handshake with the drive, brakes, faults, restriction, interval",
        tries: "t_interval: 1; t_sample: 1; sequence_br_1: 1; sequence_br_2: 18; t_open_br_1 t_close_br_1 t_open_br_2 t_close_br_2: 2; pos_tolerance: 1; vmax_release: 0 5; t_mon_sel t_mon_req: 2; unproven: 0; err_react: 0; second sequence: 0 1; timer: 0..2; start: 0; faults: 0 64; overflowed: 0; due: 1; left: 1; ack_held: 0; safe_v: 0 6; safe_pos: 1 -2147483648; fdback_br_2: 0",
        caveat: "one sequence of each brake, an external and a motor holding one; others and longer times only under Kani and in samples; Kani takes times of 0 to 255 ms in calls of 0 to 3 ms",
    }]
    [total [kani(unwind(18))] srm_brake_test_total on srm::brake_test { caveat: "none" }]
}
