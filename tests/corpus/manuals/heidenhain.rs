//! Runners of HEIDENHAIN's functional safety.
//!
//! `monitor`: a production monitor with its table, see [`super::story`]; a parameter that is a time may be `"200 ms"`.
//!
//! `keys`: the filter of the keys, which has no table under its name. Given: `unit`, the machine operating mode; `t_open`, the
//! magazine door, while the door of the working space is open; `on`, `panel` or `wheel`; `key`, `stop`, `start` or `permissive`.
//! Answer: `active`; a start has to be so for every key that starts a motion.
//!
//! `conversion`: a value of a safe machine parameter. Given: `parameter`, `value` in the finest step of the parameter. Answer:
//! `accepted`, and `cycles` of 3 ms or `increments` of 0.1 um, in a cycle where it is a speed.

use stillpoint_monitors::heidenhain::key_filter::{self, Keys};
use stillpoint_monitors::heidenhain::parameters;
use stillpoint_monitors::heidenhain::types::Unit;
use stillpoint_monitors::kernel::{ConfigError, Cycles};
use toml::{Table, Value};

use super::case::{Given, Runner};
use super::story::{self, Family};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[
    ("monitor", monitor),
    ("keys", keys),
    ("conversion", conversion),
];

fn monitor(given: &Given<'_>) -> Result<Table, String> {
    let family = Family {
        name: "heidenhain-fs",
        cycle: 3,
        param,
    };
    story::monitor(&family, given)
}

/// A parameter of a table: a number, or a time that the monitors' conversion turns into cycles.
fn param(name: &str, value: &Value) -> Result<i64, String> {
    if let Some(flag) = value.as_bool() {
        return Ok(i64::from(flag));
    }
    let Some(text) = value.as_str() else {
        return value
            .as_integer()
            .ok_or_else(|| format!("{name}: a number or a time is needed"));
    };
    let millis: u32 = text
        .strip_suffix(" ms")
        .and_then(|t| t.parse().ok())
        .ok_or_else(|| format!("{name}: {text} is no time in ms"))?;
    let cycles = if name == "t_brake" {
        parameters::brake_time(millis)
    } else {
        parameters::stop_time(millis)
    };
    cycles
        .map(|c| i64::from(c.count()))
        .map_err(|e| format!("{name}: {e:?}"))
}

fn keys(given: &Given<'_>) -> Result<Table, String> {
    let unit = match given.text("unit")? {
        "PANEL" => Unit::Panel,
        "PROGRAM" => Unit::Program,
        "HANDWHEEL" => Unit::Handwheel,
        "REFERENCE" => Unit::Reference,
        other => return Err(format!("no machine operating mode is called {other}")),
    };
    let open = key_filter::Inputs {
        door_open: true,
        t_open: given.flag("t_open")?,
        unit,
        ..Default::default()
    };
    let pass = |inputs: &key_filter::Inputs| {
        let out = key_filter::Monitor::new(key_filter::Config).step(inputs);
        (out.panel, out.wheel, out.stop)
    };
    let starts = [
        Keys {
            axes: 1,
            ..Keys::NONE
        },
        Keys {
            nc_start: true,
            ..Keys::NONE
        },
        Keys {
            jog: true,
            ..Keys::NONE
        },
        Keys {
            spindle_start: true,
            ..Keys::NONE
        },
    ];
    let permissive = [Keys {
        permissive: true,
        ..Keys::NONE
    }];
    let wheel = match given.text("on")? {
        "panel" => false,
        "wheel" => true,
        other => return Err(format!("no unit is called {other}")),
    };
    let seen = |pressed: &Keys| {
        if wheel {
            pass(&key_filter::Inputs {
                wheel: *pressed,
                ..open
            })
            .1 == *pressed
        } else {
            pass(&key_filter::Inputs {
                panel: *pressed,
                ..open
            })
            .0 == *pressed
        }
    };
    let all = |pressed: &[Keys]| {
        let active = pressed.iter().filter(|p| seen(p)).count();
        if active == 0 || active == pressed.len() {
            Ok(active > 0)
        } else {
            Err(format!("{active} of {} keys act", pressed.len()))
        }
    };
    let active = match given.text("key")? {
        "start" => all(&starts)?,
        "permissive" => all(&permissive)?,
        "stop" => pass(&key_filter::Inputs { stop: true, ..open }).2,
        other => return Err(format!("no key is called {other}")),
    };
    let mut answer = Table::new();
    answer.insert("active".into(), active.into());
    Ok(answer)
}

fn conversion(given: &Given<'_>) -> Result<Table, String> {
    let parameter = given.text("parameter")?;
    let value = given.int("value")?;
    let positive = || u32::try_from(value).map_err(|_| ConfigError::ValueOutOfRange);
    let cycles = |r: Result<Cycles, ConfigError>| r.map(|c| ("cycles", i64::from(c.count())));
    let path = |r: Result<u32, ConfigError>| r.map(|d| ("increments", i64::from(d)));
    let result = match parameter {
        "SMP525" | "SMP526" | "SMP527" | "SMP528" | "SMP530" => {
            cycles(positive().and_then(parameters::stop_time))
        }
        "MP2308" => cycles(positive().and_then(parameters::brake_time)),
        "SMP511" => cycles(positive().and_then(parameters::test_interval)),
        "SMP2172" => cycles(positive().and_then(parameters::switch_off_time)),
        "SMP632" | "SMP633" => cycles(positive().and_then(parameters::window)),
        "permissive" => cycles(positive().and_then(parameters::permissive_time)),
        "SMP590" => path(
            positive()
                .and_then(|v| parameters::axis_limit(v, 2_000))
                .map(|s| s.0),
        ),
        "SMP540" | "SMP552" => path(
            positive()
                .and_then(|v| parameters::axis_limit(v, 5_000))
                .map(|s| s.0),
        ),
        "SMP591" | "SMP541" | "SMP551" => {
            path(positive().and_then(parameters::spindle_limit).map(|s| s.0))
        }
        "SMP545" => path(
            positive()
                .and_then(parameters::standstill_path)
                .map(|d| d.0),
        ),
        "SMP550" => path(positive().and_then(parameters::stop_path).map(|d| d.0)),
        "SMP641" | "SMP642" => path(positive().and_then(parameters::deviation).map(|d| d.0)),
        "SMP646" | "SMP650" | "SMP670" => i32::try_from(value)
            .map_err(|_| ConfigError::ValueOutOfRange)
            .and_then(parameters::absolute)
            .map(|p| ("increments", i64::from(p.0))),
        _ => return Err(format!("no conversion of {parameter}")),
    };
    let mut answer = Table::new();
    answer.insert("accepted".into(), result.is_ok().into());
    if let Ok((unit, number)) = result {
        answer.insert(unit.into(), number.into());
    }
    Ok(answer)
}
