//! SBH/SG selection, referencing, user agreement and gear stage.

use stillpoint_monitors::kernel::{ConfigError, Position};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{agreement, gear, reference, selection};

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "selection" => selection(p, mutant)?,
        "reference" => reference(p, mutant)?,
        "agreement" => agreement(p, mutant)?,
        "gear" => gear(p, mutant)?,
        _ => return Ok(None),
    }))
}

pub(super) fn selection_config(p: &Params) -> Result<selection::Config, ConfigError> {
    let limits = ["limit_1", "limit_2", "limit_3", "limit_4"].map(|name| p.speed(name));
    let plain = selection::Config::new(p.is("enable"), p.time("t_vel"), limits)?;
    match p.is("override") {
        true => plain.with_override(std::array::from_fn(|k| small(p.value(&format!("f_{k}"))))),
        false => Ok(plain),
    }
}

fn selection(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = selection_config(p)?;
    let next = chosen::<selection::Monitor>(mutant);
    let over = upto(p.value("over_max"));
    let (time, position) = (upto(p.value("t_vel")), upto(p.value("pos_max")));
    Ok(Adapter::new(
        &[
            "power_on",
            "sge_sbh_sg",
            "sge_sbh",
            "sg_select",
            "over",
            "sbh_internal",
            "position",
            "ended_at",
            "set_anew",
        ],
        &[
            "mode",
            "sga_active",
            "sga_sbh_active",
            "sga_sg",
            "monitored",
            "speed_limit",
            "reference",
        ],
        vec![upto(5), upto(3), over, upto(3), over, time, position],
        selection::State::INITIAL,
        move |state, i, o| {
            let inputs = selection::Inputs {
                power_on: i[0] != 0,
                sge_sbh_sg: i[1] != 0,
                sge_sbh: i[2] != 0,
                sg_select: stage(i[3]),
                over: factor(i[4]),
                sbh_internal: i[5] != 0,
                position: Position(i[6]),
                ended_at: Position(i[7]),
                set_anew: i[8] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                i64::from(ordinal(&MODES, out.mode)),
                bit(out.sga_active),
                bit(out.sga_sbh_active),
                i64::from(out.sga_sg.index()),
                watched(out.monitored),
                i64::from(out.limit.0),
                i64::from(out.reference.0),
            ]);
            after
        },
    ))
}

fn reference(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = reference::Config::new(p.is("se_sn_enabled"))?;
    let next = chosen::<reference::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "run_up",
            "referenced",
            "reference_lost",
            "parking",
            "agreed_1",
            "agreed_2",
        ],
        &[
            "axis",
            "nst_reference_reached",
            "safely_referenced",
            "compare_due",
            "confirmed",
            "message",
        ],
        vec![upto(3), truth()],
        reference::State::INITIAL,
        move |state, i, o| {
            let inputs = reference::Inputs {
                power_on: i[0] != 0,
                run_up: i[1] != 0,
                referenced: i[2] != 0,
                reference_lost: i[3] != 0,
                parking: i[4] != 0,
                agreed_1: i[5] != 0,
                agreed_2: i[6] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                i64::from(ordinal(&AXES, out.axis)),
                bit(out.nst_reference_reached),
                bit(out.safely_referenced),
                bit(out.compare_due),
                bit(out.confirmed),
                bit(out.message),
            ]);
            after
        },
    ))
}

fn agreement(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = agreement::Config::new(p.time("t_differ"), p.is("se_sn_enabled"))?;
    let next = chosen::<agreement::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "set",
            "cancel",
            "key",
            "axis_ref",
            "compare_due",
            "history_ok",
            "stored",
            "gear_changed",
            "altered",
            "other_agreed",
        ],
        &["agreed", "code", "withdrawn", "se_active"],
        vec![truth(), upto(p.value("t_differ"))],
        agreement::State::restored(false),
        move |state, i, o| {
            let inputs = agreement::Inputs {
                power_on: i[0] != 0,
                set: i[1] != 0,
                cancel: i[2] != 0,
                key: i[3] != 0,
                axis_ref: i[4] != 0,
                compare_due: i[5] != 0,
                history_ok: i[6] != 0,
                stored: i[7] != 0,
                gear_changed: i[8] != 0,
                altered: i[9] != 0,
                other_agreed: i[10] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.agreed),
                i64::from(out.code.number()),
                bit(out.withdrawn),
                bit(out.se_active),
            ]);
            after
        },
    )
    .without(&["axis_safe"])
    .kept(0, "agreed"))
}

fn gear(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = gear::Config::new(small(p.value("gear_max")), p.is("se_sn_enabled"))?;
    let next = chosen::<gear::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "index"],
        &["stage", "changed"],
        vec![upto(p.value("gear_max")), truth()],
        gear::State::INITIAL,
        move |state, i, o| {
            let inputs = gear::Inputs {
                power_on: i[0] != 0,
                index: gear::GearIndex::new(small(i[1])).unwrap_or_default(),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([i64::from(out.stage.get()), bit(out.changed)]);
            after
        },
    ))
}
