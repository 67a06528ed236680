//! The safe position.

inventory! {
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::common::remainder, crate::arbitrary::srm::few_rests), stub(stillpoint_monitors::srm::safe_pos::laws::rounded_up, crate::arbitrary::srm::few_rounded_up), stub(stillpoint_monitors::srm::safe_pos::Config::standing, crate::arbitrary::srm::few_standing), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls), stub(stillpoint_monitors::srm::common::multiple, crate::arbitrary::srm::few_whole_times), stub(stillpoint_monitors::srm::safe_pos::velocity::velocity, crate::arbitrary::srm::few_velocities))] srm_safe_pos_contract on srm::safe_pos {
        property: "every clause of F_SAFE_POS: encoder faults, discrepancies, validation, commands, range, velocity, drift, reports",
        tries: "t_sample: 10; possi_t_sample: 10; pos_min: 0; pos_max: 4; pos_disc_window: 1; pos2_disc_window possi_disc_window: 2; pos_startup_tol: 0; v_standstill: 5 12001; v_max: 12000; v_disc_window: 1; v_sync_intervall: 20; pos_reference: 2; count_margin: 0; sync_pos2: 0; count_watch: 0; err_react: 0; off1: 0; off_si: 0; off2: 0 3; saved: 0 1; below overflowed fast drifted: 0; state.safe_pos: 1; state.safe_v: 12; state.direction: 0; last1: 0; sample: 0; count: 0; still: 0 1; window1: 0; window_si: 0; window_calls: 0 1; sync_held ack_held: 0; pos1: -2147483648 1 4 5; pos2: 1; possi: 0 3000; possi_count: 0 -32767",
        few: [("t_sample", 0, 3)],
        caveat: "one set of parameters; other positions, offsets and times only in samples",
    }]
    [total [kani(unwind(18))] srm_safe_pos_total on srm::safe_pos { caveat: "none" }]
}
