//! The check of the safe PLC program.

use stillpoint_monitors::heidenhain::mutant::Mutant;
use stillpoint_monitors::heidenhain::program_check;

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "program_check" => program_check(p, mutant)?,
        _ => return Ok(None),
    }))
}

cells! {
    program_check::State, 1 {
        good = truthy, i32::from;
    }
}

fn program_check(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = program_check::Config::new(p.is("commissioning"))?;
    let next = mutant.map_or(
        program_check::next as program_check::Next,
        Mutant::program_check,
    );
    Ok(Adapter::new(
        &["translated", "crc_equal", "version_equal"],
        &["message_crc", "message_version", "good"],
        vec![truth()],
        program_check::State::INITIAL,
        move |state, i, o| {
            let inputs = program_check::Inputs {
                translated: i[0] != 0,
                crc_equal: i[1] != 0,
                version_equal: i[2] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.message_crc),
                bit(out.message_version),
                bit(out.good),
            ]);
            after
        },
    ))
}
