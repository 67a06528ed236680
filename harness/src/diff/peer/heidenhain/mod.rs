//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod interface;
mod numbers;

use stillpoint_monitors::heidenhain::mutant::Mutant;

use super::{Family, Made, Params};

pub(super) static FAMILY: Family = Family {
    name: "heidenhain-fs",
    machines: &[("gate", "gate"), ("both_channels", "both_channels")],
    systems: &[],
    fixed: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<super::Mutant>) -> Made {
    let mutant: Option<Mutant> = mutant.and_then(|mutant| match mutant {
        super::Mutant::Heidenhain(mutant) => Some(mutant),
        super::Mutant::Sinumerik(_) => None,
    });
    for make in [interface::make] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
