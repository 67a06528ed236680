//! The monitors that the tables of the control part describe in the same words, and what is not the same.

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::numbers::upto;
use crate::diff::peer::same::{Same, peers};
use crate::diff::peer::{Made, Params};

peers! { sinamics |p|
    // Terminals of the Basic Functions.
    "debounce" => input_filter
        .named(&[("t_filter", "time"), ("raw", "terminal"), ("value", "level"), ("apart", "other")]);
    "pair" => terminal_pair
        .named(&[
            ("t_disc", "tolerance"), ("in_1", "own"), ("in_2", "inputs.other"), ("ef_sto", "held"), ("ack", "acknowledge"),
            ("error", "outputs.fault"),
        ]);
    // The table counts what has passed of both times, the monitor what is left of them.
    "chatter" => chatter
        .named(&[("t_disc", "rest"), ("ack", "acknowledge"), ("was", "last"), ("error", "outputs.fault")])
        .cell("unrested", upto(p.value("t_disc")))
        .cell("watch", upto(p.value("t_disc").saturating_mul(5)));
    "basic_stop" => basic_stop
        .named(&[
            ("t_f", "delay"), ("stopping", "inputs.fault"), ("differs", "difference"), ("event_ack", "internal_event_ack"),
            ("off", "pulses_off"), ("entry", "entered"), ("was_selected", "state.selected"),
        ]);
    // Here the table has one cause alone, which can be acknowledged.
    "basic_fault" => basic_stop
        .named(&[
            ("t_f", "delay"), ("error", "difference"), ("ack", "acknowledge"), ("event_ack", "internal_event_ack"), ("fault", "stop"),
            ("stop_a", "pulses_off"), ("entry", "entered"), ("was_selected", "state.selected"),
        ])
        .constants(&[("inputs.fault", 0), ("locking", 0)]);

    // Fail-safe inputs, acknowledgement.
    "fdi" => fail_safe_input
        .live("normally_open", "nc_no")
        .live("onboard", "onboard")
        .named(&[
            ("t_disc", "tolerance"), ("in_1", "input1"), ("in_2", "input2"), ("ack", "acknowledge"), ("error", "fault"),
            ("state", "state.phase"),
        ]);
    // Which results there are is the monitor's; the table knows that one differs.
    "compare" => cross_check
        .named(&[
            ("values", "values_apart"), ("gear", "gear_too_long"), ("wide", "too_wide"), ("wrong", "implausible"),
        ])
        .made("own.slp", &["differ"], |i| i64::from(i[0]))
        .constants(&[
            ("own.stop", 0), ("own.function", 0), ("own.sos", 0), ("own.sls", 0), ("own.sls_level", 0), ("own.sdi", 0), ("own.stage", 0),
            ("other.stop", 0), ("other.function", 0), ("other.sos", 0), ("other.sls", 0), ("other.sls_level", 0), ("other.sdi", 0),
            ("other.slp", 0), ("other.stage", 0),
        ]);
    "edge" => acknowledgement_edge
        .named(&[("edge", "phase"), ("pulse", "acknowledge"), ("alarm", "not_idle")])
        .made("stable", &["high", "low"], |i| i64::from(i[0] | i[1]))
        .made("level", &["high", "low"], |i| i64::from(i[0] & !i[1]));
    "module" => acknowledgement
        .named(&[("fault", "state.module"), ("cause", "module_cause"), ("safe_ack", "input_edge"), ("cu_ack", "standard")])
        .constants(&[
            ("config.input", 1), ("config.profisafe", 0), ("config.extended", 0), ("profisafe_edge", 0), ("reselected", 0),
            ("message", 0), ("inputs.cause", 0),
        ])
        .hidden(&["outputs.acknowledge", "event", "no_event", "module_fault"]);

    // POWER ON is one of the reasons that the table gets together.
    "restart" => restart
        .named(&[
            ("suppressed", "sto"), ("blocked", "latched"), ("on_off1", "on"), ("enables", "enabled"), ("chain", "phase"), ("was", "last"),
        ])
        .constants(&[("power_on", 0)]);
    "acceptance" => acceptance_mode
        .named(&[
            ("t_accept", "duration"), ("set", "request"), ("slp_test", "inputs.position_test"), ("sos_ack", "sos_acknowledged"),
            ("zsw3b_15", "active"), ("zsw3b_14", "outputs.position_test"), ("setpoint", "setpoint_enabled"),
            ("taught", "new_reference"), ("timer", "left"), ("was", "requested"),
        ])
        .hidden(&["limits"])
        .told("no_limits", |_, out| (!out.limits).into());

    // Commissioning. An incompatible Motor Module is the table's alone; p9601 may change while the mode is on.
    "commissioning" => commissioning
        .live("enabled", "enabled")
        .named(&[
            ("sum_cu", "checksum_control_unit"), ("sum_mm", "checksum_motor_module"), ("a01698", "active"), ("a01693", "power_on_required"),
        ])
        .decided("compatible", |_| true)
        .without(&["off", "sto"]);
}
