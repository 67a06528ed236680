//! Position and speed.

use crate::enumeration::Domain;
use crate::inventory::NARROW;

inventory! {
    [contract [kani(solver(kissat))] hfs_speed_contract on heidenhain::speed {
        property: "every clause of the limited speed's contract: 5 % margin, restricted operation, limits that are not set",
        domain: NARROW,
        domain_text: "limits 0, 1 and the highest; speeds 0 to 3, the highest, and those around each limit and its margin; every state",
        caveat: "which state is in force is the group's business; Kani takes limits of 10 and speeds of 11 bits, hfs_speed_margin all",
    }]
    [run(4) [kani(solver(kissat))] hfs_speed_margin on heidenhain::"speed" by watching::margin_is_exact {
        property: "the limited speed's margin of 5 % is exact, whatever the limit",
        requirements: ["HFS-SLS-003"],
        covers: ["above the limit and within the margin", "beyond the margin"],
        domain: NARROW,
        domain_text: "limits 0 to 45 and the highest, speeds 0 to 50 and the highest",
        bound: "none",
        caveat: "none",
    }]
    [contract hfs_operating_stop_contract on heidenhain::operating_stop {
        property: "every clause of the operating stop's contract: SS1 for motion, SS0 for creeping, path alone in the self-test",
        domain: NARROW,
        domain_text: "paths and standstill speeds 0 to 2, positions -4 to 4, speeds 0 to 3, and the ends of 32 bits; every state",
        caveat: "none",
    }]
    [contract hfs_stop_path_contract on heidenhain::stop_path {
        property: "every clause of the stop path's contract: SS1 beyond it with a limited speed only, counted from the beginning",
        domain: NARROW,
        domain_text: "paths 0 to 2, positions -4 to 4, and the ends of 32 bits; every state",
        caveat: "none",
    }]
    [contract hfs_position_limit_contract on heidenhain::position_limit {
        property: "every clause of the limited position's contract: SS1 beyond it, way back, lock until the limits are changed",
        domain: NARROW,
        domain_text: "limits -1 to 1, positions -3 to 3, and the ends of 32 bits; every lock",
        caveat: "whether the position is right is the referencing's business",
    }]
    [contract hfs_revolutions_contract on heidenhain::revolutions {
        property: "every clause of the two revolutions' contract: signed angle from the activation, SS1 beyond it",
        domain: NARROW,
        domain_text: "permitted angles 1 to 3 and the largest, angles -2 to 2 and the largest, steps -5 to 5 and the ends of 32 bits",
        caveat: "reading AMB-32 AT_START",
    }]
    [contract [kani(solver(kissat))] hfs_comparison_contract on heidenhain::comparison {
        property: "every clause of the comparison's contract: what is compared when, tolerance, window",
        domain: Domain { delays: &[1, 3], highest_speed: 0 },
        domain_text: "windows of 1 and 3 cycles, 0, 99 and 100 percent, deviations and speeds near 0 and the ends of 32 bits; every state",
        caveat: "reading AMB-17/18 TABLE; the intended following error is taken off outside; Kani takes speeds of 12 bits",
    }]
    [contract hfs_deceleration_contract on heidenhain::deceleration {
        property: "every clause of the dv/dt monitoring's contract: waiting time, axes, spindles, coasting",
        domain: Domain { delays: &[0, 1, 3], highest_speed: 0 },
        domain_text: "waiting times 0, 1 and 3 cycles; speeds 0 to 3 and the highest; every consistent state and input",
        caveat: "the waiting time of spindles is not published",
    }]
    [contract hfs_axis_count_contract on heidenhain::axis_count {
        property: "every clause of the axis count's contract: SOM_2, handwheel, homing",
        domain: NARROW,
        domain_text: "every state and mode; 0 to 3 axes and 255",
        caveat: "which axes count is decided outside",
    }]
}
