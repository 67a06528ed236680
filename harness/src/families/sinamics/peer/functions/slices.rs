//! What is explored with other parameters than those of the tables' own systems.

use crate::diff::slices::Slice;

/// The whole of a machine or system under some parameters.
const fn whole(
    system: &'static str,
    params: &'static [(&'static str, i64)],
    free: &'static [&'static str],
) -> Slice {
    Slice {
        system,
        params,
        free,
    }
}

/// The inputs of SS1.
const SS1: &[&str] = &["selected", "stop_b", "sto", "off", "n"];

/// The inputs of a drive without encoder.
const BLIND: &[&str] = &["sto", "sls", "sdi", "pulses", "slow", "on", "current"];

/// The slices.
pub(super) const SLICES: &[Slice] = &[
    whole("ss1_basic", &[("external", 0)], &["selected", "sto"]),
    whole("ss1_basic", &[("external", 1)], &["selected", "sto"]),
    whole("ss1", &[("external", 0), ("kind", 0)], SS1),
    whole("ss1", &[("external", 0), ("kind", 1)], SS1),
    whole("ss1", &[("external", 1), ("kind", 2)], SS1),
    whole("ssm", &[("smooth", 1)], &["n", "y"]),
    whole("ssm", &[("smooth", 0)], &["n", "y"]),
    whole("sdi", &[("p_top", 7), ("number", 0)], &["selected", "pos"]),
    whole("sdi", &[("p_top", 3), ("number", 1)], &["selected", "pos"]),
    whole(
        "actual_value",
        &[("cyclic", 0)],
        &["pos_1", "pos_2", "wide", "sync_once"],
    ),
    whole(
        "actual_value",
        &[("cyclic", 1)],
        &["pos_1", "pos_2", "wide", "sync_once"],
    ),
    // SSM beside SDI that ends with the pulses, and without either.
    whole("blind", &[("ssm", 1), ("sdi_ends", 1)], BLIND),
    whole("blind", &[("ssm_ends", 1), ("sdi_ends", 0)], BLIND),
    // Without selection, SSM beside it.
    whole("blind", &[("static", 1), ("ssm", 1)], BLIND),
    // Evaluated from the first pulse on, and later.
    whole("start_phase", &[("t_start", 0)], &["pulses", "correct"]),
    whole("start_phase", &[("t_start", 3)], &["pulses", "correct"]),
    // A ramp that is no whole number in a cycle, down to 0.
    whole("sbr", &[("t_ref", 6), ("n_res", 0)], &["brakes", "n"]),
    // Positions within and beyond the 16 bits.
    whole(
        "sp",
        &[("low", -40_000), ("top", 40_000), ("scale", 1)],
        &["pos_1", "pos_2", "found", "safe"],
    ),
    // Beyond them where they are not sent.
    whole(
        "sp",
        &[
            ("low", -40_000),
            ("top", 40_000),
            ("scale", 1),
            ("short", 0),
        ],
        &["pos_1", "pos_2", "found", "safe"],
    ),
    // All of the composed one at once.
    whole("ramped_channel", &[], &["selected", "second", "n"]),
];
