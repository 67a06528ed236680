//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod cells;
mod checks;
mod groups;
mod interface;
mod link;
mod machine;
mod numbers;
mod operation;
mod safe_plc;
mod service;
mod watching;

use stillpoint_monitors::mutant::Mutant;

use super::{Family, Made, Params};

pub(super) static FAMILY: Family = Family {
    name: "heidenhain-fs",
    module: "heidenhain",
    machines: &[
        ("gate", "gate"),
        ("both_channels", "both_channels"),
        ("both_fields", "both_fields"),
        ("both_status", "both_status"),
        ("stop", "stop"),
        ("report", "report"),
        ("neighbour", "neighbour"),
        ("global_sto", "global_sto"),
        ("judge", "judge"),
        ("group", "group"),
        ("startup", "startup"),
        ("axis", "axis_release"),
        ("som", "som"),
        ("button", "button"),
        ("switch_on", "switch_on"),
        ("output_enable", "output_enable"),
        ("speed", "speed"),
        ("operating_stop", "operating_stop"),
        ("stop_path", "stop_path"),
        ("position_limit", "position_limit"),
        ("revolutions", "revolutions"),
        ("comparison", "comparison"),
        ("deceleration", "deceleration"),
        ("axis_count", "axis_count"),
        ("reference", "reference"),
        ("agreement", "agreement"),
        ("brakes", "brakes"),
        ("tool_holder", "tool_holder"),
        ("acceptance", "acceptance"),
        ("cc_link", "cc_link"),
        ("self_test", "self_test"),
        ("cut_out", "cut_out"),
        ("holding_brake", "holding_brake"),
        ("status_bits", "status_bits"),
        ("sampling", "sampling"),
        ("self_checks", "self_checks"),
        ("start_checks", "start_checks"),
        ("safe_input", "safe_input"),
        ("doors", "working_space"),
        ("general", "general_fields"),
        ("motion", "group_motion"),
        ("available", "availability"),
        ("program_check", "program_check"),
        ("increment", "jog_increment"),
        ("functions", "allowed_functions"),
        ("reset_button", "control_voltage"),
        ("nc_speed", "f_limited"),
        ("splc", "safe_plc"),
        ("splc_axes", "axes_logic"),
        ("splc_spindle", "spindle_logic"),
        ("splc_magazine", "magazine_logic"),
    ],
    systems: &[],
    fixed: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    for make in [
        interface::make,
        groups::make,
        machine::make,
        watching::make,
        service::make,
        checks::make,
        safe_plc::make,
        operation::make,
        link::make,
    ] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
