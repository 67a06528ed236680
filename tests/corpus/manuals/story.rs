//! A production monitor over time, by the names that its table has for ports, parameters and values, and the table in step with
//! it: where the two part the case is no evidence and fails.
//!
//! Given: `file` and `machine`, or `system`, the table; `params`, its parameters; `inputs`, what they are from the beginning, FALSE or
//! their least value where nothing is said; `story`, what happens, in the order of time: `"36 NAME=VALUE"` at 36 ms and from then on,
//! `"36 NAME!"` for one cycle only; `until`, the last time, 0 where there is none; `cycle`, the length of a cycle in ms, that of the
//! family where there is none. Times are those of the first cycle not before them.
//!
//! `ask` has a question for each key of the answer: `"48 NAME"`, the value at 48 ms; `"first NAME=VALUE"`, when it is seen first,
//! in ms, -1 if never; `"count NAME=VALUE"`, in how many cycles. Without it the answer is every output of the last cycle.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use stillpoint_harness::diff::peer::{Peer, peer};
use stillpoint_harness::diff::product::Product;
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{LazyKind, Ty};
use toml::{Table, Value};

use super::case::Given;

/// A machine of the tables with its monitor.
struct Pair {
    bound: Bound,
    peer: Box<dyn Peer>,
}

/// The outputs of each cycle, in the order of the monitor.
type Shown = Vec<Vec<i64>>;

/// What differs between families.
pub struct Family {
    /// Its folder.
    pub name: &'static str,
    /// The length of a cycle in ms where a case says nothing of it.
    pub cycle: i64,
    /// A parameter of a table by its name, from what a case has for it.
    pub param: fn(&str, &Value) -> Result<i64, String>,
}

/// Runs a case.
pub fn monitor(family: &Family, given: &Given<'_>) -> Result<Table, String> {
    let pair = Pair::new(family, given)?;
    let cycle = u64::try_from(given.int_or("cycle", family.cycle)?).map_err(|e| e.to_string())?;
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

/// A file of a family; read once, since many cases look into the same.
fn specification(family: &str, name: &str) -> Result<Arc<Spec>, String> {
    static READ: Mutex<BTreeMap<PathBuf, Arc<Spec>>> = Mutex::new(BTreeMap::new());
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec/families");
    let file = folder.join(family).join(name);
    let mut read = READ.lock().map_err(|e| e.to_string())?;
    if let Some(spec) = read.get(&file) {
        return Ok(Arc::clone(spec));
    }
    let spec = Arc::new(Spec::load(&file).map_err(|e| e.to_string())?);
    read.insert(file, Arc::clone(&spec));
    Ok(spec)
}

impl Pair {
    fn new(family: &Family, given: &Given<'_>) -> Result<Self, String> {
        let spec = specification(family.name, given.text("file")?)?;
        let (name, system) = match given.get("system").and_then(Value::as_str) {
            Some(name) => (name, spec.system(name, None).map_err(|e| e.to_string())?),
            None => {
                let name = given.text("machine")?;
                (name, spec.open_machine(name).map_err(|e| e.to_string())?)
            }
        };
        let mut params = BTreeMap::new();
        if let Some(list) = given.get("params") {
            for (name, value) in list.as_table().ok_or("params: a table is needed")? {
                params.insert(name.clone(), vec![(family.param)(name, value)?]);
            }
        }
        let bound = Bound::new(system, &params, &BTreeMap::new()).map_err(|e| e.to_string())?;
        let peer = peer(name, &bound, None)?.ok_or("the machine has no monitor")?;
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
        if let (Ty::Int, Ok(n)) = (inputs[k].ty, value.parse::<i32>()) {
            return match (lo..=hi).contains(&n) {
                true => Ok((k, n)),
                false => Err(format!("{name} is {lo} to {hi}")),
            };
        }
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
