//! The slices of the systems of a channel and of both: which inputs move together.

use crate::diff::slices::Slice;

/// The value of an input that is held: nothing is asked for, a speed stage is selected, the axis is referenced and the key
/// switch on. All others are 0.
pub(super) const CALM: &[(&str, i32)] = &[
    ("terminals.a", 1),
    ("terminals.c", 1),
    ("terminals.d", 1),
    ("terminals.e", 1),
    ("selection.sge_sbh", 1),
    ("seen[1].a", 1),
    ("seen[2].a", 1),
    ("seen[1].c", 1),
    ("seen[2].c", 1),
    ("seen[1].sbh", 1),
    ("seen[2].sbh", 1),
    ("key", 1),
    ("user[1].home", 1),
    ("user[2].home", 1),
];

/// The slices.
pub(super) const SLICES: &[Slice] = &[
    // Both channels: external stops, STOP F by their difference, RESET.
    Slice {
        system: "pair_stops",
        params: &[],
        free: &[
            "power_on",
            "reset",
            "seen[1].a",
            "seen[1].c",
            "seen[2].a",
            "seen[2].c",
        ],
    },
    // Both channels: stops of the monitors beside an external one.
    Slice {
        system: "pair_stops",
        params: &[("moves", 1), ("reaction_1", 3)],
        free: &[
            "power_on",
            "reset",
            "seen[1].a",
            "seen[2].c",
            "seen[1].away",
            "seen[2].away",
        ],
    },
    // Both channels: external stops and the tolerance time of their change.
    Slice {
        system: "pair_stops",
        params: &[("t_chg", 1)],
        free: &["power_on", "reset", "seen[1].a", "seen[2].c"],
    },
    // Both channels: selection of SBH and SG, and the tolerance time of its change.
    Slice {
        system: "pair_stops",
        params: &[("t_chg", 1), ("selects", 1), ("stops", 0), ("t_vel", 2)],
        free: &[
            "power_on",
            "reset",
            "seen[1].sbh_sg",
            "seen[2].sbh_sg",
            "seen[1].sbh",
        ],
    },
    // Both channels: SBH, and an axis that moves under it, at times not slower than n_x in one of them.
    Slice {
        system: "pair_stops",
        params: &[
            ("selects", 1),
            ("stops", 0),
            ("moves", 1),
            ("pos_tol", 1),
            ("step", 4),
            ("velo_x", 2),
        ],
        free: &[
            "power_on",
            "reset",
            "seen[1].sbh_sg",
            "seen[2].sbh",
            "seen[1].away",
            "seen[2].away",
        ],
    },
    // Both channels: test stops and the interval of forced checking.
    Slice {
        system: "pair_stops",
        params: &[("tested", 1), ("t_chk", 2), ("interval", 4)],
        free: &[
            "power_on",
            "seen[1].test",
            "seen[2].test",
            "seen[1].feedback",
            "seen[2].feedback",
            "seen[2].c",
        ],
    },
    // Both channels: test of the external shutdown with stops.
    Slice {
        system: "pair_stops",
        params: &[("tested", 1), ("switched", 1), ("t_chk", 2)],
        free: &[
            "power_on",
            "reset",
            "shutdown",
            "seen[1].feedback",
            "seen[2].a",
            "seen[1].c",
        ],
    },
    // Both channels: start and errors of the safe logic.
    Slice {
        system: "pair_stops",
        params: &[("starts", 1)],
        free: &["power_on", "reset", "spl_started", "spl_error", "seen[1].c"],
    },
    // Both channels: user agreement, referencing, RESET.
    Slice {
        system: "pair_reference",
        params: &[("t_differ", 2)],
        free: &[
            "power_on",
            "reset",
            "key",
            "user[1].set",
            "user[2].set",
            "user[1].cancel",
            "user[1].home",
            "user[2].home",
        ],
    },
    // Both channels: a stored position that is not the one of the reference.
    Slice {
        system: "pair_reference",
        params: &[("shifts", 1)],
        free: &[
            "power_on",
            "reset",
            "key",
            "user[1].set",
            "user[1].home",
            "user[2].home",
            "user[1].slid",
            "user[2].slid",
        ],
    },
    // Both channels: lost reference and parking.
    Slice {
        system: "pair_reference",
        params: &[("leaves", 1), ("shifts", 1)],
        free: &[
            "user[1].lost",
            "user[2].park",
            "user[1].home",
            "user[2].home",
            "user[1].slid",
        ],
    },
    // Both channels: gear stages and the agreement they withdraw. Left out is an axis that moves meanwhile: the next part.
    Slice {
        system: "pair_reference",
        params: &[("gears", 1), ("t_chg", 1)],
        free: &["user[1].gear", "user[2].gear", "user[1].set", "user[2].set"],
    },
    // Both channels: gear stages while one channel sees the axis move: no tolerance time for their change. Left out is the
    // agreement, which has come before the first cycle or never comes.
    Slice {
        system: "pair_reference",
        params: &[
            ("gears", 1),
            ("t_chg", 1),
            ("moves", 1),
            ("step", 2),
            ("pos_tol", 1),
        ],
        free: &["user[1].gear", "user[2].gear", "seen[1].away"],
    },
    // Both channels: limit positions with and without the agreement of both. Left out are power-on, the key and an axis that
    // is not referenced: their part is that of the agreement.
    Slice {
        system: "pair_reference",
        params: &[("moves", 1), ("se_mode", 2)],
        free: &[
            "reset",
            "user[1].set",
            "user[2].set",
            "seen[1].away",
            "seen[2].away",
        ],
    },
    // Selection, monitors and stops.
    Slice {
        system: "axis_core",
        params: &[("tested", 0), ("peer", 0), ("se", 1)],
        free: &[
            "power_on",
            "reset",
            "terminals.a",
            "terminals.c",
            "selection.sge_sbh_sg",
            "selection.sge_sbh",
            "sg_select",
            "se_active",
            "se_select",
            "position",
            "discrepancy",
        ],
    },
    // Test stop and pulse cancellation.
    Slice {
        system: "axis_core",
        params: &[("tested", 1), ("peer", 0), ("internal", 1)],
        free: &[
            "power_on",
            "reset",
            "terminals.a",
            "terminals.c",
            "selection.sge_sbh_sg",
            "position",
            "test_select",
            "feedback",
            "discrepancy",
        ],
    },
    // What the other channel passes on.
    Slice {
        system: "axis_core",
        params: &[("tested", 0), ("peer", 1)],
        free: &[
            "power_on",
            "reset",
            "terminals.a",
            "selection.sge_sbh_sg",
            "position",
            "discrepancy",
            "rx_fault",
            "rx_internal",
            "rx_external",
        ],
    },
];
