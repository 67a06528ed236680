//! Runners of HEIDENHAIN's functional safety.
//!
//! `conversion`: a value of a safe machine parameter. Given: `parameter`, `value` in the finest step of the parameter. Answer:
//! `accepted`, and `cycles` of 3 ms or `increments` of 0.1 um, in a cycle where it is a speed.

use stillpoint_monitors::heidenhain::parameters;
use stillpoint_monitors::kernel::{ConfigError, Cycles};
use toml::Table;

use crate::case::{Given, Runner};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[("conversion", conversion)];

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
