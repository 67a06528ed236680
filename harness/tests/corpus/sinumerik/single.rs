//! Runners of one monitor each.

use crate::case::Given;
use stillpoint::recording::vocabulary;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::interface::{Place, SGA, SGE};
use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_monitors::sinumerik::{external, stop};
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

/// Two stops of one channel, one a cycle after the other. Given: `first`, `then`, letters or `TEST`. Answer: `after`, the
/// effective stop; `other_way`, where the second one comes first.
pub fn priority(given: &Given<'_>) -> Result<Table, String> {
    let config = stop::Config::new(
        Cycles::new(9),
        Cycles::new(9),
        Cycles::new(9),
        Cycles::new(9),
    )
    .map_err(|e| e.to_string())?;
    let inputs = |name: &str| -> Result<stop::Inputs, String> {
        let level = Level::ALL
            .into_iter()
            .find(|l| vocabulary::level(*l) == name)
            .ok_or(format!("no stop is called {name}"))?;
        let mut inputs = stop::Inputs::default();
        match InternalStop::from_level(level) {
            Some(demand) => inputs.demand = demand,
            None => inputs.test = level == Level::Test,
        }
        Ok(inputs)
    };
    let run = |first: stop::Inputs, then: stop::Inputs| {
        let mut monitor = stop::Monitor::new(config);
        let _ = monitor.step(&first);
        // The test is held by its signal, a stop raised inside by its latch.
        let both = stop::Inputs {
            test: first.test || then.test,
            ..then
        };
        vocabulary::level(monitor.step(&both).level)
    };
    let (first, then) = (inputs(given.text("first")?)?, inputs(given.text("then")?)?);
    Ok(Table::from_iter([
        ("after".to_owned(), Value::from(run(first, then))),
        ("other_way".to_owned(), Value::from(run(then, first))),
    ]))
}

/// A bit of the data block of an axis. Given: `byte`, `bit`. Answer: `signal`, the one signal there, found by writing the
/// data block with each output signal, and by reading each input signal from it.
pub fn signal(given: &Given<'_>) -> Result<Table, String> {
    let (byte, bit) = (given.int("byte")?, given.int("bit")?);
    let at = |place: &&Place| (i64::from(place.byte), i64::from(place.bit)) == (byte, bit);
    let mut found = SGE.iter().chain(SGA).filter(at).map(|place| place.id);
    let name = found.next().unwrap_or("reserved");
    if let Some(second) = found.next() {
        return Err(format!("{second} stands there, too"));
    }
    Ok(Table::from_iter([("signal".to_owned(), Value::from(name))]))
}
