//! What the families share where they read the values of a machine file for their monitors.

use stillpoint_machine::Settings;
use stillpoint_monitors::kernel::ConfigError;

/// A value of a parameter, in base units; 0 where the file has none.
pub(super) fn cell(values: &Settings, name: &str, place: usize) -> i64 {
    let cells = values.get(name).map(|v| v.cells.as_slice());
    cells.and_then(|c| c.get(place).copied()).unwrap_or(0)
}

/// The value itself, or the nearest one of 32 bits.
pub(super) fn nearest(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}

/// A value, or what is wrong with which parameter.
pub(super) type Fit<T> = Result<T, String>;

/// What the monitors say of the value of a parameter.
pub(super) fn fit<T>(name: &str, result: Result<T, ConfigError>) -> Fit<T> {
    result.map_err(|error| format!("the monitors refuse the value of {name}: {error}"))
}
