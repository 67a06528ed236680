//! The load supervision and its calibration.

inventory! {
    [contract [kani(solver(kissat), unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls))] srm_load_monitor_contract on srm::load_monitor {
        property: "every clause of the load supervision of F_LOAD_MONITOR: overload, slack rope, discrepancy, retraction, reports",
        tries: "config.maxtol_load: 1; maxload_dyn: 8; maxload_stat: 6; minload: 1 6; vmax_release: 3; cal_value maxtol_cal: 5; t_sample: 20; t_test: 40; t_settle: 20; err_react: 0; state.overflowed: 0; load1: 3 7 -2147483648; load2: 0 3 5 6 2147483647; safe_v: 0 4",
        few: [("t_sample", 0, 3), ("t_test", 0, 15), ("t_settle", 0, 15)],
        caveat: "wider loads and parameters only under Kani and in samples",
    }]
    [contract [kani(solver(kissat), unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls))] srm_load_calibration_contract on srm::load_calibration {
        property: "every clause of the calibration of F_LOAD_MONITOR: start, settling, holding, interval",
        tries: "t_interval: 0 2; t_sample: 20; t_test: 40 60; t_settle: 20 40 60; cal_value: 5; maxtol_cal: 1; calls: 0..2; from1: -2147483648 0 2; from2: 0 2; left: 0..2; load1: 4 7 9 2147483647; load2: 2 6 7",
        few: [("t_sample", 0, 3), ("t_test", 0, 15), ("t_settle", 0, 15)],
        caveat: "longer times and other loads only under Kani and in samples",
    }]
}
