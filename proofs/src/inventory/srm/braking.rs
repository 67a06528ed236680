//! The monitor of the ramp.

inventory! {
    [contract srm_sbr_monitor_contract on srm::sbr_monitor {
        property: "every clause of F_SBR_MONITOR: ramp, way, end, acknowledgement, parameters",
        tries: "t_sample: 0 20; t_ramp: -20 0 30 40; v_max: 3001 6000; v_stop_monitoring: 5; maxtol_v: 1 6001; maxtol_pos: 1 max; ramp: 0 3000 6000; start: 0; way: 0 1 max; rest: 0 59999; safe_pos: 0 1 2 4 min; safe_v: 0 4 5 3001 6001 -6002",
        caveat: "times and velocities between those only under Kani and in samples",
    }]
}
