//! Stop and monitoring state of an axis group.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract hfs_stop_contract on heidenhain::stop {
        property: "every clause of the stop reaction's contract: priority, timers, braking order, torque off, restart",
        domain: Domain { delays: &[0, 1, 3], highest_speed: 0 },
        domain_text: "SMP525 to SMP528 and MP2308 each 0, 1 or 3 cycles; either channel; every consistent state; every input",
        caveat: "longer times only under Kani and in samples; the code compares times with zero, it treats no other value specially",
    }]
    [contract hfs_report_contract on heidenhain::report {
        property: "every clause of the report's contract: the running stop, every cause that is found, nothing that is over",
        domain: NARROW,
        domain_text: "complete: every input",
        caveat: "that the telegram arrives is watched by the watchdogs; when it arrives is in the tables",
    }]
    [contract hfs_neighbour_contract on heidenhain::neighbour {
        property: "every clause of the contract between groups: SS0, SS1F and wide SS1 spread, a wait brakes the listed ones, nothing else crosses",
        domain: NARROW,
        domain_text: "complete: every configuration and input",
        caveat: "one pair of groups; that a group takes the highest of all others is outside",
    }]
    [contract hfs_global_sto_contract on heidenhain::global_sto {
        property: "every clause of the contract of -STO.A.G after an SS0: end of the others, latest time, main switch",
        domain: Domain { delays: &[1, 2, 4], highest_speed: 0 },
        domain_text: "SMP2172 of 1, 2 or 4 cycles; every consistent state; every input",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_judge_contract on heidenhain::judge {
        property: "every clause of the judgement's contract: bad requests, mode changes, motion, permissive, operating unit, self-test",
        domain: NARROW,
        domain_text: "complete: every configuration, state and input",
        caveat: "which axes move and which stand for too long comes from outside",
    }]
    [contract hfs_group_contract on heidenhain::group {
        property: "every clause of the monitoring state's contract: release, tightening, loosening, ends of the stops",
        domain: NARROW,
        domain_text: "complete: every kind, consistent state and input",
        caveat: "that the stop of the group was demanded for what a request breaks is the contract of judge",
    }]
    [contract hfs_startup_contract on heidenhain::startup {
        property: "every clause of the start-up protection's contract: count of the standstill, modes, permissive",
        domain: Domain { delays: &[1, 2, 4], highest_speed: 0 },
        domain_text: "1, 2 or 4 cycles; every state; every input",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_axis_release_contract on heidenhain::axis_release {
        property: "every clause of the axis' contract: braking without feed enable, its time, standstill",
        domain: Domain { delays: &[0, 1, 3], highest_speed: 0 },
        domain_text: "SMP527 0, 1 or 3 cycles; every consistent state; every input",
        caveat: "longer times only under Kani and in samples",
    }]
}
