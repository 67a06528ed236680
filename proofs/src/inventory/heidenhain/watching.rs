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
        tries: "path still: 0..2 max; begin: -2..2 ends; position: -4..4 ends; inputs.speed: 0..3 max",
        caveat: "none",
    }]
    [contract hfs_stop_path_contract on heidenhain::stop_path {
        property: "every clause of the stop path's contract: SS1 beyond it with a limited speed only, counted from the beginning",
        tries: "path: 0..2 max; begin: -2..2 ends; position: -4..4 ends",
        caveat: "none",
    }]
    [contract [parts(3: first = 1, second = 2, third = 3)] hfs_position_limit_contract on heidenhain::position_limit {
        property: "every clause of the limited position's contract: SS1 beyond it, way back, lock until the limits are changed",
        tries: "minus plus: -1..1 ends; last position: -3..3 ends",
        caveat: "whether the position is right is the referencing's business",
    }]
    [contract hfs_revolutions_contract on heidenhain::revolutions {
        property: "every clause of the two revolutions' contract: signed angle from the activation, SS1 beyond it",
        tries: "turns: 1..3 1073741823; angle: -3..3 -1073741824 1073741823 1073741824; step: -5..5 ends",
        caveat: "reading AMB-32 AT_START",
    }]
    [contract [kani(solver(kissat))] hfs_comparison_contract on heidenhain::comparison {
        property: "every clause of the comparison's contract: what is compared when, tolerance, window",
        domain: Domain { delays: &[1, 3], highest_speed: 0 },
        domain_text: "windows of 1 and 3 cycles, 0, 99 and 100 percent, deviations and speeds near 0 and the ends of 32 bits; every state",
        caveat: "reading AMB-17/18 TABLE; the intended following error is taken off outside; Kani takes speeds of 12 bits",
    }]
    [contract [parts(3: first = 1, second = 2, third = 3)] hfs_deceleration_contract on heidenhain::deceleration {
        property: "every clause of the dv/dt monitoring's contract: waiting time, axes, spindles, coasting",
        tries: "wait: 0 1 3; timer: 0..3; last: 0..2 max; speed: 0..3 max",
        caveat: "the waiting time of spindles is not published",
    }]
    [contract hfs_axis_count_contract on heidenhain::axis_count {
        property: "every clause of the axis count's contract: SOM_2, handwheel, homing",
        tries: "moving ungrouped: 0..3 max",
        caveat: "which axes count is decided outside",
    }]
}
