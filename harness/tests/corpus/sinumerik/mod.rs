//! Runners of the SINUMERIK 840D.

mod single;
mod story;

use crate::case::{Given, Runner};
use stillpoint_monitors::sinumerik::parameters::{Configuration, Parameters};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[
    ("story", story::run),
    ("external_stops", single::external_stops),
    ("priority", single::priority),
    ("signal", single::signal),
];

/// The machine data of axis X of a machine file, in the units of the monitors. Given: `axis`, the lines of the table of the axis;
/// `control`, those of the control, if any.
fn parameters(given: &Given<'_>) -> Result<(Parameters, Configuration), String> {
    let control = match given.get("control") {
        Some(_) => given.text("control")?,
        None => "",
    };
    let axis = given.text("axis")?;
    let text = format!(
        "family = \"sinumerik-840d\"\nname = \"corpus\"\n[control]\n{control}\n[axis.X]\n{axis}\n"
    );
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let machine = stillpoint_spec::machine::load_bytes(
        &root.join("tests/corpus/case.toml"),
        text.into_bytes(),
        &root.join("spec"),
    )
    .map_err(|e| format!("{e:?}"))?;
    let mut axes = stillpoint::production::axes(&machine)?;
    let first = axes.pop().ok_or("no axis")?;
    Ok((first.parameters, first.configuration))
}
