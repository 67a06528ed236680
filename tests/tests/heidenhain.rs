//! The tables of the family: every file holds completely. The systems of `composed-axes.toml` and `composed-spindle.toml` are those of
//! the machining centre, with whose parameters `machines.rs` explores them.

use stillpoint::check::{Settings, check, exit_status, summarise};
use stillpoint::subject::{self, Readings};
use stillpoint_tests::root;

fn holds(file: &str) {
    let path = root().join("spec/heidenhain-fs").join(file);
    let subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let checked = check(&subject, &Settings::default(), &mut |_| Box::new(()));
    let checked = checked.unwrap_or_else(|(title, e)| panic!("{file}, {title}: {e}"));
    let summaries = summarise(&subject, &checked);
    assert!(!summaries.is_empty(), "{file} states no property");
    assert_eq!(
        exit_status(&summaries, &checked),
        0,
        "{file}: {summaries:?}"
    );
}

#[test]
fn modes_and_permissives() {
    holds("mode.toml");
}

#[test]
fn referencing_of_axes() {
    holds("reference.toml");
}

#[test]
fn monitors() {
    holds("monitors.toml");
}

#[test]
fn status_bits() {
    holds("status-bits.toml");
}

#[test]
fn self_test() {
    holds("selftest.toml");
}

#[test]
fn outputs() {
    holds("outputs.toml");
}

#[test]
fn faults_and_checks_at_start_up() {
    holds("faults.toml");
}

#[test]
fn requests_of_the_safe_logic() {
    holds("interface.toml");
}

#[test]
fn comparison_of_fields_programs_and_outputs() {
    holds("compared.toml");
}

#[test]
fn stops() {
    holds("stop.toml");
}

#[test]
fn groups() {
    holds("group.toml");
}

#[test]
fn doors() {
    holds("doors.toml");
}

#[test]
fn kernel_under_any_logic() {
    holds("kernel.toml");
}

#[test]
fn example_of_a_logic() {
    holds("splc.toml");
}

#[test]
fn logic_alone() {
    holds("composed.toml");
}

#[test]
fn tests_of_chain_channels_outputs_and_brakes() {
    holds("cutout.toml");
}

/// Among them: exactly one master CC (HFS-ARCH-002); what a changed parameter needs (HFS-PARAM-009).
#[test]
fn safe_inputs_and_general_fields() {
    holds("fields.toml");
}

#[test]
fn operation_by_the_operator() {
    holds("operation.toml");
}

#[test]
fn response_times() {
    holds("response.toml");
    holds("reaction.toml");
}

#[test]
fn telegrams_between_controller_computers() {
    holds("link.toml");
}

#[test]
fn both_channels_of_a_group() {
    holds("channels.toml");
}

#[test]
fn single_faults_in_two_channels() {
    holds("faults-two-channels.toml");
}
