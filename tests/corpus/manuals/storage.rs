//! The runner of the blocks for storage and retrieval machines: `monitor`, a block with its table, see [`super::story`]. A cycle is one
//! call; times are counted in calls where a case gives no `cycle`.

use toml::{Table, Value};

use super::case::{Given, Runner};
use super::story::{self, Family};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[("monitor", monitor)];

fn monitor(given: &Given<'_>) -> Result<Table, String> {
    let family = Family {
        name: "srm-fblocks",
        cycle: 1,
        param,
    };
    story::monitor(&family, given)
}

/// A parameter of a table: a number or a truth value.
fn param(name: &str, value: &Value) -> Result<i64, String> {
    let number = value.as_bool().map(i64::from).or(value.as_integer());
    number.ok_or_else(|| format!("{name}: a number or a truth value is needed"))
}
