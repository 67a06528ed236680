//! The monitor of the ramp.

inventory! {
    [contract [kani(unwind(18), stub(stillpoint_monitors::srm::common::calls, crate::arbitrary::srm::few_calls), stub(stillpoint_monitors::srm::common::multiple, crate::arbitrary::srm::few_multiples), stub(stillpoint_monitors::srm::common::quotient, crate::arbitrary::srm::few_quotients), stub(stillpoint_monitors::srm::common::remainder, crate::arbitrary::srm::few_remainders), stub(stillpoint_monitors::srm::sbr_monitor::whole_mm, crate::arbitrary::srm::few_whole_mm)) parts(3: first = 1, second = 2, third = 3)] srm_sbr_monitor_contract on srm::sbr_monitor {
        property: "every clause of F_SBR_MONITOR: ramp, way, end, acknowledgement, parameters",
        tries: "t_sample: 0 20; t_ramp: -20 0 30 40; v_max: 3001 6000; v_stop_monitoring: 5; maxtol_v: 1 6001; maxtol_pos: 1 max; ramp: 0 3000 6000; start: 0; way: 0 1 max; rest: 0 59999; safe_pos: 0 1 2 4 min; safe_v: 0 4 5 3001 6001 -6002",
        few: [("t_sample", 0, 3), ("ramp", 0, 255)],
        caveat: "times and velocities between those only under Kani and in samples; Kani takes ramps of 0 to 255 ms from 0 to 255 mm/min",
    }]
    [total [kani(unwind(18))] srm_sbr_monitor_total on srm::sbr_monitor { caveat: "none" }]
}
