//! What concerns the whole machine: modes, permissives, control voltage, outputs.

use stillpoint_monitors::heidenhain::{button, output_enable, som, switch_on};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "som" => som(p, mutant)?,
        "button" => button(p, mutant)?,
        "switch_on" => switch_on(p, mutant)?,
        "output_enable" => output_enable(p, mutant)?,
        _ => return Ok(None),
    }))
}

fn som(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = som::Config::new(p.is("som_4"))?;
    let next = chosen::<som::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "key_2", "key_3", "key_4", "deselected"],
        &["som", "pp_som", "changed"],
        vec![upto(3), upto(3), truth()],
        som::State::INITIAL,
        move |state, i, o| {
            let inputs = som::Inputs {
                power_on: i[0] != 0,
                key_2: i[1] != 0,
                key_3: i[2] != 0,
                key_4: i[3] != 0,
                deselected: i[4] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([som_rank(after.som), som_rank(out.som), bit(out.changed)]);
            after
        },
    ))
}

fn button(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = button::Config::new(p.time("t_max"))?;
    let next = chosen::<button::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "contact_a", "contact_b", "unit_changes"],
        &["button", "valid", "jammed"],
        vec![upto(2), upto(p.value("t_max"))],
        button::State::INITIAL,
        move |state, i, o| {
            let inputs = button::Inputs {
                power_on: i[0] != 0,
                contact_a: i[1] != 0,
                contact_b: i[2] != 0,
                unit_changes: i[3] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(&button::Button::ALL, out.button),
                bit(out.valid),
                bit(out.jammed),
            ]);
            after
        },
    ))
}

fn switch_on(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = switch_on::Config::new(p.time("t_chain"))?;
    let next = chosen::<switch_on::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "cvo",
            "chain",
            "t_brk",
            "dropped",
            "may_on",
            "testing",
            "spindle_rests",
        ],
        &["voltage", "sto_a_g", "stos_a_g", "fault", "demand"],
        vec![upto(2), upto(p.value("t_chain")), truth()],
        switch_on::State::INITIAL,
        move |state, i, o| {
            let inputs = switch_on::Inputs {
                cvo: i[0] != 0,
                chain: i[1] != 0,
                t_brk: i[2] != 0,
                dropped: i[3] != 0,
                may_on: i[4] != 0,
                testing: i[5] != 0,
                spindle_rests: i[6] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(&switch_on::Voltage::ALL, out.voltage),
                bit(out.sto_a_g),
                bit(out.stos_a_g),
                bit(out.fault),
                stop_rank(out.demand),
            ]);
            after
        },
    ))
}

fn output_enable(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = output_enable::Config::new(p.time("t_off"))?;
    let next = chosen::<output_enable::Monitor>(mutant);
    Ok(Adapter::new(
        &["ready", "stop", "emergency", "still"],
        &["enabled"],
        vec![truth(), upto(p.value("t_off"))],
        output_enable::State::INITIAL,
        move |state, i, o| {
            let inputs = output_enable::Inputs {
                ready: i[0] != 0,
                stop: stop(i[1]),
                emergency: i[2] != 0,
                still: i[3] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.push(bit(out.enabled));
            after
        },
    ))
}
