//! Runners of what belongs to PROFIsafe.

use crate::manuals::case::Given;
use stillpoint_monitors::sinumerik::f_setup::Address;
use stillpoint_monitors::sinumerik::f_times::Times;
use stillpoint_monitors::sinumerik::net_data::Connection;
use toml::{Table, Value};

/// Response times of the F master. Given, in ms: `late_cycle`, the PROFIsafe cycle as late as it can be; `cycle`, as parameterised;
/// `interpolator`, `plc`, `ob40`, `late`. Answer, in ms: `plc_one_way`, `plc_both_ways`, `nck_in`, `nck_out`, `nck_both_ways`.
pub fn f_times(given: &Given<'_>) -> Result<Table, String> {
    let us = |key: &str| -> Result<u32, String> {
        let ms = given.int_or(key, 0)?;
        u32::try_from(ms * 1000).map_err(|e| format!("{key}: {e}"))
    };
    let times = Times {
        delayed_cycle_us: us("late_cycle")?,
        cycle_us: us("cycle")?,
        interpolator_us: us("interpolator")?,
        plc_us: us("plc")?,
        ob40_us: us("ob40")?,
        late_us: us("late")?,
    };
    let answers = [
        ("plc_one_way", times.plc_one_way()),
        ("plc_both_ways", times.plc_both_ways()),
        ("nck_in", times.nck_in()),
        ("nck_out", times.nck_out()),
        ("nck_both_ways", times.nck_both_ways()),
    ];
    let mut table = Table::new();
    for (name, us) in answers {
        if us % 1000 != 0 {
            return Err(format!("{name} is {us} us"));
        }
        let ms = i64::try_from(us / 1000).map_err(|e| e.to_string())?;
        table.insert(name.to_owned(), Value::from(ms));
    }
    Ok(table)
}

/// A connection of an F module. Given: `filter`, `assign`, and `address` if there is one. Answer: `bits`, the bits of the sub-slot that are
/// used, from the lowest; `variables`, the variable of each; `sub_slot`, `station` of the address.
pub fn connection(given: &Given<'_>) -> Result<Table, String> {
    let datum = |key: &str| -> Result<u32, String> {
        u32::try_from(given.int(key)?).map_err(|e| format!("{key}: {e}"))
    };
    let connection =
        Connection::new(datum("filter")?, datum("assign")?).map_err(|e| format!("{e:?}"))?;
    let bits = (0..32).filter(|bit| connection.bits() >> bit & 1 == 1);
    let bits: Vec<u8> = bits.collect();
    let variables = bits.iter().filter_map(|bit| connection.variable(*bit));
    let list = |numbers: Vec<u8>| {
        let numbers = numbers.into_iter().map(|n| Value::from(i64::from(n)));
        Value::Array(numbers.collect())
    };
    let mut table = Table::from_iter([
        ("variables".to_owned(), list(variables.collect())),
        ("bits".to_owned(), list(bits)),
    ]);
    if given.get("address").is_some() {
        let address = Address::decode(datum("address")?);
        let sub_slot = Value::from(i64::from(address.sub_slot));
        table.insert("sub_slot".to_owned(), sub_slot);
        let station = Value::from(i64::from(address.station));
        table.insert("station".to_owned(), station);
    }
    Ok(table)
}
