//! The load supervision and its calibration.

inventory! {
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls), stub(stillpoint_monitors::srm::common::remainder, crate::arbitrary::srm::few_rests)) parts(2: first = 1, second = 2)] srm_load_monitor_contract on srm::load_monitor {
        property: "every clause of the load supervision of F_LOAD_MONITOR: overload, slack rope, discrepancy, retraction, reports",
        tries: "config.maxtol_load: 1; maxload_dyn: 8; maxload_stat: 6; minload: 1 6; vmax_release: 3; cal_value maxtol_cal: 5; t_sample: 20; t_test: 40; t_settle: 20; err_react: 0; state.overflowed: 0; load1: 3 7 -2147483648; load2: 0 3 5 6 2147483647; safe_v: 0 4",
        caveat: "wider loads and parameters only under Kani and in samples; Kani takes times of 0 to 255 ms in calls of 0 to 3 ms",
    }]
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls)) parts(2: first = 1, second = 2)] srm_load_calibration_contract on srm::load_calibration {
        property: "every clause of the calibration of F_LOAD_MONITOR: start, settling, holding, interval",
        tries: "t_interval: 0 2; t_sample: 20; t_test: 40 60; t_settle: 20 40 60; cal_value: 5; maxtol_cal: 1; calls: 0..2; from1: -2147483648 0 2; from2: 0 2; left: 0..2; load1: 4 7 9 2147483647; load2: 2 6 7",
        caveat: "longer times and other loads only under Kani and in samples; Kani takes times of 0 to 255 ms in calls of 0 to 3 ms",
    }]
    [total [kani(unwind(18))] srm_load_monitor_total on srm::load_monitor { caveat: "none" }]
    [total [kani(unwind(18))] srm_load_calibration_total on srm::load_calibration { caveat: "none" }]
}
