//! Stop and monitoring state of an axis group.

inventory! {
    [contract hfs_stop_contract on heidenhain::stop {
        property: "every clause of the stop reaction's contract: priority, timers, braking order, torque off, restart",
        tries: "t_ss1 t_ss2 t_brake: 0 1 3; timer brake: 0..3",
        caveat: "longer times only under Kani and in samples; the code compares times with zero, it treats no other value specially",
    }]
    [contract hfs_report_contract on heidenhain::report {
        property: "every clause of the report's contract: the running stop, every cause that is found, nothing that is over",
        tries: "",
        caveat: "that the telegram arrives is watched by the watchdogs; when it arrives is in the tables",
    }]
    [contract hfs_neighbour_contract on heidenhain::neighbour {
        property: "every clause of the contract between groups: SS0, SS1F and wide SS1 spread, a wait brakes the listed ones, nothing else crosses",
        tries: "",
        caveat: "one pair of groups; that a group takes the highest of all others is outside",
    }]
    [contract [parts(2: first = 1, second = 2)] hfs_global_sto_contract on heidenhain::global_sto {
        property: "every clause of the contract of -STO.A.G after an SS0: end of the others, latest time, main switch",
        tries: "t_off: 1 2 4; timer: 0..4",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_judge_contract on heidenhain::judge {
        property: "every clause of the judgement's contract: bad requests, mode changes, motion, permissive, operating unit, self-test",
        tries: "",
        caveat: "which axes move and which stand for too long comes from outside",
    }]
    [contract hfs_group_contract on heidenhain::group {
        property: "every clause of the monitoring state's contract: release, tightening, loosening, ends of the stops",
        tries: "",
        caveat: "that the stop of the group was demanded for what a request breaks is the contract of judge",
    }]
    [contract hfs_startup_contract on heidenhain::startup {
        property: "every clause of the start-up protection's contract: count of the standstill, modes, permissive",
        tries: "t_idle: 1 2 4; timer: 0..4",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_axis_release_contract on heidenhain::axis_release {
        property: "every clause of the axis' contract: braking without feed enable, its time, standstill",
        tries: "t_ss2: 0 1 3; timer: 0..3",
        caveat: "longer times only under Kani and in samples",
    }]
}
