//! A run of both channels of an axis over time, with machine data and times as the manual has them.
//!
//! Given: `axis` and `control` as in a machine file; `story`, what happens, in the order of time: `"36 NAME=VALUE"` at 36 ms in
//! both channels, `"36 nck NAME=VALUE"` in one, `"36 NAME!"` for one cycle only. Names are those of recordings
//! (`docs/src/recordings.md`); `speed` moves the axis from then on (um or 0.001 degrees a minute), `position` puts it somewhere.
//! The feedback that the pulses are cancelled follows the pulses unless the story sets it. `agreed` and `standstill` (a
//! position) are what was kept through power-off.
//!
//! `ask` has a question for each key of the answer: `"48 NAME"` the value at 48 ms; `"first NAME=VALUE"` when it is seen
//! first, in ms, -1 if never; `"first NAME=VALUE after 48"`; `"count NAME=VALUE"` in how many cycles. Behind a question,
//! `nck` or `drive` names the channel, else the nck is asked. Beside the names of recordings there are `stopsi`, `xfaultsi_1`
//! (bit 1 of that variable), `ramp_limit` in increments per cycle, `gear_stage` from 1, `setpoint_limited`,
//! `setpoint_limit` and `position`. Power-on is the cycle at 0 ms. Times are rounded up to cycles:
//! nothing happens in the middle of one.

use super::parameters;
use crate::manuals::case::Given;
use stillpoint_harness::families::sinumerik::vocabulary;
use stillpoint_harness::recording::Value as Seen;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};
use toml::{Table, Value};

/// Cycles a story may last; the longest time of the manual is a minute.
const LONGEST: u64 = 200_000;

/// Something that happens.
struct Event<'a> {
    cycle: u64,
    sides: &'static [usize],
    name: &'a str,
    /// None: true for one cycle.
    value: Option<&'a str>,
}

/// Its name, and where both channels have it together.
type Joint = (&'static str, fn(&Outputs) -> Seen);
/// Its name, and where one channel has it.
type Extra = (&'static str, fn(&axis::Outputs) -> Seen);

/// Outputs that recordings do not have.
const EXTRAS: [Extra; 5] = [
    ("stopsi", |o| Seen::Int(i64::from(o.channel.stop.stopsi))),
    ("xfaultsi_1", |o| Seen::Bool(o.channel.fault.bit1)),
    ("ramp_limit", |o| {
        Seen::Int(i64::from(o.channel.ramp.limit.0))
    }),
    ("gear_stage", |o| {
        Seen::Int(i64::from(o.gear.stage.get()) + 1)
    }),
    ("position", |o| Seen::Int(i64::from(o.position.0))),
];

/// Outputs of both channels together; either may be asked.
const JOINT: [Joint; 2] = [
    ("setpoint_limited", |o| Seen::Bool(o.setpoint.limited)),
    ("setpoint_limit", |o| {
        Seen::Int(i64::from(o.setpoint.limit.0))
    }),
];

/// What both channels showed in a cycle: by side, by output.
type Shown = [Vec<Seen>; 2];

pub fn run(given: &Given<'_>) -> Result<Table, String> {
    let (parameters, configuration) = parameters(given)?;
    let cycle_us = parameters.monitoring_cycle_us();
    let cycles = |ms: &str| -> Result<u64, String> {
        let ms: u64 = ms.parse().map_err(|_| format!("{ms} is no time in ms"))?;
        Ok((ms * 1_000).div_ceil(cycle_us))
    };
    let events: Vec<Event<'_>> = given
        .texts("story")?
        .into_iter()
        .map(|line| event(line, &cycles))
        .collect::<Result<_, _>>()?;
    let until = cycles(given.text("until")?)?;
    if until > LONGEST {
        return Err(format!("{until} cycles are too many"));
    }
    let kept = axis::State::restored(
        given.flag("agreed")?,
        given
            .get("standstill")
            .map(|_| given.int("standstill"))
            .transpose()?
            .map(increments)
            .transpose()?,
    );
    let pair = Pair::resume(Config::new(configuration), State::restored(kept, kept))
        .map_err(|_| "the state kept is inconsistent")?;
    let shown = play(pair, &events, until, cycle_us)?;
    let Some(ask) = given.get("ask").and_then(Value::as_table) else {
        return Err("ask: a table is needed".into());
    };
    let mut answer = Table::new();
    for (key, question) in ask {
        let question = question.as_str().ok_or("a question is a text")?;
        answer.insert(key.clone(), reply(question, &shown, &cycles, cycle_us)?);
    }
    Ok(answer)
}

fn increments(value: i64) -> Result<Position, String> {
    i32::try_from(value)
        .map(Position)
        .map_err(|e| e.to_string())
}

fn event<'a>(
    line: &'a str,
    cycles: &impl Fn(&str) -> Result<u64, String>,
) -> Result<Event<'a>, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (time, sides, what): (_, &[usize], _) = match words.as_slice() {
        [time, what] => (time, &[0, 1], what),
        [time, "nck", what] => (time, &[0], what),
        [time, "drive", what] => (time, &[1], what),
        _ => return Err(format!("{line}: TIME [nck|drive] NAME=VALUE is needed")),
    };
    let (name, value) = match (what.split_once('='), what.strip_suffix('!')) {
        (Some((name, value)), _) => (name, Some(value)),
        (None, Some(name)) => (name, None),
        _ => return Err(format!("{line}: NAME=VALUE or NAME! is needed")),
    };
    Ok(Event {
        cycle: cycles(time)?,
        sides,
        name,
        value,
    })
}

/// What a value is, as the inputs take it.
fn seen(text: &str) -> Seen {
    match (text, text.parse::<i64>()) {
        ("true" | "false", _) => Seen::Bool(text == "true"),
        (_, Ok(number)) => Seen::Int(number),
        _ => Seen::Text(text.to_owned().into()),
    }
}

fn set(local: &mut Local, name: &str, value: &Seen) -> Result<(), String> {
    let input = vocabulary::inputs()
        .into_iter()
        .find(|i| i.name == name)
        .ok_or(format!("no input is called {name}"))?;
    let value = match value {
        Seen::Int(n @ (0 | 1))
            if input.range() != (0, 1) && matches!(input.get(local), Seen::Bool(_)) =>
        {
            Seen::Bool(*n == 1)
        }
        other => other.clone(),
    };
    if input.set(local, &value) {
        Ok(())
    } else {
        Err(format!("{name} cannot be {value:?}"))
    }
}

fn play(
    mut pair: Pair,
    events: &[Event<'_>],
    until: u64,
    cycle_us: u64,
) -> Result<Vec<Shown>, String> {
    let names = vocabulary::outputs();
    let mut inputs = Inputs::both(Local::idle());
    let (mut speed, mut feedback_is_told) = ([0_i64; 2], false);
    // Positions in millionths of an increment, so that slow axes lose nothing.
    let mut position = [0_i64; 2];
    let mut shown = Vec::new();
    let mut pulses = true;
    for cycle in 0..=until {
        let mut now = inputs;
        now.nck.power_on = cycle == 0;
        now.drive.power_on = cycle == 0;
        for side in 0..2 {
            let per_cycle = speed[side] * i64::try_from(cycle_us).map_err(|e| e.to_string())? / 60;
            position[side] += per_cycle;
        }
        for event in events.iter().filter(|e| e.cycle == cycle) {
            for side in event.sides {
                let number = || {
                    event
                        .value
                        .and_then(|v| v.parse::<i64>().ok())
                        .ok_or(format!("{}: a number is needed", event.name))
                };
                match event.name {
                    "speed" => speed[*side] = number()?,
                    "position" => position[*side] = number()? * 1_000_000,
                    name => {
                        feedback_is_told |= name == "pulses_cancelled";
                        let value = event.value.map_or(Seen::Bool(true), seen);
                        let channel = |both: &mut Inputs| -> Result<(), String> {
                            set(
                                if *side == 0 {
                                    &mut both.nck
                                } else {
                                    &mut both.drive
                                },
                                name,
                                &value,
                            )
                        };
                        channel(&mut now)?;
                        if event.value.is_some() {
                            channel(&mut inputs)?;
                        }
                    }
                }
            }
        }
        for (side, local) in [&mut now.nck, &mut now.drive].into_iter().enumerate() {
            local.position = increments(position[side].div_euclid(1_000_000))?;
            if !feedback_is_told {
                local.feedback = !pulses;
            }
        }
        let outputs = pair.step(&now);
        let enabled = |o: &axis::Outputs| o.channel.pulses.enable && !o.channel.stop.cancel_pulses;
        pulses = enabled(&outputs.nck) && enabled(&outputs.drive);
        let all = |side, local: &Local, of: &axis::Outputs| {
            let named = names.iter().map(|n| n.get(side, local, of));
            let extras = EXTRAS.iter().map(|(_, get)| get(of));
            let joint = JOINT.iter().map(|(_, get)| get(&outputs));
            named.chain(extras).chain(joint).collect()
        };
        shown.push([
            all(0, &now.nck, &outputs.nck),
            all(1, &now.drive, &outputs.drive),
        ]);
    }
    Ok(shown)
}

fn reply(
    question: &str,
    shown: &[Shown],
    cycles: &impl Fn(&str) -> Result<u64, String>,
    cycle_us: u64,
) -> Result<Value, String> {
    let mut words: Vec<&str> = question.split_whitespace().collect();
    let side = match words.last() {
        Some(&"drive") => 1,
        _ => 0,
    };
    words.retain(|w| *w != "nck" && *w != "drive");
    let place = |name: &str| {
        let named = vocabulary::outputs().into_iter().map(|o| o.name);
        named
            .chain(EXTRAS.iter().map(|(name, _)| *name))
            .chain(JOINT.iter().map(|(name, _)| *name))
            .position(|known| known == name)
            .ok_or(format!("no output is called {name}"))
    };
    let matches = |what: &str, after: u64| -> Result<Vec<usize>, String> {
        let (name, value) = what
            .split_once('=')
            .ok_or(format!("{question}: NAME=VALUE is needed"))?;
        let place = place(name)?;
        let is = |shown: &Shown| {
            plain(&shown[side][place]).map(|v| v.to_string().trim_matches('"') == value)
        };
        let mut found = Vec::new();
        for (cycle, shown) in shown
            .iter()
            .enumerate()
            .skip(usize::try_from(after).map_err(|e| e.to_string())?)
        {
            if is(shown)? {
                found.push(cycle);
            }
        }
        Ok(found)
    };
    let ms = |cycle: usize| -> Result<Value, String> {
        let us = i64::try_from(cycle as u64 * cycle_us).map_err(|e| e.to_string())?;
        Ok(if us % 1_000 == 0 {
            Value::from(us / 1_000)
        } else {
            Value::from(format!("{us} us"))
        })
    };
    match words.as_slice() {
        ["first", what] => matches(what, 0)?
            .first()
            .map_or(Ok(Value::from(-1)), |c| ms(*c)),
        ["first", what, "after", time] => matches(what, cycles(time)?)?
            .first()
            .map_or(Ok(Value::from(-1)), |c| ms(*c)),
        ["count", what] => Ok(Value::from(
            i64::try_from(matches(what, 0)?.len()).map_err(|e| e.to_string())?,
        )),
        [time, name] => {
            let cycle = usize::try_from(cycles(time)?).map_err(|e| e.to_string())?;
            let at = shown
                .get(cycle)
                .ok_or(format!("{question}: the story has ended before"))?;
            plain(&at[side][place(name)?])
        }
        _ => Err(format!("{question}: not a question")),
    }
}

fn plain(seen: &Seen) -> Result<Value, String> {
    Ok(match seen {
        Seen::Bool(b) => Value::from(*b),
        Seen::Int(n) => Value::from(*n),
        Seen::Text(t) => Value::from(t.as_ref()),
        #[allow(unreachable_patterns)]
        other => return Err(format!("{other:?} cannot be compared")),
    })
}
