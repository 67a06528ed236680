//! The slices of the safe PLC program: which inputs move together.

use crate::diff::slices::Slice;

/// The slices.
pub(super) const SLICES: &[Slice] = &[
    // A safe PLC program: what its three groups are asked for depends on no state of another group.
    Slice {
        system: "splc",
        params: &[],
        free: &[
            "door_open",
            "t_open",
            "som",
            "som_changed",
            "pb_panel",
            "pb_wheel",
            "axis_key",
            "nc_start",
            "stop_key",
            "unit",
            "state_a",
            "gen_safe",
        ],
    },
    Slice {
        system: "splc",
        params: &[],
        free: &[
            "door_open",
            "t_open",
            "som",
            "som_changed",
            "pb_panel",
            "pb_wheel",
            "nc_start",
            "jog",
            "spindle_start",
            "stop_key",
            "unit",
            "restricted",
            "holder_open",
            "gen_safe",
        ],
    },
    Slice {
        system: "splc",
        params: &[],
        free: &[
            "door_open",
            "t_open",
            "som_changed",
            "pb_magazine",
            "magazine_key",
            "confirm",
            "axis_key",
            "moving_t",
            "gen_safe",
        ],
    },
];
