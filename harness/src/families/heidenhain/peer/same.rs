//! The monitors that the tables of HEIDENHAIN describe in the same words, and what is not the same.

use stillpoint_model::Domain;
use stillpoint_monitors::heidenhain::types::Stop;
use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params};
use crate::diff::product::Values;

/// The stop of fields with a number that is no value of theirs.
fn wrong(ports: &[i32]) -> i64 {
    let stop = if ports[0] != 0 {
        Stop::Ss1F
    } else {
        Stop::None
    };
    stop as i64
}

/// A set of bits, one for each port.
fn bits<const N: usize>(ports: &[i32]) -> i64 {
    (0..N).map(|k| i64::from(ports[k] != 0) << k).sum()
}

peers! { heidenhain |p|
    // Interface to the safe PLC.
    "gate" => gate;
    "both_channels" => both_channels;
    "both_fields" => both_fields
        .made("mc.stop", &["wrong_mc"], wrong)
        .made("cc.stop", &["wrong_cc"], wrong)
        .named(&[
            ("som_mc", "mc.som"), ("voltage_mc", "mc.voltage"), ("drives_mc", "mc.drives"), ("chain_mc", "mc.chain"),
            ("keys_mc", "mc.keys"), ("brakes_mc", "mc.brakes"), ("feed_mc", "mc.feed"),
            ("som_cc", "cc.som"), ("voltage_cc", "cc.voltage"), ("drives_cc", "cc.drives"), ("chain_cc", "cc.chain"),
            ("keys_cc", "cc.keys"), ("brakes_cc", "cc.brakes"), ("feed_cc", "cc.feed"),
            ("mode", "outputs.som"), ("chain_closed", "outputs.chain"), ("enabled", "outputs.feed"),
        ]);
    "both_status" => both_status
        .named(&[
            ("runs_mc", "mc.executed"), ("runtime_mc", "mc.runtime"), ("output_mc", "mc.outputs"),
            ("runs_cc", "cc.executed"), ("runtime_cc", "cc.runtime"), ("output_cc", "cc.outputs"),
        ]);
    "general" => general_fields
        .named(&[
            ("cvo", "inputs.voltage"), ("permit", "inputs.drives"), ("mkg", "inputs.keys"), ("t_brk", "inputs.brakes"),
            ("mode", "outputs.som"), ("chain_closed", "outputs.chain"), ("enabled", "outputs.feed"),
        ]);

    // Stop and monitoring state of a group.
    "stop" => stop;
    "report" => report;
    "neighbour" => neighbour;
    "global_sto" => global_sto;
    // There is no code for SS0.
    "judge" => judge
        .named(&[("last", "place")])
        .only(&["stop_request"], Values::List(&[0, 1, 2, 3, 4]));
    "group" => group
        .named(&[("with_2", "left.sls_2"), ("with_3", "left.sls_3"), ("with_4", "left.sls_4")]);
    "startup" => startup;
    "axis" => axis_release;

    // The whole machine.
    "som" => som.named(&[("pp_som", "outputs.som")]);
    "button" => button;
    "switch_on" => switch_on;
    "output_enable" => output_enable;

    // Position and speed.
    "speed" => speed
        .named(&[
            ("limit_2", "limits.som_2"), ("limit_3", "limits.som_3"), ("limit_4", "limits.som_4"),
            ("limit_s", "limits.restricted"),
            ("with_2", "left.sls_2"), ("with_3", "left.sls_3"), ("with_4", "left.sls_4"), ("v", "speed"),
        ]);
    "operating_stop" => operating_stop.named(&[("v", "speed")]);
    "stop_path" => stop_path;
    "position_limit" => position_limit.kept("last", "last");
    "revolutions" => revolutions
        .cell("angle", Domain { lo: -p.value("turns") - 1, hi: p.value("turns") + 1 })
        .without(&["moving"]);
    "comparison" => comparison;
    "deceleration" => deceleration.named(&[("v", "speed")]);
    // The table counts at most three axes: as many as may move without a limit.
    "axis_count" => axis_count
        .named(&[("free", "ungrouped")])
        .hidden(&["one_only"])
        .told("allowed", |_, outputs| if outputs.one_only { 1 } else { 3 });

    // Referencing, outputs, tests.
    // What is saved is set anew before it is read again; the two sides do so in different cycles.
    "reference" => reference
        .named(&[("ref", "axis")])
        .hidden(&["outputs.demand", "state.saved"])
        .kept("saved", "saved");
    "agreement" => agreement;
    "brakes" => brakes
        .named(&[
            ("release_1", "inputs.own.release"), ("drive_1", "inputs.own.drive"),
            ("release_2", "shared.0.release"), ("drive_2", "shared.0.drive"),
            ("release_3", "shared.1.release"), ("drive_3", "shared.1.drive"),
        ]);
    "tool_holder" => tool_holder;
    "acceptance" => acceptance.named(&[("accepted", "phase")]);
    // A passed test is no repeated one any more, in the table it stays one until the next; nothing reads it in between.
    "self_test" => self_test.named(&[("step", "phase")]).hidden(&["brake_demand", "state.repeated"]);
    "cut_out" => cut_out;
    "holding_brake" => holding_brake.named(&[("hold", "step")]);
    "status_bits" => status_bits;
    // The pair of the table is an emergency stop.
    "sampling" => sampling.constants(&[("emergency", 1)]);
    "self_checks" => self_checks;
    "start_checks" => start_checks;
    "cc_link" => cc_link
        .named(&[
            ("moves", "inputs.drive.moving"), ("member", "inputs.drive.group.some"), ("place", "inputs.drive.position"),
            ("brake_open", "inputs.drive.brake_open"), ("torque", "inputs.drive.torque"),
            ("taken_moving", "outputs.drive.moving"), ("taken_member", "outputs.drive.group.some"),
            ("taken_place", "outputs.drive.position"), ("taken_open", "outputs.drive.brake_open"),
            ("taken_torque", "outputs.drive.torque"),
        ])
        // The table knows one group.
        .constants(&[("inputs.drive.group.value", 0)])
        .hidden(&["outputs.drive.group.value"])
        .cell("last.group.value", upto(0))
        .cell("last.position", upto(1));

    // What the operator can do, and what the control checks of the program.
    "safe_input" => safe_input;
    "doors" => working_space
        .constants(&[("doors", 0b11)])
        .made("closed", &["door_1", "door_2"], bits::<2>);
    "motion" => group_motion.made("axes", &["axis_1", "axis_2", "axis_3"], bits::<3>);
    "available" => availability.named(&[("has", "available")]);
    "program_check" => program_check;
    "increment" => jog_increment.constants(&[("to_end", 0)]);
    "functions" => allowed_functions;
    // The table knows the key only: the latch circuit is not set.
    "reset_button" => control_voltage
        .named(&[("fitted", "config.reset"), ("cvo", "inputs.key")])
        .hidden(&["drives", "t_drives"])
        .constants(&[("config.t_key", 0), ("inputs.latched", 0), ("inputs.t_key", 0)]);
    "nc_speed" => f_limited
        .named(&[
            ("limit_2", "limits.0"), ("limit_3", "limits.1"), ("limit_4", "limits.2"), ("f_limited", "pressed"),
            ("v", "outputs.speed"),
        ]);
}
