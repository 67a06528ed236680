//! Runners of HEIDENHAIN's functional safety.
//!
//! `monitor`: a production monitor over time, by the names that its table has for ports, parameters and values, and the table in
//! step with it: where the two part the case is no evidence and fails.
//!
//! Given: `file` and `machine`, the table; `params`, its parameters, of which a time may be `"200 ms"`; `inputs`, what they are
//! from the beginning, FALSE or their least value where nothing is said; `story`, what happens, in the order of time:
//! `"36 NAME=VALUE"` at 36 ms and from then on, `"36 NAME!"` for one cycle only; `until`, the last time, 0 where there is none;
//! `cycle`, the length of a cycle in ms, 3 where there is none. Times are those of the first cycle not before them.
//!
//! `ask` has a question for each key of the answer: `"48 NAME"`, the value at 48 ms; `"first NAME=VALUE"`, when it is seen first,
//! in ms, -1 if never; `"count NAME=VALUE"`, in how many cycles. Without it the answer is every output of the last cycle.
//!
//! `keys`: the filter of the keys, which has no table under its name. Given: `unit`, the machine operating mode; `t_open`, the
//! magazine door, while the door of the working space is open; `on`, `panel` or `wheel`; `key`, `stop`, `start` or `permissive`.
//! Answer: `active`; a start has to be so for every key that starts a motion.
//!
//! `conversion`: a value of a safe machine parameter. Given: `parameter`, `value` in the finest step of the parameter. Answer:
//! `accepted`, and `cycles` of 3 ms or `increments` of 0.1 um, in a cycle where it is a speed.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex};

use stillpoint_harness::diff::peer::{Peer, peer};
use stillpoint_harness::diff::product::Product;
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{LazyKind, Ty};
use stillpoint_monitors::heidenhain::key_filter::{self, Keys};
use stillpoint_monitors::heidenhain::parameters;
use stillpoint_monitors::heidenhain::types::Unit;
use stillpoint_monitors::kernel::{ConfigError, Cycles};
use toml::{Table, Value};

use super::case::{Given, Runner};

/// The runners by name; every one is used by a case.
pub const RUNNERS: &[(&str, Runner)] = &[
    ("monitor", monitor),
    ("keys", keys),
    ("conversion", conversion),
];

/// A machine of the tables with its monitor.
struct Pair {
    bound: Bound,
    peer: Box<dyn Peer>,
}

/// The outputs of each cycle, in the order of the monitor.
type Shown = Vec<Vec<i64>>;

fn monitor(given: &Given<'_>) -> Result<Table, String> {
    let pair = Pair::new(given)?;
    let cycle = u64::try_from(given.int_or("cycle", 3)?).map_err(|e| e.to_string())?;
    let until = u64::try_from(given.int_or("until", 0)?).map_err(|e| e.to_string())?;
    let shown = pair.play(given, cycle, until.div_ceil(cycle))?;
    let mut answer = Table::new();
    match given.get("ask") {
        Some(ask) => {
            for (key, question) in ask.as_table().ok_or("ask: a table is needed")? {
                let question = question.as_str().ok_or("a question is a text")?;
                answer.insert(key.clone(), pair.reply(question, &shown, cycle)?);
            }
        }
        None => {
            let last = shown.last().ok_or("no cycle")?;
            for (k, name) in pair.peer.outputs().iter().enumerate() {
                answer.insert((*name).to_owned(), pair.value(name, last[k]));
            }
        }
    }
    Ok(answer)
}

/// A file of the family; read once, since many cases look into the same.
fn specification(name: &str) -> Result<Arc<Spec>, String> {
    static READ: Mutex<BTreeMap<String, Arc<Spec>>> = Mutex::new(BTreeMap::new());
    let mut read = READ.lock().map_err(|e| e.to_string())?;
    if let Some(spec) = read.get(name) {
        return Ok(Arc::clone(spec));
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec/families/heidenhain-fs");
    let spec = Arc::new(Spec::load(&folder.join(name)).map_err(|e| e.to_string())?);
    read.insert(name.to_owned(), Arc::clone(&spec));
    Ok(spec)
}

impl Pair {
    fn new(given: &Given<'_>) -> Result<Self, String> {
        let machine = given.text("machine")?;
        let spec = specification(given.text("file")?)?;
        let system = spec.open_machine(machine).map_err(|e| e.to_string())?;
        let mut params = BTreeMap::new();
        if let Some(list) = given.get("params") {
            for (name, value) in list.as_table().ok_or("params: a table is needed")? {
                params.insert(name.clone(), vec![param(name, value)?]);
            }
        }
        let bound = Bound::new(system, &params, &BTreeMap::new()).map_err(|e| e.to_string())?;
        let peer = peer(machine, &bound, None)?.ok_or("the machine has no monitor")?;
        Ok(Self { bound, peer })
    }

    /// The number of an input's value.
    fn input(&self, what: &str) -> Result<(usize, i32), String> {
        let (name, value) = what
            .split_once('=')
            .ok_or_else(|| format!("{what}: NAME=VALUE is needed"))?;
        let system = &self.bound.system;
        let inputs = &system.inputs;
        let k = inputs
            .iter()
            .position(|i| is(&i.name, name))
            .ok_or_else(|| format!("no input is called {name}"))?;
        let (lo, hi) = self.bound.inputs[k];
        let of = |n: &i32| {
            system
                .show(inputs[k].ty, i64::from(*n))
                .eq_ignore_ascii_case(value)
        };
        let found = (lo..=hi).find(of);
        found
            .map(|n| (k, n))
            .ok_or_else(|| format!("{name} cannot be {value}"))
    }

    fn play(&self, given: &Given<'_>, cycle: u64, last: u64) -> Result<Shown, String> {
        let product = Product::new(&self.bound, self.peer.as_ref())?;
        let mut inputs: Vec<i32> = self.bound.inputs.iter().map(|(lo, _)| *lo).collect();
        if let Some(list) = given.get("inputs") {
            for (name, value) in list.as_table().ok_or("inputs: a table is needed")? {
                let text = value
                    .as_str()
                    .map_or_else(|| value.to_string(), str::to_owned);
                let (k, value) = self.input(&format!("{name}={text}"))?;
                inputs[k] = value;
            }
        }
        let mut events = Vec::new();
        for line in given.texts("story")? {
            let (time, what) = line
                .split_once(' ')
                .ok_or_else(|| format!("{line}: TIME NAME=VALUE is needed"))?;
            let time: u64 = time.parse().map_err(|_| format!("{line}: no time in ms"))?;
            let once = what.strip_suffix('!');
            let change = match once {
                Some(name) => self.input(&format!("{name}=TRUE"))?,
                None => self.input(what)?,
            };
            events.push((time.div_ceil(cycle), once.is_some(), change));
        }
        let names = self.peer.inputs();
        let fed: Vec<usize> = names
            .iter()
            .map(|name| {
                let mut all = self.bound.system.inputs.iter();
                all.position(|i| is(&i.name, name))
                    .ok_or(format!("no input {name}"))
            })
            .collect::<Result<_, _>>()?;
        let mut work = product.new_work();
        let mut both = product.start(&mut |k| self.bound.states[k].0);
        let mut own = both.split_off(self.bound.states.len());
        both.extend_from_slice(&own);
        let mut shown = Vec::new();
        for now in 0..=last {
            let mut these = inputs.clone();
            for (at, once, (k, value)) in &events {
                if *at == now {
                    these[*k] = *value;
                    if !once {
                        inputs[*k] = *value;
                    }
                }
            }
            work.set_inputs(&these);
            product
                .step(&mut work, &mut both)
                .map_err(|f| format!("the table faults: {f:?}"))?;
            if !product.agree(&work) {
                return Err(format!("table and monitor part at {} ms", now * cycle));
            }
            let numbers: Vec<i32> = fed.iter().map(|k| these[*k]).collect();
            let mut outputs = Vec::new();
            self.peer.step(&mut own, &numbers, &mut outputs);
            shown.push(outputs);
        }
        Ok(shown)
    }

    /// An output's value as a case has it.
    fn value(&self, name: &str, number: i64) -> Value {
        let system = &self.bound.system;
        let state = system.states.iter().find(|s| is(&s.var.name, name));
        let mut outputs = system.lazies.iter().filter(|l| l.kind == LazyKind::Output);
        let ty = match state {
            Some(state) => state.var.ty,
            None => outputs
                .find(|l| is(&l.name, name))
                .map_or(Ty::Int, |l| l.ty),
        };
        match ty {
            Ty::Bool => (number != 0).into(),
            Ty::Int => number.into(),
            Ty::Enum(_) => system.show(ty, number).into(),
        }
    }

    fn reply(&self, question: &str, shown: &Shown, cycle: u64) -> Result<Value, String> {
        let place = |name: &str| {
            let mut all = self.peer.outputs().iter();
            all.position(|o| *o == name)
                .ok_or_else(|| format!("no output is called {name}"))
        };
        let seen = |what: &str| -> Result<Vec<usize>, String> {
            let (name, value) = what
                .split_once('=')
                .ok_or_else(|| format!("{question}: NAME=VALUE is needed"))?;
            let k = place(name)?;
            let is = |row: &[i64]| {
                let found = self.value(name, row[k]).to_string();
                found.trim_matches('"').eq_ignore_ascii_case(value)
            };
            let all = shown.iter().enumerate();
            Ok(all.filter(|(_, row)| is(row)).map(|(n, _)| n).collect())
        };
        let number = |n: u64| i64::try_from(n).map(Value::from).map_err(|e| e.to_string());
        let words: Vec<&str> = question.split(' ').collect();
        match words.as_slice() {
            ["first", what] => match seen(what)?.first() {
                Some(n) => number(*n as u64 * cycle),
                None => Ok(Value::from(-1)),
            },
            ["count", what] => number(seen(what)?.len() as u64),
            [time, name] => {
                let time: u64 = time.parse().map_err(|_| format!("{question}: no time"))?;
                let n = usize::try_from(time.div_ceil(cycle)).map_err(|e| e.to_string())?;
                let row = shown
                    .get(n)
                    .ok_or_else(|| format!("{question}: the story has ended before"))?;
                Ok(self.value(name, row[place(name)?]))
            }
            _ => Err(format!("{question}: not a question")),
        }
    }
}

/// Whether a port of a machine on its own, which has its instance before it, has this name.
fn is(port: &str, name: &str) -> bool {
    port == name || port.split_once('.').is_some_and(|(_, short)| short == name)
}

/// A parameter of a table: a number, or a time that the monitors' conversion turns into cycles.
fn param(name: &str, value: &Value) -> Result<i64, String> {
    if let Some(flag) = value.as_bool() {
        return Ok(i64::from(flag));
    }
    let Some(text) = value.as_str() else {
        return value
            .as_integer()
            .ok_or_else(|| format!("{name}: a number or a time is needed"));
    };
    let millis: u32 = text
        .strip_suffix(" ms")
        .and_then(|t| t.parse().ok())
        .ok_or_else(|| format!("{name}: {text} is no time in ms"))?;
    let cycles = if name == "t_brake" {
        parameters::brake_time(millis)
    } else {
        parameters::stop_time(millis)
    };
    cycles
        .map(|c| i64::from(c.count()))
        .map_err(|e| format!("{name}: {e:?}"))
}

fn keys(given: &Given<'_>) -> Result<Table, String> {
    let unit = match given.text("unit")? {
        "PANEL" => Unit::Panel,
        "PROGRAM" => Unit::Program,
        "HANDWHEEL" => Unit::Handwheel,
        "REFERENCE" => Unit::Reference,
        other => return Err(format!("no machine operating mode is called {other}")),
    };
    let open = key_filter::Inputs {
        door_open: true,
        t_open: given.flag("t_open")?,
        unit,
        ..Default::default()
    };
    let pass = |inputs: &key_filter::Inputs| {
        let out = key_filter::Monitor::new(key_filter::Config).step(inputs);
        (out.panel, out.wheel, out.stop)
    };
    let starts = [
        Keys {
            axes: 1,
            ..Keys::NONE
        },
        Keys {
            nc_start: true,
            ..Keys::NONE
        },
        Keys {
            jog: true,
            ..Keys::NONE
        },
        Keys {
            spindle_start: true,
            ..Keys::NONE
        },
    ];
    let permissive = [Keys {
        permissive: true,
        ..Keys::NONE
    }];
    let wheel = match given.text("on")? {
        "panel" => false,
        "wheel" => true,
        other => return Err(format!("no unit is called {other}")),
    };
    let seen = |pressed: &Keys| {
        if wheel {
            pass(&key_filter::Inputs {
                wheel: *pressed,
                ..open
            })
            .1 == *pressed
        } else {
            pass(&key_filter::Inputs {
                panel: *pressed,
                ..open
            })
            .0 == *pressed
        }
    };
    let all = |pressed: &[Keys]| {
        let active = pressed.iter().filter(|p| seen(p)).count();
        if active == 0 || active == pressed.len() {
            Ok(active > 0)
        } else {
            Err(format!("{active} of {} keys act", pressed.len()))
        }
    };
    let active = match given.text("key")? {
        "start" => all(&starts)?,
        "permissive" => all(&permissive)?,
        "stop" => pass(&key_filter::Inputs { stop: true, ..open }).2,
        other => return Err(format!("no key is called {other}")),
    };
    let mut answer = Table::new();
    answer.insert("active".into(), active.into());
    Ok(answer)
}

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
