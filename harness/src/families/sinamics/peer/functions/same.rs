//! The monitors of the functions that their tables describe in the same words, and what is not the same.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{ConfigError, Position, Speed};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinamics::types::Stop;
use stillpoint_monitors::sinamics::{encoderless, sbr, sdi, slp, sls, ss2, ssm};

use crate::diff::peer::numbers::{bit, distance, small, upto};
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params};
use crate::diff::product::Values;

/// A signal that the table has the other way round.
fn not(ports: &[i32]) -> i64 {
    bit(ports[0] == 0)
}

/// Both signals.
fn both(ports: &[i32]) -> i64 {
    bit(ports[0] != 0 && ports[1] != 0)
}

/// The first port.
pub(super) fn first(ports: &[i32]) -> i64 {
    i64::from(ports[0])
}

/// The second port.
fn second(ports: &[i32]) -> i64 {
    i64::from(ports[1])
}

/// A position that is counted the other way round.
fn reversed(ports: &[i32]) -> i64 {
    -i64::from(ports[0])
}

/// The stop that a parameter names.
pub(super) fn response(p: &Params, name: &str) -> Result<Stop, ConfigError> {
    Stop::from_code(small(p.value(name))).ok_or(ConfigError::StopNotAllowed)
}

/// The ramp.
pub(super) fn sbr_config(p: &Params) -> Result<sbr::Config, ConfigError> {
    sbr::Config::new(
        p.speed("n_ref"),
        p.time("t_ref"),
        p.time("t_delay"),
        p.speed("n_res"),
        sbr::SbrStart::Trigger,
        sbr::SbrFloor::Resolution,
    )
}

fn sls_config(p: &Params) -> Result<sls::Config, ConfigError> {
    sls::Config::new(
        ["v_1", "v_2", "v_3", "v_4"].map(|name| p.speed(name)),
        [
            response(p, "code_1")?,
            response(p, "code_2")?,
            response(p, "code_3")?,
            response(p, "code_4")?,
        ],
        p.time("t_sls"),
        true,
        p.is("graded"),
        p.is("static"),
        sls::Slsd::Keep,
    )
}

/// The table has the filtered speed in parts of a step.
fn ssm_config(p: &Params) -> Result<ssm::Config, ConfigError> {
    let smooth = p.is("smooth");
    let fine = if smooth { p.value("fine") } else { 1 };
    let parts = |name| Speed(p.value(name).saturating_mul(fine).unsigned_abs());
    let limit = if p.is("enabled") {
        parts("n_x")
    } else {
        Speed(0)
    };
    let hysteresis = smooth.then(|| parts("n_h")).filter(|_| limit != Speed(0));
    ssm::Config::new(limit, hysteresis, true, false)
}

fn sdi_config(p: &Params) -> Result<sdi::Config, ConfigError> {
    sdi::Config::new(
        if p.is("number") {
            sdi::Permitted::Negative
        } else {
            sdi::Permitted::Positive
        },
        p.time("t_sdi"),
        distance(p.value("tol")),
        response(p, "code")?,
        true,
        p.is("static"),
        false,
        sdi::SdiRef::Trail,
    )
}

fn slp_config(p: &Params) -> Result<slp::Config, ConfigError> {
    let range = |lower, upper, code| -> Result<slp::Range, ConfigError> {
        Ok(slp::Range {
            lower: Position(p.value(lower)),
            upper: Position(p.value(upper)),
            response: response(p, code)?,
        })
    };
    slp::Config::new(
        range("lower_1", "upper_1", "code_1")?,
        range("lower_2", "upper_2", "code_2")?,
    )
}

/// In the table p9509 says where monitoring ends, in the monitor where it goes on; SSM is a parameter of both.
fn encoderless_config(p: &Params) -> Result<encoderless::Config, ConfigError> {
    let wait = p.time("t_wait");
    encoderless::Config::new(
        wait,
        wait,
        p.is("ssm") && !p.is("ssm_ends"),
        !p.is("sdi_ends"),
        p.is("static"),
    )
}

peers! { sinamics |p|
    // Stops. POWER ON is a new monitor.
    "sto" => sto
        .constants(&[("valve", 0), ("valve_closed", 0), ("armature_short", 0)])
        .named(&[
            ("ready", "powered_up"), ("parked", "inputs.parking"), ("testing", "test_stop"), ("act", "active"), ("act", "shown"),
            ("off", "pulses_off"), ("parking", "outputs.parked"),
        ])
        .without(&["power_on"])
        .hidden(&["outputs.armature_short", "deselected"])
        .told("close", |_, outputs| bit(outputs.pulses_off));
    // The brake is asked for, and follows: what the line does is a table of its own.
    "sbc" => sbc
        .constants(&[("inputs.open", 1), ("other_on", 1), ("feedback", 1)])
        .named(&[("close", "sto"), ("failed", "inputs.fault"), ("other", "other_fault"), ("open", "outputs.on"), ("open", "state.on")])
        .hidden(&["outputs.open", "defect"]);
    "ss1_basic" => ss1_basic
        .named(&[
            ("t_ss1", "time"), ("sto", "inputs.sto"), ("ended", "outputs.sto"), ("act", "active"), ("timer", "left"),
        ]);
    "ss1" => ss1
        .constants(&[("config.stop_b", 0), ("ramp_violated", 0)])
        .named(&[
            ("t_b", "time"), ("n_stop", "shutdown"), ("kind", "braking"), ("sto", "inputs.sto"), ("n", "speed"),
            ("ended", "outputs.sto"), ("act", "active"), ("off3", "monitored"), ("timer", "left"), ("raised", "state.stop_b"),
        ])
        .made("drive_on", &["off"], not)
        .hidden(&["stop_a", "violated"])
        .told("request", |_, outputs| if outputs.stop_a { Stop::A as i64 } else { 0 });
    "ss2" => ss2
        .constants(&[("deselect", 0), ("ramp_violated", 0)])
        .named(&[
            ("kind", "braking"), ("t_c", "time_c"), ("t_d", "time_d"), ("t_e", "time_e"), ("higher", "ss1_or_sto"),
            ("stands", "sos_active"), ("hold", "outputs.sos"), ("act", "ss2_active"), ("act_e", "ss2e_active"),
            ("inhibits", "outputs.inhibited"), ("timer", "left"),
        ])
        // What cannot be acknowledged is one more STOP A.
        .only(&["stop"], Values::Range(0, 5))
        .hidden(&["violated", "state.phase"])
        .told("phase", |state, _| match state.phase {
            ss2::Phase::Idle => 0,
            ss2::Phase::Braking => 1,
            ss2::Phase::DelayD => 2,
            ss2::Phase::DelayE => 3,
            ss2::Phase::Sos => 4,
        });
    // The monitor asks for its stop in each cycle of a violation; that it is not triggered twice is the arbiter's business.
    "sos" => sos
        .named(&[
            ("t_sos", "delay"), ("tol", "tolerance"), ("hold", "held"), ("pos", "position"), ("asked", "outputs.selected"),
            ("act", "active"), ("outside", "violated"), ("ref", "reference"), ("timer", "left"),
        ])
        .made("renew", &["acknowledge", "teach"], both)
        .hidden(&["demand"])
        .told("outside", |_, outputs| bit(outputs.demand == Stop::B));

    // What monitors braking.
    "sam" => sam
        .constants(&[("l0", 0), ("below", 0), ("fault_stop", Stop::A as i64), ("encoder_fault", 0)])
        .named(&[("tol", "tolerance"), ("n_off", "shutdown"), ("n_ssm", "ssm_limit"), ("brakes", "braking"), ("n", "speed")])
        .hidden(&["demand", "state.first", "state.off"])
        .told("violated", |_, outputs| bit(outputs.demand == Stop::A));
    "sbr" => sbr
        .config(sbr_config(p)?)
        .named(&[("brakes", "braking"), ("n", "speed")])
        .cell("left", upto(p.value("t_delay").max(2)))
        .cell("ramp", upto(p.value("n_top").max(p.value("n_ref"))))
        .cell("rest", upto(p.value("t_ref") - 1))
        .hidden(&["monitored", "limit"])
        .told("on", |state, _| bit(state.phase != sbr::Phase::Idle));

    // Limits of speed, direction and position.
    "sls" => sls
        .config(sls_config(p)?)
        .constants(&[("drive_on", 1)])
        .named(&[
            ("share", "telegram"), ("hold", "sos_after_stop"), ("n", "speed"), ("act", "active"), ("act_bits", "outputs.level"),
            ("shown", "outputs.limit"), ("above", "violated"), ("request", "demand"), ("timer", "left"), ("stage", "now.level"),
            ("limit", "now.limit"), ("next", "next.limit"),
        ])
        .only(&["share"], Values::Range(-1, 32_767))
        .explored(&["share"], Values::List(&[-1, 0, 1, 8_192, 16_383, 16_384, 32_766, 32_767]))
        .without(&["acknowledge"])
        .hidden(&["wrong_value", "next.level"])
        .told("value", |_, outputs| if outputs.wrong_value { 1_041 } else { 0 })
        .told("message", |state, outputs| match outputs.violated {
            true => 100 * (i64::from(state.now.level.index()) + 1),
            false => 0,
        });
    "ssm" => ssm
        .config(ssm_config(p)?)
        .constants(&[("pulses", 1)])
        .made("speed", &["n", "y"], if p.is("smooth") { second } else { first })
        .named(&[("guards", "counts")])
        .told("bit", |_, outputs| bit(outputs.below));
    "sdi" => sdi
        .config(sdi_config(p)?)
        .constants(&[("pulses", 1)])
        .made("position", &["pos"], if p.is("number") { reversed } else { first })
        .named(&[("act", "active"), ("above", "violated"), ("request", "demand"), ("timer", "left")])
        .cell("from", Domain { lo: -p.value("p_top"), hi: p.value("p_top") })
        .told("ref", |state, _| i64::from(state.from.0).abs())
        .told("message", if p.is("number") {
            |_, outputs| if outputs.violated { 1 } else { -1 }
        } else {
            |_, outputs| if outputs.violated { 0 } else { -1 }
        });
    "slp" => slp
        .config(slp_config(p)?)
        .named(&[
            ("pos", "position"), ("diagnosis", "enabled"), ("act", "active"), ("request", "demand"), ("up", "sdi_positive"),
            ("down", "sdi_negative"), ("way", "state.retract"), ("was_retract", "input_held"), ("passes_low", "below"),
            ("passes_up", "above"),
        ]);

    // Positions and encoders.
    "referencing" => reference
        .constants(&[("agreement", 0), ("parking", 0)])
        .named(&[
            ("t_ua", "window"), ("tol", "tolerance"), ("lost", "power_on"), ("gear", "gear_change"), ("command", "declared"),
            ("stands", "standstill"), ("agree_1", "agrees"), ("agree_2", "other_agrees"), ("pos", "position"),
            ("referenced_bit", "outputs.referenced"), ("failed", "moved"), ("axis", "phase"), ("timer", "left"),
            ("buffered", "agreed"),
        ]);
    "actual_value" => actual_value
        .named(&[
            ("tol_p", "position"), ("tol_p", "slip"), ("cyclic", "synchronised"), ("pos_1", "own"), ("pos_2", "other"),
            ("wide", "raised"), ("sync_once", "synchronise"), ("violated", "exceeded"), ("base", "aligned"),
        ])
        .hidden(&["apart"]);
    "gear" => gear
        .named(&[
            ("t_tol", "longest"), ("asked", "inputs.stage"), ("increase", "raise"), ("wide", "outputs.raised"),
            ("syncs", "synchronise"), ("new", "changed"),
        ])
        .cell("left", upto(p.value("t_tol")));
    // What SSM and SDI tell without pulses is told by their monitors.
    "blind" => encoderless
        .config(encoderless_config(p)?)
        .named(&[
            ("slow", "still"), ("internal", "outputs.sto"), ("no_start", "no_current"), ("timer", "left"), ("was_on", "on_held"),
            ("ran", "came"),
        ])
        .without(&["below"])
        .cell("left", upto(p.value("t_wait")));
    "start_phase" => start_phase
        .named(&[("t_start", "delay"), ("correct", "plausible"), ("differs", "stop_f"), ("timer", "left")])
        .hidden(&["enabled"])
        .told("sight", |state, outputs| i64::from(state.enabled) + bit(outputs.known));
    // The brake test of a test stop.
    "with_test_stop" => brake_test_request
        .constants(&[("by_test_stop", 1), ("negative", 0), ("config.automatic", 0), ("complete", 0)])
        .named(&[("at_start", "inputs.automatic"), ("test", "test_stop")])
        .hidden(&["choice"]);
    // A fault of the only encoder is none of a data set.
    "encoder" => data_set
        .named(&[("switched", "changes"), ("invalid", "locked")])
        .made("same", &["unequal"], not)
        .without(&["fault"])
        .hidden(&["outputs.fault", "stop_a"])
        .told("request", |_, outputs| if outputs.stop_a { 6 } else { 0 });
}
