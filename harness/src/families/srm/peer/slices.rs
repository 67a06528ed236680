//! The slices of blocks with many inputs: which of them move together.

use crate::diff::slices::Slice;

/// The value of an input that is held: signals are valid, the drive is enabled, has selected the test and
/// reports that it is well; the ends of a range are where the tables have them.
pub(super) const CALM: &[(&str, i32)] = &[
    ("valid_1", 1),
    ("valid_2", 1),
    ("valid_s", 1),
    ("pos_valid", 1),
    ("v_valid", 1),
    ("drive", 1),
    ("selected", 1),
    ("active", 1),
    ("result", 1),
    ("x_negative", 1),
    ("x_positive", 3),
];

/// Calls as long as the cycles of the drive, in each of which POSSI may go by 1 mm; a DInt has more velocities.
const VELOCITY: &[(&str, i64)] = &[
    ("p_top", 1),
    ("v_max", 30),
    ("v_standstill", 30),
    ("v_top", 60),
    ("t_si", 1_000),
    ("t_sample", 1_000),
    ("patience", 1),
    ("interval", 1),
    ("v_disc", 1),
];

/// The same, without a limit of the velocity, but no drift at all is borne.
const DRIFT: &[(&str, i64)] = &[
    ("p_top", 1),
    ("v_max", 60),
    ("v_standstill", 30),
    ("v_top", 60),
    ("t_si", 1_000),
    ("t_sample", 1_000),
    ("patience", 1),
    ("interval", 2),
    ("v_disc", 0),
];

/// The slices.
pub(super) const SLICES: &[Slice] = &[
    // Two encoders, two positions of each: the third one is not read.
    Slice {
        system: "position",
        params: &[
            ("three", 0),
            ("p_top", 1),
            ("pos_reference", 1),
            ("window_s", 0),
            ("pos_min", 0),
        ],
        free: &[
            "pos_1",
            "pos_s",
            "valid_1",
            "valid_s",
            "reference",
            "sync",
            "ack",
        ],
    },
    // Two encoders that may be apart by 1 mm, the range narrower than the positions, any change a step.
    Slice {
        system: "position",
        params: &[
            ("three", 0),
            ("p_top", 1),
            ("pos_reference", 1),
            ("window_s", 1),
            ("pos_min", 1),
            ("pos_max", 1),
            ("v_max", 0),
        ],
        free: &["pos_1", "pos_s", "valid_1", "valid_s", "reference", "ack"],
    },
    // Three encoders, two positions of each; POSSI does not move.
    Slice {
        system: "position",
        params: &[
            ("three", 1),
            ("p_top", 1),
            ("pos_reference", 1),
            ("window_s", 1),
            ("pos_min", 0),
        ],
        free: &[
            "pos_1",
            "pos_2",
            "valid_1",
            "valid_2",
            "valid_s",
            "reference",
            "sync",
            "ack",
        ],
    },
    // Velocity and its counter, while POS1 stands: 60 mm/min are too fast, 30 are not.
    Slice {
        system: "safe_pos_block",
        params: VELOCITY,
        free: &["pos_s", "valid_s", "count", "reference", "ack"],
    },
    // Drift of POS1 and POSSI in an interval of two calls, and the direction.
    Slice {
        system: "safe_pos_block",
        params: DRIFT,
        free: &["pos_1", "pos_s", "valid_1", "count", "reference", "ack"],
    },
    // End zones whose ends move.
    Slice {
        system: "endzone",
        params: &[("p_top", 2)],
        free: &[
            "pos",
            "pos_valid",
            "v",
            "v_valid",
            "x_negative",
            "x_positive",
            "release",
            "ack",
        ],
    },
    // End zones of a wider range.
    Slice {
        system: "endzone",
        params: &[("p_top", 4)],
        free: &["pos", "pos_valid", "v", "v_valid", "release", "ack"],
    },
    // Brake test: every status word of the drive, an external and a motor holding brake.
    Slice {
        system: "brake",
        params: &[],
        free: &[
            "selected", "second", "active", "result", "finished", "close", "closed_1", "execute",
            "ack",
        ],
    },
    // Brake test: every fault of an axis with an external brake.
    Slice {
        system: "brake",
        params: &[],
        free: &[
            "pos",
            "pos_valid",
            "v",
            "v_valid",
            "drive",
            "close",
            "closed_1",
            "finished",
            "execute",
            "ack",
        ],
    },
    // Brake test: every fault of an axis with a motor holding brake, whose drive says anything.
    Slice {
        system: "brake",
        params: &[("seq_1", 17), ("seq_2", 0)],
        free: &[
            "pos",
            "pos_valid",
            "v",
            "v_valid",
            "drive",
            "active",
            "finished",
            "execute",
            "ack",
        ],
    },
    // Brake test: several sequences of two motor holding brakes.
    Slice {
        system: "brake",
        params: &[("seq_1", 27), ("seq_2", 22)],
        free: &["second", "active", "finished", "result", "execute", "ack"],
    },
    // Brake test: an external second brake.
    Slice {
        system: "brake",
        params: &[
            ("seq_1", 16),
            ("seq_2", 8),
            ("t_open_2", 2),
            ("t_close_2", 3),
        ],
        free: &[
            "second", "active", "finished", "close", "closed_2", "drive", "execute", "ack",
        ],
    },
    // Brake test: the whole block.
    Slice {
        system: "brake_block",
        params: &[],
        free: &[
            "pos_valid",
            "v_valid",
            "selected",
            "active",
            "result",
            "finished",
            "execute",
            "ack",
        ],
    },
];
