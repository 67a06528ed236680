//! Parts of a composed system, or of a machine with many inputs, that can be explored: some inputs move freely, the others are held.
//!
//! All inputs at once are too many. What each slice leaves out another one has, and random runs move everything. Which slices a
//! family has stands with its [`Peers`](super::peer::Peers).

use std::collections::BTreeMap;

use stillpoint_lang::bind::Bound;

use super::pairing::parameters_of;
use super::product::is;
use super::{DiffError, Pairing};
use crate::families;

/// Inputs of a system that move together, and the parameters that make them act.
pub struct Slice {
    /// The system or machine.
    pub(crate) system: &'static str,
    /// The parameters.
    pub(crate) params: &'static [(&'static str, i64)],
    /// The inputs. All others are held.
    pub(crate) free: &'static [&'static str],
}

/// The slices of a pairing: those of a composed one, or of a machine with too many inputs; any other machine is one slice with
/// all its inputs.
///
/// # Errors
/// Parameters that do not fit each other.
pub fn slices(pairing: &Pairing) -> Result<Vec<Pairing>, DiffError> {
    let mut cuts = Vec::new();
    if let Some(family) = families::of_table(&pairing.bound.system.name) {
        let slices = family.peers.slices.iter().copied().flatten();
        for slice in slices.filter(|s| s.system == pairing.machine) {
            cuts.push(cut(pairing, slice, family.peers.calm)?);
        }
    }
    Ok(match cuts.is_empty() && !pairing.composed {
        true => vec![pairing.clone()],
        false => cuts,
    })
}

/// A slice of a pairing; an input that is held has its value of `calm`, else its least one.
fn cut(pairing: &Pairing, slice: &Slice, calm: &[(&str, i32)]) -> Result<Pairing, DiffError> {
    let system = &pairing.bound.system;
    let mut given = parameters_of(&pairing.bound, system);
    for (name, value) in slice.params {
        given.insert((*name).to_owned(), vec![*value]);
    }
    let bound = Bound::new(system.clone(), &given, &BTreeMap::new())
        .map_err(|e| DiffError::Sides(format!("{}: {e}", pairing.machine)))?;
    let mut held = Vec::new();
    for (input, (lo, _)) in bound.system.inputs.iter().zip(&bound.inputs) {
        if !slice.free.iter().any(|name| is(&input.name, name)) {
            let calm = calm.iter().find(|(name, _)| is(&input.name, name));
            held.push((input.name.clone(), calm.map_or(*lo, |(_, v)| *v)));
        }
    }
    Ok(Pairing {
        bound,
        held,
        ..pairing.clone()
    })
}
