//! Runners of machine data: what the machine file and the monitors permit, and what a combination of them gives.

use super::{load, parameters, read};
use crate::manuals::case::Given;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex};
use stillpoint_machine::Machine;
use stillpoint_monitors::sinumerik::parameters::{DATA, Datum, Parameters, Unit};
use stillpoint_monitors::units::Axis;
use toml::{Table, Value};

/// Machine data of the monitors that a machine file does not hold under their own name.
const NOT_IN_FILE: [u32; 3] = [36901, 36902, 36958];

/// A value of a machine datum, in a machine file and in the monitors, which must agree.
///
/// Given: `md`, the number of the NCK datum or of its counterpart in the drive; `value`, as printed but without blanks; `unit`, as
/// printed; `kind`, linear where nothing is said; `word`, what a machine file writes in place of a number; `with`, further
/// lines that the value needs; `monitors_only`, no machine file can have it, because another rule excludes it. Answer: `permitted`, and `default`, whether it is the value where none is written.
pub fn machine_datum(given: &Given<'_>) -> Result<Table, String> {
    let md = u32::try_from(given.int("md")?).map_err(|e| e.to_string())?;
    let rotary = given.get("kind").and_then(Value::as_str) == Some("rotary");
    let datum = DATA.iter().find(|d| d.number == md || drive(d) == Some(md));
    let value = given.text("value")?;
    let unit = given.get("unit").and_then(Value::as_str).unwrap_or("");
    let monitors = datum
        .map(|datum| in_monitors(datum, value, unit, rotary))
        .transpose()?;
    let file = match datum {
        Some(datum) if given.flag("monitors_only")? || NOT_IN_FILE.contains(&datum.number) => {
            let _ = (given.get("word"), given.get("with"));
            None
        }
        _ => Some(in_file(given, md, datum, value, unit, rotary)?),
    };
    let (permitted, default) = match (file, monitors) {
        (Some(file), Some(monitors)) if file != monitors => {
            return Err(format!(
                "the machine file says {file:?}, the monitors {monitors:?}"
            ));
        }
        (Some(one), _) | (None, Some(one)) => one,
        (None, None) => return Err(format!("MD{md} is in neither")),
    };
    Ok(Table::from_iter([
        ("permitted".to_owned(), permitted.into()),
        ("default".to_owned(), default.into()),
    ]))
}

/// The number of the counterpart in the drive (table 6-2).
fn drive(datum: &Datum) -> Option<u32> {
    match datum.number {
        10089 => Some(1380),
        number => number.checked_sub(35_600).filter(|n| *n > 1_300),
    }
}

/// Permitted, and the default.
type Judged = (bool, bool);

fn in_monitors(datum: &Datum, value: &str, unit: &str, rotary: bool) -> Result<Judged, String> {
    let factor = match (datum.unit, unit) {
        (Unit::Microseconds, "s") | (Unit::Grid, "mm") => 1_000_000,
        (Unit::Microseconds, "ms")
        | (Unit::Length, "mm")
        | (Unit::Length | Unit::Angle, "degrees")
        | (Unit::Grid, "um")
        | (Unit::Pitch, "mm" | "mm/rev")
        | (Unit::Speed, "mm/min" | "rev/min") => 1_000,
        (Unit::Length, "um")
        | (Unit::Length | Unit::Angle, "0.001 degrees")
        | (Unit::Percent, "%")
        | (Unit::Hertz, "Hz")
        | (Unit::Number | Unit::Choice | Unit::Bits, "") => 1,
        _ => return Err(format!("MD{} is not in {unit}", datum.number)),
    };
    let value = exact(value, factor)?;
    let axis = if rotary { Axis::Rotary } else { Axis::Linear };
    let defaults = Parameters::default();
    let default = (0..datum.count).all(|k| (datum.value)(&defaults, k) == value);
    Ok((datum.permitted_on(axis).contains(value), default))
}

/// A decimal number times a factor; it must be a whole one.
fn exact(text: &str, factor: i64) -> Result<i64, String> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    let places = u32::try_from(decimals.len()).map_err(|e| e.to_string())?;
    let digits: i64 = format!("{whole}{decimals}")
        .parse()
        .map_err(|_| format!("{text} is no number"))?;
    let product = digits.checked_mul(factor).ok_or("the number is too long")?;
    let divisor = 10_i64.checked_pow(places).ok_or("the number is too long")?;
    (product % divisor == 0)
        .then_some(product / divisor)
        .ok_or_else(|| format!("{text} is finer than the unit of the monitors"))
}

fn in_file(
    given: &Given<'_>,
    md: u32,
    datum: Option<&Datum>,
    value: &str,
    unit: &str,
    rotary: bool,
) -> Result<Judged, String> {
    let key = match (md, datum) {
        (10070, _) => "IPO_SYSCLOCK_CYCLE_TIME_RATIO",
        (_, Some(datum)) if datum.number < 30_000 => datum.name,
        (_, Some(datum)) => datum.name.strip_prefix("SAFE_").unwrap_or(datum.name),
        _ => return Err(format!("no key for MD{md}")),
    };
    let word = given.get("word").and_then(Value::as_str);
    let one = match (word, unit) {
        (Some("true" | "false"), _) => word.unwrap_or_default().to_owned(),
        (Some(word), _) => format!("\"{word}\""),
        (None, "") => value.to_owned(),
        (None, "degrees") => format!("\"{value} deg\""),
        (None, "0.001 degrees") => format!("\"{value} mdeg\""),
        // A pitch is printed in mm, and means those of one revolution.
        (None, "mm") if key == "ENC_GEAR_PITCH" => format!("\"{value} mm/rev\""),
        (None, unit) => format!("\"{value} {unit}\""),
    };
    let count = datum.map_or(1, |d| d.count);
    let line = match count {
        1 => format!("{key} = {one}"),
        _ => format!("{key} = [{}]", vec![one; count].join(", ")),
    };
    let with = match given.get("with") {
        Some(_) => given.text("with")?,
        None => "",
    };
    let control = datum.is_none_or(|d| d.number < 30_000);
    let kind = if rotary { "rotary" } else { "linear" };
    let file = |line: &str| match control {
        true => load(&format!("{line}\n{with}"), &format!("kind = \"{kind}\"")),
        false => load("", &format!("kind = \"{kind}\"\n{line}\n{with}")),
    };
    let cells = |machine: &Machine| -> Result<Vec<i64>, String> {
        let settings = match control {
            true => &machine.control,
            false => &machine.axes.first().ok_or("no axis")?.values,
        };
        let setting = settings.get(key).ok_or(format!("no key {key}"))?;
        Ok(setting.cells.clone())
    };
    match file(&line) {
        Ok(machine) => {
            // What the file permits the monitors must take.
            let _ = stillpoint_harness::families::sinumerik::production::axes(&machine)?;
            let default = cells(&machine)? == cells(&file("")?)?;
            Ok((true, default))
        }
        Err(text) => {
            let says = |what| text.contains(what);
            let range =
                says("the greatest value") || says("the least value") || says("cannot be negative");
            range.then_some((false, false)).ok_or(text)
        }
    }
}

/// A machine file that the manual permits or refuses, as `validate` and the monitors read it; cheaper than the command line.
///
/// Given: `file`, its text; `find`, texts looked for in the findings. Answer: `plausible`; `found`, those that were found.
pub fn machine(given: &Given<'_>) -> Result<Table, String> {
    let findings = match read(given.text("file")?) {
        // What a file may say the monitors must take.
        Ok(machine) => {
            stillpoint_harness::families::sinumerik::production::axes(&machine).map(|_| None)?
        }
        Err(text) => Some(text),
    };
    let found = |what: &&str| findings.as_ref().is_some_and(|text| text.contains(what));
    let found: Vec<&str> = given.texts("find")?.into_iter().filter(found).collect();
    Ok(Table::from_iter([
        ("plausible".to_owned(), findings.is_none().into()),
        ("found".to_owned(), found.into()),
    ]))
}

/// The enable word of an axis. Given: `axis`. Answer: `bits`, those that are set.
pub fn enable_word(given: &Given<'_>) -> Result<Table, String> {
    let (parameters, _) = parameters(given)?;
    Ok(Table::from_iter([(
        "bits".to_owned(),
        bits(parameters.function_enable),
    )]))
}

/// The numbers of the bits that are set.
pub fn bits(word: u32) -> Value {
    (0..32_i64)
        .filter(|bit| word >> bit & 1 == 1)
        .map(Value::from)
        .collect::<Vec<_>>()
        .into()
}

/// The monitoring cycle. Given: `control`, `axis`. Answer: `us`, and `drive`, MD1300 in its unit of 31.25 us.
pub fn monitoring_cycle(given: &Given<'_>) -> Result<Table, String> {
    let (parameters, _) = parameters(given)?;
    let us = i64::try_from(parameters.monitoring_cycle_us()).map_err(|e| e.to_string())?;
    Ok(Table::from_iter([
        ("us".to_owned(), us.into()),
        ("drive".to_owned(), (us * 4 / 125).into()),
    ]))
}

/// A file of the family; read once, since many cases look into the same.
fn family_file(name: &str) -> Result<Arc<Table>, String> {
    static READ: Mutex<BTreeMap<String, Arc<Table>>> = Mutex::new(BTreeMap::new());
    let mut read = READ.lock().map_err(|e| e.to_string())?;
    if let Some(table) = read.get(name) {
        return Ok(Arc::clone(table));
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec/families/sinumerik-840d");
    let path = folder.join(name).with_extension("toml");
    let text = std::fs::read_to_string(path).map_err(|e| e.to_string())?;
    let table: Table = text.parse().map_err(|e| format!("{e}"))?;
    let table = Arc::new(table);
    read.insert(name.to_owned(), Arc::clone(&table));
    Ok(table)
}

/// An entry of the lists that the family has from the manual. Given: `file` and `list`, where it stands; `key` and `is`, which
/// one. Answer: what it says.
pub fn entry(given: &Given<'_>) -> Result<Table, String> {
    let table = family_file(given.text("file")?)?;
    let list = given.text("list")?;
    let entries = table.get(list).and_then(Value::as_array);
    let (key, is) = (given.text("key")?, given.get("is"));
    let mut found = entries
        .ok_or(format!("no list {list}"))?
        .iter()
        .filter(|entry| entry.get(key) == is);
    match (found.next().and_then(Value::as_table), found.next()) {
        (Some(one), None) => Ok(one.clone()),
        (None, _) => Err(format!("no entry has {key} = {is:?}")),
        (_, Some(_)) => Err(format!("several entries have {key} = {is:?}")),
    }
}
