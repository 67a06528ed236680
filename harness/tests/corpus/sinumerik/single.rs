//! Runners of one monitor each.

use crate::case::Given;
use stillpoint::recording::vocabulary;
use stillpoint_monitors::sinumerik::external;
use toml::{Table, Value};

/// External stops of one channel, once the safe logic is compared. Given: `selected`, the letters whose signal is 0; `stop_e`,
/// STOP E exists, `not_started` the safe logic is not compared yet. Answer: `request`.
pub fn external_stops(given: &Given<'_>) -> Result<Table, String> {
    let selected = given.texts("selected")?;
    let off = |letter| !selected.contains(&letter);
    let config =
        external::Config::new(true, given.flag("stop_e")?, false).map_err(|e| e.to_string())?;
    let inputs = external::Inputs {
        spl_started: !given.flag("not_started")?,
        sge_a: off("A"),
        sge_c: off("C"),
        sge_d: off("D"),
        sge_e: off("E"),
        ..external::Inputs::default()
    };
    let (_, outputs) = external::next(external::State::INITIAL, &config, &inputs);
    let request = vocabulary::level(outputs.request.level());
    Ok(Table::from_iter([(
        "request".to_owned(),
        Value::from(request),
    )]))
}
