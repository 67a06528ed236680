//! Runners of one monitor each.

use super::parameters;
use crate::manuals::case::Given;
use core::num::NonZeroU32;
use stillpoint_harness::families::sinumerik::vocabulary;
use stillpoint_monitors::kernel::Cycles;
use stillpoint_monitors::sinumerik::alarm::{Alarm, Response};
use stillpoint_monitors::sinumerik::encoder::{Encoder, LimitFrequency, Mounting, REVOLUTION};
use stillpoint_monitors::sinumerik::gear::GearIndex;
use stillpoint_monitors::sinumerik::interface::{Place, SGA, SGE};
use stillpoint_monitors::sinumerik::level::{InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{Monitored, Stage};
use stillpoint_monitors::sinumerik::{bus_failure, external, stop};
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

/// The drive bus fails. Given: `axis`, `control`, lines of a machine file; `stage`, the active and selected one from 1, 0 for
/// neither SBH nor SG. Answer: `pulses_off`, in ms after the failure; it is an error if the channels differ.
pub fn bus_failure(given: &Given<'_>) -> Result<Table, String> {
    let (_, configuration) = parameters(given)?;
    let stage = given.int("stage")?;
    let index = u8::try_from((stage - 1).max(0)).map_err(|e| e.to_string())?;
    let selected = Stage::from_bits(index & 2 == 2, index & 1 == 1);
    let inputs = bus_failure::Inputs {
        failed: true,
        sge_sbh_sg: stage == 0,
        sge_sbh: true,
        sg_select: selected,
        monitored: match stage {
            0 => Monitored::Nothing,
            _ => Monitored::Speed,
        },
        stage: selected,
        ..bus_failure::Inputs::default()
    };
    let mut off = Vec::new();
    for config in [configuration.bus_nck(), configuration.bus_drive()] {
        let mut monitor = bus_failure::Monitor::new(*config);
        let cycles = (0..2_000_u32).find(|_| monitor.step(&inputs).cancel);
        let cycles = cycles.ok_or("the pulses stay on")?;
        off.push(i64::from(cycles * configuration.cycle_us().get() / 1_000));
    }
    match off.as_slice() {
        [nck, drive] if nck == drive => Ok(Table::from_iter([(
            "pulses_off".to_owned(),
            Value::from(*nck),
        )])),
        differ => Err(format!("the channels differ: {differ:?}")),
    }
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

/// An alarm of the monitors. Given: `number`, of the NCK or of the drive. Answer: `response`, what the control does, in the words
/// of the lists; `stop`, the letter that belongs to it, `configured` or `none`; `clears`, what takes it away, and
/// `after_stop_ab` the same once STOP A or B has followed; `other`, the number in the other channel, 0 if it has none.
pub fn alarm(given: &Given<'_>) -> Result<Table, String> {
    let number = u32::try_from(given.int("number")?).map_err(|e| e.to_string())?;
    let drive = |alarm: Alarm| alarm.drive().filter(|entry| entry.number == number);
    let of = |alarm: Alarm| match alarm.nck().number == number {
        true => Some((alarm.nck(), alarm.drive().map_or(0, |other| other.number))),
        false => drive(alarm).map(|entry| (entry, alarm.nck().number)),
    };
    let (entry, other) = Alarm::ALL
        .into_iter()
        .find_map(of)
        .ok_or(format!("no alarm {number}"))?;
    let mut response: Vec<&str> = entry.reactions.iter().map(|r| r.keyword()).collect();
    response.sort_unstable();
    let stop = match entry.response {
        Response::None => "none",
        Response::Fixed(level) => vocabulary::level(level),
        Response::Configured => "configured",
    };
    let clears = |stop_ab| Value::from(entry.acknowledgement.needed(stop_ab).keyword());
    Ok(Table::from_iter([
        ("response".to_owned(), response.into()),
        ("stop".to_owned(), stop.into()),
        ("clears".to_owned(), clears(false)),
        ("after_stop_ab".to_owned(), clears(true)),
        ("other".to_owned(), i64::from(other).into()),
    ]))
}

/// The gear stage of the three signals. Given: `bits`, bit 2, 1 and 0. Answer: `stage`, from 1.
pub fn gear_stage(given: &Given<'_>) -> Result<Table, String> {
    let bits = given.ints("bits")?;
    let [two, one, zero] = bits.as_slice() else {
        return Err("bits: three are needed".into());
    };
    let index = GearIndex::from_bits(*two == 1, *one == 1, *zero == 1);
    Ok(Table::from_iter([(
        "stage".to_owned(),
        Value::from(i64::from(index.get()) + 1),
    )]))
}

fn positive(given: &Given<'_>, key: &str) -> Result<NonZeroU32, String> {
    u32::try_from(given.int(key)?)
        .ok()
        .and_then(NonZeroU32::new)
        .ok_or(format!("{key} must be positive"))
}

/// The position of the load at a count of the encoder. Given: `count`; `pulses` of a revolution, each of `subdivision` counts,
/// `denom` revolutions of the load for `numera` of the encoder, and for a linear axis `pitch` in um; or `grid` in nm for a
/// linear scale; `reversed`. Answer: `position` in um or 0.001 degrees, `ratio`, increments per count as a fraction.
pub fn encoder(given: &Given<'_>) -> Result<Table, String> {
    let mounting = match given.get("grid") {
        Some(_) => Mounting::Linear {
            grid_nm: positive(given, "grid")?,
        },
        None => Mounting::Rotary {
            pulses: positive(given, "pulses")?,
            denom: positive(given, "denom")?,
            numera: positive(given, "numera")?,
            load: match given.get("pitch") {
                Some(_) => positive(given, "pitch")?,
                None => REVOLUTION,
            },
        },
    };
    let encoder = Encoder::new(
        mounting,
        positive(given, "subdivision")?,
        given.flag("reversed")?,
    )
    .map_err(|e| e.to_string())?;
    let count = i32::try_from(given.int("count")?).map_err(|e| e.to_string())?;
    let position = encoder.position(count).ok_or("the position is too far")?;
    let (numerator, denominator) = encoder.ratio();
    Ok(Table::from_iter([
        ("position".to_owned(), i64::from(position.0).into()),
        (
            "ratio".to_owned(),
            format!("{numerator}/{denominator}").into(),
        ),
    ]))
}

/// The highest speed of an encoder. Given: `pulses` of a revolution, `khz`, the limit frequency. Answer: `rpm`, and `hundreds`,
/// whole hundreds of it.
pub fn encoder_speed(given: &Given<'_>) -> Result<Table, String> {
    let hz = u32::try_from(given.int("khz")? * 1_000).map_err(|e| e.to_string())?;
    let limit = LimitFrequency::new(hz, true).map_err(|e| e.to_string())?;
    let rpm = limit.revolutions_per_minute(positive(given, "pulses")?);
    Ok(Table::from_iter([
        ("rpm".to_owned(), i64::from(rpm).into()),
        ("hundreds".to_owned(), i64::from(rpm / 100 * 100).into()),
    ]))
}
