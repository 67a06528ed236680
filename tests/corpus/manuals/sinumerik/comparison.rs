//! Runners of the cross comparison: its codes, its limits and its result lists.

use super::datum::bits;
use super::{configured, parameters};
use crate::manuals::case::Given;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::compare::list::{ITEMS, Item, Kind, Limits, Rule};
use stillpoint_monitors::sinumerik::results;
use stillpoint_monitors::sinumerik::selection::{Monitored, Stage};
use toml::{Table, Value};

/// A machine datum that one channel has otherwise. Given: `axis`, the lines of the axis; `altered`, what of it the other
/// channel has, by the keys of a machine file; `monitors`, the same for data that no machine file holds. Answer: `codes`, of the
/// parameters that differ.
pub fn compared(given: &Given<'_>) -> Result<Table, String> {
    let (own, _) = parameters(given)?;
    let mut lines: Table = given.text("axis")?.parse().map_err(|e| format!("{e}"))?;
    let empty = Table::new();
    let table = |key| given.get(key).and_then(Value::as_table).unwrap_or(&empty);
    for (key, value) in table("altered") {
        lines.insert(key.clone(), value.clone());
    }
    let (mut other, _) = configured("", &lines.to_string())?;
    for (name, value) in table("monitors") {
        let value = value
            .as_integer()
            .and_then(|n| u32::try_from(n).ok())
            .ok_or("a number is needed")?;
        match name.as_str() {
            "acceptance_tst_timeout" => other.acceptance_tst_timeout = value,
            "pulse_dis_time_busfail" => other.pulse_dis_time_busfail = value,
            _ => return Err(format!("no datum {name}")),
        }
    }
    let (own, other) = (
        own.validate().map_err(|e| e.to_string())?,
        other.validate().map_err(|e| e.to_string())?,
    );
    let differing = ITEMS
        .into_iter()
        .filter(|item| own.words().words(item.code()) != other.words().words(item.code()));
    let codes: Vec<Value> = differing
        .map(|item| Value::from(i64::from(item.code().number())))
        .collect();
    Ok(Table::from_iter([("codes".to_owned(), codes.into())]))
}

/// A code of STOP F. Given: `code`. Answer: `known`, whether a monitor has it; `compared`, how the list of the comparison
/// compares it: `parameter`, `result`, `value` within a tolerance, or `none`; `actual_value`, whether it is an error of those.
pub fn code(given: &Given<'_>) -> Result<Table, String> {
    let number = u16::try_from(given.int("code")?).map_err(|e| e.to_string())?;
    let code = Code::of(number);
    let compared = match code.and_then(Item::of).map(|i| (i.kind(), i.rule())) {
        None => "none",
        Some((Kind::Static, _)) => "parameter",
        Some((Kind::Dynamic, Rule::Exact)) => "result",
        Some((Kind::Dynamic, Rule::Tolerance)) => "value",
    };
    Ok(Table::from_iter([
        ("known".to_owned(), code.is_some().into()),
        ("compared".to_owned(), compared.into()),
        (
            "actual_value".to_owned(),
            code.is_some_and(Code::is_actual_value).into(),
        ),
    ]))
}

/// The limits that are made anew in every cycle. Given: `axis`; `position`, and `reference`, that of the operating stop, in um or
/// 0.001 degrees. Answer: each limit by its code.
pub fn limits(given: &Given<'_>) -> Result<Table, String> {
    let (_, configuration) = parameters(given)?;
    let words = configuration.words();
    let position = |key| -> Result<Position, String> {
        i32::try_from(given.int_or(key, 0)?)
            .map(Position)
            .map_err(|e| e.to_string())
    };
    let limits = Limits::new(
        position("position")?,
        words.velo_limit,
        position("reference")?,
        words.standstill_tol,
        words.velo_x,
        words.pos_tol,
    );
    let with_code = limits.0.iter().zip(44..);
    Ok(with_code
        .map(|(limit, code)| (format!("{code}"), Value::from(i64::from(limit.0))))
        .collect())
}

/// The bits of a function in the result lists. Given: `function`; `state`: `inactive`, `ok`, `below` or `above`. Answer:
/// `list_1` and `list_2`, the bits that are set.
pub fn result_list(given: &Given<'_>) -> Result<Table, String> {
    let function = given.text("function")?;
    let state = given.text("state")?;
    let (above, below) = (state == "above", state == "below");
    let active = match state {
        "inactive" => false,
        "ok" | "above" | "below" => true,
        _ => return Err(format!("no state {state}")),
    };
    let mut inputs = results::Inputs::default();
    let (mut cams, mut n_x, mut modulo) = ([false; 8], false, false);
    let stage = |name: &str| match name {
        "SG1" => Some(Stage::Sg1),
        "SG2" => Some(Stage::Sg2),
        "SG3" => Some(Stage::Sg3),
        "SG4" => Some(Stage::Sg4),
        _ => None,
    };
    const CAMS: [&str; 8] = [
        "SN1+", "SN1-", "SN2+", "SN2-", "SN3+", "SN3-", "SN4+", "SN4-",
    ];
    match function {
        "SBH" if active => {
            inputs.monitored = Monitored::Standstill;
            (inputs.standstill_upper, inputs.standstill_lower) = (above, below);
        }
        "SE1" | "SE2" => {
            (inputs.se_watched, inputs.se_select) = (active, function == "SE2");
            (inputs.se_upper, inputs.se_lower) = (above, below);
        }
        "nx" => (n_x, inputs.below) = (active, state == "ok"),
        "modulo" => modulo = active,
        "SBH" => {}
        name => match (stage(name), CAMS.iter().position(|cam| *cam == name)) {
            (Some(stage), _) => {
                inputs.stage = stage;
                inputs.speed_violated = above;
                if active {
                    inputs.monitored = Monitored::Speed;
                }
            }
            (None, Some(cam)) => (cams[cam], inputs.cams[cam]) = (active, above),
            (None, None) => return Err(format!("no function {name}")),
        },
    }
    let config = results::Config::new(cams, n_x, modulo).map_err(|e| e.to_string())?;
    let (_, outputs) = results::next(results::State, &config, &inputs);
    Ok(Table::from_iter([
        ("list_1".to_owned(), bits(u32::from(outputs.list_1.bits()))),
        ("list_2".to_owned(), bits(outputs.list_2.bits())),
    ]))
}
