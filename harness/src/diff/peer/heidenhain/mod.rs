//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod cells;
mod groups;
mod interface;
mod machine;
mod numbers;

use stillpoint_monitors::heidenhain::mutant::Mutant;

use super::{Family, Made, Params};

pub(super) static FAMILY: Family = Family {
    name: "heidenhain-fs",
    machines: &[
        ("gate", "gate"),
        ("both_channels", "both_channels"),
        ("stop", "stop"),
        ("judge", "judge"),
        ("group", "group"),
        ("startup", "startup"),
        ("axis", "axis_release"),
        ("som", "som"),
        ("button", "button"),
        ("switch_on", "switch_on"),
        ("output_enable", "output_enable"),
    ],
    systems: &[],
    fixed: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<super::Mutant>) -> Made {
    let mutant: Option<Mutant> = mutant.and_then(|mutant| match mutant {
        super::Mutant::Heidenhain(mutant) => Some(mutant),
        super::Mutant::Sinumerik(_) => None,
    });
    for make in [interface::make, groups::make, machine::make] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
