//! The monitors of the blocks that their tables describe in the same words.
//!
//! Whether the first call finds the parameters right is an input of these tables (`bad`); the parameters themselves decide it here, and
//! that check is compared apart, in `first_call`. An overflow is an input of the tables too: the numbers are kept where there is none.
//! `DIAG` is compared bit by bit.

use stillpoint_model::Domain;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::srm::common::ErrReact;
use stillpoint_monitors::srm::interpolation::{self, Curve, segments_fit};
use stillpoint_monitors::srm::{endzone, sbr_monitor};

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params};
use crate::diff::product::Values;

/// The points of an envelope.
fn curve(p: &Params) -> Curve {
    let of = |letter: char, k: usize| p.value(&format!("{letter}_{k}"));
    Curve {
        x: std::array::from_fn(|k| of('x', k)),
        v: std::array::from_fn(|k| of('v', k)),
        x_16: of('x', 16),
        v_16: of('v', 16),
    }
}

fn endzone_config(p: &Params) -> endzone::Config {
    endzone::Config {
        vmax_release: p.value("vmax_release"),
        interpolation: curve(p),
        vinv_retract: endzone::VinvRetract::Stop,
        ez_dir: endzone::EzDir::Expire,
        err_react: ErrReact::Safe,
    }
}

/// The table has the time of the ramp in calls.
fn sbr_config(p: &Params) -> sbr_monitor::Config {
    sbr_monitor::Config {
        t_sample: p.value("t_sample"),
        t_ramp: p.value("n").saturating_mul(p.value("t_sample")),
        v_max: p.value("v_max"),
        v_stop_monitoring: p.value("v_stop"),
        maxtol_v: p.value("maxtol_v"),
        maxtol_pos: p.value("maxtol_pos"),
        sbr_pos: sbr_monitor::SbrPos::Cum,
        sbr_retrig: sbr_monitor::SbrRetrig::Ignore,
        err_react: ErrReact::Safe,
    }
}

/// The whole way of a ramp, mm, and whether no product or sum on it leaves a DInt.
fn way(p: &Params) -> Option<i32> {
    p.value("v_max").checked_mul(p.value("t_sample"))?;
    let all = ["n", "v_max", "t_sample"].map(|name| i128::from(p.value(name)));
    let way = i32::try_from(all.iter().product::<i128>() / 60_000).ok()?;
    p.value("n").checked_mul(p.value("t_sample"))?;
    way.checked_add(p.value("maxtol_pos")).map(|_| way)
}

peers! { srm |p|
    "min_max" => min_max
        .named(&[
            ("in_1", "in1"), ("in_2", "in2"), ("in_3", "in3"), ("in_4", "in4"), ("in_5", "in5"), ("in_6", "in6"),
            ("in_7", "in7"), ("in_8", "in8"),
        ]);
    "interpolation" => interpolation
        .config(interpolation::Config { curve: curve(p) })
        .needs(segments_fit(&curve(p)), "a product of a segment must be a DInt");
    "slp" => slp_monitor
        .constants(&[("err_react", 0)])
        .named(&[
            ("pos", "safe_pos"), ("v", "safe_v"), ("way", "phase"), ("below", "low"), ("above", "high"), ("was_ack", "ack_held"),
            ("was_release", "release_held"),
        ])
        .decided("bad", |config| config.wrong_velocity())
        .hidden(&["diag"])
        .bits(|o| o.diag, &[("diag_0", 0), ("diag_1", 1), ("diag_2", 2), ("diag_4", 4), ("diag_5", 5), ("diag_6", 6)]);
    "endzone" => endzone
        .config(endzone_config(p))
        .needs(curve(p).ascends() && segments_fit(&curve(p)), "the points must ascend and a product of a segment be a DInt")
        .named(&[
            ("pos", "safe_pos"), ("v", "safe_v"), ("way", "phase"), ("below", "low"), ("above", "high"), ("fast", "retracts_fast"),
            ("over", "state.fast"), ("calc", "overflowed"), ("course", "direction"), ("last", "place"), ("shown", "threshold"),
            ("was_ack", "ack_held"), ("was_release", "release_held"),
        ])
        .decided("bad", |config| config.parameter_bits() != 0)
        .without(&["overflow"])
        .hidden(&["diag", "place"])
        .bits(|o| o.diag, &[("diag_0", 0), ("diag_1", 1), ("diag_2", 2), ("diag_5", 5), ("diag_6", 6), ("diag_9", 9), ("diag_11", 11)]);
    // The table counts the calls of the ramp, the monitor its velocity and its way.
    "sbr" => sbr_monitor
        .config(sbr_config(p))
        .needs(way(p).is_some(), "the way of the ramp must be a DInt")
        .named(&[
            ("pos", "safe_pos"), ("v", "safe_v"), ("ramp", "phase"), ("v_ramp", "state.ramp"), ("from", "start"),
            ("broken", "violated"), ("calc", "overflowed"), ("was_execute", "execute_held"), ("was_ack", "ack_held"),
        ])
        .cell("state.ramp", upto(p.value("v_max")))
        .cell("way", upto(way(p).unwrap_or(0)))
        .cell("rest", Domain { lo: -59_999, hi: 59_999 })
        .decided("bad", |config| config.parameter_bits() != 0)
        .without(&["overflow"])
        .hidden(&["diag"])
        .bits(|o| o.diag, &[("diag_0", 0), ("diag_11", 11)]);
    "load" => load_monitor
        .constants(&[
            ("err_react", 0), ("cal_value", 0), ("maxtol_cal", 0), ("t_sample", 1), ("t_test", 2), ("t_settle", 1),
            ("calibration_overflow", 0),
        ])
        .named(&[
            ("load_1", "load1"), ("load_2", "load2"), ("mode", "maxload_mode"), ("v", "safe_v"), ("retr", "retracting"),
            ("unlike", "discrepancy"), ("static", "over_static"), ("dynamic", "over_dynamic"), ("lost", "blind"),
            ("outside", "out_of_range"), ("calc", "overflowed"), ("was_release", "release_held"), ("was_ack", "ack_held"),
        ])
        .explored(&["load_1", "load_2"], Values::List(&[-1, 0, 1, 2, 3, 4, 5, 6, 10_000, 10_001]))
        .decided("bad", |config| config.parameter_bits() != 0)
        .without(&["overflow"])
        .hidden(&["diag"])
        .bits(|o| o.diag, &[("diag_0", 0), ("diag_1", 1), ("diag_2", 2), ("diag_7", 7), ("diag_9", 9), ("diag_10", 10), ("diag_11", 11)]);
    // ACK ends an overflow only. The kind of the test is an input of the block that the monitor has as a parameter.
    "calibration" => load_calibration
        .constants(&[("t_sample", 1), ("wrong_elsewhere", 0), ("inputs.ack", 0)])
        .live("cal_mode", "step")
        .needs(p.value("t_test") > p.value("t_settle"), "the test must be longer than its settling")
        .named(&[
            ("load_1", "load1"), ("load_2", "load2"), ("test", "phase"), ("t", "state.calls"), ("first_1", "from1"),
            ("first_2", "from2"), ("long", "unsettled"), ("ok", "passed"), ("was_calibrate", "calibrate_held"),
        ])
        .without(&["bad"])
        .hidden(&["diag", "overflowed", "ack_held", "ack_req"])
        .bits(|o| o.diag, &[("diag_4", 4), ("diag_5", 5)]);
}
