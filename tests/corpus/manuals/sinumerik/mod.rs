//! Runners of the SINUMERIK 840D.

mod comparison;
mod datum;
mod profisafe;
mod single;
mod story;

use crate::manuals::case::{Given, Runner};
use stillpoint_machine::Machine;
use stillpoint_monitors::sinumerik::parameters::{Configuration, Parameters};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[
    ("story", story::run),
    ("external_stops", single::external_stops),
    ("bus_failure", single::bus_failure),
    ("priority", single::priority),
    ("signal", single::signal),
    ("alarm", single::alarm),
    ("gear_stage", single::gear_stage),
    ("encoder", single::encoder),
    ("encoder_speed", single::encoder_speed),
    ("machine_datum", datum::machine_datum),
    ("machine", datum::machine),
    ("enable_word", datum::enable_word),
    ("monitoring_cycle", datum::monitoring_cycle),
    ("entry", datum::entry),
    ("compared", comparison::compared),
    ("code", comparison::code),
    ("limits", comparison::limits),
    ("result_list", comparison::result_list),
    ("f_times", profisafe::f_times),
    ("connection", profisafe::connection),
];

/// The machine data of axis X of a machine file, in the units of the monitors. Given: `axis`, the lines of the table of the axis;
/// `control`, those of the control, if any.
fn parameters(given: &Given<'_>) -> Result<(Parameters, Configuration), String> {
    let control = match given.get("control") {
        Some(_) => given.text("control")?,
        None => "",
    };
    configured(control, given.text("axis")?)
}

/// The same of lines.
fn configured(control: &str, axis: &str) -> Result<(Parameters, Configuration), String> {
    let mut axes =
        stillpoint_harness::families::sinumerik::production::axes(&load(control, axis)?)?;
    let first = axes.pop().ok_or("no axis")?;
    Ok((first.parameters, first.configuration))
}

/// A machine of one axis.
fn load(control: &str, axis: &str) -> Result<Machine, String> {
    let text = format!(
        "family = \"sinumerik-840d\"\nname = \"corpus\"\n[control]\n{control}\n[axis.X]\n{axis}\n"
    );
    read(&text)
}

/// The machine of a file.
fn read(text: &str) -> Result<Machine, String> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    stillpoint_machine::load_bytes(
        &root.join("tests/corpus/case.toml"),
        text.as_bytes().to_vec(),
        &root.join("spec/families"),
    )
    .map_err(|e| format!("{e:?}"))
}
