//! What the page shows, as JSON.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use serde_json::{Value, json};
use stillpoint_engine::table::Interpreted;
use stillpoint_engine::{Cycle, label, lazy};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::UNSET;
use stillpoint_lang::ir::{LazyKind, Ty, Var};
use stillpoint_machine::Abstraction;
use stillpoint_model::Fault;
use stillpoint_show::diagram::{Diagram, Mark};

use super::classes::{Class, Classes, MOST_CYCLES, classes};
use super::live::{Live, Standing, live};
use super::path::Choice;
use super::recording::recordable;
use super::walk::Walk;
use super::{Walks, path};
use crate::report::{grouped, params};
use crate::timing;

/// Initial states listed at most.
const MOST_INITIAL: usize = 200;
/// Values of an input listed at most; the page takes a number for others.
const MOST_VALUES: i64 = 64;
/// Cycles of the longest walk that is drawn.
const MOST_DRAWN: usize = 1000;

/// The systems of a file: what does not depend on a walk.
pub fn systems(walks: &Walks) -> Value {
    let systems = walks.systems().map(|(task, name, hash)| {
        let bound = &task.bound;
        let inputs = bound.system.inputs.iter().zip(&bound.inputs);
        let inputs = inputs.map(|(input, (lo, hi))| {
            let (lo, hi) = (i64::from(*lo), i64::from(*hi));
            let values = (hi - lo < MOST_VALUES)
                .then(|| (lo..=hi).map(|v| bound.system.show(input.ty, v)).collect::<Vec<_>>());
            json!({ "name": input.name, "text": input.text, "lo": lo, "hi": hi, "values": values })
        });
        let properties = bound.system.properties.iter().map(|p| {
            json!({
                "id": label(p), "text": p.text, "note": p.note, "requirements": p.req,
                "written": p.written.iter().map(|(key, text)| json!([key, text])).collect::<Vec<_>>(),
            })
        });
        let rules = bound.system.rules().map(
            |rule| json!({ "name": rule.name, "requirements": rule.ids, "note": rule.note }),
        );
        let rules: Vec<Value> = rules.collect();
        let inputs: Vec<Value> = inputs.collect();
        json!({
            "name": name, "recordable": recordable(walks.subject().machine.as_ref(), task), "title": task.title, "system": bound.system.name, "hash": hash,
            "axes": task.axes, "abstractions": Abstraction::texts(&task.abstractions),
            "cycle_us": bound.system.cycle_us, "scaled": bound.system.scaled && walks.subject().machine.is_some(),
            "parameters": params(bound), "readings": bound.readings(),
            "inputs": inputs, "rules": rules, "properties": properties.collect::<Vec<_>>(),
        })
    });
    let systems: Vec<Value> = systems.collect();
    let start = walks
        .systems()
        .nth(walks.start)
        .map(|(_, name, _)| name.to_owned());
    json!({
        "name": walks.subject().name, "title": walks.subject().title,
        "version": env!("CARGO_PKG_VERSION"), "start": start, "systems": systems,
        "most_cycles": path::MOST_CYCLES,
    })
}

/// What a walk shows at its cycle number `at` (0 for the initial state), with some inputs of the next cycle held.
pub fn view(bound: &Bound, walk: &Walk, at: usize, held: &[(u32, u32)]) -> Value {
    let properties = live(bound, &judged(walk)[..at.min(judged(walk).len())]);
    let path = &walk.path;
    let next = walk.states.get(at).map(|state| classes(bound, state, held));
    let listed = next
        .as_ref()
        .map(|next| listed(bound, &walk.states[at], next));
    json!({
        "path": path.to_string(),
        "parts": std::iter::once(&path.initial).chain(&path.steps).map(Choice::to_string).collect::<Vec<_>>(),
        "at": at, "length": walk.cycles.len(),
        "machines": machines(bound, walk, at),
        "inputs": inputs(bound, walk, at),
        "fired": at.checked_sub(1).map(|k| rules(bound, &walk.cycles[k].frame.fired)),
        "fault": walk.fault.filter(|_| at == walk.cycles.len()).map(|code| fault(bound, Fault { code })),
        "properties": bound.system.properties.iter().zip(&properties)
            .map(|(p, live)| property(bound, &label(p), live)).collect::<Vec<_>>(),
        "next": listed,
        "initials": if at == 0 { initials(bound) } else { Value::Null },
        "diagram": (walk.cycles.len() <= MOST_DRAWN).then(|| drawn(bound, walk, at).svg()),
    })
}

/// The cycles that properties speak of: one that met a fault has no state after it.
fn judged(walk: &Walk) -> &[Cycle] {
    let states = walk.states.len().saturating_sub(1);
    &walk.cycles[..states.min(walk.cycles.len())]
}

/// The timing diagram of a walk, with marks where properties break and at the cycle shown.
fn drawn(bound: &Bound, walk: &Walk, at: usize) -> Diagram {
    let mut diagram = timing::of_run(bound, &walk.cycles);
    diagram.cycle = Some(bound.system.cycle_us);
    let whole = live(bound, judged(walk));
    for (property, live) in bound.system.properties.iter().zip(&whole) {
        if let Some(column) = live.broken {
            diagram.marks.push(Mark {
                column,
                text: format!("{} violated", label(property)),
                fault: true,
            });
        }
    }
    if at < walk.cycles.len() {
        diagram.marks.push(Mark {
            column: at,
            text: "shown above".to_owned(),
            fault: false,
        });
    }
    diagram
}

/// The walk as a diagram alone, for a file.
pub fn svg(bound: &Bound, walk: &Walk) -> String {
    drawn(bound, walk, walk.cycles.len()).svg()
}

/// The state variables and outputs of each machine.
fn machines(bound: &Bound, walk: &Walk, at: usize) -> Vec<Value> {
    let system = &bound.system;
    let now = walk.states.get(at);
    let before = at.checked_sub(1).and_then(|k| walk.states.get(k));
    let cycle = at.checked_sub(1).and_then(|k| walk.cycles.get(k));
    let earlier = at.checked_sub(2).and_then(|k| walk.cycles.get(k));
    let owner = |name: &str| {
        let of = |instance: &str| {
            name.strip_prefix(instance)
                .is_some_and(|rest| rest.starts_with('.'))
        };
        system.instances.iter().position(|i| of(&i.name))
    };
    let short = |name: &str, instance: &str| {
        let rest = name
            .strip_prefix(instance)
            .and_then(|rest| rest.strip_prefix('.'));
        rest.unwrap_or(name).to_owned()
    };
    let outputs: Vec<_> = system
        .lazies
        .iter()
        .enumerate()
        .filter(|(_, l)| l.kind == LazyKind::Output)
        .map(|(k, l)| (owner(&l.name), k, l))
        .collect();
    let mut out = Vec::new();
    for (number, instance) in system.instances.iter().enumerate() {
        let cells = instance.states.start as usize..instance.states.end as usize;
        let states = cells.filter_map(|k| {
            let var = &system.states.get(k)?.var;
            let value = now.map(|now| now[k]);
            let old = before.map(|before| before[k]);
            let (lo, hi) = bound.states[k];
            Some(json!({
                "name": short(&var.name, &instance.name), "text": var.text,
                "kind": kind(var.ty), "value": value.map(|v| shown(bound, var, v)),
                "before": old.filter(|old| value.is_some_and(|v| v != *old)).map(|v| shown(bound, var, v)),
                "range": match var.ty { Ty::Int => json!([lo, hi]), _ => Value::Null },
                "requirements": var.ids,
            }))
        });
        let states: Vec<Value> = states.collect();
        let mine = outputs.iter().filter(|(of, ..)| of.unwrap_or(0) == number);
        let mine = mine.map(|(_, k, output)| {
            let value = cycle.and_then(|c| lazy(bound, c, *k));
            let old = earlier.and_then(|c| lazy(bound, c, *k));
            let show = |v: i64| system.show(output.ty, v);
            json!({
                "name": short(&output.name, &instance.name), "text": output.text,
                "kind": kind(output.ty), "value": value.map(show),
                "before": old.filter(|old| value.is_some_and(|v| v != *old)).map(show),
                "requirements": output.ids,
            })
        });
        out.push(json!({
            "name": instance.name, "machine": instance.machine,
            "states": states, "outputs": mine.collect::<Vec<_>>(),
        }));
    }
    out
}

fn kind(ty: Ty) -> &'static str {
    match ty {
        Ty::Bool => "bool",
        Ty::Enum(_) => "enum",
        Ty::Int => "int",
    }
}

fn shown(bound: &Bound, var: &Var, value: i32) -> String {
    bound.system.show(var.ty, i64::from(value))
}

/// The value of input `k` at this distance from its least one.
fn input_value(bound: &Bound, k: u32, above: u32) -> String {
    let var = bound.system.inputs.get(k as usize);
    let lo = bound.inputs.get(k as usize).map_or(0, |(lo, _)| *lo);
    let value = i64::from(lo) + i64::from(above);
    var.map_or_else(|| value.to_string(), |var| bound.system.show(var.ty, value))
}

fn input_name(bound: &Bound, k: u32) -> String {
    let var = bound.system.inputs.get(k as usize);
    var.map_or_else(|| format!("input {k}"), |var| var.name.clone())
}

/// The inputs of the cycle that led here; those that nothing read are not listed.
fn inputs(bound: &Bound, walk: &Walk, at: usize) -> Vec<Value> {
    let Some(cycle) = at.checked_sub(1).and_then(|k| walk.cycles.get(k)) else {
        return Vec::new();
    };
    let read = bound.system.inputs.iter().zip(&cycle.frame.inputs);
    read.filter(|(_, value)| **value != UNSET)
        .map(|(var, value)| json!({ "name": var.name, "text": var.text, "value": shown(bound, var, *value) }))
        .collect()
}

/// The numbers of the rules that fired, one of an instance at most, as the list of all rules counts them.
fn rules(bound: &Bound, fired: &[i32]) -> Vec<usize> {
    let mut first = 0;
    let mut out = Vec::new();
    for (instance, fired) in bound.system.instances.iter().zip(fired) {
        let number = usize::try_from(*fired).ok().and_then(|n| n.checked_sub(1));
        out.extend(number.map(|number| first + number));
        first += instance.rules.len();
    }
    out
}

fn fault(bound: &Bound, fault: Fault) -> String {
    match bound.system.sites.get(fault.code as usize) {
        Some(site) => format!("{} leaves its range", site.name),
        None => "a value leaves its range".to_owned(),
    }
}

fn property(bound: &Bound, id: &str, live: &Live) -> Value {
    let (standing, text) = match live.standing {
        Standing::Begin => ("none", "no cycle yet".to_owned()),
        Standing::Idle => ("idle", "nothing is asked".to_owned()),
        Standing::Met => ("met", "met".to_owned()),
        Standing::Broken => ("broken", "violated in this cycle".to_owned()),
        Standing::Pending { since, left: None } => {
            ("pending", format!("pending since cycle {since}"))
        }
        Standing::Pending {
            since,
            left: Some(left),
        } => {
            let left = match left {
                1 => "1 cycle left".to_owned(),
                n => format!("{n} cycles left"),
            };
            ("pending", format!("pending since cycle {since}, {left}"))
        }
        Standing::Unseen => ("unseen", "not seen yet".to_owned()),
        Standing::Seen(first) => ("seen", format!("seen in cycle {first}")),
        Standing::Open => ("open", "depends on inputs that were not read".to_owned()),
        Standing::NotOne => ("other", "not shown by a single walk".to_owned()),
    };
    let says = live.says.iter().map(|(key, text, value)| {
        let open = |inputs: &BTreeSet<u32>| {
            let names = inputs.iter().map(|k| input_name(bound, *k));
            names.collect::<Vec<_>>()
        };
        json!({
            "key": key, "text": text,
            "value": value.as_ref().and_then(|v| v.as_ref().ok()),
            "open": value.as_ref().and_then(|v| v.as_ref().err()).map(open),
        })
    });
    json!({
        "id": id, "standing": standing, "text": text, "broken": live.broken,
        "says": says.collect::<Vec<_>>(),
    })
}

fn listed(bound: &Bound, state: &[i32], next: &Classes) -> Value {
    let classes = next.classes.iter().map(|class| one(bound, state, class));
    let read = next.read.iter().map(|k| *k as usize);
    json!({
        "classes": classes.collect::<Vec<_>>(),
        "combinations": grouped(next.combinations), "cycles": next.cycles,
        "complete": next.complete, "most": MOST_CYCLES,
        "read": read.collect::<Vec<_>>(),
    })
}

fn one(bound: &Bound, state: &[i32], class: &Class) -> Value {
    let system = &bound.system;
    let changes: Vec<Value> = match &class.after {
        Err(_) => Vec::new(),
        Ok(after) => {
            let both = system.states.iter().zip(state.iter().zip(after));
            both.filter(|(_, (old, new))| old != new)
                .map(|(s, (old, new))| {
                    json!([
                        s.var.name,
                        shown(bound, &s.var, *old),
                        shown(bound, &s.var, *new)
                    ])
                })
                .collect()
        }
    };
    // An input at its least value, FALSE for most, is what a reader takes for granted.
    let when = class.when.iter().map(|(k, values)| {
        let least = values.as_slice() == [0];
        json!([input_name(bound, *k), ranges(bound, *k, values), least])
    });
    let broken = class
        .broken
        .iter()
        .filter_map(|k| system.properties.get(*k));
    json!({
        "choice": class.choice.to_string(),
        "changes": changes,
        "rules": rules(bound, &class.fired),
        "fault": class.after.as_ref().err().map(|f| fault(bound, *f)),
        "broken": broken.map(label).collect::<Vec<_>>(),
        "combinations": grouped(class.combinations),
        "when": when.collect::<Vec<_>>(),
        "exact": class.exact,
    })
}

/// Values of an input: each one, and from three neighbours on the first and the last of them.
fn ranges(bound: &Bound, k: u32, values: &[u32]) -> Vec<String> {
    let mut out = Vec::new();
    for run in values.chunk_by(|a, b| a + 1 == *b) {
        match run {
            [first, _, .., last] => out.push(format!(
                "{} to {}",
                input_value(bound, k, *first),
                input_value(bound, k, *last)
            )),
            few => out.extend(few.iter().map(|v| input_value(bound, k, *v))),
        }
    }
    out
}

/// The initial states: their choices and where they differ. Nothing if there is one only.
fn initials(bound: &Bound) -> Value {
    let free: Vec<usize> = (0..bound.initial.len())
        .filter(|k| bound.initial[*k].is_none())
        .collect();
    if free.is_empty() {
        return Value::Null;
    }
    let mut list = Vec::new();
    let mut complete = true;
    stillpoint_model::initials(&Interpreted::new(bound), |read, state| {
        if list.len() == MOST_INITIAL {
            complete = false;
            return ControlFlow::Break(());
        }
        let values = free.iter().map(|k| {
            let var = &bound.system.states[*k].var;
            json!([var.name, shown(bound, var, state[*k])])
        });
        let choice = Choice::new(read.iter().map(|(_, v)| *v).collect(), Vec::new());
        list.push(json!({ "choice": choice.to_string(), "values": values.collect::<Vec<_>>() }));
        ControlFlow::Continue(())
    });
    json!({ "states": list, "complete": complete })
}
