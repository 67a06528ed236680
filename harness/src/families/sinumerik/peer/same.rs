//! The monitors that the tables of SINUMERIK describe in the same words, and what is not the same.

use stillpoint_monitors::kernel::{ConfigError, Position};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{limit_switch, selection, speed};

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
        small(p.value("setpoint_percent")),
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

/// The table of the slip bounds the correction, the monitor does not: how far the other channel may be so that it stays clear
/// of the bound.
fn clear_of_the_bound(p: &Params) -> i32 {
    p.value("off_max").saturating_sub(p.value("pos_max"))
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
