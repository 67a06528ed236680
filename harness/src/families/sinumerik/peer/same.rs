//! The monitors that the tables of SINUMERIK describe in the same words, and what is not the same.

use stillpoint_monitors::kernel::{ConfigError, Position};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{bus_failure, limit_switch, selection, speed, spl_file};

use super::numbers::{EXTERNAL, INTERNAL, small};
use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params};
use crate::diff::product::Values;

pub(super) fn selection_config(p: &Params) -> Result<selection::Config, ConfigError> {
    let limits = ["limit_1", "limit_2", "limit_3", "limit_4"].map(|name| p.speed(name));
    let plain = selection::Config::new(p.is("enable"), p.time("t_vel"), limits)?;
    match p.is("override") {
        true => plain.with_override(std::array::from_fn(|k| small(p.value(&format!("f_{k}"))))),
        false => Ok(plain),
    }
}

/// `mode`: the parameter with the stops of the stages.
pub(super) fn speed_config(p: &Params, mode: &str) -> Result<speed::Config, ConfigError> {
    let reactions = ["reaction_1", "reaction_2", "reaction_3", "reaction_4"];
    speed::Config::new(
        small(p.value(mode)),
        reactions.map(|name| small(p.value(name))),
        p.is("one_encoder").then(|| p.speed("encoder_max")),
    )
}

/// `enabled`, `mode`: the parameters with the enable bit and the stop.
pub(super) fn limit_switch_config(
    p: &Params,
    enabled: &str,
    mode: &str,
) -> Result<limit_switch::Config, ConfigError> {
    let pair = |names: [&str; 2]| names.map(|name| Position(p.value(name)));
    limit_switch::Config::new(
        p.is(enabled),
        pair(["plus_1", "plus_2"]),
        pair(["minus_1", "minus_2"]),
        small(p.value(mode)),
    )
}

fn bus_failure_config(p: &Params) -> Result<bus_failure::Config, ConfigError> {
    let reactions = ["reaction_1", "reaction_2", "reaction_3", "reaction_4"];
    bus_failure::Config::new(
        p.is("nck"),
        p.is("enable"),
        p.time("t_bus"),
        small(p.value("stop_mode")),
        reactions.map(|name| small(p.value(name))),
    )
}

/// The table of the slip bounds the correction, the monitor does not: how far the other channel may be so that it stays clear
/// of the bound.
fn clear_of_the_bound(p: &Params) -> i32 {
    p.value("off_max").saturating_sub(p.value("pos_max"))
}

/// The number of the first of three signals that is found, 0 for none.
fn first_found(ports: &[i32]) -> i64 {
    let found = (1..=3).zip(ports).find(|(_, found)| **found != 0);
    found.map_or(0, |(number, _)| number)
}

/// The greatest of these parameters.
fn longest(p: &Params, names: &[&str]) -> i32 {
    names.iter().map(|name| p.value(name)).fold(0, i32::max)
}

peers! { sinumerik |p|
    // Stops.
    "external" => external;
    "fault" => fault;
    "stop" => stop
        .named(&[("sequence_over", "ended")])
        .only(&["demand", "rx_internal"], INTERNAL)
        .only(&["external", "rx_external"], EXTERNAL);

    // The table counts what has passed of the delay, the monitor what is left of it.
    "bus_failure" => bus_failure
        .config(bus_failure_config(p)?)
        .cell("left", upto(p.value("t_bus")));

    // State of the axis.
    "selection" => selection
        .config(selection_config(p)?)
        .named(&[("speed_limit", "outputs.limit")]);
    "reference" => reference;
    "agreement" => agreement.without(&["axis_safe"]).kept("agreed", "agreed");
    "gear" => gear.hidden(&["unconfigured"]);

    // Actual value and limits.
    "motion" => motion.named(&[("actual", "outputs.position"), ("moved", "state.speed")]);
    "standstill" => standstill;
    "speed" => speed.config(speed_config(p, "stop_mode")?);
    "setpoint" => setpoint;
    "end_stop" => limit_switch.config(limit_switch_config(p, "enabled", "stop_mode")?);
    "ramp" => ramp.without(&["restart"]).cell("lowest", upto(p.value("v_max")));
    "threshold" => threshold;
    "cam" => cam.named(&[("position_of", "config.cam")]);
    // The table has result list 1 only.
    "results" => results
        .constants(&[("cams", 0), ("n_x", 0), ("modulo", 0), ("below", 0)])
        .named(&[("sbh_upper", "standstill_upper"), ("sbh_lower", "standstill_lower"), ("sg_violated", "speed_violated")])
        .hidden(&["list_1", "list_2"])
        .told("r_sbh", |_, out| out.list_1.sbh.bits().into())
        .told("r_se1", |_, out| out.list_1.se[0].bits().into())
        .told("r_se2", |_, out| out.list_1.se[1].bits().into())
        .told("r_sg1", |_, out| out.list_1.sg[0].bits().into())
        .told("r_sg2", |_, out| out.list_1.sg[1].bits().into())
        .told("r_sg3", |_, out| out.list_1.sg[2].bits().into())
        .told("r_sg4", |_, out| out.list_1.sg[3].bits().into());

    // Tests and comparisons.
    "test" => test_stop
        .without(&["external_a", "standstill"])
        .told("message", |_, out| out.active.into());
    "shutdown_test" => shutdown_test.told("message", |_, out| out.active.into());
    "pulses" => pulses;
    "slip" => slip
        .needs(clear_of_the_bound(p) >= p.value("pos_max"), "off_max must be at least 2 * pos_max")
        .only(&["other"], Values::Range(-clear_of_the_bound(p), clear_of_the_bound(p)));
    // The table may start with a position that is not stored, which nothing reads; the monitor then has none.
    "history" => history
        .named(&[("exists", "outputs.stored")])
        .hidden(&["state.standstill"])
        .without(&["save_sge"])
        .kept("state.stored", "stored")
        .kept_where("standstill", "standstill", "stored");
    "test_interval" => forced_check;

    // Blocks of the safe logic. The table counts how long a shutdown lasts, the monitor what it leaves of the window.
    "relay" => relay
        .named(&[("tm1", "window"), ("ti_1", "delay_1"), ("ti_2", "delay_2"), ("ti_3", "delay_3")])
        .cell("left", upto(p.value("tm1")))
        .cell("least", upto(p.value("tm1")));

    // Comparison of NCK-SPL and PLC-SPL. The table counts how long a signal differs, the monitor what is left of the extended time.
    "spl_protection" => spl_protection;
    "spl_signal" => spl_signal
        .named(&[("limit", "plain"), ("limit_10", "extended"), ("pair", "phase")])
        .without(&["cmd_other"])
        .cell("left", upto(p.value("limit_10")));
    // Three signals of the table stand for 320 numbers.
    "spl_comparison" => spl_comparison
        .made("found", &["found_1", "found_2", "found_3"], first_found)
        .without(&["unequal_1", "unequal_2", "unequal_3"]);
    // The watchdog of the monitor counts the grace down, and has a word of outputs twice for the one of the table.
    "spl_link" => spl_link
        .named(&[("t_lost", "patience"), ("t_end", "grace"), ("wanted", "inputs.outsed"), ("driven", "outputs.outsed")])
        .cell("time", upto(p.value("t_lost").max(p.value("t_end"))));

    // Start of the safe logic: the status word of the monitor stands bit by bit in the table.
    "spl_start" => spl_start
        .named(&[("phase", "stage")])
        .hidden(&["outputs.status"])
        .told("bit_0", |_, out| (out.status & 1).into())
        .told("bit_1", |_, out| (out.status >> 1 & 1).into())
        .told("bit_2", |_, out| (out.status >> 2 & 1).into())
        .told("bit_3", |_, out| (out.status >> 3 & 1).into())
        .told("bit_4", |_, out| (out.status >> 4 & 1).into())
        .told("bit_5", |_, out| (out.status >> 5 & 1).into())
        .told("bit_6", |_, out| (out.status >> 6 & 1).into())
        .told("bit_7", |_, out| (out.status >> 7 & 1).into())
        .told("bit_8", |_, out| (out.status >> 8 & 1).into())
        .told("bit_9", |_, out| (out.status >> 9 & 1).into())
        .told("bit_10", |_, out| (out.status >> 10 & 1).into())
        .told("bit_11", |_, out| (out.status >> 11 & 1).into())
        .told("bit_12", |_, out| (out.status >> 12 & 1).into())
        .told("bit_13", |_, out| (out.status >> 13 & 1).into());
    "spl_file" => spl_file
        .named(&[("ref_length", "state.length"), ("ref_sum", "state.sum"), ("marked", "mark.some"), ("mark", "mark.value")])
        .hidden(&["deviation"])
        .told("longer", |state, _| (state.deviation == spl_file::Deviation::Length).into())
        .told("other", |state, _| (state.deviation == spl_file::Deviation::Content).into());
    "spl_access" => spl_access;

    // Forced checking around the safe logic.
    "spl_output_test" => spl_output_test.named(&[("t_answer", "delay"), ("count", "wrong")]);
    "spl_stop_test" => spl_stop_test
        .named(&[("t_step", "delay"), ("was_0", "low")])
        .hidden(&["item"])
        .cell("left", upto(p.value("t_step")))
        .told("step", |state, _| (state.item as i64 * 2 - 1).max(0) + i64::from(state.drive));

    // PROFIsafe. The table counts what is left of the 50 ms and of the overruns, the monitor what has passed; the table counts to the
    // next PROFIsafe cycle from the last one, the monitor from the next.
    "f_master" => f_master
        .named(&[("t_limit", "tolerated")])
        .cell("until", upto(p.value("ratio") - 1))
        .cell("since", upto(p.value("t_limit")))
        .cell("exceeded", upto(p.value("overruns")));
    "f_module" => f_module
        .named(&[("cleared", "blocked")])
        .constants(&[("bits", 2)])
        .cell("shown", upto(3));

    // Diagnosis. Of the acceptance test mode the table counts what is left of its times, the monitor what has passed.
    "acceptance_mode" => acceptance_mode
        .hidden(&["outputs.differs"])
        .told("code", |_, out| if out.differs { 1011 } else { 0 })
        .cell("lasted", upto(p.value("t_test")))
        .cell("differed", upto(p.value("t_differ")));
    "acceptance_alarm" => acceptance_alarm;
    "alarm_life" => alarm_life;
    "alarm_display" => alarm_display;
    "sge_difference" => sge_difference.cell("lasted", upto(p.value("t_chg")));

    // Service. The table counts what is left of the time of a step of the brake test, the monitor what has passed of it.
    "brake_test" => brake_test.cell("waited", upto(longest(p, &["tv_active", "tv_close", "tv_command", "tv_reached", "tv_hold"])));
    "brake_torque" => brake_torque;
    "brake_load" => brake_load;
    "brake_control" => brake_control;
    "esr_trigger" => esr_trigger;
}
