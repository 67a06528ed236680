//! The safe position: its position alone with two and three encoders, and the whole block with velocity and drift.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::srm::common::ErrReact;
use stillpoint_monitors::srm::safe_pos;

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::Same;
use crate::diff::peer::{Made, Params};
use crate::diff::product::Values;

/// The position, its validity and its reference.
pub(super) const MACHINES: &[(&str, &str)] = &[("position", "safe_pos")];

/// The whole block.
pub(super) const SYSTEM: (&str, &str) = ("safe_pos_block", "safe_pos");

/// What both tables show alike, by the names of the table and of the monitor.
macro_rules! named {
    ($(($table:literal, $monitor:literal)),* $(,)?) => {
        &[
            ("pos_1", "pos1"), ("pos_s", "possi"), ("valid_1", "pos1_valid"), ("valid_s", "possi_valid"), ("state", "phase"),
            ("off_1", "off1"), ("off_s", "off_si"), ("off_2", "off2"), ("disagree", "apart"), ("apart", "unconfirmed"),
            ("apart_2", "unconfirmed2"), ("was_reference", "reference_held"), ("was_sync", "sync_held"), ("was_ack", "ack_held"),
            $(($table, $monitor)),*
        ]
    };
}

/// Without faults of the velocity: its counter stands and its drift has no limit.
fn position_config(p: &Params) -> safe_pos::Config {
    safe_pos::Config {
        t_sample: p.value("t_sample"),
        pos_config: p.is("three"),
        // At most that, so that its counter need not move in a call.
        possi_t_sample: p.value("t_sample").min(1_023),
        pos_min: p.value("pos_min"),
        pos_max: p.value("pos_max"),
        pos_disc_window: p.value("window"),
        pos2_disc_window: p.value("window_2"),
        possi_disc_window: p.value("window_s"),
        pos_startup_tol: p.value("startup_tol"),
        v_standstill: 0,
        v_max: p.value("v_max"),
        v_disc_window: i32::MAX,
        v_sync_intervall: p.value("t_sample"),
        pos_reference: p.value("pos_reference"),
        count_margin: Cycles::ZERO,
        sync_pos2: safe_pos::SyncPos2::Keep,
        count_watch: safe_pos::CountWatch::Hold,
        err_react: ErrReact::Safe,
    }
}

/// With velocity and drift; none where the table has fewer calls for a standing counter than the block.
fn block_config(p: &Params) -> Option<safe_pos::Config> {
    let calls = p.value("t_si").checked_add(p.value("t_sample") - 1)? / p.value("t_sample").max(1);
    let margin = u32::try_from(p.value("patience") - calls).ok()?;
    Some(safe_pos::Config {
        possi_t_sample: p.value("t_si"),
        v_standstill: p.value("v_standstill"),
        v_disc_window: p.value("v_disc"),
        v_sync_intervall: p.value("interval").checked_mul(p.value("t_sample"))?,
        count_margin: Cycles::new(margin),
        count_watch: safe_pos::CountWatch::Watch,
        ..position_config(p)
    })
}

/// The values of a corrected position.
fn width(p: &Params) -> Domain {
    let top = p.value("p_top");
    Domain {
        lo: -top,
        hi: top.saturating_add(p.value("pos_reference")),
    }
}

/// What both tables have of the state of the monitor.
fn same<'a>(
    p: &'a Params<'a>,
    mutant: Option<Mutant>,
    config: safe_pos::Config,
) -> Same<'a, safe_pos::Monitor> {
    let mm = p.value("p_top");
    let um = mm.saturating_mul(1_000);
    Same::<safe_pos::Monitor>::new(p, mutant)
        .config(config)
        .explored(&["pos_s"], Values::List(&[0, 1_000]))
        .cell("saved", width(p))
        .cell("safe_pos", width(p))
        .cell("last1", upto(mm))
        .cell("sample", upto(um))
        .cell("window1", upto(mm))
        .cell("window_si", upto(um))
}

pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "position" => same(p, mutant, position_config(p))
            .constants(&[("possi_count", 0)])
            .decided("bad", |config| config.parameter_bits() != 0)
            .named(named![
                ("pos_2", "pos2"),
                ("valid_2", "pos2_valid"),
                ("ref", "referenced"),
                ("v_possible", "v_valid"),
                ("drifted", "strayed"),
                ("calc", "overflowed"),
            ])
            .without(&["overflow"])
            .hidden(&[
                "diag",
                "outputs.safe_pos",
                "state.safe_pos",
                "safe_v",
                "standstill",
                "moves_positive",
                "moves_negative",
                "saved",
                "si_failed",
                "fast",
                "state.drifted",
                "direction",
                "seen1",
                "last1",
                "seen_si",
                "sample",
                "count",
                "still",
                "window1",
                "window_si",
                "window_calls",
            ])
            .cell("safe_v", upto(0))
            .cell("count", upto(0))
            .cell("still", upto(2))
            .cell("window_calls", upto(0))
            .bits(
                |o| o.diag,
                &[
                    ("diag_3", 3),
                    ("diag_4", 4),
                    ("diag_7", 7),
                    ("diag_8", 8),
                    ("diag_9", 9),
                    ("diag_10", 10),
                    ("diag_11", 11),
                    ("diag_12", 12),
                    ("diag_13", 13),
                ],
            )
            .peer()?,
        // Wrong parameters, offsets that overflow, SYNC and a second direct encoder are those of the tables above.
        "safe_pos_block" => {
            let config = block_config(p);
            let right = config.is_some_and(|config| config.parameter_bits() == 0);
            same(p, mutant, config.unwrap_or_else(|| position_config(p)))
                .needs(right, "the parameters must be right ones, and a counter may stand as long as it needs")
                .constants(&[("pos2", 0), ("pos2_valid", 0), ("inputs.sync", 0)])
                .named(named![
                    ("count", "possi_count"),
                    ("shown", "safe_pos"),
                    ("valid", "pos_valid"),
                    ("refers", "referenced"),
                    ("v", "safe_v"),
                    ("v_ok", "v_valid"),
                    ("request", "ack_req"),
                    ("fault", "error"),
                    ("sign", "direction"),
                    ("stands", "still"),
                    ("from_1", "window1"),
                    ("from_s", "window_si"),
                    ("k", "window_calls"),
                ])
                .explored(&["count"], Values::List(&[0, 1, 2]))
                .hidden(&[
                    "diag",
                    "saved",
                    "si_failed",
                    "strayed",
                    "state.drifted",
                    "overflowed",
                    "seen1",
                    "last1",
                    "seen_si",
                    "sample",
                    "state.count",
                ])
                .cell(
                    "state.count",
                    Domain {
                        lo: i32::from(i16::MIN),
                        hi: i32::from(i16::MAX),
                    },
                )
                .bits(
                    |o| o.diag,
                    &[
                        ("diag_3", 3),
                        ("diag_4", 4),
                        ("diag_5", 5),
                        ("diag_6", 6),
                        ("diag_7", 7),
                        ("diag_8", 8),
                        ("diag_9", 9),
                        ("diag_10", 10),
                        ("diag_11", 11),
                        ("v_calc", 13),
                    ],
                )
                .peer()?
        }
        _ => return Ok(None),
    }))
}
