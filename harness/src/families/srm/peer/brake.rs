//! The brake test: its sequence alone, and the whole block with the bits of `DIAG` and the interval.

use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::srm::brake_test;

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::Same;
use crate::diff::peer::{Made, Params};

/// The sequence and the handshake with the drive.
pub(super) const MACHINES: &[(&str, &str)] = &[("brake", "brake_test")];

/// The whole block.
pub(super) const SYSTEM: (&str, &str) = ("brake_block", "brake_test");

/// What the table calls the numbers of the monitor.
const NAMED: &[(&str, &str)] = &[
    ("seq_1", "sequence_br_1"),
    ("seq_2", "sequence_br_2"),
    ("t_open_1", "t_open_br_1"),
    ("t_close_1", "t_close_br_1"),
    ("t_open_2", "t_open_br_2"),
    ("t_close_2", "t_close_br_2"),
    ("t_selected", "t_mon_sel"),
    ("t_request", "t_mon_req"),
    ("pos", "safe_pos"),
    ("v", "safe_v"),
    ("drive", "fdback_drive"),
    ("closed_1", "fdback_br_1"),
    ("closed_2", "fdback_br_2"),
    ("second", "active_br"),
    ("close", "close_br"),
    ("open_1", "open_br_1"),
    ("open_2", "open_br_2"),
    ("stw_select", "select"),
    ("stw_start", "stw.start"),
    ("stw_brake", "br_select"),
    ("stw_negative", "torque_dir"),
    ("stw_sequence", "stw.sequence"),
    ("stw_closed", "fdback_br"),
    ("brake", "state.second"),
    ("t", "timer"),
    ("from", "state.start"),
    ("seen", "ran"),
    ("br_1_ok", "first_ok"),
    ("sls", "fast"),
    ("calc", "overflowed"),
    ("req", "due"),
    ("was_execute", "execute_held"),
    ("was_ack", "ack_held"),
];

/// What both tables show alike. Times are those of calls: T_SAMPLE is 1.
fn same<'a>(p: &'a Params<'a>, mutant: Option<Mutant>) -> Same<'a, brake_test::Monitor> {
    Same::<brake_test::Monitor>::new(p, mutant)
        .named(NAMED)
        .cell("faults", upto(i32::from(brake_test::TEST_BITS)))
        .bits(
            |o| o.diag,
            &[
                ("diag_2", 2),
                ("diag_11", 11),
                ("diag_14", 14),
                ("diag_15", 15),
            ],
        )
}

pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "brake" => same(p, mutant)
            .constants(&[
                ("t_interval", 1),
                ("t_sample", 1),
                ("unproven", 0),
                ("sbt_fresh", 0),
                ("err_react", 0),
            ])
            .decided("bad", |config| config.parameter_bits() != 0)
            .without(&["overflow"])
            .hidden(&["diag", "test_req", "faults", "due", "left", "tried"])
            .cell("left", upto(1))
            .peer()?,
        // A motor holding brake of an axis that stands.
        "brake_block" => same(p, mutant)
            .constants(&[
                ("t_sample", 1),
                ("unproven", 0),
                ("sbt_fresh", 0),
                ("err_react", 0),
                ("safe_pos", 0),
                ("safe_v", 1),
                ("fdback_drive", 1),
                ("fdback_br_1", 0),
                ("fdback_br_2", 0),
                ("active_br", 0),
                ("close_br", 0),
            ])
            .decided("wrong", |config| config.parameter_bits() != 0)
            .without(&["overflow"])
            .hidden(&["diag", "test_req", "faults", "tried"])
            .bits(
                |o| o.diag,
                &[
                    ("time_1", 0),
                    ("time_2", 1),
                    ("moved", 3),
                    ("implausible", 6),
                    ("no_enable", 7),
                    ("no_position", 8),
                    ("not_selected", 9),
                    ("no_request", 10),
                ],
            )
            .peer()?,
        _ => return Ok(None),
    }))
}
